/*
 * Local frames: n is +z. Directions of BSDFs and sampling warps are in such a frame.
 */
#pragma once

#include "math/vec.h"

/** @brief An orthonormal right-handed basis; columns in world coordinates. */
typedef struct frame {
    vec3 s, t, n;
} frame;

/** @brief A frame around a unit normal (Duff et al., "Building an Orthonormal Basis,
 *  Revisited", 2017). */
static inline frame frame_from_normal(vec3 n)
{
    float sign = copysignf(1.0f, n[2]);
    float a = -1.0f / (sign + n[2]);
    float b = n[0] * n[1] * a;
    return (frame){
        .s = vec3_make(1.0f + sign * n[0] * n[0] * a, sign * b, -sign * n[0]),
        .t = vec3_make(b, sign + n[1] * n[1] * a, -n[1]),
        .n = n,
    };
}

/** @brief A frame around unit n whose s lies along the part of tangent orthogonal to n;
 * any frame around n when tangent is zero or parallel to it. */
static inline frame frame_from_tangent(vec3 n, vec3 tangent)
{
    vec3 s = tangent - n * dot3(n, tangent);
    float length2 = length3_2(s);
    if (!(length2 > 1e-12f * length3_2(tangent)) || !isfinite(length2))
        return frame_from_normal(n);
    s /= sqrtf(length2);
    return (frame){.s = s, .t = cross3(n, s), .n = n};
}

static inline vec3 frame_to_local(const frame *f, vec3 world)
{
    return vec3_make(dot3(world, f->s), dot3(world, f->t), dot3(world, f->n));
}

static inline vec3 frame_to_world(const frame *f, vec3 local)
{
    return f->s * local[0] + f->t * local[1] + f->n * local[2];
}
