/*
 * The point on the octahedron that a packed direction means, one or some at a time.
 *
 * Its coordinates are small integers, exact as floats: not yet of unit length, but enough
 * to tell on which side of a plane the direction points, and some cost little more than
 * one.
 */
#pragma once

#include "math/vec_lanes.h"

/** Steps from the centre of the square to its edge; the L1 norm of the points. */
enum { OCTAHEDRON_STEPS = 16383 }; /* math: what 15 bits of an axis hold */

static inline vec3 direction_octahedron(uint32_t packed)
{
    int u = (int)(packed & 0x7fff) - OCTAHEDRON_STEPS;
    int v = (int)(packed >> 15 & 0x7fff) - OCTAHEDRON_STEPS;
    int z = OCTAHEDRON_STEPS - (u < 0 ? -u : u) - (v < 0 ? -v : v);
    int fold = z < 0 ? -z : 0;
    return vec3_make((float)(u < 0 ? u + fold : u - fold),
                     (float)(v < 0 ? v + fold : v - fold), (float)z);
}

/** @brief Dot product of n with the octahedron's point: same sign as wi·n. */
static inline float direction_dot(uint32_t packed, vec3 n)
{
    return fused_dot3(direction_octahedron(packed), n);
}

/** @brief The flags of a packed direction. */
static inline unsigned direction_flags(uint32_t packed)
{
    return packed >> 30;
}

/** @brief A lane each: points on the octahedron. */
static inline lane_vec3 lane_directions_of(lane_ints w)
{
    const float steps = (float)OCTAHEDRON_STEPS;
    lane_floats u = __builtin_convertvector((w & 0x7fff) - OCTAHEDRON_STEPS, lane_floats);
    lane_floats v =
        __builtin_convertvector((w >> 15 & 0x7fff) - OCTAHEDRON_STEPS, lane_floats);
    lane_floats norm = abs_lanes(u) + abs_lanes(v);
    lane_ints fold = (lane_ints)max_lanes(norm - steps, fill_lanes(0.0f));
    return (lane_vec3){
        .x = u - (lane_floats)(fold | ((lane_ints)u & INT32_MIN)),
        .y = v - (lane_floats)(fold | ((lane_ints)v & INT32_MIN)),
        .z = steps - norm,
    };
}

/** @brief Bits of packed directions on the side of n. */
static inline unsigned directions_on_side(lane_ints packed, vec3 n)
{
    return bits_below(fill_lanes(0.0f), dot3_lanes(lane_directions_of(packed), n));
}
