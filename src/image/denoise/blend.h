/*
 * From what the regressions say to the picture: which bandwidth, and how much of what
 * they took out comes back.
 */
#pragma once

#include "image/denoise/regress.h"
#include "math/vec.h"

typedef struct blend {
    const regression *done;
    float share;                   /**< of all samples that are in the first half */
    float distinct;                /**< denoise_size.distinct */
    const float *variance;         /**< of the luminance of the mean, mirrored */
    const float *raw[N_HALVES][3]; /**< as rendered: before outliers were cut */
    float *const *albedo;          /**< light was divided by, three planes; or NULL */
    float brightness;              /**< denoise_size.brightness */
    float *out[3];                 /**< may be sums of the regression */
} blend;

/** @brief Luminance of linear RGB. */
static inline lane_floats luminance_lanes(lane_floats r, lane_floats g, lane_floats b)
{
    return 0.2126f * r + 0.7152f * g + 0.0722f * b;
}

/* Light is divided by no less: where nearly nothing is reflected, noise would be blown up
   and taken back in vain. */
#define LEAST_ALBEDO 0.02f

/** @brief What light was divided by there. @param albedo three planes, or NULL */
static inline lane_floats divisor(float *const *albedo, int c, size_t at)
{
    const lane_floats least = fill_lanes(LEAST_ALBEDO);
    return albedo ? max_lanes(load_lanes(albedo[c] + at), least) : fill_lanes(1.0f);
}

static inline lane_floats mean_divisor(float *const *albedo, size_t at)
{
    return luminance_lanes(divisor(albedo, 0, at), divisor(albedo, 1, at),
                           divisor(albedo, 2, at));
}

bool blend_all(const blend *b, GError **error);
