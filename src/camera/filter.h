/*
 * Pixel reconstruction filters, importance sampled: a sample falls where the filter is
 * large and counts as one (pbrt's scheme). Negative lobes give weights of either sign.
 */
#pragma once

#include "params/params.h"

typedef struct filter_table filter_table;

/** @brief A filter: kind by name (box, triangle, gaussian, mitchell, sinc), radii in
 * pixels. */
typedef struct pixel_filter {
    const char *name;
    float x_radius, y_radius;
    filter_table *table; /**< owned, made by filter_init */
} pixel_filter;

bool filter_init(pixel_filter *f, const char *kind, const params *p, GError **error);
void filter_clear(pixel_filter *f);
/** @brief pbrt's default: gaussian, radius 1.5, sigma 0.5. */
bool filter_init_default(pixel_filter *f, GError **error);
/** @brief Offset from the pixel's centre for uniform u, and the sample's weight. */
vec2 filter_sample(const pixel_filter *f, vec2 u, float *weight);
/** @brief Likewise, of the number-th of samples that are summed up. Where the filter has
 * negative lobes, weights below 0 come as often as they should, but evenly, and not
 * first: so the sum of few weights, by which that of samples is divided, is not near 0.
 * @param key of these samples */
vec2 filter_sample_nth(const pixel_filter *f, uint64_t key, uint64_t number, vec2 u,
                       float *weight);
/** @brief What negative lobes take off what a pixel has, over all of it: 0 to < 1. */
float filter_taken(const pixel_filter *f);
/** @brief f(x, y), not normalised. */
float filter_eval(const pixel_filter *f, vec2 offset);
/** @brief f(x, y) over its integral, per pixel area: what a place on the film gives to a
 * pixel. */
float filter_density(const pixel_filter *f, vec2 offset);
/** @brief True if a place on the raster gives to some pixel of a film of that size. */
bool filter_reaches(const pixel_filter *f, vec2 raster, int width, int height);
/** @brief Name of kind number i of the table; NULL behind the last. */
const char *filter_kind_name(size_t i);
/** @brief What it may be given, blank-separated; owned by the caller. */
char *filter_kind_parameters(size_t i);
