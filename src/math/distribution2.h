/*
 * Discrete distributions over the cells of a grid on the unit square: first a row, then a
 * column in it, then uniformly within the cell.
 */
#pragma once

#include "math/distribution.h"
#include "math/vec.h"

/** @brief width x height weights summed up. Immutable once built. */
typedef struct distribution2 {
    size_t width, height;
    distribution rows;     /**< totals of the rows */
    distribution *columns; /**< one per row */
} distribution2;

/** @brief Sums weights[y * width + x] (>= 0, finite). @return false when memory is
 * refused; then there is nothing to clear. */
bool distribution2_init(distribution2 *d, const float *weights, size_t width,
                        size_t height, GError **error);
void distribution2_clear(distribution2 *d);
/** @brief A point of [0,1)² for uniform u; *pdf per unit area. The total must not be
 * zero. */
vec2 distribution2_sample(const distribution2 *d, vec2 u, float *pdf);
/** @brief The density at a point of the unit square; 0 if the total is zero. */
float distribution2_pdf(const distribution2 *d, vec2 at);
/** @brief Mean weight of a cell. */
double distribution2_mean(const distribution2 *d);
