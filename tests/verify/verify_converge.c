/*
 * How errors fall: the slope of log MSE against log photons or samples.
 *
 * Path tracing of diffuse light falls as 1/N or, where its samples are laid out evenly,
 * faster: no faster than as N^-3, where what is sampled is smooth (Owen 1997). Progressive photon mapping with alpha = 2/3 has a variance and a squared bias
 * that both fall as N^(-2/3) (Knaus & Zwicker 2011, §4). Its caustic here has a closed
 * form: a point light in a plane mirror is a second point light.
 */
#include "rooms.h"
#include "verify.h"

enum { MAX_STEPS = 16, MAX_PIXELS = 1024 };

/* Squared error after so many passes, summed over seeds. */
typedef struct convergence {
    const render *render;
    const char *layer; /* "" for the beauty */
    double truth[MAX_PIXELS];
    int64_t passes[MAX_STEPS];
    double error[MAX_STEPS];
    size_t n;
} convergence;

static double pixel_of(const image *img, const char *layer, size_t pixel)
{
    g_autofree char *name = g_strdup_printf("%s%sG", layer, *layer ? "." : "");
    return at(img, pixel, channel_of(img, name));
}

static bool note_error(double fraction, const render_statistics *st, void *data)
{
    (void)fraction;
    convergence *c = data;
    for (size_t k = 0; k < c->n; k++) {
        if (c->passes[k] != st->passes || c->error[k] < 0)
            continue;
        g_autoptr(image) img = image_of(c->render);
        double sum = 0;
        for (size_t i = 0; i < pixels_of(img); i++) {
            double off = pixel_of(img, c->layer, i) - c->truth[i];
            sum += off * off;
        }
        c->error[k] = -sum / (double)pixels_of(img); /* noted: below zero */
    }
    return true;
}

/* Adds one seed's errors. */
static void run_seed(const view *v, const char *words, int seed, convergence *c)
{
    convergence own = *c;
    g_autofree char *all =
        g_strdup_printf("%s passes=%d seed=%d", words, (int)c->passes[c->n - 1], seed);
    g_autoptr(render) r = render_of(v, all);
    own.render = r;
    for (size_t k = 0; k < own.n; k++)
        own.error[k] = 0;
    g_assert_true(render_run(r, note_error, &own, NULL));
    for (size_t k = 0; k < own.n; k++)
        c->error[k] -= own.error[k];
}

static double slope_of(const convergence *c)
{
    double x[MAX_STEPS];
    for (size_t k = 0; k < c->n; k++) {
        x[k] = (double)c->passes[k];
        g_test_message("%4d passes: MSE %g", (int)c->passes[k], c->error[k]);
    }
    return verify_log_slope(x, c->error, c->n);
}

static void test_path(void)
{
    g_autoptr(view) v = view_of(ROOM);
    int seeds = VERIFY_SHORT_LONG(2, 8);
    convergence c = {.layer = "direct", .n = 4, .passes = {4, 16, 64, 256}};
    g_autoptr(image) truth =
        render_with(v, "integrator=path spp=64 passes=64 max_backward_bounces=1 seed=99");
    for (size_t i = 0; i < pixels_of(truth); i++)
        c.truth[i] = pixel_of(truth, c.layer, i);
    for (int seed = 0; seed < seeds; seed++)
        run_seed(v, "integrator=path spp=1 max_backward_bounces=1", seed, &c);
    double slope = slope_of(&c);
    g_test_message("slope %g", slope);
    g_assert_cmpfloat(slope, <, -0.92);
    g_assert_cmpfloat(slope, >, -3.0);
    /* every pass must do its share, not only one in many */
    for (size_t k = 1; k < c.n; k++) {
        double step = log(c.error[k] / c.error[k - 1]) / log(4);
        g_assert_cmpfloat(step, <, -0.8);
    }
}

/* ---- The caustic of a plane mirror ---- */

/* A point light hidden from the floor, a mirror on x = 1, and the floor between. The
   light stands at (-0.5, 0, 0.4), its image at (2.5, 0, 0.4). */
#define MIRRORED_LIGHT                                                                   \
    "LookAt 0 0 5  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 12\n" SIZE(         \
        16) "WorldBegin LightSource \"point\" \"spectrum I\" [300 1 900 1] \"point3 "    \
            "from\" [-0.5 0 0.4]\n"                                                      \
            "Material \"diffuse\" \"spectrum reflectance\" [300 0.5 900 0.5] Shape "     \
            "\"trianglemesh\" \"point3 P\" [-9 -9 0 9 -9 0 9 9 0 -9 9 0] \"integer "     \
            "indices\" [0 1 2 0 2 3]\n"                                                  \
            "Material \"conductor\" \"rgb reflectance\" [0.9999 0.9999 0.9999] Shape "   \
            "\"trianglemesh\" \"point3 P\" [1 -0.7 0 1 0.7 0 1 0.7 0.3 1 -0.7 0.3] "     \
            "\"integer "                                                                 \
            "indices\" [0 1 2 0 2 3]\n"

/* The same without the mirror, and the light in the place of its image. */
static view *image_of_light(void)
{
    GString *text = g_string_new(MIRRORED_LIGHT);
    g_string_replace(text, "from\" [-0.5 0 0.4]", "from\" [2.5 0 0.4]", 1);
    g_string_truncate(text,
                      (gsize)(strstr(text->str, "Material \"conductor\"") - text->str));
    view *v = view_of(text->str);
    g_string_free(text, TRUE);
    return v;
}

static void test_sppm(void)
{
    g_autoptr(view) v = view_of(MIRRORED_LIGHT), twin = image_of_light();
    int seeds = VERIFY_SHORT_LONG(8, 64);
    convergence c = {.layer = "caustic", .n = 6, .passes = {4, 8, 16, 32, 64, 128}};
    g_autoptr(image) truth =
        render_with(twin, "integrator=path spp=64 passes=64 seed=99");
    for (size_t i = 0; i < pixels_of(truth); i++)
        c.truth[i] = pixel_of(truth, "direct", i);
    for (int seed = 0; seed < seeds; seed++)
        run_seed(v,
                 "integrator=sppm radius=0.15 caustic_photons=400 indirect_photons=1 "
                 "caustic_emission=specular-area max_forward_bounces=1",
                 seed, &c);
    double slope = slope_of(&c);
    g_test_message("slope %g", slope);
    g_assert_cmpfloat(fabs(slope + 2.0 / 3.0), <, 0.08);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/verify/converge/path", test_path);
    g_test_add_func("/verify/converge/sppm", test_sppm);
    return g_test_run();
}
