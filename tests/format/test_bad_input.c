/*
 * bad input: each mistake is told with its file, line and column, what was expected and
 * what was found; no input whatever may crash.
 */
#include "refused_scene.h"

#include "base/memory.h"

#define CAMERA "Camera \"perspective\"\n"
#define LIGHT "LightSource \"point\"\n"
#define WORLD CAMERA "WorldBegin\n" LIGHT /* three lines */

static void test_files(void)
{
    g_autoptr(GError) missing = NULL, unknown = NULL, folder = NULL;
    g_assert_null(format_load("/nowhere/a.pbrt", 1, NULL, &missing));
    g_assert_cmpstr(missing->message, ==,
                    "/nowhere/a.pbrt: cannot open '/nowhere/a.pbrt': No such file or "
                    "directory");
    g_assert_null(format_load("/nowhere/a.scene", 1, NULL, &unknown));
    g_assert_true(g_str_has_prefix(unknown->message,
                                   "/nowhere/a.scene: expected a scene file: pbrt"));
    g_assert_true(strstr(unknown->message, ", found .scene; Blender") != NULL);
    scene_folder f = folder_new("");
    g_autofree char *name = g_build_filename(f.path, "x.pbrt", NULL);
    g_mkdir(name, 0700);
    g_assert_null(format_load(name, 1, NULL, &folder));
    g_autofree char *want =
        g_strdup_printf("%s: expected a file, found '%s', which is none", name, name);
    g_assert_cmpstr(folder->message, ==, want);
    g_rmdir(name);
    folder_remove(&f);
}

static void test_grammar(void)
{
    refuse(WORLD "Sphere \"x\" 1 2\n", "%s:4:1: expected a directive, found 'Sphere'");
    refuse(WORLD "Shape sphere\n", "%s:4:7: expected a kind in quotes, found 'sphere'");
    refuse(WORLD "Shape \"sphere\n",
           "%s:4:7: expected a kind in quotes, found a string without its closing quote");
    refuse(WORLD "Shape \"sphere\" \"float radius 2\n",
           "%s:4:16: expected a parameter or a directive, found a string without its "
           "closing quote");
    refuse(WORLD "Shape \"sphere\" [2]\n",
           "%s:4:16: expected a parameter or a directive, found '['");
    refuse(WORLD "Shape \"sphere\" \"radius\" 2\n",
           "%s:4:16: expected \"type name\", found \"radius\"");
    refuse(WORLD "Shape \"sphere\" \"color radius\" 2\n",
           "%s:4:16: expected a parameter type (float, integer, bool, string, point2, "
           "vector2, point3, vector3, normal, rgb, blackbody, spectrum, texture), found "
           "'color'");
    refuse(WORLD "Shape \"sphere\" \"float radius\" []\n",
           "%s:4:32: parameter 'radius': expected a value, found ']'");
    refuse(WORLD "Shape \"sphere\" \"float radius\"",
           "%s:4:30: parameter 'radius': expected a number, found the end of the file");
    refuse(WORLD "Shape \"sphere\" \"float radius\" [ 1 2\n",
           "%s:5:1: parameter 'radius': expected a number, found the end of the file");
    refuse(WORLD "Translate 1 2\nShape \"sphere\"\n",
           "%s:5:1: expected a number, found 'Shape'");
    refuse(WORLD "Transform 1 2\n", "%s:4:11: expected '[', found '1'");
}

static void test_values(void)
{
    refuse(WORLD "Shape \"sphere\" \"float radius\" \"2\"\n",
           "%s:4:31: parameter 'radius': expected a number, found \"2\"");
    refuse(WORLD "Shape \"sphere\" \"float radius\" nan\n",
           "%s:4:31: parameter 'radius': expected a number, found 'nan'");
    refuse(WORLD "Shape \"sphere\" \"float radius\" 1e99\n",
           "%s:4:31: parameter 'radius': expected a number, found '1e99'");
    refuse(WORLD "Shape \"trianglemesh\" \"integer indices\" [0 1.x 2]\n",
           "%s:4:43: parameter 'indices': expected a whole number, found '1.x'");
    refuse(WORLD "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1]\n",
           "%s:4:22: parameter 'P': expected a multiple of 3 numbers, found 4");
    refuse(WORLD "AreaLightSource \"diffuse\" \"bool twosided\" \"true\"\n",
           "%s:4:43: parameter 'twosided': expected true or false, found \"true\"");
    refuse(WORLD "Material \"diffuse\" \"spectrum reflectance\" \"nowhere.spd\"\n",
           "%s:4:20: parameter 'reflectance': expected a spectrum's name or file, found "
           "\"nowhere.spd\"");
}

static void test_kinds_and_parameters(void)
{
    refuse(WORLD "Shape \"sphere\" \"integer radius\" 2\n",
           "%s:4:16: parameter 'radius': expected float, found integer");
    refuse(WORLD "Shape \"sphere\" \"float radious\" 2\n",
           "%s:4:16: unknown parameter 'radious' of shape \"sphere\"");
    refuse(WORLD "Shape \"sphere\" \"texture alpha\" \"leaf\"\n",
           "%s:4:16: parameter 'alpha': there is no float texture 'leaf'");
    refuse(WORLD "Shape \"blob\" \"float radius\" 2\n",
           "%s:4:1: expected a shape of kind plymesh, trianglemesh, sphere, disk, "
           "cylinder, bilinearmesh, loopsubdiv, curve, found 'blob'");
    refuse("Option \"seed\" many\n" WORLD,
           "%s:1:8: expected a value for option 'seed', found 'many'");
    refuse("Option \"seed\" [\n" WORLD, "%s:1:15: expected a value, found '['");
    refuse(WORLD "LightSource \"\"\n",
           "%s:4:1: expected a light source of kind point, spot, distant, goniometric, "
           "projection, infinite, found ''");
    refuse(WORLD "AreaLightSource \"sparkle\"\n",
           "%s:4:17: expected AreaLightSource \"diffuse\", found \"sparkle\"");
    refuse(WORLD "Texture \"t\" \"rgb\" \"constant\"\n",
           "%s:4:13: expected \"float\" or \"spectrum\", found \"rgb\"");
    refuse(WORLD "NamedMaterial \"gold\"\n",
           "%s:4:15: expected the name of a material, found \"gold\"");
    refuse(WORLD "MakeNamedMaterial \"gold\"\n",
           "%s:4:19: expected \"string type\" of material 'gold', found none");
    refuse(WORLD "MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\n"
                 "MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\n",
           "%s:5:19: expected a new material's name, found \"a\" again");
    refuse(WORLD "Material \"interface\" \"float eta\" 1\n",
           "%s:4:22: unknown parameter 'eta' of material \"interface\"");
    refuse(WORLD "Attribute \"shapes\" \"float radius\" 1\n",
           "%s:4:11: expected \"shape\", \"light\", \"material\", \"medium\" or "
           "\"texture\", "
           "found \"shapes\"");
}

static void test_what_is_not_supported(void)
{
    refuse(WORLD "ObjectBegin \"leaf\"\nObjectBegin \"twig\"\nObjectEnd\n"
                 "ObjectInstance \"tree\"\nObjectBegin \"leaf\"\n",
           "%s:5:1: expected ObjectEnd before another ObjectBegin\n"
           "%s:8:13: object \"leaf\" is there already\n"
           "%s:7:16: expected the name of an object, found \"tree\"");
    refuse(WORLD "ObjectBegin \"lamp\"\nAreaLightSource \"diffuse\"\nShape \"sphere\"\n"
                 "ObjectInstance \"lamp\"\n",
           "%s:7:1: expected ObjectEnd before ObjectInstance, found none\n"
           "%s:4:1: expected AttributeEnd for this AttributeBegin, found the end of the "
           "file\n"
           "%s:4:1: expected ObjectEnd for this ObjectBegin, found the end of the file");
    refuse("TransformTimes 1 1\n" WORLD "ActiveTransform EndTime Scale 2 2 2\n"
           "LightSource \"point\"\nActiveTransform Never\n",
           "%s:1:1: expected a start time before the end time, found TransformTimes 1 1\n"
           "%s:7:17: expected All, StartTime or EndTime, found 'Never'");
    refuse("Option \"bool disabletexturefiltering\" false \"bool forcediffuse\" "
           "true\n" WORLD,
           "%s:1:45: option 'forcediffuse' is not supported");
}

static void test_transforms(void)
{
    refuse("Scale 1 0 1\n" WORLD,
           "%s:2:1: expected a transform that can be inverted, found one that flattens");
    refuse(WORLD "LookAt 0 0 0  0 0 0  0 1 0\n",
           "%s:4:1: expected an eye apart from the target and an up direction across the "
           "view, found neither or one of them missing");
    refuse(WORLD "Scale 1e-200 1 1 Scale 1e-200 1 1\n",
           "%s:4:18: expected a transform of finite numbers, found one out of range");
}

static void test_order(void)
{
    refuse("", "%s:1:1: expected WorldBegin, found the end of the file");
    refuse(CAMERA "Shape \"sphere\"\nWorldBegin\n" LIGHT,
           "%s:2:1: expected WorldBegin before Shape, found none");
    refuse(WORLD CAMERA, "%s:4:1: expected Camera before WorldBegin, found it after");
    refuse(WORLD "AttributeBegin\n",
           "%s:4:1: expected AttributeEnd for this AttributeBegin, found the end of the "
           "file");
    refuse(WORLD "ObjectEnd\n",
           "%s:4:1: expected ObjectBegin before ObjectEnd, found none");
}

/* All that are registered are named; "path" is pbrt's word. */
static void test_unknown_integrator(void)
{
    g_autoptr(GString) ours = g_string_new(NULL);
    const char *const *words = settings_find("integrator")->words;
    for (int k = 0; k < N_INTEGRATORS; k++)
        if (k != INTEGRATOR_PATH)
            g_string_append_printf(ours, "%s\"%s\"", ours->len ? ", " : "", words[k]);
    g_autofree char *want = g_strdup_printf(
        "%%s:1:12: expected Integrator %s or one of pbrt's (sppm, path, volpath, "
        "simplepath, simplevolpath, randomwalk, lightpath, bdpt, mlt), found \"ao\"",
        ours->str);
    refuse("Integrator \"ao\"\n" WORLD, want);
}

static void test_options(void)
{
    refuse("Integrator \"photonmap\" \"integer pases\" 3\n" WORLD,
           "%s:1:24: unknown parameter 'pases' of Integrator \"photonmap\"");
    refuse("Integrator \"photonmap\" \"integer passes\" -1\n" WORLD,
           "%s:1:24: setting 'passes': expected a number from 0 to 1000000000, found "
           "'-1'");
    refuse("Integrator \"photonmap\" \"float radius\" [1 2]\n" WORLD,
           "%s:1:24: parameter 'radius': expected one value, found 2");
    refuse("Camera \"perspective\"\nWorldBegin\nLightSource \"point\" \"string group\" "
           "\"a.b\"\n",
           "%s:3:21: parameter 'group': expected letters, digits, _ and -, found "
           "\"a.b\"");
    refuse("Integrator \"path\" \"integer maxdepht\" 3\n" WORLD,
           "%s:1:19: unknown parameter 'maxdepht' of Integrator \"path\"");
    refuse("Sampler \"random\"\n" WORLD,
           "%s:1:9: expected one of halton, sobol, zsobol, paddedsobol, independent, "
           "stratified, pmj02bn, found \"random\"");
    refuse("Sampler \"sobol\" \"integer pixelsamples\" 0\n" WORLD,
           "%s:1:17: parameter 'pixelsamples': expected a number > 0, found 0");
    refuse("Accelerator \"octree\"\n" WORLD,
           "%s:1:13: expected Accelerator \"bvh\" or \"kdtree\", found \"octree\"");
}

static void test_includes(void)
{
    scene_folder f = folder_new(WORLD "Include \"a.pbrt\"\n");
    folder_write(&f, "a.pbrt", "# nothing\n  Include \"b.pbrt\"", -1);
    folder_write(&f, "b.pbrt", "Include \"a.pbrt\" Wurst Include \"c.pbrt\"", -1);
    g_autoptr(GError) error = NULL;
    g_assert_null(format_load(f.main, 1, NULL, &error));
    g_autofree char *want = g_strdup_printf(
        "%s/b.pbrt:1:9: expected a file that is not being read, found \"a.pbrt\"\n"
        "%s/b.pbrt:1:18: expected a directive, found 'Wurst'\n"
        "%s/b.pbrt:1:32: cannot open '%s/c.pbrt': No such file or directory",
        f.path, f.path, f.path, f.path);
    g_assert_cmpstr(error->message, ==, want);
    folder_remove(&f);
}

static void test_errors_are_collected(void)
{
    refuse(CAMERA "WorldBegin\nShape \"sphere\" \"float radius\" x\nTranslate a\n"
                  "Material \"diffuse\"\n" LIGHT "LookAt 0 0 0 0 0 0 0 1 0\n",
           "%s:3:31: parameter 'radius': expected a number, found 'x'\n"
           "%s:4:11: expected a number, found 'a'\n"
           "%s:7:1: expected an eye apart from the target and an up direction across the "
           "view, found neither or one of them missing");
    g_autoptr(GString) text = g_string_new(WORLD), want = g_string_new(NULL);
    for (int i = 0; i < 30; i++)
        g_string_append(text, "Wurst Identity\n");
    for (int i = 0; i < 20; i++)
        g_string_append_printf(want, "%s%%s:%d:1: expected a directive, found 'Wurst'",
                               i ? "\n" : "", i + 4);
    refuse(text->str, want->str);
}

static void test_geometry(void)
{
    refuse(CAMERA "WorldBegin\nAreaLightSource \"diffuse\"\n"
                  "Shape \"trianglemesh\" \"point3 P\" [0 0 0  1 0 0  2 0 0]\n",
           "%s:4:1: a shape that shines must have an area");
    refuse(WORLD "Shape \"sphere\" \"float radius\" -1\n",
           "%s:4:16: the sphere's radius must be positive, found -1");
    refuse(WORLD "Scale 1e30 1e30 1e30 Shape \"sphere\" \"float radius\" 1e30\n",
           "%s:4:22: the shape has no area (or an infinite one)");
}

static void test_sizes(void)
{
    refuse("Film \"rgb\" \"integer xresolution\" 0\n" WORLD,
           "%s:1:12: xresolution must be 1..65536 pixels, found 0");
    refuse("Film \"rgb\" \"integer yresolution\" 2000000000\n" WORLD,
           "%s:1:12: yresolution must be 1..65536 pixels, found 2000000000");
    refuse("Sampler \"sobol\" \"integer pixelsamples\" 2000000000\n"
           "Integrator \"photonmap\"\n" WORLD,
           "%s:1:17: setting 'spp': expected a whole number from 1 to 65536 "
           "samples/pixel, found '2000000000'");
    refuse(
        "Integrator \"sppm\" \"integer maxdepth\" -3\n" WORLD,
        "%s:1:19: setting 'maxdepth': expected a whole number from 0 to 1000000, found "
        "'-3'");
}

/* ---- Meshes in files ---- */

#define PLY_HEAD                                                                         \
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"      \
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"         \
    "end_header\n"

/** A scene whose only shape is a mesh of that text; the error comes after the place. */
static void refuse_mesh(const char *ply, const char *message)
{
    scene_folder f =
        folder_new(WORLD "Shape \"plymesh\" \"string filename\" \"a.ply\"\n");
    g_autoptr(GError) error = NULL;
    if (ply)
        folder_write(&f, "a.ply", ply, -1);
    g_assert_null(format_load(f.main, 1, NULL, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_autofree char *path = g_build_filename(f.path, "a.ply", NULL);
    g_auto(GStrv) parts = g_strsplit(message, "%s", -1);
    g_autofree char *told = g_strjoinv(path, parts);
    g_autofree char *want = g_strdup_printf("%s:4:17: %s", f.main, told);
    g_assert_cmpstr(error->message, ==, want);
    folder_remove(&f);
}

static void test_meshes(void)
{
    refuse(WORLD "Shape \"plymesh\"\n",
           "%s:4:1: plymesh: expected \"string filename\", found none");
    refuse_mesh(NULL, "cannot open '%s': No such file or directory");
    refuse_mesh("solid\n", "%s:1:1: expected 'ply' on the first line, found something "
                           "else");
    refuse_mesh(PLY_HEAD "0 0 0\n1 0 0\n0 1",
                "%s: expected 3 elements 'vertex', found the end of the file after at "
                "most 2");
    refuse_mesh(PLY_HEAD "0 0 0\n1 0 0\n0 1 0\n3 0 1",
                "%s:13:6: expected a number, found the end of the file");
    refuse_mesh(PLY_HEAD "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n",
                "%s: expected finite numbers, found y = nan of vertex 1");
    refuse_mesh(PLY_HEAD "0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n",
                "%s:13:8: expected a vertex from 0 to 2, found 7");
}

/* ---- Anything at all ---- */

static const char good[] =
    "# a scene with some of everything\n"
    "Option \"integer seed\" 3\nColorSpace \"srgb\"\n"
    "Integrator \"photonmap\" \"integer passes\" 2 \"float radius\" 0.1\n"
    "Sampler \"sobol\" \"integer pixelsamples\" 4\nAccelerator \"bvh\"\n"
    "PixelFilter \"box\" \"float xradius\" 0.5\n"
    "Film \"rgb\" \"integer xresolution\" [16] \"integer yresolution\" 16\n"
    "LookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n"
    "WorldBegin\nTransform [1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1]\n"
    "CoordinateSystem \"a\"\nTranslate 1 2 3 Rotate 30 0 1 0 Scale 1 2 1\n"
    "ConcatTransform [1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1] CoordSysTransform \"a\"\n"
    "Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [.1 .2 .3]\n"
    "MakeNamedMaterial \"m\" \"string type\" \"diffuse\" \"texture reflectance\" \"t\"\n"
    "AttributeBegin\n  AreaLightSource \"diffuse\" \"blackbody L\" 3000\n"
    "  Attribute \"shape\" \"float radius\" 2\n  Shape \"sphere\"\nAttributeEnd\n"
    "LightSource \"infinite\" \"spectrum L\" [400 1 700 2]\n"
    "LightSource \"point\" \"point3 from\" [1 2 3]\n"
    "NamedMaterial \"m\" ReverseOrientation\nShape \"disk\" \"float height\" 1e-1\n"
    "Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"float roughness\" 0.1\n"
    "Shape \"cylinder\" \"float zmax\" 2\nMaterial \"dielectric\" \"float eta\" 1.4\n"
    "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]\n"
    "  \"integer indices\" [0 1 2 1 2 3] \"normal N\" [0 0 1 0 0 1 0 0 1 0 0 1]\n"
    "  \"point2 uv\" [0 0 1 0 0 1 1 1]\nMediumInterface \"\" \"\"\n";

/** Changes a few bytes: another character, a piece left out, or a piece twice. */
static void spoil(GString *text, GRand *random)
{
    static const char letters[] = "\"[]# \n\\-+.e0123456789infa\xff\x01";
    int n = g_rand_int_range(random, 1, 5);
    for (int i = 0; i < n && text->len > 20; i++) {
        gssize at = g_rand_int_range(random, 0, (gint32)text->len - 16);
        gssize length = g_rand_int_range(random, 1, 16);
        int how = g_rand_int_range(random, 0, 3);
        if (how == 0)
            text->str[at] = letters[g_rand_int_range(random, 0, sizeof letters - 1)];
        else if (how == 1)
            g_string_erase(text, at, length);
        else {
            g_autofree char *piece = g_strndup(text->str + at, (gsize)length);
            g_string_insert_len(text, g_rand_int_range(random, 0, (gint32)text->len),
                                piece, -1);
        }
    }
}

static void test_garbage(void)
{
    g_autoptr(GRand) random = g_rand_new_with_seed(2024);
    scene_folder f = folder_new(good);
    int n_loaded = 0;
    for (int i = 0; i < 300; i++) {
        g_autoptr(GString) text = g_string_new(good);
        if (i > 0)
            spoil(text, random);
        g_assert_true(g_file_set_contents_full(f.main, text->str, (gssize)text->len,
                                               G_FILE_SET_CONTENTS_NONE, 0600, NULL));
        g_autoptr(GError) error = NULL;
        g_autoptr(scene) s = format_load(f.main, 1, NULL, &error);
        g_assert_true((s != NULL) == (error == NULL));
        if (error && !g_str_has_prefix(error->message, f.main))
            g_error("'%s' names no place, of\n%s", error->message, text->str);
        g_assert_true(s || i > 0);
        n_loaded += s != NULL;
    }
    g_assert_cmpint(n_loaded, <, 150);
    folder_remove(&f);
}

/* Every allocation in turn is refused: told as such, or done without. */
static void test_memory_that_is_refused(void)
{
    scene_folder f = folder_new(good);
    unsigned n = 1;
    for (bool loaded = false; !loaded; n++) {
        g_autoptr(GError) error = NULL;
        big_alloc_fail_at(n);
        g_autoptr(scene) s = format_load(f.main, 1, NULL, &error);
        loaded = s != NULL;
        if (!loaded)
            g_assert_error(error, NEPH_ERROR, ERROR_FAILED);
    }
    big_alloc_fail_at(0);
    g_assert_cmpuint(n, >, 20);
    folder_remove(&f);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/bad-input/files", test_files);
    g_test_add_func("/bad-input/grammar", test_grammar);
    g_test_add_func("/bad-input/values", test_values);
    g_test_add_func("/bad-input/kinds-and-parameters", test_kinds_and_parameters);
    g_test_add_func("/bad-input/what-is-not-supported", test_what_is_not_supported);
    g_test_add_func("/bad-input/transforms", test_transforms);
    g_test_add_func("/bad-input/order", test_order);
    g_test_add_func("/bad-input/options", test_options);
    g_test_add_func("/bad-input/unknown-integrator", test_unknown_integrator);
    g_test_add_func("/bad-input/includes", test_includes);
    g_test_add_func("/bad-input/errors-are-collected", test_errors_are_collected);
    g_test_add_func("/bad-input/geometry", test_geometry);
    g_test_add_func("/bad-input/sizes", test_sizes);
    g_test_add_func("/bad-input/meshes", test_meshes);
    g_test_add_func("/bad-input/garbage", test_garbage);
    g_test_add_func("/bad-input/memory-that-is-refused", test_memory_that_is_refused);
    return g_test_run();
}
