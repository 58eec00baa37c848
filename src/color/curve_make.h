/*
 * Curves from functions and grids: for the files that make curves of their own kind.
 */
#pragma once

#include "color/curve.h"
#include "color/grid.h"

/** @brief A function of wavelength in nm. */
typedef double (*curve_function)(double nm, const void *data);

/** @brief The function on the grid of whole nanometres. NULL if a value in
 * LAMBDA_MIN..LAMBDA_MAX is not finite or negative. */
curve *curve_from_function(curve_function f, const void *data);

/** @brief A copy of the grid as a curve. */
curve *curve_from_grid(const float grid[GRID_N]);

/** @brief n² = 1 + sum over n_terms of b λ²/(λ² - c); NULL where n is not positive. */
curve *curve_sellmeier_terms(const double *b, const double *c, int n_terms);
