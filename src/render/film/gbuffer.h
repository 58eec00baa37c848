/*
 * The layers of pbrt-v4's film "gbuffer", under its names, beside those that every
 * picture has:
 *
 *   Albedo.R G B            reflectance of the first surface, 0 where there is none
 *   P.X Y Z                 where it is, m
 *   dzdx dzdy               how much its depth changes from this pixel to the next, m
 *   N.X Y Z, Ns.X Y Z       true and shading normal, toward the eye, unit
 *   u v                     parameters of the surface
 *   Variance.R G B          between samples of the pixel that met a surface
 *   RelativeVariance.R G B  the same over their mean
 *
 * P, N, Ns and the depth z are in the camera's space, or in the world's if the film says
 * so. Means are over the samples that met a surface. pbrt's dzdx are for rays that stand
 * closer together the more samples a pixel has; these are for whole pixels.
 */
#pragma once

#include "render/film/film.h"

/** @brief How a sample was seen. */
typedef struct gbuffer_sample {
    vec2 raster, u_lens;
    ray seen_by;
    float weight; /**< of the pixel filter */
    float dimmed; /**< what its radiance was scaled by */
} gbuffer_sample;

/** @brief Room for the layers, if the film is a gbuffer. */
bool gbuffer_open(film *f, const film_settings *how, GError **error);

/** @brief Turns the shading normal into the camera's space if the film asks for it.
 *  @param time of the shutter, 0..1 */
void gbuffer_turn(const view *v, float time, radiance_sample *sample);

/** @brief Adds a sample, turned already, to the sums of a pixel. */
void gbuffer_add(surface_sum *sum, const film *f, const view *v, const film_pass *pass,
                 const gbuffer_sample *look, const radiance_sample *sample);

/* Called by film.c; nothing if the film is no gbuffer. */
void gbuffer_put(film *f, int x, int y, const surface_sum *sum);
void gbuffer_end_pass(const film *f, size_t begin, size_t end);
void gbuffer_add_names(const film *f, GPtrArray *names);
/** @brief Adds the sums of pixel i, with the pass under way where that counts. */
void gbuffer_sum(const film *f, size_t i, surface_sum *sum);
/** @brief Values of a pixel under those names. @param sum its other sums */
void gbuffer_write(const film *f, const surface_sum *of, const film_sum *sum, float *out);
