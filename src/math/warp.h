/*
 * Sampling warps: each maps [0,1)² to a domain without rejecting, so that low-discrepancy
 * points keep their structure. Densities are with respect to the domain's own measure.
 */
#pragma once

#include "math/vec.h"

/** @brief Uniform on the unit disk (Shirley & Chiu 1997, concentric). pdf_area = 1/pi. */
vec2 warp_disk(vec2 u);
/** @brief Cosine-weighted on the hemisphere around +z. pdf_solid_angle = cos/pi. */
vec3 warp_cosine_hemisphere(vec2 u);
/** @brief Uniform on the unit sphere. pdf_solid_angle = 1/(4 pi). */
vec3 warp_sphere(vec2 u);
/** @brief 1 - cos of an angle up to a right one by its squared sine, which may be above 1
 * by rounding. Keeps all digits of small angles, where 1 - sqrt(1 - sine2) would be 0. */
static inline double one_minus_cos_of_sine2(double sine2)
{
    return sine2 / (1.0 + sqrt(fmax(1.0 - sine2, 0.0)));
}
/** @brief 1 - cos of any angle (radians), with all digits of small ones. */
static inline double one_minus_cos_of_angle(double angle)
{
    double half = sin(0.5 * angle);
    return 2.0 * half * half;
}
/** @brief Uniform in the cone around +z with the given one_minus_cos = 1 - cos(half
 * angle) (kept in this form so that narrow cones lose no precision). */
vec3 warp_cone(vec2 u, float one_minus_cos);
/** @brief pdf_solid_angle of warp_cone. */
float warp_cone_pdf(float one_minus_cos);
/** @brief Barycentric weights (of vertices 1 and 2) uniform on a triangle. */
vec2 warp_triangle(vec2 u);
