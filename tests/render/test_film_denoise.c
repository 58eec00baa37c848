/*
 * film-denoise: what is shown beside the raw picture. Against the same room rendered for
 * long, by every algorithm; and what it must leave as it is.
 */
#include "rooms.h"

#include "base/clock.h"
#include "base/memory.h"
#include "image/compare.h"
#include "image/layers.h"
#include "render/film/film_denoise.h"
#include "render/film/film_halves.h"
#include "render/render_state.h"

#include <glib/gstdio.h>

/* The room with a ball of glass, which throws a caustic, and a mirror on the wall. */
#define HALL                                                                             \
    ROOM_CAMERA SIZE(40) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS                         \
        "AttributeBegin Translate 0.7 0 0 " GLASS_BALL "AttributeEnd\n"                  \
        "Material \"conductor\" Shape \"trianglemesh\" \"point3 P\" [-1.8 1 0.3 -0.4 "   \
        "1.8 0.3 -0.4 1.8 1.7 -1.8 1 1.7] \"integer indices\" [0 1 2 0 2 3]\n"

static image_difference against(const image *img, const image *reference)
{
    image_difference d;
    g_assert_true(image_compare(img, reference, &d, NULL));
    return d;
}

/* relMSE of the raw picture and of that without noise. */
typedef struct errors {
    double raw, denoised;
} errors;

static errors errors_of(const image *img, const image *reference)
{
    g_autoptr(image) shown = image_layer(img, "denoised", NULL);
    g_assert_nonnull(shown);
    return (errors){against(img, reference).relmse, against(shown, reference).relmse};
}

static image *hall(const view *v, const char *integrator, int passes, int seed)
{
    g_autofree char *words =
        g_strdup_printf("denoise=on integrator=%s spp=4 photons=8000 passes=%d seed=%d",
                        integrator, passes, seed);
    return render_with(v, words);
}

/* Passes of few samples show less than a third of their error, and more passes less of
   it; all of it is far above that of the reference. */
static void test_less_noise(void)
{
    g_autoptr(view) v = view_of(HALL);
    g_autoptr(image) reference =
        render_with(v, "integrator=path spp=16 passes=60 seed=9");
    double before = (double)INFINITY;
    for (int passes = 2; passes <= 8; passes *= 4) {
        g_autoptr(image) img = hall(v, "path", passes, 1);
        errors e = errors_of(img, reference);
        g_test_message("%d passes: %g, denoised %g", passes, e.raw, e.denoised);
        g_assert_cmpfloat(e.denoised, <, 0.4 * e.raw);
        g_assert_cmpfloat(e.denoised, <, 0.7 * before);
        before = e.denoised;
    }
}

/* Fewer windows say something else, and hardly anything worse. */
static void test_windows(void)
{
    static const char how[] = "denoise=on integrator=path spp=4 passes=4 ";
    g_autoptr(view) v = view_of(HALL);
    g_autoptr(image) reference =
        render_with(v, "integrator=path spp=16 passes=60 seed=9");
    g_autofree char *few = g_strconcat(how, "denoise_windows=coarse", NULL);
    g_autofree char *many = g_strconcat(how, "denoise_windows=fine", NULL);
    g_autoptr(image) coarse = render_with(v, few), fine = render_with(v, many);
    errors of_few = errors_of(coarse, reference), of_many = errors_of(fine, reference);
    g_test_message("fine %g, coarse %g", of_many.denoised, of_few.denoised);
    g_assert_cmpfloat(of_few.raw, ==, of_many.raw);
    g_assert_cmpfloat(of_few.denoised, !=, of_many.denoised);
    g_assert_cmpfloat(of_few.denoised, <, 1.25 * of_many.denoised);
}

static const char *const integrators[] = {"path", "vcm", "photonmap", "auto"};

/* A lamp and a mirror that shows it: all else is black. */
static const char mirror[] = ROOM_CAMERA SIZE(16) "WorldBegin\n" ROOM_LAMP(
    "") "Material \"conductor\" Shape \"trianglemesh\" \"point3 P\" [-2 -4 0.8 2 -4 "
        "0.8 "
        "2 2 0.8 -2 2 0.8] \"integer indices\" [0 1 2 0 2 3]\n";

/* A ball of chrome in a box that is open towards the eye: beside the lamp it shows the
   dark outside. */
#define OPEN_BOX                                                                         \
    "Film \"rgb\" \"integer xresolution\" 128 \"integer yresolution\" 128 \"float "      \
    "cropwindow\" [0.2 0.5 0.55 0.9] PixelFilter \"box\"\n"                              \
    "Scale -1 1 1 LookAt .278 .273 -.8  .278 .273 0  0 1 0 Camera \"perspective\" "      \
    "\"float fov\" 39.3\n"                                                               \
    "WorldBegin\n"                                                                       \
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [17 12 4] "                    \
    "Material \"diffuse\" \"rgb reflectance\" [0 0 0] Shape \"trianglemesh\" \"integer " \
    "indices\" [0 1 2 0 2 3] "                                                           \
    "\"point3 P\" [.343 .5487 .227 .343 .5487 .332 .213 .5487 .332 .213 .5487 .227] "    \
    "AttributeEnd\n"                                                                     \
    "Material \"diffuse\" \"rgb reflectance\" [.7 .7 .7]\n"                              \
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3 4 5 6 4 6 7 8 9 10 8 10 "   \
    "11 12 13 14 12 14 15 16 17 18 16 18 19] "                                           \
    "\"point3 P\" [.5528 0 0 0 0 0 0 0 .5592 .5528 0 .5592 .5528 .5488 0 .5528 .5488 "   \
    ".5592 0 .5488 .5592 0 .5488 0 "                                                     \
    ".5528 0 .5592 0 0 .5592 0 .5488 .5592 .5528 .5488 .5592 0 0 .5592 0 0 0 0 .5488 0 " \
    "0 .5488 .5592 "                                                                     \
    ".5528 0 0 .5528 0 .5592 .5528 .5488 .5592 .5528 .5488 0]\n"                         \
    "Translate .4 .1 .37 Material \"conductor\" \"spectrum reflectance\" [200 1 900 1] " \
    "Shape \"sphere\" \"float radius\" .1\n"

/* The most that a pixel has of lamps seen by mirrors and glass. */
typedef struct lamps_seen {
    float lights, glints;
} lamps_seen;

/* In a scene where all else is black: lamps are all that mirrors and glass show. */
static lamps_seen lamps_by(const view *v, const char *integrator)
{
    lamps_seen most = {0};
    g_autofree char *words = g_strdup_printf(
        "denoise=on passes=3 spp=2 photons=500 integrator=%s", integrator);
    g_autoptr(render) r = render_of(v, words);
    g_assert_true(render_run(r, NULL, NULL, NULL));
    for (int i = 0; i < 16 * 16; i++) {
        const guide_sum *guides = &r->film.halves[i].guides;
        float shown = (float)r->film.pixels[i].sum.color[LAYER_SPECULAR][1];
        g_assert_cmpfloat_with_epsilon(guides->lights[1] + guides->glints[1], shown,
                                       1e-4f * (1.0f + shown));
        most.lights = fmaxf(most.lights, guides->lights[1]);
        most.glints = fmaxf(most.glints, guides->glints[1]);
    }
    return most;
}

/* What a mirror shows of a lamp is the lamp, whose light is known. */
static void test_lamp_in_mirror(void)
{
    g_autoptr(view) v = view_of(mirror);
    for (size_t k = 0; k < G_N_ELEMENTS(integrators); k++) {
        lamps_seen most = lamps_by(v, integrators[k]);
        g_assert_cmpfloat(most.lights, >, 1.0f);
        g_assert_cmpfloat(most.glints, ==, 0.0f);
    }
}

/* A lamp before the eye, as wide as the picture, and a pane of glass between. */
#define BEHIND_A_PANE                                                                    \
    "Camera \"perspective\" \"float fov\" 20\n" SIZE(                                    \
        16) "WorldBegin\n"                                                               \
            "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0 0 0] "           \
            "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool "                      \
            "twosided\" true Shape \"trianglemesh\" \"point3 P\" [-9 -9 5 9 -9 5 9 9 "   \
            "5 -9 9 5] \"integer indices\" [0 1 2 0 2 3] AttributeEnd\n"                 \
            "Material \"dielectric\" \"float eta\" 1.5\n"                                \
            "Shape \"trianglemesh\" \"point3 P\" [-2 -2 2 2 -2 2 2 2 2 -2 2 2 -2 -2 "    \
            "2.1 2 -2 2.1 2 2 2.1 -2 2 2.1] \"integer indices\" [0 2 1 0 3 2 4 5 6 4 "   \
            "6 7]\n"

/* Each path sees it: of its light .96² comes through the pane. */
static void test_lamp_behind_pane(void)
{
    g_autoptr(view) v = view_of(BEHIND_A_PANE);
    for (size_t k = 0; k < G_N_ELEMENTS(integrators); k++) {
        for (int seed = 0; seed < 4; seed++) {
            g_autofree char *words =
                g_strdup_printf("denoise=on passes=1 spp=1 photons=500 seed=%d "
                                "integrator=%s",
                                seed, integrators[k]);
            g_autoptr(render) r = render_of(v, words);
            g_assert_true(render_run(r, NULL, NULL, NULL));
            for (int i = 0; i < 16 * 16; i++)
                g_assert_cmpfloat(r->film.halves[i].guides.lights[1], >, 0.5f);
        }
    }
}

/* And two balls of glass, in which light goes to and fro. */
#define BEHIND_BALLS                                                                     \
    BEHIND_A_PANE "AttributeBegin Translate 0 0 3.2 Shape \"sphere\" \"float radius\" "  \
                  ".8 AttributeEnd Translate 0 0 1.2 Shape \"sphere\" \"float "          \
                  "radius\" .7\n"

/* Where chance chose the way through glass, lamps are glints. */
static void test_glints(void)
{
    g_autoptr(view) v = view_of(BEHIND_BALLS);
    for (size_t k = 0; k < G_N_ELEMENTS(integrators); k++)
        g_assert_cmpfloat(lamps_by(v, integrators[k]).glints, >, 0.02f);
}

/* So it is as sharp as a lamp in sight, also where few samples find its edge: what is
   shown differs by the noise of other light, .003 to .08, and not by a lamp smeared over
   what is dark beside it, .5 to 1.3. */
static void test_sharp_in_mirror(void)
{
    g_autoptr(view) v = view_of(OPEN_BOX);
    for (size_t k = 0; k < G_N_ELEMENTS(integrators); k++) {
        for (int seed = 0; seed < 4; seed++) {
            g_autofree char *words = g_strdup_printf(
                "denoise=on passes=2 spp=1 seed=%d integrator=%s", seed, integrators[k]);
            g_autoptr(image) img = render_with(v, words);
            g_autoptr(image) shown = image_layer(img, "denoised", NULL);
            g_assert_cmpfloat(against(shown, img).relmse, <, 0.2);
        }
    }
}

/* A checkered floor and a ball, with sky beside them. */
#define RIMS                                                                             \
    ROOM_CAMERA "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32 "    \
                "PixelFilter \"mitchell\" WorldBegin "                                   \
                "LightSource \"infinite\" \"rgb L\" [1 1 1] "                            \
                "Texture \"t\" \"spectrum\" \"checkerboard\" \"float uscale\" 8 "        \
                "\"float vscale\" 8 \"rgb tex1\" [.05 .3 .1] \"rgb tex2\" [.6 .1 .4] "   \
                "Material \"diffuse\" \"texture reflectance\" \"t\" "                    \
                "Shape \"trianglemesh\" \"point3 P\" [-1 -2 .3 1 -2 .3 1 1 .3 -1 1 .3] " \
                "\"point2 uv\" [0 0 1 0 1 1 0 1] \"integer indices\" [0 1 2 0 2 3] "     \
                "Translate 0 0 .8 Shape \"sphere\" \"float radius\" .4\n"

/* A filter with weights of either sign has those of the surfaces in a pixel come to next
   to nothing at some rims. By them means of what is there were thousands, and what is
   shown up to 20 where 1 is right. */
static void test_rims(void)
{
    static const char *const bounded[] = {"albedo.R", "normal.Z", "depth.Z"};
    g_autoptr(view) v = view_of(RIMS);
    for (int seed = 0; seed < 8; seed++) {
        g_autofree char *words =
            g_strdup_printf("denoise=on integrator=path spp=1 passes=32 seed=%d", seed);
        g_autoptr(image) img = render_with(v, words);
        for (size_t i = 0; i < 3 * pixels_of(img); i++) {
            const char *c[] = {"R", "G", "B"},
                       *shown[] = {"denoised.R", "denoised.G", "denoised.B"};
            double is = at(img, i / 3, channel_of(img, shown[i % 3]));
            double was = at(img, i / 3, channel_of(img, c[i % 3]));
            g_assert_cmpfloat(fabs(is - was), <, 0.5);
            g_assert_cmpfloat(fabs(at(img, i / 3, channel_of(img, bounded[i % 3]))), <,
                              8);
        }
    }
}

/* What a photon map errs by is smooth, or the same in both halves: there is little to
   take out, and nothing must be lost. */
static const struct {
    const char *integrator;
    double most; /* of the raw error */
    int passes;  /* of the reference: few paths of auto are far brighter than others */
} algorithms[] = {{"vcm", 0.6, 16}, {"photonmap", 1.05, 16}, {"auto", 1.05, 60}};

static void test_algorithms(void)
{
    g_autoptr(view) v = view_of(HALL);
    for (size_t i = 0; i < G_N_ELEMENTS(algorithms); i++) {
        const char *integrator = algorithms[i].integrator;
        g_autofree char *words =
            g_strdup_printf("integrator=%s spp=16 photons=16000 passes=%d seed=9",
                            integrator, algorithms[i].passes);
        g_autoptr(image) reference = render_with(v, words);
        g_autoptr(image) img = hall(v, integrator, 4, 1);
        errors e = errors_of(img, reference);
        g_test_message("%s: %g, denoised %g", integrator, e.raw, e.denoised);
        g_assert_cmpfloat(e.denoised, <, algorithms[i].most * e.raw);
    }
}

/* What is beside it (and lights in sight) is the same to the bit, and so is it with any
   number of threads. */
static void test_raw_stays(void)
{
    g_autoptr(view) v = view_of(HALL);
    g_autoptr(image) off = render_with(v, "integrator=auto spp=1 passes=3 threads=1");
    g_autoptr(image) on =
        render_with(v, "integrator=auto spp=1 passes=3 threads=1 denoise=on");
    g_autoptr(image) others =
        render_with(v, "integrator=auto spp=1 passes=3 threads=3 denoise=on");
    g_assert_cmpint(on->n_channels, ==, off->n_channels + 7);
    for (int c = 0; c < off->n_channels; c++) {
        g_assert_cmpstr(on->channels[c], ==, off->channels[c]);
        for (size_t i = 0; i < pixels_of(on); i++)
            g_assert_cmpfloat(at(on, i, (size_t)c), ==, at(off, i, (size_t)c));
    }
    assert_same_bits(on, others);
}

/* Half a pass has two halves, each of pixels in every other row: neither as good as those
   of two passes, each far better than a picture whose noise stays. Of less there is none,
   nor of one pass of many samples. */
static void test_one_pass(void)
{
    static const char *const passes[] = {"0.5", "0.75", "1", "1.25", "1.75", "2"};
    g_autoptr(view) v = view_of(HALL);
    g_autoptr(image) reference = hall(v, "path", 400, 9);
    double before = (double)INFINITY;
    for (size_t i = 0; i < G_N_ELEMENTS(passes); i++) {
        g_autofree char *words = g_strdup_printf(
            "denoise=on integrator=path spp=1 planned_passes=2 passes=%s", passes[i]);
        g_autoptr(image) img = render_with(v, words);
        errors e = errors_of(img, reference);
        g_test_message("%s passes: %g, denoised %g", passes[i], e.raw, e.denoised);
        g_assert_cmpfloat(e.denoised, <, 0.5 * e.raw);
        g_assert_cmpfloat(e.denoised, <, 1.5 * before);
        before = e.denoised;
    }
    static const char *const none[] = {"spp=1 passes=0.46875", "spp=5 passes=1"};
    for (size_t i = 0; i < G_N_ELEMENTS(none); i++) {
        g_autofree char *words = g_strconcat("photons=500 denoise=on ", none[i], NULL);
        g_autoptr(image) img = render_with(v, words);
        g_assert_cmpint(image_channel(img, "denoised.R"), ==, -1);
    }
}

/* Of the hall by paths, denoised: its channels of that, with what it is off by. */
static image *shown_after(const view *v, const char *words, const image *reference,
                          errors *off)
{
    g_autofree char *all = g_strconcat("denoise=on integrator=path spp=1 ", words, NULL);
    g_autoptr(image) img = render_with(v, all);
    *off = errors_of(img, reference);
    return image_layer(img, "denoised", NULL);
}

/* Where less than two samples are planned lights are filtered as one: another picture,
   and hardly a worse one. Who plans for few and goes on has lights apart again. */
static void test_together(void)
{
    g_autoptr(view) v = view_of(HALL);
    g_autoptr(image) reference = hall(v, "path", 400, 9);
    errors as_one, apart;
    for (int passes = 1; passes <= 4; passes += 3) {
        g_autofree char *few = g_strdup_printf("planned_passes=1 passes=%d", passes);
        g_autofree char *many = g_strdup_printf("planned_passes=2 passes=%d", passes);
        g_autoptr(image) a = shown_after(v, few, reference, &as_one);
        g_autoptr(image) b = shown_after(v, many, reference, &apart);
        g_test_message("%d passes: as one %g, apart %g of %g", passes, as_one.denoised,
                       apart.denoised, apart.raw);
        g_assert_cmpfloat(as_one.raw, ==, apart.raw);
        g_assert_true((against(a, b).rmse > 0.0f) == (passes == 1));
        g_assert_cmpfloat(as_one.denoised, <, 1.15 * apart.denoised);
    }
}

/* A pass that was ended early is in the picture shown as far as it came: of 63 of its 64
   parts nearly all. */
static void test_part_of_a_pass(void)
{
    g_autoptr(view) v = view_of(HALL);
    static const char *const passes[] = {"2", "2.984375", "3"};
    image *shown[3];
    for (int i = 0; i < 3; i++) {
        g_autofree char *words = g_strdup_printf(
            "denoise=on integrator=path spp=1 planned_passes=3 passes=%s", passes[i]);
        g_autoptr(image) img = render_with(v, words);
        shown[i] = image_layer(img, "denoised", NULL);
    }
    double without = against(shown[0], shown[2]).rmse;
    double with = against(shown[1], shown[2]).rmse;
    g_test_message("from three passes: two are off by %g, nearly three by %g", without,
                   with);
    g_assert_cmpfloat(with, <, 0.3 * without);
    for (int i = 0; i < 3; i++)
        image_free(shown[i]);
}

/* Noise that there is no time to take out is left in, which is said. */
static void test_no_time(void)
{
    g_autoptr(view) v = view_of(HALL);
    for (int i = 0; i < 2; i++) {
        g_autoptr(render) r = render_of(v, "denoise=on spp=1 passes=1 photons=500");
        g_assert_true(render_run(r, NULL, NULL, NULL));
        r->plan.how.time = 1.0;
        r->start -= i == 0 ? 2.0 : 0.0;
        render_time_writing(r);
        g_assert_true(render_get_statistics(r).left_noisy == (i == 0));
        g_autoptr(image) img = image_of(r);
        g_assert_true((image_channel(img, "denoised.R") < 0) == (i == 0));
    }
}

/* Where that is known before the first pass, all is planned for a picture whose noise
   stays, and who repeats it is told so. Where the time is just over, for half a pass,
   which is rendered and denoised whatever the time. */
static void test_no_time_ahead(void)
{
    g_autoptr(view) v = view_of(HALL);
    const double elapsed[] = {0.0, 600.0, 700.0};
    view_resize(v, 800, 800);
    for (size_t i = 0; i < G_N_ELEMENTS(elapsed); i++) {
        g_autoptr(render) r = render_of(v, "denoise=on spp=1 time=600 photons=500");
        bool late = i == G_N_ELEMENTS(elapsed) - 1;
        render_start_clock(r);
        r->start -= elapsed[i];
        g_assert_true(render_prepare(r, NULL));
        g_assert_true(late || r->plan.how.planned_passes >= 0.5);
        g_assert_true(r->plan.how.denoise == !late);
        g_assert_true(render_get_statistics(r).left_noisy == late);
        g_assert_true(r->film.no_time == late);
    }
}

/* The least of three, for other work may come between. */
static double least_seconds(const film *f)
{
    double least = (double)INFINITY;
    for (int i = 0; i < 3; i++) {
        double start = clock_seconds();
        float *out;
        g_assert_true(film_denoise(f, 1, NULL, &out, NULL));
        big_free(out);
        least = fmin(least, clock_seconds() - start);
    }
    return least;
}

static double seconds_told(const film *f, const view *v, bool gets_more)
{
    return film_denoise_trial(f, v, 1, 1.0) * film_denoise_work(f, 1, gets_more);
}

/* How long it takes is told before there is a picture and by one, lights apart or not. */
static void test_seconds(void)
{
    g_autoptr(view) v = view_of(HALL);
    g_autoptr(render) r = render_of(v, "denoise=on spp=1 passes=2 photons=500");
    double ahead = seconds_told(&r->film, v, false);
    g_assert_true(render_run(r, NULL, NULL, NULL));
    for (int together = 0; together < 2; together++) {
        r->film.together = together;
        double told = seconds_told(&r->film, v, false);
        double is = least_seconds(&r->film);
        g_test_message("%g s ahead, %g s by the picture, %g s", ahead, told, is);
        g_assert_cmpfloat(fmin(told, ahead), >, is / 3.0);
        g_assert_cmpfloat(fmax(told, ahead), <, is * 3.0);
    }
    g_autoptr(render) lone = render_of(v, "denoise=on spp=8 passes=1 photons=500");
    g_assert_true(render_run(lone, NULL, NULL, NULL));
    g_assert_cmpfloat(seconds_told(&lone->film, v, false), ==, 0.0);
    g_assert_cmpfloat(seconds_told(&lone->film, v, true), >, 0.0);
}

/* A scene in millimetres, with a sensor that is less sensitive, looks the same. */
static void test_units(void)
{
    g_autoptr(view) v = view_of(HALL);
    g_autoptr(view) small = view_of("Scale 0.001 0.001 0.001\n" HALL);
    g_autoptr(image) a = hall(v, "path", 4, 1), b = hall(small, "path", 4, 1);
    g_autoptr(image) of_a = image_layer(a, "denoised", NULL);
    g_autoptr(image) of_b = image_layer(b, "denoised", NULL);
    g_assert_cmpfloat(against(of_b, of_a).relmse, <, 0.1 * against(a, of_a).relmse);
}

/* What a PNG file of one picture is to show of another, to half a code. */
static bool is_shown(const image *written, const char *png, const image *of)
{
    g_assert_true(image_write(written, png, NULL, NULL));
    g_autoptr(image) shown = image_read(png, NULL, NULL);
    bool same = true;
    for (size_t i = 0; i < pixels_of(of) * 3; i++) {
        float linear = CLAMP(of->pixels[i], 0.0f, 1.0f);
        float off = srgb_encode(shown->pixels[i]) - srgb_encode(linear);
        same = same && fabsf(off) < 0.6f / 255.0f;
    }
    return same;
}

/* Files of eight bits show it; its floats stay beside the raw ones. */
static void test_files(void)
{
    g_autoptr(view) v = view_of(HALL);
    g_autoptr(image) img = hall(v, "path", 2, 1);
    g_autoptr(image) denoised = image_as_shown(img, 1.0f, NULL);
    g_autoptr(image) raw = image_layer(img, "raw", NULL);
    g_autofree char *folder = g_dir_make_tmp("denoise-XXXXXX", NULL);
    g_autofree char *png = g_build_filename(folder, "a.png", NULL);
    g_assert_true(is_shown(img, png, denoised));
    g_assert_true(is_shown(raw, png, raw));
    g_assert_false(is_shown(img, png, raw));
    g_autoptr(GError) error = NULL;
    g_assert_null(image_layer(raw, "denoised", &error));
    g_assert_error(error, NEPH_ERROR, ERROR_USAGE);
    g_assert_nonnull(strstr(error->message, "raw"));
    remove(png);
    g_rmdir(folder);
}

/* ---- Edges of lights ---- */

/* A lamp over white by far from the left edge to a third of the fourth pixel of eight, a
   metre a pixel, and one that is smaller than the pixel it is in. */
#define EDGE                                                                             \
    "LookAt 0 0 9 0 0 0 0 1 0 Scale -1 1 1 Camera \"orthographic\" \"float "             \
    "screenwindow\" "                                                                    \
    "[-4 4 -4 4]\n" SIZE(8) "WorldBegin\n"                                               \
                            "AreaLightSource \"diffuse\" \"rgb L\" [500 500 500]\n"      \
                            "Shape \"trianglemesh\" \"point3 P\" [-9 -9 0 -0.6667 -9 0 " \
                            "-0.6667 9 0 -9 9 0] "                                       \
                            "\"integer indices\" [0 1 2 0 2 3]\n"                        \
                            "Shape \"trianglemesh\" \"point3 P\" [2.2 1.2 0 2.5 1.2 0 "  \
                            "2.5 1.5 0 2.2 1.5 0] "                                      \
                            "\"integer indices\" [0 1 2 0 2 3]\n"

/* Pixel (x, 2) of eight by eight. */
static const float *in_row(const image *img, int x)
{
    return img->pixels + (size_t)(2 * 8 + x) * (size_t)img->n_channels;
}

/* A pixel of which a lamp fills a third is seen a third as bright as white at any
   exposure, though its mean is far above it; the mean stays in the floats. A lamp within
   a pixel, beside which none is full, keeps its mean. */
static void test_edges_of_lights(void)
{
    g_autoptr(view) v = view_of(EDGE);
    g_autoptr(image) img = render_with(v, "denoise=on integrator=path spp=64 passes=4");
    g_autoptr(image) floats = image_layer(img, "denoised", NULL);
    g_assert_cmpfloat(in_row(floats, 3)[0], >, 100.0f);
    for (float white = 0.5f; white <= 2.0f; white *= 2.0f) {
        g_autoptr(image) seen = image_as_shown(img, white, NULL);
        g_assert_cmpfloat(in_row(seen, 2)[0], >, white);
        g_assert_cmpfloat(fabsf(in_row(seen, 3)[0] / white - 1.0f / 3.0f), <, 0.05f);
        g_assert_cmpfloat(in_row(seen, 4)[0], <, 1e-3f);
        g_assert_cmpfloat(in_row(seen, 6)[0], >, white);
    }
    g_autoptr(image) all = image_as_shown(img, INFINITY, NULL);
    g_assert_cmpfloat(fabsf(in_row(all, 3)[0] - in_row(floats, 3)[0]), <, 1e-3f);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/film-denoise/less-noise", test_less_noise);
    g_test_add_func("/film-denoise/windows", test_windows);
    g_test_add_func("/film-denoise/lamp-in-mirror", test_lamp_in_mirror);
    g_test_add_func("/film-denoise/lamp-behind-pane", test_lamp_behind_pane);
    g_test_add_func("/film-denoise/glints", test_glints);
    g_test_add_func("/film-denoise/sharp-in-mirror", test_sharp_in_mirror);
    g_test_add_func("/film-denoise/rims", test_rims);
    g_test_add_func("/film-denoise/algorithms", test_algorithms);
    g_test_add_func("/film-denoise/raw-stays", test_raw_stays);
    g_test_add_func("/film-denoise/one-pass", test_one_pass);
    g_test_add_func("/film-denoise/together", test_together);
    g_test_add_func("/film-denoise/part-of-a-pass", test_part_of_a_pass);
    g_test_add_func("/film-denoise/no-time", test_no_time);
    g_test_add_func("/film-denoise/no-time-ahead", test_no_time_ahead);
    g_test_add_func("/film-denoise/seconds", test_seconds);
    g_test_add_func("/film-denoise/units", test_units);
    g_test_add_func("/film-denoise/files", test_files);
    g_test_add_func("/film-denoise/edges-of-lights", test_edges_of_lights);
    return g_test_run();
}
