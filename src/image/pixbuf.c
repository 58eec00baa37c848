/*
 * TGA and BMP through gdk-pixbuf, to be read only: 8 bits a channel, grey as colour.
 *
 * A TGA file begins with no mark of its own, so it is asked for last, and what it says of
 * itself must be possible.
 */
#include "base/memory.h"
#include "base/wanted.h"
#include "image/codec.h"

#include <gdk-pixbuf/gdk-pixbuf.h>

enum { N_CODES = 256, PIECE = 1 << 20 };

/* The loader with the whole file in it, closed. */
static bool load(GdkPixbufLoader *loader, const image_source *source, GError **error)
{
    bool written = true;
    for (size_t at = 0, n; at < source->size && written; at += n) {
        n = MIN(source->size - at, (size_t)PIECE);
        written = still_wanted(error) &&
                  gdk_pixbuf_loader_write(loader, source->bytes + at, n, error);
    }
    bool closed = gdk_pixbuf_loader_close(loader, written ? error : NULL);
    return written && closed && gdk_pixbuf_loader_get_pixbuf(loader);
}

static image *to_image(const GdkPixbuf *from, const image_read_options *options,
                       GError **error)
{
    g_autofree float *table = encoding_table(options, N_CODES);
    int width = gdk_pixbuf_get_width(from), height = gdk_pixbuf_get_height(from),
        n = gdk_pixbuf_get_n_channels(from);
    image *img = image_new(width, height, n, rgba_names, error);
    if (!img)
        return NULL;
    const uint8_t *bytes = gdk_pixbuf_read_pixels(from);
    float *to = img->pixels;
    for (int y = 0; y < height && still_wanted(NULL); y++) {
        const uint8_t *row = bytes + (size_t)y * (size_t)gdk_pixbuf_get_rowstride(from);
        for (int i = 0; i < width * n; i++)
            *to++ = i % n < 3 ? table[row[i]] : (float)row[i] / (N_CODES - 1);
    }
    return img;
}

/* The two names of a format. */
typedef struct pixbuf_format {
    const char *type, *name; /* gdk-pixbuf's, ours */
} pixbuf_format;

static image *read_unlimited(const pixbuf_format *as, const image_source *source,
                             const image_read_options *options, GError **error)
{
    g_autoptr(GError) why = NULL;
    g_autoptr(GdkPixbufLoader) loader = gdk_pixbuf_loader_new_with_type(as->type, &why);
    if (!loader) {
        error_set(error, ERROR_FAILED, "%s: %s files cannot be read here: %s",
                  source->path, as->name, why->message);
        return NULL;
    }
    if (load(loader, source, &why))
        return to_image(gdk_pixbuf_loader_get_pixbuf(loader), options, error);
    source_damaged(source, as->name, why ? why->message : "it ends early", error);
    return NULL;
}

/* gdk-pixbuf makes room by itself, for up to four bytes a pixel. */
static image *read_as(const pixbuf_format *as, const image_source *source,
                      int64_t n_pixels, const image_read_options *options, GError **error)
{
    const size_t size = 4 * (size_t)n_pixels;
    if (!memory_reserve(size, "the rows of an image", error))
        return NULL;
    image *img = read_unlimited(as, source, options, error);
    memory_release(size);
    return img;
}

static unsigned u16_at(const image_source *source, size_t at)
{
    return source->bytes[at] | (unsigned)source->bytes[at + 1] << 8;
}

static uint32_t u32_at(const image_source *source, size_t at)
{
    return u16_at(source, at) | (uint32_t)u16_at(source, at + 2) << 16;
}

/* ---- BMP: a file header of 14 bytes, then one of the image, whose first number is its
   own size ---- */

enum { BMP_LEAST = 54, BMP_RGB = 0, BMP_BITFIELDS = 3 };

static bool is_bmp(const image_source *source)
{
    return source->size >= BMP_LEAST && source->bytes[0] == 'B' &&
           source->bytes[1] == 'M' && u32_at(source, 14) >= 40;
}

/* gdk-pixbuf gives what there is of a file that is cut off. */
static image *read_bmp(const image_source *source, const image_read_options *options,
                       GError **error)
{
    int64_t width = (int32_t)u32_at(source, 18), height = (int32_t)u32_at(source, 22);
    unsigned bits = u16_at(source, 28), compression = u32_at(source, 30);
    height = height < 0 ? -height : height; /* negative: rows go down */
    if (compression != BMP_RGB && compression != BMP_BITFIELDS) {
        error_set(error, ERROR_INPUT, "%s: compressed BMP files are not supported",
                  source->path);
        return NULL;
    }
    if (!source_size_possible(source, width, height, bits / 8.0, 1.0, error))
        return NULL;
    int64_t row = (width * bits + 31) / 32 * 4;
    if (u32_at(source, 10) + row * height > (int64_t)source->size) {
        source_damaged(source, codec_bmp.name, "it ends early", error);
        return NULL;
    }
    const pixbuf_format bmp = {"bmp", codec_bmp.name};
    return read_as(&bmp, source, width * height, options, error);
}

/* ---- TGA ("Truevision TGA File Format Specification" 2.0): a header of 18 bytes ---- */

enum { TGA_HEADER = 18, TGA_MAPPED = 1, TGA_COLOR = 2, TGA_GREY = 3, TGA_PACKED = 8 };

static bool is_tga(const image_source *source)
{
    if (source->size <= TGA_HEADER)
        return false;
    const uint8_t *b = source->bytes;
    int has_map = b[1], kind = b[2] & ~TGA_PACKED, map_bits = b[7], bits = b[16];
    switch (kind) {
    case TGA_MAPPED:
        return has_map == 1 && bits == 8 && map_bits >= 15 && map_bits <= 32;
    case TGA_COLOR:
        return has_map <= 1 && bits >= 15 && bits <= 32;
    case TGA_GREY:
        return has_map == 0 && (bits == 8 || bits == 16);
    default:
        return false;
    }
}

static image *read_tga(const image_source *source, const image_read_options *options,
                       GError **error)
{
    const double best_ratio = 128; /* a run of so many pixels, each of one byte or more */
    int64_t width = u16_at(source, 12), height = u16_at(source, 14);
    if (!source_size_possible(source, width, height, 1, best_ratio, error))
        return NULL;
    const pixbuf_format tga = {"tga", codec_tga.name};
    return read_as(&tga, source, width * height, options, error);
}

static const char *const bmp_names[] = {".bmp", NULL};
static const char *const tga_names[] = {".tga", NULL};
const image_codec codec_bmp = {"BMP", bmp_names, is_bmp, read_bmp, NULL, true};
const image_codec codec_tga = {"TGA", tga_names, is_tga, read_tga, NULL, true};
