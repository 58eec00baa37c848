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
/** @brief Uniform in the cone around +z with the given one_minus_cos = 1 - cos(half
 * angle) (kept in this form so that narrow cones lose no precision). */
vec3 warp_cone(vec2 u, float one_minus_cos);
/** @brief pdf_solid_angle of warp_cone. */
float warp_cone_pdf(float one_minus_cos);
/** @brief Barycentric weights (of vertices 1 and 2) uniform on a triangle. */
vec2 warp_triangle(vec2 u);
