/*
 * Bright spots: their density is that of the directions they give, and looking at them
 * takes noise away and no light.
 */
#include "rooms.h"

#include "math/sampler.h"
#include "math/warp.h"
#include "photon/spots.h"

/* ---- Density ---- */

/* Two planes that meet: z = 0 and x = 1. @return the first that the ray meets. */
static bool land(vec3 from, vec3 wi, vec3 *landed)
{
    float floor = wi[2] < 0.0f ? -from[2] / wi[2] : INFINITY;
    float wall = wi[0] > 0.0f ? (1.0f - from[0]) / wi[0] : INFINITY;
    float t = minf(floor, wall);
    *landed = from + t * wi;
    return isfinite(t);
}

/* Photons of unlike flux on the floor, up to the wall, and a few on the wall. */
static void put_photons(photon_store *store)
{
    sampler random = sampler_make(7, 0);
    store->oriented = true;
    g_assert_true(photon_store_reserve(store, 3000, NULL));
    for (int i = 0; i < 3000; i++) {
        vec2 u = sampler_2d(&random);
        bool on_wall = i % 10 == 0;
        photon p = {
            .p = on_wall ? vec3_make(1.0f, u.x, 0.3f * u.y)
                         : vec3_make(1.0f - 0.5f * u.x * u.x, u.y, 0.0f),
            .n = on_wall ? vec3_make(-1, 0, 0) : vec3_make(0, 0, 1),
            .wi = vec3_make(0, 0, 1),
            .flux = spectrum_fill(sampler_1d(&random)),
        };
        photon_store_put(store, &p);
    }
}

/* Directions in three parts, by where they lead. */
static bool is_counted(vec3 landed, int part)
{
    int cell = (int)floorf(landed[0] * 8.0f) + (int)floorf(landed[1] * 8.0f) +
               (int)floorf(landed[2] * 8.0f);
    return ((cell % 3) + 3) % 3 == part;
}

static double by_sampling(const photon_spots *spots, vec3 from, int part, int n)
{
    double counted = 0.0;
    for (int i = 0; i < n; i++) {
        int spot;
        vec3 wi, landed;
        sampler random = sampler_make(3, (uint64_t)i);
        light_numbers u = sampler_light(&random);
        if (photon_spots_sample(spots, from, u.light, u.place, &spot, &wi) &&
            land(from, wi, &landed) && photon_spots_landed(spots, spot, from, wi, landed))
            counted += is_counted(landed, part);
    }
    return counted / n;
}

static double by_density(const photon_spots *spots, vec3 from, int part, int n)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++) {
        sampler random = sampler_make(5, (uint64_t)i);
        vec3 landed, wi = warp_sphere(sampler_2d(&random));
        if (land(from, wi, &landed) && is_counted(landed, part))
            sum += (double)photon_spots_pdf(spots, from, wi, landed);
    }
    return 4.0 * G_PI * sum / n;
}

static void test_density_is_that_of_directions(void)
{
    enum { SAMPLES = 200000 };
    photon_store store = {0};
    put_photons(&store);
    const spot_source source = {.photons = &store, .least = 0.01f};
    g_autoptr(photon_spots) spots = photon_spots_new(&source, 1, NULL);
    const vec3 from[] = {{0.2f, 0.3f, 0.8f}, {0.8f, 0.6f, 0.1f}};
    double all = 0.0;
    for (size_t i = 0; i < G_N_ELEMENTS(from); i++) {
        for (int part = 0; part < 3; part++) {
            double a = by_sampling(spots, from[i], part, SAMPLES);
            double b = by_density(spots, from[i], part, SAMPLES);
            g_test_message("from place %zu, part %d: %g sampled, %g by density", i, part,
                           a, b);
            g_assert_cmpfloat(fabs(a - b), <, 0.02);
            all += a / (double)G_N_ELEMENTS(from);
        }
    }
    g_assert_cmpfloat(all, >, 0.7);
    photon_store_clear(&store);
}

/* ---- Pictures ---- */

/* A room lit by a small spot on its floor, beside the camera. */
#define SPOT_ROOM                                                                        \
    ROOM_CAMERA SIZE(                                                                    \
        16) "WorldBegin\n"                                                               \
            "LightSource \"spot\" \"rgb I\" [90 80 70] \"point3 from\" [1.5 -3 1.9] "    \
            "\"point3 to\" [1.5 -3 0] \"float coneangle\" 8\n" ROOM_WALLS
/* A slab of glass close to the lamp, so that little of what the spot sends on comes
 * through it again. */
#define PANE                                                                             \
    "Material \"dielectric\" Shape \"trianglemesh\"\n"                                   \
    "\"point3 P\" [1.45 -3.05 1.8 1.55 -3.05 1.8 1.55 -2.95 1.8 1.45 -2.95 1.8\n"        \
    "1.45 -3.05 1.79 1.55 -3.05 1.79 1.55 -2.95 1.79 1.45 -2.95 1.79]\n"                 \
    "\"integer indices\" [0 1 2 0 2 3 4 6 5 4 7 6 0 4 5 0 5 1\n"                         \
    "2 6 7 2 7 3 1 5 6 1 6 2 0 3 7 0 7 4]\n"
#define IN_SIGHT(material)                                                               \
    "Material " material " Translate 0 0 0.6 Shape \"sphere\" \"float radius\" 0.5\n"

typedef struct spot_scene {
    const char *name, *text;
    const char *how; /* enough samples that some paths find the spot by themselves */
} spot_scene;

static const spot_scene scenes[] = {
    {"lamp", SPOT_ROOM, "integrator=auto passes=2 spp=256"},
    {"pane-plastic",
     SPOT_ROOM PANE IN_SIGHT("\"coateddiffuse\" \"rgb reflectance\" [0.2 0.4 0.8] "
                             "\"float roughness\" 0.2 \"bool remaproughness\" false"),
     "integrator=auto passes=2 spp=64 radius=0.05"},
    {"pane-glass", SPOT_ROOM PANE IN_SIGHT("\"dielectric\""),
     "integrator=auto passes=2 spp=64 radius=0.05"},
};

static image *look(const view *v, const spot_scene *of, const char *more)
{
    g_autofree char *words = g_strconcat(of->how, " gather_indirect=off ", more, NULL);
    return render_with(v, words);
}

/* Relative variance of a pixel, from two pictures. */
static double variance_of(const image *a, const image *b)
{
    size_t n = pixels_of(a), green = channel_of(a, "G");
    double sum = 0.0, mean = 0.0;
    for (size_t i = 0; i < n; i++) {
        double x = at(a, i, green), y = at(b, i, green);
        sum += 0.5 * (x - y) * (x - y);
        mean += 0.5 * (x + y);
    }
    return sum * (double)n / (mean * mean);
}

#define PEER "integrator=vcm vcm_strategies=bpt passes=4 spp=32 photons=8000"

static void test_noise_goes_and_no_light(gconstpointer data)
{
    const spot_scene *of = data;
    g_autoptr(view) v = view_of(of->text);
    g_autoptr(image) on = look(v, of, "seed=1");
    g_autoptr(image) on_too = look(v, of, "seed=2");
    g_autoptr(image) off = look(v, of, "seed=1 bright_spots=off");
    g_autoptr(image) off_too = look(v, of, "seed=2 bright_spots=off");
    g_autoptr(image) peer = render_with(v, PEER);
    double a = 0.5 * (mean_of(on, "") + mean_of(on_too, "")), b = mean_of(peer, "");
    double noise = variance_of(on, on_too), before = variance_of(off, off_too);
    g_test_message("%s: mean %g, by bpt %g (%+.2f %%); variance %g, without %g", of->name,
                   a, b, 100 * (a / b - 1), noise, before);
    g_assert_cmpfloat(fabs(a / b - 1.0), <, 0.03);
    g_assert_cmpfloat(noise, <, before / 3.0);
}

static double mean_of_channel(const image *img, const char *name)
{
    size_t n = pixels_of(img), channel = channel_of(img, name);
    double sum = 0.0;
    for (size_t i = 0; i < n; i++)
        sum += at(img, i, channel);
    return sum / (double)n;
}

/* What is seen of a spot by way of blue plastic with a wide gloss is in the layers of the
   lobe that it went by, in the colour that this one has, as by bidirectional paths. */
static void test_layers(void)
{
    static const char *const channels[] = {"specular.R", "specular.B", "indirect.R",
                                           "indirect.B"};
    g_autoptr(view) v = view_of(
        SPOT_ROOM
        "Material \"coateddiffuse\" \"rgb reflectance\" [0.02 0.1 0.8] \"float "
        "roughness\" 0.28 \"bool remaproughness\" false Translate 0.3 -1 0.9 Shape "
        "\"sphere\" \"float radius\" 0.9\n");
    g_autoptr(image) on = render_with(v, "integrator=auto passes=4 spp=256");
    g_autoptr(image) peer =
        render_with(v, "integrator=vcm vcm_strategies=bpt passes=8 spp=64 photons=16000");
    for (size_t i = 0; i < G_N_ELEMENTS(channels); i++) {
        double a = mean_of_channel(on, channels[i]),
               b = mean_of_channel(peer, channels[i]);
        g_test_message("%s: %g, by bpt %g (%+.2f %%)", channels[i], a, b,
                       100 * (a / b - 1));
        /* the gloss is faint, and noise a twentieth of it; with both lobes in one
           layer it would be half as blue again */
        g_assert_cmpfloat(fabs(a / b - 1.0), <, 0.2);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/spots/density", test_density_is_that_of_directions);
    for (size_t i = 0; i < G_N_ELEMENTS(scenes); i++) {
        g_autofree char *path = g_strconcat("/spots/", scenes[i].name, NULL);
        g_test_add_data_func(path, &scenes[i], test_noise_goes_and_no_light);
    }
    g_test_add_func("/spots/layers", test_layers);
    return g_test_run();
}
