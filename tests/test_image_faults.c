/*
 * image: EXR files of every kind are read, and damaged files of every format end in a
 * message, whatever is cut off and whichever bits are turned. Run under a memory checker
 * this also shows that nothing outside the file is touched.
 */
#include "image/image.h"

#include <glib/gstdio.h>
#include <math.h>
#include <openexr.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

enum { SEED = 20, N_FLIPS = 200, WIDTH = 45, HEIGHT = 38, TILE = 16 };

static const char *const names[] = {"R", "G", "B"};
static char *path;
static unsigned
    n_not_finite; /* images read; printed, so that pixels never set are seen */

static void assert_message_names_file(const GError *error)
{
    g_assert_nonnull(error);
    g_assert_nonnull(strstr(error->message, path));
}

/* Not g_file_set_contents, which waits for the disk. */
static void write_bytes(const char *bytes, size_t size)
{
    FILE *f = g_fopen(path, "wb");
    g_assert_nonnull(f);
    g_assert_cmpuint(fwrite(bytes, 1, size, f), ==, size);
    fclose(f);
}

/* Reads bytes as a file. Nothing must be printed, and there is an image or a message. */
static bool try_read(const char *bytes, size_t size)
{
    GError *error = NULL;
    write_bytes(bytes, size);
    g_autoptr(image) img = image_read(path, NULL, &error);
    if (img) {
        g_assert_no_error(error);
        double sum = 0;
        size_t n = (size_t)img->width * (size_t)img->height * (size_t)img->n_channels;
        for (size_t i = 0; i < n; i++)
            sum += (double)img->pixels[i];
        n_not_finite += !isfinite(sum);
        return true;
    }
    assert_message_names_file(error);
    g_error_free(error);
    return false;
}

static image *gradient(int width, int height)
{
    image *img = image_new(width, height, 3, names, NULL);
    for (int i = 0; i < width * height * 3; i++)
        img->pixels[i] = 0.5f + 0.5f * sinf(0.37f * (float)i);
    return img;
}

static char *file_of(const char *extension, size_t *size)
{
    char *bytes = NULL;
    g_autoptr(image) img = gradient(WIDTH, HEIGHT);
    g_autofree char *name = g_strconcat(path, extension, NULL);
    g_assert_true(image_write(img, name, NULL, NULL));
    g_assert_true(g_file_get_contents(name, &bytes, size, NULL));
    g_unlink(name);
    return bytes;
}

static void test_cut(gconstpointer extension)
{
    size_t size;
    g_autofree char *bytes = file_of(extension, &size);
    g_assert_true(try_read(bytes, size));
    size_t step = MAX(size / 60, 1);
    for (size_t length = 0; length < size; length += length < 50 ? 1 : step)
        g_assert_false(try_read(bytes, length));
    g_assert_false(try_read(bytes, size - 1));
}

static void test_flipped(gconstpointer extension)
{
    size_t size;
    g_autofree char *bytes = file_of(extension, &size);
    g_autofree char *damaged = g_malloc(size);
    g_autoptr(GRand) random = g_rand_new_with_seed(SEED);
    unsigned n_read = 0;
    for (int i = 0; i < N_FLIPS; i++) {
        memcpy(damaged, bytes, size);
        /* Half of the time in the header, where a lie does most. */
        int32_t reach = (int32_t)(i % 2 ? MIN(size, 400) : size);
        int n_bits = g_rand_int_range(random, 1, 4);
        for (int b = 0; b < n_bits; b++)
            damaged[g_rand_int_range(random, 0, reach)] ^=
                (char)(1 << g_rand_int_range(random, 0, 8));
        n_read += try_read(damaged, size);
    }
    g_test_message("seed %d: %u of %d damaged %s files were still images", SEED, n_read,
                   N_FLIPS, (const char *)extension);
    g_test_message("so far %u images were not finite", n_not_finite);
}

/* ---- EXR as others write it ---- */

typedef struct exr_kind {
    exr_compression_t compression;
    exr_pixel_type_t type;
    bool tiled;
    double tolerance; /* relative, of the compression and type */
} exr_kind;

/* A value that half, and as an integer uint, hold exactly. */
static float exr_value(const exr_kind *kind, int x, int y, int c)
{
    int code = (x * 7 + y * 3 + c * 50) % 256;
    return kind->type == EXR_PIXEL_UINT ? (float)code : (float)code / 64.0f;
}

/* One chunk's values of all channels, interleaved, as float or uint. */
static void fill_chunk(const exr_kind *kind, const exr_chunk_info_t *chunk, int x0,
                       int y0, uint32_t *out)
{
    for (int y = 0; y < chunk->height; y++)
        for (int x = 0; x < chunk->width; x++)
            for (int c = 0; c < 3; c++, out++) {
                float v = exr_value(kind, x0 + x, y0 + y, c);
                uint32_t integer = (uint32_t)v;
                memcpy(out, kind->type == EXR_PIXEL_UINT ? (void *)&integer : (void *)&v,
                       sizeof *out);
            }
}

static void encode_chunk(exr_context_t context, const exr_kind *kind,
                         const exr_chunk_info_t *chunk, int x0, int y0)
{
    exr_encode_pipeline_t encoder = EXR_ENCODE_PIPELINE_INITIALIZER;
    g_autofree uint32_t *values =
        g_new0(uint32_t, (size_t)chunk->width * (size_t)chunk->height * 3);
    fill_chunk(kind, chunk, x0, y0, values);
    g_assert_cmpint(exr_encoding_initialize(context, 0, chunk, &encoder), ==, 0);
    for (int c = 0; c < 3; c++) {
        exr_coding_channel_info_t *channel = &encoder.channels[c];
        channel->encode_from_ptr = (const uint8_t *)(values + c);
        channel->user_data_type =
            kind->type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = 4;
        channel->user_pixel_stride = 12;
        channel->user_line_stride = 12 * chunk->width;
    }
    g_assert_cmpint(exr_encoding_choose_default_routines(context, 0, &encoder), ==, 0);
    g_assert_cmpint(exr_encoding_run(context, 0, &encoder), ==, 0);
    exr_encoding_destroy(context, &encoder);
}

static void encode_chunks(exr_context_t context, const exr_kind *kind)
{
    exr_chunk_info_t chunk;
    int32_t step = 0;
    if (!kind->tiled) {
        exr_get_scanlines_per_chunk(context, 0, &step);
        for (int y = 0; y < HEIGHT; y += step) {
            exr_write_scanline_chunk_info(context, 0, y - 5, &chunk);
            encode_chunk(context, kind, &chunk, 0, y);
        }
        return;
    }
    for (int y = 0; y * TILE < HEIGHT; y++)
        for (int x = 0; x * TILE < WIDTH; x++) {
            exr_write_tile_chunk_info(context, 0, x, y, 0, 0, &chunk);
            encode_chunk(context, kind, &chunk, x * TILE, y * TILE);
        }
}

/* A data window that does not begin at zero. */
static void write_exr_kind(const exr_kind *kind)
{
    exr_context_t context = NULL;
    int part;
    const exr_attr_box2i_t window = {.min = {{{3, -5}}},
                                     .max = {{{WIDTH + 2, HEIGHT - 6}}}};
    const exr_attr_v2f_t center = {{{0, 0}}};
    exr_storage_t storage = kind->tiled ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE;
    g_assert_cmpint(exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, NULL), ==,
                    0);
    exr_add_part(context, "beauty", storage, &part);
    exr_initialize_required_attr(context, 0, &window, &window, 1, &center, 1,
                                 EXR_LINEORDER_INCREASING_Y, kind->compression);
    if (kind->tiled)
        exr_set_tile_descriptor(context, 0, TILE, TILE, EXR_TILE_ONE_LEVEL,
                                EXR_TILE_ROUND_DOWN);
    for (int c = 0; c < 3; c++) {
        const char *const sorted[] = {"B", "G", "R"};
        exr_add_channel(context, 0, sorted[c], kind->type, EXR_PERCEPTUALLY_LOGARITHMIC,
                        1, 1);
    }
    g_assert_cmpint(exr_write_header(context), ==, 0);
    encode_chunks(context, kind);
    g_assert_cmpint(exr_finish(&context), ==, 0);
}

static void check_exr_kind(const exr_kind *kind)
{
    GError *error = NULL;
    write_exr_kind(kind);
    g_autoptr(image) img = image_read(path, NULL, &error);
    g_assert_no_error(error);
    g_assert_cmpint(img->width, ==, WIDTH);
    g_assert_cmpint(img->height, ==, HEIGHT);
    g_assert_cmpstr(img->channels[0], ==, "B");
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++) {
        int x = i / 3 % WIDTH, y = i / 3 / WIDTH;
        double expected = (double)exr_value(kind, x, y, i % 3);
        g_assert_cmpfloat_with_epsilon((double)img->pixels[i], expected,
                                       1e-9 + kind->tolerance * expected);
    }
}

static void test_exr_kinds(void)
{
    const exr_compression_t lossless[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE,
                                          EXR_COMPRESSION_ZIPS, EXR_COMPRESSION_ZIP,
                                          EXR_COMPRESSION_PIZ};
    for (size_t i = 0; i < G_N_ELEMENTS(lossless); i++)
        for (int type = EXR_PIXEL_UINT; type <= EXR_PIXEL_FLOAT; type++)
            for (int tiled = 0; tiled < 2; tiled++) {
                exr_kind kind = {lossless[i], (exr_pixel_type_t)type, tiled, 0};
                check_exr_kind(&kind);
            }
    for (int tiled = 0; tiled < 2; tiled++) {
        exr_kind pxr = {EXR_COMPRESSION_PXR24, EXR_PIXEL_FLOAT, tiled, exp2(-15)};
        check_exr_kind(&pxr);
        exr_kind b44 = {EXR_COMPRESSION_B44, EXR_PIXEL_UINT, tiled, 0};
        check_exr_kind(&b44);
    }
    g_unlink(path);
}

static void test_exr_kinds_damaged(void)
{
    const exr_compression_t all[] = {EXR_COMPRESSION_NONE,  EXR_COMPRESSION_RLE,
                                     EXR_COMPRESSION_ZIP,   EXR_COMPRESSION_PIZ,
                                     EXR_COMPRESSION_PXR24, EXR_COMPRESSION_B44};
    g_autoptr(GRand) random = g_rand_new_with_seed(SEED);
    for (size_t i = 0; i < 2 * G_N_ELEMENTS(all); i++) {
        exr_kind kind = {all[i / 2], EXR_PIXEL_HALF, i % 2, 0};
        g_autofree char *bytes = NULL;
        size_t size;
        write_exr_kind(&kind);
        g_assert_true(g_file_get_contents(path, &bytes, &size, NULL));
        for (int flip = 0; flip < N_FLIPS / 4; flip++) {
            size_t at = (size_t)g_rand_int_range(random, 0, (int32_t)size);
            char bit = (char)(1 << g_rand_int_range(random, 0, 8));
            bytes[at] ^= bit;
            try_read(bytes, size);
            bytes[at] ^= bit;
        }
        for (int cut = 0; cut < 40; cut++)
            g_assert_false(try_read(bytes, size * (size_t)cut / 40));
    }
    g_unlink(path);
}

/* The file's first channel, B, is said to have a value in every third column only. */
static void test_exr_subsampled_is_refused(void)
{
    size_t size;
    GError *error = NULL;
    g_autofree char *bytes = file_of(".exr", &size);
    const char list[] = "chlist";
    const size_t to_sampling = sizeof list + 4 + sizeof "B" + 4 + 4;
    char *found = bytes;
    while (memcmp(found, list, sizeof list) != 0 && found + sizeof list < bytes + size)
        found++;
    g_assert_true(found[to_sampling] == 1);
    found[to_sampling] = 3;
    write_bytes(bytes, size);
    g_assert_null(image_read(path, NULL, &error));
    assert_message_names_file(error);
    g_assert_nonnull(strstr(error->message, "'B' is subsampled"));
    g_error_free(error);
}

/* A chunk that says it has 1.6 GB, in a file of 73 bytes: no memory is asked for it.
   Found by fuzzing. */
static void test_claims(void)
{
    static const unsigned char bytes[] =
        "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\2\0\0\0\2\1\3\0\0\0\x48\x78\x9f\x67"
        "\x63\0\x63\x25tEXtdate:c";
    struct rusage before, after;
    GError *error = NULL;
    getrusage(RUSAGE_SELF, &before);
    write_bytes((const char *)bytes, sizeof bytes - 1);
    g_assert_null(image_read(path, NULL, &error));
    assert_message_names_file(error);
    g_error_free(error);
    getrusage(RUSAGE_SELF, &after);
    g_assert_cmpint(after.ru_maxrss - before.ru_maxrss, <, 100 * 1024);
}

/* The library has no business on the terminal: standard output and error stay empty. */
static void test_nothing_is_printed(void)
{
    if (g_test_subprocess()) {
        const char *const extensions[] = {".exr", ".png", ".jpg", ".hdr", ".pfm"};
        for (size_t i = 0; i < G_N_ELEMENTS(extensions); i++) {
            size_t size;
            g_autofree char *bytes = file_of(extensions[i], &size);
            for (size_t length = 0; length < size; length += size / 20)
                try_read(bytes, length);
        }
        return;
    }
    g_test_trap_subprocess(NULL, 0, 0);
    g_test_trap_assert_passed();
    g_test_trap_assert_stderr("");
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    static const char *const extensions[] = {".exr", ".png", ".jpg", ".hdr", ".pfm"};
    g_autofree char *folder = g_dir_make_tmp("nephroid-faults-XXXXXX", NULL);
    path = g_build_filename(folder, "damaged", NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(extensions); i++) {
        g_autofree char *cut = g_strdup_printf("/image/cut/%s", extensions[i] + 1);
        g_autofree char *flipped =
            g_strdup_printf("/image/flipped/%s", extensions[i] + 1);
        g_test_add_data_func(cut, extensions[i], test_cut);
        g_test_add_data_func(flipped, extensions[i], test_flipped);
    }
    g_test_add_func("/image/exr-kinds", test_exr_kinds);
    g_test_add_func("/image/exr-kinds-damaged", test_exr_kinds_damaged);
    g_test_add_func("/image/exr-subsampled", test_exr_subsampled_is_refused);
    g_test_add_func("/image/claims", test_claims);
    g_test_add_func("/image/silent", test_nothing_is_printed);
    int result = g_test_run();
    g_unlink(path);
    g_rmdir(folder);
    g_free(path);
    return result;
}
