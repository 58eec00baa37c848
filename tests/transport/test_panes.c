/*
 * Thin panes: light that goes straight through one is not scattered by it. What lies
 * behind is lit as lights are sampled, dimmed by what the pane reflects, and all
 * algorithms find the same picture, in the same layers.
 */
#include "rooms.h"

/* A lamp at a point and the floor, seen from aside, and a pane between them. */
#define FLOOR                                                                            \
    "LookAt 0 -3 1.2  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 30\n" SIZE(      \
        8) "WorldBegin\n"                                                                \
           "LightSource \"point\" \"rgb I\" [5 5 5] \"point3 from\" [0 0 2]\n"           \
           "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"                    \
           "Shape \"disk\" \"float radius\" 9\n"
#define PANE                                                                             \
    "Material \"thindielectric\" \"float eta\" 1.5 Translate 0 0 1.9\n"                  \
    "Shape \"disk\" \"float radius\" 9\n"

/* What a plate lets through, of light under that cosine (Stokes 1862). */
static double plate(double cosine)
{
    double t = sqrt(1.0 - (1.0 - cosine * cosine) / (1.5 * 1.5));
    double s = (cosine - 1.5 * t) / (cosine + 1.5 * t);
    double p = (1.5 * cosine - t) / (1.5 * cosine + t);
    double r = (s * s + p * p) / 2.0;
    return (1.0 - r) / (1.0 + r);
}

static double at_pixel(const image *img, const char *channel, int i)
{
    return (double)
        img->pixels[(size_t)i * (size_t)img->n_channels + channel_of(img, channel)];
}

typedef struct algorithm {
    const char *name, *words;
} algorithm;

static const algorithm algorithms[] = {
    {"path", "integrator=path passes=4 spp=64"},
    {"photonmap", "integrator=photonmap passes=4 spp=64 final_gather=off"},
    {"vcm", "integrator=vcm vcm_strategies=bpt passes=16 spp=256"},
    {"auto", "integrator=auto passes=4 spp=64"},
};

/* Light falls off with cos³ θ on the floor, and a lamp at a point makes no noise. */
static void test_closed_form(gconstpointer words)
{
    g_autoptr(view) open = view_of(FLOOR), covered = view_of(FLOOR PANE);
    g_autoptr(image) bare = render_with(open, words),
                     through = render_with(covered, words);
    double below = at_pixel(bare, "direct.G", 8 * 4 + 4);
    for (int i = 0; i < 8 * 8; i++) {
        double lit = at_pixel(bare, "direct.G", i);
        double share = at_pixel(through, "direct.G", i) / lit;
        g_assert_cmpfloat(lit, >, 0.0);
        g_assert_cmpfloat(fabs(share - plate(fmin(cbrt(lit / below), 1.0))), <, 0.01);
    }
}

/* A lamp above a pane, and one that stands, in a room with a dull metal ball. */
#define PANES(material)                                                                  \
    ROOM_CAMERA SIZE(16) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS material                \
        "Shape \"trianglemesh\" \"point3 P\" [-1.5 -1.5 1.2 1.5 -1.5 "                   \
        "1.2 1.5 1.9 1.4 -1.5 1.9 1.4] \"integer indices\" [0 1 2 0 2 "                  \
        "3]\nShape \"trianglemesh\" \"point3 P\" [-0.5 0.2 0 -0.5 1.2 "                  \
        "0 -0.5 1.2 1 -0.5 0.2 1] \"integer indices\" [0 1 2 0 2 3]\n"                   \
        "Material \"conductor\" \"float roughness\" 0.1\n"                               \
        "Shape \"sphere\" \"float radius\" 0.3\n"

#define THIN "Material \"thindielectric\" \"float eta\" 1.5\n"
/* Coated, and matt in part. */
#define LEAF                                                                             \
    "Material \"gltf\" \"float transmission\" 0.8 \"float roughness\" 0 \"float "        \
    "metallic\" 0 \"rgb basecolor\" [0.9 0.5 0.4] \"float clearcoat\" 0.5\n"
#define PATCHES                                                                          \
    "MakeNamedMaterial \"a\" \"string type\" \"thindielectric\"\n"                       \
    "MakeNamedMaterial \"b\" \"string type\" \"diffuse\"\n"                              \
    "Material \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" 0.4\n"

static const char *const layers[] = {"direct.G", "indirect.G", "caustic.G", "specular.G"};

static double mean_of_layer(const image *img, const char *layer)
{
    double sum = 0.0;
    int n = img->width * img->height;
    for (int i = 0; i < n; i++)
        sum += at_pixel(img, layer, i) / n;
    return sum;
}

/* The last two find with photons, and slowly, what they find behind any sort of pane. */
static const char *const peers[] = {
    "integrator=path passes=4 spp=128",
    "integrator=vcm vcm_strategies=bpm passes=16 spp=4 photons=40000",
    "integrator=photonmap passes=8 spp=4 photons=60000 gather_rays=8",
    "integrator=photonmap passes=40 spp=4 photons=60000 direct_illumination=off "
    "final_gather=off radius=0.08",
};

typedef struct pane_room {
    const char *name, *text;
    size_t n_peers;
} pane_room;

static const pane_room rooms[] = {
    {"thin", PANES(THIN), G_N_ELEMENTS(peers)},
    {"leaf", PANES(LEAF), 2},
    {"patches", PANES(PATCHES), 2},
};

/* Layers are those of vcm, which shares all ways to find a path. */
static void test_agree(gconstpointer data)
{
    const pane_room *room = data;
    g_autoptr(view) v = view_of(room->text);
    g_autoptr(image) truth =
        render_with(v, "integrator=vcm passes=16 spp=8 photons=40000");
    double all = 0.0;
    for (size_t k = 0; k < G_N_ELEMENTS(layers); k++)
        all += mean_of_layer(truth, layers[k]);
    g_assert_cmpfloat(mean_of_layer(truth, "direct.G"), >, 0.2 * all);
    for (size_t i = 0; i < room->n_peers; i++) {
        g_autoptr(image) img = render_with(v, peers[i]);
        for (size_t k = 0; k < G_N_ELEMENTS(layers); k++) {
            double expected = mean_of_layer(truth, layers[k]);
            double found = mean_of_layer(img, layers[k]);
            g_test_message("%s, %s: %g, expected %g", peers[i], layers[k], found,
                           expected);
            g_assert_cmpfloat(fabs(found - expected), <, 0.01 * all);
        }
    }
}

/* A pane is an event of a path all the same: one that may have no other is dark. */
static void test_bounded(void)
{
    static const char *const words[] = {"integrator=path", "integrator=vcm"};
    g_autoptr(view) v = view_of(FLOOR PANE);
    for (size_t i = 0; i < G_N_ELEMENTS(words); i++) {
        for (int limit = 1; limit <= 2; limit++) {
            g_autofree char *all = g_strdup_printf(
                "%s passes=1 spp=4 max_backward_bounces=%d", words[i], limit);
            g_autoptr(image) img = render_with(v, all);
            double lit = mean_of_layer(img, "direct.G");
            g_assert_true((lit > 0.0) == (limit == 2));
        }
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(algorithms); i++) {
        g_autofree char *path =
            g_strconcat("/panes/closed-form/", algorithms[i].name, NULL);
        g_test_add_data_func(path, algorithms[i].words, test_closed_form);
    }
    for (size_t i = 0; i < G_N_ELEMENTS(rooms); i++) {
        g_autofree char *path = g_strconcat("/panes/agree/", rooms[i].name, NULL);
        g_test_add_data_func(path, &rooms[i], test_agree);
    }
    g_test_add_func("/panes/bounded", test_bounded);
    return g_test_run();
}
