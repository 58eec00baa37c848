/*
 * fog: what the transports make of participating media, against closed forms, quadrature
 * and a naive twin (fog_twin.h). All views are so narrow that the picture is one ray.
 *
 * Tolerances are four standard errors and more of so few samples; what photons blur is
 * said where it is allowed for.
 */
#include "fog_views.h"

/* Auto without gathering: the error of maps, which is alike in all pixels of so narrow a
   view, is by its measure no worse than the noise of one pixel, but is the mean's, too;
   maps have the photons that they need in verify_fog.c. */
static const method ways[] = {
    {"path", "integrator=path spp=64 passes=16 max_backward_bounces=-1", 0},
    {"auto",
     "integrator=auto spp=64 passes=8 photons=4000 max_backward_bounces=-1 "
     "gather_indirect=off",
     0},
};

/* ---- Colours ---- */

/* Scatters 0.6 / m below 550 nm and 3 / m above, and absorbs 0.2 / m. */
#define COLOURED                                                                         \
    "MakeNamedMedium \"f\" \"string type\" \"homogeneous\" \"spectrum sigma_a\" [300 "   \
    ".2 "                                                                                \
    "900 .2] \"spectrum sigma_s\" [300 .6 549.9 .6 550.1 3 900 3] \"float g\" .3\n"

static const double coloured_sigma_s[2] = {0.6, 3};

/* Linear sRGB of the scene's first lamp, of intensity 1, weighed by a step at 550 nm. */
static void coloured_rgb(const scene *s, const double weight[2], float rgb[3])
{
    enum { N = 200 };
    const light *l = scene_light(s, 0);
    float xyz[3] = {0}, part[3];
    for (int i = 0; i < N; i++) {
        const wavelengths w = wavelengths_at(((float)i + 0.5f) / N);
        light_sample to;
        vec3 p = vec3_make(2, -1.5f, 1); /* a metre away */
        g_assert_true(l->kind->sample(l->self, &w, p, 0, (vec2){0}, &to));
        for (int k = 0; k < N_WAVELENGTHS; k++)
            to.radiance[k] *= (float)weight[w.lambda[k] > 550];
        spectrum_to_xyz(&w, to.radiance, part);
        for (int k = 0; k < 3; k++)
            xyz[k] += part[k] / N;
    }
    color_space_from_xyz(color_space_srgb(), xyz, rgb);
}

static void test_colour(gconstpointer data)
{
    const method *m = data;
    const double eye[3] = {0, -4, 0.3}, way[3] = {0, 1, 0};
    double weight[2];
    for (int i = 0; i < 2; i++) {
        const twin t = {0.2,         coloured_sigma_s[i],  0.3,
                        .radius = 1, .lamp = {2, -1.5, 0}, .strength = 1};
        weight[i] = twin_radiance(&t, eye, way, 400000, 11).sum;
    }
    g_autoptr(view) v = view_of(COLOURED EYE("", "0 -4 .3  0 0 .3") BETWEEN("", "")
                                    POINT("2 -1.5 0") BETWEEN("f", "") BALL("1"));
    float expected[3];
    coloured_rgb(v->scene, weight, expected);
    g_autofree char *how = g_strconcat(m->words, " spp=16 passes=64", NULL);
    g_autoptr(image) img = render_with(v, how);
    for (int c = 0; c < 3; c++) {
        const char name[2] = {"RGB"[c], 0};
        double seen = 0;
        for (size_t i = 0; i < pixels_of(img); i++)
            seen += at(img, i, channel_of(img, name)) / (double)pixels_of(img);
        g_test_message("%s: %.5f, expected %.5f", name, seen, (double)expected[c]);
        g_assert_cmpfloat(fabs(seen / (double)expected[c] - 1), <, 0.02 + m->more);
    }
}

/* ---- Noise ---- */

/* Squared, over the mean: of pixels that see the same. */
static double relative_variance(const image *img)
{
    const double mean = mean_of(img, "");
    const size_t n = pixels_of(img);
    double sum = 0;
    for (size_t i = 0; i < n; i++) {
        double off = (double)at(img, i, channel_of(img, "G")) / mean - 1;
        sum += off * off / (double)(n - 1);
    }
    return sum;
}

/* A ray that crosses a beam is scattered in it by half of the samples, one after the
   other: the variance of each is .04. With points drawn near the lamp but all along the
   ray, and only if one drawn before was lit, it was 18. */
static void test_beam_is_found(void)
{
    g_autoptr(view) v = view_of(BEAM);
    g_autoptr(image) img =
        render_with(v, "integrator=path spp=16 passes=1 max_backward_bounces=1");
    double each = 16 * relative_variance(img);
    g_test_message("variance of a sample: %.2f", each);
    g_assert_cmpfloat(each, <, 0.5);
}

/* ---- The twin itself ---- */

static void test_twin(void)
{
    for (size_t i = 0; i < G_N_ELEMENTS(scattering); i++) {
        const fog_view *v = &scattering[i];
        double way[3];
        if (v->expected != all_orders)
            continue;
        unit_way(v, way);
        twin_result r = twin_radiance(&v->twin, v->eye, way, 400000, 3);
        double once = twin_single(&v->twin, v->eye, way);
        g_test_message("%s: once %.5f, by quadrature %.5f; all %.5f +- %.5f", v->name,
                       r.order[0], once, r.sum, r.error);
        g_assert_cmpfloat(fabs(r.order[0] / once - 1), <, 0.01);
    }
}

/* What fog scatters toward the eye has nothing of the surface behind it: it is in the
   layer that is not divided by that one's albedo. */
static void test_layer(gconstpointer data)
{
    const method *m = data;
    g_autoptr(view) v = view_of(COLOURED EYE("", "0 -4 .3  0 0 .3") BETWEEN("", "")
                                    POINT("2 -1.5 0") BETWEEN("f", "") BALL("1"));
    g_autoptr(image) img = render_with(v, m->words);
    g_assert_cmpfloat(mean_of(img, ""), >, 0.0);
    g_assert_cmpfloat(fabs(mean_of(img, "specular") / mean_of(img, "") - 1), <, 1e-5);
}

/* The sky behind a ball of fog is as bright as the fog lets it: a path that is scattered
   has seen it as well as one that comes through, which a pixel's four samples often do
   not. */
static void test_lights_in_sight(gconstpointer data)
{
    const method *m = data;
    g_autoptr(view) v = view_of(FOG("f", ".2", ".8", "0") EYE("", "0 -4 .3  0 0 .3")
                                    BETWEEN("", "") SKY BETWEEN("f", "") BALL("1"));
    g_autoptr(image) img = render_with(v, m->words);
    const double through = exp(-2 * sqrt(1 - 0.3 * 0.3));
    for (size_t i = 0; i < pixels_of(img); i++) {
        double seen = (double)at(img, i, channel_of(img, "emission.G"));
        g_assert_cmpfloat(fabs(seen / through - 1), <, 0.1);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/fog/twin", test_twin);
    add_views("absorbs", absorbing, G_N_ELEMENTS(absorbing), 0.005, ways,
              G_N_ELEMENTS(ways));
    add_views("scatters", scattering, G_N_ELEMENTS(scattering), 0.015, ways,
              G_N_ELEMENTS(ways));
    add_views("furnace", furnaces, G_N_ELEMENTS(furnaces), 0.01, ways,
              G_N_ELEMENTS(ways));
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autofree char *name = g_strdup_printf("/fog/colour/%s", ways[i].name);
        g_test_add_data_func(name, &ways[i], test_colour);
    }
    static const method layered[] = {
        {"path", "integrator=path spp=4 passes=1", 0},
        {"photonmap", "integrator=photonmap spp=4 passes=1 photons=4000", 0}};
    for (size_t i = 0; i < G_N_ELEMENTS(layered); i++) {
        g_autofree char *name = g_strdup_printf("/fog/layer/%s", layered[i].name);
        g_test_add_data_func(name, &layered[i], test_layer);
        g_autofree char *sight =
            g_strdup_printf("/fog/lights-in-sight/%s", layered[i].name);
        g_test_add_data_func(sight, &layered[i], test_lights_in_sight);
    }
    g_test_add_func("/fog/beam-is-found", test_beam_is_found);
    return g_test_run();
}
