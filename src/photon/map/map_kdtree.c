/*
 * The kd-tree (kdtree.h) as a kind of point index.
 */
#include "photon/map/index_kind.h"
#include "photon/map/kdtree.h"

static size_t *tree_sort(point_index *index, float radius, workers by, GError **error)
{
    (void)radius;
    return kdtree_sort(&index->points, by, error);
}

static bool tree_build(point_index *index, workers by, GError **error)
{
    index->structure = kdtree_build(&index->points, NULL, by, error);
    return index->structure != NULL;
}

static void tree_free(point_index *index)
{
    kdtree_free(index->structure);
}

static size_t tree_bytes(const point_index *index)
{
    return kdtree_bytes(index->structure);
}

static void tree_runs(const point_index *index, vec3 p, float radius,
                      point_run_visitor visit, void *data)
{
    kdtree_runs(index->structure, &index->points, p, radius, visit, data);
}

static bool tree_nearest(const point_index *index, const point_query *query, size_t k,
                         float radius, point_hits *hits)
{
    nearest_set set;
    if (!nearest_begin(&set, &index->points, query, k, radius, hits))
        return false;
    if (k == 1 && !query_selects(query))
        kdtree_nearest_one(index->structure, &set);
    else
        kdtree_nearest(index->structure, &set);
    return true;
}

const point_index_kind point_index_kdtree = {
    .name = "kdtree",
    .sort = tree_sort,
    .build = tree_build,
    .free = tree_free,
    .bytes = tree_bytes,
    .runs = tree_runs,
    .nearest = tree_nearest,
};
