/*
 * pbrt's participating media: what MakeNamedMedium says is what the scene holds, and
 * MediumInterface is around what stands in its scope; in pbrt-v3's words too. What is
 * wrong with them is told at its place.
 */
#include "refused_scene.h"

#include "medium/medium_presets.h"

#include <math.h>

#define CAMERA "Camera \"perspective\"\n"
#define LIGHT "LightSource \"point\"\n"
#define BALL "Shape \"sphere\"\n"
#define MAKE(name) "MakeNamedMedium \"" name "\" \"string type\" \"homogeneous\" "

/* ---- Where media are ---- */

/* The two media around something: "inside|outside", of none nothing. */
static char *around_of(const scene *s, const medium_interface *media)
{
    const medium *in = scene_medium(s, media->inside);
    const medium *beyond = scene_medium(s, media->outside);
    return g_strdup_printf("%s|%s", in ? in->name : "", beyond ? beyond->name : "");
}

static void check_shapes(const char *world, const char *const *want)
{
    g_autofree char *text = g_strconcat(
        CAMERA "WorldBegin\n" LIGHT MAKE("a") MAKE("b") MAKE("c"), world, NULL);
    g_autoptr(scene) s = scene_of(text);
    g_assert_cmpuint(s->shapes->len, ==, g_strv_length((char **)want));
    for (guint i = 0; i < s->shapes->len; i++) {
        const shape *one = s->shapes->pdata[i];
        g_autofree char *found = around_of(s, &one->media);
        g_assert_cmpstr(found, ==, want[i]);
        g_assert_true(one->parts_media == (one->media.inside != one->media.outside));
    }
}

static void test_shapes(void)
{
    check_shapes(BALL, (const char *const[]){"|", NULL});
    check_shapes("MediumInterface \"a\"\n" BALL, (const char *const[]){"a|a", NULL});
    check_shapes("MediumInterface \"a\" \"b\"\n" BALL "MediumInterface \"\"\n" BALL
                 "MediumInterface \"\" \"c\"\n" BALL "MediumInterface \"b\" \"\"\n" BALL,
                 (const char *const[]){"a|b", "|", "|c", "b|", NULL});
}

static void test_scopes(void)
{
    check_shapes("MediumInterface \"a\" \"b\"\nAttributeBegin\n" BALL
                 "MediumInterface \"c\" \"\"\n" BALL "AttributeEnd\n" BALL,
                 (const char *const[]){"a|b", "c|", "a|b", NULL});
    check_shapes("MediumInterface \"a\" \"b\"\nObjectBegin \"o\"\n" BALL
                 "MediumInterface \"c\" \"a\"\n" BALL "ObjectEnd\n" BALL
                 "ObjectInstance \"o\"\n",
                 (const char *const[]){"a|b", "c|a", "a|b", NULL});
    check_shapes(
        "MediumInterface \"a\" \"b\" ActiveTransform EndTime Translate 1 0 0\n" BALL,
        (const char *const[]){"a|b", NULL});
}

/* A name may come before what it names, but not what it is around. */
static void test_named_before(void)
{
    check_shapes("MediumInterface \"d\" \"a\"\n" MAKE("d") BALL,
                 (const char *const[]){"d|a", NULL});
}

static void test_lights(void)
{
    g_autoptr(scene) s =
        scene_of(CAMERA "WorldBegin\n" MAKE("a") MAKE("b") LIGHT
                 "MediumInterface \"a\" \"b\"\n" LIGHT
                 "LightSource \"infinite\"\nLightSource \"distant\"\n"
                 "AreaLightSource \"diffuse\"\n" BALL "MediumInterface \"a\"\n" BALL);
    static const char *const want[] = {"|", "b|b", "|", "|", "a|b", "a|a"};
    g_assert_cmpuint(s->lights->len, ==, G_N_ELEMENTS(want));
    for (guint i = 0; i < s->lights->len; i++) {
        g_autofree char *found = around_of(s, &scene_light(s, (int)i)->media);
        g_assert_cmpstr(found, ==, want[i]);
    }
}

static void check_camera(const char *options, const char *world, const char *seen,
                         const char *around)
{
    g_autofree char *text =
        g_strconcat(MAKE("a") MAKE("b"), options, "WorldBegin\n" LIGHT, world, NULL);
    g_autoptr(view) v = view_of(text);
    const shape *first = v->scene->shapes->pdata[0];
    g_autofree char *found = around_of(v->scene, &first->media);
    const medium *in = scene_medium(v->scene, v->camera.media.participating);
    g_assert_cmpstr(in ? in->name : "", ==, seen);
    g_assert_cmpstr(found, ==, around);
}

/* It stands in the outer one of its directive, and WorldBegin changes nothing. */
static void test_camera(void)
{
    check_camera(CAMERA, BALL, "", "|");
    check_camera("MediumInterface \"a\" \"b\"\n" CAMERA, BALL, "b", "a|b");
    check_camera("MediumInterface \"a\"\n" CAMERA "MediumInterface \"\" \"b\"\n", BALL,
                 "a", "|b");
    check_camera(CAMERA "MediumInterface \"b\" \"a\"\n", BALL, "", "b|a");
    check_camera(CAMERA, "MediumInterface \"b\" \"a\"\n" BALL, "", "b|a");
    check_camera("MediumInterface \"d\"\n" CAMERA MAKE("d"), BALL, "d", "d|d");
}

/* ---- What they are ---- */

static float coefficient(const medium *m, const curve *c, float nm)
{
    return c ? m->scale * curve_at(c, nm) : 0.0f;
}

/* σa, σs at 450 and 650 nm, and g, of the only medium of a text. */
static void measure(const char *text, float out[5])
{
    g_autoptr(scene) s = scene_of(text);
    g_assert_cmpuint(s->media->len, ==, 1);
    const medium *m = s->media->pdata[0];
    for (int i = 0; i < 2; i++) {
        out[i] = coefficient(m, m->absorption, i ? 650.0f : 450.0f);
        out[2 + i] = coefficient(m, m->scattering, i ? 650.0f : 450.0f);
    }
    out[4] = m->g;
}

static void measure_made(const char *given, float out[5])
{
    g_autofree char *text =
        g_strconcat(CAMERA "WorldBegin\n" LIGHT MAKE("fog"), given, "\n" BALL, NULL);
    measure(text, out);
}

static void check_close(const float a[5], const float b[5])
{
    for (int i = 0; i < 5; i++)
        if (!(fabsf(a[i] - b[i]) <= 1e-5f * fabsf(b[i])))
            g_error("number %d: %g, expected %g", i, (double)a[i], (double)b[i]);
}

static void check_made(const char *given, const float want[5])
{
    float found[5];
    measure_made(given, found);
    check_close(found, want);
}

static void test_coefficients(void)
{
    check_made("", (const float[]){1, 1, 1, 1, 0});
    check_made("\"float g\" -0.5 \"float scale\" 3", (const float[]){3, 3, 3, 3, -0.5f});
    check_made("\"spectrum sigma_a\" [400 1 500 2 700 4] \"spectrum sigma_s\" [400 0 500 "
               "5 600 10 700 0] \"float scale\" 2",
               (const float[]){3, 7, 5, 10, 0});
    check_made("\"spectrum sigma_a\" [400 0 700 0]", (const float[]){0, 0, 1, 1, 0});
    check_made("\"rgb Le\" [0 0 0] \"float Lescale\" 5", (const float[]){1, 1, 1, 1, 0});
    check_made("\"spectrum Le\" [400 7 700 7] \"float Lescale\" 0",
               (const float[]){1, 1, 1, 1, 0});
}

static void test_defaults(void)
{
    static const char text[] =
        CAMERA "Attribute \"medium\" \"float g\" 0.25 \"float density\" 3\n"
               "WorldBegin\n" LIGHT
               "AttributeBegin\nAttribute \"medium\" \"float scale\" 2\n" MAKE("a")
                   MAKE("b") "\"float scale\" 5\nAttributeEnd\n" MAKE("c") BALL;
    g_autoptr(scene) s = scene_of(text);
    static const float scales[] = {2, 5, 1};
    g_assert_cmpuint(s->media->len, ==, 3);
    for (guint i = 0; i < 3; i++) {
        const medium *m = s->media->pdata[i];
        g_assert_cmpfloat(m->g, ==, 0.25f);
        g_assert_cmpfloat(m->scale, ==, scales[i]);
    }
}

/* Figures of the two papers, and scale that makes metres of their millimetres. */
static void check_preset(const char *name, const char *absorption, const char *scattering)
{
    g_autofree char *given =
        g_strdup_printf("\"string preset\" \"%s\" \"float scale\" 1000", name);
    g_autofree char *same =
        g_strdup_printf("\"rgb sigma_a\" [%s] \"rgb sigma_s\" [%s] \"float scale\" 1000",
                        absorption, scattering);
    float a[5], b[5];
    measure_made(given, a);
    measure_made(same, b);
    check_close(a, b);
}

static void test_presets(void)
{
    check_preset("Ketchup", "0.061 0.97 1.45", "0.18 0.07 0.03");
    check_preset("Spectralon", "0 0 0", "11.6 20.4 14.9");
    check_preset("Coke", "0.10014 0.16503 0.2468", "8.9053e-05 8.372e-05 0");
    check_preset("Head & Shoulders Shampoo", "0.084621 0.15688 0.20365",
                 "0.023805 0.028804 0.034306");
    check_made("\"string preset\" \"\"", (const float[]){1, 1, 1, 1, 0});
    float a[5], b[5]; /* they are of sRGB, whatever the file's colours are of */
    measure_made("\"string preset\" \"Cream\"", a);
    measure(CAMERA "ColorSpace \"rec2020\" WorldBegin\n" LIGHT MAKE(
                "fog") "\"string preset\" \"Cream\"\n" BALL,
            b);
    check_close(a, b);
}

/* The manual lists them all, and none twice. */
static void test_manual_lists_presets(void)
{
    g_autofree char *manual = NULL;
    g_assert_true(
        g_file_get_contents(SOURCE_ROOT "/docs/manual.md", &manual, NULL, NULL));
    const medium_preset *one;
    for (size_t i = 0; (one = medium_preset_at(i)); i++) {
        g_autofree char *row = g_strdup_printf("`%s`", one->name);
        if (!strstr(manual, row))
            g_error("the manual does not list %s", row);
        g_assert_true(medium_preset_find(one->name) == one);
    }
}

/* ---- pbrt-v3 ---- */

#define V3(given) CAMERA "WorldBegin\n" LIGHT MAKE("fog") given "\n" BALL "WorldEnd\n"

static void check_v3(const char *v3, const char *v4)
{
    float a[5], b[5];
    measure(v3, a);
    measure_made(v4, b);
    check_close(a, b);
}

/* api.cpp's MakeMedium: milk, then the preset, then what is given. */
static void test_v3(void)
{
    check_v3(V3(""), "\"rgb sigma_a\" [.0011 .0024 .014] \"rgb sigma_s\" [2.55 3.21 "
                     "3.77]");
    check_v3(V3("\"rgb sigma_a\" [1 2 3] \"float scale\" 10 \"float g\" .5"),
             "\"rgb sigma_a\" [1 2 3] \"rgb sigma_s\" [2.55 3.21 3.77] \"float scale\" "
             "10 \"float g\" .5");
    check_v3(V3("\"string preset\" \"Skin1\" \"color sigma_s\" [4 5 6]"),
             "\"rgb sigma_a\" [.032 .17 .48] \"rgb sigma_s\" [4 5 6]");
    check_v3(V3("\"string preset\" \"Skin1\""), "\"string preset\" \"Skin1\"");
}

/* ---- What is wrong ---- */

#define WORLD CAMERA "WorldBegin\n" LIGHT /* three lines */

static void refuse_made(const char *given, const char *message)
{
    g_autofree char *text = g_strconcat(WORLD MAKE("fog") "\n", given, NULL);
    g_autofree char *at = g_strconcat("%s:5:", message, NULL);
    refuse(text, at);
}

static void test_wrong_names(void)
{
    refuse(WORLD "MakeNamedMedium \"fog\" \"float g\" 0\n",
           "%s:4:17: expected \"string type\" of medium 'fog', found none");
    refuse(WORLD "MakeNamedMedium \"\" \"string type\" \"homogeneous\"\n",
           "%s:4:17: expected a medium's name, found \"\", which is none");
    refuse(WORLD MAKE("fog") "\n" MAKE("fog"),
           "%s:5:17: expected a new medium's name, found \"fog\" again");
    refuse(
        WORLD "MediumInterface \"\" \"fog\"\n" BALL BALL "MediumInterface \"fog\"\n"
              "AttributeBegin MediumInterface \"mist\" \"\" AttributeEnd\n",
        "%s:4:20: expected the name of a medium made before it is used, found \"fog\"\n"
        "%s:8:32: expected the name of a medium made before it is used, found "
        "\"mist\"");
    refuse("MediumInterface \"fog\"\n" WORLD MAKE("fog"),
           "%s:1:17: expected the name of a medium made before it is used, found "
           "\"fog\"");
    refuse(WORLD "MediumInterface fog\n",
           "%s:4:17: expected a medium in quotes, found 'fog'");
}

static void test_wrong_kinds(void)
{
    refuse(WORLD "MakeNamedMedium \"fog\" \"string type\" \"haze\"\n"
                 "MediumInterface \"fog\"\n" BALL,
           "%s:4:1: expected a medium \"homogeneous\", found \"haze\"");
    refuse(WORLD
           "MakeNamedMedium \"fog\" \"string type\" \"cloud\" \"float density\" 4\n",
           "%s:4:1: medium \"cloud\" is not supported, \"homogeneous\" is; --lenient "
           "takes empty space for it");
    refuse(WORLD "MakeNamedMedium \"fog\" \"string type\" \"heterogeneous\"\n",
           "%s:4:1: medium \"heterogeneous\" is not supported, \"homogeneous\" is; "
           "--lenient takes empty space for it");
}

static void test_wrong_parameters(void)
{
    refuse_made("\"float density\" 2",
                "1: unknown parameter 'density' of medium \"homogeneous\"");
    refuse_made("\"float g\" 1", "1: parameter 'g': expected a number between -1 and 1, "
                                 "found 1");
    refuse_made("\"float g\" 0 \"float scale\" -2",
                "13: parameter 'scale': expected a number >= 0, found -2");
    refuse_made("\"spectrum sigma_a\" [400 1e30 700 1e30] \"float scale\" 1e30",
                "40: parameter 'scale': expected a number that leaves the medium's "
                "finite, found 1e+30");
    refuse_made("\"spectrum sigma_a\" [400 1 700 -1]",
                "1: parameter 'sigma_a': expected numbers >= 0, found -0.0333333 at 555 "
                "nm");
    refuse_made("\"rgb sigma_s\" [1 -1 1]",
                "1: rgb (1, -1, 1): components must be finite and not negative");
    refuse_made("\"float Lescale\" 2 \"blackbody Le\" 3000",
                "19: parameter 'Le': expected 0, since media that glow are not "
                "supported, found more");
    refuse_made("\"string preset\" \"Beer\"",
                "1: parameter 'preset': expected the name of a medium that the manual "
                "lists under \"Participating media\", found \"Beer\"");
    refuse_made("\"string preset\" \"Cream\" \"rgb sigma_s\" [1 1 1]",
                "25: parameter 'sigma_s': expected no 'preset' beside it, found "
                "\"Cream\"");
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/pbrt-media/shapes", test_shapes);
    g_test_add_func("/pbrt-media/scopes", test_scopes);
    g_test_add_func("/pbrt-media/named-before", test_named_before);
    g_test_add_func("/pbrt-media/lights", test_lights);
    g_test_add_func("/pbrt-media/camera", test_camera);
    g_test_add_func("/pbrt-media/coefficients", test_coefficients);
    g_test_add_func("/pbrt-media/defaults", test_defaults);
    g_test_add_func("/pbrt-media/presets", test_presets);
    g_test_add_func("/pbrt-media/manual-lists-presets", test_manual_lists_presets);
    g_test_add_func("/pbrt-media/v3", test_v3);
    g_test_add_func("/pbrt-media/wrong-names", test_wrong_names);
    g_test_add_func("/pbrt-media/wrong-kinds", test_wrong_kinds);
    g_test_add_func("/pbrt-media/wrong-parameters", test_wrong_parameters);
    return g_test_run();
}
