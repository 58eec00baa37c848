/*
 * What else is to be known of writing OpenEXR (codec.h).
 */
#pragma once

#include <stddef.h>

/** @brief Bytes that packing an image takes beside the image. */
size_t exr_writing_bytes(int width, int height, int n_channels);
