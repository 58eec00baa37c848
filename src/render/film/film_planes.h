/*
 * The film as plain numbers: all that is kept of the passes done, plane by plane, to be
 * written to a file or sent to another process. A plane of the film that is not listed
 * here is lost in a checkpoint.
 */
#pragma once

#include "render/film/film.h"

/** @brief Sums over passes, pixel by pixel: first floats, then doubles. */
typedef struct film_plane {
    const char *name; /**< static; one word */
    void *data;       /**< n pixels of so many numbers */
    size_t n, n_floats, n_doubles;
} film_plane;

enum { FILM_MOST_PLANES = 4 };

/** @brief What the film has, borrowed. @return how many */
size_t film_planes(const film *f, film_plane out[FILM_MOST_PLANES]);
size_t film_plane_bytes(const film_plane *plane);
/** @brief How many numbers are in all of them. */
size_t film_count_sums(const film *f);
/** @brief Copies numbers [first, first + n), counted through all planes. */
void film_get_sums(const film *f, size_t first, size_t n, double *out);
/** @brief Adds to them. */
void film_add_sums(film *f, size_t first, size_t n, const double *more);
/** @brief Forgets the passes. */
void film_reset(film *f);

/** @brief An open film's sums, those of the pass under way with them; what is reserved
 * for later (image_size, denoise_size) is not there yet. */
size_t film_bytes(const film *f);
/** @brief With what is reserved. */
size_t film_bytes_in_all(const film *f);

/** @brief What a film takes, bytes. */
typedef struct film_size {
    size_t pass;      /**< of the pass under way */
    size_t sums;      /**< with all passes done */
    size_t image;     /**< that it becomes */
    size_t denoising; /**< while its noise is taken out; 0: it stays */
    size_t writing;   /**< while the image is packed into OpenEXR, the most of formats */
} film_size;

/** @brief What the film of a view will take; all 0 where not even a small one can be
 * had. */
film_size film_size_for(const view *v, bool denoise);
