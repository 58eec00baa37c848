/*
 * camera and filter: rays go where pbrt's go, and samples fall as their filter says.
 */
#include "camera/camera.h"
#include "camera/filter.h"
#include "math/sampler.h"

#include <glib.h>
#include <math.h>
#include <string.h>

/* Chi² of 255 degrees of freedom: above this with probability 1e-6 (Wilson-Hilferty). */
static double chi2_limit(int n)
{
    const double z = 4.753;
    double v = 2.0 / (9.0 * n), root = 1.0 - v + z * sqrt(v);
    return n * root * root * root;
}

static params *no_params(void)
{
    return params_new((source_place){g_intern_string("a.pbrt"), 3, 1}, ".", NULL);
}

static params *one_param(const char *name, const float *values, size_t n)
{
    params *p = no_params();
    source_place place = {g_intern_string("a.pbrt"), 4, 5};
    g_assert_true(params_add_numbers(p, place, PARAM_FLOAT, name, values, n, NULL));
    return p;
}

static void assert_refused(GError *error, const char *text)
{
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    if (!g_str_has_prefix(error->message, "a.pbrt:") || !strstr(error->message, text))
        g_error("'%s' does not say '%s'", error->message, text);
    g_error_free(error);
}

/* ---- camera ---- */

static camera make_camera(const char *name, const float *values, size_t n, int width,
                          int height)
{
    camera c;
    GError *error = NULL;
    transform identity = transform_identity();
    g_autoptr(params) p = name ? one_param(name, values, n) : no_params();
    g_assert_true(camera_init(&c, "perspective", p, &identity, width, height, &error));
    g_assert_no_error(error);
    return c;
}

static vec3 direction_at(const camera *c, float x, float y)
{
    return camera_ray(c, (vec2){x, y}, (vec2){0, 0}, 0).direction;
}

static void assert_near3(vec3 a, vec3 b, double epsilon)
{
    for (int i = 0; i < 3; i++)
        g_assert_cmpfloat_with_epsilon((double)a[i], (double)b[i], epsilon);
}

static void test_centre_and_sides(void)
{
    camera c = make_camera(NULL, NULL, 0, 200, 100);
    assert_near3(direction_at(&c, 100, 50), vec3_make(0, 0, 1), 1e-6);
    g_assert_cmpfloat(direction_at(&c, 150, 50)[0], >, 0); /* right is +x */
    g_assert_cmpfloat(direction_at(&c, 100, 20)[1], >, 0); /* up is +y, at small y */
}

/* 60 degrees span the shorter side, whichever that is. */
static void test_fov_spans_shorter_side(void)
{
    const float fov = 60;
    const double half = G_PI / 6;
    camera wide = make_camera("fov", &fov, 1, 200, 100);
    vec3 top = direction_at(&wide, 100, 0);
    g_assert_cmpfloat_with_epsilon(atan2((double)top[1], (double)top[2]), half, 1e-6);
    camera tall = make_camera("fov", &fov, 1, 100, 300);
    vec3 left = direction_at(&tall, 0, 150);
    g_assert_cmpfloat_with_epsilon(atan2((double)left[0], (double)left[2]), -half, 1e-6);
    float t = (float)tan(half);
    assert_near3(direction_at(&wide, 0, 0), normalize3(vec3_make(-2 * t, t, 1)), 1e-6);
    assert_near3(direction_at(&tall, 100, 300), normalize3(vec3_make(t, -3 * t, 1)),
                 1e-6);
}

static void test_window_and_aspect(void)
{
    const float window[4] = {-0.5f, 1.5f, -2, 0}, aspect = 3;
    camera shifted = make_camera("screenwindow", window, 4, 50, 70);
    assert_near3(direction_at(&shifted, 0, 0), normalize3(vec3_make(-0.5f, 0, 1)), 1e-6);
    assert_near3(direction_at(&shifted, 50, 70), normalize3(vec3_make(1.5f, -2, 1)),
                 1e-6);
    camera squeezed = make_camera("frameaspectratio", &aspect, 1, 50, 50);
    assert_near3(direction_at(&squeezed, 50, 0), normalize3(vec3_make(3, 1, 1)), 1e-6);
}

static void test_resize(void)
{
    const float aspect = 1.5f;
    camera a = make_camera(NULL, NULL, 0, 64, 64), b = make_camera(NULL, NULL, 0, 96, 32);
    camera_resize(&a, 96, 32);
    assert_near3(direction_at(&a, 90, 3), direction_at(&b, 90, 3), 1e-7);
    g_assert_cmpint(a.width, ==, 96);
    camera fixed = make_camera("frameaspectratio", &aspect, 1, 64, 64);
    vec3 corner = direction_at(&fixed, 64, 64);
    camera_resize(&fixed, 10, 100);
    assert_near3(direction_at(&fixed, 10, 100), corner, 1e-6);
}

static void test_pixel_area(void)
{
    const float fov = 40;
    camera c = make_camera("fov", &fov, 1, 30, 20);
    double side = 2 * 5 * tan(G_PI / 9) / 20;
    g_assert_cmpfloat_with_epsilon((double)camera_pixel_area(&c, 5), side * side, 1e-6);
}

/* pbrt's LookAt is world to camera; a scaled and mirrored camera is a camera still. */
static camera placed_camera(double scale_x, double scale)
{
    const double eye[3] = {1, 2, 3}, at[3] = {-4, 1, 0.5}, up[3] = {0, 0, 1};
    const float fov = 35;
    transform look, stretch = transform_scale(scale_x, scale, scale), both, to_world;
    g_assert_true(transform_look_at(eye, at, up, &look));
    both = transform_multiply(&stretch, &look);
    to_world = transform_inverse(&both);
    camera c;
    g_autoptr(params) p = one_param("fov", &fov, 1);
    g_assert_true(camera_init(&c, "perspective", p, &to_world, 160, 90, NULL));
    return c;
}

static void test_project_inverts_ray(void)
{
    const double scales[][2] = {{1, 1}, {-1, 1}, {1000, 1000}};
    for (int i = 0; i < 3; i++) {
        camera c = placed_camera(scales[i][0], scales[i][1]);
        sampler s = sampler_make(11, 0);
        for (int j = 0; j < 200; j++) {
            vec2 u = sampler_2d(&s), raster;
            float x = 200 * u.x - 20, y = 130 * u.y - 20;
            ray r = camera_ray(&c, (vec2){x, y}, sampler_2d(&s), 0);
            assert_near3(r.origin, vec3_make(1, 2, 3), 1e-5);
            g_assert_cmpfloat_with_epsilon((double)length3(r.direction), 1, 1e-6);
            vec3 p = r.origin + (0.5f + 10 * u.y) * r.direction;
            g_assert_true(camera_project(&c, p, &raster));
            g_assert_cmpfloat_with_epsilon((double)raster.x, (double)x, 2e-3);
            g_assert_cmpfloat_with_epsilon((double)raster.y, (double)y, 2e-3);
            g_assert_false(camera_project(&c, 2 * r.origin - p, &raster));
        }
    }
}

/* pbrt's world is left-handed: right is up x look. Looking along -x with z up that is -y;
 * Scale -1 1 1 before LookAt, as exporters of right-handed worlds write, mirrors it. */
static void test_right_is_right(void)
{
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        camera c = placed_camera(mirrored ? -1 : 1, 1);
        vec2 middle, beside, above;
        g_assert_true(camera_project(&c, vec3_make(-4, 1, 0.5f), &middle));
        g_assert_true(camera_project(&c, vec3_make(-4, 0.5f, 0.5f), &beside));
        g_assert_true(camera_project(&c, vec3_make(-4, 1, 0.7f), &above));
        g_assert_cmpfloat_with_epsilon((double)middle.x, 80, 1e-3);
        g_assert_cmpfloat_with_epsilon((double)middle.y, 45, 1e-3);
        g_assert_cmpint(beside.x > middle.x, ==, !mirrored);
        g_assert_cmpfloat(above.y, <, middle.y);
    }
}

/* Rays through one place of the film start all over the lens and meet where it is sharp:
 * on the plane z = focal distance. */
static void test_lens_rays_meet(void)
{
    camera c = make_camera(NULL, NULL, 0, 40, 40);
    c.lens_radius = 0.3f;
    c.focal_distance = 4;
    sampler s = sampler_make(5, 0);
    vec3 sum = {0};
    float largest = 0;
    enum { N = 512 };
    for (int i = 0; i < N; i++) {
        ray r = camera_ray(&c, (vec2){33, 4}, sampler_2d(&s), 0);
        g_assert_cmpfloat(length3(r.origin), <=, 0.3f + 1e-6f);
        g_assert_cmpfloat(r.origin[2], ==, 0.0f);
        vec3 p = r.origin + (4.0f / r.direction[2]) * r.direction;
        assert_near3(p, vec3_make(4 * 0.65f, 4 * 0.8f, 4), 1e-5);
        sum += r.origin;
        largest = fmaxf(largest, length3(r.origin));
    }
    g_assert_cmpfloat(largest, >, 0.28f);
    g_assert_cmpfloat(length3(sum) / N, <, 0.05f);
}

static void test_shutter(void)
{
    camera c = make_camera(NULL, NULL, 0, 4, 4);
    ray r = camera_ray(&c, (vec2){1, 1}, (vec2){0, 0}, 0.25f);
    g_assert_cmpfloat_with_epsilon((double)r.time, 0.25, 1e-7);
    c.shutter_open = 2;
    c.shutter_close = 6;
    r = camera_ray(&c, (vec2){1, 1}, (vec2){0, 0}, 0.25f);
    g_assert_cmpfloat_with_epsilon((double)r.time, 0.25, 1e-7);
    g_assert_true(isinf(r.t_max));
}

static void test_camera_refuses(void)
{
    const struct {
        const char *name, *says;
        float value;
        size_t n;
    } bad[] = {
        {"fov", "fov", 180, 1},
        {"fov", "fov", -5, 1},
        {"lensradius", "lensr", -1, 1},
        {"focaldistance", "focald", 0, 1},
        {"frameaspectratio", "f", 0, 1},
        {"screenwindow", "four floats", 1, 1},
        {"shutterclose", "opens", -1, 1},
        {"shutteropen", "opens", 2, 1},
        {"fvo", "fvo", 1, 1},
    };
    camera c;
    transform identity = transform_identity();
    for (size_t i = 0; i < G_N_ELEMENTS(bad); i++) {
        GError *error = NULL;
        g_autoptr(params) p = one_param(bad[i].name, &bad[i].value, bad[i].n);
        g_assert_false(camera_init(&c, "perspective", p, &identity, 8, 8, &error));
        assert_refused(error, bad[i].says);
    }
    GError *error = NULL;
    g_autoptr(params) p = no_params();
    g_assert_false(camera_init(&c, "realistic", p, &identity, 8, 8, &error));
    assert_refused(error, "realistic");
}

/* ---- other cameras ---- */

static camera camera_of(const char *kind, const char *mapping, int width, int height)
{
    camera c;
    GError *error = NULL;
    transform identity = transform_identity();
    g_autoptr(params) p = no_params();
    if (mapping)
        params_add_strings(p, p->place, PARAM_STRING, "mapping", &mapping, 1, NULL);
    g_assert_true(camera_init(&c, kind, p, &identity, width, height, &error));
    g_assert_no_error(error);
    g_assert_cmpstr(camera_kind_name(&c), ==, kind);
    return c;
}

/* All rays look the same way, from -2..2 by 1..-1 on a film twice as wide as high; with a
 * lens they meet in the plane in focus. */
static void test_orthographic(void)
{
    camera c = camera_of("orthographic", NULL, 40, 20);
    ray r = camera_ray(&c, (vec2){0, 0}, (vec2){0, 0}, 0);
    assert_near3(r.origin, vec3_make(-2, 1, 0), 1e-6);
    assert_near3(r.direction, vec3_make(0, 0, 1), 1e-7);
    assert_near3(camera_ray(&c, (vec2){30, 15}, (vec2){0, 0}, 0).origin,
                 vec3_make(1, -0.5f, 0), 1e-6);
    vec2 raster;
    g_assert_true(camera_project(&c, vec3_make(1, -0.5f, 7), &raster));
    g_assert_cmpfloat(fabsf(raster.x - 30) + fabsf(raster.y - 15), <, 1e-4f);
    g_assert_false(camera_project(&c, vec3_make(0, 0, -1), &raster));
    g_assert_cmpfloat_with_epsilon((double)camera_pixel_area(&c, 9), 0.01, 1e-7);
    g_assert_false(camera_connects(&c));
    c.lens_radius = 0.2f;
    c.focal_distance = 3;
    for (uint32_t i = 0; i < 50; i++) {
        sampler s = sampler_make(3, i);
        r = camera_ray(&c, (vec2){30, 15}, sampler_2d(&s), 0);
        vec3 in_focus = r.origin + r.direction * (3 / r.direction[2]);
        assert_near3(in_focus, vec3_make(1, -0.5f, 3), 1e-5);
        g_assert_cmpfloat(length3(r.origin - vec3_make(1, -0.5f, 0)), <, 0.2001f);
    }
}

/* θ = π y / h from +y, φ = 2π x / w from +x to +z. */
static void test_equirectangular(void)
{
    camera c = camera_of("spherical", "equirectangular", 80, 40);
    const struct {
        float x, y;
        vec3 d;
    } known[] = {{0, 20, {1, 0, 0}},
                 {20, 20, {0, 0, 1}},
                 {40, 20, {-1, 0, 0}},
                 {60, 20, {0, 0, -1}},
                 {13, 0, {0, 1, 0}},
                 {50, 40, {0, -1, 0}},
                 {10, 10, {0.5f, 0.70710678f, 0.5f}}};
    for (size_t i = 0; i < G_N_ELEMENTS(known); i++)
        assert_near3(direction_at(&c, known[i].x, known[i].y), known[i].d, 1e-6);
}

/* pbrt's square: the middle is +y (its z, exchanged), the corners are -y, the middles of
 * the sides lie on the horizon. */
static void test_equal_area(void)
{
    camera c = camera_of("spherical", NULL, 64, 64);
    assert_near3(direction_at(&c, 32, 32), vec3_make(0, 1, 0), 1e-6);
    assert_near3(direction_at(&c, 64, 32), vec3_make(1, 0, 0), 1e-6);
    assert_near3(direction_at(&c, 32, 64), vec3_make(0, 0, 1), 1e-6);
    assert_near3(direction_at(&c, 0, 0), vec3_make(0, -1, 0), 1e-6);
    /* Beyond the border the picture goes on. */
    assert_near3(direction_at(&c, 64.01f, 20), direction_at(&c, 63.99f, 44), 1e-3);
    assert_near3(direction_at(&c, 20, -0.01f), direction_at(&c, 44, 0.01f), 1e-3);
}

/* Every place near the border, on either side of it, is where a connection leads or one
   of its repeats, once; and all of these see the same. */
static void test_spherical_repeats(void)
{
    for (int k = 0; k < 2; k++) {
        camera c = camera_of("spherical", k ? "equalarea" : "equirectangular", 50, 40);
        for (uint32_t i = 0; i < 2000; i++) {
            sampler s = sampler_make(9, i);
            vec2 u = sampler_2d(&s), at = {56 * u.x - 3, 46 * u.y - 3};
            vec2 seen[1 + MOST_REPEATS];
            camera_connection found;
            vec3 d = direction_at(&c, at.x, at.y);
            g_assert_true(camera_connect(&c, 3.0f * d, (vec2){0, 0}, 0, &found));
            seen[0] = found.raster;
            int n = 1 + camera_repeats(&c, found.raster, seen + 1), n_here = 0;
            for (int j = 0; j < n; j++) {
                assert_near3(direction_at(&c, seen[j].x, seen[j].y), d, 1e-3);
                n_here += hypotf(seen[j].x - at.x, seen[j].y - at.y) < 0.02f;
            }
            g_assert_cmpint(n_here, ==, 1);
        }
    }
    camera flat = camera_of("perspective", NULL, 50, 40);
    vec2 none[MOST_REPEATS];
    g_assert_cmpint(camera_repeats(&flat, (vec2){1, 1}, none), ==, 0);
}

/* Back to the raster, and pixels per solid angle by differences. */
static void test_spherical_connects(void)
{
    for (int k = 0; k < 2; k++) {
        camera c = camera_of("spherical", k ? "equalarea" : "equirectangular", 50, 40);
        c.to_world = transform_rotate(40, 1, 2, 3);
        g_assert_true(camera_connects(&c));
        for (uint32_t i = 0; i < 200; i++) {
            sampler s = sampler_make(8, i);
            vec2 u = sampler_2d(&s), at = {1 + 48 * u.x, 2 + 36 * u.y};
            vec3 d = camera_ray(&c, at, (vec2){0, 0}, 0).direction;
            camera_connection found;
            g_assert_true(camera_connect(&c, 3.0f * d, (vec2){0, 0}, 0, &found));
            g_assert_cmpfloat(fabsf(found.raster.x - at.x), <, 1e-3f);
            g_assert_cmpfloat(fabsf(found.raster.y - at.y), <, 1e-3f);
            g_assert_cmpfloat(fabsf(found.distance - 3), <, 1e-5f);
            const float h = 0.02f;
            vec2 right = {at.x + h, at.y}, down = {at.x, at.y + h};
            vec3 dx = camera_ray(&c, right, (vec2){0, 0}, 0).direction - d;
            vec3 dy = camera_ray(&c, down, (vec2){0, 0}, 0).direction - d;
            float solid_angle = length3(cross3(dx, dy)) / (h * h);
            bool smooth = k == 0 || (fabsf(at.x - 25) > 1 && fabsf(at.y - 20) > 1);
            if (smooth)
                g_assert_cmpfloat(fabsf(found.pdf * solid_angle - 1), <, 0.05f);
        }
    }
}

/* Half the field of view is half of it. */
static void test_half_field_of_view(void)
{
    const float fov = 50, half = 25;
    camera a = make_camera("fov", &fov, 1, 30, 20),
           b = make_camera("halffov", &half, 1, 30, 20);
    assert_near3(direction_at(&a, 3, 4), direction_at(&b, 3, 4), 1e-7);
}

/* ---- filters ---- */

static const char *const kinds[] = {"box", "triangle", "gaussian", "mitchell", "sinc"};

static pixel_filter make_filter(const char *kind)
{
    pixel_filter f;
    GError *error = NULL;
    g_autoptr(params) p = no_params();
    g_assert_true(filter_init(&f, kind, p, &error));
    g_assert_no_error(error);
    return f;
}

/* Midpoint sum over the filter's square of f times a test function. */
static double integrate(const pixel_filter *f, double frequency)
{
    enum { N = 800 };
    double sum = 0, dx = 2.0 * (double)f->x_radius / N,
           dy = 2.0 * (double)f->y_radius / N;
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++) {
            double x = (i + 0.5) * dx - (double)f->x_radius;
            double y = (j + 0.5) * dy - (double)f->y_radius;
            double test = 1 + cos(frequency * x) * cos(0.7 * frequency * y);
            sum += test * (double)filter_eval(f, (vec2){(float)x, (float)y});
        }
    return sum * dx * dy;
}

static void test_filter_values(void)
{
    const vec2 at = {0.25f, -0.125f}, beyond = {9, 0};
    double g = exp(-2 * 0.0625) - exp(-2 * 2.25), h = exp(-2 * 0.015625) - exp(-2 * 2.25);
    /* Mitchell with B = C = 1/3 at t = 1/4 and 1/8: (7 t³ - 12 t² + 16/3) / 6. */
    double m = (7 / 64.0 - 12 / 16.0 + 16 / 3.0) / 6;
    double k = (7 / 512.0 - 12 / 64.0 + 16 / 3.0) / 6;
    double sx = sin(G_PI / 4) / (G_PI / 4) * sin(G_PI / 12) / (G_PI / 12);
    double sy = sin(G_PI / 8) / (G_PI / 8) * sin(G_PI / 24) / (G_PI / 24);
    const double expected[] = {1, 1.75 * 1.875, g * h, m * k, sx * sy};
    const float radius[] = {0.5f, 2, 1.5f, 2, 4};
    for (int i = 0; i < 5; i++) {
        pixel_filter f = make_filter(kinds[i]);
        g_assert_cmpfloat_with_epsilon((double)filter_eval(&f, at), expected[i], 1e-5);
        g_assert_cmpfloat(filter_eval(&f, beyond), ==, 0.0f);
        g_assert_cmpfloat(f.x_radius, ==, radius[i]);
        g_assert_cmpstr(f.name, ==, kinds[i]);
        filter_clear(&f);
    }
    pixel_filter standard;
    g_assert_true(filter_init_default(&standard, NULL));
    g_assert_cmpstr(standard.name, ==, "gaussian");
    g_assert_cmpfloat_with_epsilon((double)filter_eval(&standard, at), g * h, 1e-6);
    filter_clear(&standard);
}

/* A place on the raster reaches a film if it lies within the filter of some pixel. */
static void test_filter_reach(void)
{
    enum { WIDTH = 5, HEIGHT = 3, N = 4000 };
    pixel_filter f = make_filter("triangle");
    unsigned n_reached = 0;
    for (uint32_t n = 0; n < N; n++) {
        sampler random = sampler_make(12, n);
        vec2 u = sampler_2d(&random);
        vec2 at = {20.0f * u.x - 8.0f, 20.0f * u.y - 8.0f};
        bool expected = false;
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            expected |= fabsf(at.x - (float)(i % WIDTH) - 0.5f) <= f.x_radius &&
                        fabsf(at.y - (float)(i / WIDTH) - 0.5f) <= f.y_radius;
        g_assert_cmpint(filter_reaches(&f, at, WIDTH, HEIGHT), ==, expected);
        n_reached += expected;
    }
    g_assert_cmpuint(n_reached, >, N / 10);
    g_assert_cmpuint(n_reached, <, N / 2);
    filter_clear(&f);
}

/* The mean weight is one, and the mean of weight * test is the filter's own integral of
 * the test, within five standard errors (false alarm 6e-7 each; deterministic by seed).
 */
static void test_weights_integrate(void)
{
    enum { N = 1 << 15 };
    for (int i = 0; i < 5; i++) {
        pixel_filter f = make_filter(kinds[i]);
        double frequency = 2.0 / (double)f.x_radius, sum = 0, sum2 = 0, ones = 0,
               ones2 = 0;
        for (uint32_t j = 0; j < N; j++) {
            float w;
            uint64_t h = hash_mix(77, j);
            vec2 u = {(float)(h >> 40) * 0x1p-24f, (float)(h & 0xffffff) * 0x1p-24f};
            vec2 p = filter_sample(&f, u, &w);
            double x = (double)p.x, y = (double)p.y, weight = (double)w;
            double v = weight * (1 + cos(frequency * x) * cos(0.7 * frequency * y));
            sum += v;
            sum2 += v * v;
            ones += weight;
            ones2 += weight * weight;
        }
        double mean = sum / N, error = sqrt((sum2 / N - mean * mean) / N);
        double expected = integrate(&f, frequency) / integrate(&f, 0) * 2;
        g_assert_cmpfloat(fabs(mean - expected), <, 5 * error + 1e-4);
        double spread = sqrt(fmax(0.0, ones2 / N - (ones / N) * (ones / N)) / N);
        g_assert_cmpfloat(fabs(ones / N - 1), <, 5 * spread + 1e-4);
        filter_clear(&f);
    }
}

/* Sums of few weights stay well above 0, and by number, too, the mean weight is one and
 * the mean of weight * test the filter's integral. */
static void test_few_weights(void)
{
    enum { KEYS = 2000, N = 64 };
    for (int i = 0; i < 5; i++) {
        pixel_filter f = make_filter(kinds[i]);
        double frequency = 2.0 / (double)f.x_radius, sum = 0, ones = 0;
        for (uint64_t key = 0; key < KEYS; key++) {
            sampler s = sampler_make(key, 0);
            double weights = 0;
            for (uint64_t j = 0; j < N; j++) {
                float w;
                vec2 u = {sampler_1d(&s), sampler_1d(&s)};
                vec2 p = filter_sample_nth(&f, key, j, u, &w);
                double x = (double)p.x, y = (double)p.y, weight = (double)w;
                weights += weight;
                g_assert_cmpfloat(weights, >, 0.6);
                sum += weight * (1 + cos(frequency * x) * cos(0.7 * frequency * y));
            }
            ones += weights;
        }
        double mean = sum / (KEYS * N), all = KEYS * N;
        double expected = integrate(&f, frequency) / integrate(&f, 0) * 2;
        g_test_message("%s: %.4f, expected %.4f; weights %.4f", kinds[i], mean, expected,
                       ones / all);
        g_assert_cmpfloat(fabs(mean - expected), <, 0.02);
        g_assert_cmpfloat(fabs(ones / all - 1), <, 0.005);
        filter_clear(&f);
    }
}

/* Box, triangle and Gaussian: every sample counts as one. */
static void test_positive_filters_have_unit_weight(void)
{
    for (int i = 0; i < 3; i++) {
        pixel_filter f = make_filter(kinds[i]);
        sampler s = sampler_make(9, 0);
        for (int j = 0; j < 3000; j++) {
            float w;
            filter_sample(&f, sampler_2d(&s), &w);
            g_assert_cmpfloat_with_epsilon((double)w, 1, i < 2 ? 1e-3 : 0.02);
        }
        filter_clear(&f);
    }
}

/* The triangle's distribution function inverts by a square root. */
static void test_triangle_is_inverted(void)
{
    pixel_filter f = make_filter("triangle");
    for (int i = 0; i < 5000; i++) {
        float u = ((float)i + 0.5f) / 5000.0f, w;
        double s = (double)fminf(u, 1 - u), x = 2 * (1 - sqrt(2 * s));
        vec2 p = filter_sample(&f, (vec2){u, 1 - u}, &w);
        g_assert_cmpfloat_with_epsilon((double)p.x, u < 0.5f ? -x : x, 1e-4);
        g_assert_cmpfloat_with_epsilon((double)p.y, u < 0.5f ? x : -x, 1e-4);
    }
    filter_clear(&f);
}

/* Mean |f| over one of 16 x 16 cells, by 32 x 32 points. */
static double cell_mass(const pixel_filter *f, int cx, int cy)
{
    double sum = 0;
    for (int j = 0; j < 32; j++)
        for (int i = 0; i < 32; i++) {
            float x = ((float)(cx * 32 + i) + 0.5f) / 256.0f - 1.0f;
            float y = ((float)(cy * 32 + j) + 0.5f) / 256.0f - 1.0f;
            vec2 p = {x * f->x_radius, y * f->y_radius};
            sum += (double)fabsf(filter_eval(f, p));
        }
    return sum;
}

/* Chi² of samples in 16 x 16 cells against |f|; cells that expect less than five are put
 * together. False alarm 1e-6 each. */
static void test_samples_follow_filter(void)
{
    enum { N = 100000 };
    for (int k = 0; k < 5; k++) {
        pixel_filter f = make_filter(kinds[k]);
        double mass[256], total = 0, chi2 = 0, rest = 0, rest_seen = 0;
        int seen[256] = {0}, n_cells = 0;
        for (int i = 0; i < 256; i++)
            total += mass[i] = cell_mass(&f, i % 16, i / 16);
        for (uint32_t j = 0; j < N; j++) {
            float w;
            uint64_t h = hash_mix(123, j);
            vec2 u = {(float)(h >> 40) * 0x1p-24f, (float)(h & 0xffffff) * 0x1p-24f};
            vec2 p = filter_sample(&f, u, &w);
            int x = (int)((p.x / f.x_radius + 1) * 8),
                y = (int)((p.y / f.y_radius + 1) * 8);
            seen[CLAMP(y, 0, 15) * 16 + CLAMP(x, 0, 15)]++;
        }
        for (int i = 0; i < 256; i++) {
            double expected = mass[i] / total * N;
            if (expected < 5) {
                rest += expected;
                rest_seen += seen[i];
                continue;
            }
            chi2 += (seen[i] - expected) * (seen[i] - expected) / expected;
            n_cells++;
        }
        if (rest >= 5) {
            chi2 += (rest_seen - rest) * (rest_seen - rest) / rest;
            n_cells++;
        }
        g_assert_cmpfloat(chi2, <, chi2_limit(n_cells - 1));
        filter_clear(&f);
    }
}

static void test_filter_parameters(void)
{
    const float two = 2, negative = -1, wide = 0.8f;
    pixel_filter f;
    GError *error = NULL;
    g_autoptr(params) radius = one_param("yradius", &two, 1);
    g_assert_true(filter_init(&f, "box", radius, NULL));
    g_assert_cmpfloat(filter_eval(&f, (vec2){0.4f, 1.9f}), ==, 1.0f);
    filter_clear(&f);
    g_autoptr(params) sigma = one_param("sigma", &wide, 1);
    g_assert_true(filter_init(&f, "gaussian", sigma, NULL));
    double edge = exp(-0.5 * 2.25 / 0.64), g = exp(-0.5 / 0.64) - edge;
    g_assert_cmpfloat_with_epsilon((double)filter_eval(&f, (vec2){1, 0}), g * (1 - edge),
                                   1e-6);
    filter_clear(&f);
    g_autoptr(params) bad = one_param("xradius", &negative, 1);
    g_assert_false(filter_init(&f, "sinc", bad, &error));
    assert_refused(error, "xradius");
    error = NULL;
    g_autoptr(params) other = one_param("sigma", &two, 1);
    g_assert_false(filter_init(&f, "box", other, &error));
    assert_refused(error, "sigma");
    error = NULL;
    g_autoptr(params) none = no_params();
    g_assert_false(filter_init(&f, "lanczos", none, &error));
    assert_refused(error, "lanczos");
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/camera/orthographic", test_orthographic);
    g_test_add_func("/camera/equirectangular", test_equirectangular);
    g_test_add_func("/camera/equal-area", test_equal_area);
    g_test_add_func("/camera/spherical/connects", test_spherical_connects);
    g_test_add_func("/camera/spherical/repeats", test_spherical_repeats);
    g_test_add_func("/camera/halffov", test_half_field_of_view);
    g_test_add_func("/camera/centre", test_centre_and_sides);
    g_test_add_func("/camera/fov", test_fov_spans_shorter_side);
    g_test_add_func("/camera/window", test_window_and_aspect);
    g_test_add_func("/camera/resize", test_resize);
    g_test_add_func("/camera/pixel-area", test_pixel_area);
    g_test_add_func("/camera/project", test_project_inverts_ray);
    g_test_add_func("/camera/right", test_right_is_right);
    g_test_add_func("/camera/lens", test_lens_rays_meet);
    g_test_add_func("/camera/shutter", test_shutter);
    g_test_add_func("/camera/refuses", test_camera_refuses);
    g_test_add_func("/filter/values", test_filter_values);
    g_test_add_func("/filter/reach", test_filter_reach);
    g_test_add_func("/filter/weights", test_weights_integrate);
    g_test_add_func("/filter/few-weights", test_few_weights);
    g_test_add_func("/filter/unit-weight", test_positive_filters_have_unit_weight);
    g_test_add_func("/filter/triangle", test_triangle_is_inverted);
    g_test_add_func("/filter/chi2", test_samples_follow_filter);
    g_test_add_func("/filter/parameters", test_filter_parameters);
    return g_test_run();
}
