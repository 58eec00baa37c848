/*
 * The GGX (Trowbridge-Reitz) distribution of microfacet normals with Smith's
 * height-correlated masking, single scattering, as pbrt-v4 uses it.
 *
 * Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007;
 * Heitz, "Understanding the Masking-Shadowing Function", JCGT 2014.
 * All directions are local, on the side of +z. In place of Λ the functions use the
 * stretched length s(w) = sqrt(wz² + αx² wx² + αy² wy²), for which 1 + 2Λ = s/wz:
 *
 *   G1(o) / oz          = 2 / (oz + s(o))
 *   G2(o, i) / (oz iz)  = 2 / (oz s(i) + iz s(o))
 *
 * which stay finite at grazing angles.
 */
#pragma once

#include "math/vec.h"

/** @brief Roughness along s and t of the frame. */
typedef struct ggx {
    float alpha_x, alpha_y;
} ggx;

/** @brief Roughness below which (along both axes) a surface counts as smooth. */
#define SMOOTH_ALPHA 1e-3f

static inline bool ggx_is_smooth(ggx g)
{
    return maxf(g.alpha_x, g.alpha_y) < SMOOTH_ALPHA;
}

/** @brief A distribution from two alphas >= 0; a rough one keeps at least 1e-4. */
static inline ggx ggx_make(float alpha_x, float alpha_y)
{
    ggx g = {alpha_x, alpha_y};
    if (ggx_is_smooth(g))
        return (ggx){0.0f, 0.0f};
    return (ggx){maxf(alpha_x, 1e-4f), maxf(alpha_y, 1e-4f)};
}

/** @brief Whether it is the same along all axes. */
static inline bool ggx_is_round(ggx g)
{
    return fabsf(g.alpha_x - g.alpha_y) <= 1e-6f * g.alpha_x;
}

/** @brief s(w), see above. */
static inline float ggx_stretched(ggx g, vec3 w)
{
    return sqrtf(w[2] * w[2] + square(g.alpha_x * w[0]) + square(g.alpha_y * w[1]));
}

/** @brief D(m): normals per solid angle and area, sr⁻¹. */
static inline float ggx_density(ggx g, vec3 m)
{
    float q = square(m[0] / g.alpha_x) + square(m[1] / g.alpha_y) + m[2] * m[2];
    return INV_PI_F / (g.alpha_x * g.alpha_y * q * q);
}

/** @brief pdf_solid_angle of ggx_sample_visible. */
static inline float ggx_visible_pdf(ggx g, vec3 wo, vec3 m)
{
    return ggx_density(g, m) * maxf(0.0f, dot3(wo, m)) * 2.0f /
           (wo[2] + ggx_stretched(g, wo));
}

/** @brief G2(wo, wi) / G1(wo): the weight of a sampled visible normal. Signs of z are
 * left out, so wi may be below. */
static inline float ggx_visible_weight(ggx g, vec3 wo, vec3 wi)
{
    float co = fabsf(wo[2]), ci = fabsf(wi[2]);
    float so = ggx_stretched(g, wo), si = ggx_stretched(g, wi);
    return ci * (co + so) / (ci * so + co * si);
}

/** @brief A normal in proportion to its area seen from wo (wo[2] > 0). */
vec3 ggx_sample_visible(ggx g, vec3 wo, vec2 u);

enum { GGX_FEW = 8 };

/** @brief Few points u of ggx_sample_visible that stand for all: a lattice, shifted by
 * numbers of wo's own, so that over many wo their mean is exact. */
void ggx_few_points(vec3 wo, vec2 u[GGX_FEW]);
