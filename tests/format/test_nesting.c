/*
 * What may stand within another of its kind: a scene can be made of more levels than
 * there is stack for, or of so few that double the work each. Both are refused at their
 * place; what people draw is not.
 */
#include "refused_scene.h"

#include "material/material.h"

#include <string.h>
#include <unistd.h>

enum { PATIENCE = 30, FAR_TOO_MANY = 60000 }; /* s */

#define WORLD                                                                            \
    "Camera \"perspective\"\nWorldBegin\nLightSource \"point\"\nShape \"sphere\"\n"

/* The world, a first line, then a line of each number: "%u" is the number, "%p" the one
 * before it. */
static char *chain(const char *first, const char *next, unsigned n, const char *last)
{
    GString *text = g_string_new(WORLD);
    g_string_append(text, first);
    for (unsigned i = 1; i <= n; i++)
        for (const char *c = next; *c; c++) {
            if (*c == '%')
                g_string_append_printf(text, "%u", *++c == 'p' ? i - 1 : i);
            else
                g_string_append_c(text, *c);
        }
    g_string_append(text, last);
    return g_string_free(text, FALSE);
}

static void refuse_chain(const char *first, const char *next, unsigned n,
                         const char *message)
{
    g_autofree char *text = chain(first, next, n, "");
    scene_folder f = folder_new(text);
    g_autoptr(GError) error = NULL;
    alarm(PATIENCE);
    g_assert_null(format_load(f.main, 1, NULL, &error));
    alarm(0);
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_autofree char *want = g_strconcat(f.main, message, NULL);
    if (!g_str_has_prefix(error->message, want))
        g_error("expected\n%s\nfound\n%s", want, error->message);
    folder_remove(&f);
}

#define FIRST_TEXTURE(type) "Texture \"t0\" \"" type "\" \"constant\"\n"

/* A texture of the first stands on line 5, so that number n stands on line 5 + n. */
static void test_long_chains(void)
{
    refuse_chain(FIRST_TEXTURE("spectrum"),
                 "Texture \"t%u\" \"spectrum\" \"scale\" \"texture tex\" \"t%p\"\n",
                 FAR_TOO_MANY, ":1005:1: expected at most 1000 textures in one");
    refuse_chain(FIRST_TEXTURE("float"),
                 "Texture \"t%u\" \"float\" \"scale\" \"texture scale\" \"t%p\"\n",
                 FAR_TOO_MANY, ":1005:1: expected at most 1000 textures in one");
    refuse_chain(FIRST_TEXTURE("float"),
                 "Texture \"t%u\" \"float\" \"mix\" \"texture amount\" \"t%p\"\n",
                 FAR_TOO_MANY, ":1005:1: expected at most 1000 textures in one");
    refuse_chain("MakeNamedMaterial \"m0\" \"string type\" \"diffuse\"\n",
                 "MakeNamedMaterial \"m%u\" \"string type\" \"mix\" \"string materials\" "
                 "[\"m%p\" \"m0\"]\n",
                 FAR_TOO_MANY, ":1006:1: expected mixes of at most 1000 levels");
    refuse_chain("", "AttributeBegin\n", FAR_TOO_MANY,
                 ":1005:1: expected at most 1000 AttributeBegin within each other");
}

/* Each is 1 + 2 of the one before: 2^10 - 1 is too many. */
static void test_doubling(void)
{
    refuse_chain(FIRST_TEXTURE("spectrum"),
                 "Texture \"t%u\" \"spectrum\" \"mix\" \"texture tex1\" \"t%p\" "
                 "\"texture tex2\" \"t%p\"\n",
                 60, ":14:1: expected at most 1000 textures in one");
}

/* The share of each grey among what a scene's last material is at many points. */
static void count_greys(const scene *s, int n_points, const float greys[], unsigned n,
                        double shares[])
{
    const bsdf_options plain = {0};
    const material *m = s->materials->pdata[s->materials->len - 1];
    wavelengths w = wavelengths_at(0.5f);
    GRand *random = g_rand_new_with_seed(11);
    for (unsigned i = 0; i < n; i++)
        shares[i] = 0.0;
    for (int point = 0; point < n_points; point++) {
        surface_hit hit = {
            .n = {0, 0, 1, 0}, .n_geom = {0, 0, 1, 0}, .dpdu = {1, 0, 0, 0}};
        hit.p = vec3_make((float)g_rand_double(random), (float)g_rand_double(random),
                          (float)g_rand_double(random));
        bsdf b;
        material_bsdf(m, &hit, &w, ALL_WAVELENGTHS, &plain, &b);
        for (unsigned i = 0; i < n; i++)
            if (fabsf(b.rho[0] - greys[i]) < 1e-3f)
                shares[i] += 1.0 / n_points;
    }
    g_rand_free(random);
}

/* Six standard deviations of a share of a quarter at 40000 points are 0.013: a false
 * alarm has a probability below 1e-8. */
static void test_mixes_of_mixes(void)
{
    g_autoptr(scene) s = scene_of(
        WORLD
        "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"spectrum reflectance\" "
        "[400 "
        "0.2 700 0.2]\n"
        "MakeNamedMaterial \"b\" \"string type\" \"diffuse\" \"spectrum reflectance\" "
        "[400 "
        "0.4 700 0.4]\n"
        "MakeNamedMaterial \"c\" \"string type\" \"diffuse\" \"spectrum reflectance\" "
        "[400 "
        "0.6 700 0.6]\n"
        "MakeNamedMaterial \"bc\" \"string type\" \"mix\" \"string materials\" [\"b\" "
        "\"c\"]\n"
        "MakeNamedMaterial \"abc\" \"string type\" \"mix\" \"string materials\" [\"a\" "
        "\"bc\"]\n");
    static const float greys[] = {0.2f, 0.4f, 0.6f};
    double shares[3];
    count_greys(s, 40000, greys, 3, shares);
    g_test_message("%g %g %g", shares[0], shares[1], shares[2]);
    g_assert_cmpfloat_with_epsilon(shares[0], 0.5, 0.015);
    g_assert_cmpfloat_with_epsilon(shares[1], 0.25, 0.013);
    g_assert_cmpfloat_with_epsilon(shares[2], 0.25, 0.013);
}

/* As many levels as are allowed, and two ways at each, load and are looked up at once. */
static void test_deep_mixes(void)
{
    g_autofree char *text = chain(
        "MakeNamedMaterial \"m0\" \"string type\" \"diffuse\"\n",
        "MakeNamedMaterial \"m%u\" \"string type\" \"mix\" \"string materials\" [\"m%p\" "
        "\"m%p\"]\n",
        1000, "NamedMaterial \"m1000\"\nShape \"sphere\"\n");
    static const float grey[] = {0.5f};
    double share;
    alarm(PATIENCE);
    g_autoptr(scene) s = scene_of(text);
    count_greys(s, 400, grey, 1, &share);
    alarm(0);
    g_assert_cmpfloat_with_epsilon(share, 1.0, 1e-6);
}

static void test_deep_textures(void)
{
    g_autofree char *text = chain(
        "Texture \"t0\" \"spectrum\" \"constant\" \"spectrum value\" [400 0.3 700 0.3]\n",
        "Texture \"t%u\" \"spectrum\" \"scale\" \"texture tex\" \"t%p\"\n", 999,
        "Material \"diffuse\" \"texture reflectance\" \"t999\"\nShape \"sphere\"\n");
    static const float grey[] = {0.3f};
    double share;
    g_autoptr(scene) s = scene_of(text);
    count_greys(s, 400, grey, 1, &share);
    g_assert_cmpfloat_with_epsilon(share, 1.0, 1e-6);
}

/* JSON is refused by its brackets, before a parser calls as deep as they go. */
static void test_json(void)
{
    g_autoptr(GString) text =
        g_string_new("{\"asset\":{\"version\":\"2.0\"},\"extras\":");
    for (int i = 0; i < FAR_TOO_MANY; i++)
        g_string_append_c(text, '[');
    scene_folder f = folder_new("");
    folder_write(&f, "a.gltf", text->str, -1);
    g_autofree char *path = g_build_filename(f.path, "a.gltf", NULL);
    g_autoptr(GError) error = NULL;
    g_assert_null(format_load(path, 1, NULL, &error));
    g_assert_nonnull(strstr(error->message, ":1:1: expected at most 200 brackets"));
    folder_remove(&f);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/nesting/long-chains", test_long_chains);
    g_test_add_func("/nesting/doubling", test_doubling);
    g_test_add_func("/nesting/mixes-of-mixes", test_mixes_of_mixes);
    g_test_add_func("/nesting/deep-mixes", test_deep_mixes);
    g_test_add_func("/nesting/deep-textures", test_deep_textures);
    g_test_add_func("/nesting/json", test_json);
    return g_test_run();
}
