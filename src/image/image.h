/*
 * Pixel buffers with named channels, and the table of file formats behind one pair of
 * calls.
 *
 *   pixels[(y * width + x) * n_channels + c], row 0 at the top, float, linear unless
 * said.
 */
#pragma once

#include "base/parallel.h"

#include <stddef.h>

/** @brief An image. Owned by who made it; plain data, no locks. */
typedef struct image {
    int width, height, n_channels;
    char *
        *channels; /**< n_channels names, "R", "G", "B", "A", "direct.R", "depth.Z" ... */
    float *pixels; /**< width * height * n_channels, big_alloc */
    GHashTable *header; /**< char* -> char*: metadata, written to and read from EXR; may
                           be NULL */
    float
        chromaticities[8]; /**< xy of R, G, B, white; all zero: not stated (then sRGB) */
} image;

/** @brief How the codes of an integer file (PNG, JPEG) become linear numbers. Float files
 * are linear whatever is asked, as they are in pbrt; so is alpha. */
typedef enum image_encoding {
    ENCODING_AUTO, /**< sRGB for integer files, linear for float files */
    ENCODING_SRGB,
    ENCODING_LINEAR,
    ENCODING_GAMMA, /**< a power, given apart */
} image_encoding;

typedef struct image_read_options {
    image_encoding encoding;
    float gamma; /**< for ENCODING_GAMMA */
} image_read_options;

typedef struct image_write_options {
    float exposure;            /**< stops applied to 8-bit output: value * 2^exposure */
    const cancel_flag *cancel; /**< asked again and again; may be NULL */
} image_write_options;

/** @brief A black image with the given channels (names copied). NULL: absurd size or
 * memory. */
image *image_new(int width, int height, int n_channels, const char *const *channels,
                 GError **error);
void image_free(image *img);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(image, image_free)

/** @brief R, G, B: for image_new. */
extern const char *const image_rgb_names[3];

/** @brief Index of a channel by name, or -1. */
int image_channel(const image *img, const char *name);
/** @brief Indices of R, G, B and A, whatever their order in the image; A is -1 where
 * there is none. Grey (Y, or the only channel) stands for R, G and B.
 *  @return false: there are no colours */
bool image_colors(const image *img, int rgba[4]);
/** @brief A string of the header, or NULL. */
const char *image_header_get(const image *img, const char *key);
void image_header_set(image *img, const char *key, const char *value);

/** @brief Reads EXR, PNG (8/16 bit), JPEG, HDR (RGBE), PFM, BMP or TGA, by content not by
 * name. EXR keeps its channels' names (sorted) and its data window only; every other
 * format gives R, G, B, grey repeated, and a PNG with transparency A.
 *  @param options NULL = automatic. @return NULL with ERROR_INPUT naming the file when it
 *  cannot be read, is damaged or claims a size it cannot hold. */
image *image_read(const char *path, const image_read_options *options, GError **error);
/** @brief The same for a file that is in memory (part of a .glb, say).
 *  @param name for messages */
image *image_read_bytes(const char *name, GBytes *bytes,
                        const image_read_options *options, GError **error);

/** @brief Writes by the name's extension (.exr, .png, .jpg, .hdr, .pfm): to a temporary
 * name beside it, synced and renamed, so that no partial file is ever seen under the
 * name. Formats other than EXR write channels R, G, B (and A for PNG, as it stands) only,
 * those of eight bits image_shown_pixel; EXR writes all, as 32-bit float, and the header
 * as string attributes.
 *  @param options NULL = exposure 0. @return false with ERROR_INPUT (unknown extension,
 *  unwritable, no R, G, B) or ERROR_FAILED (disk);
 *  with ERROR_CANCELLED once it is cancelled. */
bool image_write(const image *img, const char *path, const image_write_options *options,
                 GError **error);

/** @brief What names of files that can be read end in, with the dot; NULL-terminated,
 * static. */
const char *const *image_extensions(void);
/** @brief The same of those that can be written. */
const char *const *image_written_extensions(void);

/** @brief Whether image_write knows the path's extension.
 * @param eight_bits whether what it writes there is as it is seen, with eight bits */
bool image_is_written(const char *path, bool *eight_bits);

/** @brief About how long image_write would take for the image, s: writes it nowhere. */
double image_write_seconds(const image *img, const char *path);

/** @brief Whether image_write knows the path's extension and its folder is writable:
 * asked before a long render. */
bool image_can_write(const char *path, GError **error);

/** @brief sRGB's transfer functions (IEC 61966-2-1). */
float srgb_encode(float linear);
float srgb_decode(float encoded);
