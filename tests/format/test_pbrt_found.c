/*
 * What scenes found in the wild hold beside what they should: pbrt-v4 and pbrt-v3 tell of
 * it and go on, each in its way, and so must we. No mesh's arrays need fit, a portal may
 * have a colour behind it, and programs made from pbrt-v3 have kinds of their own.
 */
#include "saying_scene.h"

#include <math.h>

#define FILM "Film \"rgb\" \"integer xresolution\" 6 \"integer yresolution\" 6\n"
#define WORLD FILM "Camera \"perspective\"\nWorldBegin\nLightSource \"point\"\n"
#define WORLD3                                                                           \
    "Film \"image\" \"integer xresolution\" 6 \"integer yresolution\" 6\n"               \
    "Camera \"perspective\"\nWorldBegin\nLightSource \"point\"\n"
#define V3 "note: pbrt-v3: its directives are translated to pbrt-v4's\n"
#define TRIANGLE "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n"
#define BALL "Shape \"sphere\"\n"

static guint n_shapes(const view *v)
{
    return v->scene->shapes->len;
}

/* ---- Both ---- */

static void test_arrays_that_do_not_fit(void)
{
    g_autoptr(view) v = read_saying(
        WORLD TRIANGLE "\"point2 uv\" [0 0] \"normal N\" [0 0 1]\n"
                       "\"vector3 S\" [1 0 0] \"integer faceIndices\" [1 2 3]\n"
                       "\"integer indices\" [0 1 2 1]\n",
        "warning:6:1: 'uv' of 1 vertices are left out: the mesh has 3\n"
        "warning:6:19: 'N' of 1 vertices are left out: the mesh has 3\n"
        "warning:7:1: 'S' of 1 vertices are left out: the mesh has 3\n"
        "warning:8:1: the last 1 of 4 indices make no face\n"
        "warning:7:21: 'faceIndices' of 3 faces are left out: the mesh has 1\n");
    const shape *on = v->scene->shapes->pdata[0];
    const mesh *m = on->kind->triangles(on->self);
    g_assert_cmpuint(m->n_triangles, ==, 1);
    g_assert_null(m->uvs);
    g_assert_null(m->normals);
}

static void test_meshes_that_are_not_seen(void)
{
    g_autoptr(view) v = read_saying(
        WORLD TRIANGLE "\"integer indices\" [0 1 3]\n" TRIANGLE
                       "\"integer indices\" [0 -1 2]\n"
                       "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n"
                       "Shape \"loopsubdiv\" \"integer indices\" [0 1 2]\n" BALL,
        "warning:6:1: a mesh that names vertex 3 of 3 is not seen\n"
        "warning:8:1: a mesh that names vertex -1 of 3 is not seen\n"
        "warning:9:7: a mesh without 'indices' is not seen\n"
        "warning:10:7: a mesh without 'P' is not seen\n");
    g_assert_cmpuint(n_shapes(v), ==, 1);
}

static void test_numbers_cut_to_whole_ones(void)
{
    g_autoptr(view) v = read_saying(
        "Film \"rgb\" \"integer xresolution\" [6.0] \"integer yresolution\" 4.9\n"
        "Camera \"perspective\"\nWorldBegin\nLightSource \"point\"\n" TRIANGLE
        "\"integer indices\" [0 1e0 2.]\n",
        "warning:1:62: parameter 'yresolution': 4.9 is taken as 4\n");
    g_assert_cmpint(v->film.width, ==, 6);
    g_assert_cmpint(v->film.height, ==, 4);
}

/* pbrt has no limit. */
static void test_files_within_files(void)
{
    enum { N = 200 };
    scene_folder f = folder_new(WORLD "Include \"0.pbrt\"\n");
    for (int i = 0; i < N; i++) {
        g_autofree char *name = g_strdup_printf("%d.pbrt", i);
        g_autofree char *text = i + 1 < N
                                    ? g_strdup_printf(BALL "Include \"%d.pbrt\"\n", i + 1)
                                    : g_strdup(BALL);
        folder_write(&f, name, text, -1);
    }
    g_autoptr(GError) error = NULL;
    g_autoptr(view) v = load_view(f.main, NULL, &error);
    g_assert_no_error(error);
    g_assert_cmpuint(n_shapes(v), ==, N);
    folder_remove(&f);
}

/* Paths from both ends see no media here. */
static void test_bidirectional_paths_in_fog(void)
{
#define FOGGY(world)                                                                     \
    FILM "Camera \"perspective\"\nIntegrator \"bdpt\"\n" world "LightSource \"point\"\n"
#define FOG "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n"
#define BECOMES                                                                          \
    "note:3:12: integrator 'bdpt' becomes vcm with 16 passes of 4 samples a pixel and "  \
    "maxdepth 5, connections alone\n"
    g_autoptr(view) v = read_saying(
        FOGGY(FOG "WorldBegin\nMediumInterface \"fog\" \"\" Shape \"sphere\"\n"),
        BECOMES "note:3:12: integrator 'bdpt' becomes auto, which sees the scene's "
                "media\n");
    g_assert_cmpint(v->scene->settings.integrator, ==, INTEGRATOR_AUTO);
    g_autoptr(view) clear = read_saying(FOGGY("WorldBegin\n" BALL), BECOMES);
    g_assert_cmpint(clear->scene->settings.integrator, ==, INTEGRATOR_VCM);
}

/* ---- pbrt-v4's lights ---- */

static double mean_with(const char *text, const char *said)
{
    g_autoptr(view) v = read_saying(text, said);
    g_autoptr(image) img = render_with(v, "integrator=path passes=1 spp=64");
    return mean_of(img, "");
}

/* assimp writes [6000 1]. */
static void test_first_of_many(void)
{
#define SKY(L) FILM "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\" " L "\n"
    double one = mean_with(SKY("\"blackbody L\" 6000"), "");
    double two = mean_with(SKY("\"blackbody L\" [6000 1]"),
                           "note:4:24: parameter 'L': the first of 2 counts\n");
    double colors = mean_with(SKY("\"rgb L\" [.5 .5 .5 3 3 3]"),
                              "note:4:24: parameter 'L': the first of 2 counts\n");
    g_assert_cmpfloat(fabs(two / one - 1.0), <, 1e-5);
    g_assert_cmpfloat(fabs(colors / 0.5 - 1.0), <, 2e-2);
}

/* A floor under a portal is lit as by a lamp in its place; behind one, pbrt takes a black
 * body as it is, its peak 1, where a lamp's luminance is 1. */
static void test_portal_of_a_color(void)
{
#define UNDER(lamp)                                                                      \
    FILM "LookAt 0 0 2 .1 1.5 0 0 0 1 Camera \"perspective\" \"float fov\" 30\n"         \
         "WorldBegin\n" lamp "Shape \"disk\" \"float radius\" 9\n"
#define PORTAL(L)                                                                        \
    UNDER("LightSource \"infinite\" \"point3 portal\" [-1 -1 3 -1 1 3 1 1 3 1 -1 3] " L  \
          "\n")
#define LAMP                                                                             \
    UNDER("AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [2 2 2]\n"               \
          "ReverseOrientation Shape \"bilinearmesh\" \"point3 P\" [-1 -1 3 1 -1 3 -1 1 " \
          "3 1 1 3] AttributeEnd\n")
    double lamp = mean_with(LAMP, ""),
           portal = mean_with(PORTAL("\"rgb L\" [2 2 2]"), "");
    g_assert_cmpfloat(lamp, >, 0.01);
    g_assert_cmpfloat(fabs(portal / lamp - 1.0), <, 0.03);
    g_autoptr(curve) hot = curve_blackbody(6500.0f);
    double luminance = (double)curve_photometric(hot) / 106.856895;
    double black = mean_with(PORTAL("\"blackbody L\" 6500 \"float scale\" 2"), "");
    g_assert_cmpfloat(fabs(black / (lamp * luminance) - 1.0), <, 0.04);
}

/* ---- pbrt-v3 ---- */

static void test_unknown_kinds(void)
{
    g_autoptr(view) v = read_saying(
        "Film \"image\"\nSampler \"own\"\nIntegrator \"own\" \"integer maxdepth\" 7\n"
        "WorldBegin\nLightSource \"own\" \"float I\" 1\nLightSource \"point\"\n"
        "Texture \"t\" \"color\" \"own\"\nMaterial \"own\" \"texture Kd\" \"t\"\n"
        "MakeNamedMedium \"m\" \"string type\" \"own\"\nMediumInterface \"m\" \"\"\n"
        "AreaLightSource \"own\"\nShape \"own\"\n" BALL "WorldEnd\n",
        V3
        "warning:2:1: sampler \"own\" is unknown: \"halton\" is taken for it\n"
        "warning:3:1: integrator \"own\" is unknown: \"path\" is taken for it\n"
        "note:4:1: there is no Camera; pbrt's own looks from the origin along z\n"
        "note:2:9: Sampler 'halton': Owen-scrambled Sobol' points are used\n"
        "note:3:12: integrator 'path' becomes auto with 16 passes of 4 samples a pixel "
        "and maxdepth 7; paths alone: --integrator path\n"
        "warning:5:13: light \"own\" is unknown: it is left out\n"
        "warning:7:21: texture \"own\" is unknown: it is left out\n"
        "warning:8:10: material \"own\" is unknown: \"matte\" is taken for it\n"
        "warning:8:16: there is no texture \"t\"; parameter 'reflectance' is left out\n"
        "warning:9:1: medium \"own\" is unknown: it is left out\n"
        "warning:11:17: area light \"own\" is unknown: its shapes do not shine\n"
        "warning:12:7: shape \"own\" is unknown: it is left out\n");
    g_assert_cmpuint(n_shapes(v), ==, 1);
    g_assert_cmpuint(v->scene->lights->len, ==, 1);
    g_assert_cmpint(settings_most_passes(&v->scene->settings), >, 0);
}

static void test_directives_out_of_place(void)
{
    g_autoptr(view) v = read_saying(
        "LightSource \"point\" \"rgb I\" [1 1 1]\n" WORLD3 BALL
        "Film \"image\" \"integer xresolution\" 9\nWorldEnd\n"
        "Film \"image\"\nWorldBegin\n" BALL,
        V3 "warning:1:1: LightSource before WorldBegin is left out, as pbrt-v3 does\n"
           "warning:7:1: Film after WorldBegin is left out, as pbrt-v3 does\n"
           "warning:9:1: what follows WorldEnd is another picture, which is left out\n");
    g_assert_cmpuint(n_shapes(v), ==, 1);
    g_assert_cmpuint(v->scene->lights->len, ==, 1);
    g_assert_cmpint(v->film.width, ==, 6);
}

/* What stood before is in the medium that had the name then. */
static void test_media_given_again(void)
{
#define MEDIUM(g)                                                                        \
    "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"float g\" " g "\n"
    g_autoptr(view) v = read_saying(
        WORLD3 MEDIUM(".25") "MediumInterface \"m\" \"\"\n" BALL MEDIUM(".75") BALL
        "MediumInterface \"none\" \"\"\n" BALL "WorldEnd\n",
        V3 "note:8:17: pbrt-v3: \"m\" is given again; what follows has the new one\n"
           "warning:10:17: there is no medium \"none\"\n");
    static const float expected[] = {0.25f, 0.75f};
    g_assert_cmpuint(v->scene->media->len, ==, 2);
    for (int i = 0; i < 2; i++) {
        const shape *on = v->scene->shapes->pdata[i];
        const medium *in = scene_medium(v->scene, on->media.inside);
        g_assert_cmpfloat(fabsf(in->g - expected[i]), <, 1e-6f);
    }
    const shape *last = v->scene->shapes->pdata[2];
    g_assert_null(scene_medium(v->scene, last->media.inside));
}

static void test_values(void)
{
    g_autoptr(view) v = read_saying(
        WORLD3
        "Material \"plastic\" \"string remaproughness\" \"false\" \"float Kd\" .5\n" BALL
        "Material \"plastic\" \"bool remaproughness\" \"False\"\n" BALL
        "Shape \"sphere\" \"radius\" [1 \"x\"] \"length x\" 3 \"float zmin\" []\n"
        "WorldEnd\n",
        V3 "note:5:52: pbrt-v3: 'Kd' is left out: it is no colour\n"
           "warning:7:42: parameter 'remaproughness': \"False\" is taken as false\n"
           "note:9:16: parameter 'radius' is left out: it has no type that pbrt-v3 "
           "knows\n"
           "note:9:33: parameter 'x' is left out: it has no type that pbrt-v3 knows\n"
           "note:9:46: parameter 'zmin' is left out: it has no value\n");
    g_assert_cmpuint(n_shapes(v), ==, 3);
}

/* What a name meant before a pair of AttributeBegin and AttributeEnd it means behind it,
 * but not behind TransformBegin and TransformEnd; what is given nowhere else lasts. */
static void test_names_that_end(void)
{
#define MADE(name, g)                                                                    \
    "Texture \"" name "\" \"float\" \"constant\" \"float value\" " g "\n"
#define USED(name) "Shape \"sphere\" \"texture alpha\" \"" name "\"\n"
    g_autoptr(view) v = read_saying(
        WORLD3 MADE("t", "1") "AttributeBegin\n" MADE("t", "0") MADE("u", ".5")
            USED("t") "AttributeEnd\n" USED("t") USED("u") "TransformBegin\n" MADE(
                "t", ".25") "TransformEnd\n" USED("t") "WorldEnd\n",
        V3 "note:7:1: pbrt-v3: \"t\" is given again; what follows has the new one\n"
           "note:14:1: pbrt-v3: \"t\" is given again; what follows has the new one\n");
    static const float expected[] = {0.0f, 1.0f, 0.5f, 0.25f};
    for (guint i = 0; i < G_N_ELEMENTS(expected); i++) {
        const shape *on = v->scene->shapes->pdata[i];
        surface_hit hit = {0};
        g_assert_cmpfloat(fabsf(float_input_eval(&on->alpha, &hit) - expected[i]), <,
                          1e-6f);
    }
}

/* 0.9505, 1, 1.089 are the XYZ of sRGB's white. */
static void test_xyz(void)
{
#define LIT(I)                                                                           \
    "Film \"image\" \"integer xresolution\" 6 \"integer yresolution\" 6\nWorldBegin "    \
    "LightSource \"infinite\" " I " WorldEnd\n"
    double white = mean_with(LIT("\"rgb L\" [.7 .7 .7]"),
                             V3 "note:2:1: there is no Camera; pbrt's own looks from the "
                                "origin along z\n");
    double xyz = mean_with(LIT("\"xyz L\" [.66535 .7 .7623]"),
                           V3 "note:2:1: there is no Camera; pbrt's own looks from the "
                              "origin along z\n");
    g_assert_cmpfloat(fabs(xyz / white - 1.0), <, 2e-3);
}

static void test_names_that_are_not_there(void)
{
    g_autoptr(view) v = read_saying(
        WORLD3 "Material \"mix\" \"string namedmaterial1\" \"gone\"\n" BALL
               "MakeNamedMaterial \"untold\" \"rgb Kd\" [1 0 0]\n"
               "ObjectBegin \"a\"\n" BALL "ObjectInstance \"a\"\nObjectEnd\nWorldEnd\n",
        V3
        "warning:5:1: there is no material \"gone\" to be mixed: \"matte\" is taken for "
        "it\n"
        "warning:5:1: there is no material \"\" to be mixed: \"matte\" is taken for it\n"
        "note:7:28: unknown parameter 'Kd' of material \"\" is left out\n"
        "warning:10:1: an instance within an object is left out\n");
    g_assert_cmpuint(n_shapes(v), ==, 2);
}

/* Of a light that no shape has nothing is asked, and all of it is known. */
static void test_light_of_object(void)
{
    g_autoptr(view) v = view_of(
        "Camera \"perspective\" WorldBegin LightSource \"point\"\n"
        "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] ObjectBegin \"o\" Shape \"disk\" "
        "ObjectEnd ObjectInstance \"o\"\n");
    g_assert_cmpuint(v->scene->lights->len, ==, 1);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/pbrt-found/arrays", test_arrays_that_do_not_fit);
    g_test_add_func("/pbrt-found/not-seen", test_meshes_that_are_not_seen);
    g_test_add_func("/pbrt-found/whole-numbers", test_numbers_cut_to_whole_ones);
    g_test_add_func("/pbrt-found/files-within-files", test_files_within_files);
    g_test_add_func("/pbrt-found/bidirectional-in-fog", test_bidirectional_paths_in_fog);
    g_test_add_func("/pbrt-found/first-of-many", test_first_of_many);
    g_test_add_func("/pbrt-found/portal-of-a-color", test_portal_of_a_color);
    g_test_add_func("/pbrt-found/v3-unknown-kinds", test_unknown_kinds);
    g_test_add_func("/pbrt-found/v3-out-of-place", test_directives_out_of_place);
    g_test_add_func("/pbrt-found/v3-media-again", test_media_given_again);
    g_test_add_func("/pbrt-found/v3-values", test_values);
    g_test_add_func("/pbrt-found/v3-names-that-end", test_names_that_end);
    g_test_add_func("/pbrt-found/v3-xyz", test_xyz);
    g_test_add_func("/pbrt-found/v3-no-names", test_names_that_are_not_there);
    g_test_add_func("/pbrt-found/light-of-object", test_light_of_object);
    return g_test_run();
}
