/*
 * The query: where one asks, how distance is measured, and which points count. The scalar
 * form is what "found" means; the form for a lane each gives the same bits.
 *
 *   distance2   (dx² + dy²) + dz², or (d·n / flatten)² where that is larger
 *
 * What lies at the points is their owner's, and so is the answer whether one counts: the
 * index hands it places in the sorted arrays.
 *
 * Rounding is monotone at each step, so |dx| < r holds in floats for every point within
 * r: a structure that looks at all x in [p - r, p + r] misses none.
 */
#pragma once

#include "math/vec_lanes.h"
#include "photon/map/points.h"

/** @brief What an owner of points says of those at places of the sorted arrays. */
typedef struct point_rules {
    /** Whether the point counts. NULL: all do. */
    bool (*accepts)(const void *data, size_t place);
    /** The same of the points first .. first + LANES - 1: those of bits that count. */
    unsigned (*accepted)(const void *data, size_t first, unsigned bits);
    /** Order of two points that lie at one place in space, as of qsort. NULL: that of the
     * sorted arrays. */
    int (*compare)(const void *data, size_t a, size_t b);
} point_rules;

typedef struct point_query {
    vec3 p;
    vec3 n;                   /**< unit; of flat ones */
    bool flat;                /**< distance is the larger of |d| and |d·n| inv_flatten */
    float inv_flatten;        /**< 1/flatten */
    const point_rules *rules; /**< NULL: every point counts */
    const void *data;         /**< handed to the rules */
} point_query;

/** @brief True if some points may not count. */
static inline bool query_selects(const point_query *query)
{
    return query->rules && query->rules->accepts;
}

static inline bool query_accepts(const point_query *query, size_t place)
{
    return !query_selects(query) || query->rules->accepts(query->data, place);
}

/** @brief Squared distance to point i. */
static inline float query_distance2(const point_query *query, const point_arrays *points,
                                    size_t i)
{
    vec3 d = vec3_make(points->x[i], points->y[i], points->z[i]) - query->p;
    float d2 = fused_dot3(d, d);
    if (!query->flat)
        return d2;
    float height = fused_dot3(d, query->n) * query->inv_flatten;
    float height2 = height * height;
    return height2 > d2 ? height2 : d2;
}

/** @brief query_distance2 of points i .. i + LANES - 1. */
static inline lane_floats query_distance2_lanes(const point_query *query,
                                                const point_arrays *points, size_t i)
{
    lane_floats x = load_lanes(points->x + i) - query->p[0],
                y = load_lanes(points->y + i) - query->p[1],
                z = load_lanes(points->z + i) - query->p[2];
    lane_floats d2 = fused_lanes(z, z, fused_lanes(y, y, x * x));
    if (!query->flat)
        return d2;
    lane_floats height = dot3_lanes((lane_vec3){x, y, z}, query->n) * query->inv_flatten;
    return max_lanes(height * height, d2);
}

/** @brief Bits of those points of i .. min(i + LANES, end) - 1 that are nearer than
 * limit, counting or not; *distance2 of all. */
static inline __attribute__((always_inline)) unsigned
query_nearer(const point_query *query, const point_arrays *points, size_t i, size_t end,
             float limit, lane_floats *distance2)
{
    *distance2 = query_distance2_lanes(query, points, i);
    return bits_below(*distance2, fill_lanes(limit)) & bits_first(end - i);
}

/** @brief query_nearer that count. */
static inline __attribute__((always_inline)) unsigned
query_block(const point_query *query, const point_arrays *points, size_t i, size_t end,
            float limit, lane_floats *distance2)
{
    unsigned bits = query_nearer(query, points, i, end, limit, distance2);
    if (bits && query_selects(query))
        bits = query->rules->accepted(query->data, i, bits);
    return bits;
}
