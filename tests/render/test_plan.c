/*
 * The plan: a value that is the same however many threads make it, that the render goes
 * by and `photons` too, and that costs a twentieth of the work it is for.
 */
#define _GNU_SOURCE /* RTLD_NEXT */
#include "ray_count.h"
#include "rooms.h"

#include "render/photons.h"

#define SMALL_LAMP                                                                       \
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [900 900 900] Translate 1 0 "  \
    "1.7 Shape \"sphere\" \"float radius\" 0.04 AttributeEnd\n"
#define POINT "LightSource \"point\" \"rgb I\" [4 4 4] \"point3 from\" [1 -2 1.5]\n"
#define STUDIO(n) ROOM_CAMERA SIZE(n) "WorldBegin\n" ROOM_WALLS

typedef struct plan_case {
    const char *name, *text, *words;
} plan_case;

static const plan_case cases[] = {
    {"auto", STUDIO(32) SMALL_LAMP GLASS_BALL, "integrator=auto passes=4 spp=4 seed=3"},
    {"auto-point", STUDIO(32) POINT GLASS_BALL, "integrator=auto passes=4 spp=4 seed=3"},
    {"auto-dull", STUDIO(32) ROOM_LAMP(""), "integrator=auto passes=4 spp=8 seed=3"},
    {"photonmap", STUDIO(32) SMALL_LAMP GLASS_BALL,
     "integrator=photonmap passes=4 photons=4000 seed=3"},
    {"vcm", STUDIO(32) SMALL_LAMP GLASS_BALL, "integrator=vcm passes=4 spp=2 seed=3"},
    {"tiny", STUDIO(8) POINT GLASS_BALL, "integrator=auto passes=1 spp=4 seed=3"},
};

static render_plan plan_with(const view *v, const char *words, const char *more)
{
    g_autofree char *all = g_strconcat(words, more, NULL);
    g_autoptr(render) r = render_of(v, all);
    render_plan plan;
    g_assert_true(render_get_plan(r, &plan, NULL));
    return plan;
}

static void same_cost(plan_cost a, plan_cost b)
{
    g_assert_cmpfloat(a.variance, ==, b.variance);
    g_assert_cmpfloat(a.rays, ==, b.rays);
}

static void same_plan(const render_plan *a, const render_plan *b)
{
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        g_assert_cmpuint(a->photons[c], ==, b->photons[c]);
        g_assert_cmpfloat(a->radius[c], ==, b->radius[c]);
        g_assert_cmpint(a->guided[c], ==, b->guided[c]);
    }
    g_assert_cmpfloat(a->discs, ==, b->discs);
    g_assert_cmpfloat(a->p_spots, ==, b->p_spots);
    g_assert_cmpfloat(a->p_blurred, ==, b->p_blurred);
    g_assert_cmpfloat(a->planning, ==, b->planning);
    g_assert_cmpint(a->n_trials, ==, b->n_trials);
    for (int i = 0; i < a->n_trials; i++) {
        g_assert_cmpstr(a->trials[i].what, ==, b->trials[i].what);
        g_assert_cmpint(a->trials[i].taken, ==, b->trials[i].taken);
        same_cost(a->trials[i].without, b->trials[i].without);
        same_cost(a->trials[i].with, b->trials[i].with);
    }
}

static void test_threads(gconstpointer data)
{
    const plan_case *of = data;
    g_autoptr(view) v = view_of(of->text);
    const render_plan one = plan_with(v, of->words, " threads=1");
    const render_plan three = plan_with(v, of->words, " threads=3");
    same_plan(&one, &three);
}

/* What is planned is what a pass sends, and what `photons` shows. */
static void test_photons_are_planned(gconstpointer data)
{
    const plan_case *of = data;
    g_autoptr(view) v = view_of(of->text);
    g_autofree char *words = g_strconcat(of->words, " planned_passes=4 passes=1", NULL);
    settings how = settings_with(v->scene, words);
    const render_plan plan = plan_with(v, words, "");
    g_autoptr(render_photons) photons = render_trace_photons(v, &how, NULL, NULL);
    const render_plan shown = render_plan_of(&photons->plan);
    same_plan(&plan, &shown);
    g_autoptr(render) r = render_of(v, words);
    g_assert_true(render_run(r, NULL, NULL, NULL));
    const render_statistics did = render_get_statistics(r);
    for (int c = 0; c < N_PHOTON_CLASSES; c++) {
        g_assert_cmpuint(photons->statistics.emitted[c], ==, plan.photons[c]);
        g_assert_cmpuint(did.emitted[c], ==, plan.photons[c]);
        g_assert_cmpuint(did.stored[c], ==, photons->statistics.stored[c]);
        if (plan.photons[c] > 0)
            g_assert_cmpfloat(did.radius[c], ==, plan.radius[c]);
    }
}

/* Of classes that share photons one that brings nothing has few: all that are sent to a
   mirror behind the wall are lost. */
static void test_shares(void)
{
    static const char mirror[] =
        "Material \"conductor\" Translate 0 0 %g Shape \"sphere\" \"float radius\" .5\n";
    for (int behind = 0; behind < 2; behind++) {
        g_autofree char *ball = g_strdup_printf(mirror, behind ? 9.0 : .6);
        g_autofree char *text = g_strconcat(STUDIO(32) SMALL_LAMP, ball, NULL);
        g_autoptr(view) v = view_of(text);
        const render_plan plan =
            plan_with(v, "integrator=photonmap passes=64 photons=8000", "");
        double caustic = (double)plan.photons[PHOTON_CAUSTIC];
        double part = caustic / (caustic + (double)plan.photons[PHOTON_INDIRECT]);
        double least = .05 / 1.05;
        g_test_message("behind %d: %g, the least is %g", behind, part, least);
        if (behind)
            g_assert_cmpfloat(fabs(part - least), <, .001);
        else
            g_assert_cmpfloat(part, >, 2 * least);
    }
}

/* Asked for before, the plan changes nothing in the picture, nor is it made twice. */
static void test_asked_before(void)
{
    g_autoptr(view) v = view_of(cases[0].text);
    g_autoptr(render) asked = render_of(v, cases[0].words);
    render_plan plan, again;
    g_assert_true(render_get_plan(asked, &plan, NULL));
    uint64_t before = rays_asked;
    g_assert_true(render_get_plan(asked, &again, NULL));
    g_assert_cmpuint(rays_asked, ==, before);
    same_plan(&plan, &again);
    g_assert_true(render_run(asked, NULL, NULL, NULL));
    g_autoptr(image) a = image_of(asked);
    g_autoptr(image) b = render_with(v, cases[0].words);
    g_assert_cmpmem(a->pixels, pixels_of(a) * (size_t)a->n_channels * sizeof(float),
                    b->pixels, pixels_of(b) * (size_t)b->n_channels * sizeof(float));
}

/* Rays that planning asks Embree for, and those of the whole render. */
static void test_costs_little(gconstpointer data)
{
    const plan_case *of = data;
    g_autoptr(view) v = view_of(of->text);
    g_autoptr(render) r = render_of(v, of->words);
    render_plan plan;
    uint64_t begun = rays_asked;
    g_assert_true(render_get_plan(r, &plan, NULL));
    double planning = (double)(rays_asked - begun);
    g_assert_true(render_run(r, NULL, NULL, NULL));
    double all = (double)(rays_asked - begun);
    g_test_message("%s: %.0f rays of %.0f, %.1f %%; %.0f by the plan", of->name, planning,
                   all, 100.0 * planning / all, plan.planning);
    g_assert_cmpfloat(planning, <, 0.05 * all);
    g_assert_cmpfloat(fabs(plan.planning - planning), <=, 0.3 * planning + 16.0);
}

static const plan_case costs[] = {
    {"thumbnail", STUDIO(32) SMALL_LAMP GLASS_BALL,
     "integrator=auto photons=100 passes=1 spp=4 seed=3"},
    {"thumbnail-photonmap", STUDIO(32) SMALL_LAMP GLASS_BALL,
     "integrator=photonmap photons=100 passes=1 spp=4 seed=3"},
    {"passes", STUDIO(32) SMALL_LAMP GLASS_BALL,
     "integrator=auto photons=1536 passes=16 spp=1 seed=3"},
    {"passes-dull", STUDIO(32) ROOM_LAMP(""),
     "integrator=auto photons=1536 passes=16 spp=1 seed=3"},
    {"picture", STUDIO(48) SMALL_LAMP GLASS_BALL,
     "integrator=auto passes=4 spp=4 seed=3"},
    {"dull", STUDIO(64) ROOM_LAMP(""), "integrator=auto passes=2 spp=4 seed=3"},
    {"glass", STUDIO(64) ROOM_LAMP("") GLASS_BALL,
     "integrator=auto passes=2 spp=4 seed=3"},
    {"tiny", STUDIO(8) POINT GLASS_BALL, "integrator=auto passes=1 spp=4 seed=3"},
};

static void add(const char *what, const plan_case *of, GTestDataFunc test)
{
    g_autofree char *path = g_strdup_printf("/plan/%s/%s", what, of->name);
    g_test_add_data_func(path, of, test);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        add("threads", &cases[i], test_threads);
        add("photons", &cases[i], test_photons_are_planned);
    }
    g_test_add_func("/plan/shares", test_shares);
    g_test_add_func("/plan/asked-before", test_asked_before);
    for (size_t i = 0; i < G_N_ELEMENTS(costs); i++)
        add("costs-little", &costs[i], test_costs_little);
    return g_test_run();
}
