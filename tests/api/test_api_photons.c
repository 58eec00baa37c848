/*
 * What a window on a scene asks about photons, by the installed header: their paths, what
 * an estimate makes of them, and those that fog scattered.
 */
#include "api_scene.h"

/* Settings of a render that sends photons of all classes. */
static NephSettings *sending_all(const NephScene *scene)
{
    NephSettings *settings = neph_scene_settings(scene);
    neph_settings_set(settings, "integrator", "photonmap", NULL);
    neph_settings_set(settings, "direct_illumination", "off", NULL);
    return settings;
}

static NephPhotons *trace(const NephScene *scene, const char *photons)
{
    g_autoptr(NephSettings) settings = sending_all(scene);
    g_autoptr(GError) error = NULL;
    neph_settings_set(settings, "photons", photons, NULL);
    NephPhotons *traced = neph_photons_trace(scene, settings, &error);
    g_assert_no_error(error);
    return traced;
}

/* Of every photon, the path told passes where it landed, after as many bounces. */
static void test_photon_paths(void)
{
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    g_autoptr(NephPhotons) photons = trace(scene, "600");
    NephPhotonEvent events[64];
    size_t n = neph_photons_count(photons), per_class[NEPH_N_PHOTON_CLASSES] = {0};
    g_assert_cmpuint(neph_photons_path(photons, 0, events, 64), ==, 0);
    g_assert_true(neph_photons_follow(photons, NULL, NULL, NULL));
    for (size_t i = 0; i < n; i++) {
        NephPhoton p;
        neph_photons_get(photons, i, &p);
        per_class[p.photon_class]++;
        g_assert_true((p.bounces == 0) == (p.photon_class == NEPH_PHOTON_DIRECT));
        size_t n_events = MIN(neph_photons_path(photons, i, events, 64), 64);
        g_assert_cmpuint(n_events, >, 1);
        g_assert_cmpint(events[0].kind, ==, NEPH_PHOTON_EMITTED);
        bool landed = false, is_full = false;
        uint32_t bounces = 0;
        for (size_t k = 0; k < n_events && !landed; k++) {
            bounces += events[k].kind == NEPH_PHOTON_SCATTERED;
            landed = events[k].kind == NEPH_PHOTON_STORED && bounces == p.bounces &&
                     memcmp(events[k].position, p.position, sizeof p.position) == 0;
            is_full = landed;
            for (int axis = 0; axis < 3 && landed; axis++) {
                float off = p.direction[axis] + events[k].direction[axis];
                is_full &= !(off < 0.0f) && !(off > 0.0f);
            }
        }
        g_assert_true((landed && is_full) || n_events == 64);
    }
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++)
        g_assert_cmpuint(per_class[c], >, 0);
}

/* What is not there is told to be so. */
static void test_beyond_the_last(void)
{
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    g_autoptr(NephPhotons) photons = trace(scene, "600");
    g_assert_true(neph_photons_follow(photons, NULL, NULL, NULL));
    size_t n = neph_photons_count(photons);
    const size_t beyond[] = {n, n + 1, 2 * n, SIZE_MAX};
    NephPhotonEvent events[4];
    for (size_t k = 0; k < G_N_ELEMENTS(beyond); k++) {
        NephPhoton p = {.bounces = 7}, none = {.bounces = 0};
        g_assert_false(neph_photons_get(photons, beyond[k], &p));
        g_assert_cmpmem(&p, sizeof p, &none, sizeof none);
        g_assert_cmpstr(neph_photons_medium(photons, beyond[k]), ==, "");
        g_assert_cmpuint(neph_photons_path(photons, beyond[k], events, 4), ==, 0);
        g_assert_null(neph_scene_material_name(scene, beyond[k]));
        g_assert_null(neph_scene_material_kind(scene, beyond[k]));
        g_assert_null(neph_bsdf_plot(scene, beyond[k], 30.0, 8, NULL));
    }
    NephPhoton last;
    g_assert_true(neph_photons_get(photons, n - 1, &last));
}

static bool never(void *data)
{
    ++*(int *)data;
    return false;
}

static void test_photons_cancelled(void)
{
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    g_autoptr(NephSettings) settings = neph_scene_settings(scene);
    g_autoptr(GError) error = NULL, again = NULL;
    int asked = 0;
    neph_settings_set(settings, "photons", "1000000", NULL);
    g_assert_null(neph_photons_trace_while(scene, settings, never, &asked, &error));
    g_assert_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_CANCELLED);
    g_assert_cmpint(asked, >, 0);
    g_autoptr(NephPhotons) photons = trace(scene, "60000");
    g_assert_false(neph_photons_follow(photons, never, &asked, &again));
    g_assert_error(again, NEPH_ERROR_DOMAIN, NEPH_ERROR_CANCELLED);
    g_assert_true(neph_photons_follow(photons, NULL, NULL, NULL));
}

/* Inside a sphere of radius 3 around a lamp of 10 W/sr, E = I / r² everywhere. About 400
   photons weigh in, so that the tolerance is more than five standard deviations. */
static NephScene *make_bright_sphere(const char *more)
{
    g_autofree char *head = g_strdup("Camera \"perspective\"\n");
    g_autofree char *path = write_scene("scene.pbrt", head);
    g_autofree char *text = NULL;
    g_assert_true(g_file_get_contents(path, &text, NULL, NULL));
    memcpy(strstr(text, "0 1.8 0"), "0 0.0 0", 7);
    *strstr(text, "NamedMaterial \"glass\"\n") = '\0';
    g_autofree char *all = g_strconcat(text, more, NULL);
    g_assert_true(g_file_set_contents(path, all, -1, NULL));
    return load(path);
}

static double luminance(const double rgb[3])
{
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

static void test_estimate(void)
{
    g_autoptr(NephScene) scene = make_bright_sphere("");
    g_autoptr(NephPhotons) photons = trace(scene, "120000");
    const double at[3] = {0, -3, 0}, up[3] = {0, 1, 0}, down[3] = {0, -1, 0};
    NephEstimate e;
    neph_photons_estimate(photons, at, up, 0.5, &e);
    g_assert_cmpuint(e.n[NEPH_PHOTON_DIRECT], >, 100);
    g_assert_cmpfloat_with_epsilon(luminance(e.irradiance[0]), 10.0 / 9.0, 0.33);
    neph_photons_estimate(photons, at, down, 0.5, &e);
    g_assert_cmpuint(e.n[NEPH_PHOTON_DIRECT], ==, 0);
    g_assert_true(neph_photons_follow(photons, NULL, NULL, NULL));
    neph_photons_estimate(photons, at, up, 0.0, &e);
    g_assert_cmpfloat(e.radius[NEPH_PHOTON_DIRECT], >, 0.0);
}

/* Where a speck moves there are photons of eight slices of time, each with all light: it
   is no brighter for it, nor if the nearest are asked for. */
static void test_estimate_of_slices(void)
{
    g_autoptr(NephScene) scene = make_bright_sphere(
        "ActiveTransform EndTime Translate .2 0 0 ActiveTransform All Shape \"sphere\" "
        "\"float radius\" .001\n");
    g_autoptr(NephSettings) settings = sending_all(scene);
    const double at[3] = {0, -3, 0}, up[3] = {0, 1, 0};
    neph_settings_set(settings, "photons", "120000", NULL);
    for (int k = 0; k < 2; k++) {
        g_autoptr(NephPhotons) photons = neph_photons_trace(scene, settings, NULL);
        NephEstimate e;
        neph_photons_estimate(photons, at, up, k == 0 ? 0.5 : 0.0, &e);
        g_assert_cmpuint(e.n[NEPH_PHOTON_DIRECT], >, 100);
        g_assert_cmpfloat_with_epsilon(luminance(e.irradiance[0]), 10.0 / 9.0, 0.33);
        neph_settings_set(settings, "direct_nearest", "50", NULL);
    }
}

static double distance_to(const NephPhotons *photons, size_t i, const double at[3])
{
    NephPhoton p;
    neph_photons_get(photons, i, &p);
    double sum = 0.0;
    for (int k = 0; k < 3; k++)
        sum += ((double)p.position[k] - at[k]) * ((double)p.position[k] - at[k]);
    return sqrt(sum);
}

static void test_neighbours(void)
{
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    g_autoptr(NephPhotons) photons = trace(scene, "20000");
    const double at[3] = {0, -3, 0}, up[3] = {0, 1, 0};
    size_t index[20];
    NephEstimate e;
    size_t n = neph_photons_near(photons, at, up, 0.5, index, 20);
    neph_photons_estimate(photons, at, up, 0.5, &e);
    g_assert_cmpuint(n, ==, e.n[0] + e.n[1] + e.n[2]);
    g_assert_cmpuint(n, >, 20);
    for (size_t i = 0; i < 20; i++) {
        g_assert_cmpfloat(distance_to(photons, index[i], at), <, 0.5);
        if (i > 0)
            g_assert_cmpfloat(distance_to(photons, index[i - 1], at), <=,
                              distance_to(photons, index[i], at));
    }
}

/* Where renders look for the nearest, so does an estimate without a radius of its own:
   the last of them is the radius and is not counted. */
static void test_nearest(void)
{
    enum { K = 12 };
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    g_autoptr(NephSettings) settings = neph_scene_settings(scene);
    g_assert_true(neph_settings_set(settings, "photons", "20000", NULL));
    g_assert_true(neph_settings_set(settings, "indirect_nearest", "12", NULL));
    g_autoptr(NephPhotons) photons = neph_photons_trace(scene, settings, NULL);
    const double at[3] = {0, -3, 0}, up[3] = {0, 1, 0};
    size_t n_near = 0, index[K];
    NephEstimate e;
    neph_photons_estimate(photons, at, up, 0.0, &e);
    g_assert_cmpuint(e.n[NEPH_PHOTON_INDIRECT], ==, K - 1);
    for (size_t i = 0; i < neph_photons_count(photons); i++) {
        NephPhoton p;
        neph_photons_get(photons, i, &p);
        n_near += p.photon_class == NEPH_PHOTON_INDIRECT && p.direction[1] > 0.0f &&
                  distance_to(photons, i, at) <= 1.00001 * e.radius[NEPH_PHOTON_INDIRECT];
    }
    g_assert_cmpuint(n_near, ==, K);
    g_assert_cmpuint(neph_photons_near(photons, at, up, 0.0, index, K), ==,
                     e.n[0] + e.n[1] + e.n[2]);
}

/* ---- Photons in media ---- */

/* Fog of 0.2 scatterings a metre in all of the scene. */
static NephScene *make_foggy_scene(const char *lamp_at, bool glass)
{
    g_autofree char *path = write_scene(
        "foggy.pbrt", "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n"
                      "    \"spectrum sigma_a\" [300 0 900 0]\n"
                      "    \"spectrum sigma_s\" [300 0.2 900 0.2]\n"
                      "MediumInterface \"fog\" \"fog\"\n"
                      "Camera \"perspective\"\n");
    g_autofree char *text = NULL;
    g_assert_true(g_file_get_contents(path, &text, NULL, NULL));
    memcpy(strstr(text, "0 1.8 0"), lamp_at, 7);
    if (!glass)
        *strstr(text, "NamedMaterial \"glass\"\n") = '\0';
    g_assert_true(g_file_set_contents(path, text, -1, NULL));
    return load(path);
}

static bool in_fog(const NephPhotons *photons, size_t i)
{
    const char *medium = neph_photons_medium(photons, i);
    g_assert_true(!*medium || strcmp(medium, "fog") == 0);
    return *medium != '\0';
}

/* More than any path through white fog has. */
enum { MOST_EVENTS = 4096 };

/* The event of its path that photon i is. */
static const NephPhotonEvent *event_of(const NephPhotons *photons, size_t i,
                                       NephPhotonEvent events[MOST_EVENTS])
{
    NephPhoton p;
    neph_photons_get(photons, i, &p);
    size_t n = MIN(neph_photons_path(photons, i, events, MOST_EVENTS), MOST_EVENTS);
    uint32_t bounces = 0;
    for (size_t k = 0; k < n; k++) {
        const NephPhotonEvent *e = &events[k];
        bounces += e->kind == NEPH_PHOTON_SCATTERED;
        if (e->kind == NEPH_PHOTON_STORED && bounces == p.bounces &&
            memcmp(e->position, p.position, sizeof p.position) == 0 &&
            memcmp(e->rgb, p.rgb, sizeof p.rgb) == 0)
            return e;
    }
    return NULL;
}

/* Photons in fog are among those of their class, each with the path that left it. */
static void test_fog_paths(void)
{
    g_autoptr(NephScene) scene = make_foggy_scene("0 1.8 0", true);
    g_autoptr(NephPhotons) photons = trace(scene, "3000");
    NephPhotonEvent events[MOST_EVENTS];
    NephStatistics s;
    size_t n[NEPH_N_PHOTON_CLASSES][2] = {0}, n_all = neph_photons_count(photons);
    const double middle[3] = {0, 0, 0};
    int last = 0;
    g_assert_true(neph_photons_follow(photons, NULL, NULL, NULL));
    for (size_t i = 0; i < n_all; i++) {
        NephPhoton p;
        neph_photons_get(photons, i, &p);
        bool fog = in_fog(photons, i);
        g_assert_cmpint((int)p.photon_class, >=, last);
        last = (int)p.photon_class;
        n[p.photon_class][fog]++;
        double r = distance_to(photons, i, middle);
        g_assert_true(fog ? r < 3.0 : fabs(r - 3.0) < 1e-3);
        const NephPhotonEvent *event = event_of(photons, i, events);
        g_assert_nonnull(event);
        g_assert_cmpstr(event->material, ==, fog ? "fog" : "walls");
        for (const NephPhotonEvent *e = events; e < event; e++)
            if (e->kind == NEPH_PHOTON_SCATTERED)
                g_assert_true(!strcmp(e->material, "fog") ==
                              !strcmp(e->what, "scattered"));
    }
    neph_photons_statistics(photons, &s);
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++) {
        g_assert_cmpuint(n[c][false], >, 0);
        g_assert_cmpuint(n[c][true], >, 0);
        g_assert_cmpuint(s.stored[c], ==, n[c][false] + n[c][true]);
    }
}

/* Each way from the lamp leaves 1 - e^-0.6 of its light in the fog, wherever on it: the
   density of places is in proportion to what they scatter. */
static void test_fog_flux(void)
{
    g_autoptr(NephScene) scene = make_foggy_scene("0 0.0 0", false);
    g_autoptr(NephPhotons) photons = trace(scene, "2000");
    NephPhotonEvent events[MOST_EVENTS];
    NephStatistics s;
    size_t n = 0;
    neph_photons_statistics(photons, &s);
    g_assert_true(neph_photons_follow(photons, NULL, NULL, NULL));
    for (size_t i = 0; i < neph_photons_count(photons); i++) {
        NephPhoton p;
        neph_photons_get(photons, i, &p);
        if (p.photon_class != NEPH_PHOTON_DIRECT || !in_fog(photons, i))
            continue;
        n++;
        g_assert_cmpuint(neph_photons_path(photons, i, events, 256), >, 1);
        g_assert_cmpfloat_with_epsilon(p.rgb[1] / events[0].rgb[1], 1.0f - expf(-0.6f),
                                       1e-3f);
    }
    g_assert_cmpuint(n, ==, s.emitted[NEPH_PHOTON_DIRECT]);
}

/* What hangs in the fog before a wall does not light it. */
static void test_fog_estimate(void)
{
    g_autoptr(NephScene) scene = make_foggy_scene("0 0.0 0", false);
    g_autoptr(NephPhotons) photons = trace(scene, "60000");
    const double at[3] = {0, -3, 0}, up[3] = {0, 1, 0};
    size_t index[4096], in_reach = 0, hanging = 0;
    NephEstimate e;
    for (size_t i = 0; i < neph_photons_count(photons); i++) {
        NephPhoton p;
        neph_photons_get(photons, i, &p);
        bool near = p.direction[1] > 0.0f && distance_to(photons, i, at) < 0.5;
        in_reach += near && !in_fog(photons, i);
        hanging += near && in_fog(photons, i);
    }
    g_assert_cmpuint(hanging, >, 50);
    neph_photons_estimate(photons, at, up, 0.5, &e);
    g_assert_cmpuint(e.n[0] + e.n[1] + e.n[2], ==, in_reach);
    size_t n = neph_photons_near(photons, at, up, 0.5, index, G_N_ELEMENTS(index));
    g_assert_cmpuint(n, ==, in_reach);
    g_assert_cmpuint(n, <, G_N_ELEMENTS(index));
    for (size_t i = 0; i < n; i++) {
        g_assert_false(in_fog(photons, index[i]));
        g_assert_cmpfloat(distance_to(photons, index[i], at), <, 0.5);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    open_folder();
    g_test_add_func("/api-photons/paths", test_photon_paths);
    g_test_add_func("/api-photons/beyond", test_beyond_the_last);
    g_test_add_func("/api-photons/cancelled", test_photons_cancelled);
    g_test_add_func("/api-photons/estimate", test_estimate);
    g_test_add_func("/api-photons/estimate-slices", test_estimate_of_slices);
    g_test_add_func("/api-photons/neighbours", test_neighbours);
    g_test_add_func("/api-photons/fog-paths", test_fog_paths);
    g_test_add_func("/api-photons/fog-flux", test_fog_flux);
    g_test_add_func("/api-photons/nearest", test_nearest);
    g_test_add_func("/api-photons/fog-estimate", test_fog_estimate);
    int result = g_test_run();
    remove_folder();
    return result;
}
