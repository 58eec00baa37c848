/*
 * Radiance pictures: text lines, a resolution line, then scanlines of four bytes a pixel:
 * three mantissas that share an exponent. Scanlines are flat, run-length coded pixel by
 * pixel (old), or component by component (new, marked by 2, 2, width).
 *
 *   value = mantissa * 2^(exponent - 136)
 *
 * The mantissas are rounded when written and taken as they are when read, which is what
 * pbrt's reader does too. An EXPOSURE line is kept in the image's header, not applied.
 * Ward, "Real Pixels", Graphics Gems II, 1991.
 */
#include "base/wanted.h"
#include "image/codec.h"

#include <math.h>
#include <string.h>

enum { MIN_CODED_WIDTH = 8, MAX_CODED_WIDTH = 0x7fff, LONGEST_RUN = 127 };

/* Where scanline s, pixel i lies: at origin + s * line + i * step, in pixels. */
typedef struct layout {
    int width, height;        /* of the image */
    int n_lines, line_length; /* of the file */
    ptrdiff_t origin, line, step;
} layout;

typedef struct reader {
    const image_source *source;
    size_t at;
    uint8_t *scanline; /* line_length pixels of R, G, B, E */
    int length;
} reader;

static bool recognises(const image_source *source)
{
    return source->size > 10 && (memcmp(source->bytes, "#?RADIANCE", 10) == 0 ||
                                 memcmp(source->bytes, "#?RGBE", 6) == 0);
}

/* ---- reading ---- */

static bool parse_axis(char **text, char *sign, char *axis, int64_t *n)
{
    char *c = g_strchug(*text);
    if ((c[0] != '+' && c[0] != '-') || (c[1] != 'X' && c[1] != 'Y'))
        return false;
    *sign = c[0];
    *axis = c[1];
    *n = g_ascii_strtoll(c + 2, text, 10);
    return *text != c + 2 && *n > 0 && *n <= G_MAXINT;
}

/* "-Y height +X width" or any other of the eight orders; +Y counts upwards. */
static bool parse_resolution(char *text, layout *out)
{
    char signs[2], axes[2];
    int64_t n[2];
    if (!parse_axis(&text, &signs[0], &axes[0], &n[0]) ||
        !parse_axis(&text, &signs[1], &axes[1], &n[1]) || axes[0] == axes[1])
        return false;
    out->n_lines = (int)n[0];
    out->line_length = (int)n[1];
    out->width = (int)(axes[0] == 'X' ? n[0] : n[1]);
    out->height = (int)(axes[0] == 'Y' ? n[0] : n[1]);
    ptrdiff_t steps[2];
    out->origin = 0;
    for (int i = 0; i < 2; i++) {
        bool backwards = axes[i] == 'X' ? signs[i] == '-' : signs[i] == '+';
        steps[i] = axes[i] == 'X' ? 1 : out->width;
        out->origin += backwards ? (ptrdiff_t)(n[i] - 1) * steps[i] : 0;
        steps[i] = backwards ? -steps[i] : steps[i];
    }
    out->line = steps[0];
    out->step = steps[1];
    return true;
}

static void parse_primaries(const char *text, float chromaticities[8])
{
    char *next = NULL;
    for (int i = 0; i < 8; i++, text = next)
        chromaticities[i] = (float)g_ascii_strtod(text, &next);
}

/* The header's lines into keys; @return false at a format that is not RGBE. */
static bool read_header(reader *r, image *info, GError **error)
{
    char line[512];
    while (source_line(r->source, &r->at, line, sizeof line)) {
        if (line[0] == '\0' || strcmp(line, "\r") == 0)
            return true;
        char *equals = strchr(line, '=');
        if (line[0] == '#' || !equals)
            continue;
        *equals = '\0';
        const char *value = g_strstrip(equals + 1);
        if (strcmp(line, "FORMAT") == 0 && strcmp(value, "32-bit_rle_rgbe") != 0) {
            error_set(error, ERROR_INPUT, "%s: Radiance format '%s' is not supported",
                      r->source->path, value);
            return false;
        }
        if (strcmp(line, "PRIMARIES") == 0)
            parse_primaries(value, info->chromaticities);
        else if (strcmp(line, "FORMAT") != 0)
            image_header_set(info, line, value);
    }
    source_damaged(r->source, codec_hdr.name, "its header does not end", error);
    return false;
}

static bool read_new_component(reader *r, int component)
{
    const uint8_t *bytes = r->source->bytes;
    int x = 0;
    while (x < r->length) {
        if (r->at >= r->source->size)
            return false;
        int count = bytes[r->at++];
        bool run = count > 128;
        count -= run ? 128 : 0;
        size_t needed = run ? 1 : (size_t)count;
        if (count == 0 || x + count > r->length || r->source->size - r->at < needed)
            return false;
        for (int i = 0; i < count; i++, x++)
            r->scanline[4 * x + component] = bytes[r->at + (run ? 0 : (size_t)i)];
        r->at += needed;
    }
    return true;
}

/* Flat pixels, where 1, 1, 1, n repeats the last pixel n times, and a second such mark
 * right after counts n * 256, and so on. */
static bool read_old_scanline(reader *r)
{
    int x = 0, shift = 0;
    while (x < r->length) {
        if (r->source->size - r->at < 4)
            return false;
        const uint8_t *p = r->source->bytes + r->at;
        r->at += 4;
        if (p[0] != 1 || p[1] != 1 || p[2] != 1) {
            memcpy(r->scanline + 4 * (size_t)x++, p, 4);
            shift = 0;
            continue;
        }
        int64_t count = shift <= 24 ? (int64_t)p[3] << shift : G_MAXINT;
        if (x == 0 || count > r->length - x)
            return false;
        for (; count > 0; count--, x++)
            memcpy(r->scanline + 4 * (size_t)x, r->scanline + 4 * (size_t)(x - 1), 4);
        shift += 8;
    }
    return true;
}

static bool is_new_scanline(const reader *r)
{
    const uint8_t *p = r->source->bytes + r->at;
    return r->length >= MIN_CODED_WIDTH && r->length <= MAX_CODED_WIDTH &&
           r->source->size - r->at >= 4 && p[0] == 2 && p[1] == 2 && (p[2] & 0x80) == 0;
}

static bool read_scanline(reader *r)
{
    if (!is_new_scanline(r))
        return read_old_scanline(r);
    const uint8_t *p = r->source->bytes + r->at;
    if ((p[2] << 8 | p[3]) != r->length)
        return false;
    r->at += 4;
    for (int component = 0; component < 4; component++)
        if (!read_new_component(r, component))
            return false;
    return true;
}

static void decode_scanline(const reader *r, float *first, ptrdiff_t step)
{
    for (int x = 0; x < r->length; x++, first += 3 * step) {
        const uint8_t *p = r->scanline + 4 * (size_t)x;
        float scale = p[3] > 0 ? ldexpf(1.0f, (int)p[3] - 136) : 0.0f;
        for (int c = 0; c < 3; c++)
            first[c] = (float)p[c] * scale;
    }
}

static bool read_pixels(reader *r, const layout *l, image *img, GError **error)
{
    r->length = l->line_length;
    g_autofree uint8_t *scanline = g_try_malloc_n((gsize)r->length, 4);
    r->scanline = scanline;
    for (int s = 0; scanline && s < l->n_lines; s++) {
        if (!still_wanted(error))
            return false;
        if (!read_scanline(r)) {
            source_damaged(r->source, codec_hdr.name, "its pixels are not whole", error);
            return false;
        }
        decode_scanline(r, img->pixels + 3 * (l->origin + s * l->line), l->step);
    }
    if (!scanline)
        error_set(error, ERROR_FAILED, "out of memory");
    return scanline != NULL;
}

static void move_header(image *from, image *to)
{
    to->header = g_steal_pointer(&from->header);
    memcpy(to->chromaticities, from->chromaticities, sizeof to->chromaticities);
}

static image *read_after_header(reader *r, image *info, GError **error)
{
    const double best_ratio = 4096; /* a scanline of one colour in the old coding */
    char line[128];
    layout l;
    if (!source_line(r->source, &r->at, line, sizeof line) ||
        !parse_resolution(line, &l)) {
        source_damaged(r->source, codec_hdr.name, "it has no resolution", error);
        return NULL;
    }
    if (!source_size_possible(r->source, l.width, l.height, 4, best_ratio, error))
        return NULL;
    g_autoptr(image) img = image_new(l.width, l.height, 3, rgba_names, error);
    if (!img || !read_pixels(r, &l, img, error))
        return NULL;
    move_header(info, img);
    return g_steal_pointer(&img);
}

static image *read_hdr(const image_source *source, const image_read_options *options,
                       GError **error)
{
    (void)options;
    reader r = {.source = source};
    image info = {0};
    image *img = NULL;
    if (read_header(&r, &info, error))
        img = read_after_header(&r, &info, error);
    if (info.header)
        g_hash_table_unref(info.header);
    return img;
}

/* ---- writing ---- */

static void encode_pixel(const float *rgb, uint8_t out[4])
{
    float largest = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
    memset(out, 0, 4);
    if (!(largest > 1e-32f))
        return;
    int exponent;
    frexpf(largest, &exponent);
    if (ldexpf(largest, 8 - exponent) >= 255.5f)
        exponent++;
    for (int c = 0; c < 3; c++)
        out[c] = rgb[c] > 0.0f ? (uint8_t)(ldexpf(rgb[c], 8 - exponent) + 0.5f) : 0;
    out[3] = (uint8_t)(exponent + 128);
}

static float writable(float v)
{
    const float largest = 1.69e38f; /* just below 255 * 2^(255 - 136) */
    return isfinite(v) ? fminf(v, largest) : 0.0f;
}

static int run_length(const uint8_t *p, int n)
{
    int length = 1;
    while (length < n && length < LONGEST_RUN && p[4 * length] == p[0])
        length++;
    return length;
}

/* Runs of four or more become runs, all else is copied. */
static void write_component(FILE *stream, const uint8_t *p, int n)
{
    const int worth_it = 4;
    for (int x = 0; x < n;) {
        int run = run_length(p + 4 * x, n - x);
        if (run >= worth_it) {
            fputc(128 + run, stream);
            fputc(p[4 * x], stream);
            x += run;
            continue;
        }
        int begin = x;
        while (x < n && x - begin < LONGEST_RUN &&
               run_length(p + 4 * x, n - x) < worth_it)
            x++;
        fputc(x - begin, stream);
        for (int i = begin; i < x; i++)
            fputc(p[4 * i], stream);
    }
}

static void write_scanline(FILE *stream, const uint8_t *scanline, int width)
{
    if (width < MIN_CODED_WIDTH || width > MAX_CODED_WIDTH) {
        fwrite(scanline, 4, (size_t)width, stream);
        return;
    }
    const uint8_t mark[4] = {2, 2, (uint8_t)(width >> 8), (uint8_t)(width & 0xff)};
    fwrite(mark, sizeof mark, 1, stream);
    for (int component = 0; component < 4; component++)
        write_component(stream, scanline + component, width);
}

static void write_header(const image *img, FILE *stream)
{
    char number[G_ASCII_DTOSTR_BUF_SIZE];
    fprintf(stream, "#?RADIANCE\nSOFTWARE=Nephroid\nFORMAT=32-bit_rle_rgbe\n");
    if (img->chromaticities[0] > 0.0f) {
        fputs("PRIMARIES=", stream);
        for (int i = 0; i < 8; i++)
            fprintf(stream, " %s",
                    g_ascii_formatd(number, sizeof number, "%.5g",
                                    (double)img->chromaticities[i]));
        fputc('\n', stream);
    }
    fprintf(stream, "\n-Y %d +X %d\n", img->height, img->width);
}

static bool write_hdr(const image *img, const image_sink *sink,
                      const image_write_options *options, GError **error)
{
    (void)options;
    int rgba[4];
    if (!image_raw(img, sink->path, rgba, error))
        return false;
    g_autofree uint8_t *scanline = g_malloc_n((gsize)img->width, 4);
    const float *p = img->pixels;
    write_header(img, sink->stream);
    for (int y = 0; y < img->height && sink_wants(sink); y++) {
        for (int x = 0; x < img->width; x++, p += img->n_channels) {
            const float v[3] = {writable(p[rgba[0]]), writable(p[rgba[1]]),
                                writable(p[rgba[2]])};
            encode_pixel(v, scanline + 4 * (size_t)x);
        }
        write_scanline(sink->stream, scanline, img->width);
    }
    return true;
}

static const char *const extensions[] = {".hdr", ".pic", NULL};
const image_codec codec_hdr = {"Radiance HDR", extensions, recognises,
                               read_hdr,       write_hdr,  false};
