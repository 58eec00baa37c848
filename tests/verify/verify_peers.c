/*
 * What went wrong in other photon mappers, each as a test of its own: photons behind a
 * surface that shrank the radius in front of it, seams where normals are interpolated,
 * one time of the shutter for all photons of a pass, one wide look-up that made all slow,
 * one radius for all that the camera sees, near or far, and counters that ran over at 2³²
 * photons.
 */
#include "math/sampler.h"
#include "photon/estimate.h"
#include "photon/trace/trace.h"
#include "rooms.h"
#include "verify.h"

#include <time.h>

/* ---- Photons behind the surface ---- */

/* An even field of 10,000 photons on 1 m², one W/m² from above, and `behind` times as
   many from below. */
static photon_map *field(uint32_t behind)
{
    enum { N = 10000 };
    photon_store store = {0};
    uint32_t n = N * (1 + behind);
    g_assert_true(photon_store_reserve(&store, n, NULL));
    for (uint32_t i = 0; i < n; i++) {
        sampler random = sampler_make(5, i);
        vec2 u = sampler_2d(&random);
        photon p = {.p = vec3_make(u.x - 0.5f, u.y - 0.5f, 0),
                    .wi = vec3_make(0, 0, i < N ? 1 : -1),
                    .flux = spectrum_fill(1.0f / N)};
        photon_store_put(&store, &p);
    }
    return photon_map_build(MAP_KDTREE, &store, 0, (workers){.threads = 1}, NULL);
}

static void test_photons_behind(void)
{
    g_autoptr(photon_map) without = field(0), with = field(20);
    const estimate_options options = {
        .kernel = {KERNEL_CONSTANT, 1}, .nearest = 200, .radius = INFINITY, .flatten = 1};
    estimate_scratch scratch = {0};
    estimate_info a, b;
    vec3 up = vec3_make(0, 0, 1), here = vec3_make(0, 0, 0);
    spectrum alone = photon_irradiance(without, here, up, &options, &scratch, &a);
    spectrum beside = photon_irradiance(with, here, up, &options, &scratch, &b);
    g_test_message("radius %g and %g, irradiance %g and %g", (double)a.radius,
                   (double)b.radius, (double)alone[0], (double)beside[0]);
    g_assert_cmpfloat(fabsf(a.radius / b.radius - 1), <, 1e-5f);
    g_assert_cmpfloat(fabsf(alone[0] / beside[0] - 1), <, 1e-4f);
    estimate_scratch_clear(&scratch);
}

/* ---- Interpolated normals ---- */

/* All light from photons, and from there once more, on a coarse ball that pretends to be
   round, whose seams would show in a block, and a floor that pretends to be tilted. */
static void test_shading_normals(void)
{
    g_autoptr(view) v = view_of(ROOM_CAMERA SIZE(
        32) "WorldBegin LightSource \"infinite\" \"rgb L\" [0.2 0.2 0.2] LightSource "
            "\"distant\" \"point3 from\" [2 1 1.5]\n"
            "Material \"diffuse\" \"rgb reflectance\" [0.7 0.7 0.7]\n"
            "Shape \"trianglemesh\" \"point3 P\" [-3 -3 0 3 -3 0 3 3 0 -3 3 0] \"normal "
            "N\" [0.5 0.2 0.8 0.5 0.2 0.8 0.5 0.2 0.8 0.5 0.2 0.8] \"integer indices\" "
            "[0 1 2 0 2 3]\n"
            "Translate 0 0 0.9 Shape \"trianglemesh\" \"point3 P\" [1 0 0 0 1 0 -1 0 0 0 "
            "-1 "
            "0 0 0 0.8 0 0 -0.8] \"normal N\" [1 0 0 0 1 0 -1 0 0 0 -1 0 0 0 1 0 0 -1] "
            "\"integer indices\" [0 1 4 1 2 4 2 3 4 3 0 4 1 0 5 2 1 5 3 2 5 0 3 5]\n");
    g_auto(yardstick) path = {
        .of = {.view = v, .words = "integrator=path spp=4 max_backward_bounces=-1"}};
    const subject by_map = {.view = v,
                            .words = "integrator=photonmap direct_illumination=off spp=2 "
                                     "photons=40000 max_backward_bounces=-1"};
    verify_agree("direct map", &by_map, &path, 32, (allowance){0.01, 0.05, false});
}

/* ---- One time a pass ---- */

/* A glass ball that flies through the room, or stands on its way there: its caustic is a
   streak, in one pass as in many. */
#define GLASS_ON_ITS_WAY                                                                 \
    "LookAt 0 -3 1.9  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 55\n" SIZE(      \
        32) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS                                      \
        "%s Translate %g 0 0 ActiveTransform All Material \"dielectric\" Translate "     \
        "-0.8 0 0.5 Shape \"sphere\" \"float radius\" 0.35\n"

/* Adds the mean caustic of blocks of 4 x 4 pixels, of one pass. */
static void add_caustic(const char *transforms, double way, double weight,
                        double mean[VERIFY_BLOCKS])
{
    g_autofree char *text = g_strdup_printf(GLASS_ON_ITS_WAY, transforms, way);
    g_autoptr(view) v = view_of(text);
    g_autoptr(image) img =
        render_with(v, "integrator=photonmap passes=1 spp=8 photons=80000 radius=0.08");
    size_t caustic = channel_of(img, "caustic.G");
    for (size_t i = 0; i < pixels_of(img); i++)
        mean[i / 32 / 4 * 8 + i % 32 / 4] += weight * at(img, i, caustic) / 16;
}

static void test_one_time_a_pass(void)
{
    enum { TIMES = 16 };
    double one[VERIFY_BLOCKS] = {0}, many[VERIFY_BLOCKS] = {0}, off2 = 0, all2 = 0;
    add_caustic("ActiveTransform EndTime", 1.6, 1, one);
    for (int i = 0; i < TIMES; i++)
        add_caustic("", 1.6 * (i + 0.5) / TIMES, 1.0 / TIMES, many);
    for (size_t i = 0; i < VERIFY_BLOCKS; i++) {
        off2 += (one[i] - many[i]) * (one[i] - many[i]);
        all2 += many[i] * many[i];
    }
    g_test_message("blocks off by %g of their caustic", sqrt(off2 / all2));
    g_assert_cmpfloat(off2, <, 0.2 * 0.2 * all2);
}

/* ---- One wide look-up ---- */

/* A lit table in a desert to the horizon, where hardly a photon falls. */
#define TABLE                                                                            \
    "LookAt 0 -5 3  0 0 0.5  0 0 1 Camera \"perspective\" \"float fov\" 50\n" SIZE(      \
        32) "WorldBegin LightSource \"spot\" \"rgb I\" [5 5 5] \"point3 from\" [0 0 3] " \
            "\"point3 to\" [0 0 0] \"float coneangle\" 40\n"                             \
            "Shape \"disk\" \"float radius\" 2\n"                                        \
            "AttributeBegin Translate 0 0 0.5 Shape \"sphere\" \"float radius\" 0.4 "    \
            "AttributeEnd\n"                                                             \
            "Shape \"disk\" \"float height\" -0.01 \"float radius\" 2000\n"

static double seconds_of(const char *more)
{
    g_autoptr(view) v = view_of(TABLE);
    g_autofree char *words = g_strconcat("integrator=photonmap passes=2 spp=4 "
                                         "photons=100000 threads=1 "
                                         "direct_illumination=off ",
                                         more, NULL);
    double best = INFINITY;
    for (int i = 0; i < 3; i++) {
        clock_t start = clock();
        g_autoptr(image) img = render_with(v, words);
        g_assert_nonnull(img);
        best = fmin(best, (double)(clock() - start) / CLOCKS_PER_SEC);
    }
    return best;
}

static void test_wide_radius(void)
{
    double near = seconds_of("radius=0.2"), wide = seconds_of("radius=0");
    g_test_message("%g s with a small radius, %g s with automatic ones", near, wide);
    g_assert_cmpfloat(wide, <, 3 * near + 0.15);
}

/* ---- A table before a landscape ---- */

/* A glass ball on a table, and behind it a hillside where a pixel is metres wide. */
#define TABLE_BEFORE                                                                     \
    "LookAt 0 -2.2 1.5  0 0 1.12  0 0 1 Camera \"perspective\" \"float fov\" 40\n" SIZE( \
        32) "WorldBegin LightSource \"point\" \"rgb I\" [3 3 3] \"point3 from\" [-0.5 "  \
            "-0.3 2.2] Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"         \
            "AttributeBegin Translate 0 0 0.8 Shape \"disk\" \"float radius\" 0.6 "      \
            "AttributeEnd AttributeBegin Material \"dielectric\" Translate 0 -0.15 1 "   \
            "Shape \"sphere\" \"float radius\" 0.15 AttributeEnd\n"
#define LANDSCAPE                                                                        \
    "LightSource \"distant\" \"rgb L\" [0.5 0.5 0.5] \"point3 from\" [0 -1 1]\n"         \
    "Translate 0 1000 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 900\n"

typedef struct caustic_found {
    double brightest, radius;
} caustic_found;

static caustic_found caustic_of(const char *text, const char *words)
{
    g_autoptr(view) v = view_of(text);
    g_autoptr(GError) error = NULL;
    g_autoptr(render) r = render_of(v, words);
    render_run(r, NULL, NULL, &error);
    g_assert_no_error(error);
    g_autoptr(image) img = image_of(r);
    size_t channel = channel_of(img, "caustic.G");
    caustic_found c = {.radius = render_get_statistics(r).radius[PHOTON_CAUSTIC]};
    for (size_t i = 0; i < pixels_of(img); i++)
        c.brightest = fmax(c.brightest, at(img, i, channel));
    return c;
}

static void test_landscape(void)
{
    static const char *const ways[] = {
        "integrator=photonmap passes=4 spp=4 photons=20000",
        "integrator=auto passes=4 spp=4 photons=20000"};
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        caustic_found alone = caustic_of(TABLE_BEFORE, ways[i]);
        caustic_found before = caustic_of(TABLE_BEFORE LANDSCAPE, ways[i]);
        g_test_message("radius %g and %g, brightest %g and %g", alone.radius,
                       before.radius, alone.brightest, before.brightest);
        g_assert_cmpfloat(fabs(before.radius / alone.radius - 1), <, 0.3);
        g_assert_cmpfloat(fabs(before.brightest / alone.brightest - 1), <, 0.2);
    }
}

/* ---- Beyond 2³² ---- */

static void note_start(const photon_event *event, void *data)
{
    if (event->kind == PHOTON_EMITTED)
        *(photon_event *)data = *event;
}

static void test_counters(void)
{
    g_autoptr(scene) s = scene_of(ROOM);
    settings how = settings_default();
    const uint64_t beyond = (uint64_t)1 << 32;
    g_assert_true(settings_set(&how, "photons", "10000000000", NULL));
    g_assert_cmpint(how.photons, ==, 10000000000);
    trace_task task = {.scene = s,
                       .how = &how,
                       .w = wavelengths_at(0.5f),
                       .photon_class = PHOTON_DIRECT,
                       .n_photons = 2 * beyond};
    trace_task few = task;
    few.n_photons = 1024;
    double sum = 0, sum_few = 0;
    for (uint64_t i = 0; i < 1024; i++) {
        photon_event low = {0}, high = {0}, of_few = {0};
        photon_tell(&task, i, note_start, &low);
        photon_tell(&task, beyond + i, note_start, &high);
        photon_tell(&few, i, note_start, &of_few);
        g_assert_cmpuint(high.index, ==, beyond + i);
        g_assert_cmpfloat(length3(high.p - low.p), >, 0.0f);
        sum += (double)spectrum_mean(high.flux);
        sum_few += (double)spectrum_mean(of_few.flux);
    }
    /* each carries its share of the lamp, one of 2³³ */
    g_assert_cmpfloat(fabs(sum / sum_few * 2 * (double)beyond / 1024 - 1), <, 1e-4);
    g_assert_cmpuint(sizeof render_get_statistics(NULL).emitted[0], ==, 8);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/verify/peers/photons-behind", test_photons_behind);
    g_test_add_func("/verify/peers/shading-normals", test_shading_normals);
    g_test_add_func("/verify/peers/one-time-a-pass", test_one_time_a_pass);
    g_test_add_func("/verify/peers/wide-radius", test_wide_radius);
    g_test_add_func("/verify/peers/landscape", test_landscape);
    g_test_add_func("/verify/peers/counters", test_counters);
    return g_test_run();
}
