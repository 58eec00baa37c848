/*
 * Functions of wavelength on a grid of whole nanometres, 360..830, piecewise linear
 * between and zero outside: cheap to evaluate, and products integrate exactly.
 */
#pragma once

#include "color/spectrum.h"

enum {
    GRID_FIRST = 360, /**< nm */
    GRID_LAST = 830,  /**< nm */
    GRID_N = GRID_LAST - GRID_FIRST + 1,
};

/** @brief The function at one wavelength in nm. */
float grid_at(const float grid[GRID_N], float nm);

/** @brief The function at eight wavelengths, all within GRID_FIRST..GRID_LAST. */
spectrum grid_eval(const float grid[GRID_N], spectrum lambda);

/** @brief Integral over first..last (whole nm) of the product of two functions. Exact:
 * the product is quadratic on each nanometre, where Simpson's rule holds. */
double grid_integrate(const float a[GRID_N], const float b[GRID_N], int first, int last);

/** @brief Resamples n >= 2 values at first, first + step, ... linearly; the end values
 * continue beyond both ends. */
void grid_from_table(const float *values, int n, int first, int step, float grid[GRID_N]);

/** @brief Multiplies all values by factor. */
void grid_scale(float grid[GRID_N], float factor);
