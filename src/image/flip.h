/*
 * FLIP: the error that a person sees who flips between two images on one screen.
 *
 *   linear RGB ─► YCxCz ─┬─► blur as the eye does ─► Hunt-adjusted L*a*b* ─► colour error
 *                        └─► edges and points of Y ─────────────────────────► feature
 * error FLIP = colour error ^ (1 - feature error), pixel by pixel, in 0..1
 *
 * Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild, "FLIP: A Difference
 * Evaluator for Alternating Images", High Performance Graphics 2020.
 */
#pragma once

#include "base/error.h"

#include <stddef.h>

/** @brief Pixels per degree of a 0.7 m wide screen of 3840 pixels seen from 0.7 m. */
#define FLIP_PIXELS_PER_DEGREE 67.0

/**
 * @brief The error of each pixel.
 * @param a, b linear sRGB in 0..1, three numbers a pixel, width * height pixels
 * @param out width * height errors
 * @return false with ERROR_FAILED if there is no memory
 */
bool flip_error(const double *a, const double *b, int width, int height, double *out,
                GError **error);
