/*
 * OpenEXR through its C core. Read: the first flat part of a file, scanlines or tiles,
 * all channels as float under their own names, string attributes into the header.
 * Written: one part of 32-bit float scanlines, ZIP-compressed.
 *
 * The image is the data window: what lies outside it is not in the file.
 */
#include "base/parallel.h"
#include "image/codec.h"

#include <errno.h>
#include <openexr.h>
#include <string.h>

enum {
    MAX_SHORT_NAME = 31,
    CHUNKS_A_THREAD = 4, /* packed at once */
    ZIP_LEVEL = 2, /* of 9: pictures get hardly larger, and are written much sooner */
};

/* What the callbacks of one context share. */
typedef struct exr_job {
    exr_context_t context;
    char message[300]; /* the first error */
    const image_source *source;
    const image_sink *sink;
    int part;
    exr_attr_box2i_t window;
    image *img;
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

static int64_t file_size(exr_const_context_t context, void *data)
{
    (void)context;
    const exr_job *job = data;
    return (int64_t)job->source->size;
}

/* Like pread: fewer bytes at the file's end, which the library knows how to judge. */
static int64_t read_bytes(exr_const_context_t context, void *data, void *buffer,
                          uint64_t size, uint64_t offset,
                          exr_stream_error_func_ptr_t report)
{
    const exr_job *job = data;
    (void)context;
    (void)report;
    uint64_t left = job->source->size - MIN(offset, job->source->size);
    size_t n = MIN(size, left);
    memcpy(buffer, job->source->bytes + job->source->size - left, n);
    return (int64_t)n;
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

static exr_context_initializer_t begin(exr_job *job)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = on_error;
    setup.user_data = job;
    setup.read_fn = job->source ? read_bytes : NULL;
    setup.size_fn = job->source ? file_size : NULL;
    setup.write_fn = job->sink ? write_bytes : NULL;
    setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    current = job;
    return setup;
}

/* ---- reading ---- */

static bool recognises(const image_source *source)
{
    return source->size >= 4 && memcmp(source->bytes, "\x76\x2f\x31\x01", 4) == 0;
}

static bool find_flat_part(exr_job *job, GError **error)
{
    int n_parts = 0;
    exr_get_count(job->context, &n_parts);
    for (job->part = 0; job->part < n_parts; job->part++) {
        exr_storage_t storage;
        if (exr_get_storage(job->context, job->part, &storage) == EXR_ERR_SUCCESS &&
            (storage == EXR_STORAGE_SCANLINE || storage == EXR_STORAGE_TILED))
            return true;
    }
    error_set(error, ERROR_INPUT, "%s: only deep data, which is not supported",
              job->source->path);
    return false;
}

static double bytes_per_pixel(const exr_attr_chlist_t *list)
{
    double bytes = 0;
    for (int c = 0; c < list->num_channels; c++)
        bytes += list->entries[c].pixel_type == EXR_PIXEL_HALF ? 2 : 4;
    return bytes;
}

/* The most that a compression can gain: deflate and Huffman runs, and in DWA's case runs
 * of runs. */
static double best_ratio(const exr_job *job)
{
    exr_compression_t compression = EXR_COMPRESSION_NONE;
    exr_get_compression(job->context, job->part, &compression);
    bool dwa = compression == EXR_COMPRESSION_DWAA || compression == EXR_COMPRESSION_DWAB;
    return dwa ? 65536.0 : 2048.0;
}

static bool channels_supported(const exr_job *job, const exr_attr_chlist_t *list,
                               GError **error)
{
    for (int c = 0; c < list->num_channels; c++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[c];
        if (entry->x_sampling == 1 && entry->y_sampling == 1)
            continue;
        error_set(error, ERROR_INPUT,
                  "%s: channel '%s' is subsampled, which is not supported",
                  job->source->path, entry->name.str);
        return false;
    }
    return true;
}

static image *allocate_image(exr_job *job, GError **error)
{
    const exr_attr_chlist_t *list = NULL;
    const exr_attr_box2i_t *w = &job->window;
    if (!succeeded(job, exr_get_channels(job->context, job->part, &list)) ||
        !succeeded(job, exr_get_data_window(job->context, job->part, &job->window))) {
        source_damaged(job->source, codec_exr.name, job->message, error);
        return NULL;
    }
    int64_t width = (int64_t)w->max.x - w->min.x + 1;
    int64_t height = (int64_t)w->max.y - w->min.y + 1;
    if (!channels_supported(job, list, error) ||
        !source_size_possible(job->source, width, height, bytes_per_pixel(list),
                              best_ratio(job), error))
        return NULL;
    if (list->num_channels < 1 || width * list->num_channels > INT32_MAX / 4) {
        source_damaged(job->source, codec_exr.name, "no channels, or too many", error);
        return NULL;
    }
    g_autofree const char **names = g_new(const char *, list->num_channels);
    for (int c = 0; c < list->num_channels; c++)
        names[c] = list->entries[c].name.str;
    return image_new((int)width, (int)height, list->num_channels, names, error);
}

/* Channels of the file and of the image stand in the same order: no names are sought. */
static void aim_decoder(const exr_job *job, exr_decode_pipeline_t *decoder, int x, int y)
{
    const image *img = job->img;
    size_t n = (size_t)img->n_channels;
    float *pixel = img->pixels + ((size_t)y * (size_t)img->width + (size_t)x) * n;
    for (int c = 0; c < decoder->channel_count; c++) {
        exr_coding_channel_info_t *channel = &decoder->channels[c];
        channel->decode_to_ptr = (uint8_t *)(pixel + c);
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = sizeof(float);
        channel->user_pixel_stride = (int32_t)(n * sizeof(float));
        channel->user_line_stride = (int32_t)(n * (size_t)img->width * sizeof(float));
    }
}

static bool chunk_inside(const exr_job *job, const exr_chunk_info_t *chunk, int x, int y)
{
    return x >= 0 && y >= 0 && chunk->width >= 0 && chunk->height >= 0 &&
           chunk->width <= job->img->width - x && chunk->height <= job->img->height - y;
}

/* Decodes a chunk whose corner is pixel x, y of the image. */
static bool read_chunk(exr_job *job, exr_decode_pipeline_t *decoder,
                       const exr_chunk_info_t *chunk, int x, int y)
{
    if (!chunk_inside(job, chunk, x, y)) {
        g_strlcpy(job->message, "a chunk lies outside the image", sizeof job->message);
        return false;
    }
    bool first = !decoder->channels;
    exr_result_t result =
        first ? exr_decoding_initialize(job->context, job->part, chunk, decoder)
              : exr_decoding_update(job->context, job->part, chunk, decoder);
    if (!succeeded(job, result))
        return false;
    if (decoder->channel_count != job->img->n_channels)
        return false;
    aim_decoder(job, decoder, x, y);
    return (!first || succeeded(job, exr_decoding_choose_default_routines(
                                         job->context, job->part, decoder))) &&
           succeeded(job, exr_decoding_run(job->context, job->part, decoder));
}

static bool read_scanlines(exr_job *job, exr_decode_pipeline_t *decoder)
{
    int32_t step = 0;
    if (!succeeded(job, exr_get_scanlines_per_chunk(job->context, job->part, &step)) ||
        step < 1)
        return false;
    for (int64_t y = job->window.min.y; y <= job->window.max.y; y += step) {
        exr_chunk_info_t chunk;
        if (!succeeded(job, exr_read_scanline_chunk_info(job->context, job->part, (int)y,
                                                         &chunk)) ||
            !read_chunk(job, decoder, &chunk, 0, (int)(y - job->window.min.y)))
            return false;
    }
    return true;
}

static bool read_tile(exr_job *job, exr_decode_pipeline_t *decoder, const int32_t size[2],
                      int column, int row)
{
    exr_chunk_info_t chunk;
    return succeeded(job, exr_read_tile_chunk_info(job->context, job->part, column, row,
                                                   0, 0, &chunk)) &&
           read_chunk(job, decoder, &chunk, column * size[0], row * size[1]);
}

/* Level 0 only: the image itself, not its smaller copies. */
static bool read_tiles(exr_job *job, exr_decode_pipeline_t *decoder)
{
    int32_t size[2] = {0, 0};
    if (!succeeded(
            job, exr_get_tile_sizes(job->context, job->part, 0, 0, &size[0], &size[1])) ||
        size[0] < 1 || size[1] < 1)
        return false;
    for (int row = 0; row <= (job->img->height - 1) / size[1]; row++)
        for (int column = 0; column <= (job->img->width - 1) / size[0]; column++)
            if (!read_tile(job, decoder, size, column, row))
                return false;
    return true;
}

static bool read_pixels(exr_job *job)
{
    exr_decode_pipeline_t decoder = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_storage_t storage;
    exr_get_storage(job->context, job->part, &storage);
    bool read = storage == EXR_STORAGE_TILED ? read_tiles(job, &decoder)
                                             : read_scanlines(job, &decoder);
    exr_decoding_destroy(job->context, &decoder);
    return read;
}

/* "name" and "type" belong to the part, not to the picture. */
static void read_attributes(exr_job *job)
{
    int32_t n = 0;
    exr_get_attribute_count(job->context, job->part, &n);
    for (int32_t i = 0; i < n; i++) {
        const exr_attribute_t *a = NULL;
        if (exr_get_attribute_by_index(job->context, job->part, EXR_ATTR_LIST_FILE_ORDER,
                                       i, &a) != EXR_ERR_SUCCESS)
            continue;
        if (a->type == EXR_ATTR_CHROMATICITIES)
            memcpy(job->img->chromaticities, a->chromaticities,
                   sizeof job->img->chromaticities);
        if (a->type != EXR_ATTR_STRING || strcmp(a->name, "name") == 0 ||
            strcmp(a->name, "type") == 0)
            continue;
        g_autofree char *value =
            g_strndup(a->string->str, (gsize)MAX(a->string->length, 0));
        image_header_set(job->img, a->name, value);
    }
}

static bool read_opened(exr_job *job, GError **error)
{
    if (!find_flat_part(job, error))
        return false;
    job->img = allocate_image(job, error);
    if (!job->img)
        return false;
    if (!read_pixels(job)) {
        const char *message = job->message[0] ? job->message : "its chunks do not fit";
        source_damaged(job->source, codec_exr.name, message, error);
        return false;
    }
    read_attributes(job);
    return true;
}

static image *read_exr(const image_source *source, const image_read_options *options,
                       GError **error)
{
    (void)options;
    exr_job job = {.source = source};
    exr_context_initializer_t setup = begin(&job);
    if (!succeeded(&job, exr_start_read(&job.context, source->path, &setup))) {
        source_damaged(source, codec_exr.name, job.message, error);
        return NULL;
    }
    bool read = read_opened(&job, error);
    exr_finish(&job.context);
    if (!read)
        image_free(g_steal_pointer(&job.img));
    return job.img;
}

/* ---- writing ---- */

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
    parallel_for(used, 1, 0, NULL, pack_chunks, chunks);
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

static bool write_exr(const image *img, const image_sink *sink,
                      const image_write_options *options, GError **error)
{
    (void)options;
    exr_job job = {.sink = sink, .to_write = img};
    exr_context_initializer_t setup = begin(&job);
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
const image_codec codec_exr = {"OpenEXR", extensions, recognises, read_exr, write_exr};
