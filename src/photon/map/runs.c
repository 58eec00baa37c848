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
    uint32_t *index =
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

/* Room is made for a piece at a time, as if all of it were found. */
enum { PIECE = 1 << 12 }; /* size: photons */

static void within_piece(const point_query *by, size_t begin, size_t end,
                         within_search *search)
{
    photon_hits *hits = search->hits;
    const point_query query = *by;
    const bool selects = query_selects(by);
    const float radius2 = search->radius2;
    float *distance2 = hits->distance2;
    uint32_t *index = hits->index;
    size_t n = hits->n;
    for (size_t i = begin; i < end; i += LANES) {
        lane_floats d2;
        unsigned bits = selects ? query_block(&query, i, end, radius2, &d2)
                                : query_nearer(&query, i, end, radius2, &d2);
        if (HAS_WIDE_LANES || bits)
            n += pack_lanes(d2, bits, (uint32_t)i, distance2 + n, index + n);
    }
    hits->n = n;
}

void within_runs(const photon_run *runs, size_t n, void *data)
{
    within_search *search = data;
    for (size_t i = 0; i < n; i++) {
        for (size_t begin = runs[i].begin; begin < runs[i].end; begin += PIECE) {
            size_t end = MIN(begin + PIECE, runs[i].end);
            if (search->refused ||
                !photon_hits_reserve(search->hits, search->hits->n + end - begin)) {
                search->refused = true;
                return;
            }
            within_piece(search->query, begin, end, search);
        }
    }
}
