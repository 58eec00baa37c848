/*
 * Photons in media: what a ray sees of them against the plain sum, their flux against the
 * law of free paths whatever way they are sent, and pictures of them that are the same
 * bits on any number of threads, in any unit, and apart by light groups.
 */
#include "flux_mean.h"
#include "fog_scenes.h"
#include "photon/trace/trace.h"
#include "photon/volume_map.h"
#include "transport/photonmap/aim.h"

#include <string.h>

/* ---- What a ray sees ---- */

enum { N_PHOTONS = 4000, N_RAYS = 300 };

/* Photons of two media in a unit cube, with radii of many sizes. */
static void fill(photon_store *store, float *radii)
{
    store->homed = store->tagged = true;
    g_assert_true(photon_store_reserve(store, N_PHOTONS, NULL));
    for (uint32_t i = 0; i < N_PHOTONS; i++) {
        sampler random = sampler_make(1, i);
        vec2 a = sampler_2d(&random), b = sampler_2d(&random);
        photon p = {.p = vec3_make(a.x, a.y, b.x),
                    .wi = normalize3(vec3_make(b.y - 0.5f, a.x - 0.3f, b.x - 0.6f)),
                    .tag = i % 3,
                    .home = 1 + i % 2};
        for (int wavelength = 0; wavelength < N_WAVELENGTHS; wavelength++)
            p.flux[wavelength] = (float)(1 + (i + (uint32_t)wavelength) % 7);
        photon_store_put(store, &p);
        radii[i] = 0.002f + 0.1f * sampler_1d(&random) * b.y;
    }
}

static double phase(double g, double cosine)
{
    return (1 - g * g) / (4 * G_PI * pow(1 + g * g - 2 * g * cosine, 1.5));
}

/* Σ T p κ Φ of one wavelength over the photons of one tag, by definition. */
static double seen(const photon_store *store, const float *radii, const ray *r,
                   const medium *m, double length, int wavelength, double sigma_t,
                   uint32_t tag)
{
    double sum = 0;
    for (size_t i = 0; i < store->n; i++) {
        const photon p = photon_store_get(store, i);
        double t = 0, d2 = 0, r2 = (double)radii[i] * (double)radii[i];
        for (int k = 0; k < 3; k++)
            t += ((double)p.p[k] - (double)r->origin[k]) * (double)r->direction[k];
        for (int k = 0; k < 3; k++)
            d2 += pow((double)p.p[k] - (double)r->origin[k] - t * (double)r->direction[k],
                      2);
        if (p.home != medium_home(m) || p.tag != tag || t <= 0 || t >= length || d2 >= r2)
            continue;
        double turn = -(double)dot3(p.wi, -r->direction);
        sum += exp(-sigma_t * t) * phase((double)m->g, turn) * (1 - d2 / r2) /
               (0.5 * G_PI * r2) * (double)p.flux[wavelength];
    }
    return sum;
}

/* Rays through the map, of groups and as a whole. */
static void compare_with_sum(const volume_map *map, const photon_store *store,
                             const float *radii, medium m)
{
    const wavelengths w = wavelengths_at(0.5f);
    const spectrum sigma_t = medium_extinction(&m, &w);
    double found = 0, expected = 0;
    for (uint32_t i = 0; i < N_RAYS; i++) {
        sampler random = sampler_make(2, i);
        vec2 a = sampler_2d(&random), b = sampler_2d(&random);
        vec3 from = vec3_make(a.x, a.y, b.x - 0.2f), to = vec3_make(b.y, a.x, a.y);
        m.index = (int)(i % 2);
        if (i % 4 == 0) /* along an axis */
            to = from +
                 (i % 8 ? 1.0f : -1.0f) * vec3_make(i % 3 == 0, i % 3 == 1, i % 3 == 2);
        const ray r = {.origin = from, .direction = normalize3(to - from)};
        spectrum groups[3];
        const volume_query query = {.ray = &r,
                                    .medium = &m,
                                    .length =
                                        i % 5 ? 0.2f + sampler_1d(&random) : INFINITY,
                                    .w = &w,
                                    .kernel = {KERNEL_EPANECHNIKOV, 1},
                                    .groups = groups,
                                    .n_groups = 3};
        size_t n_weighed;
        spectrum all = volume_map_radiance(map, &query, &n_weighed);
        for (int wavelength = 0; wavelength < N_WAVELENGTHS; wavelength += 3) {
            double whole = 0;
            for (uint32_t tag = 0; tag < 3; tag++) {
                double is = seen(store, radii, &r, &m, (double)query.length, wavelength,
                                 (double)sigma_t[wavelength], tag);
                whole += is;
                g_assert_cmpfloat(fabs((double)groups[tag][wavelength] - is), <,
                                  1e-3 + 1e-3 * is);
            }
            found += (double)all[wavelength];
            expected += whole;
            g_assert_cmpfloat(fabs((double)all[wavelength] - whole), <,
                              1e-3 + 1e-3 * whole);
        }
    }
    g_test_message("all rays: %g, expected %g", found, expected);
    g_assert_cmpfloat(expected, >, 100);
    g_assert_cmpfloat(fabs(found / expected - 1), <, 1e-4);
}

static void test_against_the_sum(void)
{
    static float radii[N_PHOTONS];
    const float nm[] = {300, 900}, sigma_s[] = {0.4f, 3.0f};
    photon_store store = {0}, taken = {0};
    fill(&store, radii);
    fill(&taken, radii);
    medium m = {
        .scale = 1, .g = 0.4f, .scattering = curve_tabulated(nm, sigma_s, 2, NULL)};
    g_autoptr(GError) error = NULL;
    volume_map *map = volume_map_build(&taken, radii, 2, &error);
    g_assert_no_error(error);
    compare_with_sum(map, &store, radii, m);
    for (size_t i = 0; i < N_PHOTONS; i++)
        radii[i] *= 1.5f;
    volume_map *wide = volume_map_widened(map, 1.5f, 2, &error);
    g_assert_no_error(error);
    compare_with_sum(wide, &store, radii, m);
    volume_map_free(wide);
    volume_map_free(map);
    photon_store_clear(&store);
    curve_unref(m.scattering);
}

/* ---- Flux ---- */

static double power_of(const scene *s)
{
    const wavelengths w = wavelengths_at(0.5f);
    const light *l = scene_light(s, 0);
    return (double)spectrum_mean(l->kind->power(l->self, &w));
}

/* A lamp in the middle of a ball of fog: 1 - e^-τ of its light is scattered a first time.
 */
static void test_first_scattering(void)
{
    static const struct {
        double tau;
        const char *fog;
    } cases[] = {{0.1, FOG("f", "0", ".1", ".3")},
                 {1, FOG("f", "0", "1", "0")},
                 {6, FOG("f", "0", "6", "-.4")}};
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autofree char *all =
            g_strconcat(cases[i].fog,
                        "Camera \"perspective\" WorldBegin " BETWEEN(
                            "f", "") "Material \"interface\" " BALL("1") BETWEEN("f", "f")
                            POINT("0 0 0"),
                        NULL);
        g_autoptr(scene) s = scene_of(all);
        transport_plan plan = {.scene = s, .how = settings_default()};
        flux_mean direct = flux_left(&plan, PHOTON_DIRECT, true, 1 << 15);
        double expected = power_of(s) * -expm1(-cases[i].tau);
        g_test_message("tau %g: %g, expected %g", cases[i].tau, direct.mean, expected);
        g_assert_cmpfloat(fabs(direct.mean / expected - 1), <, 2e-3);
    }
}

/* Absorbing fog without end: of albedo a, light is scattered a / (1 - a) times on
   average, the first of them as direct light. */
static void test_series_of_scatterings(void)
{
    g_autoptr(scene) s =
        scene_of(FOG("f", "2", "6", ".5") "Camera \"perspective\" WorldBegin " BETWEEN(
            "f", "") "Material \"interface\" " BALL("9") BETWEEN("f", "f")
                     POINT("0 0 0"));
    transport_plan plan = {.scene = s, .how = settings_default()};
    double direct = flux_left(&plan, PHOTON_DIRECT, true, 1 << 14).mean / power_of(s);
    double later = flux_left(&plan, PHOTON_INDIRECT, true, 1 << 14).mean / power_of(s);
    g_test_message("direct %g of .75, later %g of 2.25", direct, later);
    g_assert_cmpfloat(fabs(direct / 0.75 - 1), <, 5e-3);
    g_assert_cmpfloat(fabs(later / 2.25 - 1), <, 1.5e-2);
}

#define BALL_IN_FOG                                                                      \
    FOG("f", ".1", ".5", ".2")                                                           \
    BETWEEN("", "f")                                                                     \
    "LookAt 0 -3 1  0 0 0.5  0 0 1 Camera \"perspective\" Film \"rgb\" \"integer "       \
    "xresolution\" 32 \"integer yresolution\" 32 WorldBegin\n" BETWEEN(                  \
        "f", "") "Material \"interface\" " BALL("4")                                     \
        BETWEEN("f", "f") "Material \"diffuse\" Shape \"disk\" \"float radius\" 3\n"     \
                          "AttributeBegin Translate 0.3 0 0.8 Material \"dielectric\" "  \
                          "MediumInterface \"\" \"f\" Shape \"sphere\" \"float "         \
                          "radius\" 0.4 AttributeEnd\n"

/* Light through glass, sent uniformly, guided, and toward the glass by area. */
static void test_ways_to_send(void)
{
    static const char *const lamps[] = {
        POINT("0 .2 2.4"),
        "AttributeBegin Translate -.5 .3 2 AreaLightSource \"diffuse\" "
        "Shape \"sphere\" \"float radius\" .2 AttributeEnd\n"};
    for (size_t i = 0; i < G_N_ELEMENTS(lamps); i++) {
        g_autofree char *text = g_strconcat(BALL_IN_FOG, lamps[i], NULL);
        g_autoptr(view) v = view_of(text);
        flux_mean found[3];
        for (int mode = 0; mode < 3; mode++) {
            transport_plan plan = {
                .scene = v->scene, .view = v, .how = settings_default()};
            plan.how.class_emission[PHOTON_CAUSTIC] = mode;
            plan.n_photons[PHOTON_CAUSTIC] = 20000;
            plan.work = (double)INFINITY;
            g_assert_true(aim_caustics(&plan, NULL, NULL, NULL));
            found[mode] = flux_left(&plan, PHOTON_CAUSTIC, true,
                                    mode == EMISSION_UNIFORM ? 1 << 19 : 1 << 16);
            transport_plan_clear(&plan);
            double off = found[mode].mean - found[0].mean;
            double error = hypot(found[mode].error, found[0].error);
            g_test_message("lamp %zu, mode %d: %g +- %g", i, mode, found[mode].mean,
                           found[mode].error);
            g_assert_cmpfloat(found[mode].mean, >, 20 * found[mode].error);
            g_assert_cmpfloat(fabs(off), <, 4 * error);
        }
    }
}

/* ---- Pictures ---- */

#define TWO_LAMPS                                                                        \
    "AttributeBegin Translate -.5 .3 2 AreaLightSource \"diffuse\" \"string group\" "    \
    "\"a\" Shape \"sphere\" \"float radius\" .1 AttributeEnd LightSource \"point\" "     \
    "\"string group\" \"b\" \"point3 from\" [.8 0 2]\n"

static void test_same_bits_on_any_threads(void)
{
    static const char *const hows[] = {"integrator=auto spp=4 passes=2",
                                       "integrator=photonmap spp=2 passes=2 "
                                       "photons=40000 gather_rays=4"};
    g_autoptr(view) v = view_of(BALL_IN_FOG TWO_LAMPS);
    for (size_t i = 0; i < G_N_ELEMENTS(hows); i++) {
        g_autofree char *one = g_strconcat(hows[i], " threads=1", NULL);
        g_autofree char *three = g_strconcat(hows[i], " threads=3", NULL);
        g_autoptr(image) a = render_with(v, one), b = render_with(v, three);
        assert_same_bits(a, b);
        g_assert_cmpfloat(mean_of(a, "caustic"), >, 0);
    }
}

/* The layers of the groups are the picture. */
static void test_groups_are_the_whole(void)
{
    static const char *const hows[] = {
        "integrator=auto spp=4 passes=2",
        "integrator=photonmap spp=2 passes=2 photons=40000 gather_rays=4",
        "integrator=photonmap spp=2 passes=1 photons=40000 final_gather=false "
        "direct_illumination=false"};
    g_autoptr(view) v = view_of(BALL_IN_FOG TWO_LAMPS);
    for (size_t i = 0; i < G_N_ELEMENTS(hows); i++) {
        g_autoptr(image) img = render_with(v, hows[i]);
        double whole = mean_of(img, ""), a = mean_of(img, "light.a"),
               b = mean_of(img, "light.b");
        g_test_message("%s: %g + %g of %g", hows[i], a, b, whole);
        g_assert_cmpfloat(fmin(a, b), >, 0);
        g_assert_cmpfloat(fabs((a + b) / whole - 1), <, 1e-3);
    }
}

/* What the maps say alone, and with light sampled, is the same light, of which there is
   no other: photons do not go on. */
static void test_direct_by_either(void)
{
    g_autoptr(view) v = view_of(BALL_IN_FOG POINT("0 .2 2.4"));
    g_autoptr(image) sampled =
        render_with(v, "integrator=photonmap spp=8 passes=8 photons=200000 "
                       "final_gather=false max_forward_bounces=0");
    g_autoptr(image) mapped =
        render_with(v, "integrator=photonmap spp=8 passes=8 photons=200000 "
                       "final_gather=false max_forward_bounces=0 "
                       "direct_illumination=false");
    double a = mean_of(sampled, "specular"), b = mean_of(mapped, "specular");
    g_test_message("sampled %g, mapped %g", a, b);
    g_assert_cmpfloat(fabs(b / a - 1), <, 0.03);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/volume-map/sum", test_against_the_sum);
    g_test_add_func("/volume-map/first-scattering", test_first_scattering);
    g_test_add_func("/volume-map/series", test_series_of_scatterings);
    g_test_add_func("/volume-map/ways-to-send", test_ways_to_send);
    g_test_add_func("/volume-map/threads", test_same_bits_on_any_threads);
    g_test_add_func("/volume-map/groups", test_groups_are_the_whole);
    g_test_add_func("/volume-map/direct", test_direct_by_either);
    return g_test_run();
}
