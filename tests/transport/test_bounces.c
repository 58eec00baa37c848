/*
 * bounces: how many times light scatters on its way from the eye. Where nothing bounds it
 * a closed white room has all its light; interfaces, which scatter nothing, are never
 * counted; and ways that nothing absorbs end all the same.
 */
#include "rooms.h"
#include "transport/visible.h"

#define BOX                                                                              \
    "Shape \"trianglemesh\" \"point3 P\" [-1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1 -1 -1 1 1 -1 " \
    "1 1 1 1 -1 1 1] \"integer indices\" [0 1 2 0 2 3 4 6 5 4 7 6 0 5 1 0 4 5 3 2 6 3 6" \
    " 7 0 3 7 0 7 4 1 5 6 1 6 2]\n"

#define FROM_WITHIN(size)                                                                \
    "Camera \"perspective\" \"float fov\" 60\n" SIZE(size) "WorldBegin\n"

/* A closed box that shines 1 and reflects ρ everywhere is filled with 1 / (1 - ρ). */
#define REFLECTANCE 0.97
#define WHITE_BOX                                                                        \
    FROM_WITHIN(8)                                                                       \
    "Material \"diffuse\" \"rgb reflectance\" [.97 .97 .97]\n"                           \
    "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true\n" BOX

static void test_white_box(void)
{
    static const char *const each[] = {
        "integrator=path passes=4 spp=32",
        "integrator=auto passes=4 spp=32",
        "integrator=vcm passes=4 spp=8 photons=256",
        "integrator=photonmap passes=2 spp=2 photons=4000 radius=.3",
    };
    g_autoptr(view) v = view_of(WHITE_BOX);
    for (size_t i = 0; i < G_N_ELEMENTS(each); i++) {
        g_autoptr(image) img = render_with(v, each[i]);
        double found = mean_of(img, "") * (1.0 - REFLECTANCE);
        g_test_message("%s: %.4f", each[i], found);
        g_assert_cmpfloat(fabs(found - 1.0), <, 0.05);
    }
}

/* ---- One depth ---- */

/* Of n scattering events the box keeps 1 + ρ + … + ρⁿ. Photons that are kept where they
   land first have scattered nowhere: gathering them is one event of the eye's path, a
   gather ray to them makes it two, and there are no more. */
static double light_of_events(int n)
{
    double sum = 0;
    for (int k = 0; k <= n; k++)
        sum += pow(REFLECTANCE, k);
    return sum;
}

static void test_one_depth(void)
{
    static const struct {
        const char *words;
        int most; /* events that it finds at all */
    } each[] = {
        {"integrator=path passes=4 spp=16", 9},
        {"integrator=auto passes=4 spp=16", 9},
        {"integrator=vcm passes=4 spp=16 photons=256", 9},
        {"integrator=photonmap passes=4 spp=4 photons=8000 radius=.3 edges=false "
         "max_forward_bounces=0 direct_illumination=off",
         1},
        {"integrator=photonmap passes=4 spp=4 photons=8000 radius=.3 edges=false "
         "max_forward_bounces=0",
         1},
        {"integrator=photonmap passes=4 spp=4 photons=8000 radius=.3 edges=false "
         "max_forward_bounces=0 final_gather=on gather_rays=16 precompute_radiance=off",
         2},
    };
    g_autoptr(view) v = view_of(WHITE_BOX);
    for (size_t i = 0; i < G_N_ELEMENTS(each); i++)
        for (int limit = 0; limit < 4; limit++) {
            g_autofree char *words =
                g_strdup_printf("%s max_backward_bounces=%d", each[i].words, limit);
            g_autoptr(image) img = render_with(v, words);
            double expected = light_of_events(MIN(limit, each[i].most));
            double found = mean_of(img, "");
            g_test_message("%s: %.4f, expected %.4f", words, found, expected);
            g_assert_cmpfloat(fabs(found / expected - 1.0), <, 0.03);
        }
}

#define MIRROR_BALL                                                                      \
    "AttributeBegin Material \"conductor\" Translate 0 0 0.6 Shape \"sphere\" "          \
    "\"float radius\" 0.5 AttributeEnd\n"

/* What photons scatter counts in auto and vcm as it does in path: a caustic is of two
   events, its photons' last one and where it is seen. */
static void test_caustics_are_of_two(void)
{
    static const char *const each[] = {
        "integrator=path passes=1 spp=1024",
        "integrator=auto passes=4 spp=16 caustic_photons=9000 radius=.2",
        "integrator=vcm passes=8 spp=32 photons=4000",
    };
    g_autoptr(view) v = view_of(ROOM MIRROR_BALL);
    double expected = 0.0;
    for (size_t i = 0; i < G_N_ELEMENTS(each); i++)
        for (int limit = 1; limit <= 2; limit++) {
            g_autofree char *words = g_strdup_printf(
                "%s max_backward_bounces=%d max_forward_bounces=1", each[i], limit);
            g_autoptr(image) img = render_with(v, words);
            double found = mean_of(img, "caustic");
            g_test_message("%s: caustics %.5f", words, found);
            if (limit == 1)
                g_assert_cmpfloat(found, ==, 0.0);
            else if (i == 0)
                expected = found;
            else
                g_assert_cmpfloat(fabs(found / expected - 1.0), <, 0.05);
        }
}

/* ---- Interfaces ---- */

/* Panes that part nothing, across a ball of silver: before it, in it and behind it. */
#define PANE(at)                                                                         \
    "AttributeBegin Material \"interface\" Translate 0 " at " 1 Shape \"trianglemesh\" " \
    "\"point3 P\" [-3 0 -2 3 0 -2 3 0 2 -3 0 2] \"integer indices\" [0 1 2 0 2 3] "      \
    "AttributeEnd\n"
#define PANES PANE("-2.9") PANE("-1.5") PANE("-.8") PANE("-.4") PANE(".05") PANE(".7")
#define LYING                                                                            \
    "AttributeBegin Material \"interface\" Translate 0 0 1.6 Shape \"trianglemesh\" "    \
    "\"point3 P\" [-2 -4 0 2 -4 0 2 2 0 -2 2 0] \"integer indices\" [0 1 2 0 2 3] "      \
    "AttributeEnd\n"

#define SILVER_BALL                                                                      \
    "AttributeBegin Material \"conductor\" \"float roughness\" .1 Translate 0 0 0.6 "    \
    "Shape \"sphere\" \"float radius\" 0.5 AttributeEnd\n"

/* What scatters is the same and in the same places, so the random numbers are too; but
   behind a pane a ray is rounded, and a few of them come out elsewhere. Looks for edges
   are turned by the last digits of where they are: they are others there. */
#define ROUNDED 1e-4
#define LOOKED 1e-3

static double mean_with(const view *v, const char *words, int limit)
{
    g_autofree char *all = g_strdup_printf("threads=1 caustic_emission=uniform seed=5 "
                                           "max_forward_bounces=%d "
                                           "max_backward_bounces=%d %s",
                                           limit, limit, words);
    g_autoptr(image) img = render_with(v, all);
    return mean_of(img, "");
}

static void test_interfaces_are_none(void)
{
    static const struct {
        const char *words;
        double error;
    } each[] = {
        {"integrator=path passes=1 spp=16", ROUNDED},
        {"integrator=auto passes=1 spp=8 caustic_photons=2000 radius=.4", ROUNDED},
        {"integrator=photonmap passes=1 spp=4 photons=4000 radius=.4 edges=false",
         ROUNDED},
        {"integrator=photonmap passes=1 spp=4 photons=4000 radius=.4 edges=false "
         "final_gather=on gather_rays=8 precompute_radiance=off",
         ROUNDED},
        {"integrator=photonmap passes=1 spp=4 photons=4000 radius=.4 edges=false "
         "final_gather=on gather_rays=8",
         ROUNDED},
        {"integrator=photonmap passes=1 spp=4 photons=4000 radius=.4 edges=false "
         "direct_illumination=off",
         ROUNDED},
        {"integrator=photonmap passes=1 spp=4 photons=4000 radius=.4 "
         "direct_illumination=off",
         LOOKED},
        {"integrator=vcm passes=1 spp=8 photons=2000 radius=.4 edges=false", ROUNDED},
        {"integrator=vcm passes=1 spp=8 photons=2000 radius=.4", LOOKED},
        {"integrator=vcm vcm_strategies=bpt passes=1 spp=8 photons=2000", ROUNDED},
    };
    g_autoptr(view) open = view_of(ROOM SILVER_BALL);
    g_autoptr(view) paned = view_of(ROOM PANES LYING SILVER_BALL);
    for (size_t i = 0; i < G_N_ELEMENTS(each); i++)
        for (int limit = 0; limit < 4; limit++) {
            double expected = mean_with(open, each[i].words, limit);
            double found = mean_with(paned, each[i].words, limit);
            g_test_message("%s, limit %d: %.6f, without panes %.6f", each[i].words, limit,
                           found, expected);
            g_assert_cmpfloat(fabs(found - expected), <=, each[i].error * expected);
        }
}

/* In fog a pane cuts a way in two, each drawn apart: the same on average, where the noise
   of a mean is a twentieth. If panes were counted nearly all light would be missing. */
#define FOG                                                                              \
    "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [.1 .1 .1]" \
    " \"rgb sigma_a\" [.02 .02 .02] MediumInterface \"\" \"fog\"\n"
#define FOGGY_ROOM                                                                       \
    FOG ROOM_CAMERA SIZE(8) "WorldBegin MediumInterface \"fog\" \"fog\"\n" ROOM_LAMP("") \
        ROOM_WALLS

static void test_interfaces_in_fog(void)
{
    static const char *const each[] = {
        "integrator=path passes=1 spp=64",
        "integrator=auto passes=1 spp=64 caustic_photons=2000 radius=.4",
        "integrator=photonmap passes=1 spp=8 photons=4000 radius=.4 edges=false",
    };
    g_autoptr(view) open = view_of(FOGGY_ROOM SILVER_BALL);
    g_autoptr(view) paned = view_of(FOGGY_ROOM PANES LYING SILVER_BALL);
    for (size_t i = 0; i < G_N_ELEMENTS(each); i++)
        for (int limit = 1; limit < 3; limit++) {
            double expected = mean_with(open, each[i], limit);
            double found = mean_with(paned, each[i], limit);
            g_test_message("%s, limit %d: %.5f, without panes %.5f", each[i], limit,
                           found, expected);
            g_assert_cmpfloat(fabs(found - expected), <=, 0.2 * expected);
        }
}

/* Behind thirty panes the camera finds the same places. */
static void test_visible_past_interfaces(void)
{
    g_autoptr(GString) text = g_string_new(ROOM);
    for (int i = 0; i < 30; i++)
        g_string_append_printf(text,
                               "AttributeBegin Material \"interface\" Translate 0 %g 1 "
                               "Shape \"trianglemesh\" \"point3 P\" [-3 0 -2 3 0 -2 3 0 "
                               "2 -3 0 2] \"integer indices\" [0 1 2 0 2 3] "
                               "AttributeEnd\n",
                               -3.3 + 0.02 * i);
    g_autoptr(view) open = view_of(ROOM), paned = view_of(text->str);
    enum { N = 256 };
    visible_point a[N], b[N];
    const settings how = settings_default();
    const transport_plan by_open = transport_plan_of(open, &how);
    const transport_plan by_paned = transport_plan_of(paned, &how);
    g_assert_cmpuint(find_visible_points(&by_open, N, a), ==, N);
    g_assert_cmpuint(find_visible_points(&by_paned, N, b), ==, N);
    for (int i = 0; i < N; i++)
        g_assert_cmpfloat(length3(a[i].p - b[i].p), <, 1e-3f);
}

/* ---- Ways without end ---- */

/* Rooms that absorb nothing: mirrors all around, glass that light is caught in, white
   walls. A lamp so small that hardly any path meets it. */
#define SMALL_LAMP                                                                       \
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Translate .5 .5 .5 "   \
    "Shape \"sphere\" \"float radius\" 0.001 AttributeEnd\n"
#define WHITE "Material \"diffuse\" \"rgb reflectance\" [1 1 1]\n"
#define MIRROR "Material \"conductor\" \"rgb reflectance\" [1 1 1]\n"
#define IN_GLASS "Material \"dielectric\" \"float eta\" 2\n"

static const char *const endless[] = {
    FROM_WITHIN(2) SMALL_LAMP WHITE BOX,
    FROM_WITHIN(2) SMALL_LAMP MIRROR BOX,
    FROM_WITHIN(2) SMALL_LAMP IN_GLASS BOX MIRROR "Scale 1.5 1.5 1.5 " BOX,
    FROM_WITHIN(2) SMALL_LAMP WHITE "Shape \"disk\" \"float height\" .9 " MIRROR BOX,
};

static void test_ends(void)
{
    static const char *const each[] = {
        "integrator=path passes=1 spp=4",
        "integrator=auto passes=1 spp=4 photons=16",
        "integrator=photonmap passes=1 spp=4 photons=16 radius=.3",
        "integrator=photonmap passes=1 spp=1 photons=16 radius=.3 final_gather=on "
        "gather_rays=8 precompute_radiance=off",
        "integrator=vcm passes=1 spp=4 photons=16 radius=.3",
    };
    for (size_t i = 0; i < G_N_ELEMENTS(endless); i++) {
        g_autoptr(view) v = view_of(endless[i]);
        for (size_t k = 0; k < G_N_ELEMENTS(each); k++) {
            g_test_message("room %zu, %s", i, each[k]);
            g_autofree char *words =
                g_strconcat("caustic_emission=uniform ", each[k], NULL);
            g_autoptr(image) img = render_with(v, words);
            g_assert_true(isfinite(mean_of(img, "")));
        }
    }
}

static bool stop_at_once(double done, const render_statistics *statistics, void *data)
{
    (void)done, (void)statistics;
    (*(int *)data)++;
    return false;
}

/* Also in a room where one path is long. */
static void test_cancel_acts(void)
{
    g_autoptr(view) v = view_of(endless[0]);
    g_autoptr(render) r = render_of(v, "integrator=path passes=1000000 spp=16 threads=1");
    g_autoptr(GError) error = NULL;
    int asked = 0;
    render_run(r, stop_at_once, &asked, &error);
    g_assert_cmpint(asked, >=, 1);
    g_assert_cmpuint(render_get_statistics(r).passes, <=, 1);
    g_assert_cmpint(render_get_statistics(r).stopped_by, ==, RENDER_CANCELLED);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/bounces/white-box", test_white_box);
    g_test_add_func("/bounces/one-depth", test_one_depth);
    g_test_add_func("/bounces/two", test_caustics_are_of_two);
    g_test_add_func("/bounces/interfaces", test_interfaces_are_none);
    g_test_add_func("/bounces/interfaces-in-fog", test_interfaces_in_fog);
    g_test_add_func("/bounces/visible", test_visible_past_interfaces);
    g_test_add_func("/bounces/ends", test_ends);
    g_test_add_func("/bounces/cancel", test_cancel_acts);
    return g_test_run();
}
