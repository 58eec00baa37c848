/*
 * One bilinear patch in double precision:
 *
 *   p01 ────── p11        p(u, v) = p00 + u a + v b + uv e
 *    │          │         a = p10 - p00, b = p01 - p00, e = p11 - p10 - p01 + p00
 *    │ v        │
 *   p00 ──u── p10         ∂p/∂u × ∂p/∂v = a×b + u a×e + v e×b
 *
 * The cross product, whose length is the area element, is linear in u and v: its length
 * is convex, and largest at a corner.
 */
#pragma once

#include "shape/mesh_triangle.h"

typedef struct patch {
    dvec3 p00, a, b, e;
} patch;

static inline patch patch_from_corners(dvec3 p00, dvec3 p10, dvec3 p01, dvec3 p11)
{
    return (patch){p00, p10 - p00, p01 - p00, p11 - p10 - p01 + p00};
}

static inline dvec3 patch_point(const patch *s, double u, double v)
{
    return s->p00 + u * s->a + v * s->b + u * v * s->e;
}

/** @brief ∂p/∂u × ∂p/∂v. */
static inline dvec3 patch_cross(const patch *s, double u, double v)
{
    return dvec3_cross(s->a + v * s->e, s->b + u * s->e);
}

/** @brief The nearest t in (t_min, t_max) where o + t d meets the patch (Reshetov, "Cool
 * Patches: A Geometric Approach to Ray/Bilinear Patch Intersections", 2019). d need not
 * be unit. */
bool patch_intersect(const patch *s, dvec3 o, dvec3 d, const double range[2], double *t,
                     double uv[2]);
double patch_area(const patch *s);
/** @brief The largest area element. */
double patch_largest_element(const patch *s);
