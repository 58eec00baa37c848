/*
 * Whether a picture of eight bits would show anything, and the exposure that does.
 */
#pragma once

#include "image/image.h"

/** @brief How a picture comes out. */
typedef enum exposure_state {
    EXPOSURE_GOOD,
    EXPOSURE_DARK,   /**< nearly black: nine tenths of what light reaches is below 1 % */
    EXPOSURE_BRIGHT, /**< nearly white: three quarters of it are above white */
    EXPOSURE_BLACK   /**< no light reaches any of it */
} exposure_state;

/** @brief Judges R, G and B at an exposure of so many stops. Pixels that no light reaches
 * do not count. An image without R, G, B is good.
 * @param better gets the stops that put nine tenths of it below half of white, in
 * quarters of a stop; `stops` for what is good or black */
exposure_state image_exposure(const image *img, float stops, float *better);
