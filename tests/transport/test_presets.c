/*
 * presets: each is what its text describes, as photons and pictures of a small room show:
 * how many photons of what class land where, that one pass is all and nothing shrinks,
 * and that the picture is that of path tracing but for the bias of the estimate.
 */
#include "color/wavelengths.h"
#include "render/photons.h"
#include "rooms.h"
#include "settings/presets.h"

#include <string.h>

/* Two lamps of unlike power, a mirror, and metal so rough that it counts as diffuse. */
#define SECOND_LAMP                                                                      \
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1 1 2] Material \"diffuse\" " \
    "\"rgb reflectance\" [0 0 0] Translate 1.5 0 1.9 Rotate 180 1 0 0 Shape \"disk\" "   \
    "\"float radius\" 0.3 AttributeEnd\n"
#define MIRROR                                                                           \
    "AttributeBegin Material \"conductor\" \"float roughness\" 0 Translate -.8 .3 .4 "   \
    "Shape \"sphere\" \"float radius\" .4 AttributeEnd\n"
#define ROUGH_PLACE 0.7f, -0.2f, 0.45f
#define ROUGH                                                                            \
    "AttributeBegin Material \"conductor\" \"float roughness\" .5 Translate .7 -.2 .45 " \
    "Shape \"sphere\" \"float radius\" .4 AttributeEnd\n"
#define SUBJECT ROOM SECOND_LAMP MIRROR ROUGH

static settings preset_with(const view *v, const char *name, const char *words)
{
    g_autoptr(GError) error = NULL;
    settings how = v->scene->settings;
    settings_load_preset(&how, name, &error);
    g_assert_no_error(error);
    g_auto(GStrv) list = g_strsplit(words, " ", -1);
    for (char **word = list; *word && **word; word++) {
        g_auto(GStrv) pair = g_strsplit(*word, "=", 2);
        settings_set(&how, pair[0], pair[1], &error);
        g_assert_no_error(error);
    }
    return how;
}

static render_photons *photons_of(const view *v, const char *name, const char *words)
{
    g_autoptr(GError) error = NULL;
    const settings how = preset_with(v, name, words);
    render_photons *p = render_trace_photons(v, &how, NULL, &error);
    g_assert_no_error(error);
    render_photons_follow(p, NULL, &error);
    g_assert_no_error(error);
    return p;
}

static size_t n_on_rough(const render_photons *p)
{
    const vec3 center = vec3_make(ROUGH_PLACE);
    size_t n = 0;
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        for (size_t i = 0; i < render_photons_count(p, (photon_class)c); i++)
            n += length3(render_photons_get(p, (photon_class)c, i).p - center) < 0.41f;
    return n;
}

static double flux_of(const render_photons *p, photon_class c)
{
    double sum = 0.0;
    for (size_t i = 0; i < render_photons_count(p, c); i++)
        sum += (double)spectrum_mean(render_photons_get(p, c, i).flux);
    return sum;
}

/* ---- The files ---- */

static void test_files(void)
{
    static const char *const all[] = {"000", "002", "003"};
    g_auto(GStrv) names = settings_presets();
    g_assert_cmpuint(g_strv_length(names), ==, G_N_ELEMENTS(all));
    for (size_t i = 0; i < G_N_ELEMENTS(all); i++) {
        g_autoptr(GError) error = NULL;
        g_autofree char *text = settings_preset_text(all[i], &error);
        g_assert_no_error(error);
        g_assert_cmpstr(names[i], ==, all[i]);
        g_assert_true(g_str_has_prefix(text, "# "));
        g_assert_null(strchr(strchr(text, '\n'), '#'));
        settings s = settings_default();
        g_assert_true(settings_load_preset(&s, all[i], &error));
        GStrv unread = settings_unread(&s, &s);
        g_assert_cmpuint(g_strv_length(unread), ==, 0);
        g_strfreev(unread);
    }
    g_autoptr(GError) error = NULL;
    settings s = settings_default();
    g_assert_false(settings_load_preset(&s, "../000", &error));
    g_assert_error(error, NEPH_ERROR, ERROR_USAGE);
    g_assert_cmpstr(error->message, ==,
                    "expected a preset's name (000, 002, 003), found '../000'");
}

/* ---- One pass, and nothing shrinks ---- */

static render_statistics rendered(const view *v, const settings *how, image **img)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(render) r = render_new(v, how, &error);
    g_assert_no_error(error);
    render_run(r, NULL, NULL, &error);
    g_assert_no_error(error);
    if (img)
        *img = image_of(r);
    return render_get_statistics(r);
}

static void test_one_pass(void)
{
    static const char *const each[] = {"000", "002", "003"};
    static const char few[] = "spp=1 photons=2000 radius=.2 direct_photons=1000 "
                              "indirect_photons=1000 caustic_photons=1000";
    g_autoptr(view) v = view_of(SUBJECT);
    for (size_t i = 0; i < G_N_ELEMENTS(each); i++) {
        settings how = preset_with(v, each[i], few);
        render_statistics one = rendered(v, &how, NULL);
        how.passes = 3;
        render_statistics three = rendered(v, &how, NULL);
        g_assert_cmpint(one.passes, ==, 1);
        for (int c = 0; c < N_PHOTON_CLASSES; c++) {
            g_assert_cmpuint(three.emitted[c], ==, 3 * one.emitted[c]);
            if (one.emitted[c] > 0)
                g_assert_cmpfloat(fabs(three.radius[c] - 0.2), <, 1e-6);
        }
    }
}

/* A fixed radius is one all over the scene, and large enough to be of use. */
static void test_one_radius(void)
{
    g_autoptr(view) v = view_of(SUBJECT);
    g_autoptr(GError) error = NULL;
    for (int one = 0; one < 2; one++) {
        const settings how =
            preset_with(v, "000", one ? "photons=20000" : "photons=20000 one_radius=off");
        transport_plan plan = transport_plan_of(v, &how);
        transport_plan_prepare(&plan, NULL, &error);
        g_assert_no_error(error);
        g_assert_cmpint(plan.radius_cache[PHOTON_INDIRECT] == NULL, ==, one);
        g_assert_cmpfloat(plan.radius[PHOTON_INDIRECT], >, 0.01);
        transport_plan_clear(&plan);
    }
}

/* ---- 000: one map ---- */

/* The one map has the photons that three have: as many, with as much flux, if each of
   those is sent as many. */
static void test_one_map(void)
{
    enum { N = 60000 };
    g_autoptr(view) v = view_of(SUBJECT);
    for (int direct = 0; direct < 2; direct++) {
        const char *with = direct ? "direct_illumination=off photons=60000"
                                  : "direct_illumination=on photons=60000";
        g_autofree char *apart = g_strconcat(with,
                                             " one_map=off indirect_photons=60000 "
                                             "direct_photons=60000 caustic_photons=60000",
                                             NULL);
        g_autoptr(render_photons) one = photons_of(v, "000", with);
        g_autoptr(render_photons) three = photons_of(v, "000", apart);
        double stored = 0.0, flux = 0.0;
        for (int c = 0; c < N_PHOTON_CLASSES; c++) {
            bool is_map = c == PHOTON_INDIRECT;
            g_assert_cmpuint(one->statistics.emitted[c], ==, is_map ? N : 0);
            stored += (double)three->statistics.stored[c];
            flux += flux_of(three, (photon_class)c);
        }
        double found = (double)one->statistics.stored[PHOTON_INDIRECT];
        g_test_message("one map %.0f photons, three %.0f", found, stored);
        g_assert_cmpfloat(fabs(found / stored - 1.0), <, 0.02);
        g_assert_cmpfloat(fabs(flux_of(one, PHOTON_INDIRECT) / flux - 1.0), <, 0.02);
        size_t straight = 0;
        for (size_t i = 0; i < one->stores[PHOTON_INDIRECT].n; i++)
            straight += one->origins[PHOTON_INDIRECT][i].bounces == 0;
        g_assert_cmpint(straight > 0, ==, direct);
    }
}

/* ---- Where photons are stored ---- */

/* Rough metal under lacquer or from a glTF file is metal as well. */
static void test_other_metals(void)
{
    static const char *const metals[] = {
        "\"coatedconductor\" \"float conductor.roughness\" .5 \"float "
        "interface.roughness\" .5",
        "\"gltf\" \"float metallic\" 1 \"float roughness\" .8",
    };
    for (size_t i = 0; i < G_N_ELEMENTS(metals); i++) {
        g_autofree char *text =
            g_strconcat(ROOM SECOND_LAMP MIRROR "AttributeBegin Material ", metals[i],
                        " Translate .7 -.2 .45 Shape \"sphere\" \"float radius\" .4 "
                        "AttributeEnd\n",
                        NULL);
        g_autoptr(view) v = view_of(text);
        g_autoptr(render_photons) of_000 = photons_of(v, "000", "photons=30000");
        g_autoptr(render_photons) of_002 = photons_of(
            v, "002",
            "direct_photons=10000 indirect_photons=10000 caustic_photons=10000");
        g_autoptr(render_photons) of_003 = photons_of(v, "003", "photons=30000");
        g_test_message("%s", metals[i]);
        g_assert_cmpuint(n_on_rough(of_000), >, 100);
        g_assert_cmpuint(n_on_rough(of_002), ==, 0);
        g_assert_cmpuint(n_on_rough(of_003), ==, 0);
    }
}

static void test_lobes(void)
{
    static const char few[] = "photons=30000 direct_photons=10000 "
                              "indirect_photons=10000 caustic_photons=10000";
    g_autoptr(view) v = view_of(SUBJECT);
    g_autoptr(render_photons) of_000 = photons_of(v, "000", "photons=30000");
    g_autoptr(render_photons) of_002 = photons_of(v, "002", few);
    g_autoptr(render_photons) of_003 = photons_of(v, "003", "photons=30000");
    g_autoptr(render_photons) needed = photons_of(v, "002", "photon_lobes=needed");
    g_assert_cmpuint(n_on_rough(of_000), >, 100);
    g_assert_cmpuint(n_on_rough(needed), >, 100);
    g_assert_cmpuint(n_on_rough(of_002), ==, 0);
    g_assert_cmpuint(n_on_rough(of_003), ==, 0);
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        g_assert_cmpuint(of_002->stores[c].n, >, 100);
}

/* ---- 002: so many of each light ---- */

static void count_light(const photon_event *event, void *data)
{
    size_t *counts = data;
    if (event->kind == PHOTON_EMITTED)
        counts[event->light]++;
}

static void test_by_light(void)
{
    enum { EACH = 3000, N_LIGHTS = 2 };
    g_autoptr(view) v = view_of(SUBJECT);
    g_autoptr(render_photons) p = photons_of(v, "002",
                                             "direct_photons=3000 indirect_photons=3000 "
                                             "caustic_photons=3000");
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        g_assert_cmpuint(p->statistics.emitted[c], ==, N_LIGHTS * EACH);
    for (int c = 0; c < PHOTON_CAUSTIC; c++) {
        size_t counts[N_LIGHTS] = {0};
        for (uint64_t i = 0; i < N_LIGHTS * EACH; i++)
            render_photons_tell(p, (photon_class)c, i, count_light, counts);
        for (int l = 0; l < N_LIGHTS; l++)
            g_assert_cmpuint(counts[l], ==, EACH);
    }
    /* Their flux is that of photons that are dealt out by power. */
    g_autoptr(render_photons) by_power =
        photons_of(v, "002",
                   "photons_per_light=off direct_photons=100000 "
                   "indirect_photons=100000 caustic_photons=100000");
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        g_autoptr(render_photons) many =
            photons_of(v, "002",
                       "direct_photons=50000 indirect_photons=50000 "
                       "caustic_photons=50000");
        double ratio =
            flux_of(many, (photon_class)c) / flux_of(by_power, (photon_class)c);
        g_test_message("class %d: flux by light over flux by power %.4f", c, ratio);
        g_assert_cmpfloat(fabs(ratio - 1.0), <, 0.03);
    }
}

/* ---- 003: what survives is stored ---- */

#define HALF_ROOM                                                                        \
    ROOM_CAMERA SIZE(8) "WorldBegin LightSource \"point\" \"rgb I\" [3 3 3] \"point3 "   \
                        "from\" [0 0 1.5] Material \"diffuse\" \"rgb reflectance\" "     \
                        "[.5 .5 .5] Shape \"sphere\" \"float radius\" 6\n"

static void test_survivors(void)
{
    enum { N = 10000 };
    g_autoptr(view) v = view_of(HALF_ROOM);
    g_autoptr(render_photons) p = photons_of(v, "003", "");
    g_autoptr(render_photons) all = photons_of(v, "003", "photon_survivors=off");
    size_t n = p->stores[PHOTON_INDIRECT].n;
    double sigma = sqrt(0.25 / N);
    g_test_message("%zu of %d survived", n, N);
    g_assert_cmpuint(p->statistics.emitted[PHOTON_INDIRECT], ==, N);
    g_assert_cmpuint(all->stores[PHOTON_INDIRECT].n, ==, N);
    g_assert_cmpfloat(fabs((double)n / N - 0.5), <, 5.0 * sigma + 0.005);
    double ratio = flux_of(p, PHOTON_INDIRECT) / flux_of(all, PHOTON_INDIRECT);
    g_assert_cmpfloat(fabs(ratio - 1.0), <, 10.0 * sigma + 0.01);
    for (size_t i = 0; i < n; i++)
        g_assert_cmpuint(p->origins[PHOTON_INDIRECT][i].bounces, ==, 0);
    /* Where they go on, as many land again as without. */
    g_autoptr(render_photons) on = photons_of(v, "003", "max_forward_bounces=4");
    double expected = 0.5 + 0.25 + 0.125 + 0.0625 + 0.03125;
    g_assert_cmpfloat(fabs((double)on->stores[PHOTON_INDIRECT].n / N - expected), <,
                      10.0 * sigma + 0.01);
}

/* ---- Pictures ---- */

static void test_pictures(void)
{
    static const struct {
        const char *name, *words, *path;
        double tolerance;
    } each[] = {
        {"000", "spp=16 photons=200000", "", 0.03},
        {"000", "spp=16 photons=200000 direct_illumination=off", "", 0.04},
        {"002", "spp=16", "", 0.04},
        {"003", "spp=16 photons=100000", " max_backward_bounces=1", 0.06},
    };
    g_autoptr(view) v = view_of(SUBJECT);
    g_autoptr(view) plain = view_of(ROOM SECOND_LAMP);
    for (size_t i = 0; i < G_N_ELEMENTS(each); i++) {
        const view *seen = *each[i].path ? plain : v;
        const settings how = preset_with(seen, each[i].name, each[i].words);
        g_autofree char *path =
            g_strconcat("integrator=path passes=4 spp=256", each[i].path, NULL);
        g_autoptr(image) reference = render_with(seen, path);
        g_autoptr(image) img = NULL;
        rendered(seen, &how, &img);
        double ratio = mean_of(img, "") / mean_of(reference, "");
        g_test_message("%s %s: %.4f of path tracing", each[i].name, each[i].words, ratio);
        g_assert_cmpfloat(fabs(ratio - 1.0), <, each[i].tolerance);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/presets/files", test_files);
    g_test_add_func("/presets/one-pass", test_one_pass);
    g_test_add_func("/presets/one-radius", test_one_radius);
    g_test_add_func("/presets/one-map", test_one_map);
    g_test_add_func("/presets/lobes", test_lobes);
    g_test_add_func("/presets/other-metals", test_other_metals);
    g_test_add_func("/presets/by-light", test_by_light);
    g_test_add_func("/presets/survivors", test_survivors);
    g_test_add_func("/presets/pictures", test_pictures);
    return g_test_run();
}
