/*
 * vcm where a wrong weight or a lost factor hardly shows in a room: against closed forms,
 * each with so few and so many light subpaths that every strategy has its turn.
 *
 * Tolerances are at least five standard deviations of what they compare.
 */
#include "rooms.h"

static double mean_with(const scene *s, const char *words)
{
    g_autoptr(image) img = render_with(s, words);
    return mean_of(img, "");
}

static void check(const scene *s, const char *words, double expected, double tolerance)
{
    double found = mean_with(s, words);
    g_test_message("%s: %g, expected %g (%+.2f %%)", words, found, expected,
                   100 * (found / expected - 1));
    g_assert_cmpfloat(fabs(found / expected - 1), <, tolerance);
}

/* ---- The sky ---- */

/* What a plane sends out under a sky of radiance one is its reflectance. */
static void test_sky(void)
{
    g_autoptr(scene) s = scene_of(
        "LookAt 0 -1 1  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 30\n" SIZE(
            8) "WorldBegin LightSource \"infinite\" Material \"diffuse\" \"rgb "
               "reflectance\" [0.5 0.5 0.5] Shape \"disk\" "
               "\"float radius\" 1.5\n");
    double sum = 0.5; /* of all strategies */
    check(s, "integrator=path passes=32 spp=16", sum, 0.004);
    check(s, "integrator=vcm passes=32 spp=16 photons=100 radius=0.02", sum, 0.008);
    check(s, "integrator=vcm passes=16 spp=1 photons=10000 radius=0.1", sum, 0.015);
    check(s, "integrator=vcm vcm_strategies=bpt passes=16 spp=1 photons=10000", sum,
          0.015);
}

/* ---- Lamps in solids ---- */

/* A lamp at height 1 over a floor, all in a solid that absorbs: straight below, radiance
   is ρ/π I e^{-σ h} / h². */
static void test_lamp_in_solid(void)
{
    g_autoptr(scene) s = scene_of(
        "LookAt 0.5 0 0.5  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 2\n" SIZE(
            4) "WorldBegin\n"
               "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5] Shape \"disk\" "
               "\"float radius\" 2\n"
               "AttributeBegin Material \"dielectric\" \"float eta\" 1 \"spectrum "
               "absorption\" [300 2 900 2] Shape \"sphere\" \"float radius\" 3 "
               "AttributeEnd\n"
               "LightSource \"point\" \"spectrum I\" [300 1 900 1] \"point3 from\" "
               "[0 0 1]\n");
    g_autoptr(scene) open = scene_of(
        "LookAt 0.5 0 0.5  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 2\n" SIZE(
            4) "WorldBegin\n"
               "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5] Shape \"disk\" "
               "\"float radius\" 2\n"
               "LightSource \"point\" \"spectrum I\" [300 1 900 1] \"point3 from\" "
               "[0 0 1]\n");
    double way = 1.0 + sqrt(0.5);
    double expected =
        mean_with(open, "integrator=path passes=16 spp=16") * exp(-2.0 * way);
    check(s, "integrator=vcm passes=16 spp=16 photons=100 radius=0.01", expected, 0.04);
    check(s, "integrator=vcm passes=8 spp=1 photons=20000 radius=0.1", expected, 0.04);
    check(s, "integrator=vcm vcm_strategies=bpm passes=8 spp=1 photons=20000 radius=0.1",
          expected, 0.04);
}

/* ---- Flat curves ---- */

#define CURVE(points)                                                                    \
    "Shape \"curve\" \"string type\" \"flat\" \"float width\" 0.15 \"point3 P\" "        \
    "[" points "]\n"
#define CURVES                                                                           \
    CURVE("-1 -.2 .1 -1 0 .6 -.8 0 1.2 -.7 .2 1.8")                                      \
    CURVE("-.5 .4 .1 -.6 .4 .6 -.3 .5 1.2 -.2 .2 1.7")                                   \
    CURVE("0 -.5 .1 0 0 .5 .2 0 1.1 .3 .2 1.8")                                          \
    CURVE(".4 1 .1 .5 1 .6 .1 1 1 0 1 1.8")                                              \
    CURVE(".8 0 .1 .8 0 .6 .9 0 1.2 .6 .2 1.7") CURVE("-1 1 1 -.5 .9 1.3 .5 1 .9 1 1 1")

/* How the light of a curve is found, and what noise is left. */
typedef struct way {
    const char *name, *words;
    double tolerance;
} way;

static const way ways[] = {
    {"all", "passes=16 spp=4 photons=4000 radius=0.1", 0.008},
    {"bpt", "vcm_strategies=bpt passes=16 spp=4 photons=4000", 0.008},
    {"bpm", "vcm_strategies=bpm passes=16 spp=2 photons=10000 radius=0.2", 0.06},
    {"ppm", "vcm_strategies=ppm passes=16 spp=2 photons=10000 radius=0.2", 0.06},
};

static void check_way(const scene *s, const char *words, double expected,
                      double tolerance)
{
    g_autofree char *all =
        g_strconcat("integrator=vcm max_backward_bounces=-1 ", words, NULL);
    check(s, all, expected, tolerance);
}

/* A flat curve under a sky of radiance one sends out its reflectance wherever one looks
   from: it turns to every eye, and no ray that leaves it meets it again. */
static void test_flat_curve_under_sky(gconstpointer data)
{
    const way *how = data;
    g_autoptr(scene) s = scene_of(
        "LookAt 1 -2 1.5  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 10\n" SIZE(
            8) "WorldBegin LightSource \"infinite\" Material \"diffuse\" \"rgb "
               "reflectance\" [0.5 0.5 0.5] Rotate 20 0 1 0 Shape \"curve\" \"string "
               "type\" \"flat\" \"float width\" 1 \"point3 P\" [0 0 -3 0 0 -1 0 0 1 0 0 "
               "3]\n");
    check_way(s, how->words, 0.5, how->tolerance);
}

/* Light that comes to the curves and goes on from them by way of the walls. */
static void test_flat_curves_in_room(void)
{
    g_autofree char *text = g_strconcat(ROOM, CURVES, NULL);
    g_autoptr(scene) s = scene_of(text);
    g_autoptr(image) path =
        render_with(s, "integrator=path passes=8 spp=32 max_backward_bounces=-1");
    g_autoptr(image) vcm = render_with(s, "integrator=vcm passes=8 spp=8 photons=10000 "
                                          "radius=0.15 max_backward_bounces=-1");
    const char *const layers[] = {"direct", "indirect"};
    for (size_t i = 0; i < G_N_ELEMENTS(layers); i++) {
        double a = mean_of(vcm, layers[i]), b = mean_of(path, layers[i]);
        g_test_message("%s: %g, path %g (%+.2f %%)", layers[i], a, b, 100 * (a / b - 1));
        g_assert_cmpfloat(fabs(a / b - 1), <, 0.03);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/vcm-weights/sky", test_sky);
    g_test_add_func("/vcm-weights/lamp-in-solid", test_lamp_in_solid);
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autofree char *sky = g_strconcat("/vcm-weights/curve/sky/", ways[i].name, NULL);
        g_test_add_data_func(sky, &ways[i], test_flat_curve_under_sky);
    }
    g_test_add_func("/vcm-weights/curve/room", test_flat_curves_in_room);
    return g_test_run();
}
