/*
 * PNG through libpng. Every depth and colour type is read; 8-bit sRGB is written.
 *
 * libpng reports errors by a jump. All state that must survive one lies in a png_job of
 * the caller's; the function that sets the jump has no variables of its own.
 */
#include "base/memory.h"
#include "base/wanted.h"
#include "image/codec.h"

#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <string.h>

typedef struct png_job {
    jmp_buf jump;
    char message[200];
    png_structp png;
    png_infop info;
    const image_source *source;
    size_t at; /* in the source */
    png_bytep *rows;
    png_byte *bytes; /* of all rows */
    int width, height, n_values, depth;
    const image *img;
    const image_sink *sink;
    float scale;       /* 2^exposure */
    image_shown shown; /* channels of img */
} png_job;

static void on_error(png_structp png, png_const_charp message)
{
    png_job *job = png_get_error_ptr(png);
    g_strlcpy(job->message, message, sizeof job->message);
    longjmp(job->jump, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

/* @return false if libpng jumped; then job->message says why. */
static bool guarded(png_job *job, void (*body)(png_job *job))
{
    if (setjmp(job->jump) != 0)
        return false;
    body(job);
    return true;
}

/* ---- reading ---- */

static bool recognises(const image_source *source)
{
    return source->size >= 8 && png_sig_cmp(source->bytes, 0, 8) == 0;
}

/* libpng makes room for as much as a chunk says it has, before it reads. */
static bool chunks_fit(const image_source *source)
{
    enum { SIGNATURE = 8, HEADER = 8, CHECKSUM = 4 };
    size_t at = SIGNATURE;
    while (source->size - at >= HEADER) {
        const uint8_t *chunk = source->bytes + at;
        size_t length = (size_t)png_get_uint_32(chunk), left = source->size - at - HEADER;
        bool is_last = memcmp(chunk + 4, "IEND", 4) == 0;
        if (left < CHECKSUM || length > left - CHECKSUM)
            return false;
        if (is_last)
            return true;
        at += HEADER + length + CHECKSUM;
    }
    return false;
}

static void read_bytes(png_structp png, png_bytep out, size_t n)
{
    png_job *job = png_get_io_ptr(png);
    if (job->source->size - job->at < n)
        png_error(png, "it ends early");
    memcpy(out, job->source->bytes + job->at, n);
    job->at += n;
}

static void read_header(png_job *job)
{
    png_structp png = job->png;
    png_set_read_fn(png, job, read_bytes);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_read_info(png, job->info);
    png_set_expand(png);
    png_set_gray_to_rgb(png);
    png_set_interlace_handling(png);
    png_read_update_info(png, job->info);
}

static void read_rows(png_job *job)
{
    for (int pass = png_set_interlace_handling(job->png); pass > 0; pass--)
        for (int y = 0; y < job->height; y++) {
            if (!still_wanted(NULL))
                png_error(job->png, "cancelled");
            png_read_row(job->png, job->rows[y], NULL);
        }
    png_read_end(job->png, NULL);
}

static bool allocate_rows(png_job *job, GError **error)
{
    size_t row_size = png_get_rowbytes(job->png, job->info);
    size_t n_rows = (size_t)job->height;
    job->bytes = big_alloc(n_rows, row_size, "the rows of an image", error);
    if (job->bytes)
        job->rows = big_alloc(n_rows, sizeof *job->rows, "the rows of an image", error);
    if (!job->rows)
        return false;
    for (size_t y = 0; y < n_rows; y++)
        job->rows[y] = job->bytes + y * row_size;
    return true;
}

static bool describe(png_job *job, GError **error)
{
    const double best_ratio = 1100; /* deflate gains 1032 at most */
    int64_t width = png_get_image_width(job->png, job->info);
    int64_t height = png_get_image_height(job->png, job->info);
    /* Palettes and packed greys hold as little as a bit a pixel in the file. */
    if (!source_size_possible(job->source, width, height, 0.125, best_ratio, error))
        return false;
    job->width = (int)width;
    job->height = (int)height;
    job->n_values = png_get_channels(job->png, job->info);
    job->depth = png_get_bit_depth(job->png, job->info);
    return true;
}

static unsigned code_at(const png_job *job, const png_byte *row, size_t i)
{
    return job->depth == 16 ? (unsigned)row[2 * i] << 8 | row[2 * i + 1] : row[i];
}

static void convert(const png_job *job, const float *table, float *pixels)
{
    size_t n = (size_t)job->n_values, row_values = n * (size_t)job->width;
    float largest = job->depth == 16 ? 65535.0f : 255.0f;
    for (int y = 0; y < job->height && still_wanted(NULL); y++)
        for (size_t i = 0; i < row_values; i++) {
            unsigned code = code_at(job, job->rows[y], i);
            bool alpha = i % n == 3;
            *pixels++ = alpha ? (float)code / largest : table[code];
        }
}

static image *read_guarded(png_job *job, const image_read_options *options,
                           GError **error)
{
    if (!guarded(job, read_header)) {
        source_damaged(job->source, codec_png.name, job->message, error);
        return NULL;
    }
    if (!describe(job, error) || !allocate_rows(job, error))
        return NULL;
    g_autoptr(image) img =
        image_new(job->width, job->height, job->n_values, rgba_names, error);
    if (!img)
        return NULL;
    if (!guarded(job, read_rows)) {
        source_damaged(job->source, codec_png.name, job->message, error);
        return NULL;
    }
    g_autofree float *table = encoding_table(options, 1u << job->depth);
    convert(job, table, img->pixels);
    return g_steal_pointer(&img);
}

static image *read_png(const image_source *source, const image_read_options *options,
                       GError **error)
{
    image *img = NULL;
    if (!chunks_fit(source)) {
        error_set(error, ERROR_INPUT, "%s: damaged PNG file: it ends early",
                  source->path);
        return NULL;
    }
    png_job *job = g_new0(png_job, 1);
    job->source = source;
    job->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, job, on_error, on_warning);
    job->info = job->png ? png_create_info_struct(job->png) : NULL;
    if (job->info)
        img = read_guarded(job, options, error);
    else
        error_set(error, ERROR_FAILED, "%s: libpng cannot be started", source->path);
    png_destroy_read_struct(&job->png, &job->info, NULL);
    big_free(job->bytes);
    big_free(job->rows);
    g_free(job);
    return img;
}

/* ---- writing ---- */

static void encode_row(const png_job *job, const float *pixel)
{
    png_byte *out = job->bytes;
    float rgb[3];
    for (int x = 0; x < job->width; x++, pixel += job->img->n_channels) {
        image_shown_pixel(&job->shown, pixel, 1.0f / job->scale, rgb);
        for (int c = 0; c < 3; c++)
            *out++ = srgb_code(rgb[c] * job->scale);
        if (job->n_values == 4) {
            float alpha = pixel[job->shown.rgba[3]];
            *out++ = (png_byte)(fminf(fmaxf(alpha, 0.0f), 1.0f) * 255.0f + 0.5f);
        }
    }
}

static void write_file(png_job *job)
{
    int color = job->n_values == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB;
    png_init_io(job->png, job->sink->stream);
    png_set_IHDR(job->png, job->info, (png_uint_32)job->width, (png_uint_32)job->height,
                 8, color, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(job->png, job->info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(job->png, job->info);
    size_t stride = (size_t)job->width * (size_t)job->img->n_channels;
    for (int y = 0; y < job->height && sink_wants(job->sink); y++) {
        encode_row(job, job->img->pixels + (size_t)y * stride);
        png_write_row(job->png, job->bytes);
    }
    if (cancelled(job->sink->cancel))
        png_error(job->png, "cancelled");
    png_write_end(job->png, job->info);
}

static bool write_guarded(png_job *job, GError **error)
{
    job->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, job, on_error, on_warning);
    job->info = job->png ? png_create_info_struct(job->png) : NULL;
    g_strlcpy(job->message, "libpng cannot be started", sizeof job->message);
    bool written = job->info && guarded(job, write_file);
    if (!written)
        error_set(error, ERROR_FAILED, "%s: cannot be written: %s", job->sink->path,
                  job->message);
    png_destroy_write_struct(&job->png, &job->info);
    return written;
}

static bool write_png(const image *img, const image_sink *sink,
                      const image_write_options *options, GError **error)
{
    png_job *job = g_new0(png_job, 1);
    job->img = img;
    job->sink = sink;
    job->width = img->width;
    job->height = img->height;
    job->scale = exp2f(options->exposure);
    job->bytes = g_malloc_n((gsize)img->width, 4);
    bool written = image_to_show(img, sink->path, &job->shown, error);
    job->n_values = job->shown.rgba[3] >= 0 ? 4 : 3;
    written = written && write_guarded(job, error);
    g_free(job->bytes);
    g_free(job);
    return written;
}

static const char *const extensions[] = {".png", NULL};
const image_codec codec_png = {"PNG", extensions, recognises, read_png, write_png, true};
