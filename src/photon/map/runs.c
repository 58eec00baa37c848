#include "photon/map/runs.h"

#include "base/memory.h"

void photon_hits_clear(photon_hits *hits)
{
    big_free(hits->index);
    big_free(hits->distance2);
    *hits = (photon_hits){0};
}

bool photon_hits_reserve(photon_hits *hits, size_t capacity)
{
    if (capacity <= hits->capacity)
        return true;
    size_t room = MAX(capacity + LANES, 2 * hits->capacity);
    size_t *index =
        big_grow(hits->index, hits->n, room, sizeof *index, "photons found", NULL);
    if (!index)
        return false;
    hits->index = index;
    float *distance2 = big_grow(hits->distance2, hits->n, room, sizeof *distance2,
                                "photons found", NULL);
    if (!distance2)
        return false;
    hits->distance2 = distance2;
    hits->capacity = room;
    return true;
}

static void within_run(size_t begin, size_t end, within_search *search)
{
    photon_hits *hits = search->hits;
    const point_query query = *search->query;
    for (size_t i = begin; i < end; i += LANES) {
        floats8 distance2;
        unsigned bits = query_block(&query, i, end, search->radius2, &distance2);
        if (!bits)
            continue;
        if (search->refused || !photon_hits_reserve(hits, hits->n + LANES)) {
            search->refused = true;
            return;
        }
        hits->n +=
            pack8(distance2, bits, i, hits->distance2 + hits->n, hits->index + hits->n);
    }
}

void within_runs(const photon_run *runs, size_t n, void *data)
{
    for (size_t i = 0; i < n; i++)
        within_run(runs[i].begin, runs[i].end, data);
}
