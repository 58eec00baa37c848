/*
 * The picture of a film without its noise (image/denoise): which features and lights of
 * it are given to the denoiser.
 */
#pragma once

#include "render/film/film.h"

/** @brief Whether there is enough for film_denoise: halves_have. */
bool film_can_denoise(const film *f, unsigned threads);
/** @brief The picture without noise, [pixel][3], in the film's colours.
 * @param cancel may be NULL
 * @param out the caller's (big_free); NULL where there is not enough
 * @return false when out of memory or cancelled */
bool film_denoise(const film *f, unsigned threads, const cancel_flag *cancel, float **out,
                  GError **error);
/** @brief What film_denoise has to do, in pixels of one light. 0 where it can not though
 * a pass is done.
 * @param gets_more passes of other processes are to come, so that it will be possible
 * though it is not now */
double film_denoise_work(const film *f, unsigned threads, bool gets_more);
/** @brief About how long that takes for a unit of film_denoise_work, s, by trials on a
 * small picture with the same lights.
 * @param budget s: there is one trial more where two took less than that */
double film_denoise_trial(const film *f, const view *v, unsigned threads, double budget);
/** @brief Whether lights are filtered as one: of few passes, if the film is to. */
bool film_filters_together(const film *f);
/** @brief Bytes while a picture of that size is denoised. */
size_t film_denoise_bytes(int width, int height);
