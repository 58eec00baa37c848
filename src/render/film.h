/*
 * The film: sums over samples, pixel by pixel, in double precision so that a million
 * passes add up.
 *
 * Each pixel is written by one thread at a time, passes come in order: the sums are the
 * same bits on any number of threads.
 */
#pragma once

#include "color/curve.h"
#include "image/image.h"
#include "transport/transport.h"

enum { FILM_COLORS = N_LAYERS + 1 /* albedo */ };

/** @brief Sums of one pixel, weighed by the pixel filter. */
typedef struct film_pixel {
    double color[FILM_COLORS]
                [3]; /**< XYZ of the layers, then of the albedo under the white */
    double normal[3], depth;
    double weight;
    double
        surface_weight; /**< of the samples that met a surface: albedo, normal, depth */
} film_pixel;

typedef struct film {
    int x0, y0, width, height; /**< the part of the picture that is rendered, pixels */
    film_pixel *pixels;
    float scale; /**< the sensor's: scene_imaging_ratio */
    const color_space *space;
} film;

/** @brief An empty film for the scene's crop window. */
bool film_open(film *f, const scene *s, GError **error);
void film_clear(film *f);

/** @brief What turns a pass' spectra into colours. */
typedef struct film_pass {
    const wavelengths *w;
    spectrum white; /**< the illuminant under which the albedo is seen, Y = 1 */
} film_pass;

film_pass film_pass_for(const wavelengths *w);

/** @brief Adds a sample to pixel (x, y) of the whole picture. */
void film_add(film *f, const film_pass *pass, int x, int y, const radiance_sample *sample,
              float weight);

/** @brief The picture: R G B, the layers' R G B, albedo, normal, depth; linear, film's
 * space. */
image *film_image(const film *f, GError **error);
