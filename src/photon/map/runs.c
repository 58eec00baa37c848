#include "photon/map/runs.h"

#include <glib.h>

/* Room is made for a piece at a time, as if all of it were found. */
enum { PIECE = 1 << 12 }; /* size: points */

/* What does not change is copied, and so is what does: the compiler can not know that
 * writing to arrays leaves it as it is. */
static inline __attribute__((always_inline)) bool
within_by(point_query query, const point_run *runs, size_t n_runs, within_search *search)
{
    const point_arrays points = *search->points;
    point_hits *hits = search->hits;
    const float radius2 = search->radius2;
    float *distance2 = hits->distance2;
    uint32_t *index = hits->index;
    size_t n = hits->n;
    for (const point_run *run = runs; run < runs + n_runs; run++) {
        for (size_t i = run->begin; i < run->end;) {
            size_t end = MIN(i + PIECE, run->end);
            if (n + (end - i) + LANES > hits->capacity) {
                hits->n = n;
                if (!point_hits_reserve(hits, n + (end - i) + LANES))
                    return false;
                distance2 = hits->distance2;
                index = hits->index;
            }
            for (; i < end; i += LANES) {
                lane_floats d2;
                unsigned bits = query_block(&query, &points, i, end, radius2, &d2);
                if (HAS_WIDE_LANES || bits)
                    n += pack_lanes(d2, bits, (uint32_t)i, distance2 + n, index + n);
            }
            i = end;
        }
    }
    hits->n = n;
    return true;
}

void within_runs(const point_run *runs, size_t n, void *data)
{
    within_search *search = data;
    point_query query = *search->query;
    if (search->refused)
        return;
    if (query_selects(&query) || query.flat) {
        search->refused = !within_by(query, runs, n, search);
        return;
    }
    query.flat = false; /* known, these fall out of the loop */
    query.rules = NULL;
    search->refused = !within_by(query, runs, n, search);
}
