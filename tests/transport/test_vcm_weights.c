/*
 * vcm where a wrong weight or a lost factor hardly shows in a room: against closed forms,
 * each with so few and so many light subpaths that every strategy has its turn.
 *
 * Tolerances are at least five standard deviations of what they compare.
 */
#include "rooms.h"

static double mean_with(const view *v, const char *words)
{
    g_autoptr(image) img = render_with(v, words);
    return mean_of(img, "");
}

static void check(const view *v, const char *words, double expected, double tolerance)
{
    double found = mean_with(v, words);
    g_test_message("%s: %g, expected %g (%+.2f %%)", words, found, expected,
                   100 * (found / expected - 1));
    g_assert_cmpfloat(fabs(found / expected - 1), <, tolerance);
}

/* ---- The sky ---- */

/* What a plane sends out under a sky of radiance one is its reflectance. */
static void test_sky(void)
{
    g_autoptr(view) v = view_of(
        "LookAt 0 -1 1  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 30\n" SIZE(
            8) "WorldBegin LightSource \"infinite\" Material \"diffuse\" \"rgb "
               "reflectance\" [0.5 0.5 0.5] Shape \"disk\" "
               "\"float radius\" 1.5\n");
    double sum = 0.5; /* of all strategies */
    check(v, "integrator=path passes=32 spp=16", sum, 0.004);
    check(v, "integrator=vcm passes=32 spp=16 photons=100 radius=0.02", sum, 0.008);
    check(v, "integrator=vcm passes=16 spp=1 photons=10000 radius=0.1", sum, 0.015);
    check(v, "integrator=vcm vcm_strategies=bpt passes=16 spp=1 photons=10000", sum,
          0.015);
}

/* ---- Lamps in solids ---- */

/* A lamp at height 1 over a floor, all in a solid that absorbs: straight below, radiance
   is ρ/π I e^{-σ h} / h². */
static void test_lamp_in_solid(void)
{
    g_autoptr(view) v = view_of(
        "LookAt 0.5 0 0.5  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 2\n" SIZE(
            4) "WorldBegin\n"
               "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5] Shape \"disk\" "
               "\"float radius\" 2\n"
               "AttributeBegin Material \"dielectric\" \"float eta\" 1 \"spectrum "
               "absorption\" [300 2 900 2] Shape \"sphere\" \"float radius\" 3 "
               "AttributeEnd\n"
               "LightSource \"point\" \"spectrum I\" [300 1 900 1] \"point3 from\" "
               "[0 0 1]\n");
    g_autoptr(view) open = view_of(
        "LookAt 0.5 0 0.5  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 2\n" SIZE(
            4) "WorldBegin\n"
               "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5] Shape \"disk\" "
               "\"float radius\" 2\n"
               "LightSource \"point\" \"spectrum I\" [300 1 900 1] \"point3 from\" "
               "[0 0 1]\n");
    double way = 1.0 + sqrt(0.5);
    double expected =
        mean_with(open, "integrator=path passes=16 spp=16") * exp(-2.0 * way);
    check(v, "integrator=vcm passes=16 spp=16 photons=100 radius=0.01", expected, 0.04);
    check(v, "integrator=vcm passes=8 spp=1 photons=20000 radius=0.1", expected, 0.04);
    check(v, "integrator=vcm vcm_strategies=bpm passes=8 spp=1 photons=20000 radius=0.1",
          expected, 0.04);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/vcm-weights/sky", test_sky);
    g_test_add_func("/vcm-weights/lamp-in-solid", test_lamp_in_solid);
    return g_test_run();
}
