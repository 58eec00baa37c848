/*
 * exr: files that another library wrote give the values that were put into them, each in
 * its channel, whatever type, layout and compression; and a sky, a texture and a
 * comparison see the same.
 */
#include "exr_files.h"
#include "image/compare.h"
#include "image/image.h"
#include "texture/picture.h"

#include <glib/gstdio.h>
#include <malloc.h>
#include <string.h>

/* Channels as they come: grey, colour, more than colour, in any order, in layers. */
static const char *const sets[][14] = {
    {"Y"},
    {"Y", "A"},
    {"R", "G", "B"},
    {"R", "G", "B", "A"},
    {"A", "G"},
    {"B", "A", "R"},
    {"B", "G", "R", "Z"},
    {"R", "G", "B", "A", "diffuse.R", "diffuse.G", "diffuse.B", "diffuse.A", "depth.Z",
     "id"},
    {"View.Combined.R", "View.Combined.G", "View.Combined.B", "View.Combined.A"},
};
static char *path;

static image *read_kind(const exr_kind *kind)
{
    GError *error = NULL;
    exr_kind_write(kind, path);
    image *img = image_read(path, NULL, &error);
    g_assert_no_error(error);
    return img;
}

static void check_channel(const image *img, const exr_kind *kind, int c)
{
    double tolerance = exr_kind_tolerance(kind, c);
    int from = image_channel(img, kind->channels[c]);
    g_assert_cmpint(from, >=, 0);
    for (int y = 0; y < img->height; y++)
        for (int x = 0; x < img->width; x++) {
            size_t at = (size_t)(y * img->width + x) * (size_t)img->n_channels;
            double value = (double)img->pixels[at + (size_t)from];
            double expected = (double)exr_kind_value(kind, c, x, y);
            g_assert_cmpfloat_with_epsilon(value, expected, 1e-9 + tolerance * expected);
        }
}

static void check_kind(const exr_kind *kind)
{
    int n = 0;
    g_autoptr(image) img = read_kind(kind);
    g_assert_cmpint(img->width, ==, EXR_WIDTH);
    g_assert_cmpint(img->height, ==, EXR_HEIGHT);
    for (; kind->channels[n]; n++)
        check_channel(img, kind, n);
    g_assert_cmpint(img->n_channels, ==, n);
    for (int c = 1; c < n; c++)
        g_assert_cmpstr(img->channels[c - 1], <, img->channels[c]);
}

static void test_values(gconstpointer values)
{
    for (size_t set = 0; set < G_N_ELEMENTS(sets); set++)
        for (int layout = 0; layout < EXR_N_LAYOUTS; layout++)
            for (int compression = 0; compression < EXR_N_COMPRESSIONS; compression++) {
                exr_kind kind = {sets[set], (exr_values)GPOINTER_TO_INT(values),
                                 (exr_layout)layout, compression};
                check_kind(&kind);
            }
}

/* The library asks for large tables again for every file: three quarters of the time go
   by in giving them back to the system and getting them anew. */
static void keep_what_is_freed(void)
{
    mallopt(M_TRIM_THRESHOLD, 1 << 28);
    mallopt(M_MMAP_THRESHOLD, 1 << 28);
}

/* ---- what comes behind the reader ---- */

static const exr_kind half_rgba[] = {
    {sets[3], EXR_HALF, EXR_SCANLINES, 3},
    {sets[3], EXR_HALF, EXR_TILES, 3},
};

/* Textures and skies look pictures up. */
static void test_picture(void)
{
    for (size_t k = 0; k < G_N_ELEMENTS(half_rgba); k++) {
        GError *error = NULL;
        exr_kind_write(&half_rgba[k], path);
        picture *pic = picture_read_file(NULL, path, NULL, &error);
        g_assert_no_error(error);
        const vec2 middle_of_5_7 = {5.5f / EXR_WIDTH, 7.5f / EXR_HEIGHT};
        texel_mix mix = picture_nearest(pic, 0, middle_of_5_7, WRAP_CLAMP);
        float rgb[3];
        picture_rgb(pic, &mix, rgb);
        for (int c = 0; c < 3; c++)
            g_assert_cmpfloat(rgb[c], ==, exr_kind_value(&half_rgba[k], c, 5, 7));
        g_assert_true(picture_has_alpha(pic) == false);
        picture_unref(pic);
    }
}

static void test_compared(void)
{
    exr_kind floats = half_rgba[0];
    floats.values = EXR_FLOAT;
    g_autoptr(image) reference = read_kind(&floats);
    for (size_t k = 0; k < G_N_ELEMENTS(half_rgba); k++) {
        image_difference found;
        g_autoptr(image) img = read_kind(&half_rgba[k]);
        g_assert_true(image_compare(img, reference, &found, NULL));
        g_assert_cmpfloat(found.rmse, ==, 0);
        g_assert_cmpfloat(found.mean_a, ==, found.mean_b);
    }
}

/* A picture of Y, with alpha or alone, is grey to every format that knows colours only.
 */
static void test_grey(void)
{
    g_autofree char *pfm = g_strconcat(path, ".pfm", NULL);
    for (int set = 0; set < 2; set++) {
        GError *error = NULL;
        exr_kind kind = {sets[set], EXR_HALF, EXR_SCANLINES, 0};
        g_autoptr(image) grey = read_kind(&kind);
        image_write(grey, pfm, NULL, &error);
        g_assert_no_error(error);
        g_autoptr(image) back = image_read(pfm, NULL, NULL);
        for (int i = 0; i < EXR_WIDTH * EXR_HEIGHT * 3; i++) {
            int x = i / 3 % EXR_WIDTH, y = i / 3 / EXR_WIDTH;
            g_assert_cmpfloat(back->pixels[i], ==, exr_kind_value(&kind, 0, x, y));
        }
        g_unlink(pfm);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    keep_what_is_freed();
    static const char *const types[EXR_N_VALUES] = {"uint", "half", "float", "mixed"};
    g_autofree char *folder = g_dir_make_tmp("nephroid-exr-XXXXXX", NULL);
    path = g_build_filename(folder, "kind.exr", NULL);
    for (int i = 0; i < EXR_N_VALUES; i++) {
        g_autofree char *name = g_strdup_printf("/exr/values/%s", types[i]);
        g_test_add_data_func(name, GINT_TO_POINTER(i), test_values);
    }
    g_test_add_func("/exr/picture", test_picture);
    g_test_add_func("/exr/compared", test_compared);
    g_test_add_func("/exr/grey", test_grey);
    int result = g_test_run();
    g_unlink(path);
    g_rmdir(folder);
    g_free(path);
    return result;
}
