/*
 * Features are noisy too, where pixels are at edges, out of focus or see photons: each is
 * smoothed by non-local means with weights from its own other half.
 */
#pragma once

#include "image/denoise/patch.h"

/** @brief Both halves of a feature. */
typedef struct noisy_feature {
    const grid *g;
    int n_channels;
    float *half[2][MOST_CHANNELS]; /**< mirrored planes */
    float share;                   /**< of all samples that are in the first half */
} noisy_feature;

/** @brief The mean of the halves, smoothed, and the square of the error that is left.
 * @param out mirrored planes
 * @param doubt that of a channel, mean over them
 * @return false: cancelled or no memory */
bool prefilter(const noisy_feature *f, float *const out[MOST_CHANNELS], float *doubt,
               GError **error);
