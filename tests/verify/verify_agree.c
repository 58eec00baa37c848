/*
 * Small scenes, ten and more, by every algorithm: the same light, whichever way it is
 * found.
 *
 * Path tracing is the truth: it has no bias. Photon mapping has one where it blurs: its
 * radii, as the renderer chooses them, are some pixels wide and shrink from pass to pass,
 * so that what is left of it is a small share of blocks of 4 x 4 pixels, and that share
 * is allowed; the mean over the picture is held to the same half per cent as all. Pixel
 * by pixel such pictures differ, and should: what is sharp is a shadow's edge or a
 * corner. So pixels are compared with what does not blur: bidirectional paths, and all
 * others with radii that are small beside a pixel, more photons making up for it.
 */
#include "rooms.h"
#include "verify.h"

#include <string.h>

typedef struct place {
    const char *name, *text;
    const char *more; /* settings of the photons that blur */
} place;

#define EYE(more)                                                                        \
    "LookAt 0 -3.4 1.2  0 0 0.9  0 0 1 Camera \"perspective\" \"float fov\" 55 " more    \
    "\n" SIZE(32) "WorldBegin\n"
#define BALL "Translate 0 0 0.6 Shape \"sphere\" \"float radius\" 0.5\n"
/* A lamp so large that little of what is compared is the noise of its image in a mirror.
 */
#define WIDE_LAMP                                                                        \
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [2.3 2 1.8] Material "         \
    "\"diffuse\" \"rgb reflectance\" [0 0 0] Shape \"trianglemesh\" \"point3 P\" "       \
    "[-1.4 -1.9 1.9 -1.4 1.2 1.9 1.4 1.2 1.9 1.4 -1.9 1.9] \"integer indices\" [0 1 2 "  \
    "0 "                                                                                 \
    "2 3] AttributeEnd\n"
#define IN_ROOM(more) EYE("") WIDE_LAMP ROOM_WALLS more

/* No walls to the sides and above, but a floor and a wall behind. */
#define STAGE                                                                            \
    "Material \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.5]\n"                           \
    "Shape \"trianglemesh\" \"point3 P\" [-4 -2 0 4 -2 0 4 4 0 -4 4 0] \"integer "       \
    "indices\" [0 1 2 0 2 3]\n"                                                          \
    "Shape \"trianglemesh\" \"point3 P\" [-4 2 0 4 2 0 4 2 3 -4 2 3] \"integer "         \
    "indices\" [0 1 2 0 2 3] Shape \"sphere\" \"float radius\" 0.5\n"

/* The floor pretends to be tilted, so that light by way of it and onto it tells whether
   normals are taken for what they are. */
static const place places[] = {
    {"empty", IN_ROOM(""), ""},
    {"mirror",
     IN_ROOM("Material \"conductor\" \"spectrum eta\" \"metal-Ag-eta\" "
             "\"spectrum k\" \"metal-Ag-k\" " BALL),
     ""},
    {"glass", IN_ROOM("Material \"dielectric\" " BALL), ""},
    {"dispersive",
     IN_ROOM("Material \"dielectric\" \"spectrum eta\" \"glass-N-SF11\" " BALL), ""},
    {"rough-metal",
     IN_ROOM("Material \"conductor\" \"float roughness\" 0.15 \"bool "
             "remaproughness\" false " BALL),
     ""},
    {"rough-glass",
     IN_ROOM("Material \"dielectric\" \"float roughness\" 0.3 \"bool "
             "remaproughness\" false " BALL),
     ""},
    {"plastic",
     IN_ROOM("Material \"coateddiffuse\" \"rgb reflectance\" [0.2 0.4 0.8] " BALL), ""},
    {"shading-normals",
     IN_ROOM("Shape \"trianglemesh\" \"point3 P\" [-2 -4 0.01 2 -4 0.01 2 2 0.01 -2 2 "
             "0.01] \"normal N\" [0.5 0.2 0.8 0.5 0.2 0.8 0.5 0.2 0.8 0.5 0.2 0.8] "
             "\"integer indices\" [0 1 2 0 2 3]\n"
             "Translate 0 0 0.8 Shape \"trianglemesh\" \"point3 P\" [1 0 0 0 1 0 -1 0 0 "
             "0 -1 0 0 0 0.8 0 0 -0.8] \"normal N\" [1 0 0 0 1 0 -1 0 0 0 -1 0 0 0 1 0 0 "
             "-1] \"integer indices\" [0 1 4 1 2 4 2 3 4 3 0 4 1 0 5 2 1 5 3 2 5 0 3 "
             "5]\n"),
     ""},
    {"lens-and-pane",
     EYE("\"float lensradius\" 0.1 \"float focaldistance\" 3") STAGE
     "LightSource \"infinite\" \"rgb L\" [0.4 0.5 0.8]\n"
     "AttributeBegin Material \"thindielectric\" Translate 0.3 -0.6 0.7 Rotate "
     "70 1 0 0 Shape \"disk\" \"float radius\" 0.6 AttributeEnd\n"
     "AreaLightSource \"diffuse\" \"rgb L\" [9 9 9] \"bool twosided\" true "
     "Translate -1 -1 2 Shape \"disk\" \"float radius\" 0.3\n",
     ""},
    {"many-lights",
     EYE("") STAGE
     "LightSource \"infinite\" \"rgb L\" [0.2 0.2 0.4]\n"
     "LightSource \"distant\" \"point3 from\" [1 -1 2]\n"
     "LightSource \"point\" \"rgb I\" [2 2 2] \"point3 from\" [-1 -2 2]\n"
     "LightSource \"spot\" \"rgb I\" [9 9 9] \"point3 from\" [1 -1 3] \"point3 to\" [0 1 "
     "0] \"float coneangle\" 40 \"float conedeltaangle\" 15\n"
     "AttributeBegin Translate 1 0 0.7 Material \"conductor\" \"float roughness\" 0.3 "
     "Shape \"sphere\" \"float radius\" 0.4 AttributeEnd\n"
     "AttributeBegin Translate 0 -0.5 0.5 Material \"interface\" Shape \"sphere\" "
     "\"float radius\" 0.9 AttributeEnd\n",
     ""},
    /* Beyond the ten. A pane so rough that photons are gathered on its faces, which are
       nearer to one another than photons are. */
    {"thin-pane",
     IN_ROOM("Translate 0 0 1.2 Rotate 20 1 0 0 Material \"dielectric\" \"float "
             "roughness\" 0.4 \"bool remaproughness\" false Shape \"trianglemesh\" "
             "\"point3 P\" [-1 -1 0 1 -1 0 1 1 0 -1 1 0 -1 -1 0.03 1 -1 0.03 1 1 0.03 -1 "
             "1 0.03] \"integer indices\" [0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 3 6 2 3 7 "
             "6 0 7 3 0 4 7 1 6 5 1 2 6]\n"),
     " radius=0.12"},
    /* A photon may meet the mirror where the eye, a hair beside it, meets the paint. */
    {"mixture",
     IN_ROOM("MakeNamedMaterial \"mirror\" \"string type\" \"conductor\" \"rgb "
             "reflectance\" [0.8 0.8 0.8] MakeNamedMaterial \"paint\" \"string type\" "
             "\"diffuse\" \"rgb reflectance\" [0.8 0.8 0.8] Material \"mix\" \"string "
             "materials\" [\"mirror\" \"paint\"] Shape \"trianglemesh\" \"point3 P\" "
             "[-1.6 1 0.01 1.6 1 0.01 1.6 1 1.7 -1.6 1 1.7] \"integer indices\" "
             "[0 1 2 0 2 3]\n"),
     ""},
    {"motion",
     IN_ROOM("AttributeBegin Translate 0.2 0 0.5 ActiveTransform EndTime "
             "Translate 0.8 0.3 0.4 Rotate 60 1 2 3 ActiveTransform All "
             "Material \"diffuse\" \"rgb reflectance\" [0.2 0.6 0.8] Shape "
             "\"bilinearmesh\" \"point3 P\" [-0.4 0 -0.4 0.4 0 -0.4 -0.4 0 0.4 "
             "0.4 0 0.4] AttributeEnd ActiveTransform EndTime Translate 0 0.5 "
             "0.6 ActiveTransform All Translate -0.7 0 0.5 Material "
             "\"dielectric\" Shape \"sphere\" \"float radius\" 0.4\n"),
     ""},
    {"instances",
     IN_ROOM("ObjectBegin \"pair\" Material \"dielectric\" Shape \"sphere\" \"float "
             "radius\" 0.35 Material \"diffuse\" \"rgb reflectance\" [0.7 0.2 0.2] "
             "Translate 0.5 0 0 Shape \"sphere\" \"float radius\" 0.2 ObjectEnd "
             "AttributeBegin Translate -0.9 0 0.4 ObjectInstance \"pair\" AttributeEnd "
             "AttributeBegin Translate 0.3 -0.3 1.3 Rotate 80 1 2 3 ObjectInstance "
             "\"pair\" AttributeEnd Translate 0.9 0.5 0.8 Scale 1 1 2 ObjectInstance "
             "\"pair\"\n"),
     ""},
    {"fog",
     "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [0.02 0.04 "
     "0.06] \"rgb sigma_s\" [0.3 0.2 0.15] \"float g\" 0.3 MediumInterface "
     "\"fog\" " IN_ROOM("MediumInterface \"\" \"fog\" Material \"dielectric\" " BALL),
     ""},
    /* The wall above it casts shadows, and is lit from below alone. */
    {"portal",
     EYE("") STAGE
     "LightSource \"infinite\" \"rgb L\" [2 3 4] \"point3 portal\" [-1 -1 2 -1 1 2 1 "
     "1 2 1 -1 2]\n"
     "Shape \"trianglemesh\" \"point3 P\" [0.2 -1 2.1 0.2 1 2.1 0.2 1 4 0.2 -1 4] "
     "\"integer indices\" [0 1 2 0 2 3]\n",
     ""},
    /* Nothing bounds it: it is bright far from all that stands in it. */
    {"haze",
     "MakeNamedMedium \"haze\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [0.02 "
     "0.02 "
     "0.02] \"rgb sigma_s\" [0.05 0.1 0.2] MediumInterface \"haze\" \"haze\" " EYE("")
         STAGE "LightSource \"infinite\" \"rgb L\" [1 1 1]\n",
     " photons=50000"},
};

/* An algorithm, its settings, and what its radii may do to a block. */
typedef struct way {
    const char *name, *words;
    double bias;
} way;

static const way ways[] = {
    {"auto", "integrator=auto spp=4 photons=5000 max_backward_bounces=-1", 0.01},
    {"photonmap", "integrator=photonmap spp=2 photons=10000 max_backward_bounces=-1",
     0.03},
    {"sppm", "integrator=sppm spp=1 photons=6000 seed=1 max_backward_bounces=-1", 0.03},
    {"vcm", "integrator=vcm spp=2 photons=4096 max_backward_bounces=-1", 0.01},
};

/* Without a blur that could be seen: connections alone, and radii of less than a third of
   a pixel, 0.1 m wide at the back of the room. The photon map's does not shrink, and it
   has many photons: smaller discs, or fewer that land in the open, meet one in one of
   hundreds of passes, and what is so rare has no normal deviate. */
static const way sharp_ways[] = {
    {"bpt",
     "integrator=vcm vcm_strategies=bpt spp=2 photons=1024 max_backward_bounces=-1", 0},
    {"auto, sharp",
     "integrator=auto spp=4 caustic_photons=10000 radius=0.03 max_backward_bounces=-1",
     0},
    {"photonmap, sharp",
     "integrator=photonmap spp=2 photons=160000 radius=0.03 alpha=1 "
     "max_backward_bounces=-1",
     0},
    {"vcm, sharp",
     "integrator=vcm spp=2 photons=4096 radius=0.03 max_backward_bounces=-1", 0},
};

static bool renders(const char *words, const scene *s)
{
    return !scene_has_media(s) || !strstr(words, "integrator=vcm");
}

/* Each place sees one of the sharp ways, in the long form all. */
static bool is_taken(const place *at, size_t which)
{
    return verify_is_long() || (size_t)(at - places) % G_N_ELEMENTS(sharp_ways) == which;
}

static void test_agreement(gconstpointer data)
{
    const place *at = data;
    g_autoptr(view) v = view_of(at->text);
    g_auto(yardstick) path = {
        .of = {.view = v, .words = "integrator=path spp=8 max_backward_bounces=-1"}};
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autofree char *words = g_strconcat(ways[i].words, at->more, NULL);
        if (!renders(words, v->scene))
            continue;
        verify_agree(ways[i].name, &(subject){.view = v, .words = words}, &path, 32,
                     (allowance){0.005, ways[i].bias, false});
    }
    for (size_t i = 0; i < G_N_ELEMENTS(sharp_ways); i++) {
        const subject of = {.view = v, .words = sharp_ways[i].words};
        if (is_taken(at, i) && renders(of.words, v->scene))
            verify_agree(sharp_ways[i].name, &of, &path, 32, (allowance){0.005, 0, true});
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(places); i++) {
        g_autofree char *name = g_strconcat("/verify/agree/", places[i].name, NULL);
        g_test_add_data_func(name, &places[i], test_agreement);
    }
    return g_test_run();
}
