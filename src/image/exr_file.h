/*
 * Reading OpenEXR files through OpenEXR's C++ library, in C's plainest types: the one
 * file of C++ stands behind this header.
 */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct exr_string {
    const char *name, *value;
} exr_string;

/** @brief The first flat part of a file: what one must know before its pixels are read.
 */
typedef struct exr_description {
    int64_t width, height; /**< of the data window */
    size_t n_channels;
    const char *const *channels;     /**< names, sorted */
    const char *subsampled;          /**< the first channel that is; NULL: none */
    double bytes_per_pixel;          /**< in the file, uncompressed */
    double best_ratio;               /**< the most that its compression can gain */
    int64_t tile_width, tile_height; /**< 0: scanlines */
    bool has_chromaticities;
    float chromaticities[8]; /**< xy of R, G, B, white */
    size_t n_strings;
    const exr_string *strings; /**< attributes */
} exr_description;

/** @brief Makes room for pixels[(row * width + column) * n_channels + channel].
 * @param part valid during this call
 * @return the room, which stays the caller's; NULL: the file is not wanted */
typedef float *(*exr_place_function)(const exr_description *part, void *data);

typedef enum exr_result {
    EXR_READ,
    EXR_NOT_WANTED, /**< place gave NULL */
    EXR_ONLY_DEEP,
    EXR_DAMAGED,
    EXR_NO_MEMORY,
} exr_result;

/** @brief Where a file goes. */
typedef struct exr_target {
    exr_place_function place;
    void *data;              /**< for it */
    bool (*is_wanted)(void); /**< asked again and again: false ends reading */
} exr_target;

/** @brief Reads a file in memory, all channels as float; of a tiled part the largest
 * level. The lengths that the header states must lie within the file. Calls on several
 * threads at once are allowed.
 * @param path for messages
 * @param message gets why the file is damaged */
exr_result exr_file_read(const char *path, const uint8_t *bytes, size_t size,
                         const exr_target *to, char message[300]);

#ifdef __cplusplus
}
#endif
