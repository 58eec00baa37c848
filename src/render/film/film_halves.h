/*
 * What the denoiser needs of a film beside its picture: the same sums over the even
 * passes alone, so that there are two halves that share no random number; how each layer
 * of light scatters over passes; and guides, which is what is known of a pixel beside its
 * light.
 *
 * Of a pixel that has one pass only, that pass is one half of it, and the other half is
 * the pass of the pixel below or above: of two rows, the first has even halves and the
 * second odd ones. So one pass has halves, half of one has them, and as the second comes
 * each pixel gets its own. That costs detail as fine as rows, so it is for few samples.
 *
 *   sample ─► guide_sum (of one pixel in one pass) ─► pass[] ── halves_end_pass ─►
 * pixels[]
 *
 * Guides are of the surface that a sample sees by way of mirrors and glass; which of them
 * are features film_denoise.c says: one more is a field of light_guide, and one there.
 */
#pragma once

#include "render/film/film.h"

/** @brief Lights that are filtered: layers, all but lights in sight, and glints, which
 * are lamps in glass that not every path finds. With what else is seen there these would
 * make whatever is beside them look like noise. Or all of them as one. */
enum {
    N_LIGHTS = LAYER_EMISSION,
    GLINTS = N_LIGHTS,
    N_FILTERED,
    ALL_LIGHTS = N_FILTERED
};

/** @brief Sums of the guides of one pixel in one pass. Zero to begin. */
typedef struct guide_sum {
    float albedo[3], lights[3], glints[3]; /**< XYZ */
    float normal[3], depth;
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

/** Of a first pass so many cells are in both halves. */
enum { HALVES_CELLS = FILM_CELLS / 2 };

/** @brief Whether there is enough to be halved. */
bool halves_have(const film *f);

/** @brief A half of a pixel: of which one, and of it the even or the odd passes. */
typedef struct half_view {
    size_t i;
    bool odd;
    const double *all;      /**< numbers of film_sum, of all passes done, */
    const float *even;      /**< of the even ones, */
    const float *pass;      /**< and of the pass under way; NULL: not in this half */
    const float *guides[2]; /**< likewise of guide_sum: of all, of even ones */
    const float *pass_guides;
} half_view;

/** @brief Half 0 or 1 of a pixel, if the film halves_have. */
half_view half_view_of(const film *f, size_t i, int half);

/** Numbers of film_sum and of guide_sum, where they begin. */
#define HALF_AT(field) (offsetof(film_sum, field) / sizeof(double))
#define GUIDE_AT(field) (offsetof(guide_sum, field) / sizeof(float))

/** @brief One of the half's numbers of film_sum. */
static inline double half_number(const half_view *v, size_t at)
{
    double even = (double)v->even[at], pass = v->pass ? (double)v->pass[at] : 0.0;
    return (v->odd ? v->all[at] - even : even) + pass;
}

/** @brief One of its numbers of guide_sum. */
static inline float half_guide(const half_view *v, size_t at)
{
    float even = v->guides[1][at], pass = v->pass ? v->pass_guides[at] : 0.0f;
    return (v->odd ? v->guides[0][at] - even : even) + pass;
}

/** @brief Variance of the luminance of a layer's mean, by the scatter of a pixel's
 * passes; NAN where there is one only. */
float halves_variance(const film *f, size_t i, int layer);

/** @brief Bytes a pixel of what guides the denoiser in the pass under way. */
size_t film_guide_bytes(void);
