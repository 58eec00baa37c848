/*
 * The kd-tree over positions.
 *
 *   order = kdtree_sort(points) ─► the owner puts its arrays in this order
 *                               ─► kdtree_build(sorted points) ─► searches
 *
 * What a search finds are places in the sorted arrays.
 */
#pragma once

#include "photon/map/nearest.h"

typedef struct kdtree kdtree;

/** @brief The order that a tree wants points in, fewer than 2^32, owned by the caller
 * (big_free); NULL when memory is refused. It does not depend on the number of threads.
 */
size_t *kdtree_sort(const point_arrays *points, workers by, GError **error);
/** @brief Over points in this order: at least one. They are not kept.
 * @param radii of balls around them, that kdtree_runs_along asks for; NULL: points */
kdtree *kdtree_build(const point_arrays *sorted, const float *radii, workers by,
                     GError **error);
void kdtree_free(kdtree *tree);
size_t kdtree_bytes(const kdtree *tree); /**< memory kept */

/** @brief Lets what is nearest enter the set, and cuts it. */
void kdtree_nearest(const kdtree *tree, nearest_set *set);
/** @brief The nearest alone, by a query that selects nothing, into the set, which must be
 * of one. Much faster than kdtree_nearest. */
void kdtree_nearest_one(const kdtree *tree, nearest_set *set);
/** @brief Visits runs that hold every point within radius of p, as
 * point_index_kind.runs. */
void kdtree_runs(const kdtree *tree, const point_arrays *points, vec3 p, float radius,
                 point_run_visitor visit, void *data);
/** @brief Visits runs that hold every point whose ball a ray meets before length, in
 * order, none of them twice. @param direction unit @param length m, INFINITY allowed */
void kdtree_runs_along(const kdtree *tree, const point_arrays *points, vec3 from,
                       vec3 direction, float length, point_run_visitor visit, void *data);
