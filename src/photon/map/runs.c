#include "photon/map/runs.h"

#include <glib.h>

/* Room is made for a piece at a time, as if all of it were found. */
enum { PIECE = 1 << 12 }; /* size: points */

/* What does not change is copied: the compiler can not know that writing hits leaves it
 * as it is. */
static inline __attribute__((always_inline)) bool
within_by(point_query query, const point_run *runs, size_t n, within_search *search)
{
    const point_arrays points = *search->points;
    point_hits *hits = search->hits;
    const float radius2 = search->radius2;
    for (size_t k = 0; k < n; k++) {
        for (size_t i = runs[k].begin; i < runs[k].end;) {
            size_t end = MIN(i + PIECE, runs[k].end);
            if (!point_hits_reserve(hits, hits->n + end - i + LANES))
                return false;
            for (; i < end; i += LANES) {
                lane_floats d2;
                unsigned bits = query_block(&query, &points, i, end, radius2, &d2);
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
