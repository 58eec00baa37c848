/*
 * Layers of an image, by the names of their channels, and which of them is the picture.
 */
#pragma once

#include "image/image.h"

/** @brief One layer as R, G and B: NAME.R .G .B, NAME.X .Y .Z, or one channel thrice
 * (NAME.Y, NAME.Z, NAME). NULL with ERROR_USAGE and the list of layers. */
image *image_layer(const image *img, const char *name, GError **error);

/** @brief Those of the picture that is shown: without noise (denoised.R, G, B), if it has
 * that, or image_colors. */
bool image_shown_colors(const image *img, int rgba[4]);
