/*
 * Some vectors at a time, a lane each.
 */
#pragma once

#include "math/lanes.h"
#include "math/vec.h"

typedef struct lane_vec3 {
    lane_floats x, y, z;
} lane_vec3;

/** @brief Dot products with n, to the bit those of fused_dot3. */
static inline lane_floats dot3_lanes(lane_vec3 v, vec3 n)
{
    lane_floats nx = fill_lanes(n[0]), ny = fill_lanes(n[1]), nz = fill_lanes(n[2]);
    return fused_lanes(v.z, nz, fused_lanes(v.y, ny, v.x * nx));
}

/** @brief A dot product spelled out operation by operation (lanes.h). */
static inline float fused_dot3(vec3 v, vec3 n)
{
    return fused(v[2], n[2], fused(v[1], n[1], v[0] * n[0]));
}
