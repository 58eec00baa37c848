/*
 * Where `auto` takes indirect light from photons: it does where a picture has less error
 * for its rays so, and where that is not known or not wanted it does not. It goes to the
 * same picture as paths.
 */
#define _GNU_SOURCE /* RTLD_NEXT */
#include "ray_count.h"
#include "rooms.h"
#include "transport/plan/gather_costs.h"

#define FLOOR                                                                            \
    "LightSource \"infinite\" Material \"diffuse\" Shape \"disk\" \"float radius\" 9\n"

#define ROOM_OF(size) ROOM_CAMERA SIZE(size) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS
#define OPEN_OF(size) ROOM_CAMERA SIZE(size) "WorldBegin\n" FLOOR

/* A lamp in a bulb of glass, in sight, is all that lights the room. */
#define LIT_BY_BULB(more)                                                                \
    ROOM_CAMERA SIZE(                                                                    \
        128) "WorldBegin\n" ROOM_WALLS more "AttributeBegin Translate 0 1 1.5\n"         \
             "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [60 60 60]\n"         \
             "Shape \"sphere\" \"float radius\" 0.08 AttributeEnd\n"                     \
             "Material \"dielectric\" \"float eta\" 1.5 Shape \"sphere\" \"float "       \
             "radius\" 0.2\n"                                                            \
             "ReverseOrientation Shape \"sphere\" \"float radius\" 0.18 AttributeEnd\n"
#define BULB LIT_BY_BULB("")

/* Outside, so bright that hardly a photon is the lamp's. */
#define SUN                                                                              \
    "AttributeBegin Translate 0 0 20 AreaLightSource \"diffuse\" \"rgb L\" [9e4 9e4 "    \
    "9e4]\nShape \"sphere\" \"float radius\" 1 AttributeEnd\n"

typedef struct choice {
    const char *name, *text, *words;
    bool gathers;
} choice;

#define QUICK "integrator=auto spp=1 passes=16 seed=2 threads=1"

static const choice choices[] = {
    {"room", ROOM_OF(128), QUICK, true},
    {"room-with-glass", ROOM_OF(128) GLASS_BALL, QUICK, true},
    {"shown-once", ROOM_OF(128) GLASS_BALL, QUICK " passes=1 photons=24576", true},
    {"many-passes", ROOM_OF(128) GLASS_BALL, QUICK " passes=64 photons=24576", true},
    {"shown-without-noise", ROOM_OF(128) GLASS_BALL,
     QUICK " denoise=on passes=64 photons=24576", false},
    {"beside-the-sun", ROOM_OF(128) SUN, QUICK, false},
    {"open", OPEN_OF(128), QUICK, false},
    {"unwanted", ROOM_OF(128), QUICK " gather_indirect=off", false},
    {"bounded", ROOM_OF(128), QUICK " max_backward_bounces=9", false},
    {"thumbnail", ROOM_OF(8), QUICK, false},
};

static void test_chosen(gconstpointer data)
{
    const choice *of = data;
    g_autoptr(view) v = view_of(of->text);
    g_autoptr(render) r = render_of(v, of->words);
    render_plan plan;
    g_assert_true(render_get_plan(r, &plan, NULL));
    g_assert_true((plan.photons[PHOTON_INDIRECT] > 0) == of->gathers);
}

/* ---- Whatever the seed ---- */

enum { N_SEEDS = 6 };

static void plan_of(const view *v, const char *words, int seed, render_plan *out)
{
    g_autofree char *all = g_strdup_printf("%s seed=%d", words, seed);
    g_autoptr(render) r = render_of(v, all);
    g_assert_true(render_get_plan(r, out, NULL));
}

static const plan_trial *trial_of(const render_plan *plan)
{
    for (int i = 0; i < plan->n_trials; i++)
        if (strcmp(plan->trials[i].what, "gathered indirect light") == 0)
            return &plan->trials[i];
    g_assert_not_reached();
}

/* Squared error of gathering, as its trial tells. */
static double told_error(const render_plan *plan)
{
    return trial_of(plan)->with.variance;
}

/* A lamp that its bulb mirrors is seen by one path of a pair: that says nothing of what
   caustic photons are worth, of which all light here is. */
static void test_bulb(void)
{
    g_autoptr(view) v = view_of(BULB);
    for (int seed = 0; seed < N_SEEDS; seed++) {
        render_plan plan;
        plan_of(v, "integrator=auto spp=4 passes=2 denoise=on", seed, &plan);
        g_assert_true(plan.photons[PHOTON_CAUSTIC] > 0);
    }
}

/* ---- What it is worth ---- */

enum { SIDE = 128, BLOCK = 8 };

static double pixel(const image *img, int x, int y, int c)
{
    size_t at = (size_t)y * (size_t)img->width + (size_t)x;
    return (double)img->pixels[at * (size_t)img->n_channels + (size_t)c];
}

/* Mean square of half of what differs in two pictures, in the dark as beside a tenth of
   white. */
static double noise_of(const image *a, const image *b)
{
    double sum = 0.0;
    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            double u = pixel(a, x, y, 1), v = pixel(b, x, y, 1), mean = (u + v) / 2.0;
            sum += (u - v) * (u - v) / 2.0 / (mean * mean + 0.01);
        }
    }
    return sum / (SIDE * SIDE);
}

/* What few photons tell is what pictures have, noise, and blur at least as much as not.
 */
static void test_told(void)
{
    const char *words = "integrator=auto spp=4 passes=4 denoise=off";
    g_autoptr(view) v = view_of(ROOM_OF(128));
    g_autoptr(image) a = render_with(v, words), b = NULL;
    g_autofree char *again = g_strconcat(words, " seed=7", NULL);
    b = render_with(v, again);
    double noise = 16.0 * noise_of(a, b);
    for (int seed = 0; seed < N_SEEDS; seed++) {
        render_plan plan;
        plan_of(v, words, seed, &plan);
        double told = told_error(&plan);
        g_test_message("seed %d: told %g, noise %g", seed, told, noise);
        g_assert_cmpfloat(told, >, noise);
        g_assert_cmpfloat(told, <, 2.5 * noise);
    }
}

/* Where noise is taken out all counts as blotches do in a room without media but for the
   grain that is paths' alone: of theirs what maps have too, no more than maps have in
   all. */
static void test_shown(void)
{
    g_autoptr(view) v = view_of(ROOM_OF(128));
    const double blotches = 32.0;
    for (int i = 0; i < 2; i++) {
        render_plan shown, raw;
        g_autofree char *words =
            g_strdup_printf("integrator=auto spp=4 passes=%s", i == 0 ? "1" : "64");
        g_autofree char *denoised = g_strconcat(words, " denoise=on", NULL);
        plan_of(v, words, 1, &raw);
        plan_of(v, denoised, 1, &shown);
        const plan_trial *a = trial_of(&raw), *b = trial_of(&shown);
        double weight = b->with.variance / a->with.variance;
        double added = b->without.variance - a->without.variance;
        double common = added / (blotches - 1.0);
        g_test_message("%s: maps %g, %g times, paths %g, of this theirs too %g", words,
                       a->with.variance, weight, a->without.variance, common);
        g_assert_cmpfloat(fabs(weight - blotches), <, 1e-6);
        g_assert_cmpfloat(common, >, 0.0);
        g_assert_cmpfloat(common, <, 0.999 * a->with.variance);
        g_assert_cmpfloat(common, <, a->without.variance);
    }
}

/* What the trial tells of places that are alike. */
typedef struct told_costs {
    plan_cost paths, maps;
    bool fit;
} told_costs;

/* @param elsewhere variance of pairs of paths that others met
   @param map_rays of a sample by maps; by paths it is one
   @param photon_rays of a pass, for each pixel */
static told_costs tell(const char *words, gather_place place, double elsewhere,
                       double map_rays, double photon_rays)
{
    enum { N = 64 };
    static gather_place places[N];
    for (int i = 0; i < N; i++)
        places[i] = place;
    const scene lit = {.radius = 1.0f, .settings = settings_default()};
    const view from = {.film = {.width = SIDE, .height = SIDE}};
    const transport_plan plan = {.scene = &lit,
                                 .view = &from,
                                 .how = settings_with(&lit, words),
                                 .path_noise = elsewhere};
    double spp = (double)plan.how.spp;
    const gather_trial t = {.plan = plan,
                            .area = 1.0,
                            .fewer = 1.0,
                            .n = N,
                            .places = places,
                            .path_rays = 1.0,
                            .first_rays = map_rays,
                            .later_rays = map_rays,
                            .photon_rays = photon_rays * SIDE * SIDE * spp};
    told_costs out;
    out.fit = gather_costs(&plan, &t, &out.paths, &out.maps);
    return out;
}

static double told_of_paths(const char *words, gather_place place, double elsewhere)
{
    return tell(words, place, elsewhere, 1.0, 0.0).paths.variance;
}

/* Where paths see what maps do and some noise. */
static const gather_place noisy = {.path = {0.8, 1.2},
                                   .smooth = {1.0, 1.1},
                                   .near = {1.0, 1.1},
                                   .twice = {1.0, 1.1},
                                   .beside = 1.0,
                                   .seen = 1.0};

/* Glints in few pixels, which pairs of paths met and places did not, are in maps'
   pictures too: where their noise stays they are no reason to gather. */
static void test_met_elsewhere(void)
{
    const char *raw = "integrator=auto passes=16 denoise=off";
    const char *shown = "integrator=auto passes=16 denoise=on";
    double alone = told_of_paths(shown, noisy, 0.0);
    g_assert_cmpfloat(told_of_paths(raw, noisy, 100.0), ==,
                      told_of_paths(raw, noisy, 0.0));
    g_assert_cmpfloat(told_of_paths(shown, noisy, 100.0), >, 2.0 * alone);
}

/* Of light straight from lamps, which paths and maps have in common, what differs at
   surfaces lies where shadows end, and weighs as blotches do; what does in media is
   grain. */
static void test_in_media(void)
{
    const double blotches = 32.0;
    gather_place hazy = noisy;
    hazy.scattered[1] = 0.1;
    const char *words[2] = {"integrator=auto passes=16 denoise=off",
                            "integrator=auto passes=16 denoise=on"};
    double told[2][2];
    for (int k = 0; k < 2; k++) {
        told[k][0] = told_of_paths(words[k], hazy, 1.0);
        told[k][1] = told_of_paths(words[k], noisy, 1.0);
    }
    double common = 0.5 * 0.1 * 0.1 * relative_weight(1.0, 1.0);
    double added = told[1][1] - told[1][0];
    g_test_message("noise stays: %g %g, else %g %g", told[0][0], told[0][1], told[1][0],
                   told[1][1]);
    g_assert_cmpfloat(told[0][0], ==, told[0][1]);
    g_assert_cmpfloat(fabs(told[1][0] - 1.0), <, 1e-6);
    g_assert_cmpfloat(fabs(added - (blotches - 1.0) * common), <, 1e-6);
}

/* Of a pass that is not whole the photons are all there. */
static void test_part_of_a_pass(void)
{
    const char *whole = "integrator=auto spp=1 passes=4 denoise=on";
    const char *part = "integrator=auto spp=1 passes=1 denoise=on";
    told_costs four = tell(whole, noisy, 1.0, 1.0, 0.25);
    told_costs one = tell(part, noisy, 1.0, 1.0, 0.25);
    told_costs dear = tell(part, noisy, 1.0, 1.0, 0.75);
    g_assert_cmpfloat(fabs(four.maps.rays - 1.25), <, 1e-6);
    g_assert_cmpfloat(fabs(one.maps.rays - (1.0 + 0.25 / 0.75)), <, 1e-6);
    g_assert_cmpfloat(fabs(dear.maps.rays - (1.0 + 0.75 / 0.5)), <, 1e-6);
    g_assert_true(four.fit && one.fit && !dear.fit);
}

/* Where not even half a pass fits noise stays, that of media with it. */
static void test_no_time(void)
{
    const char *words = "integrator=auto spp=1 passes=1 denoise=on";
    const double blotches = 32.0, common = 0.5 * 0.1 * 0.1 * relative_weight(1.0, 1.0);
    gather_place hazy = noisy;
    hazy.scattered[1] = 0.1;
    told_costs fits = tell(words, hazy, 1.0, 1.9, 0.0);
    told_costs does_not = tell(words, hazy, 1.0, 2.1, 0.0);
    double added = does_not.maps.variance - fits.maps.variance;
    g_assert_true(fits.fit && !does_not.fit);
    g_test_message("%g, without time %g", fits.maps.variance, does_not.maps.variance);
    g_assert_cmpfloat(added, >, 0.9 * (blotches - 1.0) * common);
}

/* A room in haze, and in sight the beam of a spot lamp, all that lights it. */
#define HAZE                                                                             \
    "MakeNamedMedium \"haze\" \"string type\" \"homogeneous\"\n"                         \
    "\"rgb sigma_s\" [.3 .3 .3] \"rgb sigma_a\" [.02 .02 .02]\n"                         \
    "MediumInterface \"haze\" \"haze\"\n"
#define SPOT_LAMP                                                                        \
    "LightSource \"spot\" \"rgb I\" [25 23 20] \"float coneangle\" 20\n"                 \
    "\"point3 from\" [-1.2 0 1.8] \"point3 to\" [.4 .3 .5]\n"
#define HAZY_ROOM                                                                        \
    HAZE ROOM_CAMERA SIZE(                                                               \
        128) "WorldBegin\n"                                                              \
             "MediumInterface \"haze\" \"haze\"\n" ROOM_WALLS SPOT_LAMP GLASS_BALL

/* The grain of the beam is as strong in maps as in paths, and no blotch. */
static void test_haze(void)
{
    g_autoptr(view) v = view_of(HAZY_ROOM);
    const double blotches = 32.0;
    for (int seed = 0; seed < N_SEEDS; seed++) {
        render_plan shown, raw;
        plan_of(v, "integrator=auto spp=1 passes=16 denoise=off", seed, &raw);
        plan_of(v, "integrator=auto spp=1 passes=16 denoise=on", seed, &shown);
        double weight = trial_of(&shown)->with.variance / trial_of(&raw)->with.variance;
        g_test_message("seed %d: %g times", seed, weight);
        g_assert_cmpfloat(weight, <, 0.95 * blotches);
    }
}

/* A wall of squares about as large as pixels. */
#define SQUARES                                                                          \
    "Texture \"squares\" \"spectrum\" \"checkerboard\"\n"                                \
    "\"float uscale\" 100 \"float vscale\" 50\n"                                         \
    "\"rgb tex1\" [0.9 0.9 0.9] \"rgb tex2\" [0 0 0]\n"                                  \
    "Material \"diffuse\" \"texture reflectance\" \"squares\"\n"                         \
    "Shape \"trianglemesh\" \"point2 uv\" [0 0 1 0 1 1 0 1]\n"                           \
    "\"point3 P\" [-2 1.5 0  2 1.5 0  2 1.5 2  -2 1.5 2]\n"                              \
    "\"integer indices\" [0 1 2 0 2 3]\n"

/* Where paths give each pixel a sample and maps, in the time that they take, may not,
   what the others show of these counts: little in a plain room, much before squares. */
static void test_gaps(void)
{
    const char *rooms[2] = {ROOM_OF(256), ROOM_OF(256) SQUARES};
    double told[2][2];
    for (int i = 0; i < 2; i++) {
        g_autoptr(view) v = view_of(rooms[i]);
        for (int k = 0; k < 2; k++) {
            render_plan plan;
            plan_of(v,
                    k == 0 ? "integrator=auto passes=2 denoise=off spp=1"
                           : "integrator=auto passes=64 denoise=off spp=1",
                    1, &plan);
            told[i][k] = told_error(&plan);
            g_assert_true(trial_of(&plan)->taken == (i == 0 || k == 1));
        }
        g_test_message("told %g, of many passes %g", told[i][0], told[i][1]);
    }
    g_assert_cmpfloat(told[0][0], <, 2.0 * told[0][1]);
    g_assert_cmpfloat(told[1][0], >, 10.0 * told[1][1]);
}

/* A pane of almost no glass before the camera changes nothing that is seen, but all is
   seen by way of it: what caustic photons bring is as little a reason to gather as
   without. */
#define PANE                                                                             \
    "AttributeBegin Translate 0 -3.3 1.19 Rotate 90 1 0 0\n"                             \
    "Material \"dielectric\" \"float eta\" 1.0001 Shape \"disk\" \"float radius\" 0.2\n" \
    "Translate 0 0 0.002 Rotate 180 1 0 0 Shape \"disk\" \"float radius\" 0.2 "          \
    "AttributeEnd\n"

typedef struct told {
    double error;   /* with noise, as told for a sample */
    double in_time; /* passes by maps over those by paths that take as long */
} told;

static told told_of_seeds(const char *text, const char *words)
{
    g_autoptr(view) v = view_of(text);
    told mean = {0};
    for (int seed = 0; seed < N_SEEDS; seed++) {
        render_plan plan;
        plan_of(v, words, seed, &plan);
        g_assert_cmpuint(plan.photons[PHOTON_CAUSTIC], >, 0);
        const plan_trial *t = trial_of(&plan);
        mean.error += told_error(&plan) / N_SEEDS;
        mean.in_time += t->without.rays / t->with.rays / N_SEEDS;
    }
    return mean;
}

/* As many more passes have as much more noise that the blur, which stays, weighs like. */
static void test_behind_glass(void)
{
    const char *words = "integrator=auto spp=1 passes=16 photons=3000 denoise=off";
    told clear = told_of_seeds(LIT_BY_BULB(""), words);
    told pane = told_of_seeds(LIT_BY_BULB(PANE), words);
    double fewer = clear.in_time / pane.in_time;
    g_test_message("told %g, behind a pane %g; %g times fewer passes", clear.error,
                   pane.error, fewer);
    g_assert_cmpfloat(fewer, >, 1.0);
    g_assert_cmpfloat(pane.error, <, 1.3 * clear.error);
    g_assert_cmpfloat(pane.error * fewer, >, clear.error / 1.3);
}

/* Noise times rays, planning included. */
static double effort(const view *v, const char *words)
{
    g_autofree char *again = g_strconcat(words, " seed=7", NULL);
    uint64_t before = rays_asked;
    g_autoptr(image) a = render_with(v, words);
    double rays = (double)(rays_asked - before);
    g_autoptr(image) b = render_with(v, again);
    double noise = noise_of(a, b);
    g_test_message("%s: %.0f rays, noise %.5f", words, rays, noise);
    return rays * noise;
}

/* What queries of maps take is not in the rays: as long again, at most. */
static void test_pays(gconstpointer data)
{
    g_autoptr(view) v = view_of(data);
    double paths = effort(v, QUICK " gather_indirect=off");
    double photons = effort(v, QUICK);
    g_assert_cmpfloat(4.0 * photons, <, paths);
}

/* The means over blocks of pixels against those pixels themselves. */
static double error_of_blocks(const image *img, const image *truth)
{
    double sum = 0.0;
    for (int i = 0; i < truth->width * truth->height; i++) {
        int x = i % truth->width, y = i / truth->width;
        double mean = 0.0, expected = pixel(truth, x, y, 1);
        for (int k = 0; k < BLOCK * BLOCK; k++)
            mean += pixel(img, BLOCK * x + k % BLOCK, BLOCK * y + k / BLOCK, 1);
        double off = mean / (BLOCK * BLOCK) - expected;
        sum += off * off / (expected * expected + 0.01);
    }
    return sum / (truth->width * truth->height);
}

/* Sixteen times the passes leave 16^(-2/3) of the squared error, of noise and bias; the
   truth, by paths, has a little of its own. */
static void test_converges(void)
{
    g_autoptr(view) v = view_of(ROOM_OF(128)), coarse = view_of(ROOM_OF(16));
    g_autoptr(image) truth =
        render_with(coarse, "integrator=path passes=8 spp=1024 seed=9");
    double errors[2];
    for (int i = 0; i < 2; i++) {
        g_autofree char *words = g_strdup_printf(
            "integrator=auto spp=1 seed=2 planned_passes=16 passes=%d", i == 0 ? 2 : 32);
        g_autoptr(image) img = render_with(v, words);
        errors[i] = error_of_blocks(img, truth);
        g_test_message("%s: error %.6f", words, errors[i]);
    }
    g_assert_cmpfloat(errors[1], <, 0.5 * errors[0]);
    g_assert_cmpfloat(errors[1], <, 0.001);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(choices); i++) {
        g_autofree char *path = g_strdup_printf("/gather/chosen/%s", choices[i].name);
        g_test_add_data_func(path, &choices[i], test_chosen);
    }
    g_test_add_func("/gather/told", test_told);
    g_test_add_func("/gather/shown", test_shown);
    g_test_add_func("/gather/in-media", test_in_media);
    g_test_add_func("/gather/part-of-a-pass", test_part_of_a_pass);
    g_test_add_func("/gather/no-time", test_no_time);
    g_test_add_func("/gather/haze", test_haze);
    g_test_add_func("/gather/met-elsewhere", test_met_elsewhere);
    g_test_add_func("/gather/gaps", test_gaps);
    g_test_add_func("/gather/bulb", test_bulb);
    g_test_add_func("/gather/behind-glass", test_behind_glass);
    g_test_add_data_func("/gather/pays/room", ROOM_OF(128), test_pays);
    g_test_add_data_func("/gather/pays/glass", ROOM_OF(128) GLASS_BALL, test_pays);
    g_test_add_func("/gather/converges", test_converges);
    return g_test_run();
}
