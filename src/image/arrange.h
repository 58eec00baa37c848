/*
 * Images made of images: scaled, and side by side. Numbers stay linear.
 */
#pragma once

#include "image/image.h"

/** @brief All channels in another size: a pixel is the mean over the area that it covers,
 * so the mean over the image stays. NULL with ERROR_FAILED. */
image *image_scaled(const image *img, int width, int height, GError **error);

/** @brief n images row by row in so many columns, as large as the largest in their row
 * and column, middle in their places, on dark grey with a gap between. R, G and B, which
 * all must have: else NULL with ERROR_INPUT. */
image *image_sheet(const image *const *images, size_t n, size_t columns, GError **error);
