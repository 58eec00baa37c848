/*
 * Fitting the smooth curve to an RGB triple.
 */
#pragma once

#include "color/space.h"

/** @brief Weight of the squared slope and bend of the sigmoid's argument beside the
 * squared relative error. Too little to show where a curve of that colour exists;
 * elsewhere it keeps curves from growing into steps that eight wavelengths would miss,
 * and a table from bending between its nodes. */
#define SMOOTH_STIFFNESS 1e-11
#define SMOOTH_TABLE_STIFFNESS 1e-7

/**
 * @brief Finds the coefficients whose curve, seen under the space's illuminant, is rgb.
 * @param rgb components in [0, 1], not all zero
 * @param c in: where to start; out: c[0] t² + c[1] t + c[2] is the sigmoid's argument
 * @return largest error of a component; considerable only where no smooth reflectance has
 * that colour.
 */
double smooth_fit(const color_space *space, const double rgb[3], double stiffness,
                  double c[3]);

/** @brief The coefficients of rgb, clamped to [0, 1]; greys are exactly flat. */
void smooth_solve(const color_space *space, const float rgb[3], float coefficients[3]);

/** @brief True if the components are equal but for rounding. */
bool smooth_is_grey(const float rgb[3]);

/** @brief The argument at which the sigmoid is x in [0, 1], kept finite. */
double smooth_inverse(double x);
