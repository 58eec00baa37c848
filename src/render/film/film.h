/*
 * The film: sums over samples, pixel by pixel, in double precision so that a million
 * passes add up.
 *
 *   sample ─► film_sum (of one pixel in one pass) ─► pass[] ── film_end_pass ─► pixels[]
 *
 * A pass is kept apart until it is whole, so that one given up leaves no trace: the
 * picture is always the mean of whole passes, and can be looked at while the next one is
 * rendered. Each pixel is written by one thread at a time, passes come in order: the sums
 * are the same bits on any number of threads.
 *
 * Beside the sums stand those of squares over passes. Passes are independent, so their
 * scatter tells the error of their mean, pixel by pixel.
 */
#pragma once

#include "color/curve.h"
#include "image/image.h"
#include "transport/transport.h"

enum {
    FILM_COLORS = N_LAYERS + 1 /* albedo */,
    FILM_Y = 1,      /**< of X, Y, Z: luminance */
    FILM_TILE = 16,  /**< pixels are rendered in squares of this size */
    FILM_COARSE = 8, /**< and may come in an order in which every so manieth in both
                        directions is first, then the half, and so on */
    FILM_CELLS = FILM_COARSE * FILM_COARSE, /**< numbers in that order: see film_cell */
};

/** @brief Sums of one pixel in one pass, weighed by the pixel filter. Zero to begin. */
typedef struct film_sum {
    double color[FILM_COLORS]
                [3]; /**< XYZ of the layers, then of the albedo under the white */
    double normal[3], depth;
    double weight;
    double
        surface_weight; /**< of the samples that met a surface: albedo, normal, depth */
} film_sum;

enum { FILM_NUMBERS = sizeof(film_sum) / sizeof(double) };

/** @brief What a pass made of a pixel: film_sum's numbers. */
typedef struct pass_pixel {
    float number[FILM_NUMBERS];
} pass_pixel;

/** @brief A pixel over all passes. */
typedef struct film_pixel {
    film_sum sum;
    double y2, yw, w2; /**< Σ over passes of y y, y w and w w; y: weighed luminance of the
                          pass, w: its weight */
} film_pixel;

/** @brief Sums of one pixel for a gbuffer (gbuffer.h). Zero to begin. */
typedef struct surface_sum {
    double p[3], n[3], ns[3], uv[2], dz[2]; /**< weighed by the pixel filter */
    double rgb[3], rgb2[3], n_samples;      /**< of the colour and its squares */
} surface_sum;

typedef struct film {
    int x0, y0, width, height; /**< the part of the picture that is rendered, pixels */
    pass_pixel *pass;          /**< of the pass under way */
    film_pixel *pixels;        /**< of the passes done */
    int n_groups;              /**< of lights; 0: none, and these are NULL */
    float *pass_groups;        /**< XYZ of the groups, [pixel][group][3], of the pass */
    double *groups;            /**< of the passes done */
    const char *const *group_names; /**< the scene's */
    int64_t n_passes;               /**< done */
    uint32_t index;                 /**< number of the pass under way */
    int n_cells;   /**< of the pass under way all pixels of so many cells are part of the
                      picture: film_cell(pixel) < n_cells */
    float scale;   /**< the sensor's: view_imaging_ratio */
    float least;   /**< share of a pixel that surfaces must take: filter_taken */
    float most;    /**< film_settings.most */
    bool balanced; /**< by this matrix of XYZ */
    double balance[9];
    const color_space *space;
    surface_sum *pass_surfaces;    /**< of the pass; NULL: the film is no gbuffer */
    surface_sum *surfaces;         /**< of the passes done */
    struct guide_sum *pass_guides; /**< of the pass; NULL: the film has no halves */
    struct half_pixel *halves;     /**< of the passes done: film_halves.h */
    size_t denoise_size;           /**< bytes reserved for film_denoise.h */
    bool coarse;                   /**< windows of film_denoise: denoise_size.coarse */
    bool together;                 /**< film_denoise filters few passes' lights as one */
    bool lends;                    /**< one pass has halves, too: film_halves.h */
    bool no_time;      /**< there is none to denoise: film_can_denoise is false */
    size_t image_size; /**< bytes reserved for film_image */
} film;

/** @brief An empty film for the view's crop window.
 * @param denoise with what film_denoise needs */
bool film_open(film *f, const view *v, bool denoise, GError **error);
void film_clear(film *f);

/** @brief What turns a pass' spectra into colours. */
typedef struct film_pass {
    const wavelengths *w;
    spectrum white; /**< the illuminant under which the albedo is seen, Y = 1 */
    float most;     /**< the largest of X, Y, Z that a sample may have; INFINITY: any */
} film_pass;

film_pass film_pass_for(const film *f, const wavelengths *w);

/** @brief What radiance must be scaled by so as not to be brighter than allowed. */
float film_dimming(const film_pass *pass, spectrum radiance);

/** @brief Adds a sample to the sum of a pixel. @return what it was scaled by, 1 unless it
 * was brighter than allowed */
float film_add(film_sum *sum, const film_pass *pass, const radiance_sample *sample,
               float weight);
/** @brief Pixel (x, y) of the whole picture is done in this pass. */
void film_put(film *f, int x, int y, const film_sum *sum);
/** @brief The same for what the light groups gave: Σ of weighed radiance, n_groups. */
void film_put_groups(film *f, const film_pass *pass, int x, int y, const spectrum *sums);
/** @brief Adds what the pass brought from the lights to pixels that are all put, splat by
 * splat in their order, by the pixel filter: the same bits on any number of threads. */
void film_add_splats(film *f, const film_pass *pass, const pixel_filter *filter,
                     splat_list splats, unsigned threads);
/** @brief When a pixel of the whole picture comes where a pass is rendered in parts,
 * 0..FILM_CELLS - 1: after 1, 4, 16 and 64 cells a grid of every 8th, 4th, 2nd and every
 * pixel is whole, and in between what there is lies evenly. */
int film_cell(const film *f, int x, int y);
/** @brief Pixels of which the sum stands for one: itself if there is any sample of it; in
 * a first pass that is not whole those on its sides that see a light, or those that see
 * none, whichever are more; before half of that the nearest on a coarser grid of its
 * tile. @return how many */
int film_pixels_for(const film *f, size_t pixel, size_t for_it[4]);
/** @brief Adds the sum of a pixel, with the pass under way where that counts. */
void film_add_pixel(const film *f, size_t pixel, film_sum *sum);
/** @brief Adds what a pass made of a pixel. */
void film_add_pass(film_sum *sum, const pass_pixel *pass);
/** @brief Whether the pass under way is part of the picture at a pixel of the film. */
bool film_pass_counts(const film *f, size_t pixel);
/** @brief Adds the pass, of which every pixel was put, to the picture. */
void film_end_pass(film *f, unsigned threads);

/**
 * @brief The relative error of the picture, estimated from the scatter of its passes:
 * √ of the mean over pixels of Var / (Y² + (m/10)²).
 *
 * Y is the pixel's luminance and m the mean one, lights in sight counting no more than
 * the mean does. INFINITY before there are two passes.
 */
double film_noise(const film *f);

/** @brief By what sums over the surfaces of a pixel are divided for their mean: the
 * weight of these. Where the filter's negative lobes take as much as there is, that may
 * be next to nothing, and they count by the share of the pixel that they have. */
double film_surface_weight(const film *f, const film_sum *sum);

/** @brief Mean of sums of XYZ, white-balanced, in the film's colour space. */
void film_to_rgb(const film *f, const double sum[3], double weight, float out[3]);

/** @brief The picture: R G B, the layers' R G B, albedo, normal, depth; linear, film's
 * space. With two passes or more also variance.Y, the square of the standard error of
 * the luminance; with light groups their layers light.NAME; then those of a gbuffer; last
 * lights.R G B A (film_lights.h) and denoised.R G B, where there is enough for
 * film_denoise. All of the pass under way, too, as far as its n_cells say; where that is
 * all there is, pixels that are still to come look like those beside.
 * @param cancel ends the taking out of noise; may be NULL */
image *film_image(const film *f, unsigned threads, const cancel_flag *cancel,
                  GError **error);
/** @brief Some of its rows only, from y on; never denoised. */
image *film_image_rows(const film *f, int y, int rows, unsigned threads, GError **error);
