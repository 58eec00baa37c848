/*
 * Kernels of the density estimate: κ(d/r), and the area ∫∫ κ(s) s ds dθ that normalises
 * it. With t = d²/r²:
 *
 *   constant       1                                                 area  π r²
 *   cone           1 - √t / k                                        π r² (1 - 2/(3k))
 *   gaussian       α (1 - (1 - e^(-β t/2)) / (1 - e^-β))             π r² times 0.5312
 *   epanechnikov   1 - t                                             π r² / 2
 *
 * Cone: Jensen 1996. Gaussian: Jensen 2001, α = 0.918, β = 1.953. It is often divided by
 * π r² as if it were normalised; its integral over the disc is smaller:
 *   π r² ∫₀¹ κ dt = π r² α (1 - (1 - (2/β)(1 - e^(-β/2))) / (1 - e^-β)),
 * and this is what we divide by, so that an even field of photons is seen as it is.
 */
#pragma once

#include "math/lanes.h"
#include "settings/settings.h"

/** @brief A kernel with its parameter. */
typedef struct kernel {
    kernel_choice choice;
    float cone_k; /**< >= 1, of the cone (Jensen 1996): κ = 1 - d/(k r) */
} kernel;

/** math: Jensen's filter */
#define GAUSSIAN_ALPHA 0.918f
#define GAUSSIAN_BETA 1.953f
#define GAUSSIAN_RANGE (1.0f - expf(-GAUSSIAN_BETA))

/** @brief κ at squared distance d2 <= r2. */
float kernel_eval(const kernel *k, float d2, float r2);
/** @brief ∫∫ κ(s) s ds dθ over the disc of squared radius r2, m². */
float kernel_area(const kernel *k, float r2);

/** @brief e^-x for 0 <= x < 1, to 1e-7: Taylor's series around the middle. */
static inline lane_floats exp_negative_lanes(lane_floats x)
{
    /* math: the series */
    static const float inverse_factorial[] = {
        1.0f, 1.0f, 1.0f / 2, 1.0f / 6, 1.0f / 24, 1.0f / 120, 1.0f / 720, 1.0f / 5040};
    lane_floats y = 0.5f - x, sum = fill_lanes(inverse_factorial[7]);
    for (int i = 6; i >= 0; i--)
        sum = fused_lanes(sum, y, fill_lanes(inverse_factorial[i]));
    return expf(-0.5f) * sum;
}

/** @brief kernel_eval of a lane each, to rounding. Lanes with d2 > r2 mean nothing. */
static inline lane_floats kernel_eval_lanes(const kernel *k, lane_floats d2, float inv_r2)
{
    lane_floats t = d2 * inv_r2;
    switch (k->choice) {
    case KERNEL_CONE:
        return 1.0f - sqrt_lanes(t) * (1.0f / k->cone_k);
    case KERNEL_GAUSSIAN:
        return GAUSSIAN_ALPHA *
               (1.0f - (1.0f - exp_negative_lanes(t * (0.5f * GAUSSIAN_BETA))) *
                           (1.0f / GAUSSIAN_RANGE));
    case KERNEL_EPANECHNIKOV:
        return 1.0f - t;
    case KERNEL_CONSTANT:
    default:
        return fill_lanes(1.0f);
    }
}
