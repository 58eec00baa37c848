/*
 * Texels: an image as look-ups want it, as small as it can be with nothing lost.
 *
 * Where no channel has more than 256 values, as in every file of eight bits a channel, a
 * texel is one byte a channel, the number of its value in the channel's table; else it is
 * the image's floats.
 */
#pragma once

#include "image/image.h"

#include <stdint.h>

enum { TEXEL_CODES = 256 };

/** @brief An image's numbers. Immutable. */
typedef struct texels {
    int width, height, n_channels;
    uint8_t *codes; /**< as an image's pixels, owned; NULL: they are floats */
    float (*tables)[TEXEL_CODES]; /**< of each channel, owned; with codes */
    float *values;                /**< without codes: an image's pixels, owned */
} texels;

/** @brief Takes an image, also on failure. @return owned by the caller; NULL: no memory
 */
texels *texels_from_image(image *taken, GError **error);
/** @brief The image of half the size, sides rounded up: each texel the mean of four.
 * @return owned by the caller; NULL: no memory */
texels *texels_halved(const texels *large, GError **error);
/** @brief A copy in which each value is what `mend` makes of it. @return owned by the
 * caller; NULL: no memory */
texels *texels_mended(const texels *t, float (*mend)(float), GError **error);
void texels_free(texels *t);

static inline size_t texels_count(const texels *t)
{
    return (size_t)t->width * (size_t)t->height;
}

/** @brief A channel of texel number `at`, counted row by row. */
static inline float texels_value(const texels *t, size_t at, int channel)
{
    size_t i = at * (size_t)t->n_channels + (size_t)channel;
    return t->codes ? t->tables[channel][t->codes[i]] : t->values[i];
}
