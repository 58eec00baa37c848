/*
 * Non-local means: how alike two pixels are by the patches around them, given how noisy
 * these are.
 *
 *   d(p, q) = max(0, Σ (u_p - u_q)² - (v_p + min(v_p, v_q))) / (v_p + v_q)
 *
 * where Σ is over the patch and v sums variances over it; d / k² is Rousselle's distance
 * with bandwidth k, of sums in place of a mean of ratios: a pixel that by chance has no
 * scatter counts no more than others. Rousselle, Manzi & Zwicker, "Robust Denoising using
 * Feature and Color Information", 2013.
 */
#pragma once

#include "image/denoise/plane.h"

enum { MOST_CHANNELS = 3, PATCH_PIXELS = (2 * PATCH + 1) * (2 * PATCH + 1) };

/** @brief What patches are compared by. */
typedef struct patch_source {
    const grid *g;
    int n_channels;
    const float *value[MOST_CHANNELS];
    const float *noise; /**< sum over patch and channels of the variance */
    float least;        /**< added to the noise: differences that nobody sees */
} patch_source;

/** @brief What the noise is of both halves, mirrored.
 * @param variance of the mean of both, summed over channels; its margin is filled
 * @param share of all samples that are in the first half */
void patch_noise(const grid *g, float *variance, float share, float *const noise[2]);

/** @brief d for BLOCK pixels from (x, y) on and those at (dx, dy) from them. */
void patch_distances(const patch_source *s, int x, int y, int dx, int dy, float *d);

/** @brief The same for n rows of such pixels from y on, at most ROWS_AT_ONCE. */
void patch_distances_of_rows(const patch_source *s, int x, int y, int n, int dx, int dy,
                             float (*d)[BLOCK]);

/** @brief About exp(-d), zero from 8 on. */
static inline lane_floats patch_weight(lane_floats d)
{
    lane_floats t = max_lanes(fill_lanes(1.0f) - d * 0.125f, fill_lanes(0.0f));
    t *= t;
    t *= t;
    return t * t;
}
