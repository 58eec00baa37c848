/*
 * texture: image look-ups against a naive twin, in pbrt-v4's orientation, with every
 * parameter acting, and bad ones refused at their place.
 */
#include "image/image.h"
#include "math/sampler.h"
#include "math/warp.h"
#include "texture/mapping.h"
#include "texture/texture.h"

#include <glib/gstdio.h>
#include <string.h>

enum { WIDTH = 4, HEIGHT = 3 };

static const source_place here = {"t.pbrt", 5, 2};
static char *folder, *colour_path, *cutout_path;

static float texel_value(int x, int y, int c)
{
    return 0.05f + 0.9f * (float)((x * 7 + y * 5 + c * 3) % 11) / 10.0f;
}

static void write_image(const char *path, bool with_alpha)
{
    static const char *const names[] = {"R", "G", "B", "A"};
    int n = with_alpha ? 4 : 3;
    g_autoptr(image) img = image_new(WIDTH, HEIGHT, n, names, NULL);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        for (int c = 0; c < n; c++)
            img->pixels[i * n + c] = texel_value(i % WIDTH, i / WIDTH, c);
    g_assert_true(image_write(img, path, NULL, NULL));
}

static params *list(const char *path)
{
    params *p = params_new((source_place){"t.pbrt", 1, 1}, folder, color_space_srgb());
    if (path)
        params_add_strings(p, here, PARAM_STRING, "filename", &path, 1, NULL);
    return p;
}

static params *with_number(params *p, const char *name, float x)
{
    g_assert_true(params_add_numbers(p, here, PARAM_FLOAT, name, &x, 1, NULL));
    return p;
}

static params *with_word(params *p, const char *name, const char *word)
{
    g_assert_true(params_add_strings(p, here, PARAM_STRING, name, &word, 1, NULL));
    return p;
}

/* A look-up through an input that borrows the texture. */
static float number_at(params *p, float u, float v)
{
    GError *error = NULL;
    texture *t = texture_new(NULL, "imagemap", false, p, &error);
    g_assert_no_error(error);
    float_input in = {.texture = t};
    surface_hit hit = {.uv = {u, v}};
    float x = float_input_eval(&in, &hit);
    texture_free(t);
    params_free(p);
    return x;
}

/* The average of the channels, bilinear, repeating: written out the slow way. */
static double naive(double u, double v)
{
    double x = u * WIDTH - 0.5, y = (1.0 - v) * HEIGHT - 0.5, sum = 0.0;
    for (int j = -40; j < 40; j++)
        for (int i = -40; i < 40; i++) {
            double weight = fmax(0.0, 1.0 - fabs(x - i)) * fmax(0.0, 1.0 - fabs(y - j));
            int a = ((i % WIDTH) + WIDTH) % WIDTH, b = ((j % HEIGHT) + HEIGHT) % HEIGHT;
            for (int c = 0; c < 3; c++)
                sum += weight * (double)texel_value(a, b, c) / 3.0;
        }
    return sum;
}

static void assert_close(double a, double b)
{
    g_assert_cmpfloat(fabs(a - b), <, 2e-4);
}

static void test_bilinear(void)
{
    for (uint64_t i = 0; i < 40; i++) {
        sampler s = sampler_make(1, i);
        vec2 uv = sampler_2d(&s);
        uv.x = 5.0f * uv.x - 2.0f, uv.y = 5.0f * uv.y - 2.0f;
        assert_close((double)number_at(list(colour_path), uv.x, uv.y),
                     naive((double)uv.x, (double)uv.y));
    }
}

/* (0, 0) is the lower left corner: the last row. */
static void test_orientation(void)
{
    float u = 0.5f / WIDTH, v = 0.5f / HEIGHT, corner = 0, top = 0;
    for (int c = 0; c < 3; c++) {
        corner += texel_value(0, HEIGHT - 1, c) / 3.0f;
        top += texel_value(0, 0, c) / 3.0f;
    }
    assert_close((double)number_at(list(colour_path), u, v), (double)corner);
    assert_close((double)number_at(list(colour_path), u, 1.0f - v), (double)top);
}

static void test_parameters_act(void)
{
    double plain = naive(0.3, 0.6);
    assert_close(
        (double)number_at(with_number(list(colour_path), "scale", 0.5f), 0.3f, 0.6f),
        0.5 * plain);
    params *p = list(colour_path);
    params_add_integers(p, here, PARAM_BOOL, "invert", (int[]){1}, 1, NULL);
    assert_close((double)number_at(p, 0.3f, 0.6f), 1.0 - plain);
    p = with_number(with_number(list(colour_path), "uscale", 2.0f), "udelta", 0.1f);
    p = with_number(with_number(p, "vscale", 3.0f), "vdelta", -0.2f);
    assert_close((double)number_at(p, 0.3f, 0.6f), naive(0.7, 1.6));
    p = with_word(list(colour_path), "filter", "point");
    float nearest = 0;
    for (int c = 0; c < 3; c++)
        nearest += texel_value(1, 1, c) / 3.0f;
    assert_close((double)number_at(p, 0.3f, 0.6f), (double)nearest);
}

static void test_wrap(void)
{
    params *p = with_word(list(colour_path), "wrap", "black");
    assert_close((double)number_at(p, 1.5f, 0.5f), 0.0);
    float edge = 0;
    for (int c = 0; c < 3; c++)
        edge += texel_value(WIDTH - 1, 1, c) / 3.0f;
    p = with_word(list(colour_path), "wrap", "black");
    assert_close((double)number_at(p, 1.0f, 0.5f), 0.5 * (double)edge);
    p = with_word(list(colour_path), "wrap", "clamp");
    assert_close((double)number_at(p, 7.0f, 0.5f), (double)edge);
}

/* An alpha channel that cuts out is what a number is read from. */
static void test_alpha(void)
{
    float u = 1.5f / WIDTH, v = 1.0f - 0.5f / HEIGHT;
    float alpha = number_at(list(cutout_path), u, v);
    g_assert_cmpfloat(fabsf(alpha - texel_value(1, 0, 3)), <, 4e-3f); /* 8 bits */
}

static spectrum colours_at(params *p, curve_role role, const wavelengths *w)
{
    GError *error = NULL;
    texture *t = texture_new(NULL, "imagemap", true, p, &error);
    g_assert_no_error(error);
    spectrum_input in = {.texture = t, .role = role};
    surface_hit hit = {.uv = {1.5f / WIDTH, 0.5f}};
    spectrum x = spectrum_input_eval(&in, &hit, w);
    texture_free(t);
    params_free(p);
    return x;
}

/* A texel is the spectrum that the same rgb parameter would be. */
static void test_spectra(void)
{
    wavelengths w = wavelengths_at(0.3f);
    static const curve_role roles[] = {CURVE_ALBEDO, CURVE_UNBOUNDED, CURVE_EMISSION};
    for (int i = 0; i < 3; i++) {
        float scale = roles[i] == CURVE_ALBEDO ? 0.9f : 3.0f, rgb[3];
        for (int c = 0; c < 3; c++)
            rgb[c] = scale * texel_value(1, 1, c);
        g_autoptr(curve) same = curve_rgb(color_space_srgb(), rgb, roles[i], NULL);
        spectrum truth = curve_eval(same, &w);
        spectrum found =
            colours_at(with_number(list(colour_path), "scale", scale), roles[i], &w);
        for (int k = 0; k < N_WAVELENGTHS; k++)
            g_assert_cmpfloat(fabsf(found[k] - truth[k]), <, 2e-3f * scale);
    }
}

/* An 8-bit grey of one half, read in each encoding. */
static void test_encoding(void)
{
    static const char *const names[] = {"R", "G", "B"};
    g_autofree char *path = g_build_filename(folder, "grey.png", NULL);
    g_autoptr(image) img = image_new(2, 2, 3, names, NULL);
    for (int i = 0; i < 12; i++)
        img->pixels[i] = srgb_decode(0.5f);
    g_assert_true(image_write(img, path, NULL, NULL));
    double grey = 128.0 / 255.0;
    float srgb = number_at(list(path), 0.5f, 0.5f);
    g_assert_cmpfloat(fabs((double)srgb - (double)srgb_decode((float)grey)), <, 4e-3);
    float linear = number_at(with_word(list(path), "encoding", "linear"), 0.5f, 0.5f);
    g_assert_cmpfloat(fabs((double)linear - grey), <, 4e-3);
    float gamma = number_at(with_word(list(path), "encoding", "gamma 3"), 0.5f, 0.5f);
    g_assert_cmpfloat(fabs((double)gamma - pow(grey, 3)), <, 4e-3);
}

static void refuse(params *p, const char *kind, const char *part)
{
    g_autoptr(GError) error = NULL;
    g_assert_null(texture_new(NULL, kind, true, p, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    if (!g_str_has_prefix(error->message, "t.pbrt:") || !strstr(error->message, part))
        g_error("expected '%s' in '%s'", part, error->message);
    params_free(p);
}

static void test_refusals(void)
{
    refuse(list(colour_path), "plasma", "found 'plasma'");
    refuse(list(NULL), "imagemap", "\"string filename\"");
    refuse(list("none.png"), "imagemap", "none.png");
    refuse(with_word(list(colour_path), "filter", "cubic"), "imagemap", "found 'cubic'");
    refuse(with_word(list(colour_path), "maxanisotropy", "much"), "imagemap",
           "'maxanisotropy'");
    refuse(with_word(list(colour_path), "wrap", "mirror"), "imagemap", "found 'mirror'");
    refuse(with_word(list(colour_path), "mapping", "cubic"), "imagemap", "found 'cubic'");
    refuse(with_number(with_word(list(colour_path), "mapping", "spherical"), "uscale", 2),
           "imagemap", "unknown parameter 'uscale'");
    refuse(with_word(list(colour_path), "encoding", "gamma x"), "imagemap",
           "found 'gamma x'");
    refuse(with_number(list(colour_path), "turbulence", 1.0f), "imagemap",
           "unknown parameter 'turbulence' of texture 'imagemap'");
}

/* A look-up at a hit, through an input that borrows the texture. */
static float number_of(params *p, const surface_hit *hit)
{
    GError *error = NULL;
    texture *t = texture_new(NULL, "imagemap", false, p, &error);
    g_assert_no_error(error);
    float_input in = {.texture = t};
    float x = float_input_eval(&in, hit);
    texture_free(t);
    params_free(p);
    return x;
}

/* Each mapping's coordinates, at a point given in the texture's space. */
static void test_mappings(void)
{
    transform turn = transform_rotate(40, 1, -2, 0.5),
              move = transform_translate(1, 2, 3);
    transform to_world = transform_multiply(&move, &turn);
    for (uint64_t i = 0; i < 30; i++) {
        sampler s = sampler_make(4, i);
        vec2 a = sampler_2d(&s);
        double x = (double)a.x - 0.5, y = (double)a.y - 0.5, z = (double)sampler_1d(&s);
        double phi = atan2(y, x), theta = acos(z / sqrt(x * x + y * y + z * z));
        surface_hit hit = {
            .p = transform_point(&to_world, vec3_make((float)x, (float)y, (float)z))};
        params *p = with_word(list(colour_path), "mapping", "spherical");
        p->to_world = to_world;
        assert_close((double)number_of(p, &hit),
                     naive(theta / G_PI, (phi < 0 ? phi + 2 * G_PI : phi) / (2 * G_PI)));
        p = with_word(list(colour_path), "mapping", "cylindrical");
        p->to_world = to_world;
        assert_close((double)number_of(p, &hit), naive((G_PI + phi) / (2 * G_PI), z));
        p = with_word(list(colour_path), "mapping", "planar");
        p->to_world = to_world;
        const float v1[3] = {1, 0.5f, 0}, v2[3] = {0, 0, 2};
        params_add_numbers(p, here, PARAM_VECTOR3, "v1", v1, 3, NULL);
        params_add_numbers(p, here, PARAM_VECTOR3, "v2", v2, 3, NULL);
        with_number(with_number(p, "udelta", 0.2f), "vdelta", -0.1f);
        assert_close((double)number_of(p, &hit), naive(x + 0.5 * y + 0.2, 2 * z - 0.1));
    }
}

static void init_mapping(mapping2 *m, const char *name, const transform *to_world)
{
    g_autoptr(params) p = with_word(list(NULL), "mapping", name);
    p->to_world = *to_world;
    const float v1[3] = {1, 0.5f, 0}, v2[3] = {0, 0, 2};
    if (strcmp(name, "planar") == 0) {
        params_add_numbers(p, here, PARAM_VECTOR3, "v1", v1, 3, NULL);
        params_add_numbers(p, here, PARAM_VECTOR3, "v2", v2, 3, NULL);
    }
    g_assert_true(mapping2_init(m, p, NULL));
}

/* The most that a coordinate changes by on the way of a footprint, whichever way: found
   by small steps all around. */
static vec2 widest(const mapping2 *m, const surface_hit *hit)
{
    const float step = 1e-3f;
    vec2 at = mapping2_eval(m, hit).st, most = {0, 0};
    for (uint32_t i = 0; i < 2000; i++) {
        sampler random = sampler_make(9, i);
        surface_hit beside = *hit;
        beside.p += step * warp_sphere(sampler_2d(&random));
        vec2 to = mapping2_eval(m, &beside).st;
        most.x = maxf(most.x, fabsf(to.x - at.x) * hit->footprint / step);
        most.y = maxf(most.y, fabsf(to.y - at.y) * hit->footprint / step);
    }
    return most;
}

/* A look of some width covers as much of the texture as the coordinates change by. */
static void test_mapped_footprints(void)
{
    static const char *const names[] = {"spherical", "cylindrical", "planar"};
    transform turn = transform_rotate(40, 1, -2, 0.5), size = transform_scale(3, 3, 3);
    transform to_world = transform_multiply(&turn, &size);
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        mapping2 m;
        init_mapping(&m, names[i], &to_world);
        surface_hit hit = {.p = transform_point(&to_world, vec3_make(0.5f, 0.4f, 0.3f)),
                           .footprint = 0.02f};
        texture_point2 found = mapping2_eval(&m, &hit);
        vec2 expected = widest(&m, &hit);
        g_test_message("%s: %g %g, expected %g %g", names[i], (double)found.ds,
                       (double)found.dt, (double)expected.x, (double)expected.y);
        g_assert_cmpfloat(fabsf(found.ds / expected.x - 1), <, 0.02f);
        g_assert_cmpfloat(fabsf(found.dt / expected.y - 1), <, 0.02f);
        hit.footprint = 1e4f; /* no coordinate of an angle covers more than all of it */
        found = mapping2_eval(&m, &hit);
        g_assert_cmpfloat(found.ds, <=, i < 2 ? 1.0f : INFINITY);
    }
}

/* Beyond an edge the octahedral sphere goes on at the edge's mirror image. */
static void test_octahedral_wrap(void)
{
    for (int i = 0; i < 10; i++) {
        float a = ((float)i + 0.5f) / 10;
        const vec2 outside[4] = {{-0.1f, a}, {1.1f, a}, {a, -0.1f}, {a, 1.1f}};
        const vec2 inside[4] = {
            {0.1f, 1 - a}, {0.9f, 1 - a}, {1 - a, 0.1f}, {1 - a, 0.9f}};
        for (int k = 0; k < 4; k++) {
            params *p = with_word(list(colour_path), "wrap", "octahedralsphere");
            params *q = with_word(list(colour_path), "wrap", "octahedralsphere");
            assert_close((double)number_at(p, outside[k].x, outside[k].y),
                         (double)number_at(q, inside[k].x, inside[k].y));
        }
    }
}

/* A wide look sees the mean; a narrow one, and one of unknown width, the image itself. */
static void test_trilinear(void)
{
    static const char *const filters[] = {"trilinear", "EWA", "ewa"};
    surface_hit hit = {.dpdu = {1, 0, 0, 0}, .dpdv = {0, 1, 0, 0}, .uv = {0.3f, 0.6f}};
    static const char *const names[] = {"R", "G", "B"};
    g_autofree char *path = g_build_filename(folder, "ramp.pfm", NULL);
    g_autoptr(image) img = image_new(16, 16, 3, names, NULL);
    for (int i = 0; i < 16 * 16 * 3; i++)
        img->pixels[i] = (float)(i / 3 % 2);
    g_assert_true(image_write(img, path, NULL, NULL));
    for (int i = 0; i < 3; i++) {
        const float widths[4] = {0, 1e-4f, 1, 30};
        float found[4];
        for (int k = 0; k < 4; k++) {
            hit.footprint = widths[k];
            found[k] = number_of(with_word(list(path), "filter", filters[i]), &hit);
        }
        assert_close((double)found[0], (double)number_at(list(path), 0.3f, 0.6f));
        assert_close((double)found[1], (double)found[0]);
        assert_close((double)found[2], 0.5);
        assert_close((double)found[3], 0.5);
        hit.footprint = 1.0f / 32; /* half a texel: between the image and the next */
        hit.footprint *= 1.5f;
        float between = number_of(with_word(list(path), "filter", filters[i]), &hit);
        g_assert_cmpfloat(fabsf(between - 0.5f), <, fabsf(found[0] - 0.5f));
        g_assert_cmpfloat(fabsf(between - 0.5f), >, 0.0f);
    }
    g_unlink(path);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder = g_dir_make_tmp("nephroid-texture-XXXXXX", NULL);
    colour_path = g_build_filename(folder, "colour.pfm", NULL);
    cutout_path = g_build_filename(folder, "cutout.png", NULL);
    write_image(colour_path, false);
    write_image(cutout_path, true);
    g_test_add_func("/texture/bilinear", test_bilinear);
    g_test_add_func("/texture/orientation", test_orientation);
    g_test_add_func("/texture/parameters-act", test_parameters_act);
    g_test_add_func("/texture/wrap", test_wrap);
    g_test_add_func("/texture/mappings", test_mappings);
    g_test_add_func("/texture/mapped-footprints", test_mapped_footprints);
    g_test_add_func("/texture/octahedral", test_octahedral_wrap);
    g_test_add_func("/texture/trilinear", test_trilinear);
    g_test_add_func("/texture/alpha", test_alpha);
    g_test_add_func("/texture/spectra", test_spectra);
    g_test_add_func("/texture/encoding", test_encoding);
    g_test_add_func("/texture/refusals", test_refusals);
    int failed = g_test_run();
    g_autofree char *grey = g_build_filename(folder, "grey.png", NULL);
    g_unlink(grey);
    g_unlink(colour_path);
    g_unlink(cutout_path);
    g_rmdir(folder);
    g_free(folder);
    g_free(colour_path);
    g_free(cutout_path);
    return failed;
}
