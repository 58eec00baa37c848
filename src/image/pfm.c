/*
 * Portable float map: "PF" (RGB) or "Pf" (grey), width and height, a scale whose sign
 * tells the byte order (negative: little endian), then rows of floats, bottom row first.
 * Debevec, "PFM Portable FloatMap Image Format", netpbm manual page pfm(5).
 */
#include "base/wanted.h"
#include "image/codec.h"

#include <math.h>
#include <string.h>

typedef struct pfm_header {
    int64_t width, height;
    int n_values; /* per pixel: 3 or 1 */
    float scale;  /* its magnitude */
    bool little_endian;
    size_t data; /* where the floats begin */
} pfm_header;

static bool recognises(const image_source *source)
{
    const uint8_t *b = source->bytes;
    return source->size >= 3 && b[0] == 'P' && (b[1] == 'F' || b[1] == 'f') &&
           g_ascii_isspace((char)b[2]);
}

static bool is_comment(const uint8_t *c, const uint8_t *end)
{
    return c < end && *c == '#';
}

/* The next word of the header; a comment runs from # to the end of its line. */
static bool next_word(const image_source *source, size_t *at, char *word, size_t size)
{
    const uint8_t *c = source->bytes + *at, *end = source->bytes + source->size;
    while (c < end && (g_ascii_isspace((char)*c) || is_comment(c, end))) {
        bool comment = is_comment(c, end);
        do
            c++;
        while (comment && c < end && c[-1] != '\n');
    }
    size_t length = 0;
    while (c < end && !g_ascii_isspace((char)*c) && length + 1 < size)
        word[length++] = (char)*c++;
    word[length] = '\0';
    *at = (size_t)(c - source->bytes);
    return length > 0 && c < end && g_ascii_isspace((char)*c);
}

static bool read_header(const image_source *source, pfm_header *header)
{
    char word[32];
    size_t at = 0;
    if (!next_word(source, &at, word, sizeof word))
        return false;
    header->n_values = word[1] == 'F' ? 3 : 1;
    if (!next_word(source, &at, word, sizeof word))
        return false;
    header->width = g_ascii_strtoll(word, NULL, 10);
    if (!next_word(source, &at, word, sizeof word))
        return false;
    header->height = g_ascii_strtoll(word, NULL, 10);
    if (!next_word(source, &at, word, sizeof word))
        return false;
    double scale = g_ascii_strtod(word, NULL);
    header->little_endian = scale < 0;
    header->scale = (float)fabs(scale);
    header->data = at + 1;
    return header->scale > 0.0f && isfinite(header->scale);
}

static float read_float(const uint8_t *bytes, bool little_endian)
{
    uint32_t bits;
    float value;
    memcpy(&bits, bytes, sizeof bits);
    bits = little_endian ? GUINT32_FROM_LE(bits) : GUINT32_FROM_BE(bits);
    memcpy(&value, &bits, sizeof value);
    return value;
}

static void read_row(const pfm_header *header, const uint8_t *bytes, float *row)
{
    int n = header->n_values;
    for (int x = 0; x < (int)header->width; x++)
        for (int c = 0; c < 3; c++) {
            size_t i = (size_t)x * (size_t)n + (size_t)(c % n);
            row[3 * x + c] =
                read_float(bytes + 4 * i, header->little_endian) * header->scale;
        }
}

static image *read_pfm(const image_source *source, const image_read_options *options,
                       GError **error)
{
    (void)options;
    pfm_header header;
    if (!read_header(source, &header)) {
        source_damaged(source, codec_pfm.name, "its header is not whole", error);
        return NULL;
    }
    double pixel_size = 4.0 * header.n_values;
    if (!source_size_possible(source, header.width, header.height, pixel_size, 1, error))
        return NULL;
    size_t row_size = (size_t)(header.width * header.n_values) * 4;
    if (source->size - header.data < row_size * (size_t)header.height) {
        source_damaged(source, codec_pfm.name, "it ends early", error);
        return NULL;
    }
    int width = (int)header.width, height = (int)header.height;
    image *img = image_new(width, height, 3, rgba_names, error);
    for (int y = 0; img && y < height && still_wanted(NULL); y++)
        read_row(&header, source->bytes + header.data + (size_t)y * row_size,
                 img->pixels + (size_t)(height - 1 - y) * (size_t)width * 3);
    return img;
}

static bool write_pfm(const image *img, const image_sink *sink,
                      const image_write_options *options, GError **error)
{
    (void)options;
    int rgba[4];
    if (!image_raw(img, sink->path, rgba, error))
        return false;
    fprintf(sink->stream, "PF\n%d %d\n-1\n", img->width, img->height);
    for (int y = img->height - 1; y >= 0 && sink_wants(sink); y--)
        for (int x = 0; x < img->width; x++) {
            size_t pixel = (size_t)y * (size_t)img->width + (size_t)x;
            const float *p = img->pixels + pixel * (size_t)img->n_channels;
            uint32_t bits[3];
            for (int c = 0; c < 3; c++) {
                memcpy(&bits[c], &p[rgba[c]], sizeof bits[c]);
                bits[c] = GUINT32_TO_LE(bits[c]);
            }
            fwrite(bits, sizeof bits, 1, sink->stream);
        }
    return true;
}

static const char *const extensions[] = {".pfm", NULL};
const image_codec codec_pfm = {"PFM", extensions, recognises, read_pfm, write_pfm, false};
