/*
 * pictures: texels keep every bit of an image in as few bytes as can be, are halved to
 * means, and are shared by all that read a file alike.
 */
#include "scene/builder.h"
#include "scene_text.h"
#include "texture/picture.h"

#include <string.h>

static image *image_of(int width, int height, int n_channels)
{
    static const char *const names[] = {"R", "G", "B", "A"};
    image *img = image_new(width, height, n_channels, names, NULL);
    g_assert_nonnull(img);
    return img;
}

/* @param n_values that its second channel has; the others have few */
static image *image_with_values(int n_values)
{
    image *img = image_of(40, 30, 3);
    for (int i = 0; i < 40 * 30; i++) {
        img->pixels[3 * i] = i % 7 ? 0.1f * (float)(i % 7) : -0.0f;
        img->pixels[3 * i + 1] = sqrtf((float)(i * 37 % n_values));
        img->pixels[3 * i + 2] = i % 5 ? 1.0f / (float)(i % 5) : NAN;
    }
    return img;
}

static void test_bits(gconstpointer data)
{
    int n_values = GPOINTER_TO_INT(data);
    g_autoptr(image) img = image_with_values(n_values);
    texels *t = texels_from_image(image_with_values(n_values), NULL);
    g_assert_nonnull(t);
    g_assert_cmpint(t->codes != NULL, ==, n_values <= TEXEL_CODES);
    for (size_t i = 0; i < 40 * 30; i++)
        for (int c = 0; c < 3; c++) {
            float value = texels_value(t, i, c);
            g_assert_cmpmem(&value, sizeof value, &img->pixels[3 * i + (size_t)c],
                            sizeof value);
        }
    g_assert_true(!t->codes || !t->values);
    texels_free(t);
}

/* Sides are rounded up, and the last of an odd one counts twice. */
static void test_halved(void)
{
    image *img = image_of(3, 2, 1);
    const float pixels[6] = {1, 2, 4, 8, 16, 32};
    memcpy(img->pixels, pixels, sizeof pixels);
    texels *t = texels_from_image(img, NULL);
    texels *half = texels_halved(t, NULL);
    g_assert_cmpint(half->width, ==, 2);
    g_assert_cmpint(half->height, ==, 1);
    g_assert_cmpfloat(fabsf(texels_value(half, 0, 0) - 6.75f), <, 1e-6f);
    g_assert_cmpfloat(fabsf(texels_value(half, 1, 0) - 18.0f), <, 1e-6f);
    texels_free(half);
    texels_free(t);
}

static picture *read_with(const scene_builder *s, params *p, image_encoding encoding)
{
    const image_read_options options = {.encoding = encoding, .gamma = 1.0f};
    GError *error = NULL;
    picture *pic = picture_read(&s->build, p, "filename", &options, &error);
    g_assert_no_error(error);
    return pic;
}

/* One in memory for all that decode its codes alike. */
static void test_shared(void)
{
    scene_folder f = folder_new("");
    image *img = image_of(2, 2, 3);
    img->pixels[0] = 0.5f;
    g_autofree char *path = g_build_filename(f.path, "shared.png", NULL);
    g_assert_true(image_write(img, path, NULL, NULL));
    image_free(img);
    g_ptr_array_add(f.files, g_strdup(path));
    g_autoptr(scene_builder) s = scene_builder_new(NULL);
    const source_place here = {"test", 1, 1};
    const char *const paths[] = {path};
    g_autoptr(params) p = params_new(here, NULL, NULL);
    g_assert_true(params_add_strings(p, here, PARAM_STRING, "filename", paths, 1, NULL));
    picture *a = read_with(s, p, ENCODING_AUTO), *b = read_with(s, p, ENCODING_AUTO);
    picture *c = read_with(s, p, ENCODING_LINEAR);
    g_assert_true(a == b);
    g_assert_true(a != c);
    g_assert_cmpfloat(texels_value(a->levels[0], 0, 0), <,
                      texels_value(c->levels[0], 0, 0));
    picture_unref(a);
    g_assert_cmpint(b->levels[0]->width, ==, 2);
    picture_unref(b);
    picture_unref(c);
    folder_remove(&f);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_data_func("/picture/bits/few", GINT_TO_POINTER(20), test_bits);
    g_test_add_data_func("/picture/bits/256", GINT_TO_POINTER(256), test_bits);
    g_test_add_data_func("/picture/bits/257", GINT_TO_POINTER(257), test_bits);
    g_test_add_func("/picture/halved", test_halved);
    g_test_add_func("/picture/shared", test_shared);
    return g_test_run();
}
