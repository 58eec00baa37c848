/*
 * Lengths that a file only claims: none is taken for true before so much can be there,
 * and memory that is not to be had is an error, not an end.
 */
#include "gltf_text.h"
#include "light/ies.h"

#include "base/memory.h"
#include "color/curve.h"

#define WORLD                                                                            \
    "Camera \"perspective\"\nWorldBegin\nLightSource \"point\"\nShape \"sphere\"\n"

static void test_profile(void)
{
    static const char *const cases[][2] = {
        {"TILT=NONE\n1 -1 1 4096 4096 1 1 0 0 0\n1 1 100\n0 90\n0\n",
         "expected 4096 numbers from a vertical angle on"},
        {"TILT=NONE\n1 -1 1 2 4096 1 1 0 0 0\n1 1 100\n0 90\n0\n",
         "expected 4096 numbers from a horizontal angle on"}};
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        ies_profile ies;
        g_autoptr(GError) error = NULL;
        g_assert_false(ies_read(&ies, cases[i][0], &error));
        if (!strstr(error->message, cases[i][1]))
            g_error("%s", error->message);
    }
}

static char *pairs(unsigned n)
{
    GString *text = g_string_new(NULL);
    for (unsigned i = 0; i < n; i++)
        g_string_append_printf(text, "%g 1\n", 300.0 + 0.005 * i);
    return g_string_free(text, FALSE);
}

static void load_spectrum(unsigned n, bool from_file, GError **error)
{
    g_autofree char *numbers = pairs(n);
    g_autofree char *text =
        from_file
            ? g_strdup(WORLD "Material \"diffuse\" \"spectrum reflectance\" \"a.spd\"\n")
            : g_strdup_printf(
                  WORLD "Material \"diffuse\" \"spectrum reflectance\" [%s]\n", numbers);
    scene_folder f = folder_new(text);
    folder_write(&f, "a.spd", numbers, -1);
    scene_free(format_load(f.main, 1, NULL, error));
    folder_remove(&f);
}

static void test_spectra(void)
{
    for (int from_file = 0; from_file < 2; from_file++) {
        g_autoptr(GError) fine = NULL, error = NULL;
        load_spectrum(CURVE_MOST_POINTS, from_file, &fine);
        g_assert_no_error(fine);
        load_spectrum(CURVE_MOST_POINTS + 1, from_file, &error);
        g_assert_nonnull(error);
        g_assert_nonnull(strstr(error->message, "expected at most 100000"));
    }
}

static void test_accessor_of_zeros(void)
{
    static const char text[] =
        HEAD MESH("0") NODES "\"materials\":[{}],\"accessors\":[{\"componentType\":5126,"
                             "\"count\":2147483647,\"type\":\"VEC3\"}]}";
    g_autoptr(GError) error = NULL;
    g_assert_null(load_bytes("a.gltf", text, -1, NULL, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_nonnull(strstr(error->message, "accessors[0]: expected a \"bufferView\""));
}

/* Every big allocation in turn is refused, those of JSON and of data: URIs among them. */
static void test_gltf_without_memory(void)
{
    g_autofree char *text = document(MESH("0") NODES "\"materials\":[{}],");
    unsigned n = 1;
    for (bool loaded = false; !loaded; n++) {
        g_autoptr(GError) error = NULL;
        big_alloc_fail_at(n);
        g_autoptr(scene) s = load_bytes("a.gltf", text, -1, NULL, &error);
        loaded = s != NULL;
        if (!loaded)
            g_assert_error(error, NEPH_ERROR, ERROR_FAILED);
        if (n == 2) /* the first is the file */
            g_assert_nonnull(strstr(error->message, "JSON"));
    }
    big_alloc_fail_at(0);
    g_assert_cmpuint(n, >, 5);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/claims/profile", test_profile);
    g_test_add_func("/claims/spectra", test_spectra);
    g_test_add_func("/claims/accessor-of-zeros", test_accessor_of_zeros);
    g_test_add_func("/claims/gltf-without-memory", test_gltf_without_memory);
    return g_test_run();
}
