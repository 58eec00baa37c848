/*
 * color: white is white, RGB survives the way through a spectrum and back, and the
 * measured figures give the published numbers.
 */
#include "color/curve.h"
#include "color/grid.h"
#include "color/observer.h"
#include "color/space.h"

#include <string.h>

static const char *const space_names[] = {"srgb", "rec2020", "dci-p3", "aces2065-1"};

/* XYZ of c averaged over n equidistant offsets of the eight wavelengths. */
static void average_xyz(const curve *c, const curve *light, int n, double xyz[3])
{
    xyz[0] = xyz[1] = xyz[2] = 0.0;
    for (int i = 0; i < n; i++) {
        wavelengths w = wavelengths_at(((float)i + 0.5f) / (float)n);
        spectrum s = curve_eval(c, &w);
        if (light)
            s *= curve_eval(light, &w) / curve_photometric(light);
        float one[3];
        spectrum_to_xyz(&w, s, one);
        for (int k = 0; k < 3; k++)
            xyz[k] += (double)one[k] / n;
    }
}

static void average_rgb(const color_space *space, const curve *c, const curve *light,
                        int n, double rgb[3])
{
    double xyz[3];
    average_xyz(c, light, n, xyz);
    float f[3] = {(float)xyz[0], (float)xyz[1], (float)xyz[2]};
    color_space_from_xyz(space, f, f);
    for (int k = 0; k < 3; k++)
        rgb[k] = (double)f[k];
}

static curve *light_of(const char *space)
{
    return curve_named(strcmp(space, "aces2065-1") == 0 ? "illum-acesD60"
                                                        : "stdillum-D65");
}

static void test_observer_integrals(void)
{
    const observer *o = observer_get();
    double sum[3] = {0};
    for (int i = 0; i < GRID_N; i++)
        for (int k = 0; k < 3; k++)
            sum[k] += (double)o->xyz[k][i];
    /* CIE 018:2019 by 1 nm: 106.865, 106.857, 106.892 */
    g_assert_cmpfloat(fabs(sum[0] - 106.865), <, 0.005);
    g_assert_cmpfloat(fabs(sum[1] - 106.857), <, 0.001);
    g_assert_cmpfloat(fabs(sum[2] - 106.892), <, 0.005);
    double xyz[3];
    for (int k = 0; k < 3; k++)
        xyz[k] = grid_integrate(o->xyz[k], o->d65, GRID_FIRST, GRID_LAST);
    g_assert_cmpfloat(fabs(xyz[0] / (xyz[0] + xyz[1] + xyz[2]) - 0.3127), <, 5e-5);
    g_assert_cmpfloat(fabs(xyz[1] / (xyz[0] + xyz[1] + xyz[2]) - 0.3290), <, 5e-5);
}

/* The observer that photons meet differs from the whole one by its tails only. */
static void test_folding_is_slight(void)
{
    const observer *o = observer_get();
    for (int k = 0; k < 3; k++)
        for (int i = 50; i < 300; i++)
            g_assert_cmpfloat(fabsf(o->folded[k][i] * 1.0f -
                                    o->xyz[k][i] * o->folded[k][100] / o->xyz[k][100]),
                              <, 1e-5f);
    for (int k = 0; k < 3; k++)
        g_assert_cmpfloat(fabsf(o->folded[k][100] / o->xyz[k][100] - 1.0f), <, 2e-3f);
}

static void test_white_is_exact(void)
{
    for (int i = 0; i < N_COLOR_SPACES; i++) {
        const color_space *space = color_space_find(space_names[i]);
        g_autoptr(curve) one = curve_constant(1.0f);
        g_autoptr(curve) light = light_of(space_names[i]);
        double rgb[3];
        average_rgb(space, one, light, 64, rgb);
        for (int k = 0; k < 3; k++)
            g_assert_cmpfloat(fabs(rgb[k] - 1.0), <, i == 3 ? 2e-4 : 1e-5);
    }
    g_autoptr(curve) one = curve_constant(1.0f), d65 = curve_named("stdillum-D65");
    double xyz[3];
    average_xyz(one, d65, 64, xyz);
    g_assert_cmpfloat(fabs(xyz[0] - 0.3127 / 0.3290), <, 1e-5);
    g_assert_cmpfloat(fabs(xyz[1] - 1.0), <, 1e-5);
    g_assert_cmpfloat(fabs(xyz[2] - 0.3583 / 0.3290), <, 1e-5);
}

static void test_wavelengths_are_stratified(void)
{
    for (uint64_t seed = 0; seed < 20; seed++) {
        unsigned char hit[8 * 16] = {0};
        for (uint32_t pass = 0; pass < 16; pass++) {
            wavelengths w = wavelengths_for_pass(seed, pass);
            for (int i = 0; i < N_LANES; i++) {
                float u = (w.lambda[i] - LAMBDA_MIN) / (LAMBDA_MAX - LAMBDA_MIN);
                g_assert_true(u >= 0.0f && u < 1.0f && (int)(u * 8.0f) == i);
                hit[(int)(u * 128.0f)]++;
            }
        }
        for (int i = 0; i < 8 * 16; i++)
            g_assert_cmpint(abs(hit[i] - 1), <=, 1);
    }
    wavelengths a = wavelengths_for_pass(1, 0), b = wavelengths_for_pass(2, 0);
    g_assert_cmpfloat(fabsf(a.lambda[0] - b.lambda[0]), >, 0.01f);
}

static void test_srgb_matrix_is_the_published_one(void)
{
    /* IEC 61966-2-1, amendment 1 */
    const double published[3][3] = {{3.2406255, -1.5372080, -0.4986286},
                                    {-0.9689307, 1.8757561, 0.0415175},
                                    {0.0557101, -0.2040211, 1.0569959}};
    const color_space *srgb = color_space_srgb();
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            g_assert_cmpfloat(fabs(srgb->from_xyz.m[i][j] - published[i][j]), <, 5e-4);
    for (int i = 0; i < N_COLOR_SPACES; i++) {
        const color_space *space = color_space_find(space_names[i]);
        float v[3] = {0.1f, 0.7f, 0.4f};
        color_space_to_xyz(space, v, v);
        color_space_from_xyz(space, v, v);
        g_assert_cmpfloat(fabsf(v[0] - 0.1f) + fabsf(v[1] - 0.7f) + fabsf(v[2] - 0.4f), <,
                          2e-6f);
    }
    g_assert_null(color_space_find("adobe"));
}

/* Largest round-trip error over a grid of n³ triples times scale. */
static double worst_round_trip(const char *name, int n, float scale, bool texels)
{
    const color_space *space = color_space_find(name);
    g_autoptr(curve) light = light_of(name);
    double worst = 0.0;
    wavelengths w[32];
    spectrum lamp[32];
    for (int i = 0; i < 32; i++) {
        w[i] = wavelengths_at(((float)i + 0.5f) / 32.0f);
        lamp[i] = curve_eval(light, &w[i]) / curve_photometric(light);
    }
    for (int i = 0; i < n * n * n; i++) {
        float rgb[3] = {scale * (float)(i % n) / (float)(n - 1),
                        scale * (float)(i / n % n) / (float)(n - 1),
                        scale * (float)(i / n / n) / (float)(n - 1)};
        float smooth[3], sum[3] = {0};
        g_autoptr(curve) c = curve_rgb(space, rgb, CURVE_ALBEDO, NULL);
        smooth_from_rgb(space, rgb, smooth);
        for (int j = 0; j < 32; j++) {
            float xyz[3];
            spectrum r = texels ? smooth_eval(smooth, &w[j]) : curve_eval(c, &w[j]);
            spectrum_to_xyz(&w[j], lamp[j] * r, xyz);
            for (int k = 0; k < 3; k++)
                sum[k] += xyz[k] / 32.0f;
        }
        color_space_from_xyz(space, sum, sum);
        for (int k = 0; k < 3; k++)
            worst = fmax(worst, (double)fabsf(sum[k] - rgb[k]));
    }
    return worst;
}

static void test_rgb_round_trip(void)
{
    g_assert_cmpfloat(worst_round_trip("srgb", 9, 1.0f, false), <, 5e-4);
    g_assert_cmpfloat(worst_round_trip("srgb", 9, 0.1f, false), <, 1e-4);
    g_assert_cmpfloat(worst_round_trip("srgb", 9, 0.01f, false), <, 5e-5);
    g_assert_cmpfloat(worst_round_trip("dci-p3", 9, 0.1f, false), <, 1e-4);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/color/observer/integrals", test_observer_integrals);
    g_test_add_func("/color/observer/folding", test_folding_is_slight);
    g_test_add_func("/color/white", test_white_is_exact);
    g_test_add_func("/color/wavelengths/stratified", test_wavelengths_are_stratified);
    g_test_add_func("/color/space/matrix", test_srgb_matrix_is_the_published_one);
    g_test_add_func("/color/rgb/round-trip", test_rgb_round_trip);
    return g_test_run();
}
