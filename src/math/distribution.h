/*
 * Discrete distributions: pick an index in proportion to its weight, by bisection in the
 * cumulative sum, which keeps the order of stratified numbers (an alias table would not).
 * A table of cuts tells where to begin (Chen & Asau, "On Generating Random Variates from
 * an Empirical Distribution", 1974), so that few steps are left.
 */
#pragma once

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

/** @brief Weights summed up. Immutable once built. */
typedef struct distribution {
    size_t n;
    double *cumulative; /**< n + 1 values, 0 first, total last */
    size_t n_cuts;      /**< a power of two */
    uint32_t *cuts;     /**< n_cuts + 1 indices: what u = i / n_cuts picks; NULL if n is 0
                         */
} distribution;

/** @brief Sums n weights (>= 0, finite). @return false when memory is refused. A total of
 * zero is allowed: then distribution_sample must not be called. */
bool distribution_init(distribution *d, const float *weights, size_t n, GError **error);
void distribution_clear(distribution *d);
double distribution_total(const distribution *d);
/** @brief Probability of index i; 0 if the total is zero. */
float distribution_pdf(const distribution *d, size_t i);
/** @brief Picks i with probability distribution_pdf(d, i) for uniform u in [0,1), and
 * makes *u uniform again for further use (its place within the step). */
size_t distribution_sample(const distribution *d, float *u);
