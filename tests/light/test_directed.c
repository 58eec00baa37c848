/*
 * directed: points whose light depends on the direction - IES profiles, goniometric
 * pictures, projected ones. Lumens are kept, directions drawn as claimed, flux sums to
 * the power, and pictures stand upright.
 *
 * Statistical tests: six standard errors, χ² with p > 1e-6.
 */
#include "chi2.h"
#include "image/image.h"
#include "light/ies.h"
#include "light/light_kinds.h"
#include "math/warp.h"

#include <glib/gstdio.h>

static const source_place here = {"d.pbrt", 6, 2};
static char *folder, *map_path, *slide_path, *ies_path;

static params *list(const char *path)
{
    params *p = params_new(here, "/", color_space_srgb());
    if (path)
        params_add_strings(p, here, PARAM_STRING, "filename", &path, 1, NULL);
    return p;
}

static params *number(params *p, const char *name, double x)
{
    const float value = (float)x;
    params_add_numbers(p, here, PARAM_FLOAT, name, &value, 1, NULL);
    return p;
}

static light *make(const char *kind, params *p, const transform *to_world)
{
    GError *error = NULL;
    transform identity = transform_identity();
    light *l = light_new(NULL, kind, p, to_world ? to_world : &identity, NULL, &error);
    g_assert_no_error(error);
    params_free(p);
    return l;
}

/* Y of what a sphere of radius 1 around the light gets in a direction: its intensity. */
static double intensity(const light *l, vec3 d, const wavelengths *w)
{
    light_sample to;
    float xyz[3];
    if (!l->kind->sample(l->self, w, d, 0, (vec2){0, 0}, &to))
        return 0;
    spectrum_to_xyz(w, to.radiance, xyz);
    return (double)xyz[1];
}

enum { N_OFFSETS = 16 };

/* The power's Y: ∫ ȳ Φ dλ. */
static double luminous_power(const light *l)
{
    double y = 0;
    for (int i = 0; i < N_OFFSETS; i++) {
        const wavelengths w = wavelengths_at(((float)i + 0.5f) / N_OFFSETS);
        float xyz[3];
        spectrum_to_xyz(&w, l->kind->power(l->self, &w), xyz);
        y += (double)xyz[1] / N_OFFSETS;
    }
    return y;
}

/* ---- IES ---- */

static void test_published_lumens(void)
{
    static const struct {
        const char *name;
        double lumens, watts;
    } files[] = {{"5.IES", 754, 9.39}, {"7.IES", 532, 8.64}};
    for (size_t i = 0; i < G_N_ELEMENTS(files); i++) {
        g_autofree char *path = g_build_filename(SOURCE_ROOT, "..", "shared", "data",
                                                 "ies", files[i].name, NULL);
        if (!g_file_test(path, G_FILE_TEST_EXISTS)) {
            g_test_skip("../shared/data/ies is not here");
            return;
        }
        light *l = make("goniometric", list(path), NULL);
        double lumens = 683 * luminous_power(l);
        g_test_message("%s: %g lm, published %g", files[i].name, lumens, files[i].lumens);
        g_assert_cmpfloat(fabs(lumens / files[i].lumens - 1), <, 0.01);
        light_free(l);
    }
}

/* Candela of a file are what the light sends: C = 0 along x, 90 along z, down is -y. */
static void test_profile_is_kept(void)
{
    g_autofree char *text = NULL;
    g_assert_true(g_file_get_contents(ies_path, &text, NULL, NULL));
    ies_profile ies;
    g_assert_true(ies_read(&ies, text, NULL));
    double lumens = ies_lumens(&ies), sum = 0;
    enum { N = 400 };
    for (int i = 0; i < N * N; i++) { /* the same by midpoints */
        double gamma = 180.0 * (i / N + 0.5) / N, c = 360.0 * (i % N + 0.5) / N;
        sum += (double)ies_candela(&ies, (float)gamma, (float)c) *
               sin(gamma * G_PI / 180) * 2 * G_PI * G_PI / (N * N);
    }
    g_assert_cmpfloat(fabs(sum / lumens - 1), <, 1e-3);
    light *l = make("goniometric", list(ies_path), NULL);
    g_assert_cmpfloat(fabs(683 * luminous_power(l) / lumens - 1), <, 1e-3);
    const float angles[4][2] = {{30, 0}, {50, 90}, {70, 45}, {20, 260}};
    for (int i = 0; i < 4; i++) {
        double g = (double)angles[i][0] * G_PI / 180,
               c = (double)angles[i][1] * G_PI / 180;
        vec3 d =
            vec3_make((float)(sin(g) * cos(c)), (float)-cos(g), (float)(sin(g) * sin(c)));
        double y = 0;
        for (int k = 0; k < N_OFFSETS; k++) {
            const wavelengths w = wavelengths_at(((float)k + 0.5f) / N_OFFSETS);
            y += intensity(l, d, &w) / N_OFFSETS;
        }
        double expected = (double)ies_candela(&ies, angles[i][0], angles[i][1]) / 683;
        g_assert_cmpfloat(fabs(y / expected - 1), <, 0.01);
    }
    light_free(l);
    ies_clear(&ies);
}

/* Symmetries: what the file leaves out is mirrored. */
static void test_symmetry(void)
{
    static const char *const horizontal[] = {"0 45 90", "0 90 180", "90 180 270",
                                             "0 180 360"};
    static const float same[4][2] = {{30, 150}, {70, 290}, {120, 60}, {10, 10}};
    for (int i = 0; i < 4; i++) {
        g_autofree char *text = g_strdup_printf(
            "IESNA91\nTILT=NONE\n1 100 1 2 3 1 2 0 0 0\n1 1 10\n0 90\n%s\n"
            "100 10\n200 20\n50 5\n",
            horizontal[i]);
        ies_profile ies;
        g_assert_true(ies_read(&ies, text, NULL));
        g_assert_cmpfloat(
            fabsf(ies_candela(&ies, 40, same[i][0]) - ies_candela(&ies, 40, same[i][1])),
            <, 1e-3f);
        g_assert_cmpfloat(fabsf(ies_candela(&ies, 0, same[i][0] + 360) -
                                ies_candela(&ies, 0, same[i][0])),
                          <, 1e-3f);
        g_assert_cmpfloat(ies_candela(&ies, 95, 0), <=, 0);
        ies_clear(&ies);
    }
}

/* Types B (2) and A (3): where their axes are, as LM-63 defines them, and the lumens in
   closed form of one candela over half of all directions, and of what grows with an
   angle. */
static void test_other_types(void)
{
    static const struct {
        int type;
        const char *vertical, *horizontal, *values;
        double lumens;
        struct {
            float gamma, c, candela;
        } at[4];
    } cases[] = {
        /* One candela: a hemisphere below, or ahead. */
        {2,
         "-90 90",
         "-90 90",
         "1 1 1 1",
         2 * G_PI,
         {{0, 0, 1}, {80, 123, 1}, {100, 5, 0}, {180, 0, 0}}},
        {3,
         "-90 90",
         "-90 90",
         "1 1 1 1",
         2 * G_PI,
         {{90, 0, 1}, {170, 60, 1}, {90, 120, 0}, {90, 240, 0}}},
        /* Floodlight: from 0 at the horizon behind to 18 ahead; ∫ (9 + v / 10°) dv = 9π,
           times ∫ cos h dh = 2. */
        {2,
         "-90 90",
         "0 90",
         "0 18 0 18",
         18 * G_PI,
         {{0, 0, 9}, {60, 0, 15}, {60, 180, 3}, {90, 0, 18}}},
        /* ... from 0 on C = 90 to 18 on C = 270: clockwise. */
        {2,
         "-90 90",
         "-90 90",
         "0 0 18 18",
         18 * G_PI,
         {{0, 0, 9}, {60, 90, 3}, {60, 270, 15}, {30, 0, 9}}},
        /* Headlight: from 0 straight down to 18 up; ∫ cos v = 2, times π. */
        {3,
         "-90 90",
         "0 90",
         "0 18 0 18",
         18 * G_PI,
         {{90, 0, 9}, {60, 0, 6}, {120, 30, 12}, {180, 0, 18}}},
        /* ... from 0 on the left, C = 90, to 18 on the right. */
        {3,
         "-90 90",
         "-90 90",
         "0 0 18 18",
         18 * G_PI,
         {{90, 0, 9}, {90, 60, 3}, {60, 300, 15}, {90, 90, 0}}},
        /* The middle alone, falling off to its sides: 2 ∫∫ (1 - h / 30°) dh cos v dv. */
        {3,
         "-30 30",
         "0 30",
         "1 1 0 0",
         G_PI / 6,
         {{90, 0, 1}, {90, 15, 0.5f}, {90, 345, 0.5f}, {90, 31, 0}}},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autofree char *text = g_strdup_printf(
            "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 2 %d 1 0 0 0\n1 1 10\n%s\n%s\n%s\n",
            cases[i].type, cases[i].vertical, cases[i].horizontal, cases[i].values);
        ies_profile ies;
        g_autoptr(GError) error = NULL;
        ies_read(&ies, text, &error);
        g_assert_no_error(error);
        g_assert_cmpfloat(fabs(ies_lumens(&ies) / cases[i].lumens - 1), <, 1e-5);
        for (int k = 0; k < 4; k++) {
            float found = ies_candela(&ies, cases[i].at[k].gamma, cases[i].at[k].c);
            if (fabsf(found - cases[i].at[k].candela) > 1e-3f)
                g_error("case %zu, place %d: %g cd", i, k, (double)found);
        }
        ies_clear(&ies);
    }
}

/* LM-63-1986 has no first line; multipliers and tilt factors count. */
static void test_factors(void)
{
    static const char text[] = "Some luminaire\nTILT=INCLUDE\n1\n3\n0 45 90\n0.5 0.7 1\n"
                               "1 100 3 2 1 1 1 0 0 0\n2 1.5 10\n0,180\n0\n100\n50\n";
    ies_profile ies;
    g_assert_true(ies_read(&ies, text, NULL));
    g_assert_cmpfloat(fabsf(ies_candela(&ies, 0, 0) - 0.5f * 3 * 2 * 1.5f * 100), <,
                      0.01f);
    g_assert_cmpfloat(fabsf(ies_candela(&ies, 90, 77) - 0.5f * 3 * 2 * 1.5f * 75), <,
                      0.01f);
    ies_clear(&ies);
}

static void test_bad_profiles(void)
{
    static const char *const bad[][2] = {
        {"", "TILT="},
        {"TILT=lamp.tlt\n", "TILT=NONE"},
        {"TILT=NONE\n1 2 3\n", "expected"},
        {"TILT=NONE\n1 100 1 2 1 4 1 0 0 0\n1 1 10\n0 90\n0\n1 1", "2 (B) or 3 (A)"},
        {"TILT=NONE\n1 100 1 2 1 3 1 0 0 0\n1 1 10\n0 90\n0\n1 1", "-90..90"},
        {"TILT=NONE\n1 100 1 2 2 2 1 0 0 0\n1 1 10\n0 180\n0 90\n1 1 1 1", "-90..90"},
        {"TILT=NONE\n1 100 1 2 1 1 1 0 0 0\n1 1 10\n90 0\n0\n1 1", "ascending"},
        {"TILT=NONE\n1 100 1 2 2 1 1 0 0 0\n1 1 10\n0 90\n0 33\n1 1 1 1", "horizontal"},
        {"TILT=NONE\n1 100 1 2 1 1 1 0 0 0\n1 1 10\n0 90\n0\n1", "candela"},
        {"TILT=NONE\n1 100 1 99999 1 1 1 0 0 0\n", "1..4096"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(bad); i++) {
        ies_profile ies;
        g_autoptr(GError) error = NULL;
        g_assert_false(ies_read(&ies, bad[i][0], &error));
        g_assert_nonnull(strstr(error->message, bad[i][1]));
    }
}

/* ---- All of them ---- */

static light *turned(const char *kind, const char *path)
{
    transform turn = transform_rotate(70, 1, -1, 0.3);
    params *p = list(path);
    if (strcmp(kind, "projection") == 0)
        number(p, "fov", 60);
    return make(kind, p, &turn);
}

static bool draw(void *data, float u_lobe, vec2 u, vec3 *out)
{
    const light *l = data;
    const wavelengths w = wavelengths_at(0.5f);
    light_emission e;
    if (!l->kind->emit(l->self, &w, u_lobe, u, u, &e))
        return false;
    float position, direction;
    l->kind->emit_pdf(l->self, e.ray.origin, e.n, e.ray.direction, &position, &direction);
    g_assert_cmpfloat(fabsf(direction / e.pdf_direction - 1), <, 0.1f);
    *out = e.ray.direction;
    return true;
}

static float density(void *data, vec3 d)
{
    const light *l = data;
    float position, direction;
    l->kind->emit_pdf(l->self, (vec3){0}, d, d, &position, &direction);
    return direction;
}

static void test_emission(void)
{
    const struct {
        const char *kind, *path;
    } cases[] = {{"goniometric", map_path},
                 {"goniometric", ies_path},
                 {"goniometric", NULL},
                 {"projection", slide_path}};
    const wavelengths w = wavelengths_at(0.4f);
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        light *l = turned(cases[i].kind, cases[i].path);
        g_assert_cmpfloat(chi2_directions(draw, density, l, 20000, 3), >, 1e-6);
        double power = (double)spectrum_mean(l->kind->power(l->self, &w));
        double sum = 0, sum2 = 0, all = 0, all2 = 0;
        enum { N = 20000 };
        for (uint32_t n = 0; n < N; n++) {
            sampler s = sampler_make(6, n);
            vec2 u = sampler_2d(&s);
            light_emission e;
            g_assert_true(l->kind->emit(l->self, &w, 0, u, u, &e));
            double flux = (double)spectrum_mean(e.flux);
            sum += flux;
            sum2 += flux * flux;
            /* the same power, as it arrives on a sphere; and aimed */
            vec3 d = warp_sphere(sampler_2d(&s));
            light_sample to;
            light_emission aimed;
            bool sent = l->kind->sample(l->self, &w, d, 0, u, &to);
            double there = sent ? (double)spectrum_mean(to.radiance) : 0;
            if (l->kind->emit_toward(l->self, &w, 0, u, 2 * d, &aimed))
                g_assert_cmpfloat(fabs((double)spectrum_mean(aimed.flux) - there), <,
                                  1e-3 * there + 1e-6);
            all += 4 * G_PI * there;
            all2 += square((float)(4 * G_PI * there));
        }
        double mean = sum / N, error = sqrt(fmax(0, sum2 / N - mean * mean) / N);
        double arrived = all / N,
               spread = sqrt(fmax(0, all2 / N - arrived * arrived) / N);
        g_assert_cmpfloat(error, <, 0.02 * mean);
        g_assert_cmpfloat(fabs(mean - power), <, 6 * error + 3e-3 * power);
        g_assert_cmpfloat(fabs(arrived - power), <, 6 * spread + 3e-3 * power);
        light_free(l);
    }
}

static void test_power_and_scale(void)
{
    const char *const kinds[] = {"goniometric", "goniometric", "projection"};
    const char *const paths[] = {map_path, ies_path, slide_path};
    for (int i = 0; i < 3; i++) {
        light *l = make(kinds[i], number(list(paths[i]), "power", 7), NULL);
        g_assert_cmpfloat(fabs(luminous_power(l) / 7 - 1), <, 0.01);
        light *plain = make(kinds[i], list(paths[i]), NULL);
        light *twice = make(kinds[i], number(list(paths[i]), "scale", 2), NULL);
        g_assert_cmpfloat(fabs(luminous_power(twice) / luminous_power(plain) - 2), <,
                          1e-4);
        light_free(l);
        light_free(plain);
        light_free(twice);
    }
    params *p = list(map_path);
    const float red[3] = {1, 0.01f, 0.01f};
    params_add_numbers(p, here, PARAM_RGB, "I", red, 3, NULL);
    light *l = make("goniometric", p, NULL);
    const wavelengths w = wavelengths_at(0.5f);
    spectrum x = l->kind->power(l->self, &w);
    g_assert_cmpfloat(x[N_WAVELENGTHS - 2], >, 5 * x[2]);
    light_free(l);
}

/* The slide's upper left corner is bright: up is +y, left is -x as seen along +z with x
 * to the right. */
static void test_slide_stands_upright(void)
{
    light *l = make("projection", number(list(slide_path), "fov", 60), NULL);
    const wavelengths w = wavelengths_at(0.5f);
    float h = tanf(30 * PI_F / 180) * 0.8f;
    double corner = intensity(l, normalize3(vec3_make(-2 * h, h, 1)), &w);
    g_assert_cmpfloat(corner, >,
                      5 * intensity(l, normalize3(vec3_make(-2 * h, -h, 1)), &w));
    g_assert_cmpfloat(corner, >,
                      5 * intensity(l, normalize3(vec3_make(2 * h, h, 1)), &w));
    g_assert_cmpfloat(corner, >,
                      5 * intensity(l, normalize3(vec3_make(2 * h, -h, 1)), &w));
    /* the window: the shorter side spans the angle */
    g_assert_cmpfloat(intensity(l, normalize3(vec3_make(0, 1.3f * h, 1)), &w), <=, 0);
    g_assert_cmpfloat(intensity(l, normalize3(vec3_make(3.0f * h, 0, 1)), &w), >, 0);
    g_assert_cmpfloat(intensity(l, normalize3(vec3_make(3.3f * h, 0, 1)), &w), <=, 0);
    g_assert_cmpfloat(intensity(l, vec3_make(0, 0, -1), &w), <=, 0);
    light_free(l);
}

/* ---- Pictures on shapes ---- */

static shape *unit_panel(void)
{
    static const float points[12] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    static const float uvs[8] = {0, 0, 1, 0, 1, 1, 0, 1};
    static const int indices[6] = {0, 1, 2, 0, 2, 3};
    g_autoptr(params) p = list(NULL);
    params_add_numbers(p, here, PARAM_POINT3, "P", points, 12, NULL);
    params_add_numbers(p, here, PARAM_POINT2, "uv", uvs, 8, NULL);
    params_add_integers(p, here, PARAM_INTEGER, "indices", indices, 6, NULL);
    const shape_place at = {.to_world = transform_identity()};
    return shape_new("trianglemesh", p, &at, NULL);
}

/* The slide is bright in the upper left: so is the panel, with the power asked for. */
static void test_pictured_panel(void)
{
    const transform identity = transform_identity();
    const vec3 up = vec3_make(0, 0, 1);
    shape *on = unit_panel();
    g_autoptr(params) p = number(list(slide_path), "power", 3);
    light *l = light_new(NULL, "diffuse", p, &identity, on, NULL);
    double y = 0;
    for (int k = 0; k < 4; k++) {
        const wavelengths w = wavelengths_at(((float)k + 0.5f) / 4);
        enum { N = 20000 };
        for (uint32_t n = 0; n < N; n++) {
            sampler s = sampler_make(71, n);
            vec2 u = sampler_2d(&s), v = sampler_2d(&s);
            light_emission e;
            float xyz[3] = {0};
            if (l->kind->emit(l->self, &w, sampler_1d(&s), u, v, &e))
                spectrum_to_xyz(&w, e.flux, xyz);
            y += (double)xyz[1] / N / 4;
        }
    }
    g_assert_cmpfloat(fabs(y / 3 - 1), <, 0.04);
    g_assert_cmpfloat(fabs(luminous_power(l) / 3 - 1), <, 0.01);
    const wavelengths w = wavelengths_at(0.5f);
    float seen[4];
    for (int i = 0; i < 4; i++) {
        surface_hit hit = {.n = up, .n_geom = up};
        hit.uv = (vec2){i & 1 ? 0.8f : 0.2f, i & 2 ? 0.8f : 0.2f};
        seen[i] = spectrum_mean(l->kind->radiance(l->self, &hit, up, &w));
    }
    for (int i = 0; i < 4; i++)
        g_assert_true(i == 2 || seen[2] > 5 * seen[i]);
    light_free(l);
    const float white[3] = {1, 1, 1};
    params_add_numbers(p, here, PARAM_RGB, "L", white, 3, NULL);
    g_autoptr(GError) error = NULL;
    g_assert_null(light_new(NULL, "diffuse", p, &identity, on, &error));
    g_assert_nonnull(strstr(error->message, "either 'L' or 'filename'"));
    shape_free(on);
}

static void refuse(const char *kind, params *p, const char *part)
{
    g_autoptr(GError) error = NULL;
    transform identity = transform_identity();
    g_assert_null(light_new(NULL, kind, p, &identity, NULL, &error));
    g_assert_nonnull(strstr(error->message, part));
    g_assert_true(g_str_has_prefix(error->message, "d.pbrt:6:2: "));
    params_free(p);
}

static void test_refusals(void)
{
    refuse("projection", list(NULL), "filename");
    refuse("projection", number(list(slide_path), "fov", 180), "'fov'");
    refuse("projection", list("/none.png"), "/none.png");
    refuse("goniometric", list(slide_path), "found 40 x 16");
    refuse("goniometric", list("/none.ies"), "/none.ies");
    refuse("goniometric", number(list(NULL), "fov", 30), "unknown parameter 'fov'");
}

static void write_files(void)
{
    static const char *const names[] = {"R", "G", "B"};
    map_path = g_build_filename(folder, "map.pfm", NULL);
    slide_path = g_build_filename(folder, "slide.pfm", NULL);
    ies_path = g_build_filename(folder, "lamp.ies", NULL);
    g_autoptr(image) map = image_new(16, 16, 3, names, NULL);
    for (int i = 0; i < 16 * 16 * 3; i++)
        map->pixels[i] = 0.2f + (float)(i / 3 * 7 % 16) / 8;
    g_autoptr(image) slide = image_new(40, 16, 3, names, NULL);
    for (int i = 0; i < 40 * 16; i++) {
        bool corner = i / 40 < 8 && i % 40 < 20;
        for (int c = 0; c < 3; c++)
            slide->pixels[3 * i + c] = corner ? 2.0f : 0.2f + 0.01f * (float)c;
    }
    g_assert_true(image_write(map, map_path, NULL, NULL));
    g_assert_true(image_write(slide, slide_path, NULL, NULL));
    GString *text = g_string_new("IESNA:LM-63-1995\n[TEST] none\nTILT=NONE\n"
                                 "1 -1 2 10 3 1 2 0.1 0.1 0\n1 1 60\n"
                                 "0 10 20 30 40 50 60 70 80 90\n0 45 90\n");
    for (int c = 0; c < 3; c++)
        for (int g = 0; g < 10; g++)
            g_string_append_printf(text, "%d ", 500 - 40 * g + 30 * c * (g % 3));
    g_assert_true(g_file_set_contents(ies_path, text->str, -1, NULL));
    g_string_free(text, TRUE);
}

/* Photons are aimed in two steps, the first at a point that the light may not shine on:
   where they leave must be known all the same. */
static void test_aimed_beside(void)
{
    static const struct {
        const char *kind;
        char **path;
    } cases[] = {{"projection", &slide_path}, {"goniometric", &map_path}};
    const wavelengths w = wavelengths_at(0.5f);
    transform at = transform_translate(3, -2, 5);
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        light *l = make(cases[i].kind, list(*cases[i].path), &at);
        for (int k = 0; k < 6; k++) {
            vec3 target = {3, -2, 5};
            target[k / 2] += k & 1 ? -1.0f : 1.0f;
            light_emission out = {0};
            l->kind->emit_toward(l->self, &w, 0.5f, (vec2){0.5f, 0.5f}, target, &out);
            g_assert_cmpfloat(length3(out.ray.origin - vec3_make(3, -2, 5)), <, 1e-5);
        }
        light_free(l);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder = g_dir_make_tmp("nephroid-XXXXXX", NULL);
    write_files();
    g_test_add_func("/directed/ies/published", test_published_lumens);
    g_test_add_func("/directed/ies/kept", test_profile_is_kept);
    g_test_add_func("/directed/ies/symmetry", test_symmetry);
    g_test_add_func("/directed/ies/other-types", test_other_types);
    g_test_add_func("/directed/ies/factors", test_factors);
    g_test_add_func("/directed/ies/bad", test_bad_profiles);
    g_test_add_func("/directed/emission", test_emission);
    g_test_add_func("/directed/power", test_power_and_scale);
    g_test_add_func("/directed/upright", test_slide_stands_upright);
    g_test_add_func("/directed/panel", test_pictured_panel);
    g_test_add_func("/directed/refusals", test_refusals);
    g_test_add_func("/directed/aimed-beside", test_aimed_beside);
    int status = g_test_run();
    char *const paths[] = {map_path, slide_path, ies_path};
    for (size_t i = 0; i < G_N_ELEMENTS(paths); i++) {
        g_unlink(paths[i]);
        g_free(paths[i]);
    }
    g_rmdir(folder);
    g_free(folder);
    return status;
}
