/*
 * Edges, corners and thin walls: photons are counted, and area measured, where the
 * surface is.
 */
#include "math/sampler.h"
#include "math/warp.h"
#include "photon/estimate.h"
#include "photon/neighbourhood.h"
#include "scene_text.h"

#define CAMERA                                                                           \
    "Camera \"perspective\" Film \"rgb\" \"integer xresolution\" 8 \"integer "           \
    "yresolution\" 8\n"
#define LAMP "LightSource \"point\" \"rgb I\" [1 1 1] \"point3 from\" [0 0 5]\n"

/* A floor of 2 x 2 m at z = 0, and a thin wall on x = 0.2. */
#define FLOOR                                                                            \
    "Shape \"trianglemesh\" \"point3 P\" [-1 -1 0 1 -1 0 1 1 0 -1 1 0] \"integer "       \
    "indices\" [0 1 2 0 2 3]\n"
#define WALL                                                                             \
    "Shape \"trianglemesh\" \"point3 P\" [0.2 -1 0 0.2 1 0 0.2 1 1 0.2 -1 1] \"integer " \
    "indices\" [0 1 2 0 2 3]\n"

static const float radius = 0.1f;

/* An even field of photons straight down, one W/m² on the floor where x lies in [x0, x1].
 */
static photon_map *field(float x0, float x1)
{
    enum { N = 200000 };
    photon_store store = {0};
    g_assert_true(photon_store_reserve(&store, N, NULL));
    for (uint32_t i = 0; i < N; i++) {
        sampler random = sampler_make(2, i);
        vec2 u = sampler_2d(&random);
        photon p = {.p = vec3_make(lerpf(x0, x1, u.x), 2 * u.y - 1, 0),
                    .wi = vec3_make(0, 0, 1),
                    .flux = spectrum_fill((x1 - x0) * 2.0f / N)};
        photon_store_put(&store, &p);
    }
    return photon_map_build(MAP_GRID, &store, radius, (workers){.threads = 1}, NULL);
}

/* Irradiance found around (x, 0, 0), mean over a stretch along y. */
static double irradiance(const scene *s, const photon_map *map, float x)
{
    estimate_options options = {
        .kernel = {KERNEL_EPANECHNIKOV, 1}, .radius = radius, .flatten = 1, .scene = s};
    estimate_scratch scratch = {0};
    double sum = 0;
    enum { POINTS = 200 };
    for (int i = 0; i < POINTS; i++) {
        vec3 p = vec3_make(x, 0.004f * (float)(i - POINTS / 2), 0);
        sum += (double)spectrum_mean(
            photon_irradiance(map, p, vec3_make(0, 0, 1), &options, &scratch, NULL));
    }
    estimate_scratch_clear(&scratch);
    return sum / POINTS;
}

static void check_even(const scene *s, const photon_map *map, const float *x, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        double e = irradiance(s, map, x[i]);
        g_test_message("at x = %g: %g W/m2, expected 1", (double)x[i], e);
        g_assert_cmpfloat(fabs(e - 1), <, 0.02);
    }
}

static void test_open_floor(void)
{
    g_autoptr(scene) s = scene_of(CAMERA "WorldBegin\n" LAMP FLOOR);
    g_autoptr(photon_map) map = field(-1, 1);
    const float x[] = {0, 0.3f, -0.5f};
    check_even(s, map, x, G_N_ELEMENTS(x));
}

static void test_edge_is_as_bright_as_the_middle(void)
{
    g_autoptr(scene) s = scene_of(CAMERA "WorldBegin\n" LAMP FLOOR);
    g_autoptr(photon_map) map = field(-1, 1);
    const float x[] = {0.93f, 0.96f, 0.99f, -0.97f};
    check_even(s, map, x, G_N_ELEMENTS(x));
    g_assert_cmpfloat(irradiance(NULL, map, 0.99f), <, 0.7); /* what is corrected */
}

static void test_corner_is_as_bright_as_the_middle(void)
{
    g_autoptr(scene) s = scene_of(CAMERA "WorldBegin\n" LAMP FLOOR WALL);
    g_autoptr(photon_map) map = field(-1, 1);
    const float x[] = {0.13f, 0.16f, 0.19f, 0.21f, 0.25f};
    check_even(s, map, x, G_N_ELEMENTS(x));
}

/* What stands close above hides nothing that photons lie on, however close it is: the
   foot of a glass, which light comes through. */
static void test_floor_below_glass_is_as_bright(void)
{
    const float gap[] = {0.0002f, 0.001f,  0.002f, 0.0035f,
                         0.0045f, 0.0055f, 0.008f, 0.02f};
    g_autoptr(photon_map) map = field(-1, 1);
    for (size_t i = 0; i < G_N_ELEMENTS(gap); i++) {
        g_autofree char *text = g_strdup_printf(
            CAMERA "WorldBegin\n" LAMP FLOOR
                   "Material \"dielectric\" Shape \"disk\" \"float radius\" 0.6 \"float "
                   "height\" %g Shape \"disk\" \"float radius\" 0.6 \"float height\" 0.1",
            (double)gap[i]);
        g_autoptr(scene) s = scene_of(text);
        g_test_message("gap of %g radii", (double)(gap[i] / radius));
        const float x[] = {0, 0.2f};
        check_even(s, map, x, G_N_ELEMENTS(x));
    }
}

/* A ball that stands on the floor: around the foot it hides what it hides, and no place
   is brighter than the light. */
static void test_floor_below_a_ball_is_as_bright(void)
{
    g_autoptr(photon_map) map = field(-1, 1);
    g_autoptr(scene) s = scene_of(CAMERA "WorldBegin\n" LAMP FLOOR
                                         "Material \"dielectric\" Translate 0 0 0.4001 "
                                         "Shape \"sphere\" \"float radius\" 0.4\n");
    for (float x = 0.01f; x < 0.3f; x += 0.02f) {
        double e = irradiance(s, map, x);
        g_test_message("at x = %g: %g W/m2, expected 1", (double)x, e);
        g_assert_cmpfloat(fabs(e - 1), <, 0.1);
    }
}

/* Light on one side of the wall only: none comes through, and none is lost. */
static void test_thin_wall_does_not_leak(void)
{
    g_autoptr(scene) s = scene_of(CAMERA "WorldBegin\n" LAMP FLOOR WALL);
    g_autoptr(photon_map) map = field(0.2f, 1);
    g_assert_cmpfloat(irradiance(NULL, map, 0.19f), >, 0.3); /* what is kept out */
    g_assert_cmpfloat(irradiance(s, map, 0.19f), <, 1e-3);
    g_assert_cmpfloat(irradiance(s, map, 0.15f), <, 1e-3);
    g_assert_cmpfloat(fabs(irradiance(s, map, 0.22f) - 1), <, 0.02);
}

/* Sunlight on the far side of the wall, a thousand watts a square metre; the room is
 * dark.
 */
static photon_map *sunlit_wall(bool oriented)
{
    enum { N = 100000 };
    photon_store store = {.oriented = oriented};
    g_assert_true(photon_store_reserve(&store, N, NULL));
    for (uint32_t i = 0; i < N; i++) {
        sampler random = sampler_make(4, i);
        vec2 u = sampler_2d(&random);
        photon p = {.p = vec3_make(0.2f, 2 * u.y - 1, 0.1f * u.x),
                    .wi = vec3_make(0.8f, 0, 0.6f),
                    .n = vec3_make(1, 0, 0),
                    .flux = spectrum_fill(1000.0f * 0.2f / N)};
        photon_store_put(&store, &p);
    }
    return photon_map_build(MAP_GRID, &store, radius, (workers){.threads = 1}, NULL);
}

static void test_bright_wall_does_not_light_the_floor(void)
{
    g_autoptr(scene) s = scene_of(CAMERA "WorldBegin\n" LAMP FLOOR WALL);
    g_autoptr(photon_map) map = sunlit_wall(true), blind = sunlit_wall(false);
    const float x[] = {0.101f, 0.11f, 0.13f, 0.16f, 0.19f, 0.199f};
    float most = 0;
    for (size_t i = 0; i < G_N_ELEMENTS(x); i++) {
        g_assert_cmpfloat(irradiance(s, map, x[i]), <, 1e-6);
        most = maxf(most, (float)irradiance(s, blind, x[i]));
    }
    g_assert_cmpfloat(most, >, 1); /* what their normals keep out */
}

/* An even field of photons on a ball of radius 0.5 m, one W/m². */
static photon_map *field_on_ball(float reach)
{
    enum { N = 400000 };
    photon_store store = {0};
    g_assert_true(photon_store_reserve(&store, N, NULL));
    for (uint32_t i = 0; i < N; i++) {
        sampler random = sampler_make(3, i);
        vec3 n = warp_sphere(sampler_2d(&random));
        photon p = {.p = 0.5f * n, .wi = n, .flux = spectrum_fill(PI_F / N)};
        photon_store_put(&store, &p);
    }
    return photon_map_build(MAP_GRID, &store, reach, (workers){.threads = 1}, NULL);
}

/* Where the surface bends off the disc, photons weigh less, and so must area. */
static void test_ball_is_as_bright_as_a_plane(void)
{
    g_autoptr(scene) s =
        scene_of(CAMERA "WorldBegin\n" LAMP "Shape \"sphere\" \"float radius\" 0.5\n");
    const float reach[] = {0.03f, 0.05f, 0.1f, 0.15f, 0.2f};
    for (size_t k = 0; k < G_N_ELEMENTS(reach); k++) {
        enum { POINTS = 2000 };
        g_autoptr(photon_map) map = field_on_ball(reach[k]);
        estimate_options options = {.kernel = {KERNEL_EPANECHNIKOV, 1},
                                    .radius = reach[k],
                                    .flatten = 1,
                                    .scene = s};
        estimate_scratch scratch = {0};
        double sum = 0;
        for (uint32_t i = 0; i < POINTS; i++) {
            sampler random = sampler_make(4, i);
            vec3 n = warp_sphere(sampler_2d(&random));
            sum += (double)spectrum_mean(
                photon_irradiance(map, 0.5f * n, n, &options, &scratch, NULL));
        }
        estimate_scratch_clear(&scratch);
        g_test_message("radius %g: %g W/m2, expected 1", (double)reach[k], sum / POINTS);
        g_assert_cmpfloat(fabs(sum / POINTS - 1), <, 0.02);
    }
}

/* On the floor beside the wall: a ball, plates a fiftieth and an eighth of the radius
   thick, and the top of a flat dome. */
#define THINGS                                                                           \
    "Shape \"disk\" \"float radius\" 0.15 \"float height\" 0.002 "                       \
    "AttributeBegin Translate -0.5 0.3 0.0125 Shape \"disk\" \"float radius\" 0.15 "     \
    "AttributeEnd AttributeBegin Translate -0.2 0.35 -0.99 Shape \"sphere\" \"float "    \
    "radius\" 1 AttributeEnd Translate -0.5 -0.3 0 Shape \"sphere\" \"float radius\" "   \
    "0.15\n"

/* Mean over places of the share of the disc that is in sight, all lengths times as much;
 *whole: of places where nothing is amiss. */
static double coverage_at_size(float size, double *whole)
{
    enum { POINTS = 1000 };
    g_autofree char *text =
        g_strdup_printf(CAMERA "WorldBegin\n" LAMP "Scale %g %g %g\n" FLOOR WALL THINGS,
                        (double)size, (double)size, (double)size);
    g_autoptr(scene) s = scene_of(text);
    const kernel kappa = {KERNEL_EPANECHNIKOV, 1};
    double sum = 0;
    *whole = 0;
    for (uint32_t i = 0; i < POINTS; i++) {
        sampler random = sampler_make(8, i);
        vec2 u = sampler_2d(&random);
        neighbourhood hood = {.scene = s,
                              .p = size * vec3_make(u.x - 0.8f, u.y - 0.5f, 0),
                              .n = vec3_make(0, 0, 1),
                              .radius = size * radius};
        *whole += neighbourhood_is_whole(&hood);
        sum += (double)neighbourhood_coverage(&hood, &kappa);
    }
    *whole /= POINTS;
    return sum / POINTS;
}

/* In millimetres, metres and kilometres the same is seen. */
static void test_any_size(void)
{
    double whole, expected_whole, expected = coverage_at_size(1, &expected_whole);
    g_assert_cmpfloat(expected, >, 0.5);
    g_assert_cmpfloat(expected, <, 0.97);
    g_assert_cmpfloat(expected_whole, >, 0.2);
    for (float size = 1e-3f; size < 2e3f; size *= 1e6f) {
        double found = coverage_at_size(size, &whole);
        g_test_message("size %g: %g, expected %g; whole %g, expected %g", (double)size,
                       found, expected, whole, expected_whole);
        g_assert_cmpfloat(fabs(found - expected), <, 0.01);
        g_assert_cmpfloat(fabs(whole - expected_whole), <, 0.04);
    }
}

static bool is_whole(const scene *s, vec3 p, vec3 n, float reach)
{
    neighbourhood hood = {.scene = s, .p = p, .n = n, .radius = reach};
    return neighbourhood_is_whole(&hood);
}

/* A ball outside and inside; but not where a floor that it stands on comes near, at the
 * rim of a half, or where the radius is too large for it. */
static void test_what_bends_is_whole(void)
{
    g_autoptr(scene) s =
        scene_of(CAMERA "WorldBegin\n" LAMP "Shape \"sphere\" \"float radius\" "
                        "0.5 \"float zmax\" 0.1 Translate 0 0 -0.5 "
                        "Shape \"disk\" \"float radius\" 2\n");
    for (uint32_t i = 0; i < 200; i++) {
        sampler random = sampler_make(5, i);
        vec3 n = warp_sphere(sampler_2d(&random)), p = 0.5f * n;
        float near_edge = 0.1f - p[2], above_floor = p[2] + 0.5f, r = 0.15f;
        bool apart = near_edge > 1.2f * r && above_floor > 1.2f * r;
        if (near_edge < 0.0f)
            continue;
        if (apart) {
            g_assert_true(is_whole(s, p, n, r) && is_whole(s, p, -n, r));
            g_assert_false(is_whole(s, p, n, 0.45f));
        } else if (near_edge < 0.5f * r) {
            g_assert_false(is_whole(s, p, n, r));
        }
    }
}

/* The share of a kernel's area that lies on this side of a line, so many radii away. */
static double share_before(const kernel *k, double line)
{
    enum { N = 400 };
    double all = 0, before = 0;
    for (int i = 0; i < N * N; i++) {
        double x = 2 * (i % N + 0.5) / N - 1, y = 2 * (i / N + 0.5) / N - 1;
        double d2 = x * x + y * y, weight = 0;
        if (d2 < 1)
            weight = (double)kernel_eval(k, (float)d2, 1.0f);
        all += weight;
        before += x < line ? weight : 0;
    }
    return before / all;
}

/* Share found beside the floor's edge at x = 1, so many radii before it, by looks on
   average. */
static double share_found(const scene *s, const kernel *k, double off)
{
    enum { PLACES = 2000 };
    double sum = 0;
    for (int place = 0; place < PLACES; place++) {
        float y = 1.6f * (float)place / PLACES - 0.8f;
        neighbourhood hood = {.scene = s,
                              .p = {1.0f - (float)off * radius, y, 0},
                              .n = {0, 0, 1},
                              .radius = radius};
        sum += neighbourhood_is_whole(&hood) ? 1.0
                                             : (double)neighbourhood_coverage(&hood, k);
    }
    return sum / PLACES;
}

static const double before_edge[] = {0.05, 0.3, 0.6};

/* What is found beside a straight edge is what the kernel weighs there, whichever
 * kernel. */
static void test_coverage_is_the_share_of_the_kernel(void)
{
    static const kernel kernels[] = {{KERNEL_CONSTANT, 1},
                                     {KERNEL_CONE, 1.1f},
                                     {KERNEL_GAUSSIAN, 1},
                                     {KERNEL_EPANECHNIKOV, 1}};
    const size_t n_lines = G_N_ELEMENTS(before_edge);
    g_autoptr(scene) s = scene_of(CAMERA "WorldBegin\n" LAMP FLOOR);
    for (size_t i = 0; i < G_N_ELEMENTS(kernels) * n_lines; i++) {
        const kernel *k = &kernels[i / n_lines];
        double off = before_edge[i % n_lines], found = share_found(s, k, off);
        double expected = share_before(k, off);
        g_test_message("kernel %d, %g radii before the edge: %g, expected %g",
                       (int)k->choice, off, found, expected);
        g_assert_cmpfloat(fabs(found - expected), <, 0.006);
    }
}

/* In the floor's plane beyond its edge, and what lies so close below. */
#define STRIP                                                                            \
    "\nShape \"trianglemesh\" \"point3 P\" [1 -1 0 2 -1 0 2 1 0 1 1 0] \"integer "       \
    "indices\" "                                                                         \
    "[0 1 2 0 2 3]\n"
#define SOLE                                                                             \
    "AttributeBegin Translate 1.5 0 -.001 Material \"diffuse\" "                         \
    "Shape \"bilinearmesh\" \"point3 P\" [-.5 -1 0 .5 -1 0 -.5 1 0 .5 1 0] "             \
    "AttributeEnd\n"

/* What lies flush beside the floor is its surface if photons may be kept on it, or on
   what shows through it. */
static void test_only_what_keeps_photons_is_surface(void)
{
    static const struct {
        const char *what, *text;
        bool is_surface;
    } strips[] = {
        {"board", "Material \"diffuse\"" STRIP, true},
        {"mirror", "Material \"conductor\" \"float roughness\" 0" STRIP, false},
        {"metal", "Material \"conductor\" \"float roughness\" 0.2" STRIP, true},
        {"glass", "Material \"dielectric\"" STRIP, false},
        {"pane", "Material \"thindielectric\"" STRIP, false},
        {"glass on a board", "Material \"dielectric\"" STRIP SOLE, true},
        {"mirror on a board", "Material \"conductor\" \"float roughness\" 0" STRIP SOLE,
         false},
        {"half a pane",
         "MakeNamedMaterial \"a\" \"string type\" \"thindielectric\" "
         "MakeNamedMaterial \"b\" \"string type\" \"diffuse\" "
         "Material \"mix\" \"string materials\" [\"a\" \"b\"]" STRIP,
         true},
    };
    const kernel k = {KERNEL_EPANECHNIKOV, 1};
    const size_t n_lines = G_N_ELEMENTS(before_edge);
    for (size_t i = 0; i < G_N_ELEMENTS(strips) * n_lines; i++) {
        g_autofree char *text =
            g_strconcat(CAMERA "WorldBegin\n" LAMP FLOOR, strips[i / n_lines].text, NULL);
        g_autoptr(scene) s = scene_of(text);
        double off = before_edge[i % n_lines], found = share_found(s, &k, off);
        double expected = strips[i / n_lines].is_surface ? 1 : share_before(&k, off);
        g_test_message("%s, %g radii before it: %g, expected %g",
                       strips[i / n_lines].what, off, found, expected);
        g_assert_cmpfloat(fabs(found - expected), <, 0.006);
    }
}

/* Some points at a time are seen as each is alone: around a corner of walls, and in
 * sectors of all directions. */
static void test_some_are_seen_as_each(void)
{
    enum { N = 4096 };
    g_autoptr(scene) s = scene_of(CAMERA "WorldBegin\n" LAMP FLOOR WALL);
    point_arrays points;
    g_assert_true(point_arrays_make(&points, N, "points", NULL));
    for (uint32_t i = 0; i < N; i++) {
        sampler random = sampler_make(5, i);
        vec2 u = sampler_2d(&random);
        points.x[i] = 0.15f + 0.24f * (u.x - 0.5f);
        points.y[i] = 0.24f * (u.y - 0.5f);
        points.z[i] = 0.02f * (sampler_1d(&random) - 0.5f);
    }
    neighbourhood hood = {
        .scene = s, .p = {0.15f, 0, 0}, .n = {0, 0, 1}, .radius = radius};
    g_assert_false(neighbourhood_is_whole(&hood));
    neighbourhood_coverage(&hood, &(kernel){KERNEL_CONSTANT, 1});
    size_t seen = 0;
    for (uint32_t i = 0; i < N; i += LANES) {
        uint32_t index[LANES];
        unsigned expected = 0, asked = 0x5fffu & bits_first(LANES);
        for (uint32_t k = 0; k < LANES; k++) {
            uint32_t n = index[k] = N - 1 - (i + k);
            vec3 q = vec3_make(points.x[n], points.y[n], points.z[n]);
            expected |= (unsigned)neighbourhood_sees(&hood, q) << k;
        }
        unsigned bits = neighbourhood_sees_of(&hood, &points, index, asked);
        g_assert_cmphex(bits, ==, expected & asked);
        seen += (size_t)__builtin_popcount(bits);
    }
    g_test_message("%zu of %d seen", seen, N);
    g_assert_cmpuint(seen, >, N / 4);
    g_assert_cmpuint(seen, <, 3 * N / 4);
    point_arrays_clear(&points);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/neighbourhood/below-glass", test_floor_below_glass_is_as_bright);
    g_test_add_func("/neighbourhood/below-ball", test_floor_below_a_ball_is_as_bright);
    g_test_add_func("/neighbourhood/open", test_open_floor);
    g_test_add_func("/neighbourhood/edge", test_edge_is_as_bright_as_the_middle);
    g_test_add_func("/neighbourhood/corner", test_corner_is_as_bright_as_the_middle);
    g_test_add_func("/neighbourhood/wall", test_thin_wall_does_not_leak);
    g_test_add_func("/neighbourhood/bright-wall",
                    test_bright_wall_does_not_light_the_floor);
    g_test_add_func("/neighbourhood/ball", test_ball_is_as_bright_as_a_plane);
    g_test_add_func("/neighbourhood/size", test_any_size);
    g_test_add_func("/neighbourhood/coverage", test_coverage_is_the_share_of_the_kernel);
    g_test_add_func("/neighbourhood/flush", test_only_what_keeps_photons_is_surface);
    g_test_add_func("/neighbourhood/some", test_some_are_seen_as_each);
    g_test_add_func("/neighbourhood/bent", test_what_bends_is_whole);
    return g_test_run();
}
