/*
 * First-order regression with non-local weights (Bitterli et al., "Nonlinearly Weighted
 * First-order Regression for Denoising Monte Carlo Renderings", 2016).
 *
 *   around every second pixel: window ─► weights by patches of the other half
 *                                    ─► colours ≈ a + b · features (least squares)
 *                                    ─► what that says of all pixels of the window
 *
 * A pixel becomes the weighted mean of what the windows it lies in say of it. Both halves
 * are filtered, each with weights from the other, so that weights know nothing of the
 * noise they are to remove; and with two bandwidths.
 *
 * Strips of rows work at once, first the even ones, then the odd: no two that do share a
 * pixel, and each pixel's sums have one order.
 */
#pragma once

#include "image/denoise/patch.h"

enum {
    SIDE = 16,   /**< of a window, pixels */
    N_BANDS = 2, /**< bandwidths: 1 and 1/2 */
    N_HALVES = 2,
    MOST_FEATURES = 24,
    N_SUMS = 4, /**< of red, green, blue, and of the weights */
};

typedef struct regression {
    grid g;
    int step; /**< every so manieth pixel in both directions has a window, which is even
                 about the square of pixels that it stands for: 2 or 4 */
    int n_features;
    const float *feature[MOST_FEATURES];
    const float *doubt[MOST_FEATURES]; /**< squared error of the features, planes */
    float least[MOST_FEATURES];        /**< a feature that scatters less in a window
                                           tells nothing there */
    patch_source alike[N_HALVES];      /**< weights that filter half h: of the other */
    const float *color[N_HALVES][3];   /**< mirrored planes */
    float *sum[N_BANDS][N_HALVES][N_SUMS]; /**< the result; zeroed */
} regression;

/** @return false: cancelled */
bool regress(const regression *r);
