/*
 * lines: lamps that shine at a few nanometres only give the light that their power says,
 * alone and beside others, in as few passes as others do; what is no line changes
 * nothing.
 */
#include "color/grid.h"
#include "color/observer.h"
#include "light/light_lines.h"
#include "render_with.h"

/* 532 nm is between two of the wavelengths of a pass, as are 589 nm. */
#define LASER "\"spectrum I\" [530.5 0 531.5 1 532.5 1 533.5 0]"
#define SODIUM "\"spectrum I\" [588.7 0 589 2 589.3 0 589.6 1 589.9 0]"
#define MERCURY                                                                          \
    "\"spectrum I\" [403 0 404.7 .4 406 0 434 0 435.8 1 437 0 545 0 546.1 1.6 547 0 "    \
    "576 "                                                                               \
    "0 578 .8 580 0]"

/* ---- Drawing wavelengths ---- */

static double smooth_at(float nm)
{
    return 1.0 + 0.5 * sin((double)nm / 30.0);
}

/* Y of a function by so many passes. */
static double by_passes(const wavelength_density *d, const curve *c, uint32_t passes)
{
    double sum = 0.0;
    for (uint32_t pass = 0; pass < passes; pass++) {
        wavelengths w = wavelengths_drawn(d, wavelength_offset(3, pass));
        spectrum s;
        float xyz[3];
        for (int i = 0; i < N_WAVELENGTHS; i++)
            s[i] = c ? curve_at(c, w.lambda[i]) : (float)smooth_at(w.lambda[i]);
        spectrum_to_xyz(&w, s, xyz);
        sum += (double)xyz[1] / passes;
    }
    return sum;
}

/* However wavelengths are drawn, the integral is the same; and that of a line, of which
   even ones know nothing for long, is known soon where its density is high. */
static void test_any_density_has_one_mean(void)
{
    static const float nm[3] = {588.0f, 589.0f, 590.0f}, values[3] = {0, 1, 0};
    g_autoptr(curve) line = curve_tabulated(nm, values, 3, NULL);
    double weights[WAVELENGTH_CELLS], smooth = by_passes(NULL, NULL, 4096);
    double true_line = 1.0 * (double)grid_at(observer_get()->folded[1], 589.0f);
    for (int i = 0; i < WAVELENGTH_CELLS; i++)
        weights[i] = i >= 832 && i < 840 ? 170.0 : 1.0 + (i % 7 == 0);
    wavelength_density d = wavelength_density_of(weights);
    g_assert_cmpfloat(fabs(by_passes(&d, NULL, 4096) / smooth - 1.0), <, 1e-3);
    g_assert_cmpfloat(fabs(by_passes(&d, line, 4096) / true_line - 1.0), <, 5e-3);
    g_assert_cmpfloat(fabs(by_passes(&d, line, 8) / true_line - 1.0), <, 0.15);
    g_assert_cmpfloat(fabs(by_passes(NULL, line, 8) / true_line - 1.0), >, 0.5);
}

static void test_drawn_wavelengths_ascend(void)
{
    double weights[WAVELENGTH_CELLS];
    for (int i = 0; i < WAVELENGTH_CELLS; i++)
        weights[i] = i == 0 || i == WAVELENGTH_CELLS - 1 ? 1e4 : 1.0;
    wavelength_density d = wavelength_density_of(weights);
    for (uint32_t pass = 0; pass < 64; pass++) {
        wavelengths w = wavelengths_drawn(&d, wavelength_offset(9, pass));
        g_assert_cmpfloat(w.lambda[0], >=, LAMBDA_MIN);
        g_assert_cmpfloat(w.lambda[N_WAVELENGTHS - 1], <=, LAMBDA_MAX);
        for (int i = 1; i < N_WAVELENGTHS; i++)
            g_assert_cmpfloat(w.lambda[i], >, w.lambda[i - 1]);
    }
    wavelengths even = wavelengths_drawn(NULL, 0.3f), at = wavelengths_at(0.3f);
    g_assert_cmpmem(&even, sizeof even, &at, sizeof at);
}

/* ---- Lamps ---- */

/* Two floors far apart, half grey, each a metre below a lamp of its own; two pixels look
   at one each. */
static view *two_floors(const char *left, const char *right)
{
    g_autofree char *text = g_strdup_printf(
        "Film \"rgb\" \"integer xresolution\" 2 \"integer yresolution\" 1\n"
        "PixelFilter \"box\" \"float xradius\" 0.001 \"float yradius\" 0.001\n"
        "Scale -1 1 1 LookAt 0 0 100  0 0 0  0 1 0\n"
        "Camera \"orthographic\" \"float screenwindow\" [-20 20 -10 10]\n"
        "WorldBegin\n"
        "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"
        "AttributeBegin Translate -10 0 0 Shape \"disk\" \"float radius\" 0.5 "
        "AttributeEnd\n"
        "AttributeBegin Translate 10 0 0 Shape \"disk\" \"float radius\" 0.5 "
        "AttributeEnd\n"
        "LightSource \"point\" \"point3 from\" [-10 0 1] %s\n"
        "LightSource \"point\" \"point3 from\" [10 0 1] %s\n",
        left, right);
    return view_of(text);
}

/* Both lamps have the intensity 1, so both floors look alike: ρ I / π d². */
static void check_floors(const char *left, const char *right, const char *how,
                         double allowed)
{
    g_autoptr(view) v = two_floors(left, right);
    g_autoptr(image) img = render_with(v, how);
    for (size_t i = 0; i < 2; i++) {
        double found = luminance_at(img, i) / (0.5 / G_PI) - 1.0;
        g_test_message("%s, pixel %d: %+.4f", how, (int)i, found);
        g_assert_cmpfloat(fabs(found), <, allowed);
    }
}

#define FEW "integrator=path passes=16 spp=16"

static void test_lines_light_as_their_power_says(void)
{
    check_floors(LASER, SODIUM, FEW, 0.1);
    check_floors(LASER, "\"blackbody I\" 5000", FEW, 0.1);
    check_floors(MERCURY, MERCURY, FEW, 0.1);
    check_floors(SODIUM, "\"rgb I\" [1 1 1]", "integrator=auto passes=16 spp=16", 0.1);
    check_floors(SODIUM, "\"rgb I\" [1 1 1]", "integrator=vcm passes=16 spp=16", 0.1);
}

/* What is smooth keeps its even wavelengths, be it the purest of colours. */
static void test_smooth_lamps_have_no_lines(void)
{
    static const char *const smooth[] = {"\"blackbody I\" 1500",
                                         "\"spectrum I\" \"stdillum-D65\"",
                                         "\"rgb I\" [1 0 0]",
                                         "\"rgb I\" [0 1 0]",
                                         "\"rgb I\" [0 0 1]",
                                         "\"rgb I\" [1 0 1]",
                                         "\"spectrum I\" \"stdillum-F1\""};
    for (size_t i = 0; i < G_N_ELEMENTS(smooth); i++) {
        g_autoptr(view) v = two_floors(smooth[i], "");
        g_test_message("%s", smooth[i]);
        g_assert_null(v->scene->lines);
    }
    g_autoptr(view) laser = two_floors(LASER, "");
    g_assert_nonnull(laser->scene->lines);
}

/* The caustic of a glass ball: photons are sent, though trials see few wavelengths. */
static void test_lines_cast_caustics(void)
{
    static const char text[] =
        "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 12\n"
        "LookAt 0 0 3  0 0 0  0 1 0\n"
        "Camera \"perspective\" \"float fov\" 10\n"
        "WorldBegin\n"
        "LightSource \"point\" \"point3 from\" [1 0 1] %s\n"
        "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"
        "Shape \"disk\" \"float radius\" 0.5\n"
        "Material \"dielectric\" \"float eta\" 1.5\n"
        "AttributeBegin Translate 0.1 0 0.1 Shape \"sphere\" \"float radius\" 0.05 "
        "\"bool camera_visible\" false AttributeEnd\n";
    double found[2];
    for (int i = 0; i < 2; i++) {
        g_autofree char *full = g_strdup_printf(text, i == 0 ? SODIUM : "");
        g_autoptr(view) v = view_of(full);
        g_autoptr(image) img = render_with(v, "integrator=auto passes=32 spp=16");
        found[i] = 0.0;
        for (size_t k = 0; k < pixels_of(img); k++)
            found[i] += 0.2126 * at(img, k, channel_of(img, "caustic.R")) +
                        0.7152 * at(img, k, channel_of(img, "caustic.G")) +
                        0.0722 * at(img, k, channel_of(img, "caustic.B"));
    }
    g_test_message("sodium %g, white %g", found[0], found[1]);
    g_assert_cmpfloat(found[1], >, 0.0);
    g_assert_cmpfloat(fabs(found[0] / found[1] - 1.0), <, 0.1);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/lines/drawn/mean", test_any_density_has_one_mean);
    g_test_add_func("/lines/drawn/order", test_drawn_wavelengths_ascend);
    g_test_add_func("/lines/power", test_lines_light_as_their_power_says);
    g_test_add_func("/lines/smooth", test_smooth_lamps_have_no_lines);
    g_test_add_func("/lines/caustics", test_lines_cast_caustics);
    return g_test_run();
}
