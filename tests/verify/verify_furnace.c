/*
 * Furnaces: closed boxes that shine 1 and reflect one half everywhere. Radiance is 2 in
 * every place and direction, whatever clear glass stands in them, and right into their
 * corners; and within glass of index n it is 2 n².
 */
#include "rooms.h"
#include "verify.h"

#define BOX                                                                              \
    "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"                           \
    "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true\n"             \
    "Shape \"trianglemesh\" \"point3 P\" [-1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1 -1 -1 1 1 -1 " \
    "1 1 1 1 -1 1 1] \"integer indices\" [0 1 2 0 2 3 4 6 5 4 7 6 0 5 1 0 4 5 3 2 6 3 "  \
    "6 "                                                                                 \
    "7 0 3 7 0 7 4 1 5 6 1 6 2]\n"

#define GLASS_CUBE                                                                       \
    "AttributeBegin Material \"dielectric\" \"float eta\" 1.5 Rotate 30 1 2 3 Scale "    \
    "0.3 "                                                                               \
    "0.3 0.3 Shape \"trianglemesh\" \"point3 P\" [-1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1 -1 "   \
    "-1 "                                                                                \
    "1 1 -1 1 1 1 1 -1 1 1] \"integer indices\" [0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 3 " \
    "6 2 3 7 6 0 7 3 0 4 7 1 6 5 1 2 6] AttributeEnd\n"

#define CAMERA_AT(look, fov)                                                             \
    "LookAt " look " 0 0 1 Camera \"perspective\" \"float fov\" " #fov                   \
    "\n" SIZE(8) "WorldBegin\n"

/* An algorithm, its settings, and the bias allowed to a block. */
typedef struct way {
    const char *name, *words;
    double bias;
} way;

typedef struct furnace {
    const char *name, *text;
    double radiance;
} furnace;

static const furnace furnaces[] = {
    {"box", CAMERA_AT("0 0 0  1 0.3 0.2", 100) BOX, 2},
    {"glass-cube", CAMERA_AT("-0.9 -0.8 0.3  0 0 0", 40) GLASS_CUBE BOX, 2},
    {"in-glass",
     CAMERA_AT("0 0 0  1 0.3 0.2", 60) "AttributeBegin Material \"dielectric\" \"float "
                                       "eta\" 1.5 Shape \"sphere\" \"float radius\" "
                                       "0.4 AttributeEnd\n" BOX,
     2 * 1.5 * 1.5},
};

static const way ways[] = {
    {"sppm", "integrator=sppm spp=8 photons=40000 max_backward_bounces=-1", 0.01},
    {"vcm", "integrator=vcm spp=32 photons=2000 max_backward_bounces=-1", 0},
    {"auto", "integrator=auto spp=64 photons=4000 max_backward_bounces=-1", 0.01},
};

static void test_furnace(gconstpointer data)
{
    const furnace *f = data;
    g_autoptr(view) v = view_of(f->text);
    g_auto(yardstick) is = {.expected = f->radiance};
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++)
        verify_agree(ways[i].name,
                     &(subject){.view = v, .words = ways[i].words, .lamps = true}, &is,
                     32,
                     (allowance){VERIFY_SHORT_LONG(0.0025, 0.001), ways[i].bias,
                                 !(ways[i].bias > 0)});
}

/* The camera sees 0.2 m of each of three walls where they meet, and photons are gathered
   from 0.15 m around. Half of what it sees is reflected: that is known to 2 %. */
static void test_corner(gconstpointer data)
{
    const way *w = data;
    g_autoptr(view) v = view_of(CAMERA_AT("0.4 0.5 0.45  1 1 1", 16) BOX);
    g_auto(yardstick) is = {.expected = 2};
    verify_agree(w->name, &(subject){.view = v, .words = w->words, .lamps = true}, &is,
                 32, (allowance){0.01, 0.01, true});
}

#define WIDE " radius=0.15 alpha=1 max_backward_bounces=-1"

static const way corner_ways[] = {
    {"photonmap", "integrator=photonmap spp=8 photons=40000" WIDE, 0},
    {"direct-map",
     "integrator=photonmap direct_illumination=off spp=8 photons=40000" WIDE, 0},
    {"nearest",
     "integrator=photonmap spp=4 photons=40000 indirect_nearest=200 photon_map=kdtree",
     0},
    {"final-gather",
     "integrator=photonmap spp=2 photons=20000 final_gather=on gather_rays=16" WIDE, 0},
    {"sppm", "integrator=sppm spp=8 photons=40000 radius=0.15", 0},
    {"vcm", "integrator=vcm spp=32 photons=2000" WIDE, 0},
    {"bpm", "integrator=vcm vcm_strategies=bpm spp=8 photons=20000" WIDE, 0},
    {"ppm", "integrator=vcm vcm_strategies=ppm spp=8 photons=20000" WIDE, 0},
};

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(furnaces); i++) {
        g_autofree char *name = g_strconcat("/verify/furnace/", furnaces[i].name, NULL);
        g_test_add_data_func(name, &furnaces[i], test_furnace);
    }
    for (size_t i = 0; i < G_N_ELEMENTS(corner_ways); i++) {
        g_autofree char *name =
            g_strconcat("/verify/furnace/corner/", corner_ways[i].name, NULL);
        g_test_add_data_func(name, &corner_ways[i], test_corner);
    }
    return g_test_run();
}
