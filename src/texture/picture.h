/*
 * Images as scenes use them, for textures, normal maps and lights: colour channels found,
 * colour space known, look-ups with every way to go on beyond the border, and a pyramid
 * of ever smaller images for wide look-ups (Williams, "Pyramidal Parametrics", 1983).
 *
 *   (context, t) = (0, 0) is the upper left corner of the first texel, (1, 1) the lower
 * right corner of the last
 */
#pragma once

#include "color/curve.h"
#include "math/vec.h"
#include "params/build_context.h"
#include "params/params.h"
#include "texture/texels.h"

/** @brief How an image goes on beyond its border. */
typedef enum picture_wrap {
    WRAP_REPEAT,
    WRAP_BLACK,
    WRAP_CLAMP,
    WRAP_OCTAHEDRAL, /**< an equal-area map of the sphere */
    WRAP_LATLONG,    /**< a latitude-longitude map of the sphere */
} picture_wrap;

enum { MAX_PICTURE_LEVELS = 32 };

/** @brief An image with its colours found. Shared by all that read it alike, and counted:
 * who gets one gives it back (picture_unref). Immutable once built. */
typedef struct picture {
    texels *levels[MAX_PICTURE_LEVELS]; /**< owned; [0] is the image */
    int n_levels;                       /**< 1 unless built */
    int channels[4]; /**< of R, G, B and A; -1: there is none. Grey: R = G = B */
    bool grey;
    const color_space *space;
} picture;

/** @brief Reads the image that string parameter `name` names, which must be there; once
 * for all that read it alike.
 *  @param context for images within the scene's file, and to share; may be NULL
 *  @return NULL with ERROR_INPUT at the parameter (or the list, if it is missing) */
picture *picture_read(const build_context *context, const params *p, const char *name,
                      const image_read_options *options, GError **error);
/** @brief The same of a file. @return NULL with ERROR_INPUT */
picture *picture_read_file(const build_context *context, const char *path,
                           const image_read_options *options, GError **error);
/** @brief picture_read of a light's image. Of values that no light can have, which lossy
 * compression and half floats leave in real photographs of skies, those below zero and
 * what is no number are taken as black, infinite ones as the largest of half floats; how
 * many they are is noted. */
picture *picture_read_light(const build_context *context, const params *p,
                            const char *name, GError **error);
/** @brief Wraps an image of one channel, which is taken, also on failure. @return NULL:
 * no memory */
picture *picture_from_grey(image *taken, GError **error);
/** @brief An image of one colour. @return NULL: no memory */
picture *picture_of_color(int side, const color_space *space, const float rgb[3],
                          GError **error);
/** @brief Builds the pyramid. */
bool picture_build_levels(picture *pic, GError **error);
void picture_unref(picture *pic); /**< NULL is allowed */
/** @brief The alpha channel is there and not one everywhere. */
bool picture_has_alpha(const picture *pic);

#define NO_TEXEL SIZE_MAX

/** @brief The texels that a look-up mixes. */
typedef struct texel_mix {
    const texels *of;
    size_t at[4]; /**< NO_TEXEL: black */
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
