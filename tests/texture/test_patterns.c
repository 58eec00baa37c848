/*
 * patterns: the textures that are computed, against their formulas written out the slow
 * way; every parameter acts, and wrong ones are refused at their place.
 */
#include "math/noise.h"
#include "math/sampler.h"
#include "math/transform.h"
#include "scene/builder.h"

#include <string.h>

static const source_place here = {"p.pbrt", 8, 4};

static params *list(void)
{
    return params_new(here, "/", color_space_srgb());
}

static params *number(params *p, const char *name, double x)
{
    const float value = (float)x;
    params_add_numbers(p, here, PARAM_FLOAT, name, &value, 1, NULL);
    return p;
}

static params *whole(params *p, const char *name, int x)
{
    params_add_integers(p, here, PARAM_INTEGER, name, &x, 1, NULL);
    return p;
}

static params *named(params *p, const char *name, const char *of)
{
    params_add_strings(p, here, PARAM_TEXTURE, name, &of, 1, NULL);
    return p;
}

static texture *make(const scene_builder *s, const char *kind, bool is_spectrum,
                     params *p)
{
    GError *error = NULL;
    texture *t = texture_new(s ? &s->build : NULL, kind, is_spectrum, p, &error);
    g_assert_no_error(error);
    params_free(p);
    return t;
}

static double value_at(const char *kind, params *p, const surface_hit *hit)
{
    texture *t = make(NULL, kind, false, p);
    double x = (double)texture_eval_float(t, hit);
    texture_free(t);
    return x;
}

static surface_hit hit_number(uint32_t i)
{
    sampler s = sampler_make(12, i);
    vec2 a = sampler_2d(&s), b = sampler_2d(&s), c = sampler_2d(&s);
    vec3 n = normalize3(vec3_make(a.x - 0.5f, a.y - 0.5f, b.x - 0.5f));
    return (surface_hit){.p = 6.0f * vec3_make(b.y - 0.5f, c.x - 0.5f, c.y - 0.5f),
                         .n = n,
                         .n_geom = n,
                         .uv = {8 * a.x - 4, 8 * b.x - 4}};
}

static void close_to(double a, double b)
{
    g_assert_cmpfloat(fabs(a - b), <, 1e-5);
}

static void test_scale_and_mix(void)
{
    surface_hit hit = hit_number(0);
    close_to(value_at("scale", number(number(list(), "tex", 3), "scale", 0.5), &hit),
             1.5);
    close_to(value_at("scale", list(), &hit), 1);
    close_to(value_at("mix", list(), &hit), 0.5);
    params *p = number(number(number(list(), "tex1", 2), "tex2", 6), "amount", 0.25);
    close_to(value_at("mix", p, &hit), 3);
}

/* Textures within textures, of both types. */
static void test_nested(void)
{
    scene_builder *s = scene_builder_new(NULL);
    GError *error = NULL;
    g_autoptr(params) half = number(list(), "value", 0.5);
    builder_add_texture(s, "half", "constant", false, half, &error);
    g_assert_no_error(error);
    const float red[3] = {0.9f, 0.1f, 0.1f};
    g_autoptr(params) colour = list();
    params_add_numbers(colour, here, PARAM_RGB, "value", red, 3, NULL);
    builder_add_texture(s, "red", "constant", true, colour, &error);
    g_assert_no_error(error);
    texture *t =
        make(s, "scale", true, named(named(list(), "tex", "red"), "scale", "half"));
    surface_hit hit = hit_number(1);
    const wavelengths w = wavelengths_at(0.5f);
    g_autoptr(curve) same = curve_rgb(color_space_srgb(), red, CURVE_ALBEDO, NULL);
    spectrum expected = 0.5f * curve_eval(same, &w);
    spectrum found = texture_eval_spectrum(t, &hit, &w, CURVE_ALBEDO);
    for (int i = 0; i < N_WAVELENGTHS; i++)
        close_to((double)found[i], (double)expected[i]);
    texture_free(t);
    t = make(s, "mix", true, named(named(list(), "tex2", "red"), "amount", "half"));
    found = texture_eval_spectrum(t, &hit, &w, CURVE_ALBEDO);
    for (int i = 0; i < N_WAVELENGTHS; i++)
        close_to((double)found[i], (double)expected[i]);
    texture_free(t);
    scene_builder_free(s);
}

static void test_direction_mix(void)
{
    for (uint32_t i = 0; i < 20; i++) {
        surface_hit hit = hit_number(i);
        params *p = number(number(list(), "tex1", 5), "tex2", 1);
        const float dir[3] = {0, 0, 2};
        double cosine = fabs((double)hit.n[1]);
        close_to(value_at("directionmix", list(), &hit), 1 - cosine);
        params_add_numbers(p, here, PARAM_VECTOR3, "dir", dir, 3, NULL);
        p->to_world = transform_rotate(90, 1, 0, 0); /* z to -y */
        close_to(value_at("directionmix", p, &hit), 1 + 4 * cosine);
    }
}

static void test_checkerboard(void)
{
    for (uint32_t i = 0; i < 200; i++) {
        surface_hit hit = hit_number(i);
        long s = (long)floor((double)hit.uv.x), t = (long)floor((double)hit.uv.y);
        params *p = number(number(list(), "tex1", 7), "tex2", 2);
        close_to(value_at("checkerboard", p, &hit), (s + t) % 2 ? 2 : 7);
        close_to(value_at("checkerboard", list(), &hit), (s + t) % 2 ? 0 : 1);
        p = whole(list(), "dimension", 3);
        p->to_world = transform_translate(1, 0, 0);
        long sum = 0;
        for (int k = 0; k < 3; k++)
            sum += (long)floor((double)hit.p[k]) - (k == 0);
        close_to(value_at("checkerboard", p, &hit), sum % 2 ? 0 : 1);
    }
    surface_hit hit = {.uv = {0.3f, 0.6f}};
    close_to(value_at("checkerboard", number(list(), "uscale", 5), &hit), 0);
}

static void test_bilerp(void)
{
    for (uint32_t i = 0; i < 20; i++) {
        surface_hit hit = hit_number(i);
        double u = (double)hit.uv.x, v = (double)hit.uv.y;
        close_to(value_at("bilerp", list(), &hit) / 8, v / 8);
        params *p = number(number(list(), "v00", 1), "v01", 2);
        number(number(p, "v10", 3), "v11", 5);
        close_to(value_at("bilerp", p, &hit) / 16, (1 + v + 2 * u + u * v) / 16);
    }
}

/* Dots are discs of radius 0.35 in some cells, and nothing crosses a cell's border; as
   pbrt names them, they show "outside", 0, and "inside", 1, is around them. */
static void test_dots(void)
{
    enum { N = 40000 };
    double around = 0, cells = 0;
    for (uint32_t i = 0; i < N; i++) {
        sampler s = sampler_make(2, i);
        vec2 u = sampler_2d(&s);
        surface_hit hit = {.uv = {40 * u.x, 40 * u.y}};
        around += value_at("dots", list(), &hit) / N;
        hit.uv.x = floorf(hit.uv.x) + 0.5f;
        close_to(value_at("dots", number(list(), "inside", 3), &hit), 3);
    }
    for (int i = 0; i < 1600; i++) {
        vec3 p = vec3_make((float)(i % 40) + 0.5f, (float)(i / 40) + 0.5f, 0.5f);
        cells += noise3(p) > 0 ? 1.0 / 1600 : 0;
    }
    g_assert_cmpfloat(fabs(1 - around - cells * G_PI * 0.35 * 0.35), <, 0.01);
}

/* Zero at whole points, smooth between, no larger than noise can be. */
static void test_noise(void)
{
    double sum = 0, sum2 = 0;
    for (uint32_t i = 0; i < 5000; i++) {
        surface_hit hit = hit_number(i);
        vec3 p = 10 * hit.p, nearby = p + vec3_make(1e-3f, -1e-3f, 1e-3f);
        double x = (double)noise3(p);
        g_assert_cmpfloat(fabs(x), <, 1.1);
        g_assert_cmpfloat(fabs(x - (double)noise3(nearby)), <, 0.02);
        sum += x / 5000;
        sum2 += x * x / 5000;
        for (int k = 0; k < 3; k++)
            p[k] = floorf(p[k]);
        close_to((double)noise3(p), 0);
    }
    g_assert_cmpfloat(fabs(sum), <, 0.03);
    g_assert_cmpfloat(sum2, >, 0.03);
    g_assert_cmpfloat(sum2, <, 0.15);
    /* a value by hand: cell (0,0,0), where each corner's gradient is known */
    double half = (double)noise3(vec3_make(0.5f, 0, 0));
    g_assert_cmpfloat(fabs(half), <=, 0.5 + 1e-6);
}

static double fbm(const float p[3], double omega, int octaves, bool creased)
{
    double sum = 0, weight = 1, scale = 1;
    for (int i = 0; i < octaves; i++) {
        double x = (double)noise3(
            vec3_make((float)scale * p[0], (float)scale * p[1], (float)scale * p[2]));
        sum += weight * (creased ? fabs(x) : x);
        weight *= omega;
        scale *= 1.99;
    }
    return creased ? sum + 0.2 * weight : sum;
}

static void test_clouds(void)
{
    for (uint32_t i = 0; i < 20; i++) {
        surface_hit hit = hit_number(i);
        const float p[3] = {hit.p[0], hit.p[1], hit.p[2]};
        params *q = number(whole(list(), "octaves", 3), "roughness", 0.7);
        g_assert_cmpfloat(fabs(value_at("fbm", q, &hit) - fbm(p, 0.7, 3, false)), <,
                          1e-4);
        g_assert_cmpfloat(fabs(value_at("fbm", list(), &hit) - fbm(p, 0.5, 8, false)), <,
                          3e-3);
        q = number(whole(list(), "octaves", 3), "roughness", 0.7);
        g_assert_cmpfloat(fabs(value_at("wrinkled", q, &hit) - fbm(p, 0.7, 3, true)), <,
                          1e-4);
        const float far[3] = {0.1f * p[0], 0.1f * p[1], 0.1f * p[2]};
        double wave = fabs(fbm(far, 0.5, 3, false)) * fbm(p, 0.5, 6, false);
        g_assert_cmpfloat(fabs(value_at("windy", list(), &hit) - wave), <, 1e-3);
        q = list();
        q->to_world = transform_translate((double)p[0], (double)p[1], (double)p[2]);
        close_to(value_at("fbm", q, &hit), 0); /* at the texture's origin */
    }
}

static float marble_at(params *p, const surface_hit *hit)
{
    const wavelengths w = wavelengths_at(0.5f);
    texture *t = make(NULL, "marble", true, p);
    spectrum x = texture_eval_spectrum(t, hit, &w, CURVE_ALBEDO);
    texture_free(t);
    g_assert_cmpfloat(spectrum_max(x), <=, 1);
    return spectrum_mean(x);
}

/* Veins are where sin of y is, bent by noise; pale stone is 0.87 grey, veins are dark. */
static void test_marble(void)
{
    float least = 1, most = 0, changed = 0;
    for (uint32_t i = 0; i < 400; i++) {
        surface_hit hit = hit_number(i);
        float plain = marble_at(list(), &hit);
        least = fminf(least, plain);
        most = fmaxf(most, plain);
        changed += fabsf(plain - marble_at(number(list(), "variation", 2), &hit));
        changed += fabsf(plain - marble_at(number(list(), "scale", 3), &hit));
        changed += fabsf(marble_at(whole(list(), "octaves", 1), &hit) -
                         marble_at(number(list(), "roughness", 0.9), &hit));
    }
    g_assert_cmpfloat(most, >, 0.85f);
    g_assert_cmpfloat(least, <, 0.6f);
    g_assert_cmpfloat(changed, >, 5);
}

static void refuse(const char *kind, bool is_spectrum, params *p, const char *part)
{
    g_autoptr(GError) error = NULL;
    g_assert_null(texture_new(NULL, kind, is_spectrum, p, &error));
    g_assert_nonnull(strstr(error->message, part));
    g_assert_true(g_str_has_prefix(error->message, "p.pbrt:8:4: "));
    params_free(p);
}

static void test_refusals(void)
{
    refuse("checkerboard", false, whole(list(), "dimension", 4), "expected 2 or 3");
    refuse("fbm", true, list(), "is of type float");
    refuse("marble", false, list(), "is of type spectrum");
    refuse("fbm", false, whole(list(), "octaves", 0), "octaves");
    refuse("mix", false, named(list(), "tex1", "none"), "'none'");
    refuse("windy", false, number(list(), "octaves", 3), "unknown parameter 'octaves'");
    refuse("ptex", false, list(), "found 'ptex'");
    for (size_t i = 0; texture_kind_at(i); i++) {
        const texture_kind *kind = texture_kind_at(i);
        refuse(kind->name, !kind->eval_float, number(list(), "colour", 1),
               "unknown parameter 'colour'");
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/patterns/scale-mix", test_scale_and_mix);
    g_test_add_func("/patterns/nested", test_nested);
    g_test_add_func("/patterns/directionmix", test_direction_mix);
    g_test_add_func("/patterns/checkerboard", test_checkerboard);
    g_test_add_func("/patterns/bilerp", test_bilerp);
    g_test_add_func("/patterns/dots", test_dots);
    g_test_add_func("/patterns/noise", test_noise);
    g_test_add_func("/patterns/clouds", test_clouds);
    g_test_add_func("/patterns/marble", test_marble);
    g_test_add_func("/patterns/refusals", test_refusals);
    return g_test_run();
}
