/*
 * spectra: tables, formulas and names give the functions and the published numbers they
 * stand for.
 */
#include "color/curve.h"
#include "color/curve_make.h"
#include "color/grid.h"
#include "color/observer.h"

#include <stdlib.h>
#include <string.h>

static void test_tables(void)
{
    const float nm[4] = {400.5f, 450.25f, 500.0f, 700.0f}, v[4] = {1, 3, 2, 0.5f};
    g_autoptr(curve) odd = curve_tabulated(nm, v, 4, NULL);
    g_assert_cmpfloat(curve_at(odd, 400.4f), <=, 0.0f);
    g_assert_cmpfloat(curve_at(odd, 700.1f), <=, 0.0f);
    g_assert_cmpfloat(fabsf(curve_at(odd, 425.375f) - 2.0f), <, 1e-5f);
    g_assert_cmpfloat(fabsf(curve_at(odd, 600.0f) - 1.25f), <, 1e-5f);
    g_autoptr(curve) flat =
        curve_tabulated((float[]){200, 900}, (float[]){0.5f, 0.5f}, 2, NULL);
    g_autoptr(curve) part =
        curve_tabulated((float[]){400, 900}, (float[]){0.5f, 0.5f}, 2, NULL);
    g_assert_true(curve_is_constant(flat) && !curve_is_constant(part));
    wavelengths w = wavelengths_at(0.77f);
    spectrum s = curve_eval(odd, &w);
    for (int i = 0; i < N_WAVELENGTHS; i++)
        g_assert_cmpfloat(fabsf(s[i] - curve_at(odd, w.lambda[i])), <, 1e-6f);
    /* a line narrower than a nanometre keeps its area */
    const observer *o = observer_get();
    g_autoptr(curve) line = curve_tabulated((float[]){589.1f, 589.35f, 589.6f},
                                            (float[]){0, 100, 0}, 3, NULL);
    float area = 25.0f * grid_at(o->xyz[1], 589.35f);
    g_assert_cmpfloat(fabsf(curve_photometric(line) / area - 1.0f), <, 1e-4f);
}

/* Whole-nanometre tables are resampled, others bisected: both are the same function. */
static void test_tables_agree(void)
{
    enum { N = 110 };
    float nm[N], shifted[N], v[N];
    for (int i = 0; i < N; i++) {
        nm[i] = 340.0f + 5.0f * (float)i;
        shifted[i] = nm[i] + 0.25f;
        v[i] = 1.0f + sinf((float)(i * i));
    }
    g_autoptr(curve) grid = curve_tabulated(nm, v, N, NULL);
    g_autoptr(curve) table = curve_tabulated(shifted, v, N, NULL);
    for (float x = LAMBDA_MIN; x < LAMBDA_MAX; x += 0.37f)
        g_assert_cmpfloat(fabsf(curve_at(grid, x) - curve_at(table, x + 0.25f)), <,
                          1e-4f);
}

static void test_formulas(void)
{
    static const struct {
        const char *name;
        double n_d, abbe;
    } published[] = {{"glass-BK7", 1.5168, 64.17},     {"glass-N-SF11", 1.78472, 25.68},
                     {"glass-BAF10", 1.67003, 47.11},  {"glass-FK51A", 1.48656, 84.47},
                     {"glass-N-LAK8", 1.713, 53.83},   {"glass-N-SF6", 1.80518, 25.36},
                     {"glass-N-SF66", 1.92286, 20.88}, {"glass-LASF9", 1.85025, 32.17},
                     {"glass-F5", 1.67271, 32.25},     {"glass-F10", 1.72828, 28.53},
                     {"glass-F11", 1.78472, 25.68},    {"metal-MgO-eta", 1.7376, 53.6},
                     {"glass-SiO2", 1.45846, 67.82},   {"glass-water", 1.33336, 55.7},
                     {"glass-diamond", 2.4175, 55.3}};
    for (size_t i = 0; i < G_N_ELEMENTS(published); i++) {
        g_autoptr(curve) glass = curve_named(published[i].name);
        double d = (double)curve_at(glass, 587.5618f);
        double f = (double)curve_at(glass, 486.1327f);
        double c = (double)curve_at(glass, 656.2725f);
        g_assert_cmpfloat(fabs(d - published[i].n_d), <, i < 11 ? 1e-5 : 5e-4);
        g_assert_cmpfloat(fabs((d - 1.0) / (f - c) / published[i].abbe - 1.0), <, 0.02);
    }
    g_autoptr(curve) sellmeier =
        curve_sellmeier_terms((double[]){1.25}, (double[]){0}, 1);
    g_assert_true(curve_is_constant(sellmeier));
    g_assert_cmpfloat(fabsf(curve_at(sellmeier, 500.0f) - 1.5f), <, 1e-6f);
}

static void test_planck(void)
{
    for (float kelvin = 4100.0f; kelvin < 7600.0f; kelvin += 500.0f) {
        g_autoptr(curve) c = curve_blackbody(kelvin);
        float peak = 2.897772e6f / kelvin; /* Wien */
        g_assert_cmpfloat(fabsf(curve_at(c, peak) - 1.0f), <, 1e-5f);
        g_assert_cmpfloat(curve_at(c, peak - 15.0f), <, 1.0f);
        g_assert_cmpfloat(curve_at(c, peak + 15.0f), <, 1.0f);
    }
    /* two wavelengths of the law itself, at a temperature whose peak is infrared */
    g_autoptr(curve) warm = curve_blackbody(1000.0f);
    double ratio =
        pow(700.0 / 500.0, 5) * expm1(14387768.775 / 7e5) / expm1(14387768.775 / 5e5);
    g_assert_cmpfloat(
        fabs((double)(curve_at(warm, 500.0f) / curve_at(warm, 700.0f)) / ratio - 1.0), <,
        1e-5);
    g_autoptr(curve) cold = curve_blackbody(1.0f);
    g_assert_cmpfloat(curve_photometric(cold), <=, 0.0f);
}

static void test_every_name_is_a_curve(void)
{
    g_autoptr(GHashTable) seen = g_hash_table_new(g_str_hash, g_str_equal);
    int n = 0;
    for (const char *const *name = curve_names(); *name; name++, n++) {
        g_autoptr(curve) c = curve_named(*name);
        g_assert_nonnull(c);
        g_assert_true(g_hash_table_add(seen, (char *)*name));
        for (float nm = 360.0f; nm <= 830.0f; nm += 1.0f)
            g_assert_true(curve_at(c, nm) >= 0.0f && curve_at(c, nm) < 200.0f);
        bool clear = g_str_has_suffix(*name, "O-k") || g_str_has_suffix(*name, "O2-k");
        g_assert_true(clear || curve_photometric(c) > 0.5f);
    }
    g_assert_cmpint(n, >=, 60);
}

static void test_illuminants_have_their_chromaticity(void)
{
    /* CIE 15:2004, tables T.3 and T.8, where the lamps have four digits */
    static const struct {
        const char *name;
        double x, y, tolerance;
    } published[] = {
        {"A", 0.44758, 0.40745, 5e-5},   {"D50", 0.34567, 0.35851, 5e-5},
        {"D65", 0.31272, 0.32903, 5e-5}, {"F1", 0.3131, 0.3371, 1e-4},
        {"F2", 0.3721, 0.3751, 1e-4},    {"F3", 0.4091, 0.3941, 1e-4},
        {"F4", 0.4402, 0.4031, 1e-4},    {"F5", 0.3138, 0.3452, 1e-4},
        {"F6", 0.3779, 0.3882, 1e-4},    {"F7", 0.3129, 0.3292, 1e-4},
        {"F8", 0.3458, 0.3586, 1e-4},    {"F9", 0.3741, 0.3727, 1e-4},
        {"F10", 0.3458, 0.3588, 4e-4},   {"F11", 0.3805, 0.3769, 1e-4},
        {"F12", 0.4370, 0.4042, 1e-4},
    };
    const observer *o = observer_get();
    for (size_t i = 0; i < G_N_ELEMENTS(published); i++) {
        g_autofree char *name = g_strconcat("stdillum-", published[i].name, NULL);
        g_autoptr(curve) c = curve_named(name);
        double xyz[3] = {0};
        for (int nm = GRID_FIRST; nm <= GRID_LAST; nm += 5)
            for (int k = 0; k < 3; k++)
                xyz[k] += (double)(o->xyz[k][nm - GRID_FIRST] * curve_at(c, (float)nm));
        double sum = xyz[0] + xyz[1] + xyz[2];
        g_assert_cmpfloat(fabs(xyz[0] / sum - published[i].x), <, published[i].tolerance);
        g_assert_cmpfloat(fabs(xyz[1] / sum - published[i].y), <, published[i].tolerance);
        g_assert_cmpfloat(fabsf(curve_photometric(c) - 106.857f), <, 1e-3f);
    }
}

/* The figures as refractiveindex.info gives them, one "µm n k" a line. */
static void check_metal(const char *symbol, const char *file)
{
    g_autofree char *path =
        g_strdup_printf("%s/../shared/data/nk/%s.yml", SOURCE_ROOT, file);
    g_autofree char *text = NULL;
    if (!g_file_get_contents(path, &text, NULL, NULL)) {
        g_test_skip("no measured data beside the sources");
        return;
    }
    g_autofree char *eta_name = g_strdup_printf("metal-%s-eta", symbol);
    g_autofree char *k_name = g_strdup_printf("metal-%s-k", symbol);
    g_autoptr(curve) eta = curve_named(eta_name), k = curve_named(k_name);
    g_auto(GStrv) lines = g_strsplit(text, "\n", -1);
    int n = 0;
    for (char **line = lines; *line; line++) {
        char *end = *line;
        double figures[3];
        for (int i = 0; i < 3; i++)
            figures[i] = g_ascii_strtod(end, &end);
        float nm = (float)(figures[0] * 1000.0);
        if (nm < 365.0f || nm > 825.0f || figures[1] <= 0.0 || figures[2] <= 0.0)
            continue;
        /* grid cells that hold a bend cut it by a little */
        g_assert_cmpfloat(fabs((double)curve_at(eta, nm) - figures[1]), <, 0.012);
        g_assert_cmpfloat(fabs((double)curve_at(k, nm) - figures[2]), <, 0.012);
        n++;
    }
    g_assert_cmpint(n, >=, 10);
}

static void test_metals_are_as_measured(void)
{
    check_metal("Ag", "Ag-Johnson-1972");
    check_metal("Al", "Al-Rakic-1995");
    check_metal("Au", "Au-Johnson-1972");
    check_metal("Cr", "Cr-Johnson-1974");
    check_metal("Cu", "Cu-Johnson-1972");
    check_metal("Fe", "Fe-Johnson-1974");
    check_metal("Ni", "Ni-Johnson-1974");
    check_metal("Pt", "Pt-Rakic");
    check_metal("Ti", "Ti-Johnson-1974");
}

/* Normal reflectance of a metal in air at one wavelength. */
static double reflectance(const char *symbol, float nm)
{
    g_autofree char *eta_name = g_strdup_printf("metal-%s-eta", symbol);
    g_autofree char *k_name = g_strdup_printf("metal-%s-k", symbol);
    g_autoptr(curve) eta = curve_named(eta_name), k = curve_named(k_name);
    double n = (double)curve_at(eta, nm), kk = (double)curve_at(k, nm);
    return ((n - 1) * (n - 1) + kk * kk) / ((n + 1) * (n + 1) + kk * kk);
}

static void test_metals_look_like_metals(void)
{
    g_assert_cmpfloat(reflectance("Ag", 550.0f), >, 0.95);
    g_assert_cmpfloat(reflectance("Al", 550.0f), >, 0.9);
    g_assert_cmpfloat(reflectance("Au", 650.0f), >, 2 * reflectance("Au", 450.0f));
    g_assert_cmpfloat(reflectance("Cu", 650.0f), >, 1.5 * reflectance("Cu", 500.0f));
    g_assert_cmpfloat(reflectance("CuZn", 650.0f), >, 1.3 * reflectance("CuZn", 450.0f));
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/spectra/table/values", test_tables);
    g_test_add_func("/spectra/table/agree", test_tables_agree);
    g_test_add_func("/spectra/formula/glass", test_formulas);
    g_test_add_func("/spectra/formula/planck", test_planck);
    g_test_add_func("/spectra/named/list", test_every_name_is_a_curve);
    g_test_add_func("/spectra/named/illuminants",
                    test_illuminants_have_their_chromaticity);
    g_test_add_func("/spectra/named/metals", test_metals_are_as_measured);
    g_test_add_func("/spectra/named/reflectance", test_metals_look_like_metals);
    return g_test_run();
}
