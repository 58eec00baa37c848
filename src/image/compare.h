/*
 * How far two images are from each other.
 */
#pragma once

#include "image/image.h"

/** @brief Errors over the R, G, B channels of two images of equal size. */
typedef struct image_difference {
    double mean_a, mean_b; /**< mean luminance */
    double rmse;           /**< root mean squared error */
    double relmse;         /**< mean of (a-b)² / (b² + 0.01), b the reference */
    double psnr;           /**< dB, for sRGB-encoded values clipped to 0..1 */
    double flip; /**< mean FLIP error (Andersson et al. 2020), LDR, 67 pixels a degree */
    size_t n_not_finite; /**< pixels left out since one of them is not finite */
} image_difference;

/** @brief Compares a with the reference b. ERROR_INPUT if sizes differ or R, G, B are
 * missing. */
bool image_compare(const image *a, const image *b, image_difference *out, GError **error);

/** @brief Where a differs from the reference b, as colours: black where they agree, from
 * red to white where a is brighter, from blue to white where it is darker. The whole
 * scale is half of b's luminance, or where b is darker than a tenth of its mean, half of
 * that; green is not finite. Errors as above. */
image *image_difference_map(const image *a, const image *b, GError **error);
