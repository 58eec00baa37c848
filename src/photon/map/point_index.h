/*
 * The point index: which of many positions are near a place. Three structures behind one
 * interface, same answers:
 *
 *   list     no structure, scalar loops: the oracle of the others
 *   kdtree   balanced, sixteen-wide; n log n to build; indifferent to radius and density
 *   grid     cells of about the radius; linear to build
 *
 *   x[] y[] z[] ──► point_index_build ──► x[] y[] z[] sorted   searches read these
 *                                    └──► order[]              for what lies at the
 * points
 *
 * It knows positions only. What lies at them (photons, radii, irradiance) is in typed
 * arrays of their owner, who puts them in the same order; searches give places in it.
 * Where some points are not to count, the owner's rules say so while searching
 * (query.h): such a point never takes a place among the k nearest.
 *
 * Built once, const afterwards; queries write only into the caller's struct. A point is
 * "within r" if its squared distance is < r². Points that tie for the k-th place are
 * taken in the order of x, y, z, then as their owner's rules say: so all structures find
 * the same points to the bit.
 *
 * Memory kept: the kdtree 1.6 bytes a point, the grid at most 4.
 */
#pragma once

#include "photon/map/runs.h"
#include "settings/settings.h"

typedef struct point_index point_index;

/**
 * @brief Sorts points and makes what searches need. The result does not depend on the
 *        number of threads.
 * @param choice not MAP_AUTO
 * @param points 0 allowed. The arrays stay the caller's and are to outlive the index, but
 *        are exchanged for sorted ones, also on failure
 * @param radius that searches will mostly use, m; 0 if unknown
 * @param order gets the order that they were put in: place i has what was order[i]; owned
 *        by the caller (big_free). NULL: they stay as they were, or it failed
 */
point_index *point_index_build(map_choice choice, point_arrays *points, float radius,
                               workers by, size_t **order, GError **error);
void point_index_free(point_index *index);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(point_index, point_index_free)
size_t point_index_bytes(const point_index *index); /**< memory kept, without points */

/** @brief Visits runs that hold every point within radius of p, none of them twice. */
void point_index_runs(const point_index *index, vec3 p, float radius,
                      point_run_visitor visit, void *data);
/** @brief All points within radius, in no order. hits->n is reset first.
 *  @return false when memory is refused */
bool point_index_within(const point_index *index, const point_query *query, float radius,
                        point_hits *hits);
/** @brief The k nearest within radius (INFINITY allowed), in no order; else as within. */
bool point_index_nearest(const point_index *index, const point_query *query, size_t k,
                         float radius, point_hits *hits);
