/*
 * image: damaged files of every format end in a message, whatever is cut off and
 * whichever bits are turned. Run under a memory checker this also shows that nothing
 * outside the file is touched.
 */
#include "exr_files.h"
#include "image/image.h"

#include <glib/gstdio.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

enum { SEED = 20, N_FLIPS = 200, WIDTH = 45, HEIGHT = 38 };

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

static void test_exr_kinds_damaged(void)
{
    static const char *const rgb[] = {"R", "G", "B", NULL};
    g_autoptr(GRand) random = g_rand_new_with_seed(SEED);
    for (int i = 0; i < 2 * EXR_N_COMPRESSIONS; i++) {
        exr_kind kind = {rgb, EXR_HALF, i % 2 ? EXR_TILES : EXR_SCANLINES, i / 2};
        g_autofree char *bytes = NULL;
        size_t size;
        exr_kind_write(&kind, path);
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

/* A value whose size is not its type's shifts all that follows it: what the library would
 * take for a size was 1.9 GB. Found by damage. */
static void test_exr_attribute_sizes(void)
{
    static const char *const types[] = {"lineOrder", "compression", "float",
                                        "v2f",       "box2i",       "chlist"};
    for (size_t i = 0; i < G_N_ELEMENTS(types); i++) {
        size_t size, length = strlen(types[i]) + 1;
        GError *error = NULL;
        g_autofree char *bytes = file_of(".exr", &size);
        char *found = bytes;
        /* the type, not a name that is the same */
        while (memcmp(found, types[i], length) != 0 || found[length + 1] != 0)
            g_assert_true(++found + length < bytes + size);
        found[length]++;
        write_bytes(bytes, size);
        g_assert_null(image_read(path, NULL, &error));
        assert_message_names_file(error);
        g_assert_nonnull(strstr(error->message, "its header does not end"));
        g_error_free(error);
    }
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
    g_test_add_func("/image/exr-kinds-damaged", test_exr_kinds_damaged);
    g_test_add_func("/image/exr-subsampled", test_exr_subsampled_is_refused);
    g_test_add_func("/image/exr-attribute-sizes", test_exr_attribute_sizes);
    g_test_add_func("/image/claims", test_claims);
    g_test_add_func("/image/silent", test_nothing_is_printed);
    int result = g_test_run();
    g_unlink(path);
    g_rmdir(folder);
    g_free(path);
    return result;
}
