/*
 * OpenEXR files as others write them, written by OpenEXR's C++ library, with values known
 * in closed form.
 */
#pragma once

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Small, yet more than one tile either way and one chunk of lines, the last ones cut. */
enum {
    EXR_WIDTH = 15,
    EXR_HEIGHT = 34,
    EXR_TILE_WIDTH = 8,
    EXR_TILE_HEIGHT = 32,
    EXR_N_COMPRESSIONS = 10
};

typedef enum exr_values {
    EXR_UINT,
    EXR_HALF,
    EXR_FLOAT,
    EXR_MIXED,
    EXR_N_VALUES
} exr_values;

typedef enum exr_layout {
    EXR_SCANLINES,
    EXR_SCANLINES_UPWARDS,
    EXR_TILES,
    EXR_TILES_MIPMAPPED,
    EXR_TILES_RIPMAPPED,
    EXR_SECOND_PART, /**< scanlines; the first is deep */
    EXR_N_LAYOUTS
} exr_layout;

typedef struct exr_kind {
    const char *const *channels; /**< in any order; NULL-terminated */
    exr_values values;           /**< mixed: the types by turns */
    exr_layout layout;
    int compression; /**< Imf::Compression: 0 none, rle, zips, zip, piz, pxr24, b44, b44a,
                        dwaa, dwab */
} exr_kind;

/** @brief The value of the kind's channel c at column x, row y. Half holds it, too. */
float exr_kind_value(const exr_kind *kind, int c, int x, int y);

/** @brief The most that the channel's values may be off, relative, for its compression;
 * 0: not at all. */
double exr_kind_tolerance(const exr_kind *kind, int c);

/** @brief Writes EXR_WIDTH x EXR_HEIGHT pixels, whose window does not begin at zero.
 * Smaller levels hold another value than the largest. */
void exr_kind_write(const exr_kind *kind, const char *path);

#ifdef __cplusplus
}
#endif
