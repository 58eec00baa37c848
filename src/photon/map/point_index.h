/*
 * The point index: which of many positions are near a place. It sorts positions and tells
 * neighbours by the numbers that its owner has given them; what lies at the points is in
 * typed arrays of the owner's own, by those numbers.
 *
 * Built once, const afterwards; queries write only into the caller's struct. A point is
 * "within r" if its squared distance is < r². Points that tie for the k-th place are
 * taken in the order of x, y, z, number.
 */
#pragma once

#include "photon/map/map.h"

typedef struct point_index point_index;

/** @brief Over n points, 0 allowed, which are copied; number i is points[i]. The result
 * does not depend on the number of threads.
 * @param normals packed (direction_pack), copied too; NULL: no one asks for sides */
point_index *point_index_build(const vec3 *points, const uint32_t *normals, size_t n,
                               unsigned threads, GError **error);
void point_index_free(point_index *index);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(point_index, point_index_free)

/** @brief The permutation: which point is at a place of the sorted order, in which near
 * points follow one another. @param place below n */
size_t point_index_number(const point_index *index, size_t place);
/** @brief Where that point is. */
vec3 point_index_position(const point_index *index, size_t place);

/** @brief Numbers of all points within radius, in no order. hits->n is reset first.
 *  @return false when memory is refused */
bool point_index_within(const point_index *index, vec3 p, float radius,
                        photon_hits *hits);
/** @brief The k nearest within radius (INFINITY allowed), in no order; else as within. */
bool point_index_nearest(const point_index *index, vec3 p, size_t k, float radius,
                         photon_hits *hits);
/** @brief The same among points whose normals make less than a right angle with n: these
 * the index must have been given. */
bool point_index_nearest_facing(const point_index *index, vec3 p, vec3 n, size_t k,
                                float radius, photon_hits *hits);
