/*
 * OpenEXR. Read: the first flat part of a file, scanlines or tiles, all channels as float
 * under their own names, string attributes into the header; by the C++ library behind
 * exr_file.h. Written, by the C core: one part of 32-bit float scanlines, ZIP-compressed.
 *
 * The image is the data window: what lies outside it is not in the file.
 */
#include "image/exr.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/wanted.h"
#include "image/codec.h"
#include "image/exr_file.h"

#include <errno.h>
#include <openexr.h>
#include <string.h>

enum {
    MAX_SHORT_NAME = 31,
    CHUNKS_A_THREAD = 4, /* packed at once */
    ZIP_ROWS = 16,       /* size: of a chunk, by the format */
    ZIP_LEVEL = 2, /* of 9: pictures get hardly larger, and are written much sooner */
};

/* ---- reading ---- */

typedef struct exr_reading {
    const image_source *source;
    image *img;
    size_t reserved; /* bytes for what the library decodes at once */
    GError **error;
} exr_reading;

static bool recognises(const image_source *source)
{
    return source->size >= 4 && memcmp(source->bytes, "\x76\x2f\x31\x01", 4) == 0;
}

/* Moves *at behind a text and the zero at its end. @return its length, -1: it has none */
static ptrdiff_t skip_text(const image_source *source, size_t *at)
{
    const uint8_t *begin = source->bytes + *at;
    const uint8_t *end = memchr(begin, 0, source->size - *at);
    if (!end)
        return -1;
    *at += (size_t)(end - begin) + 1;
    return end - begin;
}

/* Types of attributes that the library reads by their type, whatever size they state: a
 * size that is another would let it take what follows for something else. */
static const struct {
    const char *type;
    int32_t size;
} fixed_types[] = {
    {"box2f", 16},      {"box2i", 16},   {"chromaticities", 32},
    {"compression", 1}, {"double", 8},   {"envmap", 1},
    {"float", 4},       {"int", 4},      {"keycode", 28},
    {"lineOrder", 1},   {"m33d", 72},    {"m33f", 36},
    {"m44d", 128},      {"m44f", 64},    {"rational", 8},
    {"tiledesc", 9},    {"timecode", 8}, {"v2d", 16},
    {"v2f", 8},         {"v2i", 8},      {"v3d", 24},
    {"v3f", 12},        {"v3i", 12},
};

static int32_t int_at(const uint8_t *bytes)
{
    int32_t value;
    memcpy(&value, bytes, sizeof value);
    return GINT32_FROM_LE(value);
}

/* A list of channels (a name and 16 bytes each) ends with an empty name. */
static bool channels_fit(const uint8_t *value, int32_t size)
{
    const image_source list = {.bytes = value, .size = (size_t)size};
    for (size_t at = 0;;) {
        ptrdiff_t name = skip_text(&list, &at);
        if (name <= 0)
            return name == 0 && at == list.size;
        if (list.size - at < 16)
            return false;
        at += 16;
    }
}

static bool value_fits(const char *type, const uint8_t *value, int32_t size)
{
    for (size_t i = 0; i < G_N_ELEMENTS(fixed_types); i++)
        if (strcmp(type, fixed_types[i].type) == 0)
            return size == fixed_types[i].size;
    if (strcmp(type, "chlist") == 0)
        return channels_fit(value, size);
    if (strcmp(type, "preview") != 0)
        return true;
    if (size < 8 || int_at(value) < 0 || int_at(value + 4) < 0)
        return false;
    int64_t n_pixels = (int64_t)int_at(value) * int_at(value + 4);
    return n_pixels <= size && 8 + 4 * n_pixels == size;
}

/* Name, type, size, value; all headers end with an empty name. @return as skip_text */
static ptrdiff_t skip_attribute(const image_source *source, size_t *at)
{
    ptrdiff_t name = skip_text(source, at);
    if (name <= 0)
        return name;
    const char *type = (const char *)source->bytes + *at;
    if (skip_text(source, at) < 0 || source->size - *at < sizeof(int32_t))
        return -1;
    int32_t size = int_at(source->bytes + *at);
    *at += sizeof size;
    if (size < 0 || (size_t)size > source->size - *at ||
        !value_fits(type, source->bytes + *at, size))
        return -1;
    *at += (size_t)size;
    return name;
}

/* The library makes room for as much as an attribute says it has, before it reads. */
static bool attributes_fit(const image_source *source)
{
    enum { VERSION = 4, HEADERS = 8, MULTI_PART = 0x10 };
    if (source->size < HEADERS)
        return false;
    bool several = source->bytes[VERSION + 1] & MULTI_PART;
    size_t at = HEADERS, begin;
    do {
        ptrdiff_t name;
        begin = at;
        while ((name = skip_attribute(source, &at)) > 0)
            ;
        if (name < 0)
            return false;
    } while (several && at > begin + 1); /* an empty header is the last */
    return true;
}

static bool can_be_read(const exr_description *part, const image_source *source,
                        GError **error)
{
    if (part->subsampled) {
        error_set(error, ERROR_INPUT,
                  "%s: channel '%s' is subsampled, which is not supported", source->path,
                  part->subsampled);
        return false;
    }
    if (!source_size_possible(source, part->width, part->height, part->bytes_per_pixel,
                              part->best_ratio, error))
        return false;
    if (part->n_channels >= 1 &&
        (double)part->width * (double)part->n_channels <= (double)INT32_MAX / 4)
        return true;
    source_damaged(source, codec_exr.name, "no channels, or too many", error);
    return false;
}

/* Chunks are tiles or up to 256 lines; there is one as it is in the file and one decoded.
 */
static bool reserve_chunks(exr_reading *r, const exr_description *part)
{
    double lines = (double)part->width * (double)MIN(part->height, 256);
    double tile = (double)part->tile_width * (double)part->tile_height;
    double bytes = 2 * part->bytes_per_pixel * (part->tile_width > 0 ? tile : lines);
    size_t whole = bytes < (double)(SIZE_MAX / 4) ? (size_t)bytes : SIZE_MAX / 4;
    if (!memory_reserve(whole, "the chunks of an image", r->error))
        return false;
    r->reserved = whole;
    return true;
}

/* An exr_place_function. */
static float *make_image(const exr_description *part, void *data)
{
    exr_reading *r = data;
    if (!can_be_read(part, r->source, r->error) || !reserve_chunks(r, part))
        return NULL;
    r->img = image_new((int)part->width, (int)part->height, (int)part->n_channels,
                       part->channels, r->error);
    if (!r->img)
        return NULL;
    for (size_t i = 0; i < part->n_strings; i++)
        image_header_set(r->img, part->strings[i].name, part->strings[i].value);
    if (part->has_chromaticities)
        memcpy(r->img->chromaticities, part->chromaticities,
               sizeof r->img->chromaticities);
    return r->img->pixels;
}

static bool is_wanted(void)
{
    return still_wanted(NULL);
}

static bool read_file(exr_reading *r, GError **error)
{
    char message[300] = "its header does not end";
    const exr_target to = {make_image, r, is_wanted};
    exr_result result = EXR_DAMAGED;
    if (attributes_fit(r->source))
        result = exr_file_read(r->source->path, r->source->bytes, r->source->size, &to,
                               message);
    if (result == EXR_DAMAGED)
        source_damaged(r->source, codec_exr.name, message, error);
    else if (result == EXR_NO_MEMORY)
        error_set(error, ERROR_FAILED, "%s: out of memory", r->source->path);
    else if (result == EXR_ONLY_DEEP)
        error_set(error, ERROR_INPUT, "%s: only deep data, which is not supported",
                  r->source->path);
    return result == EXR_READ;
}

static image *read_exr(const image_source *source, const image_read_options *options,
                       GError **error)
{
    (void)options;
    exr_reading r = {.source = source, .error = error};
    if (!read_file(&r, error))
        image_free(g_steal_pointer(&r.img));
    memory_release(r.reserved);
    return r.img;
}

/* ---- writing ---- */

/* What the callbacks of one context share. */
typedef struct exr_job {
    exr_context_t context;
    char message[300]; /* the first error */
    const image_sink *sink;
    int part;
    const image *to_write;
} exr_job;

/* The job at work on this thread: the library holds a lock on the context while it
 * reports an error, so that the context cannot be asked for its user data then. */
static _Thread_local exr_job *current;

static void on_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    if (!current->message[0])
        g_strlcpy(current->message, message, sizeof current->message);
}

/* True on success; otherwise there is a message in the job. */
static bool succeeded(exr_job *job, exr_result_t code)
{
    if (code != EXR_ERR_SUCCESS && !job->message[0])
        g_strlcpy(job->message, exr_get_default_error_message(code), sizeof job->message);
    return code == EXR_ERR_SUCCESS;
}

static int64_t write_bytes(exr_const_context_t context, void *data, const void *buffer,
                           uint64_t size, uint64_t offset,
                           exr_stream_error_func_ptr_t report)
{
    const exr_job *job = data;
    FILE *stream = job->sink->stream;
    if (fseeko(stream, (off_t)offset, SEEK_SET) == 0 &&
        fwrite(buffer, 1, size, stream) == size)
        return (int64_t)size;
    report(context, EXR_ERR_WRITE_IO, "%s", g_strerror(errno));
    return -1;
}

static bool needs_long_names(const image *img)
{
    for (int c = 0; c < img->n_channels; c++)
        if (strlen(img->channels[c]) > MAX_SHORT_NAME)
            return true;
    GHashTableIter i;
    gpointer key;
    if (!img->header)
        return false;
    g_hash_table_iter_init(&i, img->header);
    while (g_hash_table_iter_next(&i, &key, NULL))
        if (strlen(key) > MAX_SHORT_NAME)
            return true;
    return false;
}

static bool declare_strings(exr_job *job)
{
    const image *img = job->to_write;
    if (!image_header_get(img, "software") &&
        !succeeded(job,
                   exr_attr_set_string(job->context, job->part, "software", "Nephroid")))
        return false;
    if (!img->header)
        return true;
    g_autoptr(GList) keys = g_hash_table_get_keys(img->header);
    keys = g_list_sort(keys, (GCompareFunc)strcmp);
    for (const GList *k = keys; k; k = k->next)
        if (!succeeded(job, exr_attr_set_string(job->context, job->part, k->data,
                                                image_header_get(img, k->data))))
            return false;
    return true;
}

static bool declare_chromaticities(exr_job *job)
{
    exr_attr_chromaticities_t c;
    G_STATIC_ASSERT(sizeof c == sizeof job->to_write->chromaticities);
    memcpy(&c, job->to_write->chromaticities, sizeof c);
    return !(c.red_x > 0.0f) ||
           succeeded(job, exr_attr_set_chromaticities(job->context, job->part,
                                                      "chromaticities", &c));
}

static bool declare(exr_job *job)
{
    const image *img = job->to_write;
    if (needs_long_names(img) &&
        !succeeded(job, exr_set_longname_support(job->context, 1)))
        return false;
    if (!succeeded(job,
                   exr_add_part(job->context, NULL, EXR_STORAGE_SCANLINE, &job->part)) ||
        !succeeded(job, exr_initialize_required_attr_simple(job->context, job->part,
                                                            img->width, img->height,
                                                            EXR_COMPRESSION_ZIP)) ||
        !succeeded(job,
                   exr_set_zip_compression_level(job->context, job->part, ZIP_LEVEL)))
        return false;
    for (int c = 0; c < img->n_channels; c++)
        if (!succeeded(job, exr_add_channel(job->context, job->part, img->channels[c],
                                            EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC,
                                            1, 1)))
            return false;
    return declare_chromaticities(job) && declare_strings(job) &&
           succeeded(job, exr_write_header(job->context));
}

/* The file's channels are sorted by name, the image's are not. */
static void aim_encoder(const image *img, exr_encode_pipeline_t *encoder, int y)
{
    size_t n = (size_t)img->n_channels;
    const float *row = img->pixels + (size_t)y * (size_t)img->width * n;
    for (int c = 0; c < encoder->channel_count; c++) {
        exr_coding_channel_info_t *channel = &encoder->channels[c];
        int from = image_channel(img, channel->channel_name);
        channel->encode_from_ptr = (const uint8_t *)(row + from);
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = sizeof(float);
        channel->user_pixel_stride = (int32_t)(n * sizeof(float));
        channel->user_line_stride = (int32_t)(n * (size_t)img->width * sizeof(float));
    }
}

/* A chunk of rows on its way: packed on any thread, written in order. */
typedef struct exr_chunk {
    exr_job *job;
    exr_encode_pipeline_t encoder;
    exr_result_t (*write)(exr_encode_pipeline_t *encoder);
    exr_result_t packed;
} exr_chunk;

static bool begin_chunk(exr_chunk *c, int y)
{
    exr_job *job = c->job;
    exr_chunk_info_t rows;
    if (!succeeded(job, exr_write_scanline_chunk_info(job->context, job->part, y, &rows)))
        return false;
    bool first = !c->encoder.channels;
    exr_result_t result =
        first ? exr_encoding_initialize(job->context, job->part, &rows, &c->encoder)
              : exr_encoding_update(job->context, job->part, &rows, &c->encoder);
    if (!succeeded(job, result))
        return false;
    aim_encoder(job->to_write, &c->encoder, y);
    if (first && !succeeded(job, exr_encoding_choose_default_routines(
                                     job->context, job->part, &c->encoder)))
        return false;
    if (first)
        c->write = c->encoder.write_fn;
    c->encoder.write_fn = c->encoder.yield_until_ready_fn = NULL;
    return true;
}

static void pack_chunks(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    exr_chunk *chunks = data;
    for (size_t i = begin; i < end; i++) {
        exr_job *job = chunks[i].job;
        current = job;
        chunks[i].packed = exr_encoding_run(job->context, job->part, &chunks[i].encoder);
    }
}

/* @return the row behind the last one written; -1: failed */
static int write_chunks(exr_job *job, exr_chunk *chunks, size_t n, int y, int step)
{
    size_t used = 0;
    for (int at = y; used < n && at < job->to_write->height; at += step)
        if (!begin_chunk(&chunks[used++], at))
            return -1;
    if (!parallel_for(used, 1, 0, job->sink->cancel, pack_chunks, chunks))
        return -1;
    for (size_t i = 0; i < used; i++)
        if (!succeeded(job, chunks[i].packed) ||
            !succeeded(job, chunks[i].write(&chunks[i].encoder)))
            return -1;
    return y + (int)used * step;
}

static bool write_pixels(exr_job *job)
{
    int32_t step = 0;
    size_t n = CHUNKS_A_THREAD * parallel_threads(0);
    g_autofree exr_chunk *chunks = g_new0(exr_chunk, n);
    int y = succeeded(job, exr_get_scanlines_per_chunk(job->context, job->part, &step))
                ? 0
                : -1;
    for (size_t i = 0; i < n; i++)
        chunks[i] = (exr_chunk){job, EXR_ENCODE_PIPELINE_INITIALIZER, NULL, 0};
    while (y >= 0 && y < job->to_write->height)
        y = write_chunks(job, chunks, n, y, step);
    for (size_t i = 0; i < n; i++)
        exr_encoding_destroy(job->context, &chunks[i].encoder);
    return y >= 0;
}

/* A chunk as it is, and packed. */
size_t exr_writing_bytes(int width, int height, int n_channels)
{
    size_t rows = CHUNKS_A_THREAD * ZIP_ROWS * (size_t)parallel_threads(0);
    return 2 * sizeof(float) * MIN(rows, (size_t)height) * (size_t)width *
           (size_t)n_channels;
}

static bool write_exr(const image *img, const image_sink *sink,
                      const image_write_options *options, GError **error)
{
    (void)options;
    exr_job job = {.sink = sink, .to_write = img};
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = on_error;
    setup.user_data = &job;
    setup.write_fn = write_bytes;
    current = &job;
    bool written = succeeded(
        &job, exr_start_write(&job.context, sink->path, EXR_WRITE_FILE_DIRECTLY, &setup));
    if (written) {
        written = declare(&job) && write_pixels(&job);
        written &= succeeded(&job, exr_finish(&job.context));
    }
    if (!written)
        error_set(error, ERROR_FAILED, "%s: cannot be written: %s", sink->path,
                  job.message);
    return written;
}

static const char *const extensions[] = {".exr", NULL};
const image_codec codec_exr = {"OpenEXR", extensions, recognises,
                               read_exr,  write_exr,  false};
