/*
 * A sketch of the picture, from the few paths of a trial: how bright it is around a place
 * of the film. Noise counts as the picture shows it: relative to what is there.
 */
#pragma once

#include "photon/map/point_set.h"

typedef struct sketch sketch;

/** @brief Of n places, > 0, in pixels, and how bright each is. NULL: out of memory */
sketch *sketch_new(const vec2 *places, const float *brightness, size_t n, GError **error);
void sketch_free(sketch *s);

/** @brief Adds caustics, once: so bright at n places, > 0, of n_all; none at the others.
 * @return false when out of memory */
bool sketch_add_caustics(sketch *s, const vec2 *places, const float *brightness, size_t n,
                         size_t n_all, GError **error);

/** @brief What a squared error counts where the picture is so bright, and so bright in
 * the mean; where all is black, 1. */
static inline double relative_weight(double here, double mean)
{
    double square = here * here + mean * mean;
    return square > 0.0 ? 1.0 / square : 1.0;
}

/** @brief The same at a place, as bright as the nearest of the sketch.
 *  @param but a place that is left out, as its own error would; n or more: none
 *  @param hits the caller's, which says if memory was refused */
double sketch_weight(const sketch *s, vec2 raster, size_t but, point_hits *hits);
