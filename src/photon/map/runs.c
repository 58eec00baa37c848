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

/* What does not change is copied: the compiler can not know that writing hits leaves it
 * as it is. */
static inline __attribute__((always_inline)) bool
within_by(point_query query, const photon_run *runs, size_t n, within_search *search)
{
    photon_hits *hits = search->hits;
    const bool selects = query_selects(&query);
    const float radius2 = search->radius2;
    for (size_t k = 0; k < n; k++) {
        for (size_t i = runs[k].begin; i < runs[k].end;) {
            size_t end = MIN(i + PIECE, runs[k].end);
            if (!photon_hits_reserve(hits, hits->n + end - i + LANES))
                return false;
            for (; i < end; i += LANES) {
                lane_floats d2;
                unsigned bits = selects ? query_block(&query, i, end, radius2, &d2)
                                        : query_nearer(&query, i, end, radius2, &d2);
                if (HAS_WIDE_LANES || bits)
                    hits->n +=
                        pack_lanes(d2, bits, (uint32_t)i, hits->distance2 + hits->n,
                                   hits->index + hits->n);
            }
            i = end;
        }
    }
    return true;
}

void within_runs(const photon_run *runs, size_t n, void *data)
{
    within_search *search = data;
    point_query query = *search->query;
    if (search->refused)
        return;
    if (query_selects(&query) || query.flat) {
        search->refused = !within_by(query, runs, n, search);
        return;
    }
    query.one_sided = query.flat = false; /* known, these fall out of the loop */
    query.normal = query.curve = NULL;
    query.face = 0;
    search->refused = !within_by(query, runs, n, search);
}
