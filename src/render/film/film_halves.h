/*
 * What the denoiser needs of a film beside its picture: the same sums over the even
 * passes alone, so that there are two halves that share no random number; how each layer
 * of light scatters over passes; and guides, which is what is known of a pixel beside its
 * light.
 *
 *   sample ─► guide_sum (of one pixel in one pass) ─► pass[] ── halves_end_pass ─►
 * pixels[]
 *
 * Guides are of the surface that a sample sees by way of mirrors and glass; they are
 * listed once, in film_halves.c: one more is a field of light_guide and a row there.
 */
#pragma once

#include "render/film/film.h"

enum {
    N_LIGHTS = LAYER_EMISSION, /**< layers that are filtered: all but lights in sight */
};

/** @brief Sums of the guides of one pixel in one pass. Zero to begin. */
typedef struct guide_sum {
    float albedo[3], lights[3]; /**< XYZ */
    float normal[3], depth;
    float weight; /**< of the samples that ended at a surface */
    float lit; /**< weight of the samples that have a light in sight, also by mirrors */
} guide_sum;

enum {
    GUIDE_NUMBERS = sizeof(guide_sum) / sizeof(float),
    HALF_FLOATS =
        FILM_NUMBERS + 2 * GUIDE_NUMBERS, /**< of a half_pixel, doubles behind */
};

/** @brief A pixel over all passes. */
typedef struct half_pixel {
    pass_pixel even;               /**< sums over the even passes */
    guide_sum guides_even, guides; /**< likewise, and over all */
    double y2[N_LIGHTS]; /**< Σ over passes of y y / w of a layer; y: weighed luminance of
                            the pass, w: its weight */
} half_pixel;

_Static_assert(sizeof(half_pixel) ==
                   HALF_FLOATS * sizeof(float) + N_LIGHTS * sizeof(double),
               "a plane of floats, then doubles");

/** @brief Room for it. */
bool halves_open(film *f, GError **error);
void halves_clear(film *f);

/** @brief Adds what a sample tells to the sums of a pixel. */
void guide_add(guide_sum *sum, const film_pass *pass, const radiance_sample *sample,
               float weight);

/* Called by film.c; nothing where there are no halves. */
void halves_put(film *f, int x, int y, const guide_sum *sum);
/** @brief Of pixels [begin, end). */
void halves_end_pass(const film *f, size_t begin, size_t end);

/** @brief Whether there is enough for film_denoise: two passes. */
bool film_can_denoise(const film *f);
/** @brief The picture without noise, [pixel][3], in the film's colours.
 * @param cancel may be NULL @return the caller's (big_free) */
float *film_denoise(const film *f, unsigned threads, const cancel_flag *cancel,
                    GError **error);
/** @brief About how long it takes, s: tries some rows. 0 where it can not be done.
 * @param gets_more passes of other processes are to come, so that it will be possible
 * though it is not now */
double film_denoise_seconds(const film *f, unsigned threads, bool gets_more);
/** @brief The same before there is a picture, by noise that is made up. */
double film_denoise_seconds_ahead(const film *f, const view *v, unsigned threads);
/** @brief Bytes a pixel of what guides the denoiser in the pass under way. */
size_t film_guide_bytes(void);

/** @brief Bytes while a picture of that size is denoised. */
size_t film_denoise_bytes(int width, int height);
