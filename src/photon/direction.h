/*
 * The point on the octahedron that a packed direction means, one or eight at a time.
 *
 * Its coordinates are small integers, exact as floats: not yet of unit length, but enough
 * to tell on which side of a plane the direction points, and eight cost little more than
 * one.
 */
#pragma once

#include "math/vec.h"
#include "photon/map/lanes.h"

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
    vec3 o = direction_octahedron(packed);
    return fused(o[2], n[2], fused(o[1], n[1], o[0] * n[0]));
}

/** @brief The flags of a packed direction. */
static inline unsigned direction_flags(uint32_t packed)
{
    return packed >> 30;
}

/** @brief Eight points on the octahedron. */
typedef struct directions8 {
    floats8 x, y, z;
} directions8;

static inline directions8 directions8_load(const uint32_t *packed)
{
    const float steps = (float)OCTAHEDRON_STEPS;
    ints8 w = load8_int(packed), sign = fill8_int(INT32_MIN);
    floats8 u = __builtin_convertvector((w & 0x7fff) - OCTAHEDRON_STEPS, floats8);
    floats8 v = __builtin_convertvector((w >> 15 & 0x7fff) - OCTAHEDRON_STEPS, floats8);
    floats8 norm = abs8(u) + abs8(v);
    ints8 fold = (ints8)max8(norm - steps, fill8(0.0f));
    return (directions8){
        .x = u - (floats8)(fold | ((ints8)u & sign)),
        .y = v - (floats8)(fold | ((ints8)v & sign)),
        .z = steps - norm,
    };
}

static inline floats8 directions8_dot(directions8 d, vec3 n)
{
    floats8 nx = fill8(n[0]), ny = fill8(n[1]), nz = fill8(n[2]);
    return fused8(d.z, nz, fused8(d.y, ny, d.x * nx));
}
