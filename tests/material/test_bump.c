/*
 * bump: normal maps and displacements bend the shading normal as the surface they stand
 * for would have it.
 */
#include "math/sampler.h"
#include "scene/builder.h"

#include <glib/gstdio.h>
#include <string.h>

static const source_place here = {"b.pbrt", 2, 3};
static char *folder, *map_path, *height_path;

enum { SIZE = 64 };

static params *list(void)
{
    return params_new(here, "/", color_space_srgb());
}

static params *with_map(params *p)
{
    const char *path = map_path;
    params_add_strings(p, here, PARAM_STRING, "normalmap", &path, 1, NULL);
    return p;
}

static void write_pixels(const char *path, void (*fill)(int x, int y, float rgb[3]))
{
    static const char *const names[] = {"R", "G", "B"};
    g_autoptr(image) img = image_new(SIZE, SIZE, 3, names, NULL);
    for (int i = 0; i < SIZE * SIZE; i++)
        fill(i % SIZE, i / SIZE, img->pixels + 3 * i);
    g_assert_true(image_write(img, path, NULL, NULL));
}

/* The normal (0.6, 0, 0.8) in the left half, (0, 0.6, 0.8) in the right one. */
static void fill_map(int x, int y, float rgb[3])
{
    (void)y;
    bool left = x < SIZE / 2;
    rgb[0] = 0.5f * ((left ? 0.6f : 0.0f) + 1.0f);
    rgb[1] = 0.5f * ((left ? 0.0f : 0.6f) + 1.0f);
    rgb[2] = 0.9f;
}

/* Heights of 2 u + 3 v, v upwards in the image. */
static void fill_height(int x, int y, float rgb[3])
{
    float u = ((float)x + 0.5f) / SIZE, v = 1.0f - ((float)y + 0.5f) / SIZE;
    rgb[0] = rgb[1] = rgb[2] = 2.0f * u + 3.0f * v;
}

static bsdf bsdf_at(const build_context *context, params *p, const surface_hit *hit)
{
    GError *error = NULL;
    material *m = material_new(context, "diffuse", p, &error);
    g_assert_no_error(error);
    const wavelengths w = wavelengths_at(0.5f);
    const bsdf_options plain = {0};
    bsdf b;
    material_bsdf(m, hit, &w, ALL_WAVELENGTHS, &plain, &b);
    material_free(m);
    params_free(p);
    return b;
}

static void assert_close(vec3 a, vec3 b)
{
    g_assert_cmpfloat(length3(a - b), <, 8e-3f);
}

/* u along y, v along -x, n along z: turned by a quarter. */
static surface_hit turned_hit(float u)
{
    return (surface_hit){.n = {0, 0, 1, 0},
                         .n_geom = {0, 0, 1, 0},
                         .dpdu = {0, 2, 0, 0},
                         .dpdv = {-3, 0, 0, 0},
                         .uv = {u, 0.3f}};
}

static void test_normal_map(void)
{
    surface_hit hit = turned_hit(0.25f);
    assert_close(bsdf_at(NULL, with_map(list()), &hit).shading.n, vec3_make(0, .6f, .8f));
    hit = turned_hit(0.75f);
    bsdf b = bsdf_at(NULL, with_map(list()), &hit);
    assert_close(b.shading.n, vec3_make(-0.6f, 0, 0.8f));
    g_assert_cmpfloat(fabsf(dot3(b.shading.s, b.shading.n)), <, 1e-6f);
    assert_close(b.shading.s, vec3_make(0, 1, 0));
    assert_close(b.n_geom, vec3_make(0, 0, 1));
    hit = turned_hit(1.25f); /* repeats */
    assert_close(bsdf_at(NULL, with_map(list()), &hit).shading.n, vec3_make(0, .6f, .8f));
}

/* Where v runs the other way green follows it. */
static void test_mirrored_map(void)
{
    surface_hit hit = turned_hit(0.75f);
    hit.dpdv = -hit.dpdv;
    assert_close(bsdf_at(NULL, with_map(list()), &hit).shading.n, vec3_make(.6f, 0, .8f));
}

static void test_normal_scale(void)
{
    surface_hit hit = turned_hit(0.25f);
    params *p = with_map(list());
    const float half = 0.5f;
    params_add_numbers(p, here, PARAM_FLOAT, "normalscale", &half, 1, NULL);
    assert_close(bsdf_at(NULL, p, &hit).shading.n, normalize3(vec3_make(0, 0.3f, 0.8f)));
}

/* The plane lifted by d(u, v) has the normal (-dd/dx, -dd/dy, 1). */
static void test_displacement(void)
{
    scene_builder *s = scene_builder_new(NULL);
    params *p = list();
    const char *path = height_path, *name = "heights";
    params_add_strings(p, here, PARAM_STRING, "filename", &path, 1, NULL);
    GError *error = NULL;
    builder_add_texture(s, name, "imagemap", false, p, &error);
    g_assert_no_error(error);
    params_free(p);
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        surface_hit hit = turned_hit(0.4f);
        if (mirrored)
            hit.dpdv = -hit.dpdv;
        float slope_x = (mirrored ? 1.0f : -1.0f) * 3.0f / 3.0f, slope_y = 2.0f / 2.0f;
        p = list();
        params_add_strings(p, here, PARAM_TEXTURE, "displacement", &name, 1, NULL);
        vec3 expected = normalize3(vec3_make(-slope_x, -slope_y, 1));
        g_assert_cmpfloat(length3(bsdf_at(&s->build, p, &hit).shading.n - expected), <,
                          2e-2f);
    }
    scene_builder_free(s);
}

static void refuse(params *p, const char *part)
{
    g_autoptr(GError) error = NULL;
    g_assert_null(material_new(NULL, "diffuse", p, &error));
    g_assert_nonnull(strstr(error->message, part));
    g_assert_true(g_str_has_prefix(error->message, "b.pbrt:2:3: "));
    params_free(p);
}

static void test_refusals(void)
{
    const char *none = "none.png";
    params *p = list();
    params_add_strings(p, here, PARAM_STRING, "normalmap", &none, 1, NULL);
    refuse(p, "none.png");
    p = with_map(list());
    params_add_strings(p, here, PARAM_TEXTURE, "displacement", &none, 1, NULL);
    refuse(p, "either 'normalmap' or 'displacement'");
    p = list();
    const float one = 1.0f;
    params_add_numbers(p, here, PARAM_FLOAT, "normalscale", &one, 1, NULL);
    refuse(p, "unknown parameter 'normalscale'");
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder = g_dir_make_tmp("nephroid-bump-XXXXXX", NULL);
    map_path = g_build_filename(folder, "map.png", NULL);
    height_path = g_build_filename(folder, "height.pfm", NULL);
    /* a PNG holds sRGB codes: what is written is what they decode to */
    write_pixels(height_path, fill_height);
    g_autoptr(image) img = NULL;
    write_pixels(map_path, fill_map);
    img = image_read(map_path, NULL, NULL);
    for (int i = 0; i < 3 * SIZE * SIZE; i++)
        img->pixels[i] = srgb_decode(img->pixels[i]);
    g_assert_true(image_write(img, map_path, NULL, NULL));
    g_test_add_func("/bump/normal-map", test_normal_map);
    g_test_add_func("/bump/mirrored", test_mirrored_map);
    g_test_add_func("/bump/scale", test_normal_scale);
    g_test_add_func("/bump/displacement", test_displacement);
    g_test_add_func("/bump/refusals", test_refusals);
    int status = g_test_run();
    g_unlink(map_path);
    g_unlink(height_path);
    g_rmdir(folder);
    g_free(map_path);
    g_free(height_path);
    g_free(folder);
    return status;
}
