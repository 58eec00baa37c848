/*
 * JPEG through libjpeg: grey and colour are read, quality 95 is written.
 *
 * libjpeg reports errors by leaving its error_exit, which must not return: it jumps. All
 * state that must survive that lies in a jpeg_job of the caller's. What libjpeg only
 * warns of (a scan that ends early, a broken code) is damage here, for it would be
 * guessed at in grey.
 */
#include "base/memory.h"
#include "base/wanted.h"
#include "image/codec.h"

#include <jpeglib.h> /* after stdio.h */

#include <jerror.h>
#include <math.h>
#include <setjmp.h>
#include <string.h>

enum { QUALITY = 95, N_CODES = 256 };

typedef struct jpeg_job {
    jmp_buf jump;
    char message[JMSG_LENGTH_MAX];
    struct jpeg_error_mgr errors;
    struct jpeg_progress_mgr progress; /* of reading */
    struct jpeg_decompress_struct in;
    struct jpeg_compress_struct out;
    const image_source *source;
    const image_sink *sink;
    const image *to_write;
    image *read;
    const float *table;
    JSAMPLE *row;
    size_t reserved;   /* bytes of what libjpeg keeps */
    float scale;       /* 2^exposure */
    image_shown shown; /* channels of to_write */
} jpeg_job;

static void on_error(j_common_ptr info)
{
    jpeg_job *job = info->client_data;
    info->err->format_message(info, job->message);
    longjmp(job->jump, 1);
}

static bool is_harmless(int code)
{
    return code == JWRN_EXTRANEOUS_DATA || code == JWRN_JFIF_MAJOR ||
           code == JWRN_ADOBE_XFORM;
}

static void on_message(j_common_ptr info, int level)
{
    const int warning = -1;
    if (level == warning && !is_harmless(info->err->msg_code))
        on_error(info);
}

static void print_nothing(j_common_ptr info)
{
    (void)info;
}

static struct jpeg_error_mgr *handlers(jpeg_job *job)
{
    jpeg_std_error(&job->errors);
    job->errors.error_exit = on_error;
    job->errors.emit_message = on_message;
    job->errors.output_message = print_nothing;
    return &job->errors;
}

/* @return false if libjpeg jumped; then job->message says why. */
static bool guarded(jpeg_job *job, void (*body)(jpeg_job *job))
{
    if (setjmp(job->jump) != 0)
        return false;
    body(job);
    return true;
}

/* ---- reading ---- */

static void on_progress(j_common_ptr info)
{
    jpeg_job *job = info->client_data;
    if (!still_wanted(NULL))
        longjmp(job->jump, 1);
}

static bool recognises(const image_source *source)
{
    const uint8_t *b = source->bytes;
    return source->size >= 3 && b[0] == 0xff && b[1] == 0xd8 && b[2] == 0xff;
}

static void read_header(jpeg_job *job)
{
    jpeg_create_decompress(&job->in);
    job->in.client_data = job;
    job->progress.progress_monitor = on_progress;
    job->in.progress = &job->progress;
    jpeg_mem_src(&job->in, job->source->bytes, job->source->size);
    jpeg_read_header(&job->in, TRUE);
    if (job->in.num_components == 1)
        job->in.out_color_space = JCS_GRAYSCALE;
    else
        job->in.out_color_space = JCS_RGB;
    job->in.dct_method = JDCT_ISLOW;
    jpeg_calc_output_dimensions(&job->in);
}

static void read_rows(jpeg_job *job)
{
    jpeg_start_decompress(&job->in);
    int n = job->in.output_components;
    float *pixel = job->read->pixels;
    while (job->in.output_scanline < job->in.output_height) {
        jpeg_read_scanlines(&job->in, &job->row, 1);
        for (int x = 0; x < job->read->width; x++, pixel += 3)
            for (int c = 0; c < 3; c++)
                pixel[c] = job->table[job->row[n * x + c % n]];
    }
    jpeg_finish_decompress(&job->in);
}

/* For the image, and for the coefficients that libjpeg keeps of files with several scans.
 */
static bool make_room(jpeg_job *job, GError **error)
{
    const double best_ratio = 512; /* a bit for 64 pixels of 8 bits */
    int64_t width = job->in.output_width, height = job->in.output_height;
    if (!source_size_possible(job->source, width, height, 1, best_ratio, error))
        return false;
    size_t pixel = (size_t)job->in.num_components * sizeof(JCOEF);
    size_t kept =
        jpeg_has_multiple_scans(&job->in) ? (size_t)(width * height) * pixel : 0;
    if (!memory_reserve(kept, "the scans of an image", error))
        return false;
    job->reserved = kept;
    job->read = image_new((int)width, (int)height, 3, rgba_names, error);
    job->row = job->read ? g_malloc_n((gsize)width, 3) : NULL;
    return job->read != NULL;
}

static bool read_guarded(jpeg_job *job, GError **error)
{
    bool read = guarded(job, read_header);
    if (read) {
        if (!make_room(job, error))
            return false;
        read = guarded(job, read_rows);
    }
    if (!read)
        source_damaged(job->source, codec_jpeg.name, job->message, error);
    return read;
}

static image *read_jpeg(const image_source *source, const image_read_options *options,
                        GError **error)
{
    g_autofree float *table = encoding_table(options, N_CODES);
    jpeg_job *job = g_new0(jpeg_job, 1);
    job->source = source;
    job->table = table;
    job->in.err = handlers(job);
    job->in.client_data = job;
    g_autoptr(image) img = NULL;
    bool read = read_guarded(job, error);
    img = job->read;
    jpeg_destroy_decompress(&job->in);
    memory_release(job->reserved);
    g_free(job->row);
    g_free(job);
    return read ? g_steal_pointer(&img) : NULL;
}

/* ---- writing ---- */

static void encode_row(const jpeg_job *job, const float *pixel)
{
    float rgb[3];
    for (int x = 0; x < job->to_write->width; x++, pixel += job->to_write->n_channels) {
        image_shown_pixel(&job->shown, pixel, 1.0f / job->scale, rgb);
        for (int c = 0; c < 3; c++)
            job->row[3 * x + c] = srgb_code(rgb[c] * job->scale);
    }
}

static void write_file(jpeg_job *job)
{
    const image *img = job->to_write;
    jpeg_create_compress(&job->out);
    job->out.client_data = job;
    jpeg_stdio_dest(&job->out, job->sink->stream);
    job->out.image_width = (JDIMENSION)img->width;
    job->out.image_height = (JDIMENSION)img->height;
    job->out.input_components = 3;
    job->out.in_color_space = JCS_RGB;
    jpeg_set_defaults(&job->out);
    jpeg_set_quality(&job->out, QUALITY, TRUE);
    job->out.comp_info[0].h_samp_factor = 1; /* colour as fine as lightness */
    job->out.comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(&job->out, TRUE);
    size_t stride = (size_t)img->width * (size_t)img->n_channels;
    for (int y = 0; y < img->height; y++) {
        if (!sink_wants(job->sink))
            longjmp(job->jump, 1);
        encode_row(job, img->pixels + (size_t)y * stride);
        jpeg_write_scanlines(&job->out, &job->row, 1);
    }
    jpeg_finish_compress(&job->out);
}

static bool write_jpeg(const image *img, const image_sink *sink,
                       const image_write_options *options, GError **error)
{
    jpeg_job *job = g_new0(jpeg_job, 1);
    job->to_write = img;
    job->sink = sink;
    job->scale = exp2f(options->exposure);
    job->row = g_malloc_n((gsize)img->width, 3);
    job->out.err = handlers(job);
    job->out.client_data = job;
    bool written = image_to_show(img, sink->path, &job->shown, error);
    if (written && !guarded(job, write_file)) {
        error_set(error, ERROR_FAILED, "%s: cannot be written: %s", sink->path,
                  job->message);
        written = false;
    }
    jpeg_destroy_compress(&job->out);
    g_free(job->row);
    g_free(job);
    return written;
}

static const char *const extensions[] = {".jpg", ".jpeg", NULL};
const image_codec codec_jpeg = {"JPEG",    extensions, recognises,
                                read_jpeg, write_jpeg, true};
