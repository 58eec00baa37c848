/*
 * image lights: pictures of the sky say the same in both layouts, are drawn with the
 * density that is claimed, and emit the power that their integral gives.
 *
 * Statistical tests: six standard errors, χ² with p > 1e-6.
 */
#include "chi2.h"
#include "light/light_kinds.h"
#include "math/warp.h"
#include "texture/sphere_map.h"

#include <glib/gstdio.h>

static const source_place here = {"l.pbrt", 3, 1};
static char *folder, *square_path, *wide_path, *odd_path, *black_path;

/* A sky with a soft sun, brighter above, redder in the west. */
static void sky_colour(vec3 d, float rgb[3])
{
    float sun = expf(-20.0f * (1.0f - dot3(d, normalize3(vec3_make(1, 2, 2)))));
    rgb[0] = 0.4f + 0.2f * d[2] + 8.0f * sun + maxf(0.0f, -0.2f * d[0]);
    rgb[1] = 0.5f + 0.3f * d[2] + 6.0f * sun;
    rgb[2] = 0.6f + 0.4f * d[2] + 4.0f * sun;
}

static vec3 latlong(double s, double t)
{
    double theta = G_PI * t, phi = 2 * G_PI * s;
    return vec3_make((float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)),
                     (float)cos(theta));
}

static char *path_of(const char *name)
{
    return g_build_filename(folder, name, NULL);
}

typedef void (*painter)(int x, int y, int width, int height, float rgb[3]);

static char *paint(const char *name, int width, int height, painter paint_texel)
{
    static const char *const names[] = {"R", "G", "B"};
    g_autoptr(image) img = image_new(width, height, 3, names, NULL);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            paint_texel(x, y, width, height, img->pixels + 3 * (y * width + x));
    char *path = path_of(name);
    g_assert_true(image_write(img, path, NULL, NULL));
    return path;
}

static void paint_wide(int x, int y, int width, int height, float rgb[3])
{
    sky_colour(latlong((x + 0.5) / width, (y + 0.5) / height), rgb);
}

static void paint_black(int x, int y, int width, int height, float rgb[3])
{
    (void)x, (void)y, (void)width, (void)height;
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
}

/* The equal-area square by its definition, in double precision: rings of equal |x|+|y|
 * hold equal solid angle. */
static vec3 square_direction(double s, double t)
{
    double x = 2 * s - 1, y = 2 * t - 1, sum = fabs(x) + fabs(y);
    double r = sum <= 1 ? sum : 2 - sum, z = sum <= 1 ? 1 - r * r : r * r - 1;
    double share = r > 0 ? (sum <= 1 ? fabs(y) / r : (1 - fabs(x)) / r) : 0;
    double phi = 0.5 * G_PI * share, across = sqrt(fmax(0, 1 - z * z));
    return vec3_make((float)copysign(across * cos(phi), x),
                     (float)copysign(across * sin(phi), y), (float)z);
}

static void paint_square(int x, int y, int width, int height, float rgb[3])
{
    sky_colour(square_direction((x + 0.5) / width, (y + 0.5) / height), rgb);
}

static params *sky_params(const char *path)
{
    params *p = params_new(here, "/", color_space_srgb());
    params_add_strings(p, here, PARAM_STRING, "filename", &path, 1, NULL);
    return p;
}

static light *make_sky(params *p, const transform *to_world)
{
    GError *error = NULL;
    transform identity = transform_identity();
    light *l =
        light_new(NULL, "infinite", p, to_world ? to_world : &identity, NULL, &error);
    g_assert_no_error(error);
    l->kind->prepare(l->self, vec3_make(0.1f, 0.2f, -0.3f), 2.0f);
    params_free(p);
    return l;
}

static light *turned_sky(const char *path)
{
    transform turn = transform_rotate(50, 1, 2, 0.5), mirror = transform_scale(2, 2, -2);
    transform both = transform_multiply(&turn, &mirror);
    return make_sky(sky_params(path), &both);
}

/* ---- What is seen ---- */

static double seen(const light *l, vec3 d)
{
    const wavelengths w = wavelengths_at(0.5f);
    return (double)spectrum_mean(l->kind->environment(l->self, (vec3){0}, d, &w));
}

static vec3 direction_number(uint32_t i)
{
    sampler s = sampler_make(5, i);
    return warp_sphere(sampler_2d(&s));
}

/* Both layouts show the same sky, in every direction, poles and seams included. */
static void test_layouts_agree(void)
{
    light *square = make_sky(sky_params(square_path), NULL);
    light *wide = make_sky(sky_params(wide_path), NULL);
    const wavelengths w = wavelengths_at(0.5f);
    g_autoptr(params) p = params_new(here, "/", color_space_srgb());
    emitter white;
    g_assert_true(emitter_init(&white, p, NULL, NULL, NULL));
    for (uint32_t i = 0; i < 2000; i++) {
        vec3 d = direction_number(i);
        if (i < 200) /* near the poles and the seam */
            d = normalize3(vec3_make(0.05f * d[0], 0.05f * d[1], i % 2 ? 1 : -1));
        else if (i < 400)
            d = normalize3(vec3_make(1, 0.05f * d[1], d[2]));
        float rgb[3];
        sky_colour(d, rgb);
        double expected =
            (double)(white.scale * spectrum_mean(rgb_eval(color_space_srgb(), rgb,
                                                          CURVE_EMISSION, &w)));
        g_assert_cmpfloat(fabs(seen(square, d) / expected - 1), <, 0.08);
        g_assert_cmpfloat(fabs(seen(wide, d) / expected - 1), <, 0.08);
    }
    emitter_clear(&white);
    light_free(square);
    light_free(wide);
}

/* The picture turns with the light: what is seen along M d is what the picture has at d.
 */
static void test_turned(void)
{
    transform turn = transform_rotate(50, 1, 2, 0.5), mirror = transform_scale(2, 2, -2);
    transform both = transform_multiply(&turn, &mirror);
    light *plain = make_sky(sky_params(wide_path), NULL);
    light *turned = turned_sky(wide_path);
    for (uint32_t i = 0; i < 100; i++) {
        vec3 d = direction_number(i), moved = normalize3(transform_vector(&both, d));
        g_assert_cmpfloat(fabs(seen(turned, moved) / seen(plain, d) - 1), <, 1e-3);
    }
    light_free(plain);
    light_free(turned);
}

/* ---- Densities and power ---- */

static bool draw_sample(void *data, float u_lobe, vec2 u, vec3 *out)
{
    const light *l = data;
    const wavelengths w = wavelengths_at(0.5f);
    light_sample to;
    if (!l->kind->sample(l->self, &w, vec3_make(0, 0, 0), u_lobe, u, &to))
        return false;
    float pdf = l->kind->pdf(l->self, vec3_make(0, 0, 0), to.wi, NULL);
    g_assert_cmpfloat(fabsf(pdf / to.pdf - 1), <, 2e-2);
    *out = to.wi;
    return true;
}

static float density(void *data, vec3 d)
{
    const light *l = data;
    return l->kind->pdf(l->self, vec3_make(0, 0, 0), d, NULL);
}

static void test_drawn(void)
{
    const char *const paths[] = {square_path, wide_path};
    for (int i = 0; i < 2; i++) {
        light *l = turned_sky(paths[i]);
        g_assert_cmpfloat(chi2_directions(draw_sample, density, l, 40000, 11), >, 1e-6);
        light_free(l);
    }
}

/* Photons: mean flux is the power, which is π R² times the sky's integral; each has the
 * flux that its densities give. */
static void test_power(void)
{
    const wavelengths w = wavelengths_at(0.3f);
    const char *const paths[] = {square_path, wide_path};
    for (int i = 0; i < 2; i++) {
        light *l = turned_sky(paths[i]);
        double power = (double)spectrum_mean(l->kind->power(l->self, &w));
        double sum = 0, sum2 = 0, integral = 0;
        enum { N = 20000 };
        for (uint32_t n = 0; n < N; n++) {
            sampler s = sampler_make(3, n);
            vec2 u = sampler_2d(&s), v = sampler_2d(&s);
            light_emission e;
            g_assert_true(l->kind->emit(l->self, &w, 0, u, v, &e));
            double flux = (double)spectrum_mean(e.flux);
            sum += flux;
            sum2 += flux * flux;
            float position, direction;
            l->kind->emit_pdf(l->self, e.ray.origin, e.n, e.ray.direction, &position,
                              &direction);
            double le = (double)spectrum_mean(
                l->kind->environment(l->self, (vec3){0}, -e.ray.direction, &w));
            g_assert_cmpfloat(fabs(flux * (double)(position * direction) / le - 1), <,
                              2e-2);
            vec3 d = direction_number(n);
            integral +=
                (double)spectrum_mean(l->kind->environment(l->self, (vec3){0}, d, &w)) *
                4 * G_PI / N;
        }
        double mean = sum / N, error = sqrt((sum2 / N - mean * mean) / N);
        g_assert_cmpfloat(error, <, 0.01 * mean); /* drawn in proportion */
        g_assert_cmpfloat(fabs(mean - power), <, 6 * error + 2e-3 * power);
        g_assert_cmpfloat(fabs(integral * G_PI * 4 / power - 1), <, 0.02);
        light_free(l);
    }
}

static double illuminance(const light *l)
{
    double y = 0;
    for (int offset = 0; offset < 16; offset++) {
        const wavelengths w = wavelengths_at(((float)offset + 0.5f) / 16);
        enum { N = 2000 };
        for (uint32_t i = 0; i < N; i++) {
            vec3 d = direction_number(i);
            float xyz[3];
            spectrum_to_xyz(&w, l->kind->environment(l->self, (vec3){0}, d, &w), xyz);
            y += (double)(xyz[1] * fmaxf(d[2], 0)) * 4 * G_PI / N / 16;
        }
    }
    return y;
}

static void test_scale_and_illuminance(void)
{
    params *p = sky_params(square_path), *q = sky_params(wide_path);
    const float three = 3, half = 0.5f;
    params_add_numbers(p, here, PARAM_FLOAT, "illuminance", &three, 1, NULL);
    params_add_numbers(q, here, PARAM_FLOAT, "scale", &half, 1, NULL);
    light *plain = make_sky(sky_params(wide_path), NULL);
    light *lit = make_sky(p, NULL), *dim = make_sky(q, NULL);
    g_assert_cmpfloat(fabs(illuminance(lit) / 3 - 1), <, 0.02);
    vec3 d = direction_number(9);
    g_assert_cmpfloat(fabs(seen(dim, d) / seen(plain, d) - 0.5), <, 1e-4);
    light_free(plain);
    light_free(lit);
    light_free(dim);
}

/* ---- Through a portal ---- */

static params *portal_params(void)
{
    static const float corners[12] = {-0.5f, 1, 0, 0.5f, 1, 0, 0.5f, 1, 1, -0.5f, 1, 1};
    params *p = sky_params(wide_path);
    params_add_numbers(p, here, PARAM_POINT3, "portal", corners, 12, NULL);
    return p;
}

/* The sky is seen through the rectangle and nowhere else; light samples have the density
 * of what they claim, and give what the environment has. */
static void test_portal_is_seen(void)
{
    light *l = make_sky(portal_params(), NULL),
          *open = make_sky(sky_params(wide_path), NULL);
    const wavelengths w = wavelengths_at(0.5f);
    const vec3 ref = vec3_make(0.2f, -1, 0.1f);
    double by_sampling = 0, by_looking = 0;
    enum { N = 40000 };
    for (uint32_t i = 0; i < N; i++) {
        sampler s = sampler_make(8, i);
        vec2 u = sampler_2d(&s);
        vec3 d = warp_sphere(sampler_2d(&s));
        float t = (1 - ref[1]) / d[1];
        vec3 at = ref + t * d;
        bool passes = t > 0 && fabsf(at[0]) < 0.5f && at[2] > 0 && at[2] < 1;
        spectrum here_seen = l->kind->environment(l->self, ref, d, &w);
        g_assert_true(spectrum_is_black(here_seen) == !passes);
        float pdf = l->kind->pdf(l->self, ref, d, NULL);
        g_assert_true((pdf > 0) == passes);
        if (passes)
            g_assert_cmpfloat(fabs((double)spectrum_mean(here_seen) / seen(open, d) - 1),
                              <, 1e-4);
        by_looking += (double)spectrum_mean(here_seen) * 4 * G_PI / N;
        light_sample to;
        g_assert_true(l->kind->sample(l->self, &w, ref, 0, u, &to));
        pdf = l->kind->pdf(l->self, ref, to.wi, NULL);
        if (pdf > 0) /* but for rounding at the edge */
            g_assert_cmpfloat(fabsf(pdf / to.pdf - 1), <, 1e-3f);
        by_sampling += (double)(spectrum_mean(to.radiance) / to.pdf) / N;
    }
    g_assert_cmpfloat(fabs(by_sampling / by_looking - 1), <, 0.05);
    light_free(l);
    light_free(open);
}

/* Photons pass it, with the power A ∫ L cosθ dω. */
static void test_portal_power(void)
{
    light *l = make_sky(portal_params(), NULL);
    const wavelengths w = wavelengths_at(0.5f);
    double power = (double)spectrum_mean(l->kind->power(l->self, &w)), sum = 0, sum2 = 0;
    double integral = 0;
    enum { N = 40000 };
    for (uint32_t i = 0; i < N; i++) {
        sampler s = sampler_make(9, i);
        vec2 u = sampler_2d(&s), v = sampler_2d(&s);
        light_emission e;
        vec3 d = warp_sphere(sampler_2d(&s)), middle = vec3_make(0, 0.999f, 0.5f);
        integral += (double)(spectrum_mean(l->kind->environment(l->self, middle, d, &w)) *
                             fmaxf(0, d[1])) *
                    4 * G_PI / N;
        if (!l->kind->emit(l->self, &w, 0, u, v, &e))
            continue;
        double flux = (double)spectrum_mean(e.flux);
        float t = (1 - e.ray.origin[1]) / e.ray.direction[1];
        vec3 at = e.ray.origin + t * e.ray.direction;
        g_assert_true(e.ray.direction[1] < 0 && fabsf(at[0]) < 0.5001f);
        g_assert_true(at[2] > -1e-4f && at[2] < 1.0001f);
        float position, direction;
        l->kind->emit_pdf(l->self, e.ray.origin, e.n, e.ray.direction, &position,
                          &direction);
        ray away = e.ray;
        float begins;
        g_assert_true(l->kind->admits(l->self, &away, &begins) == (position > 0));
        if (position > 0)
            g_assert_cmpfloat(fabsf(begins - t), <, 1e-3f * t);
        away.origin[0] += 3;
        g_assert_false(l->kind->admits(l->self, &away, &begins));
        if (position > 0)
            g_assert_cmpfloat(fabsf(position / e.pdf_position - 1), <, 1e-3f);
        sum += flux;
        sum2 += flux * flux;
    }
    double mean = sum / N, error = sqrt((sum2 / N - mean * mean) / N);
    g_assert_cmpfloat(fabs(mean - power), <, 6 * error + 3e-3 * power);
    g_assert_cmpfloat(fabs(integral / power - 1), <, 0.05);
    light_free(l);
}

/* ---- Refusals ---- */

static void refuse(params *p, const transform *to_world, const char *part)
{
    GError *error = NULL;
    transform identity = transform_identity();
    g_assert_null(
        light_new(NULL, "infinite", p, to_world ? to_world : &identity, NULL, &error));
    g_assert_nonnull(strstr(error->message, part));
    g_assert_true(g_str_has_prefix(error->message, "l.pbrt:3:1: "));
    g_error_free(error);
    params_free(p);
}

/* ---- What photographs of skies come with ---- */

static void paint_faulty(int x, int y, int width, int height, float rgb[3])
{
    paint_wide(x, y, width, height, rgb);
    if (y == 20 && x == 30)
        rgb[1] = -3.0f;
    if (y == 20 && x == 60)
        rgb[2] = NAN;
    if (y == 24 && x == 10)
        rgb[0] = INFINITY;
}

static void paint_mended(int x, int y, int width, int height, float rgb[3])
{
    paint_faulty(x, y, width, height, rgb);
    for (int c = 0; c < 3; c++)
        rgb[c] = isinf(rgb[c]) ? 65504.0f : rgb[c] > 0.0f ? rgb[c] : 0.0f;
}

static void note(log_level level, const char *text, void *data)
{
    g_assert_cmpint(level, ==, LOG_WARNING);
    g_string_append(data, text);
}

static void test_faulty_texels(void)
{
    char *faulty_path = paint("faulty.exr", 96, 48, paint_faulty);
    char *mended_path = paint("mended.exr", 96, 48, paint_mended);
    g_autoptr(GString) said = g_string_new(NULL);
    const log_sink log = {note, said};
    params *p = sky_params(faulty_path);
    p->log = &log;
    light *faulty = make_sky(p, NULL);
    light *mended = make_sky(sky_params(mended_path), NULL);
    g_assert_nonnull(strstr(said->str, "3 texels are below zero or not finite"));
    for (uint32_t i = 0; i < 2000; i++) {
        double a = seen(faulty, direction_number(i));
        double b = seen(mended, direction_number(i));
        g_assert_cmpfloat(fabs(a - b), <=, 1e-6 * fabs(b));
    }
    light_free(faulty);
    light_free(mended);
    g_unlink(faulty_path);
    g_unlink(mended_path);
    g_free(faulty_path);
    g_free(mended_path);
}

static void test_refusals(void)
{
    transform stretched = transform_scale(1, 2, 1);
    refuse(sky_params(odd_path), NULL, "found 7 x 5");
    refuse(sky_params(black_path), NULL, "is black");
    params *skew = sky_params(wide_path);
    static const float corners[12] = {0, 0, 0, 1, 0, 0, 2, 1, 0, 1, 1, 0};
    params_add_numbers(skew, here, PARAM_POINT3, "portal", corners, 12, NULL);
    refuse(skew, NULL, "'portal'");
    refuse(sky_params("/nowhere.exr"), NULL, "/nowhere.exr");
    refuse(sky_params(wide_path), &stretched, "stretched");
    params *p = sky_params(wide_path);
    const float white[3] = {1, 1, 1};
    params_add_numbers(p, here, PARAM_RGB, "L", white, 3, NULL);
    refuse(p, NULL, "either 'L' or 'filename'");
}

static void clean_up(void)
{
    char *const paths[] = {square_path, wide_path, odd_path, black_path};
    for (size_t i = 0; i < G_N_ELEMENTS(paths); i++) {
        g_unlink(paths[i]);
        g_free(paths[i]);
    }
    g_rmdir(folder);
    g_free(folder);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder = g_dir_make_tmp("nephroid-XXXXXX", NULL);
    square_path = paint("square.exr", 64, 64, paint_square);
    wide_path = paint("wide.exr", 96, 48, paint_wide);
    odd_path = paint("odd.exr", 7, 5, paint_wide);
    black_path = paint("black.exr", 8, 8, paint_black);
    g_test_add_func("/image-light/layouts", test_layouts_agree);
    g_test_add_func("/image-light/turned", test_turned);
    g_test_add_func("/image-light/drawn", test_drawn);
    g_test_add_func("/image-light/power", test_power);
    g_test_add_func("/image-light/scale", test_scale_and_illuminance);
    g_test_add_func("/image-light/portal/seen", test_portal_is_seen);
    g_test_add_func("/image-light/portal/power", test_portal_power);
    g_test_add_func("/image-light/faulty-texels", test_faulty_texels);
    g_test_add_func("/image-light/refusals", test_refusals);
    int status = g_test_run();
    clean_up();
    return status;
}
