/*
 * Photons in a kd-tree (kdtree.h).
 */
#include "base/memory.h"
#include "photon/map/kdtree.h"
#include "photon/map/map_kind.h"

static void map_kdtree_free(photon_map *map)
{
    kdtree_free(map->index);
}

static bool map_kdtree_build(photon_map *map, float radius, unsigned threads,
                             GError **error)
{
    (void)radius;
    point_arrays points = photon_points(&map->store);
    size_t *order = kdtree_sort(&points, threads, error);
    bool sorted = order && photon_store_permute(&map->store, order, threads, error);
    big_free(order);
    if (!sorted)
        return false;
    points = photon_points(&map->store);
    map->index = kdtree_build(&points, threads, error);
    return map->index != NULL;
}

static size_t map_kdtree_bytes(const photon_map *map)
{
    return kdtree_bytes(map->index);
}

static bool map_kdtree_nearest(const photon_map *map, const point_query *query, size_t k,
                               float radius, photon_hits *hits)
{
    nearest_set set;
    if (!nearest_begin(&set, query, k, radius, hits))
        return false;
    kdtree_nearest(map->index, &set);
    return true;
}

static void map_kdtree_runs(const photon_map *map, vec3 p, float radius,
                            photon_run_visitor visit, void *data)
{
    const point_arrays points = photon_points(&map->store);
    kdtree_runs(map->index, &points, p, radius, visit, data);
}

const photon_map_kind photon_map_kdtree = {
    .name = "kdtree",
    .build = map_kdtree_build,
    .free = map_kdtree_free,
    .bytes = map_kdtree_bytes,
    .runs = map_kdtree_runs,
    .within = photon_map_within_runs,
    .nearest = map_kdtree_nearest,
};
