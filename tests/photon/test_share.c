/*
 * What photons and paths from the eye share is neither lost nor counted twice, whatever
 * the share: it is moved from next to nothing to nearly all by the number of photons, and
 * the picture stays as bright.
 */
#include "rooms.h"

#include "transport/photonmap/photonmap.h"

/* A floor with something upon it, lamps apart. */
#define FLOOR                                                                            \
    "LookAt 0 -3 3  0 0 0.2  0 0 1 Camera \"perspective\" \"float fov\" 45\n" SIZE(      \
        12) "WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [0.6 0.6 0.6]\n"       \
            "Shape \"trianglemesh\" \"point3 P\" [-2 -2 0 2 -2 0 2 2 0 -2 2 0] "         \
            "\"integer indices\" [0 1 2 0 2 3]\n"
#define WALL                                                                             \
    "Shape \"trianglemesh\" \"point3 P\" [-2 1.5 0 2 1.5 0 2 1.5 2 -2 1.5 2] "           \
    "\"integer indices\" [0 2 1 0 3 2]\n"
#define BALL "Translate 0 0 0.6 Shape \"sphere\" \"float radius\" 0.4\n"
#define LAMP(size)                                                                       \
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [8 8 8] Translate 1 0 3 "      \
    "Rotate 180 1 0 0 Shape \"disk\" \"float radius\" " #size " AttributeEnd\n"
#define SKY "LightSource \"infinite\" \"rgb L\" [1 1 1]\n"

/* Noise is 3 %; a share that one side has wrong shows by tens of per cent. */
#define TOLERANCE 0.2

typedef struct shared_scene {
    const char *name, *text;
} shared_scene;

static const shared_scene scenes[] = {
    {"metal",
     FLOOR WALL LAMP(1.5) "Material \"conductor\" \"float roughness\" 0.05 " BALL},
    {"rough-dispersive-glass",
     FLOOR LAMP(1.5) "Material \"dielectric\" \"spectrum eta\" \"glass-BK7\" "
                     "\"float roughness\" 0.05 " BALL},
    {"sky", FLOOR WALL SKY "Material \"dielectric\" " BALL},
    {"spot", FLOOR WALL
     "LightSource \"spot\" \"point3 from\" [1 0 3] \"point3 to\" [0 0 0.6] "
     "\"rgb I\" [9 9 9] Material \"conductor\" \"float roughness\" 0.05 " BALL},
    {"lamps", FLOOR WALL LAMP(1) SKY
     "LightSource \"point\" \"point3 from\" [-1 -1 2] \"rgb I\" [2 2 2] "
     "Material \"conductor\" \"float roughness\" 0.05 " BALL},
};

static void test_nothing_is_lost_or_counted_twice(gconstpointer data)
{
    const shared_scene *of = data;
    g_autoptr(scene) s = scene_of(of->text);
    g_autoptr(image) path = render_with(s, "integrator=path passes=8 spp=128 seed=1");
    const char *const ways[] = {
        "integrator=auto passes=8 spp=64 caustic_photons=100 radius=0.03 alpha=1",
        "integrator=auto passes=8 spp=16 caustic_photons=2000 radius=0.03 alpha=1",
        "integrator=auto passes=8 spp=16 caustic_photons=20000 radius=0.03 alpha=1",
    };
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autoptr(image) shared = render_with(s, ways[i]);
        double a = mean_of(shared, "caustic"), b = mean_of(path, "caustic");
        g_test_message("%s: %s: %g, path %g (%+.2f %%)", of->name, ways[i], a, b,
                       100 * (a / b - 1));
        g_assert_cmpfloat(fabs(a / b - 1.0), <, TOLERANCE);
    }
}

/* A ball of glass on its way past: in each slice of time its caustic has few photons, and
   the automatic radius must not reach for many of them from afar. Without a bound on what
   it wants it is a quarter too bright. */
#define PASSING                                                                          \
    "LookAt 0 -4 1.6  0 0 0.6  0 0 1 Camera \"perspective\" \"float fov\" 42\n" SIZE(    \
        40) "WorldBegin\nMaterial \"diffuse\" Shape \"disk\" \"float radius\" 6\n"       \
            "LightSource \"infinite\" \"rgb L\" [0.1 0.1 0.12] AttributeBegin "          \
            "Translate 1.5 -1 4 "                                                        \
            "AreaLightSource \"diffuse\" \"rgb L\" [40 40 40] Shape \"sphere\" \"float " \
            "radius\" "                                                                  \
            "0.3 AttributeEnd ActiveTransform EndTime Translate 0.8 0 0 "                \
            "ActiveTransform All "                                                       \
            "Translate -0.4 0 0.5 Material \"dielectric\" Shape \"sphere\" \"float "     \
            "radius\" 0.5\n"

static void test_few_photons_do_not_shine_afar(void)
{
    g_autoptr(scene) s = scene_of(PASSING);
    g_autoptr(image) few = render_with(s, "integrator=auto passes=24 spp=4 seed=1");
    g_autoptr(image) many =
        render_with(s, "integrator=photonmap passes=4 spp=16 caustic_photons=100000 "
                       "photons=1000 radius=0.03 alpha=1 seed=2");
    double a = mean_of(few, "caustic"), b = mean_of(many, "caustic");
    g_test_message("few photons %g, many %g (%+.2f %%)", a, b, 100 * (a / b - 1));
    g_assert_cmpfloat(fabs(a / b - 1.0), <, 0.15);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(scenes); i++) {
        g_autofree char *path = g_strconcat("/share/", scenes[i].name, NULL);
        g_test_add_data_func(path, &scenes[i], test_nothing_is_lost_or_counted_twice);
    }
    g_test_add_func("/share/few-photons", test_few_photons_do_not_shine_afar);
    return g_test_run();
}
