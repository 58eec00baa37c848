/*
 * What must not matter: the unit of length, which way the world is turned, and left and
 * right. A change of the world is applied to the camera too, so that the picture is the
 * same but for noise; mirrored alone, the world gives the mirrored picture.
 */
#include "rooms.h"
#include "verify.h"

/* The room from aside, so that nothing is symmetrical; a piece of glass, a rough ball. */
#define LOOK "LookAt 0.4 -3.4 1.2  0 0 0.9  0 0 1 "
#define CAMERA " Camera \"perspective\" \"float fov\" 55\n" SIZE(24) "WorldBegin "
#define THINGS                                                                           \
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [2.3 2 1.8] Material "         \
    "\"diffuse\" \"rgb reflectance\" [0 0 0] Shape \"trianglemesh\" \"point3 P\" [-1.4 " \
    "-1.9 1.9 -1.4 1.2 1.9 1.4 1.2 1.9 1.4 -1.9 1.9] \"integer indices\" [0 1 2 0 2 3] " \
    "AttributeEnd\n" ROOM_WALLS                                                          \
    "AttributeBegin Material \"dielectric\" Translate 0.6 0 0.6 Shape "                  \
    "\"trianglemesh\" \"point3 P\" [0.5 0 0 0 0.5 0 -0.5 0 0 0 -0.5 0 0 0 0.5 0 0 "      \
    "-0.5] "                                                                             \
    "\"integer indices\" [0 1 4 1 2 4 2 3 4 3 0 4 1 0 5 2 1 5 3 2 5 0 3 5] "             \
    "AttributeEnd\n"                                                                     \
    "AttributeBegin Material \"conductor\" \"float roughness\" 0.2 Translate -0.8 0.3 "  \
    "0.5 Shape \"sphere\" \"float radius\" 0.4 AttributeEnd\n"                           \
    "LightSource \"spot\" \"rgb I\" [3 1 1] \"point3 from\" [1.5 -1 1.5] \"point3 to\" " \
    "[0 0 0] \"float coneangle\" 40 \"float conedeltaangle\" 15 \"float scale\" "

typedef struct change {
    const char *name, *of_world, *back; /* and what takes it back */
    const char *intensity; /* of lamps that have no size: as the square of lengths */
} change;

static const change changes[] = {
    {"thousand", "Scale 1000 1000 1000", "Scale 0.001 0.001 0.001", "1e6"},
    {"thousandth", "Scale 0.001 0.001 0.001", "Scale 1000 1000 1000", "1e-6"},
    {"thousand millionth", "Scale 1e-9 1e-9 1e-9", "Scale 1e9 1e9 1e9", "1e-18"},
    {"thousand million", "Scale 1e9 1e9 1e9", "Scale 1e-9 1e-9 1e-9", "1e18"},
    {"turned", "Rotate 50 1 2 3", "Rotate -50 1 2 3", "1"},
    {"mirrored", "Scale -1 1 1", "Scale -1 1 1", "1"},
    {"moved", "Translate 50 -20 70", "Translate -50 20 -70", "1"},
};

static const char *const ways[] = {
    "integrator=path spp=4",
    "integrator=auto spp=2 photons=4000",
    "integrator=sppm spp=1 photons=6000",
    "integrator=vcm spp=1 photons=4096",
};

static view *changed_scene(const char *look, const change *c)
{
    g_autofree char *text = g_strconcat(look, c->back, CAMERA, c->of_world, "\n", THINGS,
                                        c->intensity, "\n", NULL);
    return view_of(text);
}

static const change nothing = {"", "", "", "1"},
                    mirrored_world = {"", "Scale -1 1 1", "", "1"};

/* The same random numbers go the same ways but where rounding turns a ray at an edge:
   what that does to a pixel is next to nothing, but no noise. */
static const allowance allowed = {0.005, 0.005, false};

static void test_changes(gconstpointer way)
{
    g_autoptr(view) plain = changed_scene(LOOK, &nothing);
    g_auto(yardstick) is = {.of = {.view = plain, .words = way}};
    for (size_t i = 0; i < G_N_ELEMENTS(changes); i++) {
        g_autoptr(view) v = changed_scene(LOOK, &changes[i]);
        verify_agree(changes[i].name, &(subject){.view = v, .words = way}, &is, 32,
                     allowed);
    }
}

/* The world mirrored at x = 0 and the eye with it, but not the picture. Other numbers
   then go other ways, and blur alike: each pixel must be the same, to noise. */
static void test_mirror_image(gconstpointer way)
{
    g_autoptr(view) plain = changed_scene(LOOK, &nothing);
    g_autoptr(view) v =
        changed_scene("LookAt -0.4 -3.4 1.2  0 0 0.9  0 0 1 ", &mirrored_world);
    g_auto(yardstick) is = {.of = {.view = plain, .words = way}};
    verify_agree("mirror image", &(subject){.view = v, .words = way, .flip = true}, &is,
                 32, (allowance){0.005, 0.005, true});
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_auto(GStrv) words = g_strsplit(ways[i] + strlen("integrator="), " ", 2);
        g_autofree char *name = g_strconcat("/verify/invariance/", words[0], NULL);
        g_autofree char *flip =
            g_strconcat("/verify/invariance/mirror-image/", words[0], NULL);
        g_test_add_data_func(name, ways[i], test_changes);
        g_test_add_data_func(flip, ways[i], test_mirror_image);
    }
    return g_test_run();
}
