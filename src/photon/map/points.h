/*
 * Points in space as the search structures take them, and those that a search finds.
 */
#pragma once

#include "base/parallel.h"
#include "math/lanes.h"

#include <stdbool.h>
#include <stddef.h>

/** @brief Positions of n points, big_alloc'ed. The arrays go on behind them for at least
 * one SIMD block, so that as many may be loaded from any. */
typedef struct point_arrays {
    size_t n;
    float *x, *y, *z;
} point_arrays;

/** @brief Room for n points. On failure nothing needs to be cleared. */
bool point_arrays_make(point_arrays *points, size_t n, const char *what, GError **error);
void point_arrays_clear(point_arrays *points);
/** @brief The three arrays in this order, as points_permute. */
bool point_arrays_permute(point_arrays *points, const size_t *order, workers by,
                          GError **error);

/** @brief Puts in order what lies at n points, an array of elements of some size: the
 * i-th becomes the one that was order[i]. *array is exchanged for another, with room for
 * a SIMD block behind; on failure it stays what it was. */
bool points_permute(void *array, size_t n, size_t size, const size_t *order, workers by,
                    GError **error);

/** @brief n and the least room behind, to a whole SIMD block. */
size_t points_padded(size_t n);

/** @brief Points found: their places in the sorted arrays, or what their owner calls
 * them, and squared distances. Zero-initialise, clear at the end; reused from query to
 * query. */
typedef struct point_hits {
    size_t n, capacity;
    uint32_t *index;
    float *distance2;
    bool refused; /**< memory was, in some query, which may have found too few */
} point_hits;

void point_hits_clear(point_hits *hits);
/** @brief Room for capacity hits in all. @return false when memory is refused */
bool point_hits_reserve(point_hits *hits, size_t capacity);
/** @brief ERROR_FAILED where memory was refused to a query. @return false */
bool point_hits_refuse(GError **error);
