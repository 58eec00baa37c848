/*
 * What files that people have hold, pbrt reads and a stricter reader would refuse: each
 * is read as pbrt reads it, and said where it matters.
 */
#include "color/balance.h"
#include "saying_scene.h"

#include <math.h>

#define CAMERA                                                                           \
    "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\n"                 \
    "Camera \"perspective\"\n"
#define WORLD CAMERA "WorldBegin\nLightSource \"point\"\n" /* four lines */

static const mesh *mesh_at(const scene *s, guint i)
{
    const shape *on = s->shapes->pdata[i];
    return on->kind->triangles(on->self);
}

/* ---- Transforms ---- */

/* A mesh is pressed flat where pbrt would divide by nothing; its normals are those of the
 * plane it lies in then, whatever the axes. */
static void test_flattened_meshes(void)
{
#define PRISM                                                                            \
    "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 2 0 0 3 1] \"normal N\" [1 2 4 1 2 4 " \
    "1 2 4]\n"
    g_autoptr(view) v = read_saying(
        WORLD "AttributeBegin Scale 1 0 1\n" PRISM "AttributeEnd\n"
              "AttributeBegin Translate 0 0 5 Rotate 30 1 0 0 Transform [1 0 0 0 0 1 0 "
              "0 1 1 0 0 7 0 0 1]\n" PRISM "AttributeEnd\n"
              "AttributeBegin Rotate 90 1 0 0 ConcatTransform [2 0 0 0 0 0 0 0 0 0 2 0 0 "
              "0 0 1] Scale 3 3 3\n" PRISM "AttributeEnd\n",
        "");
    static const vec3 axes[] = {{0, 1, 0}, {0, 0, 1}, {0, 0, 1}};
    g_assert_cmpuint(v->scene->shapes->len, ==, 3);
    for (guint i = 0; i < 3; i++) {
        const mesh *m = mesh_at(v->scene, i);
        for (int k = 0; k < 3; k++) {
            const float *p = m->positions + 3 * k, *n = m->normals + 3 * k;
            vec3 from_first = {p[0] - m->positions[0], p[1] - m->positions[1],
                               p[2] - m->positions[2]};
            float along = dot3(vec3_make(n[0], n[1], n[2]), axes[i]);
            g_assert_cmpfloat(fabsf(dot3(from_first, axes[i])), <, 1e-5f);
            g_assert_cmpfloat(fabsf(fabsf(along) - 1.0f), <, 1e-5f);
        }
    }
}

/* What is no mesh is not seen then, in pbrt too. */
static void test_flattened_rest(void)
{
    g_autoptr(view) v =
        read_saying(WORLD "ObjectBegin \"o\" Shape \"disk\" ObjectEnd\n"
                          "Scale 0 1 1 Shape \"sphere\"\n"
                          "ObjectInstance \"o\"\n"
                          "AreaLightSource \"diffuse\" Shape \"disk\"\n",
                    "warning:6:19: a shape \"sphere\" that is flattened is not seen\n"
                    "warning:7:16: an instance that is flattened is not seen\n"
                    "warning:8:33: a shape \"disk\" that is flattened is not seen\n");
    g_assert_cmpuint(v->scene->shapes->len, ==, 1);
    g_assert_cmpuint(v->scene->instances->len, ==, 0);
}

static void test_transforms_that_do_nothing(void)
{
    g_autoptr(view) v = read_saying(
        WORLD "Rotate 30 0 0 0\n"
              "CoordSysTransform \"moon\"\nAttributeEnd\nColorSpace \"cmyk\"\n"
              "Shape \"trianglemesh\" \"point3 P\" [1 2 3 0 1 0 0 0 1]\n",
        "warning:5:1: Rotate about an axis 0 0 0 turns nothing\n"
        "warning:6:19: there is no coordinate system \"moon\"; the one before stays\n"
        "warning:7:1: AttributeEnd without an AttributeBegin before it ends nothing\n"
        "warning:8:12: there is no colour space \"cmyk\", but \"srgb\", \"rec2020\", "
        "\"dci-p3\" and \"aces2065-1\"; the one before stays\n");
    const float *p = mesh_at(v->scene, 0)->positions;
    for (int i = 0; i < 3; i++)
        g_assert_cmpfloat(fabsf(p[i] - (float)(i + 1)), <, 1e-6f);
}

/* ---- Lights ---- */

static void test_lights_that_can_not_be(void)
{
    g_autoptr(view) v = read_saying(
        WORLD "ObjectBegin \"lamp\" AreaLightSource \"diffuse\" Shape \"sphere\" "
              "ObjectEnd\nObjectInstance \"lamp\"\n"
              "ActiveTransform EndTime Translate 1 0 0\nLightSource \"point\"\n",
        "warning:5:20: a shape that moves or is part of an object does not shine\n"
        "warning:8:1: a light that moves stands still where it starts\n");
    g_assert_cmpuint(v->scene->lights->len, ==, 2);
}

/* ---- Film ---- */

/* As pbrt: to a camera's sensor the daylight of 6500 K is white, if nothing is said. */
static void test_sensors(void)
{
    g_autoptr(view) v = read_saying(
        "Film \"rgb\" \"string sensor\" \"canon_eos_100d\"\nCamera \"perspective\"\n"
        "WorldBegin\nLightSource \"point\"\n",
        "note:1:12: sensor \"canon_eos_100d\" sees as \"cie1931\" does, in the colours "
        "of "
        "the film\n");
    g_assert_cmpfloat(fabsf(v->film.kelvin - 6500.0f), <, 1.0f);
    g_autoptr(view) told = read_saying(
        "Film \"rgb\" \"string sensor\" \"sony_ilce_9\" \"float whitebalance\" 3200\n"
        "Camera \"perspective\"\nWorldBegin\nLightSource \"point\"\n",
        "note:1:12: sensor \"sony_ilce_9\" sees as \"cie1931\" does, in the colours of "
        "the "
        "film\n");
    g_assert_cmpfloat(fabsf(told->film.kelvin - 3200.0f), <, 1.0f);
}

/* White below daylight is a black body's: its chromaticity at 2856 K is that of CIE
 * illuminant A, (0.44757, 0.40745). */
static void test_warm_white(void)
{
    double m[9];
    const double xy[2] = {0.44757, 0.40745};
    const double xyz[3] = {xy[0] / xy[1], 1.0, (1.0 - xy[0] - xy[1]) / xy[1]};
    static const double d65[3] = {0.95047, 1.0, 1.08883};
    color_balance(2856.0f, color_space_srgb(), m);
    for (int i = 0; i < 3; i++) {
        double to = m[3 * i] * xyz[0] + m[3 * i + 1] * xyz[1] + m[3 * i + 2] * xyz[2];
        g_assert_cmpfloat(fabs(to - d65[i]), <, 2e-3);
    }
}

static void test_spectral_film(void)
{
    g_autoptr(view) v = read_saying(
        "Film \"spectral\" \"integer xresolution\" 4 \"integer yresolution\" 5 \"integer "
        "nbuckets\" 16 \"float lambdamin\" 400 \"float lambdamax\" 700\n"
        "Camera \"perspective\"\nWorldBegin\nLightSource \"point\"\n",
        "note:1:1: film \"spectral\" becomes \"rgb\": the picture has colours and no "
        "spectra\n");
    g_assert_cmpint(v->film.height, ==, 5);
}

/* Beyond the film it is cut off, turned round it is turned back, and of both the window
 * counts. */
static void test_crops(void)
{
    static const struct {
        const char *text, *said;
        float crop[4];
    } films[] = {
        {"\"float cropwindow\" [0.75 0.25 -1 2]", "", {0.3f, 0.8f, 0, 1}},
        {"\"integer pixelbounds\" [-5 6 2 99]", "", {0, 0.6f, 0.2f, 1}},
        {"\"integer pixelbounds\" [1 2 1 2] \"float cropwindow\" [0 .5 0 .5]",
         "note:1:62: \"cropwindow\" counts, and \"pixelbounds\" beside it does not\n",
         {0, 0.5f, 0, 0.5f}},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(films); i++) {
        g_autofree char *text = g_strconcat(
            "Film \"rgb\" \"integer xresolution\" 10 \"integer yresolution\" 10 ",
            films[i].text,
            "\nCamera \"perspective\"\nWorldBegin\nLightSource \"point\"\n", NULL);
        g_autoptr(view) v = read_saying(text, films[i].said);
        for (int k = 0; k < 4; k++) /* the pixel that it begins at or ends before */
            g_assert_cmpfloat(fabsf(ceilf(10 * v->film.crop[k]) / 10 - films[i].crop[k]),
                              <, 1e-6f);
    }
}

/* ---- Cameras ---- */

static void test_no_camera(void)
{
    g_autoptr(view) v = read_saying(
        "Translate 1 2 3\nWorldBegin\nLightSource \"point\"\n",
        "note:2:1: there is no Camera; pbrt's own looks from the origin along z\n");
    vec3 eye = transform_point(&v->camera.to_world, vec3_make(0, 0, 0));
    vec3 ahead = transform_vector(&v->camera.to_world, vec3_make(0, 0, 1));
    g_assert_cmpfloat(length3(eye), <, 1e-6f);
    g_assert_cmpfloat(length3(ahead - vec3_make(0, 0, 1)), <, 1e-6f);
}

/* A thick lens of radii 50 and -50 mm, 10 mm of index 1.5, has by the lensmaker's
 * equation 1/f = (n - 1) (1/R1 - 1/R2 + (n - 1) d / (n R1 R2)), f = 51.724 mm. On a film
 * of 24 x 18 mm (a diagonal of 30) its shorter side sees 2 atan(9 / f). Its aperture lets
 * the share π/4 (D/f)² through. */
static void test_realistic_camera(void)
{
    scene_folder f = folder_new(
        "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 6 \"float "
        "diagonal\" 30\nCamera \"realistic\" \"string lensfile\" \"lens.dat\" \"float "
        "aperturediameter\" 10 \"float focusdistance\" 4\nWorldBegin\nLightSource "
        "\"point\"\n");
    folder_write(&f, "lens.dat", "# one lens\n50 10 1.5 20\n-50 40 1 20\n", -1);
    g_autoptr(GString) lines = g_string_new(NULL);
    g_autoptr(GError) error = NULL;
    const log_sink sink = {keep_line, lines};
    g_autoptr(view) v = load_view(f.main, &sink, &error);
    g_assert_no_error(error);
    const double focal = 1.0 / (0.5 * (1.0 / 50 + 1.0 / 50 - 0.5 * 10 / (1.5 * 2500)));
    g_assert_cmpfloat(fabs(focal - 51.724), <, 1e-3);
    ray middle = camera_ray(&v->camera, (vec2){4, 3}, (vec2){0.5f, 0.5f}, 0.5f);
    ray edge = camera_ray(&v->camera, (vec2){4, 0}, (vec2){0.5f, 0.5f}, 0.5f);
    double angle =
        acos((double)dot3(normalize3(middle.direction), normalize3(edge.direction)));
    g_assert_cmpfloat(fabs(tan(angle) - 9 / focal), <, 1e-3);
    g_assert_cmpfloat(fabs((double)v->film.iso - 100 * G_PI / 4 * 100 / (focal * focal)),
                      <, 1e-3);
    g_assert_nonnull(strstr(lines->str, "warning:2:8: camera \"realistic\" becomes"));
    folder_remove(&f);
}

/* ---- Names that come later ---- */

static const char *material_of(const scene *s, guint i)
{
    const shape *on = s->shapes->pdata[i];
    const material *m =
        on->material == NO_INDEX ? NULL : s->materials->pdata[on->material];
    return m ? m->kind->name : "none";
}

/* pbrt asks what names mean when all has been read. Places in lists stay. */
static void test_names_given_later(void)
{
    g_autoptr(view) v = read_saying(
        WORLD
        "AttributeBegin NamedMaterial \"gold\" Shape \"sphere\" AttributeEnd\n"
        "NamedMaterial \"air\" Shape \"disk\"\n"
        "Material \"diffuse\" \"texture reflectance\" \"scaled\" Shape \"sphere\"\n"
        "Material \"mix\" \"string materials\" [\"painted\" \"gold\"] Shape \"sphere\"\n"
        "ObjectInstance \"twig\"\n"
        "Shape \"disk\" \"texture alpha\" \"holes\"\n"
        "MakeNamedMaterial \"painted\" \"string type\" \"diffuse\" \"texture "
        "reflectance\" \"scaled\"\n"
        "MakeNamedMaterial \"gold\" \"string type\" \"conductor\"\n"
        "MakeNamedMaterial \"air\" \"string type\" \"interface\"\n"
        "NamedMaterial \"air\" Shape \"disk\" NamedMaterial \"gold\" Shape \"sphere\"\n"
        "ObjectBegin \"twig\" Shape \"sphere\" ObjectEnd\n"
        "Texture \"scaled\" \"spectrum\" \"scale\" \"texture tex\" \"checks\"\n"
        "Texture \"checks\" \"spectrum\" \"checkerboard\" \"texture tex1\" \"plain\"\n"
        "Texture \"plain\" \"spectrum\" \"constant\"\n"
        "Texture \"holes\" \"float\" \"checkerboard\"\n",
        "");
    static const char *const want[] = {"conductor", "none",      "diffuse",   "mix",
                                       "none",      "conductor", "conductor", "mix"};
    g_assert_cmpuint(v->scene->shapes->len, ==, G_N_ELEMENTS(want));
    for (guint i = 0; i < G_N_ELEMENTS(want); i++)
        g_assert_cmpstr(material_of(v->scene, i), ==, want[i]);
    g_assert_true(((const shape *)v->scene->shapes->pdata[7])->has_alpha);
    g_assert_cmpuint(v->scene->instances->len, ==, 1);
    for (guint i = 0; i < v->scene->materials->len; i++)
        g_assert_nonnull(v->scene->materials->pdata[i]);
}

/* The picture is that of the same scene in order. */
static void test_later_is_the_same(void)
{
#define SEEN                                                                             \
    "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n"                 \
    "LookAt 0 0 -4 0 0 0 0 1 0 Camera \"perspective\"\nWorldBegin\n"                     \
    "LightSource \"infinite\" LightSource \"point\" \"point3 from\" [0 3 -4]\n"
#define BALL "Shape \"sphere\"\n"
#define CHECKS "Texture \"t\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [.9 .1 .2]\n"
#define PAINT                                                                            \
    "MakeNamedMaterial \"m\" \"string type\" \"diffuse\" \"texture reflectance\" "       \
    "\"t\"\n"
    g_autoptr(view) a = read_saying(SEEN "NamedMaterial \"m\"\n" BALL PAINT CHECKS, "");
    g_autoptr(view) b = read_saying(SEEN CHECKS PAINT "NamedMaterial \"m\"\n" BALL, "");
    g_autoptr(image) x = render_with(a, "integrator=path passes=1 spp=1");
    g_autoptr(image) y = render_with(b, "integrator=path passes=1 spp=1");
    assert_same_bits(x, y);
    g_assert_cmpfloat(mean_of(x, ""), >, 0.0);
}

/* ---- Meshes ---- */

/* In text and in bytes: normals and coordinates that are no numbers are none. */
static void test_bad_normals(void)
{
    scene_folder f =
        folder_new(WORLD "Shape \"plymesh\" \"string filename\" \"a.ply\"\n");
    folder_write(&f, "a.ply",
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                 "property float y\nproperty float z\nproperty float nx\nproperty float "
                 "ny\nproperty float nz\nproperty float u\nproperty float v\nelement "
                 "face 1\nproperty list uchar int vertex_indices\nend_header\n"
                 "0 0 0 nan -nan(ind) 0 0 0\n1 0 0 0 0 1 inf 0\n0 1 0 -NaN 0 1 1 1\n"
                 "3 0 1 2\n",
                 -1);
    g_autoptr(GString) lines = g_string_new(NULL);
    g_autoptr(GError) error = NULL;
    const log_sink sink = {keep_line, lines};
    g_autoptr(view) s = load_view(f.main, &sink, &error);
    g_assert_no_error(error);
    g_assert_cmpstr(
        lines->str, ==,
        "note:5:17: 2 of 3 normals of the mesh are no numbers and left out\n"
        "note:5:17: 1 of 3 texture coordinates of the mesh are no numbers and "
        "left out\n");
    ray r = {.origin = vec3_make(0.1f, 0.1f, 1),
             .direction = vec3_make(0, 0, -1),
             .t_max = INFINITY};
    surface_hit hit;
    g_assert_true(scene_intersect(s->scene, &r, &hit));
    g_assert_cmpfloat(fabsf(hit.n[2] - 1), <, 1e-5f);
    folder_remove(&f);
}

static void test_curve_normals(void)
{
    g_autoptr(view) v = read_saying(
        WORLD "Shape \"curve\" \"point3 P\" [0 0 0 1 0 0 1 1 0 2 1 0]\n"
              "\"normal N\" [0 0 1 0 0 1] \"float width\" .1 \"integer splitdepth\" 12\n",
        "note:6:1: \"N\" is for curves of type \"ribbon\" only\n");
    g_assert_cmpuint(v->scene->shapes->len, ==, 1);
}

/* ---- Parameters ---- */

/* pbrt reads it with every filter. */
static void test_anisotropy(void)
{
    scene_folder f = folder_new(
        WORLD "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"t.pfm\"\n"
              "\"float maxanisotropy\" 8 \"string wrap\" \"repeat\"\n"
              "Material \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\"\n");
    folder_write(&f, "t.pfm", "Pf\n1 1\n-1\n\0\0\0?", 14);
    g_autoptr(GError) error = NULL;
    g_autoptr(view) v = load_view(f.main, NULL, &error);
    g_assert_no_error(error);
    g_assert_cmpuint(v->scene->shapes->len, ==, 1);
    folder_remove(&f);
}

static float height_of(const scene *s)
{
    const shape *on = s->shapes->pdata[0];
    box3 b = on->kind->bounds(on->self);
    return b.high[2] - b.low[2];
}

/* The last directive of an included file goes on behind the Include, through the ends of
 * as many files as there are; an Import ends with its file. */
static void test_parameters_behind_an_include(void)
{
    scene_folder f = folder_new(WORLD "Include \"outer.pbrt\"\n\"float radius\" 3\n"
                                      "\"bool camera_visible\" false\n"
                                      "Import \"inner.pbrt\"\nShape \"disk\"\n");
    folder_write(&f, "outer.pbrt", "Include \"inner.pbrt\" # no more\n", -1);
    folder_write(&f, "inner.pbrt", "Shape \"sphere\" \"float zmax\" 1\n", -1);
    g_autoptr(GError) error = NULL;
    g_autoptr(view) v = load_view(f.main, NULL, &error);
    g_assert_no_error(error);
    g_assert_cmpuint(v->scene->shapes->len, ==, 3);
    g_assert_cmpfloat(fabsf(height_of(v->scene) - 4.0f), <, 1e-4f);
    folder_write(&f, "scene.pbrt",
                 WORLD "Import \"inner.pbrt\"\n\"float radius\" 3\nShape \"disk\"\n", -1);
    g_autoptr(view) wrong = load_view(f.main, NULL, &error);
    g_assert_null(wrong);
    g_assert_nonnull(strstr(error->message, "expected a directive, found"));
    folder_remove(&f);
}

/* What pbrt's paths from both ends are told beside their length: none changes the
 * picture. */
static void test_bidirectional_words(void)
{
    g_autoptr(view) v = read_saying(
        "Integrator \"bdpt\" \"bool visualizestrategies\" false\n"
        "\"bool visualizeweights\" true \"string lightsampler\" \"power\"\n" WORLD
        "Shape \"sphere\"\n",
        "note:2:30: 'lightsampler' of integrator 'bdpt' has no meaning here\n"
        "note:1:19: 'visualizestrategies' of integrator 'bdpt' has no meaning here\n"
        "note:2:1: 'visualizeweights' of integrator 'bdpt' has no meaning here\n"
        "note:1:12: integrator 'bdpt' becomes vcm with 16 passes of 4 samples a pixel "
        "and "
        "maxdepth 5, connections alone\n");
    g_assert_cmpuint(v->scene->shapes->len, ==, 1);
}

/* Where pbrt moves vertices, it is said that none moves. */
static void test_displaced_mesh(void)
{
    scene_folder f = folder_new(
        WORLD "Texture \"f\" \"float\" \"fbm\"\n"
              "Shape \"plymesh\" \"string filename\" \"m.ply\" \"texture displacement\" "
              "\"f\" \"float displacement.edgelength\" 0.1\n");
    folder_write(&f, "m.ply",
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                 "property float y\nproperty float z\nelement face 1\n"
                 "property list uchar int vertex_indices\nend_header\n"
                 "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
                 -1);
    g_autoptr(GString) lines = g_string_new(NULL);
    g_autoptr(GError) error = NULL;
    const log_sink sink = {keep_line, lines};
    g_autoptr(view) v = load_view(f.main, &sink, &error);
    g_assert_no_error(error);
    g_assert_cmpuint(v->scene->shapes->len, ==, 1);
    g_assert_cmpstr(
        lines->str, ==,
        "warning:6:43: 'displacement' of a mesh moves nothing: it stays as its "
        "file has it\n");
    folder_remove(&f);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/pbrt-real/anisotropy", test_anisotropy);
    g_test_add_func("/pbrt-real/behind-an-include", test_parameters_behind_an_include);
    g_test_add_func("/pbrt-real/bidirectional-words", test_bidirectional_words);
    g_test_add_func("/pbrt-real/displaced-mesh", test_displaced_mesh);
    g_test_add_func("/pbrt-real/flattened-meshes", test_flattened_meshes);
    g_test_add_func("/pbrt-real/flattened-rest", test_flattened_rest);
    g_test_add_func("/pbrt-real/transforms", test_transforms_that_do_nothing);
    g_test_add_func("/pbrt-real/lights", test_lights_that_can_not_be);
    g_test_add_func("/pbrt-real/sensors", test_sensors);
    g_test_add_func("/pbrt-real/warm-white", test_warm_white);
    g_test_add_func("/pbrt-real/spectral-film", test_spectral_film);
    g_test_add_func("/pbrt-real/crops", test_crops);
    g_test_add_func("/pbrt-real/no-camera", test_no_camera);
    g_test_add_func("/pbrt-real/realistic-camera", test_realistic_camera);
    g_test_add_func("/pbrt-real/names-given-later", test_names_given_later);
    g_test_add_func("/pbrt-real/later-is-the-same", test_later_is_the_same);
    g_test_add_func("/pbrt-real/bad-normals", test_bad_normals);
    g_test_add_func("/pbrt-real/curve-normals", test_curve_normals);
    return g_test_run();
}
