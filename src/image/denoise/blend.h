/*
 * From what the regressions say to the picture: which bandwidth, and how much of what
 * they took out comes back.
 */
#pragma once

#include "image/denoise/regress.h"

typedef struct blend {
    const regression *done;
    float share;                   /**< of all samples that are in the first half */
    const float *variance;         /**< of the luminance of the mean, mirrored */
    const float *raw[N_HALVES][3]; /**< as rendered: before outliers were cut */
    float *out[3];                 /**< may be sums of the regression */
} blend;

/** @brief Luminance of linear RGB. */
static inline float luminance(float r, float g, float b)
{
    return 0.2126f * r + 0.7152f * g + 0.0722f * b;
}

bool blend_all(const blend *b, GError **error);
