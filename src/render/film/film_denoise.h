/*
 * The picture of a film without its noise (image/denoise): which features and lights of
 * it are given to the denoiser.
 */
#pragma once

#include "render/film/film.h"

/** @brief Whether there is enough for film_denoise: halves_have. */
bool film_can_denoise(const film *f, unsigned threads);
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
/** @brief Bytes while a picture of that size is denoised. */
size_t film_denoise_bytes(int width, int height);
