/*
 * Takes the noise out of a picture of which there are two independent halves, one of its
 * parts (direct light, caustics ...) at a time, by what else is known of each pixel.
 *
 *   features ─► prefilter ─┐
 *   light, halves ─────────┴► regress (two bandwidths) ─► choose ─► shrink ─► light
 *
 * - prefilter.h: features (albedo, normal, depth ...) by non-local means.
 * - regress.h: colours as linear functions of features in windows.
 * - choose: between bandwidths, where the halves say which errs less; and beside what few
 *   windows say a pixel's own colour, where they err.
 * - shrink: toward the picture as it was, as far as what was taken out of it is more than
 *   its noise; James & Stein, "Estimation with Quadratic Loss", 1961. First means over
 *   squares, of which noise is small, then single pixels. So whatever the filter does,
 *   the error falls with that of the picture: a picture without noise stays what it is.
 *
 * The same bits on any number of threads. Numbers that are not finite are replaced by the
 * other half's or a neighbour's.
 */
#pragma once

#include "base/parallel.h"
#include "image/image.h"

/** @brief Numbers of each pixel, in two halves that share no random number. */
typedef struct denoise_source {
    /** What is in row y, from the top: of half h channel c goes to half[h][c]; of light
     * to variance that of the luminance of the mean of both (the square of its standard
     * error; NAN: as the halves' difference tells), which is NULL for features. Called on
     * many threads at once. */
    void (*read)(const void *data, int y, float *const *const half[2], float *variance);
    const void *data;
} denoise_source;

/** @brief Of the picture. */
typedef struct denoise_size {
    int width, height;
    float share;      /**< of all samples that are in the first half, 0..1 exclusive */
    float distinct;   /**< share of a half's pixels that have numbers of their own, 0..1;
                         others have those of one beside */
    float brightness; /**< mean luminance of all that is filtered: the eye, made for it,
                         sees less in what is darker */
    unsigned threads;
    const cancel_flag *cancel; /**< may be NULL */
    bool coarse; /**< windows around every fourth pixel in place of every second */
} denoise_size;

typedef struct denoiser denoiser;

denoiser *denoiser_new(const denoise_size *size, GError **error);
void denoiser_free(denoiser *d);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(denoiser, denoiser_free)

/** @brief n more features for all lights that are filtered from now on.
 * @param from what they are, one after another's channels
 * @param n_channels of each, 1..3
 * @return the number of the first, or -1 */
int denoiser_add(denoiser *d, const denoise_source *from, const int *n_channels, int n,
                 GError **error);

/** @brief Filters light of three channels, linear, if there is any.
 * @param n_beside so many pixels beside an outlier may be outliers with it
 * @param divide_by number of a feature of three channels, an albedo that the light is
 * about proportional to; -1: none
 * @param out [pixel][3]: the result is added */
bool denoiser_filter(const denoiser *d, const denoise_source *light, int n_beside,
                     int divide_by, float *out, GError **error);

/** @brief Bytes that it takes while it works on a picture, margins with it. */
size_t denoise_bytes(int width, int height, int n_features, int n_feature_channels);
