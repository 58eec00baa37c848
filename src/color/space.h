/*
 * RGB spaces inside: matrices, illuminant, and what fitting smooth curves needs.
 */
#pragma once

#include "color/curve.h"
#include "color/grid.h"

enum {
    N_COLOR_SPACES = 4,
    FIT_STEP = 2, /**< nm between the nodes of the fit's quadrature */
    FIT_N = 171,  /**< nodes from LAMBDA_MIN to LAMBDA_MAX */
    FIT_PADDED =
        172, /**< FIT_N rounded up to whole vectors; the weights there are zero */
};

/** @brief The smooth curve is a quadratic in t = (nm - SMOOTH_CENTER) / SMOOTH_HALF. */
#define SMOOTH_CENTER (0.5f * (LAMBDA_MIN + LAMBDA_MAX))
#define SMOOTH_HALF (0.5f * (LAMBDA_MAX - LAMBDA_MIN))

/** @brief A matrix for columns: rows of m are the rows. */
typedef struct matrix3 {
    double m[3][3];
} matrix3;

struct color_space {
    const char *name;
    double xy[8];   /**< red, green, blue, white */
    matrix3 to_xyz; /**< columns: XYZ of the primaries; white has Y = 1 */
    matrix3 from_xyz;
    const float *illuminant; /**< GRID_N values, photometric integral of equal energy */
    /** Component k of a reflectance R under the illuminant is sum_i fit[k][i] R(node i).
     */
    double fit[3][FIT_PADDED];
    int index; /**< place in the list of spaces, 0..N_COLOR_SPACES-1 */
};

/** @brief Space number index, in 0..N_COLOR_SPACES-1. */
const color_space *color_space_at(int index);
