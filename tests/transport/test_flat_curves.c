/*
 * Flat curves: every algorithm sees the same light on them. Photons are kept on the axis
 * of a curve, vcm's light subpaths end or merge there.
 *
 * Tolerances are at least five standard deviations of what they compare.
 */
#include "rooms.h"

/* How light is found, and how far off it may be. */
typedef struct way {
    const char *name, *words;
    double tolerance;
} way;

/* ---- Under a sky ---- */

static const way sky_ways[] = {
    {"vcm", "integrator=vcm passes=16 spp=4 photons=4000 radius=0.1", 0.002},
    {"bpt", "integrator=vcm vcm_strategies=bpt passes=16 spp=4 photons=4000", 0.002},
    {"bpm", "integrator=vcm vcm_strategies=bpm passes=16 spp=2 photons=10000 radius=0.2",
     0.06},
    {"ppm", "integrator=vcm vcm_strategies=ppm passes=16 spp=2 photons=10000 radius=0.2",
     0.06},
    {"photonmap-radius",
     "integrator=photonmap direct_illumination=false passes=16 spp=2 photons=20000 "
     "radius=0.2",
     0.05},
    {"photonmap-nearest",
     "integrator=photonmap direct_illumination=false passes=16 spp=2 photons=20000 "
     "direct_nearest=40 indirect_nearest=40",
     0.05},
};

/* A flat curve under a sky of radiance one sends out its reflectance wherever one looks
   from: it turns to every eye, and no ray that leaves it meets it again. */
static void test_sky(gconstpointer data)
{
    const way *how = data;
    g_autoptr(view) v = view_of(
        "LookAt 1 -2 1.5  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 10\n" SIZE(
            8) "WorldBegin LightSource \"infinite\" Material \"diffuse\" \"rgb "
               "reflectance\" [0.5 0.5 0.5] Rotate 20 0 1 0 Shape \"curve\" \"string "
               "type\" \"flat\" \"float width\" 1 \"point3 P\" [0 0 -3 0 0 -1 0 0 1 0 0 "
               "3]\n");
    g_autofree char *words = g_strconcat("max_backward_bounces=-1 ", how->words, NULL);
    g_autoptr(image) img = render_with(v, words);
    double found = mean_of(img, "");
    g_test_message("%s: %g, expected 0.5 (%+.2f %%)", words, found, 200 * found - 100);
    g_assert_cmpfloat(fabs(found / 0.5 - 1), <, how->tolerance);
}

/* ---- In a room ---- */

static const way room_ways[] = {
    {"vcm", "integrator=vcm passes=8 spp=8 photons=10000 radius=0.15", 0.05},
    {"photonmap-radius", "integrator=photonmap passes=8 spp=8 photons=20000 radius=0.1",
     0.05},
    {"photonmap-nearest",
     "integrator=photonmap passes=8 spp=8 photons=20000 direct_nearest=40 "
     "indirect_nearest=40",
     0.05},
    {"photonmap-auto-radius", "integrator=photonmap passes=8 spp=8 photons=20000", 0.05},
    {"photonmap-direct",
     "integrator=photonmap direct_illumination=false passes=8 spp=8 photons=40000 "
     "radius=0.05",
     0.05},
    {"final-gather",
     "integrator=photonmap final_gather=true precompute_radiance=false gather_rays=16 "
     "passes=8 spp=4 photons=20000 radius=0.1",
     0.05},
    {"final-gather-kept",
     "integrator=photonmap final_gather=true precompute_radiance=true gather_rays=16 "
     "passes=8 spp=4 photons=20000 radius=0.1",
     0.05},
};

/* A curtain of strands that hides most of a room, whose walls light it from both sides.
   @param strand what makes one, at the origin along z */
static void check_room(const char *object, const char *strand, const way *how)
{
    g_autoptr(GString) text = g_string_new(
        "LookAt 0 -3 1.2  0 0 0.9  0 0 1 Camera \"perspective\" \"float fov\" 24\n" SIZE(
            16) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS);
    g_string_append(text, object);
    for (int i = 0; i < 30; i++)
        g_string_append_printf(
            text, "AttributeBegin Translate %g %g 0.1 Rotate %d 0 0 1 %s AttributeEnd\n",
            0.06 * i - 0.87, 0.3 * sin(2.0 * i), 50 * i, strand);
    g_autoptr(view) v = view_of(text->str);
    g_autofree char *words = g_strconcat("max_backward_bounces=-1 ", how->words, NULL);
    g_autoptr(image) path =
        render_with(v, "integrator=path passes=8 spp=32 max_backward_bounces=-1");
    g_autoptr(image) found = render_with(v, words);
    const char *const layers[] = {"direct", "indirect"};
    for (size_t i = 0; i < G_N_ELEMENTS(layers); i++) {
        double a = mean_of(found, layers[i]), b = mean_of(path, layers[i]);
        g_test_message("%s %s: %g, path %g (%+.2f %%)", how->name, layers[i], a, b,
                       100 * (a / b - 1));
        g_assert_cmpfloat(fabs(a / b - 1), <, how->tolerance);
    }
}

#define STRAND                                                                           \
    "Shape \"curve\" \"string type\" \"flat\" \"float width0\" 0.03 \"float width1\" "   \
    "0.05 \"point3 P\" [0 -.2 0 .1 0 0.5 0 0 1.1 0 .3 1.7]\n"

static void test_room(gconstpointer data)
{
    check_room("", STRAND, data);
}

/* Copies of an object that is twice as large in its own space, at rest and on their way.
 */
static void test_instances(gconstpointer place)
{
    static const way how = {"instances",
                            "integrator=photonmap direct_illumination=false passes=16 "
                            "spp=8 photons=40000 radius=0.1",
                            0.03};
    g_autofree char *strand = g_strconcat(place, " ObjectInstance \"strand\"", NULL);
    check_room("ObjectBegin \"strand\" AttributeBegin Scale 2 2 2 " STRAND
               "AttributeEnd ObjectEnd\n",
               strand, &how);
}

/* ---- Under glass ---- */

static const way glass_ways[] = {
    {"auto", "integrator=auto passes=8 spp=8 caustic_photons=40000", 0.05},
    {"photonmap", "integrator=photonmap passes=8 spp=8 photons=40000 radius=0.1", 0.05},
    {"vcm", "integrator=vcm passes=8 spp=8 photons=40000 radius=0.1", 0.05},
};

#define PANE                                                                             \
    "AttributeBegin Material \"dielectric\" "                                            \
    "Shape \"trianglemesh\" \"point3 P\" [-6 -6 4 6 -6 4 6 6 4 -6 6 4] "                 \
    "\"integer indices\" [0 2 1 0 3 2] "                                                 \
    "Shape \"trianglemesh\" \"point3 P\" [-6 -6 5 6 -6 5 6 6 5 -6 6 5] "                 \
    "\"integer indices\" [0 1 2 0 2 3] AttributeEnd "

static view *under_sun(const char *pane)
{
    g_autofree char *text = g_strconcat(
        "LookAt 0 -2 1  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 10\n", SIZE(8),
        "WorldBegin LightSource \"distant\" \"rgb L\" [1 1 1] \"point3 from\" [0 0 1] "
        "\"point3 to\" [0 0 0]\n",
        pane,
        "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5] Shape \"curve\" \"string "
        "type\" \"flat\" \"float width\" 1 \"point3 P\" [-3 0 0 -1 0 0 1 0 0 3 0 0]\n",
        NULL);
    return view_of(text);
}

/* A pane lets (1 - R) / (1 + R) of the sun through, R = (0.5 / 2.5)², on a curve that no
   path from the eye finds it by: photons must land on curves. */
static void test_under_glass(gconstpointer data)
{
    const way *how = data;
    g_autoptr(view) bare = under_sun(""), under = under_sun(PANE);
    g_autoptr(image) path = render_with(bare, "integrator=path passes=4 spp=16");
    g_autoptr(image) lit = render_with(under, how->words);
    double found = mean_of(lit, ""), expected = mean_of(path, "") * (1 - 0.04) / 1.04;
    g_test_message("%s: %g, expected %g (%+.2f %%)", how->words, found, expected,
                   100 * (found / expected - 1));
    g_assert_cmpfloat(expected, >, 0);
    g_assert_cmpfloat(fabs(found / expected - 1), <, how->tolerance);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(sky_ways); i++) {
        g_autofree char *name = g_strconcat("/flat-curves/sky/", sky_ways[i].name, NULL);
        g_test_add_data_func(name, &sky_ways[i], test_sky);
    }
    for (size_t i = 0; i < G_N_ELEMENTS(room_ways); i++) {
        g_autofree char *name =
            g_strconcat("/flat-curves/room/", room_ways[i].name, NULL);
        g_test_add_data_func(name, &room_ways[i], test_room);
    }
    for (size_t i = 0; i < G_N_ELEMENTS(glass_ways); i++) {
        g_autofree char *name =
            g_strconcat("/flat-curves/under-glass/", glass_ways[i].name, NULL);
        g_test_add_data_func(name, &glass_ways[i], test_under_glass);
    }
    g_test_add_data_func("/flat-curves/instances/at-rest", "Scale 0.5 0.5 0.5",
                         test_instances);
    g_test_add_data_func("/flat-curves/instances/moving",
                         "Scale 0.5 0.5 0.5 ActiveTransform EndTime Translate 0.3 0.2 0 "
                         "Rotate 70 0 0 1 ActiveTransform All",
                         test_instances);
    return g_test_run();
}
