/*
 * Values as pbrt-v3 reads them: what follows a number is passed over, names of no picture
 * are none, colours are scaled by spectra and are black bodies, and NURBS are meshes.
 */
#include "alike.h"
#include "format/pbrt/pbrt_v3.h"

#include "params/params.h"

#include <math.h>
#include <string.h>

#define LOOK "LookAt 0 -5 2  0 0 0.3  0 0 1 Camera \"perspective\" \"float fov\" 40\n"
#define FILM3                                                                            \
    "Film \"image\" \"integer xresolution\" 8 \"integer yresolution\" 6 PixelFilter "    \
    "\"box\"\n"
#define LAMP "LightSource \"point\" \"rgb I\" [20 18 16] \"point from\" [1 -2 4]\n"
#define FLOOR "Shape \"disk\" \"float radius\" 4\n"
#define BALL "Translate 0 0 .8 Shape \"sphere\" \"float radius\" .7\n"
#define WORLD3(text) LOOK FILM3 "WorldBegin\n" LAMP FLOOR text "WorldEnd\n"

static void test_numbers(void)
{
#define MESH(a, b)                                                                       \
    WORLD3("Shape \"trianglemesh\" \"point P\" [" a "] \"integer indices\" [" b "]\n")
    static const pair pairs[] = {
        {"comma", MESH("-1, 0, 0, 1, 0, 0, 0,0, 0, 2", "0, 1, 2"),
         MESH("-1 0 0 1 0 0 0 0 2", "0 1 2")},
        {"look",
         "LookAt 0, -5f 2,  0 0 0.3  0 0 1, Camera \"perspective\" \"float fov\" 40deg\n"
         "Film \"image\" \"integer xresolution\" 8px \"integer yresolution\" 6\n"
         "WorldBegin\n" LAMP FLOOR "WorldEnd\n",
         WORLD3("")},
    };
    check_all(pairs, G_N_ELEMENTS(pairs));
}

/* Of what is of another type, or too little, nothing is left. */
static void test_left_out(void)
{
#define RED "Material \"matte\" \"rgb Kd\" [.9 .1 .1] "
    static const pair pairs[] = {
        {"one number", WORLD3("Material \"matte\" \"rgb Kd\" .7 " BALL),
         WORLD3("Material \"matte\" " BALL)},
        {"a fourth", WORLD3("Material \"matte\" \"rgb Kd\" [.9 .1 .1 1] " BALL),
         WORLD3(RED BALL)},
        {"words", WORLD3("Material \"matte\" \"color Kd\" \"red\" " BALL),
         WORLD3("Material \"matte\" " BALL)},
        {"list of words", WORLD3("Shape \"sphere\" \"float radius\" [\"2\" \"3\"]\n"),
         WORLD3("Shape \"sphere\"\n")},
        {"numbers", WORLD3("Material \"matte\" \"texture Kd\" [.9 .1 .1] " BALL),
         WORLD3("Material \"matte\" " BALL)},
        {"odd spectrum", WORLD3("Material \"matte\" \"spectrum Kd\" [400 .7 500] " BALL),
         WORLD3("Material \"matte\" \"spectrum Kd\" [400 .7] " BALL)},
        {"mapping",
         WORLD3("Texture \"t\" \"color\" \"checkerboard\" \"string mapping\" \"odd\" "
                "Material \"matte\" \"texture Kd\" \"t\" " BALL),
         WORLD3("Texture \"t\" \"color\" \"checkerboard\" Material \"matte\" "
                "\"texture Kd\" \"t\" " BALL)},
        {"picture",
         WORLD3("Texture \"t\" \"color\" \"imagemap\" \"string filename\" \"\" "
                "Material \"matte\" \"texture Kd\" \"t\" " BALL),
         WORLD3("Material \"matte\" \"rgb Kd\" [1 1 1] " BALL)},
        {"window",
         LOOK "Film \"image\" \"float cropwindow\" [0 .5] \"integer xresolution\" 8 "
              "\"integer yresolution\" 6 WorldBegin " LAMP FLOOR "WorldEnd\n",
         WORLD3("")},
        {"texture", WORLD3(RED "Texture \"t\" \"rgb\" \"constant\" " BALL),
         WORLD3(RED BALL)},
    };
    check_all(pairs, G_N_ELEMENTS(pairs));
}

static void test_lights(void)
{
    static const pair pairs[] = {
        {"no picture",
         WORLD3("LightSource \"infinite\" \"rgb L\" [1 .8 1] \"string mapname\" [\"\"] "
                "\"rgb scale\" [.1 .1 .1]\n"),
         WORLD3("LightSource \"infinite\" \"rgb L\" [.1 .08 .1]\n")},
        {"no picture of a lamp",
         WORLD3("LightSource \"goniometric\" \"rgb I\" [9 9 9] \"string mapname\" "
                "\"\"\n"),
         WORLD3("LightSource \"goniometric\" \"rgb I\" [9 9 9]\n")},
        {"scale",
         WORLD3("LightSource \"distant\" \"rgb L\" [1 2 3] \"spectrum scale\" [300 4 900 "
                "4] \"point from\" [1 1 5]\n"),
         WORLD3("LightSource \"distant\" \"rgb L\" [4 8 12] \"point from\" [1 1 5]\n")},
    };
    check_all(pairs, G_N_ELEMENTS(pairs));
}

/* Planck's law, 1 where it is most by Wien's. */
static double planck(double nm, double kelvin)
{
    const double c2 = 1.438776877e7, wien = 2.897771955e6; /* nm K */
    double most = wien / kelvin;
    return pow(most / nm, 5.0) * expm1(c2 / (most * kelvin)) / expm1(c2 / (nm * kelvin));
}

static void test_black_bodies(void)
{
    g_autoptr(GString) sampled = g_string_new(NULL);
    for (int nm = 360; nm <= 830; nm += 10)
        g_string_append_printf(sampled, "%d %.7f ", nm, 0.6 * planck(nm, 3000.0));
    g_autofree char *other = g_strdup_printf(
        WORLD3("Material \"matte\" \"spectrum Kd\" [%s] " BALL), sampled->str);
    const pair p = {"black body",
                    WORLD3("Material \"matte\" \"blackbody Kd\" [3000 .6] " BALL), other};
    check_alike(&p);
}

/* Components above are cut, which by a lamp as near as this one they are. */
static void test_bounded_samples(void)
{
#define WITH(film)                                                                       \
    LOOK film "\"integer xresolution\" 8 \"integer yresolution\" 6 PixelFilter "         \
              "\"box\"\nWorldBegin\n" LAMP FLOOR
    const pair p = {
        "bounded",
        WITH("Film \"image\" \"float maxsampleluminance\" .1 \"float scale\" "
             "2 ") "WorldEnd\n",
        WITH("Film \"rgb\" \"float maxcomponentvalue\" .2 \"float iso\" 200 ")};
    check_alike(&p);
    g_autoptr(view) v = view_of(p.one);
    g_autoptr(image) img = render_with(v, ALIKE_HOW);
    g_assert_cmpfloat(mean_of(img, ""), <=, 0.2 * (1.0 + 1e-5));
}

/* What a shape says of its material goes before what the material says, for it alone. */
static void test_materials_of_shapes(void)
{
#define LEFT(more) "Translate -1 0 .7 Shape \"sphere\" \"float radius\" .7 " more "\n"
#define RIGHT "Translate 2 0 0 Shape \"sphere\" \"float radius\" .7\n"
#define BLUE "Material \"matte\" \"rgb Kd\" [.1 .1 .9] "
#define NAMED(name, rgb)                                                                 \
    "MakeNamedMaterial \"" name "\" \"string type\" \"matte\" \"rgb Kd\" [" rgb "]\n"
    static const pair pairs[] = {
        {"of its own", WORLD3(BLUE LEFT("\"rgb Kd\" [.9 .1 .1]") RIGHT),
         WORLD3(RED LEFT("") BLUE RIGHT)},
        {"named",
         WORLD3(NAMED("m", ".1 .1 .9") "NamedMaterial \"m\" " LEFT(
             "\"color Kd\" [.9 .1 .1]") RIGHT),
         WORLD3(RED LEFT("") BLUE RIGHT)},
        {"default", WORLD3(LEFT("\"rgb Kd\" [.9 .1 .1]") RIGHT),
         WORLD3(RED LEFT("") "Material \"matte\" " RIGHT)},
        {"beside",
         WORLD3("Material \"glass\" \"float index\" 1.7 " LEFT("\"rgb Kt\" [.9 .1 .1]")),
         WORLD3(
             "Material \"glass\" \"float index\" 1.7 \"rgb Kt\" [.9 .1 .1] " LEFT(""))},
        {"ended",
         WORLD3(RED "AttributeBegin " BLUE "AttributeEnd " LEFT("\"float sigma\" 0")
                    RIGHT),
         WORLD3(RED LEFT("") RIGHT)},
    };
    check_all(pairs, G_N_ELEMENTS(pairs));
}

/* Nothing else is said than what there is to say. */
static void keep_notes(log_level level, const char *text, void *data)
{
    if (level == LOG_NOTE || level == LOG_WARNING)
        g_string_append_printf(data, "%s\n", text);
}

static void test_notes(void)
{
    scene_folder f = folder_new(
        LOOK FILM3 "WorldBegin\n" LAMP NAMED("m", ".1 .1 .9") "NamedMaterial \"m\" " LEFT(
            "\"rgb Kd\" [.9 .1 .1]") "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] "
                                     "ObjectBegin \"o\" Shape \"disk\" ObjectEnd "
                                     "ObjectInstance \"o\"\nWorldEnd\n");
    g_autoptr(GString) notes = g_string_new(NULL);
    const log_sink sink = {keep_notes, notes};
    g_autoptr(GError) error = NULL;
    scene *s = format_load(f.main, 1, &sink, &error);
    g_assert_no_error(error);
    g_assert_nonnull(strstr(notes->str, "does not shine"));
    g_assert_null(strstr(notes->str, "unknown parameter"));
    scene_free(s);
    folder_remove(&f);
}

/* ---- NURBS ---- */

static const source_place nowhere = {"a file", 1, 1};

static void give(params *p, param_type type, const char *name, const float *x, size_t n)
{
    g_autoptr(GError) error = NULL;
    params_add_numbers(p, nowhere, type, name, x, n, &error);
    g_assert_no_error(error);
}

static void give_count(params *p, const char *name, int n)
{
    g_autoptr(GError) error = NULL;
    params_add_integers(p, nowhere, PARAM_INTEGER, name, &n, 1, &error);
    g_assert_no_error(error);
}

/* Of three points in u, by a parabola, and two in v, by a line. */
static params *mesh_of(param_type type, const char *name, const float *x, size_t n)
{
    static const float uknots[] = {0, 0, 0, 2, 2, 2}, vknots[] = {1, 1, 3, 3};
    params *p = params_new(nowhere, ".", color_space_srgb());
    g_autofree char *kind = g_strdup("nurbs");
    const log_sink silent = {0};
    g_autoptr(GError) error = NULL;
    give_count(p, "nu", 3);
    give_count(p, "nv", 2);
    give_count(p, "uorder", 3);
    give_count(p, "vorder", 2);
    give(p, PARAM_FLOAT, "uknots", uknots, G_N_ELEMENTS(uknots));
    give(p, PARAM_FLOAT, "vknots", vknots, G_N_ELEMENTS(vknots));
    give(p, type, name, x, n);
    g_assert_true(pbrt_v3_translate(V3_SHAPE, &kind, p, &silent, &error));
    g_assert_no_error(error);
    g_assert_cmpstr(kind, ==, "trianglemesh");
    return p;
}

/* Three points with weights 1, 1/√2 and 1 are a quarter of a circle. */
static void test_cylinder(void)
{
    const float w = 0.70710678f;
    const float x[] = {1, 0, 0, 1, w, w, 0,     w, 0, 1, 0, 1,
                       1, 0, 5, 1, w, w, 5 * w, w, 0, 1, 5, 1};
    g_autoptr(params) p = mesh_of(PARAM_FLOAT, "Pw", x, G_N_ELEMENTS(x));
    const float *at = params_find(p, "P")->numbers, *n = params_find(p, "N")->numbers;
    const float *uv = params_find(p, "uv")->numbers;
    g_assert_cmpuint(params_find(p, "P")->n, ==, (size_t)3 * 900);
    g_assert_cmpuint(params_find(p, "indices")->n, ==, (size_t)6 * 29 * 29);
    for (int i = 0; i < 900; i++, at += 3, n += 3, uv += 2) {
        g_assert_cmpfloat(fabs(hypot((double)at[0], (double)at[1]) - 1.0), <, 1e-6);
        g_assert_cmpfloat(fabs((double)at[2] - 2.5 * ((double)uv[1] - 1.0)), <, 1e-5);
        g_assert_cmpfloat(hypot((double)(n[0] - at[0]), (double)(n[1] - at[1])), <, 1e-5);
        g_assert_cmpfloat(fabs((double)n[2]), <, 1e-6);
    }
    g_assert_cmpfloat(fabs((double)at[-3]), <, 1e-6);
    g_assert_cmpfloat((double)uv[-2], ==, 2.0);
}

/* One side is a single point, where the surface has no slope along it. */
static void test_pole(void)
{
    const float x[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1};
    g_autoptr(params) p = mesh_of(PARAM_POINT3, "P", x, G_N_ELEMENTS(x));
    const float *n = params_find(p, "N")->numbers;
    for (int i = 0; i < 900; i++, n += 3)
        g_assert_cmpfloat(fabs(fabs((double)n[2]) - 1.0), <, 1e-5);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/pbrt-v3-values/numbers", test_numbers);
    g_test_add_func("/pbrt-v3-values/left-out", test_left_out);
    g_test_add_func("/pbrt-v3-values/lights", test_lights);
    g_test_add_func("/pbrt-v3-values/black-bodies", test_black_bodies);
    g_test_add_func("/pbrt-v3-values/bounded-samples", test_bounded_samples);
    g_test_add_func("/pbrt-v3-values/materials-of-shapes", test_materials_of_shapes);
    g_test_add_func("/pbrt-v3-values/notes", test_notes);
    g_test_add_func("/pbrt-v3-values/cylinder", test_cylinder);
    g_test_add_func("/pbrt-v3-values/pole", test_pole);
    return g_test_run();
}
