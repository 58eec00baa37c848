/*
 * Where `auto` takes indirect light from photons: it does where a picture has less error
 * for its rays so, and where that is not known or not wanted it does not. The truth is a
 * long render by paths.
 */
#define _GNU_SOURCE /* RTLD_NEXT */
#include "ray_count.h"
#include "rooms.h"

#define FLOOR                                                                            \
    "LightSource \"infinite\" Material \"diffuse\" Shape \"disk\" \"float radius\" 9\n"

#define ROOM_OF(size) ROOM_CAMERA SIZE(size) "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS
#define OPEN_OF(size) ROOM_CAMERA SIZE(size) "WorldBegin\n" FLOOR

typedef struct choice {
    const char *name, *text, *words;
    bool gathers;
} choice;

#define QUICK "integrator=auto spp=1 passes=16 seed=2 threads=1"

static const choice choices[] = {
    {"room", ROOM_OF(64), QUICK, true},
    {"room-with-glass", ROOM_OF(64) GLASS_BALL, QUICK, true},
    {"open", OPEN_OF(64), QUICK, false},
    {"unwanted", ROOM_OF(64), QUICK " gather_indirect=off", false},
    {"bounded", ROOM_OF(64), QUICK " max_backward_bounces=9", false},
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

/* Mean square of what differs from the truth, in the dark as beside a tenth of white. */
static double error_of(const image *a, const image *truth)
{
    double sum = 0.0;
    size_t n = pixels_of(a);
    for (size_t i = 0; i < n; i++) {
        for (int c = 0; c < 3; c++) {
            double x = (double)a->pixels[i * (size_t)a->n_channels + (size_t)c];
            double y = (double)truth->pixels[i * (size_t)truth->n_channels + (size_t)c];
            sum += (x - y) * (x - y) / (y * y + 0.01);
        }
    }
    return sum / (3.0 * (double)n);
}

/* Error times rays, planning included. */
static double effort(const view *v, const char *words, const image *truth)
{
    uint64_t before = rays_asked;
    g_autoptr(image) img = render_with(v, words);
    double rays = (double)(rays_asked - before), error = error_of(img, truth);
    g_test_message("%s: %.0f rays, error %.5f", words, rays, error);
    return rays * error;
}

/* The smaller the picture, the fewer photons and the wider they reach: here it is little
   that they win, at 256 x 256 it is five times. */
static void test_pays(gconstpointer data)
{
    g_autoptr(view) v = view_of(data);
    g_autoptr(image) truth = render_with(v, "integrator=path passes=8 spp=128 seed=9");
    double paths = effort(v, QUICK " gather_indirect=off", truth);
    double photons = effort(v, QUICK, truth);
    g_assert_cmpfloat(1.25 * photons, <, paths);
}

/* Sixteen times the passes leave 16^(-2/3) of the squared error, of noise and bias. */
static void test_converges(void)
{
    g_autoptr(view) v = view_of(ROOM_OF(32));
    g_autoptr(image) truth = render_with(v, "integrator=path passes=8 spp=256 seed=9");
    static const char *const passes[] = {"passes=8", "passes=128"};
    double errors[2];
    for (int i = 0; i < 2; i++) {
        g_autofree char *words = g_strdup_printf(
            "integrator=auto spp=1 seed=2 planned_passes=32 %s", passes[i]);
        g_autoptr(image) img = render_with(v, words);
        errors[i] = error_of(img, truth);
        g_test_message("%s: error %.6f", words, errors[i]);
    }
    g_assert_cmpfloat(errors[1], <, 0.25 * errors[0]);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(choices); i++) {
        g_autofree char *path = g_strdup_printf("/gather/chosen/%s", choices[i].name);
        g_test_add_data_func(path, &choices[i], test_chosen);
    }
    g_test_add_data_func("/gather/pays/room", ROOM_OF(32), test_pays);
    g_test_add_data_func("/gather/pays/glass", ROOM_OF(32) GLASS_BALL, test_pays);
    g_test_add_func("/gather/converges", test_converges);
    return g_test_run();
}
