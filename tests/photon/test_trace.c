/*
 * The photon pass: flux is neither made nor lost, aimed emission has the flux of plain
 * emission, and an integrating sphere holds what theory says.
 */
#include "base/memory.h"
#include "flux_mean.h"
#include "photon/estimate.h"
#include "photon/trace/trace.h"
#include "scene_text.h"
#include "transport/photonmap/aim.h"
#include "transport/work.h"

#include <string.h>

#define CAMERA                                                                           \
    "Camera \"perspective\" Film \"rgb\" \"integer xresolution\" 8 \"integer "           \
    "yresolution\" 8\n"

/* A closed box of half width 2 around the origin, one sheet for all walls. */
#define BOX                                                                              \
    "Shape \"trianglemesh\" \"point3 P\" [-2 -2 -2 2 -2 -2 2 2 -2 -2 2 -2 -2 -2 2 2 -2 " \
    "2 2 2 2 "                                                                           \
    "-2 2 2] \"integer indices\" [0 1 2 0 2 3 4 6 5 4 7 6 0 5 1 0 4 5 3 2 6 3 6 7 0 3 "  \
    "7 0 7 4 1 "                                                                         \
    "5 6 1 6 2]\n"

static const char *const lights[] = {
    "LightSource \"point\" \"rgb I\" [1 2 3] \"point3 from\" [0.5 0.2 1]\n",
    "LightSource \"spot\" \"rgb I\" [3 2 1] \"point3 from\" [0 0 1.5] \"point3 to\" [0.1 "
    "0 0] "
    "\"float coneangle\" 40 \"float conedeltaangle\" 15\n",
    "AttributeBegin Translate 0 0 1.5 AreaLightSource \"diffuse\" \"rgb L\" [5 5 4] "
    "Shape "
    "\"sphere\" \"float radius\" 0.2 AttributeEnd\n",
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [5 5 4] Shape \"trianglemesh\" "
    "\"point3 P\" [-0.5 -0.5 1.9 -0.5 0.5 1.9 0.5 0.5 1.9 0.5 -0.5 1.9] \"integer "
    "indices\" [0 1 "
    "2 0 2 3] AttributeEnd\n",
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [2 3 4] \"bool twosided\" true "
    "Shape "
    "\"disk\" \"float radius\" 0.4 AttributeEnd\n",
    "LightSource \"distant\" \"rgb L\" [1 1 2] \"point3 from\" [0 1 2] \"point3 to\" [0 "
    "0 0]\n",
    "LightSource \"infinite\" \"rgb L\" [1 1 1]\n",
};

static settings quick_settings(void)
{
    settings how = settings_default();
    how.threads = 2;
    return how;
}

static trace_task task_for(const scene *s, const settings *how, photon_class c,
                           uint64_t n)
{
    return (trace_task){.scene = s,
                        .how = how,
                        .w = wavelengths_at(0.5f),
                        .photon_class = c,
                        .n_photons = n};
}

static spectrum power_of_lights(const scene *s, const wavelengths *w)
{
    spectrum sum = {0};
    for (unsigned i = 0; i < s->lights->len; i++) {
        const light *l = scene_light(s, (int)i);
        sum += l->kind->power(l->self, w);
    }
    return sum;
}

/* On surfaces. */
static flux_mean stored_flux(const scene *s, const settings *how, photon_class c,
                             uint64_t n)
{
    const transport_plan plan = {.scene = s, .how = *how};
    return flux_left(&plan, c, false, n);
}

static void test_emitted_flux_is_the_power(void)
{
    for (size_t i = 0; i < G_N_ELEMENTS(lights); i++) {
        g_autofree char *text = g_strconcat(CAMERA "WorldBegin\n" BOX, lights[i], NULL);
        g_autoptr(scene) s = scene_of(text);
        wavelengths w = wavelengths_at(0.5f);
        spectrum power = power_of_lights(s, &w), sum = {0};
        enum { N = 1 << 14 };
        for (uint32_t k = 0; k < N; k++) {
            sampler random = sampler_make(i, k);
            photon_start start = {0};
            if (photon_emit(s, &w, NULL, &random, &start))
                sum += start.flux / N;
        }
        for (int wavelength = 0; wavelength < N_WAVELENGTHS; wavelength++)
            g_assert_cmpfloat(fabsf(sum[wavelength] / power[wavelength] - 1.0f), <,
                              5e-3f);
    }
}

/* Lights inside a closed box: every photon lands on its walls. */
static void test_direct_map_holds_all_flux(void)
{
    settings how = quick_settings();
    for (size_t i = 0; i < 5; i++) {
        g_autofree char *text = g_strconcat(CAMERA "WorldBegin\n" BOX, lights[i], NULL);
        g_autoptr(scene) s = scene_of(text);
        wavelengths w = wavelengths_at(0.5f);
        flux_mean found = stored_flux(s, &how, PHOTON_DIRECT, 1 << 15);
        double power = (double)spectrum_mean(power_of_lights(s, &w));
        g_test_message("light %zu: stored %g of %g W", i, found.mean, power);
        g_assert_cmpfloat(fabs(found.mean / power - 1.0), <, 5e-3);
    }
}

/* In a closed box of albedo ρ each bounce leaves ρ: indirect flux is Φ ρ/(1-ρ). */
static void test_indirect_flux_is_a_geometric_series(void)
{
    for (int roulette = 0; roulette < 2; roulette++) {
        settings how = quick_settings();
        how.roulette = roulette;
        g_autofree char *text = g_strconcat(
            CAMERA
            "WorldBegin Material \"diffuse\" \"rgb reflectance\" [0.7 0.7 0.7]\n" BOX,
            lights[0], NULL);
        g_autoptr(scene) s = scene_of(text);
        wavelengths w = wavelengths_at(0.5f);
        flux_mean found = stored_flux(s, &how, PHOTON_INDIRECT, 1 << 15);
        double expected = (double)spectrum_mean(power_of_lights(s, &w)) * 0.7 / 0.3;
        g_test_message("indirect %g, expected %g", found.mean, expected);
        g_assert_cmpfloat(fabs(found.mean / expected - 1.0), <, 1e-2);
    }
}

/* White walls keep photons for ever: after many bounces some are taken out, and the
   others stand for them. */
static void test_long_ways(void)
{
    settings how = quick_settings();
    g_autofree char *white = g_strconcat(
        CAMERA "WorldBegin Material \"diffuse\" \"rgb reflectance\" [1 1 1]\n" BOX,
        lights[0], NULL);
    g_autofree char *nearly = g_strconcat(
        CAMERA
        "WorldBegin Material \"diffuse\" \"rgb reflectance\" [.993 .993 .993]\n" BOX,
        lights[0], NULL);
    g_autoptr(scene) endless = scene_of(white), s = scene_of(nearly);
    g_assert_cmpfloat(stored_flux(endless, &how, PHOTON_INDIRECT, 1 << 8).mean, >, 0);
    wavelengths w = wavelengths_at(0.5f);
    double expected = (double)spectrum_mean(power_of_lights(s, &w)) * 0.993 / 0.007;
    flux_mean found = stored_flux(s, &how, PHOTON_INDIRECT, 1 << 17);
    g_test_message("indirect %g +- %g, expected %g", found.mean, found.error, expected);
    g_assert_cmpfloat(fabs(found.mean / expected - 1.0), <, 0.01);
}

static void test_bounce_limit_counts_scattering(void)
{
    settings how = quick_settings();
    g_autofree char *text = g_strconcat(
        CAMERA "WorldBegin Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n" BOX,
        lights[0], NULL);
    g_autoptr(scene) s = scene_of(text);
    wavelengths w = wavelengths_at(0.5f);
    double power = (double)spectrum_mean(power_of_lights(s, &w));
    for (int limit = 0; limit < 4; limit++) {
        how.max_forward_bounces = limit;
        double expected = power * (1.0 - pow(0.5, limit));
        double found = stored_flux(s, &how, PHOTON_INDIRECT, 1 << 14).mean;
        g_assert_cmpfloat(fabs(found - expected), <, 0.02 * power);
    }
}

/* Glass and mirrors, some behind others, in the box. */
#define CASTERS                                                                          \
    "AttributeBegin Translate 0.3 0 -0.5 Material \"dielectric\" Shape \"sphere\" "      \
    "\"float radius\" "                                                                  \
    "0.5 AttributeEnd AttributeBegin Translate -1 0.4 0 Material \"conductor\" \"float " \
    "roughness\" "                                                                       \
    "0.05 Shape \"sphere\" \"float radius\" 0.3 AttributeEnd AttributeBegin Translate "  \
    "0 0 -1.4 "                                                                          \
    "Material \"thindielectric\" Shape \"disk\" \"float radius\" 0.8 AttributeEnd\n"

static void test_aimed_emission_has_the_same_flux(void)
{
    for (size_t i = 0; i < G_N_ELEMENTS(lights); i++) {
        settings how = quick_settings();
        /* distant and infinite light comes from outside: a floor instead of the box */
        const char *walls =
            i < 5 ? BOX : "Shape \"disk\" \"float height\" -2 \"float radius\" 5\n";
        g_autofree char *text =
            g_strconcat(CAMERA "WorldBegin\n", walls, CASTERS, lights[i], NULL);
        g_autoptr(view) v = view_of(text);
        how.class_emission[PHOTON_CAUSTIC] = EMISSION_UNIFORM;
        flux_mean plain = stored_flux(v->scene, &how, PHOTON_CAUSTIC, 1 << 19);
        how.class_emission[PHOTON_CAUSTIC] = EMISSION_SPECULAR_AREA;
        flux_mean aimed = stored_flux(v->scene, &how, PHOTON_CAUSTIC, 1 << 16);
        double error = sqrt(plain.error * plain.error + aimed.error * aimed.error);
        g_test_message("light %zu: uniform %g +- %g, aimed %g +- %g", i, plain.mean,
                       plain.error, aimed.mean, aimed.error);
        transport_plan plan = {.scene = v->scene, .view = v, .how = how};
        plan.how.class_emission[PHOTON_CAUSTIC] = EMISSION_GUIDED;
        plan.n_photons[PHOTON_CAUSTIC] = 1;
        plan.work = (double)INFINITY;
        g_assert_true(aim_caustics(&plan, NULL, NULL, NULL));
        flux_mean guided = flux_left(&plan, PHOTON_CAUSTIC, false, 1 << 17);
        transport_plan_clear(&plan);
        double guided_error =
            sqrt(plain.error * plain.error + guided.error * guided.error);
        g_test_message("guided %g +- %g", guided.mean, guided.error);
        g_assert_cmpfloat(fabs(plain.mean - guided.mean), <, 5 * guided_error);
        g_assert_cmpfloat(plain.mean, >, 0);
        g_assert_cmpfloat(fabs(plain.mean - aimed.mean), <, 5 * error);
        g_assert_cmpfloat(error, <, 0.03 * plain.mean);
    }
}

/* Point light Φ in the middle of a diffuse sphere: the indirect irradiance is everywhere
   Φ/(4πR²) ρ/(1-ρ). A ball of radius r cuts a cap of area exactly πr² from a sphere. */
/* Where few photons land a guide sends most of them, and the flux is the same. */
static void test_guided_emission_has_the_same_flux(void)
{
    static const char cup[] = "Shape \"sphere\" \"float radius\" .4 \"float zmax\" 0\n";
    int n_guided = 0;
    for (size_t i = 0; i < 2 * G_N_ELEMENTS(lights); i++) {
        photon_class c = i % 2 == 0 ? PHOTON_DIRECT : PHOTON_INDIRECT;
        g_autofree char *text = g_strconcat(CAMERA "WorldBegin\n", lights[i / 2],
                                            "Translate .1 0 -1.5\n", cup, NULL);
        g_autoptr(view) v = view_of(text);
        transport_plan plan = {.scene = v->scene, .view = v, .how = quick_settings()};
        plan.work = (double)INFINITY;
        flux_mean plain = stored_flux(v->scene, &plan.how, c, 1 << 20);
        g_assert_true(aim_photons(&plan, c, NULL, NULL));
        flux_mean guided = flux_left(&plan, c, false, 1 << 17);
        n_guided += plan.guide[c] != NULL;
        transport_plan_clear(&plan);
        g_test_message("light %zu, class %d: %g +- %g, %g +- %g", i / 2, c, plain.mean,
                       plain.error, guided.mean, guided.error);
        g_assert_cmpfloat(plain.mean, >, 20 * plain.error);
        g_assert_cmpfloat(fabs(plain.mean - guided.mean), <,
                          5 * hypot(plain.error, guided.error));
    }
    g_assert_cmpint(n_guided, >, (int)G_N_ELEMENTS(lights));
}

/* In a closed box that scatters a half one is sent, scattered once more in the mean, and
   lands once behind a diffuse bounce. */
static void test_price(void)
{
    g_autofree char *text = g_strconcat(CAMERA "WorldBegin\n", BOX, lights[0], NULL);
    g_autoptr(view) v = view_of(text);
    transport_plan plan = {.scene = v->scene, .view = v, .how = quick_settings()};
    plan.work = (double)INFINITY;
    g_assert_true(aim_photons(&plan, PHOTON_INDIRECT, NULL, NULL));
    double price = plan.price[PHOTON_INDIRECT], expected = 1 + 2 + SAMPLE_RAYS;
    g_test_message("%g rays, expected %g", price, expected);
    g_assert_cmpfloat(fabs(price / expected - 1), <, .02);
    transport_plan_clear(&plan);
}

static void test_integrating_sphere(void)
{
    settings how = quick_settings();
    g_autoptr(scene) s =
        scene_of(CAMERA "WorldBegin LightSource \"point\" \"rgb I\" [1 1 1]\n"
                        "Material \"diffuse\" \"rgb reflectance\" [0.6 0.6 0.6]\n"
                        "Shape \"sphere\" \"float radius\" 3\n");
    trace_task task = task_for(s, &how, PHOTON_INDIRECT, 200000);
    trace_result result;
    g_assert_true(photon_trace(&task, false, &result, NULL));
    g_autoptr(photon_map) map =
        photon_map_build(MAP_GRID, &result.photons, 0.5f, (workers){.threads = 2}, NULL);
    memset(&result.photons, 0, sizeof result.photons);
    trace_result_clear(&result);
    spectrum power = power_of_lights(s, &task.w);
    double expected = (double)spectrum_mean(power) / (4.0 * G_PI * 9.0) * 0.6 / 0.4,
           found = 0;
    estimate_options options = {
        .kernel = {KERNEL_CONSTANT, 1}, .radius = 0.5f, .flatten = 1};
    estimate_scratch scratch = {0};
    enum { POINTS = 200 };
    for (uint32_t i = 0; i < POINTS; i++) {
        sampler random = sampler_make(4, i);
        float z = 2.0f * sampler_1d(&random) - 1.0f,
              phi = 2.0f * PI_F * sampler_1d(&random);
        float r = sqrtf(1.0f - z * z);
        vec3 n = vec3_make(r * cosf(phi), r * sinf(phi), z);
        found += (double)spectrum_mean(
                     photon_irradiance(map, 3.0f * n, -n, &options, &scratch, NULL)) /
                 POINTS;
    }
    estimate_scratch_clear(&scratch);
    g_test_message("irradiance %g, expected %g", found, expected);
    g_assert_cmpfloat(fabs(found / expected - 1.0), <, 0.01);
}

static void test_trace_is_the_same_on_any_number_of_threads(void)
{
    g_autofree char *text =
        g_strconcat(CAMERA "WorldBegin\n" BOX CASTERS, lights[2], NULL);
    g_autoptr(scene) s = scene_of(text);
    g_autoptr(caustic_casters) casters = caustic_casters_new(s, NULL);
    settings one = quick_settings(), two = quick_settings();
    one.threads = 1;
    two.threads = 3;
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        trace_result a, b;
        trace_task task = task_for(s, &one, (photon_class)c, 20000);
        task.casters = casters;
        g_assert_true(photon_trace(&task, true, &a, NULL));
        task.how = &two;
        g_assert_true(photon_trace(&task, true, &b, NULL));
        g_assert_cmpuint(a.photons.n, ==, b.photons.n);
        g_assert_cmpmem(a.photons.x, a.photons.n * 4, b.photons.x, b.photons.n * 4);
        g_assert_cmpmem(a.photons.flux, a.photons.n * 32, b.photons.flux,
                        b.photons.n * 32);
        g_assert_cmpmem(a.photons.normal, a.photons.n * 4, b.photons.normal,
                        b.photons.n * 4);
        trace_result_clear(&a);
        trace_result_clear(&b);
    }
}

static void test_refused_memory_is_an_error(void)
{
    g_autofree char *text = g_strconcat(CAMERA "WorldBegin\n" BOX, lights[0], NULL);
    g_autoptr(scene) s = scene_of(text);
    settings how = quick_settings();
    how.threads = 1;
    bool failed = true;
    for (unsigned n = 1; failed; n++) {
        g_autoptr(GError) error = NULL;
        trace_task task = task_for(s, &how, PHOTON_DIRECT, 5000);
        trace_result result;
        big_alloc_fail_at(n);
        failed = !photon_trace(&task, true, &result, &error);
        big_alloc_fail_at(0);
        if (failed)
            g_assert_error(error, NEPH_ERROR, ERROR_FAILED);
        trace_result_clear(&result);
        g_assert_cmpuint(n, <, 200);
    }
}

/* ---- What each photon is and does ---- */

typedef struct first_scatter {
    double emitted, mirrored; /* flux */
    bool met;                 /* a surface */
} first_scatter;

static void note_mirrored(const photon_event *event, void *data)
{
    first_scatter *f = data;
    double flux = (double)spectrum_mean(event->flux);
    if (event->kind == PHOTON_EMITTED) {
        f->emitted += flux;
        f->met = false;
    } else if (event->kind == PHOTON_SCATTERED && !f->met) {
        f->met = true;
        f->mirrored += event->lobe & LOBE_SPECULAR ? flux : 0;
    }
}

/* Indirect photons are mirrored by what is smooth: straight onto plastic of index 1.5,
   one in 25 of their flux. */
static void test_indirect_photons_take_mirrors(void)
{
    settings how = quick_settings();
    g_autoptr(scene) s = scene_of(
        CAMERA "WorldBegin LightSource \"point\" \"rgb I\" [1 1 1]\n"
               "Material \"coateddiffuse\" \"rgb reflectance\" [0.5 0.5 0.5] \"float "
               "roughness\" 0 \"float eta\" 1.5 Shape \"sphere\" \"float radius\" 3\n");
    enum { PHOTONS = 100000 };
    trace_task task = task_for(s, &how, PHOTON_INDIRECT, PHOTONS);
    first_scatter sum = {0};
    for (uint64_t i = 0; i < PHOTONS; i++)
        photon_tell(&task, i, note_mirrored, &sum);
    g_test_message("mirrored %g of the flux", sum.mirrored / sum.emitted);
    g_assert_cmpfloat(fabs(sum.mirrored / sum.emitted / 0.04 - 1), <, 0.08);
}

#define SUN_ON_DISK(motion)                                                              \
    CAMERA "WorldBegin LightSource \"distant\" \"point3 from\" [0 0 2] "                 \
           "\"rgb L\" [1 1 1] " motion " Shape \"disk\" \"float radius\" 1\n"

static double direct_flux(const char *text)
{
    settings how = quick_settings();
    g_autoptr(scene) s = scene_of(text);
    trace_task task = task_for(s, &how, PHOTON_DIRECT, 200000);
    task.n_slices = 1;
    trace_result result;
    double sum = 0;
    g_assert_true(photon_trace(&task, false, &result, NULL));
    for (size_t i = 0; i < result.photons.n; i++)
        sum += (double)spectrum_mean(result.photons.flux[i]);
    trace_result_clear(&result);
    return sum;
}

/* A disk that grows threefold is kept as it is at half time, when it is twice as large:
   light falls on it as on one that always is. */
static void test_photons_on_what_grows(void)
{
    double grows = direct_flux(
        SUN_ON_DISK("ActiveTransform EndTime Scale 3 3 1 ActiveTransform All"));
    double stays = direct_flux(SUN_ON_DISK("Scale 2 2 1"));
    g_test_message("flux %g, on a disk that stays %g", grows, stays);
    g_assert_cmpfloat(fabs(grows / stays - 1), <, 0.015);
}

static void note_direction(const photon_event *event, void *data)
{
    if (event->kind == PHOTON_EMITTED)
        *(vec3 *)data = event->direction;
}

/* What a guide learns from is where the photon of that index starts, however large. */
static void test_start_points_are_the_photons_own(void)
{
    static const uint64_t indices[] = {5, 300, 70005, ((uint64_t)1 << 32) + 5};
    settings how = quick_settings();
    g_autoptr(scene) s =
        scene_of(CAMERA "WorldBegin LightSource \"point\" \"rgb I\" [1 1 1]\n"
                        "Shape \"sphere\" \"float radius\" 3\n");
    trace_task task = task_for(s, &how, PHOTON_DIRECT, (uint64_t)1 << 34);
    for (size_t i = 0; i < G_N_ELEMENTS(indices); i++) {
        float u[EMISSION_DIMENSIONS];
        vec3 direction = {0};
        light_emission e;
        const light *lamp = scene_light(s, 0);
        g_assert_cmpfloat(fabsf(photon_start_point(&task, indices[i], u) - 1), <, 1e-6f);
        photon_tell(&task, indices[i], note_direction, &direction);
        g_assert_true(lamp->kind->emit(lamp->self, &task.w, u[1], (vec2){u[2], u[3]},
                                       (vec2){u[4], u[5]}, &e));
        g_assert_cmpfloat(length3(e.ray.direction - direction), <, 1e-6f);
    }
}

/* A lamp apart from the glass sends into the cone that it sees it in: flux over density
   is its intensity, for each photon. */
static void test_flux_into_the_cone(void)
{
    settings how = quick_settings();
    g_autoptr(scene) s =
        scene_of(CAMERA "WorldBegin LightSource \"point\" \"rgb I\" [1 1 1] \"point3 "
                        "from\" [0 0 5]\n"
                        "Material \"dielectric\" Shape \"sphere\" \"float radius\" 1\n");
    g_autoptr(caustic_casters) casters = caustic_casters_new(s, NULL);
    trace_task task = task_for(s, &how, PHOTON_CAUSTIC, 1);
    double intensity = (double)spectrum_mean(power_of_lights(s, &task.w)) / (4 * G_PI);
    for (uint64_t i = 0; i < 100; i++) {
        sampler random = sampler_make(7, i);
        photon_start at = {0};
        g_assert_true(photon_emit_caustic(casters, &task.w, NULL, &random, &at));
        double found = (double)spectrum_mean(at.flux) *
                       (double)photon_cone_pdf(casters, at.ray.origin);
        g_assert_cmpfloat(fabs(found / intensity - 1), <, 1e-4);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/trace/emitted-flux", test_emitted_flux_is_the_power);
    g_test_add_func("/trace/direct-flux", test_direct_map_holds_all_flux);
    g_test_add_func("/trace/indirect-flux", test_indirect_flux_is_a_geometric_series);
    g_test_add_func("/trace/bounce-limit", test_bounce_limit_counts_scattering);
    g_test_add_func("/trace/long-ways", test_long_ways);
    g_test_add_func("/trace/aimed-flux", test_aimed_emission_has_the_same_flux);
    g_test_add_func("/trace/guided-flux", test_guided_emission_has_the_same_flux);
    g_test_add_func("/trace/price", test_price);
    g_test_add_func("/trace/integrating-sphere", test_integrating_sphere);
    g_test_add_func("/trace/mirrors", test_indirect_photons_take_mirrors);
    g_test_add_func("/trace/growing", test_photons_on_what_grows);
    g_test_add_func("/trace/start-points", test_start_points_are_the_photons_own);
    g_test_add_func("/trace/cone-flux", test_flux_into_the_cone);
    g_test_add_func("/trace/threads", test_trace_is_the_same_on_any_number_of_threads);
    g_test_add_func("/trace/memory", test_refused_memory_is_an_error);
    return g_test_run();
}
