/*
 * A point set: points that keep the numbers that their owner calls them by, for owners
 * who do not put their own arrays in order.
 *
 * Of points that tie for the k-th place the order is that of x, y, z, number.
 */
#pragma once

#include "photon/map/point_index.h"

typedef struct point_set point_set;

/** @brief Over n points, 0 allowed, which are copied; number i is points[i]. The result
 * does not depend on the number of threads. */
point_set *point_set_build(const vec3 *points, size_t n, unsigned threads,
                           GError **error);
void point_set_free(point_set *set);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(point_set, point_set_free)

/** @brief Which point is at a place of the sorted order, in which near points follow one
 * another. @param place below n */
size_t point_set_number(const point_set *set, size_t place);
/** @brief Where that point is. */
vec3 point_set_position(const point_set *set, size_t place);

/** @brief Numbers of all points within radius, in no order. hits->n is reset first.
 *  @return false when memory is refused */
bool point_set_within(const point_set *set, vec3 p, float radius, point_hits *hits);
/** @brief The k nearest within radius (INFINITY allowed), in no order; else as within. */
bool point_set_nearest(const point_set *set, vec3 p, size_t k, float radius,
                       point_hits *hits);
