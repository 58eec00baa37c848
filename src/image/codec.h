/*
 * What a file format gives to the table in codec.c, and the few tools all formats share.
 *
 * A reader sees the whole file as bytes in memory (so that nothing but bounds stands
 * between it and a damaged file); a writer writes to a stream that codec.c later syncs
 * and renames. Every message begins with the file's name.
 */
#pragma once

#include "base/parallel.h"
#include "image/image.h"
#include "image/layers.h"

#include <stdint.h>
#include <stdio.h>

/** @brief A file being read. bytes[size] is a zero, so that text in it ends. */
typedef struct image_source {
    const char *path; /**< for messages */
    const uint8_t *bytes;
    size_t size;
} image_source;

/** @brief A file being written: an empty, seekable stream, and the name it will have. */
typedef struct image_sink {
    const char *path; /**< for messages */
    FILE *stream;
    const cancel_flag *cancel; /**< asked by sink_wants; may be NULL */
} image_sink;

/** @brief To be asked before each row. @return false: nobody wants the file any more, and
 * what comes of it does not count */
static inline bool sink_wants(const image_sink *sink)
{
    return !cancel_tell_progress(sink->cancel);
}

/** @brief One file format. */
typedef struct image_codec {
    const char *name;              /**< "OpenEXR", for messages */
    const char *const *extensions; /**< ".exr" ..., NULL-terminated */
    bool (*recognises)(const image_source *source);
    image *(*read)(const image_source *source, const image_read_options *options,
                   GError **error);
    /** Write failures of the stream need not be noticed: the caller asks ferror. NULL: it
     * is only read. */
    bool (*write)(const image *img, const image_sink *sink,
                  const image_write_options *options, GError **error);
    bool eight_bits; /**< what is written is as it is seen: tone curve, eight bits */
} image_codec;

#define CODEC(name, file) extern const image_codec codec_##name;
#include "image/codec.def"
#undef CODEC

/** @brief ERROR_INPUT "path: damaged NAME file: ..." for a file that breaks its format.
 */
void source_damaged(const image_source *source, const char *format_name,
                    const char *message, GError **error);

/**
 * @brief Whether a claimed size can be true: positive, fewer than 2³¹ pixels, and not
 * more than ratio times as many bytes as the file has.
 * @param bytes_per_pixel of the uncompressed data
 * @param ratio the most that the format's compression can gain
 * @return false with ERROR_INPUT naming the file
 */
bool source_size_possible(const image_source *source, int64_t width, int64_t height,
                          double bytes_per_pixel, double ratio, GError **error);

/** @brief Copies the line that begins at *at without its line end and moves *at behind
 * it. @return false if there is no line end before `size` characters or the file's end.
 */
bool source_line(const image_source *source, size_t *at, char *line, size_t size);

/** @brief Linear values of the integer codes 0 .. n_codes - 1 of an image file; owned by
 * the caller (g_free). */
float *encoding_table(const image_read_options *options, unsigned n_codes);

/** @brief image_colors. @return false with ERROR_INPUT if there are none. */
bool image_raw(const image *img, const char *path, int rgba[4], GError **error);
/** @brief The same of image_find_shown. */
bool image_to_show(const image *img, const char *path, image_shown *out, GError **error);

/** @brief The 8-bit sRGB code of a linear value; not finite counts as 0. */
uint8_t srgb_code(float linear);

/** @brief The names of the channels of every format but EXR: R, G, B, A. */
extern const char *const rgba_names[4];
