/*
 * `auto` sends photons only where they pay: with nothing that paths do not find as well
 * it is path tracing, to the bit, and costs little more; where paths can not find a
 * caustic, or hardly, there are photons. How noisy paths would be its trials tell as
 * pictures by paths show it.
 */
#define _GNU_SOURCE /* RTLD_NEXT */
#include "ray_count.h"
#include "rooms.h"
#include "transport/plan/caustics.h"
#include "transport/plan/path_trial.h"

#define AT " Shape \"sphere\" \"float radius\" "
#define BALL "Translate 0 0 0.6" AT "0.5\n"
#define STUDIO ROOM_CAMERA SIZE(24) "WorldBegin\n" ROOM_WALLS
#define SMALL_LAMP                                                                       \
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [900 900 900] Translate 1 0 "  \
    "1.7" AT "0.04 AttributeEnd\n"
#define POINT "LightSource \"point\" \"rgb I\" [4 4 4] \"point3 from\" [1 -2 1.5]\n"

typedef struct subject {
    const char *name, *text;
} subject;

/* What these throw on the walls is faint, or wide and soft. */
static const subject dull[] = {
    {"empty", STUDIO ROOM_LAMP("")},
    {"dull-metal", STUDIO ROOM_LAMP("") "Material \"conductor\" \"float roughness\" 0.35 "
                                        "\"bool remaproughness\" false " BALL},
    {"satin-plastic", STUDIO ROOM_LAMP("") "Material \"coateddiffuse\" \"rgb "
                                           "reflectance\" [0.2 0.4 0.8] \"float "
                                           "roughness\" 0.3 " BALL},
    {"dull-metal-point-light",
     STUDIO POINT "Material \"conductor\" \"float roughness\" 0.35 "
                  "\"bool remaproughness\" false " BALL},
    {"tiny-mirror", STUDIO ROOM_LAMP("") "Material \"conductor\" Translate -1.7 1.7 "
                                         "0.1" AT "0.06\n"},
};

static const subject bright[] = {
    {"glass", STUDIO SMALL_LAMP "Material \"dielectric\" " BALL},
    {"rough-glass", STUDIO SMALL_LAMP "Material \"dielectric\" \"float roughness\" 0.03 "
                                      "\"bool remaproughness\" false " BALL},
    {"point-light", STUDIO POINT "Material \"dielectric\" " BALL},
    {"tiny-glass-point-light",
     STUDIO POINT "Material \"dielectric\" Translate -1.7 1.7 0.1" AT "0.06\n"},
};

static uint64_t photons_of(const render *r)
{
    return render_get_statistics(r).emitted[PHOTON_CAUSTIC];
}

static bool same_bits(const image *a, const image *b)
{
    size_t n = (size_t)a->width * (size_t)a->height * (size_t)a->n_channels;
    return a->n_channels == b->n_channels &&
           memcmp(a->pixels, b->pixels, n * sizeof *a->pixels) == 0;
}

#define SHORT " passes=4 spp=4 seed=3 threads=1"

static void test_is_path(gconstpointer data)
{
    g_autoptr(view) v = view_of(((const subject *)data)->text);
    g_autoptr(render) r = render_of(v, "integrator=auto" SHORT);
    g_assert_true(render_run(r, NULL, NULL, NULL));
    g_assert_cmpuint(photons_of(r), ==, 0);
    g_autoptr(image) shared = image_of(r);
    g_autoptr(image) path = render_with(v, "integrator=path" SHORT);
    g_assert_true(same_bits(shared, path));
}

static void test_sends_photons(gconstpointer data)
{
    g_autoptr(view) v = view_of(((const subject *)data)->text);
    g_autoptr(render) r = render_of(v, "integrator=auto" SHORT);
    g_assert_true(render_run(r, NULL, NULL, NULL));
    g_assert_cmpuint(photons_of(r), >, 100);
}

static double rays_of(const view *v, const char *words)
{
    g_autoptr(render) r = render_of(v, words);
    uint64_t before = rays_asked;
    g_assert_true(render_run(r, NULL, NULL, NULL));
    const render_statistics told = render_get_statistics(r);
    uint64_t rays = rays_asked - before;
    g_assert_cmpuint(rays, >=, told.camera_rays + told.shadow_rays + told.photon_rays);
    return (double)rays;
}

/* Trials, of which there are a few even for the smallest picture, are all that it costs
   to find out that photons do not pay; a tenth is what is aimed for. */
#define DEARER 1.15

static void test_costs_as_path(gconstpointer data)
{
    const subject *of = data;
    g_autoptr(view) v = view_of(of->text);
    double path = rays_of(v, "integrator=path" SHORT);
    double shared = rays_of(v, "integrator=auto" SHORT);
    g_test_message("%s: %.0f rays, %.3f of path", of->name, shared, shared / path);
    g_assert_cmpfloat(shared, <, DEARER * path);
}

/* ---- The noise that trials tell ---- */

/* Glass and satin, the lamp out of sight. */
#define NOISY                                                                            \
    "LookAt 0 -3.4 1.2  0 0 0.3  0 0 1 Camera \"perspective\" \"float fov\" 40\n" SIZE(  \
        32) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS                                      \
        "AttributeBegin Material \"dielectric\" Translate -0.6 0 0.5" AT                 \
        "0.5 AttributeEnd\n"                                                             \
        "Material \"conductor\" \"float roughness\" 0.2 Translate 0.7 0.3 0.5" AT        \
        "0.5\n"

/* A lamp in a hollow globe, where photons take many rays, and all of its light is theirs.
 */
#define GLOBE                                                                            \
    "LookAt 0 -3.4 1.2  0 0 0.3  0 0 1 Camera \"perspective\" \"float fov\" 40\n" SIZE(  \
        32) "WorldBegin\nShape \"trianglemesh\" \"point3 P\" [-3 -3 0 3 -3 0 3 3 0 "     \
            "-3 3 0] \"integer indices\" [0 1 2 0 2 3]\nTranslate 0 0 2.2\n"             \
            "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [90 80 70]" AT         \
            "0.3 AttributeEnd\nMaterial \"dielectric\"" AT "0.5 ReverseOrientation" AT   \
            "0.45\n"

static const subject noisy[] = {{"glass-and-satin", NOISY}, {"globe", GLOBE}};

enum { N_SEEDS = 16, N_PICTURES = 256, N_PIXELS = 32 * 32 };

/* What the trial of caustic photons tells of paths without them. */
static double told_noise(const view *v, int passes, int seed)
{
    g_autofree char *words =
        g_strdup_printf("integrator=auto passes=%d seed=%d", passes, seed);
    g_autoptr(render) r = render_of(v, words);
    render_plan plan;
    g_assert_true(render_get_plan(r, &plan, NULL));
    for (int i = 0; i < plan.n_trials; i++)
        if (strcmp(plan.trials[i].what, "caustic photons") == 0)
            return plan.trials[i].without.variance;
    g_assert_not_reached();
}

/* Of pictures of one sample a pixel: sums of each pixel's brightness and its square. */
static void add_picture(const view *v, int seed, double sum[], double square[])
{
    g_autofree char *words =
        g_strdup_printf("integrator=path passes=1 spp=1 seed=%d", seed);
    g_autoptr(image) img = render_with(v, words);
    for (int i = 0; i < N_PIXELS; i++) {
        const float *rgb = &img->pixels[i * img->n_channels];
        double grey = ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3.0;
        sum[i] += grey;
        square[i] += grey * grey;
    }
}

/* Each pixel's variance, over the squares of its own brightness and of the picture's. */
static double noise_of_pictures(const view *v)
{
    double sum[N_PIXELS] = {0}, square[N_PIXELS] = {0}, mean = 0.0, noise = 0.0;
    const double n = N_PICTURES;
    for (int seed = 0; seed < N_PICTURES; seed++)
        add_picture(v, seed, sum, square);
    for (int i = 0; i < N_PIXELS; i++)
        mean += sum[i] / n / N_PIXELS;
    for (int i = 0; i < N_PIXELS; i++) {
        double here = sum[i] / n;
        double variance = (square[i] - n * here * here) / (n - 1.0);
        noise += variance / (here * here + mean * mean) / N_PIXELS;
    }
    return noise;
}

/* Of so many passes that a trial's photons draw the sketch: where few land in sight it is
   dark in places, and noise there told as too much. */
static void test_told(gconstpointer data)
{
    g_autoptr(view) v = view_of(((const subject *)data)->text);
    double told = 0.0, noise = noise_of_pictures(v);
    for (int seed = 0; seed < N_SEEDS; seed++)
        told += told_noise(v, 1024, seed) / N_SEEDS;
    g_test_message("told %g, noise of pictures %g", told, noise);
    g_assert_cmpfloat(told, >, 0.7 * noise);
    g_assert_cmpfloat(told, <, 1.4 * noise);
}

/* One seed tells what another does, though few photons fit into a trial of theirs. */
static void test_steady(void)
{
    g_autoptr(view) v = view_of(GLOBE);
    double least = INFINITY, most = 0.0;
    for (int seed = 0; seed < N_SEEDS; seed++) {
        double told = told_noise(v, 64, seed);
        least = fmin(least, told);
        most = fmax(most, told);
    }
    g_test_message("%g to %g", least, most);
    g_assert_cmpfloat(most, <, 3.0 * least);
}

/* ---- Grain and blotches ---- */

/* What a picture of four passes is to be, with its noise or without, where so much noise
   of paths is photons' to take, beside .2 of other light: they leave them so much of it
   and bring so much that is alike, in twice the rays. */
static transport_plan decided(const view *v, const char *words, double noise, double left,
                              double alike)
{
    const settings how = settings_with(v->scene, words);
    transport_plan plan = transport_plan_of(v, &how);
    const path_effort paths = {.noise = 0.2, .rays = 6.0, .surfaces = 3.0};
    aim_result found = {.noise = noise, .rays = 1.0};
    for (int i = 0; i < N_SHARES; i++) {
        found.left[i] = left;
        found.alike[i] = alike / plan_share(i);
    }
    plan.n_photons[PHOTON_CAUSTIC] = 100;
    caustics_decide(&plan, &found, &paths);
    return plan;
}

#define SHOWN "integrator=auto passes=4 spp=1 denoise=true"
#define RAW "integrator=auto passes=4 spp=1 denoise=false"
#define GLASS STUDIO SMALL_LAMP "Material \"dielectric\" " BALL

static uint64_t sent(const char *words, double left, double alike)
{
    g_autoptr(view) v = view_of(GLASS);
    transport_plan plan = decided(v, words, 1.8, left, alike);
    uint64_t n = plan.n_photons[PHOTON_CAUSTIC];
    transport_plan_clear(&plan);
    return n;
}

/* How many surfaces look where that takes most of the grain, and half as much again of
   the rays. */
static float looking(const char *words, double alike)
{
    g_autoptr(view) v = view_of(GLASS);
    transport_plan plan = decided(v, words, 18.0, 0.0, alike);
    const spot_trial trial = {.without = 1.8, .with = {0.1, 0.6}, .rays = 6.0};
    plan.sample_rays = 6.0;
    g_assert_cmpuint(plan.n_photons[PHOTON_CAUSTIC], >, 0);
    spots_choose_share(&plan, &trial, 0.15, 1);
    float share = plan.p_spots;
    transport_plan_clear(&plan);
    return share;
}

/* Grain that photons take away is worth their grain, but not their blotches, unless noise
   stays as it is. */
static void test_blotches(void)
{
    g_assert_cmpuint(sent(RAW, 0.1, 0.0), >, 0);
    g_assert_cmpuint(sent(SHOWN, 0.1, 0.0), >, 0);
    g_assert_cmpuint(sent(RAW, 0.0, 0.1), ==, 100);
    g_assert_cmpuint(sent(SHOWN, 0.0, 0.1), ==, 0);
    g_assert_cmpuint(sent(SHOWN, 0.0, 0.01), >, 0);
}

/* Looks take grain, and passes from what is alike, which only passes take away. */
static void test_blotches_beside_looks(void)
{
    g_assert_cmpfloat(looking(SHOWN, 0.0), ==, 1.0f);
    g_assert_cmpfloat(looking(RAW, 0.1), ==, 1.0f);
    g_assert_cmpfloat(looking(SHOWN, 0.1), ==, 0.0f);
}

static void add(const char *what, const subject *of, GTestDataFunc test)
{
    g_autofree char *path = g_strdup_printf("/budget/%s/%s", what, of->name);
    g_test_add_data_func(path, of, test);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(dull); i++) {
        add("is-path", &dull[i], test_is_path);
        add("costs-as-path", &dull[i], test_costs_as_path);
    }
    for (size_t i = 0; i < G_N_ELEMENTS(bright); i++)
        add("sends-photons", &bright[i], test_sends_photons);
    for (size_t i = 0; i < G_N_ELEMENTS(noisy); i++)
        add("told", &noisy[i], test_told);
    g_test_add_func("/budget/steady", test_steady);
    g_test_add_func("/budget/blotches", test_blotches);
    g_test_add_func("/budget/blotches-beside-looks", test_blotches_beside_looks);
    return g_test_run();
}
