/*
 * The list: every photon is looked at, one by one. Nothing to build, nothing to get
 * wrong: the oracle that the other maps are tested against, so it shares none of their
 * code. The k nearest are kept in a bounded heap with the furthest on top (Jensen 2001).
 */
#include "photon/map/map_kind.h"
#include "photon/map/nearest.h"

static bool list_build(photon_map *map, float radius, unsigned threads, GError **error)
{
    (void)map, (void)radius, (void)threads, (void)error;
    return true;
}

static void list_free(photon_map *map)
{
    (void)map;
}

static size_t list_bytes(const photon_map *map)
{
    (void)map;
    return 0;
}

static bool list_within(const photon_map *map, const point_query *query, float radius,
                        photon_hits *hits)
{
    for (size_t i = 0; i < map->store.n; i++) {
        float distance2 = query_distance2(query, i);
        if (!(distance2 < radius * radius) || !query_accepts(query, i))
            continue;
        if (!photon_hits_reserve(hits, hits->n + 1))
            return false;
        hits->index[hits->n] = (uint32_t)i;
        hits->distance2[hits->n++] = distance2;
    }
    return true;
}

/* True if the photon at heap place a comes before the one at place b. */
static bool before(const point_query *by, const photon_hits *heap, size_t a, size_t b)
{
    return nearest_before(by, heap->index[a], heap->distance2[a], heap->index[b],
                          heap->distance2[b]);
}

static void swap(photon_hits *heap, size_t a, size_t b)
{
    uint32_t index = heap->index[a];
    float distance2 = heap->distance2[a];
    heap->index[a] = heap->index[b];
    heap->distance2[a] = heap->distance2[b];
    heap->index[b] = index;
    heap->distance2[b] = distance2;
}

static void sift_up(const point_query *by, photon_hits *heap)
{
    for (size_t i = heap->n - 1; i > 0 && before(by, heap, (i - 1) / 2, i);
         i = (i - 1) / 2)
        swap(heap, i, (i - 1) / 2);
}

static void sift_down(const point_query *by, photon_hits *heap)
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

static bool list_nearest(const photon_map *map, const point_query *query, size_t k,
                         float radius, photon_hits *hits)
{
    const photon_store *s = &map->store;
    if (!photon_hits_reserve(hits, k))
        return false;
    for (size_t i = 0; i < s->n; i++) {
        float distance2 = query_distance2(query, i);
        if (!(distance2 < radius * radius) || !query_accepts(query, i))
            continue;
        if (hits->n < k) {
            hits->index[hits->n] = (uint32_t)i;
            hits->distance2[hits->n++] = distance2;
            sift_up(query, hits);
        } else if (nearest_before(query, i, distance2, hits->index[0],
                                  hits->distance2[0])) {
            hits->index[0] = (uint32_t)i;
            hits->distance2[0] = distance2;
            sift_down(query, hits);
        }
    }
    return true;
}

const photon_map_kind photon_map_list = {
    .name = "list",
    .build = list_build,
    .free = list_free,
    .bytes = list_bytes,
    .within = list_within,
    .nearest = list_nearest,
};
