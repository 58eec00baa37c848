/*
 * Images as scenes use them, for textures, normal maps and lights: colour channels found,
 * colour space known, look-ups with every way to go on beyond the border, and a pyramid
 * of ever smaller images for wide look-ups (Williams, "Pyramidal Parametrics", 1983).
 *
 *   (s, t) = (0, 0) is the upper left corner of the first texel, (1, 1) the lower right
 *   corner of the last
 */
#pragma once

#include "color/curve.h"
#include "image/image.h"
#include "math/vec.h"
#include "scene/params.h"

struct scene;

/** @brief How an image goes on beyond its border. */
typedef enum picture_wrap {
    WRAP_REPEAT,
    WRAP_BLACK,
    WRAP_CLAMP,
    WRAP_OCTAHEDRAL, /**< an equal-area map of the sphere */
    WRAP_LATLONG,    /**< a latitude-longitude map of the sphere */
} picture_wrap;

enum { MAX_PICTURE_LEVELS = 32 };

/** @brief An image with its colours found. Immutable once built. */
typedef struct picture {
    image *levels[MAX_PICTURE_LEVELS]; /**< owned; [0] is the image */
    int n_levels;                      /**< 1 unless built */
    int channels[4]; /**< of R, G, B and A; -1: there is none. Grey: R = G = B */
    bool grey;
    const color_space *space;
} picture;

/** @brief Reads the image that string parameter `name` names, which must be there.
 *  @param s for images within the scene's file; may be NULL
 *  @return false with ERROR_INPUT at the parameter (or the list, if it is missing) */
bool picture_read(picture *out, const struct scene *s, const params *p, const char *name,
                  const image_read_options *options, GError **error);
/** @brief Wraps an image of one channel, which is taken. */
void picture_from_grey(picture *out, image *taken);
/** @brief Builds the pyramid. */
bool picture_build_levels(picture *pic, GError **error);
void picture_clear(picture *pic);
/** @brief Refuses texels that no light can have: not finite, or negative. */
bool picture_check_light(const picture *pic, source_place place, GError **error);
/** @brief The alpha channel is there and not one everywhere. */
bool picture_has_alpha(const picture *pic);

/** @brief The texels that a look-up mixes. */
typedef struct texel_mix {
    const float *texels[4]; /**< NULL: black */
    float weights[4];
} texel_mix;

texel_mix picture_nearest(const picture *pic, int level, vec2 st, picture_wrap wrap);
texel_mix picture_bilinear(const picture *pic, int level, vec2 st, picture_wrap wrap);
/** @brief One channel of the mixture. */
float texel_mix_channel(const texel_mix *mix, int channel);
/** @brief R, G and B of the mixture. */
void picture_rgb(const picture *pic, const texel_mix *mix, float rgb[3]);
/** @brief The mean over a texel of the bilinear mixture: its own colour six times of
 * eight along each axis. */
void picture_texel_mean(const picture *pic, picture_wrap wrap, int x, int y,
                        float rgb[3]);
/** @brief The level, counted from the largest, whose texels are as wide as `width`, a
 * share of the image's smaller side; may lie between two, or below 0. */
float picture_level(const picture *pic, float width);
