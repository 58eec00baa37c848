/*
 * Layers of an image, by the names of their channels, and which of them is the picture.
 */
#pragma once

#include "image/image.h"

/** @brief One layer as R, G and B: NAME.R .G .B, NAME.X .Y .Z, or one channel thrice
 * (NAME.Y, NAME.Z, NAME). NULL with ERROR_USAGE and the list of layers. */
image *image_layer(const image *img, const char *name, GError **error);

/** @brief Channels of the picture that is shown. */
typedef struct image_shown {
    int rgba[4];   /**< denoised.R, G, B, if it has that, or image_colors */
    int lights[4]; /**< lights.R, G, B, A: what of the picture is lights in sight, and of
                      how much of the pixel; lights[3] < 0: it has none */
} image_shown;

/** @return false: it has no colours */
bool image_find_shown(const image *img, image_shown *out);

/**
 * @brief A pixel as it is seen where nothing is brighter than white, before it is cut
 * there.
 *
 * A light in sight may be so bright that a thousandth of a pixel is enough to make all of
 * it white: edges of lights would be jagged. So the part of the pixel where it is in
 * sight is white, and no more than that.
 */
void image_shown_pixel(const image_shown *shown, const float *pixel, float white,
                       float rgb[3]);

/** @brief All pixels so, as R, G and B. NULL with ERROR_INPUT: it has no colours. */
image *image_as_shown(const image *img, float white, GError **error);
