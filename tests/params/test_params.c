/*
 * params: typed access tells wrong types and counts at their place, and what nobody
 * asked for is found.
 */
#include "params/params.h"

#include <math.h>

static const source_place here = {"a.pbrt", 3, 7};

static params *sample(void)
{
    params *p = params_new((source_place){"a.pbrt", 1, 1}, "/base", NULL);
    params_add_numbers(p, here, PARAM_FLOAT, "radius", (float[]){2.5f}, 1, NULL);
    params_add_numbers(p, here, PARAM_FLOAT, "bad", (float[]){NAN}, 1, NULL);
    params_add_numbers(p, here, PARAM_POINT3, "from", (float[]){1, 2, 3}, 3, NULL);
    params_add_integers(p, here, PARAM_INTEGER, "indices", (int[]){4, 5}, 2, NULL);
    params_add_integers(p, here, PARAM_INTEGER, "n", (int[]){-4}, 1, NULL);
    params_add_integers(p, here, PARAM_BOOL, "twosided", (int[]){1}, 1, NULL);
    const char *const file[] = {"x/../b.png"}, *const word[] = {"repeat"};
    params_add_strings(p, here, PARAM_STRING, "filename", file, 1, NULL);
    params_add_strings(p, here, PARAM_STRING, "wrap", word, 1, NULL);
    return p;
}

static void test_typed_access(void)
{
    g_autoptr(params) p = sample();
    float radius = 0.0f, absent = 9.0f;
    int n = 0, wrap = -1;
    bool twosided = false;
    vec3 from;
    const char *text = NULL;
    g_autofree char *path = NULL;
    const char *const words[] = {"black", "repeat", NULL};
    g_assert_true(
        params_float(p, "radius", &radius, NULL) &&
        params_float(p, "absent", &absent, NULL) && params_integer(p, "n", &n, NULL) &&
        params_bool(p, "twosided", &twosided, NULL) &&
        params_point3(p, "from", &from, NULL) && params_string(p, "wrap", &text, NULL) &&
        params_choice(p, "wrap", words, &wrap, NULL) &&
        params_path(p, "filename", &path, NULL));
    g_assert_cmpfloat(radius, ==, 2.5f);
    g_assert_cmpfloat(absent, ==, 9.0f);
    g_assert_cmpint(n, ==, -4);
    g_assert_true(twosided);
    g_assert_cmpfloat(from[1], ==, 2.0f);
    g_assert_cmpstr(text, ==, "repeat");
    g_assert_cmpint(wrap, ==, 1);
    g_assert_cmpstr(path, ==, "/base/b.png");
}

static void expect(bool result, GError *error, const char *message)
{
    g_assert_false(result);
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_cmpstr(error->message, ==, message);
    g_error_free(error);
}

static void test_wrong_type_count_and_value(void)
{
    g_autoptr(params) p = sample();
    GError *error = NULL;
    float x;
    int i;
    bool result = params_float(p, "n", &x, &error);
    expect(result, error, "a.pbrt:3:7: parameter 'n': expected float, found integer");
    error = NULL;
    result = params_float(p, "bad", &x, &error);
    expect(result, error,
           "a.pbrt:3:7: parameter 'bad': expected finite numbers, found nan");
    error = NULL;
    result = params_integer(p, "indices", &i, &error);
    expect(result, error, "a.pbrt:3:7: parameter 'indices': expected 1 value, found 2");
    error = NULL;
    result = params_choice(p, "wrap", (const char *const[]){"black", "clamp", NULL}, &i,
                           &error);
    expect(result, error,
           "a.pbrt:3:7: parameter 'wrap': expected one of black, clamp, found 'repeat'");
}

static void test_a_name_comes_once(void)
{
    g_autoptr(params) p = sample();
    GError *error = NULL;
    bool result = params_add_integers(p, (source_place){"a.pbrt", 4, 1}, PARAM_INTEGER,
                                      "n", (int[]){1}, 1, &error);
    expect(result, error, "a.pbrt:4:1: expected each parameter once, found 'n' again");
}

static void test_unasked_is_found(void)
{
    g_autoptr(params) p = params_new(here, "/", NULL);
    params_add_integers(p, here, PARAM_INTEGER, "n", (int[]){1}, 1, NULL);
    g_assert_true(params_has(p, "n"));
    GError *error = NULL;
    bool result = params_all_used(p, "shape 'sphere'", &error);
    expect(result, error, "a.pbrt:3:7: unknown parameter 'n' of shape 'sphere'");
    g_assert_nonnull(params_find(p, "n"));
    g_assert_true(params_all_used(p, "shape 'sphere'", NULL));
}

static params *spectra(void)
{
    params *p = params_new(here, "/", color_space_srgb());
    params_add_numbers(p, here, PARAM_RGB, "rgb", (float[]){0.5f, 0.5f, 0.5f}, 3, NULL);
    params_add_numbers(p, here, PARAM_RGB, "over", (float[]){1.5f, 0.5f, 0.5f}, 3, NULL);
    params_add_numbers(p, here, PARAM_BLACKBODY, "hot", (float[]){5000.0f}, 1, NULL);
    params_add_numbers(p, here, PARAM_BLACKBODY, "cold", (float[]){0.0f}, 1, NULL);
    params_add_numbers(p, here, PARAM_SPECTRUM, "pairs", (float[]){400, 1, 600, 3}, 4,
                       NULL);
    params_add_numbers(p, here, PARAM_SPECTRUM, "odd", (float[]){400, 1, 600}, 3, NULL);
    params_add_numbers(p, here, PARAM_FLOAT, "eta", (float[]){1.5f}, 1, NULL);
    const char *const glass[] = {"glass-BK7"}, *const unknown[] = {"unobtainium"};
    params_add_strings(p, here, PARAM_SPECTRUM_NAME, "glass", glass, 1, NULL);
    params_add_strings(p, here, PARAM_SPECTRUM_NAME, "unknown", unknown, 1, NULL);
    return p;
}

static float at(const params *p, const char *name, curve_role role, float nm)
{
    g_autoptr(curve) c = NULL;
    g_autoptr(GError) error = NULL;
    g_assert_true(params_curve(p, name, role, &c, &error));
    g_assert_no_error(error);
    return c ? curve_at(c, nm) : -1.0f;
}

static void test_curves_by_role(void)
{
    g_autoptr(params) p = spectra();
    g_assert_cmpfloat(at(p, "absent", CURVE_ALBEDO, 500), ==, -1.0f);
    g_assert_true(fabsf(at(p, "rgb", CURVE_ALBEDO, 550) - 0.5f) < 1e-3f);
    g_assert_true(fabsf(at(p, "pairs", CURVE_ALBEDO, 500) - 2.0f) < 1e-6f);
    g_assert_true(fabsf(at(p, "eta", CURVE_UNBOUNDED, 500) - 1.5f) < 1e-6f);
    g_assert_true(fabsf(at(p, "glass", CURVE_UNBOUNDED, 587.6f) - 1.5168f) < 1e-3f);
    g_assert_true(fabsf(at(p, "hot", CURVE_EMISSION, 579.6f) - 1.0f) < 1e-3f);
}

static void curve_refuses(const char *name, curve_role role, const char *begin)
{
    g_autoptr(params) p = spectra();
    g_autoptr(curve) c = NULL;
    g_autoptr(GError) error = NULL;
    g_assert_false(params_curve(p, name, role, &c, &error));
    g_assert_null(c);
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    if (!g_str_has_prefix(error->message, begin))
        g_error("expected '%s', found '%s'", begin, error->message);
}

static void test_wrong_curves(void)
{
    curve_refuses("over", CURVE_ALBEDO, "a.pbrt:3:7: ");
    curve_refuses("cold", CURVE_EMISSION,
                  "a.pbrt:3:7: parameter 'cold': expected a temperature > 0 K, found 0");
    curve_refuses("odd", CURVE_ALBEDO,
                  "a.pbrt:3:7: parameter 'odd': expected pairs of wavelength and value, "
                  "found 3 numbers");
    curve_refuses("eta", CURVE_ALBEDO,
                  "a.pbrt:3:7: parameter 'eta': expected rgb, blackbody or spectrum, "
                  "found another type");
    curve_refuses("unknown", CURVE_UNBOUNDED,
                  "a.pbrt:3:7: parameter 'unknown': expected a spectrum's name or file, "
                  "found 'unobtainium'");
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/params/typed-access", test_typed_access);
    g_test_add_func("/params/wrong-type-count-and-value",
                    test_wrong_type_count_and_value);
    g_test_add_func("/params/a-name-comes-once", test_a_name_comes_once);
    g_test_add_func("/params/unasked-is-found", test_unasked_is_found);
    g_test_add_func("/params/curves-by-role", test_curves_by_role);
    g_test_add_func("/params/wrong-curves", test_wrong_curves);
    return g_test_run();
}
