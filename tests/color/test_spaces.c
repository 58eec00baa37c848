/*
 * spaces: colours are read in the space that a scene or an image names, and an image of
 * unknown primaries is refused.
 */
#include "image/image.h"
#include "scene_text.h"

#include <glib/gstdio.h>
#include <string.h>

static const char *const spaces[] = {"srgb", "rec2020", "dci-p3", "aces2065-1"};
static const float leaf[3] = {0.2f, 0.5f, 0.1f};

static void assert_same(spectrum a, spectrum b, float tolerance)
{
    for (int i = 0; i < N_WAVELENGTHS; i++)
        g_assert_cmpfloat(fabsf(a[i] - b[i]), <, tolerance);
}

static float apart(spectrum a, spectrum b)
{
    spectrum d = (a - b) * (a - b);
    return sqrtf(spectrum_max(d));
}

static spectrum curve_in(const char *space, curve_role role, const wavelengths *w)
{
    g_autoptr(curve) c = curve_rgb(color_space_find(space), leaf, role, NULL);
    return curve_eval(c, w);
}

/* Materials, textures and lights after the directive, and only those within its block. */
static void test_directive(void)
{
    const wavelengths w = wavelengths_at(0.5f);
    const bsdf_options plain = {0};
    for (size_t i = 0; i < G_N_ELEMENTS(spaces); i++) {
        g_autofree char *text = g_strdup_printf(
            "Camera \"perspective\" WorldBegin LightSource \"point\" \"rgb I\" [.2 .5 "
            ".1]\n"
            "AttributeBegin ColorSpace \"%s\"\n"
            "LightSource \"point\" \"rgb I\" [.2 .5 .1] LightSource \"point\"\n"
            "Material \"diffuse\" \"rgb reflectance\" [.2 .5 .1]\n"
            "Shape \"sphere\" AttributeEnd\n"
            "Material \"diffuse\" \"rgb reflectance\" [.2 .5 .1] Shape \"sphere\"\n",
            spaces[i]);
        g_autoptr(scene) s = scene_of(text);
        spectrum rho[2];
        for (int k = 0; k < 2; k++) {
            const shape *on = s->shapes->pdata[k];
            surface_hit hit = {.n = {0, 0, 1, 0}, .n_geom = {0, 0, 1, 0}};
            hit.dpdu = vec3_make(1, 0, 0);
            bsdf b;
            material_bsdf(s->materials->pdata[on->material], &hit, &w, ALL_WAVELENGTHS,
                          &plain, &b);
            rho[k] = b.rho;
        }
        assert_same(rho[0], curve_in(spaces[i], CURVE_ALBEDO, &w), 1e-5f);
        assert_same(rho[1], curve_in("srgb", CURVE_ALBEDO, &w), 1e-5f);
        spectrum sent[3];
        for (int k = 0; k < 3; k++)
            sent[k] = scene_light(s, k)->kind->power(scene_light(s, k)->self, &w);
        if (i > 0) {
            g_assert_cmpfloat(apart(rho[0], rho[1]), >, 0.01f);
            g_assert_cmpfloat(apart(sent[0], sent[1]), >, 0.01f * spectrum_max(sent[0]));
        }
        /* the white of a light that names no colour is the space's */
        const float white[3] = {1, 1, 1};
        g_autoptr(curve) own =
            curve_rgb(color_space_find(spaces[i]), white, CURVE_EMISSION, NULL);
        spectrum expected = curve_eval(own, &w) * (4 * PI_F / curve_photometric(own));
        assert_same(sent[2], expected, 1e-4f * spectrum_max(expected));
    }
}

static texture *read_leaf(const char *path, GError **error)
{
    g_autoptr(params) p =
        params_new((source_place){"s.pbrt", 1, 2}, "/", color_space_srgb());
    params_add_strings(p, p->place, PARAM_STRING, "filename", &path, 1, NULL);
    return texture_new(NULL, "imagemap", true, p, error);
}

static void test_images(void)
{
    static const char *const names[] = {"R", "G", "B"};
    const wavelengths w = wavelengths_at(0.5f);
    g_autofree char *folder = g_dir_make_tmp("nephroid-spaces-XXXXXX", NULL);
    g_autofree char *path = g_build_filename(folder, "leaf.exr", NULL);
    g_autoptr(image) img = image_new(1, 1, 3, names, NULL);
    memcpy(img->pixels, leaf, sizeof leaf);
    surface_hit hit = {.uv = {0.5f, 0.5f}};
    for (size_t i = 0; i < G_N_ELEMENTS(spaces); i++) {
        GError *error = NULL;
        color_space_chromaticities(color_space_find(spaces[i]), img->chromaticities);
        g_assert_true(image_write(img, path, NULL, NULL));
        texture *t = read_leaf(path, &error);
        g_assert_no_error(error);
        assert_same(texture_eval_spectrum(t, &hit, &w, CURVE_ALBEDO),
                    curve_in(spaces[i], CURVE_ALBEDO, &w), 8e-3f);
        texture_free(t);
    }
    g_autoptr(GError) error = NULL;
    img->chromaticities[0] = 0.9f;
    g_assert_true(image_write(img, path, NULL, NULL));
    g_assert_null(read_leaf(path, &error));
    g_assert_nonnull(strstr(error->message, "primaries"));
    g_unlink(path);
    g_rmdir(folder);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/spaces/directive", test_directive);
    g_test_add_func("/spaces/images", test_images);
    return g_test_run();
}
