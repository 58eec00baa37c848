/*
 * Whole renders against what must hold: furnaces, path tracing, symmetry of threads and
 * scale.
 */
#include "bsdf/bsdf_models.h"
#include "photon/direction.h"
#include "rooms.h"
#include "transport/photonmap/photonmap.h"
#include "transport/visible.h"

/* ---- Furnace ---- */

static void check_furnace(const char *words)
{
    g_autoptr(view) v = view_of(FURNACE);
    g_autoptr(image) img = render_with(v, words);
    double found = mean_of(img, "");
    g_test_message("%s: radiance %g", words, found);
    g_assert_cmpfloat(fabs(found / 2.0 - 1.0), <, 0.01);
}

static void test_furnace_by_the_map(void)
{
    check_furnace("passes=4 spp=4 photons=200000 radius=0.1 direct_illumination=off");
    check_furnace("passes=4 spp=4 photons=200000 indirect_nearest=200");
}

static void test_furnace_by_final_gather(void)
{
    check_furnace(
        "passes=2 spp=2 photons=100000 radius=0.1 final_gather=on gather_rays=64 "
        "precompute_radiance=off");
    check_furnace(
        "passes=2 spp=2 photons=100000 radius=0.1 final_gather=on gather_rays=64");
    /* so few photons in reach that one counted at its own place would be 10 % of them */
    check_furnace("passes=32 spp=2 photons=50000 radius=0.05 alpha=1 final_gather=on "
                  "gather_rays=16");
}

/* A white ball within a glass ball in the furnace: inside glass radiance is η² times as
   much, and what a gather ray brings out of it is two again. The camera looks past them,
   at a wall. */
static void test_furnace_gathers_within_glass(void)
{
    g_auto(GStrv) room = g_strsplit(FURNACE, "WorldBegin\n", 2);
    g_autofree char *text = g_strconcat(
        "LookAt -0.9 -0.9 -0.92  0 0 -1  0 0 1 Camera \"perspective\" \"float fov\" "
        "6\n" SIZE(8) "WorldBegin Material \"dielectric\" Shape \"sphere\" \"float "
                      "radius\" 0.8 Material \"diffuse\" \"rgb reflectance\" [1 1 1] "
                      "Shape \"sphere\" \"float radius\" 0.7\n",
        room[1], NULL);
    g_autoptr(view) v = view_of(text);
    g_autoptr(image) img = render_with(
        v, "passes=8 spp=2 photons=30000 radius=0.1 final_gather=on gather_rays=8 "
           "max_backward_bounces=-1 max_forward_bounces=-1");
    double found = mean_of(img, "");
    g_test_message("radiance %g", found);
    g_assert_cmpfloat(fabs(found / 2.0 - 1.0), <, 0.06);
}

/* Above the lamp and behind the ball it is dark, with hardly a photon. */
#define DARK_PLACES(motion)                                                              \
    ROOM_CAMERA SIZE(8) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS                          \
        "ActiveTransform EndTime Translate " motion                                      \
        " 0 0 ActiveTransform All Translate 0 "                                          \
        "0 0.6 Material \"diffuse\" \"rgb reflectance\" [0.7 0.7 0.7] Shape \"sphere\" " \
        "\"float radius\" 0.4\n"

/* Irradiance that is kept is what the maps say. */
static void test_irradiance_cache(void)
{
    static const struct {
        const char *text, *words;
    } rooms[] = {{DARK_PLACES("0"), "photons=5000"}, {DARK_PLACES("1"), "photons=20000"}};
    for (size_t i = 0; i < G_N_ELEMENTS(rooms); i++) {
        g_autoptr(view) v = view_of(rooms[i].text);
        double sum[2];
        for (int k = 0; k < 2; k++) {
            g_autofree char *words =
                g_strdup_printf("passes=12 spp=4 radius=0.2 alpha=1 final_gather=on "
                                "gather_rays=16 precompute_radiance=%s %s",
                                k ? "on" : "off", rooms[i].words);
            g_autoptr(image) img = render_with(v, words);
            sum[k] = mean_of(img, "indirect");
        }
        g_test_message("kept %g, asked %g (%+.2f %%)", sum[1], sum[0],
                       100 * (sum[1] / sum[0] - 1));
        g_assert_cmpfloat(fabs(sum[1] / sum[0] - 1), <, 0.006);
    }
}

/* What a white wall at a kept place would send out by the maps, times π. */
static spectrum asked_irradiance(const photonmap_pass *pass, vec3 p, vec3 n,
                                 transport_scratch *scratch)
{
    const surface_hit hit = {.p = p, .n_geom = n, .n = n, .instance = NO_INDEX};
    bsdf white = {
        .shading = frame_from_normal(n), .n_geom = n, .wavelength = ALL_WAVELENGTHS};
    bsdf_make_diffuse(&white, spectrum_fill(1.0f));
    const shading_point at = {.hit = &hit, .bsdf = &white, .wo = n};
    spectrum sum = {0};
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        sum += PI_F * photonmap_gather(pass, (photon_class)c, &at, 0, scratch);
    return sum;
}

/* Where radii differ from place to place, irradiance is kept with the radius of its own,
   as it is asked for there. */
static void test_kept_with_own_radius(void)
{
    g_autoptr(view) v = view_of(DARK_PLACES("0"));
    const transport_kind *kind = transport_find(INTEGRATOR_PHOTONMAP);
    transport_plan plan = {.scene = v->scene, .view = v};
    plan.how =
        settings_with(v->scene, "photons=20000 final_gather=on edges=off threads=2");
    transport_counts counts = {0};
    transport_scratch scratch = {0};
    g_assert_true(kind->prepare(&plan, NULL, NULL));
    photonmap_pass *pass = kind->begin_pass(&plan, 0, NULL, &counts, NULL);
    const irradiance_cache *kept = pass->irradiance[0];
    double off = 0.0, all = 0.0;
    const point_arrays *places = &kept->places;
    for (size_t k = 0; k < places->n; k++) {
        vec3 p = vec3_make(places->x[k], places->y[k], places->z[k]),
             n = direction_unpack(kept->normal[k]);
        double asked = (double)spectrum_mean(asked_irradiance(pass, p, n, &scratch));
        off += fabs((double)spectrum_mean(kept->irradiance[k]) - asked);
        all += asked;
    }
    g_test_message("%zu places, off by %g of all", places->n, off / all);
    g_assert_cmpuint(places->n, >, 1000);
    g_assert_cmpfloat(off / all, <, 1e-4);
    transport_scratch_clear(&scratch);
    kind->end_pass(pass);
    transport_plan_clear(&plan);
}

static void test_furnace_by_path(void)
{
    check_furnace("integrator=path passes=8 spp=16 max_backward_bounces=-1");
}

/* ---- Photon mapping against path tracing ---- */

/* All but the lamps as the camera sees them, whose edges make noise of their own. */
static double reflected(const image *img)
{
    return mean_of(img, "") - mean_of(img, "emission");
}

static void test_photon_mapping_agrees_with_path_tracing(gconstpointer data)
{
    const furnishing *f = data;
    g_autofree char *text = g_strconcat(ROOM, f->text, NULL);
    g_autoptr(view) v = view_of(text);
    g_autoptr(image) path =
        render_with(v, "integrator=path passes=8 spp=128 max_backward_bounces=-1 seed=1");
    const char *const ways[] = {
        "passes=4 spp=4 photons=150000 radius=0.05 direct_illumination=off",
        "passes=4 spp=8 photons=100000 radius=0.05 final_gather=on gather_rays=8 "
        "precompute_radiance=off",
    };
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autoptr(image) photons = render_with(v, ways[i]);
        double a = reflected(photons), b = reflected(path);
        g_test_message("%s: %s: %g, path %g (%+.2f %%)", f->name, ways[i], a, b,
                       100 * (a / b - 1));
        g_assert_cmpfloat(fabs(a / b - 1.0), <, f->tolerance);
    }
}

/* A ball of ground glass, alpha 0.45, looked at closely by the automatic radii. Light
 * gathered on it was a fifth too much: its photons point where the surface around turned
 * them to. */
static void test_ground_glass_is_as_bright_as_by_paths(void)
{
    g_autoptr(view) v =
        view_of("LookAt 0 -3 1.2  0 0 0.3  0 0 1\n"
                "Camera \"perspective\" \"float fov\" 9\n"
                "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\n"
                "WorldBegin\n"
                "Material \"diffuse\" \"rgb reflectance\" [0.6 0.6 0.6]\n"
                "Shape \"disk\" \"float radius\" 3\n"
                "AttributeBegin Translate 0 0 0.3\n"
                "Material \"dielectric\" \"float roughness\" 0.2\n"
                "Shape \"sphere\" \"float radius\" 0.3 AttributeEnd\n"
                "AttributeBegin Translate 1 -1 3\n"
                "AreaLightSource \"diffuse\" \"float scale\" 30\n"
                "Shape \"sphere\" \"float radius\" 0.3 AttributeEnd\n");
    g_autoptr(image) path = render_with(v, "integrator=path passes=4 spp=64 seed=1");
    g_autoptr(image) photons = render_with(v, "passes=2 spp=32 photons=60000");
    double a = reflected(photons), b = reflected(path);
    g_test_message("%g, path %g (%+.2f %%)", a, b, 100 * (a / b - 1));
    g_assert_cmpfloat(fabs(a / b - 1.0), <, 0.05);
}

/* The layers hold the same light, whichever way it was found. */
static void test_layers_agree_with_path_tracing(void)
{
    g_autofree char *text = g_strconcat(ROOM, furnishings[2].text, NULL);
    g_autoptr(view) v = view_of(text);
    g_autoptr(image) path =
        render_with(v, "integrator=path passes=8 spp=64 max_backward_bounces=-1");
    g_autoptr(image) photons = render_with(v, "passes=8 spp=8 photons=60000");
    const char *const names[] = {"direct",   "indirect", "caustic",
                                 "specular", "emission", "albedo"};
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        double a = mean_of(photons, names[i]), b = mean_of(path, names[i]);
        g_test_message("%s: photons %g, path %g", names[i], a, b);
        g_assert_cmpfloat(fabs(a - b), <, 0.012 * mean_of(path, "") + 0.02 * b);
    }
}

/* ---- Invariance ---- */

static void test_same_bits_on_any_number_of_threads(void)
{
    const char *const ways[] = {
        "passes=2 spp=2 photons=10000",
        "passes=2 spp=1 photons=10000 photon_map=kdtree caustic_emission=uniform",
        "passes=1 spp=1 photons=10000 final_gather=on gather_rays=8 "
        "caustic_emission=uniform",
        "passes=1 spp=1 photons=10000 indirect_nearest=50 caustic_emission=uniform",
        "integrator=path passes=2 spp=4"};
    g_autofree char *text = g_strconcat(ROOM, furnishings[2].text, NULL);
    g_autoptr(view) v = view_of(text);
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autofree char *one = g_strconcat(ways[i], " threads=1", NULL);
        g_autofree char *two = g_strconcat(ways[i], " threads=2", NULL);
        g_autoptr(image) a = render_with(v, one);
        g_autoptr(image) b = render_with(v, two);
        assert_same_bits(a, b);
    }
}

static void test_maps_render_the_same(void)
{
    g_autofree char *text = g_strconcat(ROOM, furnishings[1].text, NULL);
    g_autoptr(view) v = view_of(text);
    const char *const ways[] = {"passes=1 spp=1 photons=5000",
                                "passes=1 spp=1 photons=5000 indirect_nearest=30 "
                                "caustic_nearest=20"};
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autofree char *list = g_strconcat(ways[i], " photon_map=list", NULL);
        g_autoptr(image) expected = render_with(v, list);
        for (int k = 0; k < 2; k++) {
            g_autofree char *other =
                g_strconcat(ways[i], k ? " photon_map=grid" : " photon_map=kdtree", NULL);
            g_autoptr(image) found = render_with(v, other);
            image_difference d;
            g_assert_true(image_compare(found, expected, &d, NULL));
            g_assert_cmpfloat(d.rmse, <, 1e-4 * d.mean_b);
        }
    }
}

/* The same scene in metres and in millimetres. Radiance does not change with scale. */
static void test_scale_changes_nothing(void)
{
    g_autofree char *metres = g_strconcat(ROOM, furnishings[2].text, NULL);
    g_autoptr(view) v = view_of(metres);
    GString *scaled = g_string_new(ROOM);
    g_string_replace(scaled, "LookAt 0 -3.4 1.2  0 0 0.9", "LookAt 0 -3400 1200  0 0 900",
                     1);
    g_string_replace(scaled, "WorldBegin\n", "WorldBegin\nScale 1000 1000 1000\n", 1);
    g_string_append(scaled, furnishings[2].text);
    g_autoptr(view) big = view_of(scaled->str);
    g_string_free(scaled, TRUE);
    const char *how = "passes=2 spp=4 photons=50000";
    g_autoptr(image) a = render_with(v, how);
    g_autoptr(image) b = render_with(big, how);
    image_difference d;
    g_assert_true(image_compare(b, a, &d, NULL));
    g_test_message("scaled: mean %g and %g, relMSE %g", d.mean_a, d.mean_b, d.relmse);
    /* Rounding sends some photons elsewhere: the images agree far below their own noise.
     */
    g_assert_cmpfloat(fabs(d.mean_a / d.mean_b - 1.0), <, 2e-3);
    g_assert_cmpfloat(d.relmse, <, 1e-3);
}

/* ---- Settings act ---- */

static void test_shadow_rays_off_lights_through(void)
{
    const char *text =
        "LookAt 3 0 4  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 20\n" SIZE(
            8) "WorldBegin LightSource \"point\" \"rgb I\" [10 10 10] \"point3 from\" [0 "
               "0 3]\n"
               "Shape \"disk\" \"float radius\" 5\n"
               "Translate 0 0 2.9 Shape \"disk\" \"float radius\" 0.5\n";
    g_autoptr(view) v = view_of(text);
    g_autoptr(image) dark =
        render_with(v, "passes=1 spp=1 photons=100 max_forward_bounces=0");
    g_autoptr(image) lit = render_with(
        v, "passes=1 spp=1 photons=100 max_forward_bounces=0 shadow_rays=off");
    g_assert_cmpfloat(mean_of(lit, "direct"), >, mean_of(dark, "direct"));
}

static void test_cancel_keeps_what_there_is(void)
{
    g_autoptr(view) v = view_of(ROOM);
    settings how = settings_with(v->scene, "passes=4 spp=1 photons=1000");
    g_autoptr(GError) error = NULL;
    g_autoptr(render) r = render_new(v, &how, &error);
    render_cancel(r);
    g_assert_false(render_run(r, NULL, NULL, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_CANCELLED);
    g_autoptr(image) img = render_image(r, NULL);
    g_assert_nonnull(img);
}

static void *cancel_soon(void *data)
{
    g_usleep(100000);
    render_cancel(data);
    return NULL;
}

/* How long a render goes on once it is cancelled, s. */
static double goes_on_for(const view *v, const char *words)
{
    g_autoptr(render) r = render_of(v, words);
    GThread *other = g_thread_new("cancel", cancel_soon, r);
    double start = (double)g_get_monotonic_time() * 1e-6;
    g_assert_false(render_run(r, NULL, NULL, NULL));
    double took = (double)g_get_monotonic_time() * 1e-6 - start - 0.1;
    g_thread_join(other);
    g_test_message("%s: %g s after", words, took);
    return took;
}

/* Where one sample, or the trials before the first, takes seconds. A busy machine may
   keep the last ray waiting. */
static void test_cancel_acts_soon(void)
{
    static const char *const ways[] = {
        "spp=1 photons=60000 radius=2 final_gather=on gather_rays=65536 "
        "precompute_radiance=off",
        "spp=1 photons=400000 radius=2 final_gather=on",
        "photons=100000000",
    };
    g_autoptr(view) v = view_of(ROOM);
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++)
        g_assert_cmpfloat(goes_on_for(v, ways[i]), <, 0.1 + 0.4);
}

/* ---- Long ways ---- */

/* Within mirrors that keep nearly all light. A ray meets the lamp after about 300 of
   them, or never. */
#define MIRRORS                                                                          \
    "WorldBegin Material \"conductor\" \"rgb reflectance\" [1 1 1] Shape "               \
    "\"trianglemesh\" \"point3 P\" [-1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1 -1 -1 1 1 -1 1 1 1 " \
    "1 -1 1 1] \"integer indices\" [0 1 2 0 2 3 4 6 5 4 7 6 0 5 1 0 4 5 3 2 6 3 6 7 0 "  \
    "3 7 0 7 4 1 5 6 1 6 2] "

static const char camera_askew[] =
    "LookAt 0.31 0.17 0.23  1 0.6 0.9  0 0 1 Camera \"perspective\" " SIZE(8);

static const char with_lamp[] = MIRRORS
    "Material \"diffuse\" \"rgb reflectance\" [0 0 0] AreaLightSource \"diffuse\" "
    "\"rgb L\" [2 2 2] Shape \"trianglemesh\" \"point3 P\" [-0.9999 0 0 -0.9999 "
    "0.2 0 -0.9999 0.2 0.3 -0.9999 0 0.3] \"integer indices\" [0 1 2 0 2 3]";

static const char without_lamp[] = MIRRORS "LightSource \"point\"";

/* What is seen of a scene, and how many rays a sample takes. */
static double seen_by(const char *world, const char *how, double *rays)
{
    enum { SPP = 8, SAMPLES = 8 * 8 * SPP };
    g_autofree char *text = g_strconcat(camera_askew, world, NULL);
    g_autofree char *words = g_strdup_printf(
        "%s max_backward_bounces=-1 max_forward_bounces=-1 passes=1 spp=%d", how,
        (int)SPP);
    g_autoptr(view) v = view_of(text);
    g_autoptr(render) r = render_of(v, words);
    g_assert_true(render_run(r, NULL, NULL, NULL));
    g_autoptr(image) img = image_of(r);
    *rays = (double)render_get_statistics(r).camera_rays / SAMPLES;
    g_test_message("%s: radiance %g, %g rays a sample", how, mean_of(img, ""), *rays);
    return mean_of(img, "");
}

/* A floor with nothing around it, so that no photon lands there a second time. */
#define LONE_FLOOR                                                                       \
    "LookAt 0 0 1 0 0 0 0 1 0 Camera \"perspective\" Film \"rgb\" \"integer "            \
    "xresolution\" 8 \"integer yresolution\" 8 WorldBegin LightSource \"point\" "        \
    "\"point3 from\" [0 0 4] Material \"diffuse\" Shape \"disk\" \"float radius\" 1\n"

static double indirect_radius(const view *v, const char *words, double *widest)
{
    g_autoptr(GError) error = NULL;
    const settings how = settings_with(v->scene, words);
    transport_plan plan = transport_plan_of(v, &how);
    transport_plan_prepare(&plan, NULL, &error);
    g_assert_no_error(error);
    double radius = plan.radius[PHOTON_INDIRECT];
    *widest = widest_radius(&plan);
    transport_plan_clear(&plan);
    return radius;
}

/* Where hardly any photon may land in a pass radii are as wide as may be; where there are
   so many that each disc may hold some, nothing tells of one. */
static void test_radius_where_none_landed(void)
{
    g_autoptr(view) v = view_of(LONE_FLOOR);
    double widest, radius = indirect_radius(v, "photons=20000 passes=1", &widest);
    g_assert_cmpfloat(fabs(radius - widest), <, 1e-6 * widest);
    radius = indirect_radius(v, "photons=20000000 passes=4000", &widest);
    g_assert_cmpfloat(fabs(radius - WIDEST_SHARE * widest), <, 1e-6 * widest);
}

/* Long ways end by chance, and what is seen stays as bright as by path tracing, whose
   paths are the same but where they end. */
static void test_long_ways(void)
{
    double rays;
    double expected = seen_by(with_lamp, "integrator=path", &rays);
    double found = seen_by(with_lamp, "photons=100 caustic_emission=uniform", &rays);
    g_assert_cmpfloat(fabs(found / expected - 1.0), <, 0.02);
    seen_by(without_lamp, "photons=100 caustic_emission=uniform", &rays);
    g_assert_cmpfloat(rays, <, 1000.0);
}

/* ---- Sky ---- */

/* A floor below a wall, under an even sky and a small lamp. */
static const char under_sky[] =
    "LookAt 0 -3 1  0 0 0.5  0 0 1 Camera \"perspective\" \"float fov\" 20 " SIZE(
        24) "WorldBegin LightSource \"infinite\" \"rgb L\" [1 1 1] LightSource \"point\" "
            "\"point3 from\" [2 -1 2] Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 "
            "0.5] Shape \"trianglemesh\" \"point3 P\" [-9 -9 0 9 -9 0 9 9 0 -9 9 0 -9 "
            "0.5 0 "
            "9 0.5 0 9 0.5 3 -9 0.5 3] \"integer indices\" [0 1 2 0 2 3 4 5 6 4 6 7]";

/* Mean over pixels of the squared error of the direct light, as a share of its square. */
static double direct_error(const image *img, const image *truth)
{
    size_t c = channel_of(img, "direct.G"), of = channel_of(truth, "direct.G");
    double sum = 0;
    for (size_t i = 0; i < pixels_of(img); i++) {
        double error = at(img, i, c) / at(truth, i, of) - 1.0;
        sum += error * error;
    }
    return sum / (double)pixels_of(img);
}

/* Of a sample of a wide sky by its own directions half are below the ground: relative
   variance 5/3. With one more by the surface's it is a fraction of that; and the mean is
   that of path tracing. */
static void test_sky_without_grain(void)
{
    enum { SPP = 4 };
    g_autoptr(view) v = view_of(under_sky);
    g_autoptr(image) truth = render_with(v, "integrator=path passes=4 spp=256");
    g_autofree char *words = g_strdup_printf("photons=100 passes=1 spp=%d", (int)SPP);
    g_autoptr(image) img = render_with(v, words);
    double bias = mean_of(img, "direct") / mean_of(truth, "direct") - 1.0;
    double variance = SPP * direct_error(img, truth);
    g_test_message("mean %+.2f %%, relative variance of a sample %g", 100.0 * bias,
                   variance);
    g_assert_cmpfloat(fabs(bias), <, 0.01);
    g_assert_cmpfloat(variance, <, 0.25);
}

/* A lamp that clear glass mirrors, in the dark: each sample sees what Fresnel's equations
   say of it at 45 degrees, 5.02 % of 100 where its index is 1.5, but for what eight
   wavelengths say of white. */
static void test_glint_without_grain(gconstpointer integrator)
{
    g_autoptr(view) v = view_of(
        "LookAt 0 -1 1  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 0.1\n" SIZE(
            4) "WorldBegin\n"
               "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [100 100 100]\n"
               "Material \"diffuse\" \"rgb reflectance\" [0 0 0] Translate 0 3 3\n"
               "Rotate 135 1 0 0 Shape \"disk\" \"float radius\" 1 AttributeEnd\n"
               "Material \"dielectric\" Shape \"disk\" \"float radius\" 1\n");
    g_autofree char *words =
        g_strconcat("passes=1 spp=1 denoise=off integrator=", integrator, NULL);
    g_autoptr(image) img = render_with(v, words);
    for (int i = 0; i < img->width * img->height; i++) {
        const float *rgb = img->pixels + i * img->n_channels;
        g_test_message("%g %g %g", (double)rgb[0], (double)rgb[1], (double)rgb[2]);
        g_assert_cmpfloat_with_epsilon((double)rgb[1], 5.02, 0.15);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/transport/furnace/map", test_furnace_by_the_map);
    g_test_add_func("/transport/furnace/final-gather", test_furnace_by_final_gather);
    g_test_add_func("/transport/furnace/within-glass", test_furnace_gathers_within_glass);
    g_test_add_func("/transport/irradiance-cache", test_irradiance_cache);
    g_test_add_func("/transport/kept-with-own-radius", test_kept_with_own_radius);
    g_test_add_func("/transport/furnace/path", test_furnace_by_path);
    for (size_t i = 0; i < G_N_ELEMENTS(furnishings); i++) {
        g_autofree char *name =
            g_strdup_printf("/transport/agree/%s", furnishings[i].name);
        g_test_add_data_func(name, &furnishings[i],
                             test_photon_mapping_agrees_with_path_tracing);
    }
    g_test_add_func("/transport/ground-glass",
                    test_ground_glass_is_as_bright_as_by_paths);
    g_test_add_func("/transport/layers", test_layers_agree_with_path_tracing);
    g_test_add_func("/transport/threads", test_same_bits_on_any_number_of_threads);
    g_test_add_func("/transport/maps", test_maps_render_the_same);
    g_test_add_func("/transport/scale", test_scale_changes_nothing);
    g_test_add_func("/transport/shadow-rays", test_shadow_rays_off_lights_through);
    g_test_add_func("/transport/cancel", test_cancel_keeps_what_there_is);
    g_test_add_func("/transport/cancel-soon", test_cancel_acts_soon);
    g_test_add_func("/transport/none-landed", test_radius_where_none_landed);
    g_test_add_func("/transport/long-ways", test_long_ways);
    g_test_add_func("/transport/sky", test_sky_without_grain);
    static const char *const all[] = {"path", "auto", "vcm", "photonmap", "sppm"};
    for (size_t i = 0; i < G_N_ELEMENTS(all); i++) {
        g_autofree char *name = g_strconcat("/transport/glint/", all[i], NULL);
        g_test_add_data_func(name, all[i], test_glint_without_grain);
    }
    return g_test_run();
}
