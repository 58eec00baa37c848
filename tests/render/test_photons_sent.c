/*
 * photons: those that are traced without a picture are those that pass 0 of a render
 * stores, bit for bit, whatever the integrator, but for the last byte of flux, of which
 * maps keep none (packed_flux.h); what it does not send is not there.
 */
#include "rooms.h"

#include "render/photons.h"
#include "transport/path/path.h"
#include "transport/photonmap/photonmap.h"
#include "transport/vcm/vcm.h"

/* A ball of glass that flies past a lamp too small for paths. */
#define SMALL_LAMP                                                                       \
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [900 900 900] Translate 1 0 "  \
    "1.7 Shape \"sphere\" \"float radius\" 0.04 AttributeEnd\n"
#define FLYING_BALL                                                                      \
    "ActiveTransform EndTime Translate 0.4 0 0 ActiveTransform All " GLASS_BALL
#define MOVING ROOM_CAMERA SIZE(24) "WorldBegin\n" SMALL_LAMP ROOM_WALLS FLYING_BALL
#define IN_FOG                                                                           \
    "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [.1 .1 "    \
    ".1] \"rgb sigma_a\" [.01 .01 .01]"                                                  \
    " MediumInterface \"\" \"fog\"\n" ROOM_CAMERA SIZE(                                  \
        24) "WorldBegin MediumInterface \"fog\" \"fog\"\n" SMALL_LAMP ROOM_WALLS         \
            "MediumInterface \"\" \"fog\"\n" GLASS_BALL

/* What is known of a photon; ordered by its bytes. */
typedef struct known {
    float p[3];
    uint32_t wi;
    float flux[N_WAVELENGTHS];
} known;

static void add_store(GArray *list, const photon_store *store)
{
    for (size_t i = 0; i < store->n; i++) {
        known one = {{store->x[i], store->y[i], store->z[i]}, store->wi[i], {0}};
        const spectrum flux = photon_store_flux(store, i);
        memcpy(one.flux, &flux, sizeof one.flux);
        g_array_append_val(list, one);
    }
}

static int by_bytes(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(known));
}

static GArray *list_new(void)
{
    return g_array_new(FALSE, FALSE, sizeof(known));
}

static GArray *shown(const render_photons *p, photon_class c)
{
    GArray *list = list_new();
    add_store(list, &p->stores[c]);
    add_store(list, &p->in_media[c]);
    g_array_sort(list, by_bytes);
    return list;
}

/* In the maps of a pass. */
static GArray *stored(const photonmap_pass *pass, photon_class c)
{
    GArray *list = list_new();
    for (int i = 0; i < pass->n_slices; i++) {
        if (pass->maps[i][c])
            add_store(list, photon_map_store(pass->maps[i][c]));
        if (pass->in_media[i][c])
            add_store(list, volume_map_store(pass->in_media[i][c]));
    }
    g_array_sort(list, by_bytes);
    return list;
}

/* The light vertices of a pass of vcm. */
static GArray *vertices(const vcm_pass *pass)
{
    GArray *list = list_new();
    for (size_t i = 0; i < pass->light.n_vertices; i++) {
        const light_vertex *v = &pass->light.vertices[i];
        photon p = vcm_photon(pass, v);
        known one = {{p.p[0], p.p[1], p.p[2]}, direction_pack(p.wi, p.flags), {0}};
        const spectrum share = v->flux / (float)pass->light.n;
        memcpy(one.flux, &share, sizeof one.flux);
        g_array_append_val(list, one);
    }
    g_array_sort(list, by_bytes);
    return list;
}

static GArray *of_pass(const settings *how, const void *pass, photon_class c)
{
    if (how->integrator == INTEGRATOR_VCM)
        return c == PHOTON_INDIRECT ? vertices(pass) : list_new();
    if (how->integrator == INTEGRATOR_PHOTONMAP)
        return stored(pass, c);
    const photonmap_pass *caustics = ((const path_pass *)pass)->caustics;
    return caustics ? stored(caustics, c) : list_new();
}

typedef struct sent_case {
    const char *name, *text, *words;
    bool sends[N_PHOTON_CLASSES];
} sent_case;

#define FEW " photons=4000 caustic_photons=3000 passes=1 spp=2 time_slices=3 seed=5"

/* Finding out where to send them and how far to reach takes longer than all else: a few
   cases do. */
#define UNAIMED " caustic_emission=uniform radius=0.2"

static const sent_case cases[] = {
    {"auto-motion",
     MOVING,
     "integrator=auto gather_indirect=off photons=4000 passes=8 spp=4 seed=5",
     {false, false, true}},
    {"auto-fog",
     IN_FOG,
     "integrator=auto gather_indirect=off photons=4000 passes=8 spp=4 seed=5",
     {false, false, true}},
    {"auto-fog-gathers",
     IN_FOG,
     "integrator=auto photons=4000 passes=8 spp=4 seed=5",
     {false, true, true}},
    {"auto-dull",
     ROOM,
     "integrator=auto gather_indirect=off photons=4000 passes=1 seed=5",
     {false}},
    {"auto-gathers",
     ROOM_CAMERA SIZE(128) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS,
     "integrator=auto photons=16000 passes=8 spp=1 seed=5",
     {false, true, false}},
    {"photonmap-motion", MOVING, "integrator=photonmap" FEW, {false, true, true}},
    {"photonmap-fog", IN_FOG, "integrator=photonmap" FEW, {false, true, true}},
    {"photonmap-direct",
     MOVING,
     "integrator=photonmap direct_illumination=off" UNAIMED FEW,
     {true, true, true}},
    {"sppm-motion", MOVING, "integrator=sppm" UNAIMED FEW, {false, true, true}},
    {"sppm-fog", IN_FOG, "integrator=sppm" FEW, {false, true, true}},
    {"vcm-motion", MOVING, "integrator=vcm" FEW, {false, true, false}},
    {"path", ROOM, "integrator=path" FEW, {false}},
};

/* The pass, by the render's own steps. */
static void *render_pass(transport_plan *plan, transport_counts *counts)
{
    g_autoptr(GError) error = NULL;
    g_assert_true(transport_plan_prepare(plan, NULL, &error));
    void *pass =
        transport_find(plan->how.integrator)->begin_pass(plan, 0, NULL, counts, &error);
    g_assert_no_error(error);
    return pass;
}

static void compare_class(const GArray *a, const GArray *b, const sent_case *of, int c)
{
    g_test_message("class %d: %u photons", c, a->len);
    g_assert_cmpuint(a->len, ==, b->len);
    g_assert_true((a->len > 0) == of->sends[c]);
    for (guint i = 0; i < a->len; i++) {
        const known *x = &g_array_index(a, known, i), *y = &g_array_index(b, known, i);
        g_assert_cmpmem(x, offsetof(known, flux), y, offsetof(known, flux));
        for (int k = 0; k < N_WAVELENGTHS; k++)
            g_assert_cmpfloat(fabsf(x->flux[k] - y->flux[k]), <=, 0x1p-15f * x->flux[k]);
    }
}

static void test_as_stored(gconstpointer data)
{
    const sent_case *of = data;
    g_autoptr(GError) error = NULL;
    g_autoptr(view) v = view_of(of->text);
    settings how = settings_with(v->scene, of->words);
    g_autoptr(render_photons) photons = render_trace_photons(v, &how, NULL, &error);
    g_assert_no_error(error);
    transport_plan plan = transport_plan_of(v, &how);
    transport_counts counts = {0};
    void *pass = render_pass(&plan, &counts);
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        g_autoptr(GArray) a = shown(photons, c), b = of_pass(&how, pass, c);
        compare_class(a, b, of, c);
        g_assert_cmpuint(photons->statistics.emitted[c], ==, counts.emitted[c]);
        g_assert_cmpuint(photons->statistics.stored[c], ==, counts.stored[c]);
        if (of->sends[c])
            g_assert_cmpfloat(photons->statistics.radius[c], ==, counts.radius[c]);
    }
    g_assert_cmpuint(photons->statistics.photon_rays, ==, counts.photon_rays);
    transport_find(how.integrator)->end_pass(pass);
    transport_plan_clear(&plan);
}

/* A render counts what `photons` shows. */
static void test_as_counted(gconstpointer data)
{
    const sent_case *of = data;
    g_autoptr(view) v = view_of(of->text);
    g_autofree char *words = g_strconcat(of->words, " passes=1" UNAIMED, NULL);
    settings how = settings_with(v->scene, words);
    g_autoptr(render) r = render_of(v, words);
    g_assert_true(render_run(r, NULL, NULL, NULL));
    g_autoptr(render_photons) photons = render_trace_photons(v, &how, NULL, NULL);
    const render_statistics rendered = render_get_statistics(r);
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        g_assert_cmpuint(photons->statistics.emitted[c], ==, rendered.emitted[c]);
        g_assert_cmpuint(photons->statistics.stored[c], ==, rendered.stored[c]);
    }
}

/* Of a first pass that is smaller than the others, too. */
static const sent_case small_first = {"first-pass",
                                      ROOM,
                                      "integrator=photonmap photons=4000 spp=4 "
                                      "first_spp=1 seed=5",
                                      {false, true, false}};

/* ---- Paths ---- */

/* What is told of the path that a photon is said to come from. */
typedef struct retold {
    const render_photons *photons;
    photon want;
    uint32_t bounces, n_alike;
} retold;

static void hear(const photon_event *event, void *data)
{
    retold *r = data;
    if (event->kind == PHOTON_SCATTERED)
        r->bounces++;
    if (event->kind == PHOTON_STORED &&
        memcmp(&event->flux, &r->want.flux, sizeof event->flux) == 0)
        r->n_alike++;
}

/* Each photon's path stores it. On what moves it is kept elsewhere and for more, so
   things stand still here. */
static void test_origins(gconstpointer data)
{
    const sent_case *of = data;
    g_autoptr(view) v = view_of(of->text);
    settings how = settings_with(v->scene, of->words);
    g_autoptr(render_photons) photons = render_trace_photons(v, &how, NULL, NULL);
    g_assert_true(render_photons_follow(photons, NULL, NULL));
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        for (size_t i = 0; i < render_photons_count(photons, c); i += 7) {
            retold r = {photons, render_photons_get(photons, c, i), 0, 0};
            const photon_origin from = photons->origins[c][i];
            render_photons_tell(photons, c, from.path, hear, &r);
            g_assert_cmpuint(r.n_alike, >=, 1);
            g_assert_cmpuint(from.bounces, <=, r.bounces);
        }
}

#define STILL ROOM_CAMERA SIZE(24) "WorldBegin\n" SMALL_LAMP ROOM_WALLS GLASS_BALL

static const sent_case still[] = {
    {"photonmap", STILL, "integrator=photonmap" UNAIMED FEW, {false}},
    {"photonmap-fog", IN_FOG, "integrator=photonmap" UNAIMED FEW, {false}},
    {"auto", STILL, "integrator=auto" FEW, {false}},
    {"vcm", STILL, "integrator=vcm" FEW, {false}},
};

/* Asked and asked again: stopped at the n-th question, it goes on where it is called
   once more, and nothing of what was found before is lost or kept twice. */
static void stop_at(void *data)
{
    cancel_flag *flag = data;
    atomic_store(&flag->set, true);
}

static void test_follow_again(void)
{
    g_autoptr(view) v = view_of(STILL);
    settings how = settings_with(v->scene, "integrator=photonmap threads=1" UNAIMED FEW);
    g_autoptr(render_photons) a = render_trace_photons(v, &how, NULL, NULL);
    g_autoptr(render_photons) b = render_trace_photons(v, &how, NULL, NULL);
    for (int i = 0; i < 3; i++) {
        cancel_flag flag = {.progress = stop_at};
        flag.progress_data = &flag;
        g_autoptr(GError) error = NULL;
        g_assert_false(render_photons_follow(a, &flag, &error));
        g_assert_error(error, NEPH_ERROR, ERROR_CANCELLED);
    }
    g_assert_true(render_photons_follow(a, NULL, NULL));
    g_assert_true(render_photons_follow(b, NULL, NULL));
    for (int c = 0; c < N_PHOTON_CLASSES; c++)
        g_assert_cmpmem(a->origins[c], render_photons_count(a, c) * sizeof(photon_origin),
                        b->origins[c],
                        render_photons_count(b, c) * sizeof(photon_origin));
}

static void add(const char *what, const sent_case *of, GTestDataFunc test)
{
    g_autofree char *path = g_strdup_printf("/photons-sent/%s/%s", what, of->name);
    g_test_add_data_func(path, of, test);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        add("as-stored", &cases[i], test_as_stored);
        add("as-counted", &cases[i], test_as_counted);
    }
    for (size_t i = 0; i < G_N_ELEMENTS(still); i++)
        add("origins", &still[i], test_origins);
    add("as-counted", &small_first, test_as_counted);
    g_test_add_func("/photons-sent/follow-again", test_follow_again);
    return g_test_run();
}
