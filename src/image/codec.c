#define _GNU_SOURCE /* fopencookie */
#include "image/codec.h"

#include "base/input.h"
#include "base/memory.h"
#include "base/output.h"
#include "image/layers.h"

#include <glib/gstdio.h>
#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

static const image_codec *const codecs[] = {
#define CODEC(name, file) &codec_##name,
#include "image/codec.def"
#undef CODEC
};

const char *const rgba_names[4] = {"R", "G", "B", "A"};

void source_damaged(const image_source *source, const char *format_name,
                    const char *message, GError **error)
{
    error_set(error, ERROR_INPUT, "%s: damaged %s file: %s", source->path, format_name,
              message);
}

bool source_size_possible(const image_source *source, int64_t width, int64_t height,
                          double bytes_per_pixel, double ratio, GError **error)
{
    double n_pixels = (double)width * (double)height;
    bool sane = width > 0 && height > 0 && n_pixels <= (double)INT_MAX;
    if (sane && n_pixels * bytes_per_pixel <= ratio * (double)source->size)
        return true;
    error_set(error, ERROR_INPUT,
              "%s: a file of %zu bytes cannot hold the %" G_GINT64_FORMAT
              " x %" G_GINT64_FORMAT " pixels it claims",
              source->path, source->size, width, height);
    return false;
}

bool source_line(const image_source *source, size_t *at, char *line, size_t size)
{
    const uint8_t *begin = source->bytes + *at;
    const uint8_t *end = memchr(begin, '\n', source->size - *at);
    if (!end || (size_t)(end - begin) >= size)
        return false;
    size_t length = (size_t)(end - begin);
    memcpy(line, begin, length);
    line[length] = '\0';
    *at += length + 1;
    return true;
}

float *encoding_table(const image_read_options *options, unsigned n_codes)
{
    image_encoding encoding = options ? options->encoding : ENCODING_AUTO;
    float *table = g_new(float, n_codes);
    for (unsigned i = 0; i < n_codes; i++) {
        float v = (float)i / (float)(n_codes - 1);
        if (encoding == ENCODING_LINEAR)
            table[i] = v;
        else if (encoding == ENCODING_GAMMA)
            table[i] = powf(v, options->gamma);
        else
            table[i] = srgb_decode(v);
    }
    return table;
}

static bool has_colors(bool found, const char *path, GError **error)
{
    if (found)
        return true;
    error_set(error, ERROR_INPUT, "%s: the image has no channels 'R', 'G', 'B' or 'Y'",
              path);
    return false;
}

bool image_raw(const image *img, const char *path, int rgba[4], GError **error)
{
    return has_colors(image_colors(img, rgba), path, error);
}

bool image_to_show(const image *img, const char *path, image_shown *out, GError **error)
{
    return has_colors(image_find_shown(img, out), path, error);
}

uint8_t srgb_code(float linear)
{
    if (!(linear > 0.0f) || isinf(linear))
        return 0;
    float encoded = srgb_encode(linear);
    return encoded < 1.0f ? (uint8_t)(encoded * 255.0f + 0.5f) : 255;
}

/* ---- reading ---- */

static const image_codec *codec_of_content(const image_source *source)
{
    for (size_t i = 0; i < G_N_ELEMENTS(codecs); i++)
        if (codecs[i]->recognises(source))
            return codecs[i];
    return NULL;
}

/* The message of a failure that did not name the file (memory) is made to name it. */
static void name_file(const char *path, GError **error)
{
    if (error && *error && !strstr((*error)->message, path))
        g_prefix_error(error, "%s: ", path);
}

/* "OpenEXR, PNG, ..." */
static char *names_of_codecs(void)
{
    GString *all = g_string_new(NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(codecs); i++)
        g_string_append_printf(all, "%s%s", i ? ", " : "", codecs[i]->name);
    return g_string_free(all, FALSE);
}

static image *read_source(const image_source *source, const image_read_options *options,
                          GError **error)
{
    const image_codec *codec = codec_of_content(source);
    if (!codec) {
        g_autofree char *known = names_of_codecs();
        error_set(error, ERROR_INPUT, "%s: not an image in a format that is known (%s)",
                  source->path, known);
        return NULL;
    }
    image *img = codec->read(source, options, error);
    if (!img)
        name_file(source->path, error);
    return img;
}

static image *read_path(const char *path, const image_read_options *options,
                        GError **error)
{
    input in;
    if (!input_read(&in, path, error))
        return NULL;
    image_source source = {path, (const uint8_t *)in.data, in.size};
    image *img = read_source(&source, options, error);
    input_close(&in);
    return img;
}

image *image_read(const char *path, const image_read_options *options, GError **error)
{
    GStatBuf about;
    size_t size = g_stat(path, &about) == 0 ? (size_t)about.st_size : 0;
    if (!memory_reserve(size, "the file", error)) {
        name_file(path, error);
        return NULL;
    }
    image *img = read_path(path, options, error);
    memory_release(size);
    return img;
}

/* Codecs may read the zero behind the bytes. */
image *image_read_bytes(const char *name, GBytes *bytes,
                        const image_read_options *options, GError **error)
{
    gsize size;
    const uint8_t *data = g_bytes_get_data(bytes, &size);
    uint8_t *copy = big_alloc(size + 1, 1, "the file", error);
    if (!copy) {
        name_file(name, error);
        return NULL;
    }
    if (size)
        memcpy(copy, data, size);
    image_source source = {name, copy, size};
    image *img = read_source(&source, options, error);
    big_free(copy);
    return img;
}

enum { MOST_EXTENSIONS = 32 };

/* Of all codecs, and of those that write. */
static const char *all_extensions[MOST_EXTENSIONS], *written_extensions[MOST_EXTENSIONS];

static void list_extensions(void)
{
    size_t n = 0, n_written = 0;
    for (size_t i = 0; i < G_N_ELEMENTS(codecs); i++)
        for (const char *const *e = codecs[i]->extensions; *e; e++) {
            g_assert(n + 1 < MOST_EXTENSIONS);
            all_extensions[n++] = *e;
            if (codecs[i]->write)
                written_extensions[n_written++] = *e;
        }
}

static pthread_once_t extensions_listed = PTHREAD_ONCE_INIT;

const char *const *image_extensions(void)
{
    pthread_once(&extensions_listed, list_extensions);
    return all_extensions;
}

const char *const *image_written_extensions(void)
{
    pthread_once(&extensions_listed, list_extensions);
    return written_extensions;
}

/* ---- writing ---- */

/* By the path's end. @param known gets the ends that are written */
static const image_codec *find_writer(const char *path, GString *known)
{
    g_autofree char *lower = g_ascii_strdown(path, -1);
    for (size_t i = 0; i < G_N_ELEMENTS(codecs); i++)
        for (const char *const *e = codecs[i]->extensions; *e && codecs[i]->write; e++) {
            if (g_str_has_suffix(lower, *e))
                return codecs[i];
            g_string_append_printf(known, "%s%s", known->len ? ", " : "", *e);
        }
    return NULL;
}

static const image_codec *codec_of_name(const char *path, GError **error)
{
    g_autoptr(GString) known = g_string_new(NULL);
    const image_codec *found = find_writer(path, known);
    if (!found)
        error_set(error, ERROR_INPUT, "%s: an image's name must end in one of %s", path,
                  known->str);
    return found;
}

bool image_is_written(const char *path, bool *eight_bits)
{
    g_autoptr(GString) known = g_string_new(NULL);
    const image_codec *found = find_writer(path, known);
    *eight_bits = found && found->eight_bits;
    return found != NULL;
}

bool image_can_write(const char *path, GError **error)
{
    return codec_of_name(path, error) && output_possible(path, error);
}

bool image_write(const image *img, const char *path, const image_write_options *options,
                 GError **error)
{
    static const image_write_options plain = {.exposure = 0.0f};
    const image_codec *codec = codec_of_name(path, error);
    g_autoptr(output) out = codec ? output_open(path, error) : NULL;
    if (!out)
        return false;
    const image_write_options *how = options ? options : &plain;
    output_watch(out, how->cancel);
    image_sink sink = {path, output_stream(out), how->cancel};
    g_autoptr(GError) refused = NULL;
    bool written = codec->write(img, &sink, how, &refused);
    if (written || cancelled(how->cancel))
        return output_commit(g_steal_pointer(&out), error);
    name_file(path, &refused);
    g_propagate_error(error, g_steal_pointer(&refused));
    return false;
}

/* What a disk takes for a byte, s: a common one, since trying it out would take as long.
 */
#define DISK_SECONDS 5e-9

/* A stream that goes nowhere: where it is, and how far it came. */
typedef struct byte_count {
    off64_t at, end;
} byte_count;

static ssize_t count_bytes(void *stream, const char *bytes, size_t n)
{
    (void)bytes;
    byte_count *count = stream;
    count->at += (off64_t)n;
    count->end = MAX(count->end, count->at);
    return (ssize_t)n;
}

static int seek_count(void *stream, off64_t *offset, int whence)
{
    byte_count *count = stream;
    off64_t from[] = {[SEEK_SET] = 0, [SEEK_CUR] = count->at, [SEEK_END] = count->end};
    *offset = count->at = from[whence] + *offset;
    return 0;
}

double image_write_seconds(const image *img, const char *path)
{
    static const cookie_io_functions_t counting = {.write = count_bytes,
                                                   .seek = seek_count};
    const image_codec *codec = codec_of_name(path, NULL);
    const image_write_options plain = {.exposure = 0.0f};
    byte_count count = {0, 0};
    FILE *nowhere = codec ? fopencookie(&count, "wb", counting) : NULL;
    if (!nowhere)
        return 0.0;
    const image_sink sink = {path, nowhere, NULL};
    int64_t start = g_get_monotonic_time();
    codec->write(img, &sink, &plain, NULL);
    fclose(nowhere);
    double packed = (double)(g_get_monotonic_time() - start) * 1e-6;
    return packed + DISK_SECONDS * (double)count.end;
}
