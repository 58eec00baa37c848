/*
 * unseen_lamp: area lights of alpha 0, which no ray meets and which shine all the same
 * (pbrt-v4): the floor under one against a closed form, by every algorithm; through glass
 * the same caustic as of a lamp that is there; in a mirror and before the camera nothing.
 */
#include "rooms.h"

#include <math.h>

#define LAMP(alpha)                                                                      \
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [5 5 5] Material \"diffuse\" " \
    "Translate 0 0 2 Rotate 180 1 0 0 Shape \"disk\" \"float radius\" 0.5 " alpha        \
    " AttributeEnd\n"
#define FLOOR                                                                            \
    "Shape \"trianglemesh\" \"point3 P\" [-9 -9 0 9 -9 0 9 9 0 -9 9 0] \"integer "       \
    "indices\" [0 1 2 0 2 3]\n"
/* A patch of 0.2 m under the lamp. */
#define PATCH_CAMERA                                                                     \
    "LookAt 0 0 1 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 11.4\n" SIZE(4)

/* Under a disk of radius r, h above: E = π L r² / (r² + h²), and a matt floor of 0.5
   sends back E / 2π; 0.1 m off the axis that is less by 1 %. */
static void test_floor(void)
{
    static const struct {
        const char *way;
        double tolerance; /* five deviations or more */
    } ways[] = {
        {"integrator=path passes=4 spp=64", 0.02},
        {"integrator=photonmap passes=4 spp=16 photons=40000", 0.02},
        {"integrator=auto passes=4 spp=64 photons=20000", 0.02},
        {"integrator=vcm passes=4 spp=64 photons=8192", 0.06},
        {"integrator=vcm vcm_strategies=light passes=4 spp=64", 0.06},
        {"integrator=vcm vcm_strategies=bpt passes=4 spp=64", 0.03},
        {"integrator=vcm vcm_strategies=ppm passes=8 spp=4 photons=160000", 0.08},
    };
    const double expected = 0.5 * 5.0 * 0.25 / (0.25 + 4.0);
    g_autoptr(view) v = view_of(PATCH_CAMERA "WorldBegin\n" LAMP(
        "\"float alpha\" 0") "Material "
                             "\"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n" FLOOR);
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autoptr(image) img = render_with(v, ways[i].way);
        double found = mean_of(img, "");
        g_test_message("%s: %g, expected %g", ways[i].way, found, expected);
        g_assert_cmpfloat(fabs(found / expected - 1.0), <, ways[i].tolerance);
    }
}

/* A floor that is a mirror, or brushed so that both ways to find the lamp count: light
   that only following could find is missing, light that both find is not. */
static void test_mirrors(void)
{
    static const char brushed[] = "Material \"conductor\" \"float roughness\" 0.2\n";
    g_autofree char *shown_text =
        g_strconcat(PATCH_CAMERA "WorldBegin\n" LAMP(""), brushed, FLOOR, NULL);
    g_autofree char *unseen_text = g_strconcat(
        PATCH_CAMERA "WorldBegin\n" LAMP("\"float alpha\" 0"), brushed, FLOOR, NULL);
    g_autoptr(view) shown = view_of(shown_text), unseen = view_of(unseen_text);
    g_autoptr(view) mirror = view_of(PATCH_CAMERA "WorldBegin\n" LAMP(
        "\"float alpha\" 0") "Material \"conductor\"\n" FLOOR);
    static const char *const ways[] = {"integrator=path passes=4 spp=64",
                                       "integrator=auto passes=4 spp=64 photons=9999",
                                       "integrator=vcm passes=4 spp=64 photons=8192"};
    g_autoptr(image) truth = render_with(shown, "integrator=path passes=4 spp=128");
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autoptr(image) img = render_with(unseen, ways[i]);
        g_autoptr(image) black = render_with(mirror, ways[i]);
        g_test_message("%s: %g, expected %g", ways[i], mean_of(img, ""),
                       mean_of(truth, ""));
        g_assert_cmpfloat(fabs(mean_of(img, "") / mean_of(truth, "") - 1.0), <, 0.03);
        g_assert_cmpfloat(mean_of(black, ""), <=, 0.0);
    }
}

/* The lamp before the camera: nothing of it is seen, nor does it hide the floor. */
static void test_camera(void)
{
    static const char above[] =
        "LookAt 0 0 4 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 5\n" SIZE(
            4) "WorldBegin\n" LAMP("\"float alpha\" 0 ") "Material \"diffuse\" \"rgb "
                                                         "reflectance\" [0.5 0.5 "
                                                         "0.5]\n" FLOOR;
    const double expected = 0.5 * 5.0 * 0.25 / (0.25 + 4.0);
    g_autoptr(view) v = view_of(above);
    g_autoptr(image) img = render_with(v, "integrator=path passes=4 spp=64");
    g_assert_cmpfloat(fabs(mean_of(img, "") / expected - 1.0), <, 0.04);
    g_assert_cmpfloat(mean_of(img, "emission"), <=, 0.0);
}

/* A glass ball between: photons bring its caustic, as of a lamp that is there. */
static void test_caustic(void)
{
    static const char ball[] =
        "AttributeBegin Material \"dielectric\" Translate 0 0 0.6 Shape \"sphere\" "
        "\"float radius\" 0.3 AttributeEnd\n"
        "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n" FLOOR;
    static const char eye[] =
        "LookAt 1.5 0 0.4 0 0 0 0 0 1 Camera \"perspective\" \"float fov\" 14\n" SIZE(4);
    g_autofree char *a = g_strconcat(eye, "WorldBegin\n" LAMP(""), ball, NULL);
    g_autofree char *b =
        g_strconcat(eye, "WorldBegin\n" LAMP("\"float alpha\" 0"), ball, NULL);
    g_autoptr(view) shown = view_of(a), unseen = view_of(b);
    static const char *const ways[] = {
        "integrator=auto passes=8 spp=16 photons=20000",
        "integrator=vcm passes=8 spp=16 photons=20000 radius=0.01",
        "integrator=photonmap passes=8 spp=16 photons=20000"};
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autoptr(image) seen = render_with(shown, ways[i]);
        g_autoptr(image) found = render_with(unseen, ways[i]);
        g_test_message("%s: %g, expected %g", ways[i], mean_of(found, ""),
                       mean_of(seen, ""));
        g_assert_cmpfloat(fabs(mean_of(found, "") / mean_of(seen, "") - 1.0), <, 0.04);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/unseen-lamp/floor", test_floor);
    g_test_add_func("/unseen-lamp/mirrors", test_mirrors);
    g_test_add_func("/unseen-lamp/camera", test_camera);
    g_test_add_func("/unseen-lamp/caustic", test_caustic);
    return g_test_run();
}
