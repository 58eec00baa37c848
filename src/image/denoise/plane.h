/*
 * Planes: one number a pixel, with a margin around the picture that mirrors it, so that
 * windows and vectors may hang over its edges.
 *
 *   plane[(y + MARGIN) * stride + x + MARGIN]
 */
#pragma once

#include "base/error.h"
#include "base/parallel.h"
#include "math/lanes.h"

#include <stddef.h>

enum {
    PATCH = 3,  /**< patches that are compared are squares of 2 PATCH + 1 pixels */
    BLOCK = 32, /**< pixels of a row that are worked on at once */
    /** Numbers of a row that patches of a block reach over, in whole vectors. */
    ACROSS = (BLOCK + 2 * PATCH + LANES - 1) / LANES * LANES,
    MARGIN = 32, /**< at least window, patch and a vector */
    ROWS_AT_ONCE = 16,
};

enum { MOST_SPARE_PLANES = 48 };

/** @brief Planes that were given back, for who wants one next: new memory is slow to come
 * by. Zero to begin. */
typedef struct spare_planes {
    float *plane[MOST_SPARE_PLANES];
    int n;
} spare_planes;

/** @brief Size of the picture, and what it is worked on with. */
typedef struct grid {
    int width, height;
    size_t stride, n; /**< n: numbers of a plane */
    unsigned threads;
    const cancel_flag *cancel;
    spare_planes *spare; /**< NULL: none is kept */
} grid;

grid grid_make(int width, int height, unsigned threads, const cancel_flag *cancel);

/** @brief A plane of zeros. */
float *plane_new(const grid *g, GError **error);
void plane_free(const grid *g, float *plane);
void spare_planes_clear(spare_planes *spare);

static inline size_t plane_at(const grid *g, int x, int y)
{
    return (size_t)(y + MARGIN) * g->stride + (size_t)(x + MARGIN);
}

/** @brief Fills the margins of n planes from the picture. */
void plane_mirror(const grid *g, float *const *planes, int n);

/** @brief Of a picture, margins apart. */
typedef struct plane_means {
    double plain, square, absolute;
} plane_means;

plane_means plane_mean(const grid *g, const float *plane);

/** @brief Sums of n planes over squares of 2 radius + 1 pixels, the margin's included;
 * `to` gets none. Not in place. @param radius at most PATCH */
void plane_box(const grid *g, const float *const *from, int n, int radius,
               float *const *to);

/** @brief Work on the pixels of row y. */
typedef void (*row_body)(int y, void *data);

/** @brief Calls body for every row, on all threads. @return false: cancelled */
bool plane_rows(const grid *g, row_body body, void *data);
