/*
 * The list: every point is looked at, one by one. Nothing to build, nothing to get wrong:
 * the oracle that the other kinds are tested against, so it shares none of their code,
 * and asks of the owner's rules only the scalar form. The k nearest are kept in a bounded
 * heap with the furthest on top (Jensen 2001).
 */
#include "photon/map/index_kind.h"
#include "photon/map/nearest.h"

static void list_runs(const point_index *index, vec3 p, float radius,
                      point_run_visitor visit, void *data)
{
    (void)p, (void)radius;
    const point_run all = {0, index->points.n};
    visit(&all, 1, data);
}

static bool list_within(const point_index *index, const point_query *query, float radius,
                        point_hits *hits)
{
    for (size_t i = 0; i < index->points.n; i++) {
        float distance2 = query_distance2(query, &index->points, i);
        if (!(distance2 < radius * radius) || !query_accepts(query, i))
            continue;
        if (!point_hits_reserve(hits, hits->n + 1))
            return false;
        hits->index[hits->n] = (uint32_t)i;
        hits->distance2[hits->n++] = distance2;
    }
    return true;
}

/* True if the point at heap place a comes before the one at place b. */
static bool before(const nearest_set *by, const point_hits *heap, size_t a, size_t b)
{
    return nearest_before(by, heap->index[a], heap->distance2[a], heap->index[b],
                          heap->distance2[b]);
}

static void swap(point_hits *heap, size_t a, size_t b)
{
    uint32_t index = heap->index[a];
    float distance2 = heap->distance2[a];
    heap->index[a] = heap->index[b];
    heap->distance2[a] = heap->distance2[b];
    heap->index[b] = index;
    heap->distance2[b] = distance2;
}

static void sift_up(const nearest_set *by, point_hits *heap)
{
    for (size_t i = heap->n - 1; i > 0 && before(by, heap, (i - 1) / 2, i);
         i = (i - 1) / 2)
        swap(heap, i, (i - 1) / 2);
}

static void sift_down(const nearest_set *by, point_hits *heap)
{
    for (size_t i = 0;;) {
        size_t last = i;
        for (size_t child = 2 * i + 1; child <= 2 * i + 2 && child < heap->n; child++)
            last = before(by, heap, last, child) ? child : last;
        if (last == i)
            return;
        swap(heap, i, last);
        i = last;
    }
}

static bool list_nearest(const point_index *index, const point_query *query, size_t k,
                         float radius, point_hits *hits)
{
    const nearest_set by = {.points = &index->points, .query = query};
    if (!point_hits_reserve(hits, k))
        return false;
    for (size_t i = 0; i < by.points->n; i++) {
        float distance2 = query_distance2(query, &index->points, i);
        if (!(distance2 < radius * radius) || !query_accepts(query, i))
            continue;
        if (hits->n < k) {
            hits->index[hits->n] = (uint32_t)i;
            hits->distance2[hits->n++] = distance2;
            sift_up(&by, hits);
        } else if (nearest_before(&by, i, distance2, hits->index[0],
                                  hits->distance2[0])) {
            hits->index[0] = (uint32_t)i;
            hits->distance2[0] = distance2;
            sift_down(&by, hits);
        }
    }
    return true;
}

const point_index_kind point_index_list = {
    .name = "list",
    .runs = list_runs,
    .within = list_within,
    .nearest = list_nearest,
};
