/*
 * color: white is white, RGB survives the way through a spectrum and back, and the
 * measured figures give the published numbers.
 */
#include "color/curve.h"
#include "color/curve_make.h"
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
    for (int k = 0; k < 3; k++) {
        float ratio = o->folded[k][100] / o->xyz[k][100];
        g_assert_cmpfloat(fabsf(ratio - 1.0f), <, 1e-3f);
        for (int i = 0; i < GRID_N; i++) {
            bool inside = i >= 20 && i <= 360;
            float expected = inside ? ratio * o->xyz[k][i] : 0.0f;
            g_assert_cmpfloat(fabsf(o->folded[k][i] - expected), <, 1e-5f);
        }
    }
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
            for (int i = 0; i < N_WAVELENGTHS; i++) {
                float u = (w.lambda[i] - LAMBDA_MIN) / (LAMBDA_MAX - LAMBDA_MIN);
                g_assert_true(u >= 0.0f && u < 1.0f && (int)(u * 8.0f) == i);
                hit[(int)(u * 128.0f)]++;
            }
        }
        for (int i = 0; i < 8 * 16; i++)
            g_assert_cmpint(hit[i], ==, 1);
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

/* Colour of the curve under the light by summing the whole observer, 360..830 nm. */
static void whole_rgb(const color_space *space, const curve *c, const curve *light,
                      float rgb[3])
{
    const observer *o = observer_get();
    double xyz[3] = {0};
    for (int i = 0; i < GRID_N; i++) {
        float nm = (float)(GRID_FIRST + i),
              radiance = curve_at(light, nm) * curve_at(c, nm);
        for (int k = 0; k < 3; k++)
            xyz[k] += (double)(o->xyz[k][i] * radiance);
    }
    for (int k = 0; k < 3; k++)
        rgb[k] = (float)xyz[k] / curve_photometric(light);
    color_space_from_xyz(space, rgb, rgb);
}

/* How a triple is turned into a spectrum and back. */
typedef enum way { BY_CURVE, BY_TABLE, BY_WHOLE_OBSERVER } way;

static double round_trip(const color_space *space, const curve *light, const float rgb[3],
                         way how)
{
    enum { PASSES = 32 };
    float smooth[3], back[3] = {0};
    g_autoptr(curve) c = curve_rgb(space, rgb, CURVE_ALBEDO, NULL);
    smooth_from_rgb(space, rgb, smooth);
    for (uint32_t pass = 0; pass < PASSES; pass++) {
        wavelengths w = wavelengths_for_pass(7, pass);
        spectrum lamp = curve_eval(light, &w) / curve_photometric(light);
        float xyz[3];
        spectrum s = how == BY_TABLE ? smooth_eval(smooth, &w) : curve_eval(c, &w);
        spectrum_to_xyz(&w, lamp * s, xyz);
        for (int k = 0; k < 3; k++)
            back[k] += xyz[k] / PASSES;
    }
    color_space_from_xyz(space, back, back);
    if (how == BY_WHOLE_OBSERVER)
        whole_rgb(space, c, light, back);
    double error = 0.0;
    for (int k = 0; k < 3; k++)
        error = fmax(error, (double)fabsf(back[k] - rgb[k]));
    return error;
}

/* Largest error over the 9³ colours of sRGB times scale, given in another space. */
static double worst_round_trip(const char *name, float scale, way how)
{
    enum { N = 9 };
    const color_space *space = color_space_find(name);
    g_autoptr(curve) light = light_of(name);
    double worst = 0.0;
    for (int i = 0; i < N * N * N; i++) {
        float rgb[3] = {scale * (float)(i % N) / (float)(N - 1),
                        scale * (float)(i / N % N) / (float)(N - 1),
                        scale * (float)(i / N / N) / (float)(N - 1)};
        if (space != color_space_srgb()) {
            color_space_to_xyz(color_space_srgb(), rgb, rgb);
            color_space_from_xyz(space, rgb, rgb);
            for (int k = 0; k < 3; k++)
                rgb[k] = fminf(fmaxf(rgb[k], 0.0f), 1.0f);
        }
        worst = fmax(worst, round_trip(space, light, rgb, how));
    }
    return worst;
}

static void test_rgb_survives_a_spectrum(void)
{
    /* constants are solved, up to what 256 wavelengths can tell */
    g_assert_cmpfloat(worst_round_trip("srgb", 1.0f, BY_CURVE), <, 1e-4);
    g_assert_cmpfloat(worst_round_trip("srgb", 0.01f, BY_CURVE), <, 5e-5);
    g_assert_cmpfloat(worst_round_trip("rec2020", 1.0f, BY_CURVE), <, 1e-4);
    g_assert_cmpfloat(worst_round_trip("dci-p3", 1.0f, BY_CURVE), <, 1e-4);
    g_assert_cmpfloat(worst_round_trip("aces2065-1", 0.8f, BY_CURVE), <, 5e-4);
    /* beyond 380..720 nm lies less than a thousandth of the eye's response */
    g_assert_cmpfloat(worst_round_trip("srgb", 1.0f, BY_WHOLE_OBSERVER), <, 1e-3);
    /* texels are looked up */
    g_assert_cmpfloat(worst_round_trip("srgb", 1.0f, BY_TABLE), <, 5e-3);
    g_assert_cmpfloat(worst_round_trip("srgb", 0.01f, BY_TABLE), <, 6e-4);
    g_assert_cmpfloat(worst_round_trip("rec2020", 1.0f, BY_TABLE), <, 8e-3);
    g_assert_cmpfloat(worst_round_trip("dci-p3", 1.0f, BY_TABLE), <, 5e-3);
    g_assert_cmpfloat(worst_round_trip("aces2065-1", 0.8f, BY_TABLE), <, 3.5e-2);
}

static void test_grey_is_flat(void)
{
    const wavelengths w = wavelengths_at(0.3f);
    for (int i = 0; i <= 20; i++) {
        float value = (float)i / 20.0f, c[3], rgb[3] = {value, value, value};
        g_autoptr(curve) albedo = curve_rgb(color_space_srgb(), rgb, CURVE_ALBEDO, NULL);
        g_autoptr(curve) eta = curve_rgb(color_space_srgb(), rgb, CURVE_UNBOUNDED, NULL);
        smooth_from_rgb(color_space_srgb(), rgb, c);
        g_assert_true(curve_is_constant(albedo) && curve_is_constant(eta));
        spectrum s[3] = {curve_eval(albedo, &w), curve_eval(eta, &w), smooth_eval(c, &w)};
        for (int k = 0; k < 3; k++)
            for (int wavelength = 0; wavelength < N_WAVELENGTHS; wavelength++)
                g_assert_cmpfloat(fabsf(s[k][wavelength] - value), <, 2e-7f);
    }
}

static void test_rgb_roles(void)
{
    const color_space *srgb = color_space_srgb();
    const float rgb[3] = {3.0f, 0.5f, 0.25f};
    g_autoptr(curve) d65 = curve_named("stdillum-D65");
    g_autoptr(curve) eta = curve_rgb(srgb, rgb, CURVE_UNBOUNDED, NULL);
    g_autoptr(curve) lamp = curve_rgb(srgb, rgb, CURVE_EMISSION, NULL);
    g_autoptr(curve) one = curve_constant(1.0f / curve_photometric(lamp));
    g_assert_cmpfloat(fabsf(curve_photometric(lamp) - 106.857f), <, 1e-3f);
    g_assert_false(curve_is_constant(lamp));
    double seen[2][3], xyz[3];
    average_rgb(srgb, eta, d65, 64, seen[0]);
    average_xyz(lamp, NULL, 64, xyz);
    float f[3] = {(float)xyz[0], (float)xyz[1], (float)xyz[2]};
    color_space_from_xyz(srgb, f, f);
    for (int k = 0; k < 3; k++) {
        g_assert_cmpfloat(fabs(seen[0][k] - (double)rgb[k]), <, 3e-4);
        g_assert_cmpfloat(fabsf(f[k] * curve_at(one, 550.0f) - rgb[k]), <, 3e-4f);
    }
}

static void refuse_rgb(float r, float g, float b, curve_role role)
{
    g_autoptr(GError) error = NULL;
    g_assert_null(curve_rgb(color_space_srgb(), (float[3]){r, g, b}, role, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
}

static void test_refusals(void)
{
    refuse_rgb(-0.1f, 0.5f, 0.5f, CURVE_ALBEDO);
    refuse_rgb(0.5f, 1.1f, 0.5f, CURVE_ALBEDO);
    refuse_rgb(0.5f, 0.5f, NAN, CURVE_ALBEDO);
    refuse_rgb(0.5f, 0.5f, INFINITY, CURVE_EMISSION);
    refuse_rgb(0.5f, -1.0f, 0.5f, CURVE_UNBOUNDED);
    g_autoptr(curve) rounded =
        curve_rgb(color_space_srgb(), (float[3]){1.00005f, 1, 1}, CURVE_ALBEDO, NULL);
    g_assert_cmpfloat(curve_at(rounded, 550.0f), <=, 1.0f);
    g_assert_null(curve_tabulated((float[]){500, 400}, (float[]){1, 1}, 2, NULL));
    g_assert_null(curve_tabulated((float[]){400, 400}, (float[]){1, 1}, 2, NULL));
    g_assert_null(curve_tabulated((float[]){400, NAN}, (float[]){1, 1}, 2, NULL));
    g_assert_null(curve_tabulated((float[]){400, 500}, (float[]){1, INFINITY}, 2, NULL));
    g_assert_null(curve_tabulated((float[]){400}, (float[]){1}, 0, NULL));
    g_assert_null(curve_blackbody(0.0f));
    g_assert_null(curve_blackbody(NAN));
    g_assert_null(curve_sellmeier_terms((double[]){1}, (double[]){0.25}, 1));
    g_assert_null(curve_named("metal-Unobtainium-eta"));
    g_assert_null(curve_named(""));
}

/* Error of one colour, relative, by one pass or the mean of two neighbouring ones. */
static void colour_errors(int passes, double *average, double *worst)
{
    enum { OFFSETS = 64 };
    static const char *const paints[3] = {"cornell-white", "cornell-red",
                                          "cornell-green"};
    g_autoptr(curve) light = curve_named("stdillum-D65");
    *average = *worst = 0.0;
    for (int i = 0; i < 3; i++) {
        g_autoptr(curve) paint = curve_named(paints[i]);
        double truth[3];
        average_xyz(paint, light, 256, truth);
        for (int j = 0; j < OFFSETS; j++) {
            double xyz[3] = {0}, error = 0.0;
            for (int pass = 0; pass < passes; pass++) {
                float u = (float)j / OFFSETS + (float)pass / (float)passes, one[3];
                wavelengths w = wavelengths_at(u - floorf(u));
                spectrum lamp = curve_eval(light, &w) / curve_photometric(light);
                spectrum_to_xyz(&w, lamp * curve_eval(paint, &w), one);
                for (int k = 0; k < 3; k++)
                    xyz[k] += (double)one[k] / passes;
            }
            for (int k = 0; k < 3; k++)
                error = fmax(error, fabs(xyz[k] / truth[k] - 1.0));
            *average += error / (3 * OFFSETS);
            *worst = fmax(*worst, error);
        }
    }
}

static void test_one_pass_is_nearly_right(void)
{
    double average, worst;
    colour_errors(1, &average, &worst);
    g_assert_cmpfloat(average, <, 0.035);
    g_assert_cmpfloat(worst, <, 0.07);
    colour_errors(2, &average, &worst);
    g_assert_cmpfloat(average, <, 0.01);
    g_assert_cmpfloat(worst, <, 0.02);
}

static void test_odd_texels_stay_finite(void)
{
    const float odd[] = {-1, 0, 1e-30f, 1e-7f, 1e-4f, 0.5f, 1, 1.5f, INFINITY, NAN};
    const int n = G_N_ELEMENTS(odd);
    const wavelengths w = wavelengths_at(0.5f);
    for (int i = 0; i < n * n * n * N_COLOR_SPACES; i++) {
        const float rgb[3] = {odd[i % n], odd[i / n % n], odd[i / n / n % n]};
        float c[3];
        smooth_from_rgb(color_space_at(i / n / n / n), rgb, c);
        spectrum s = smooth_eval(c, &w);
        for (int k = 0; k < N_WAVELENGTHS; k++)
            g_assert_true(s[k] >= 0.0f && s[k] <= 1.0f);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/color/observer/integrals", test_observer_integrals);
    g_test_add_func("/color/observer/folding", test_folding_is_slight);
    g_test_add_func("/color/white", test_white_is_exact);
    g_test_add_func("/color/wavelengths/stratified", test_wavelengths_are_stratified);
    g_test_add_func("/color/space/matrix", test_srgb_matrix_is_the_published_one);
    g_test_add_func("/color/rgb/round-trip", test_rgb_survives_a_spectrum);
    g_test_add_func("/color/rgb/grey", test_grey_is_flat);
    g_test_add_func("/color/rgb/roles", test_rgb_roles);
    g_test_add_func("/color/rgb/texels", test_odd_texels_stay_finite);
    g_test_add_func("/color/refusals", test_refusals);
    g_test_add_func("/color/one-pass", test_one_pass_is_nearly_right);
    return g_test_run();
}
