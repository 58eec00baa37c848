/*
 * convert: a scene written as pbrt text and read again renders to the same image, to the
 * last bit, whatever it is made of.
 */
#include "format/convert/convert.h"
#include "rooms.h"

#include <string.h>

#define HOW "integrator=photonmap passes=1 spp=1 photons=3000 caustic_emission=uniform"

static void remove_tree(const char *path)
{
    g_autoptr(GDir) dir = g_dir_open(path, 0, NULL);
    for (const char *name; dir && (name = g_dir_read_name(dir));) {
        g_autofree char *inside = g_build_filename(path, name, NULL);
        remove_tree(inside);
    }
    g_remove(path);
}

static image *picture_of(const char *path)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(view) v = load_view(path, NULL, &error);
    g_assert_no_error(error);
    view_resize(v, 16, 12);
    return render_with(v, HOW);
}

static void check_same(const char *in)
{
    g_autofree char *folder = g_dir_make_tmp("nephroid-convert-XXXXXX", NULL);
    g_autofree char *out = g_build_filename(folder, "b.pbrt", NULL);
    g_autoptr(GError) error = NULL;
    g_assert_true(format_convert(in, out, NULL, &error));
    g_assert_no_error(error);
    g_autoptr(image) a = picture_of(in), b = picture_of(out);
    g_test_message("%s: mean %g", in, mean_of(a, ""));
    g_assert_cmpfloat(mean_of(a, ""), >, 0.0);
    g_assert_cmpmem(a->pixels, sizeof(float) * 16 * 12 * (size_t)a->n_channels, b->pixels,
                    sizeof(float) * 16 * 12 * (size_t)b->n_channels);
    remove_tree(folder);
}

static void check_text_with(const char *options, const char *world)
{
    g_autofree char *text = g_strdup_printf(
        "%s LookAt 0 -5 3  0 0 0.5  0 0 1 Film \"rgb\" \"float iso\" 150 \"string "
        "filename\" "
        "\"x.exr\" PixelFilter \"triangle\" \"float xradius\" 1.5\n"
        "Sampler \"independent\" \"integer seed\" 7\n"
        "Camera \"perspective\" \"float fov\" 42 \"float lensradius\" 0.01 \"float "
        "focaldistance\" 5\nWorldBegin\nLightSource \"point\" \"rgb I\" [9 8 7] \"point3 "
        "from\" [1 -2 4]\n%s",
        options, world);
    scene_folder f = folder_new(text);
    static const char *const names[] = {"R", "G", "B"};
    g_autoptr(image) img = image_new(4, 4, 3, names, NULL);
    for (int i = 0; i < 48; i++)
        img->pixels[i] = (float)(i * 7 % 11) / 11.0f;
    g_autofree char *picture = g_build_filename(f.path, "p.png", NULL);
    g_assert_true(image_write(img, picture, NULL, NULL));
    check_same(f.main);
    g_ptr_array_add(f.files, g_steal_pointer(&picture));
    folder_remove(&f);
}

static void check_text(const char *world)
{
    check_text_with("", world);
}

static void test_shapes(void)
{
    check_text(
        "Material \"diffuse\" \"rgb reflectance\" [.7 .2 .1] Rotate 30 1 2 3 Scale 1 "
        "1.5 -1\nShape \"sphere\" \"float radius\" 0.7\nAttributeBegin Translate 1 0 "
        "0 AreaLightSource \"diffuse\" ReverseOrientation Shape \"cylinder\" "
        "AttributeEnd\nShape \"disk\" \"float "
        "height\" -1 \"float radius\" 4 \"bool camera_visible\" true\n");
    check_text(
        "Translate 0.1 0.2 0.3 Rotate 20 0 0 1\n"
        "Shape \"trianglemesh\" \"point3 P\" [-3 -3 0 3 -3 0 3 3 0 -3 3 0] \"integer "
        "indices\" [0 1 2 0 2 3] \"vector3 S\" [1 0 0 1 0 0 1 1 0 1 0 0] \"point2 uv\" "
        "[0 0 1 0 1 1 0 1] \"normal N\" [0 0 1 0 .1 1 0 0 1 0 0 1] \"float alpha\" "
        "0.7\n");
}

static void test_materials(void)
{
    check_text(
        "MakeNamedMaterial \"a \\\"b\\\"\" \"string type\" \"conductor\" \"spectrum "
        "eta\" \"metal-Ag-eta\" \"spectrum k\" \"metal-Ag-k\" \"float roughness\" .1\n"
        "NamedMaterial \"a \\\"b\\\"\" Shape \"sphere\" \"float radius\" .8\n"
        "Material \"dielectric\" \"spectrum eta\" [300 1.6 900 1.5] Translate 2 0 0 "
        "Shape \"sphere\" \"float radius\" .6 Material \"interface\" Shape \"disk\"\n"
        "ColorSpace \"rec2020\" Material \"diffuse\" \"rgb reflectance\" [.2 .5 .1] "
        "Translate 0 0 -1 Shape \"disk\" \"float radius\" 5\n");
}

/* Each option changes the image, so that the same image tells that it was kept. */
static void test_options(void)
{
    check_text_with("Option \"bool disablepixeljitter\" true Option \"bool "
                    "disablewavelengthjitter\" true Option \"bool "
                    "disabletexturefiltering\" true",
                    "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" "
                    "\"p.png\" \"string filter\" \"trilinear\" \"float uscale\" 9\n"
                    "Material \"diffuse\" \"texture reflectance\" \"t\"\n"
                    "Shape \"disk\" \"float radius\" 3\n");
}

/* Attributes may say what a kind does not know. */
static void test_attributes(void)
{
    check_text("Attribute \"shape\" \"float alpha\" 0.5\n"
               "Attribute \"material\" \"bool remaproughness\" false\n"
               "Attribute \"light\" \"float scale\" 0.5\n"
               "Material \"diffuse\"\nShape \"disk\" \"float radius\" 3\n"
               "LightSource \"point\" \"point3 from\" [1 0 3]\n"
               "AttributeBegin\nAreaLightSource \"diffuse\"\nTranslate 0 0 3\n"
               "Shape \"sphere\" \"float radius\" 0.2\nAttributeEnd\n"
               "Material \"conductor\" \"float roughness\" 0.3\n"
               "Shape \"sphere\" \"float alpha\" 1\n");
}

static void test_textures_and_lights(void)
{
    check_text(
        "Translate .3 .2 0 Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" "
        "\"p.png\" \"float uscale\" 2\nTexture \"f\" \"float\" \"imagemap\" \"string "
        "filename\" \"p.png\" \"string mapping\" \"planar\"\n"
        "Material \"diffuse\" \"texture reflectance\" \"t\" \"string normalmap\" "
        "\"p.png\"\nShape \"disk\" \"float radius\" 3 \"texture alpha\" \"f\"\n"
        "LightSource \"infinite\" \"blackbody L\" 4000 \"float scale\" .01\n"
        "LightSource \"spot\" \"point3 from\" [2 2 3] \"string group\" \"key\"\n"
        "AreaLightSource \"diffuse\" \"rgb L\" [3 2 1] \"bool twosided\" true "
        "Translate 0 0 2 Shape \"sphere\" \"float radius\" .2\n");
}

static void test_media(void)
{
    check_text("Material \"dielectric\" \"rgb attenuationcolor\" [.2 .7 .4] \"float "
               "attenuationdistance\" 0.5\nShape \"sphere\"\n"
               "Material \"dielectric\" \"spectrum absorption\" [300 1 900 3]\n"
               "Shape \"sphere\" \"float radius\" 0.5\n"
               "Material \"diffuse\"\nTranslate 0 0 -1 Shape \"disk\" \"float radius\" "
               "9\n");
}

/* ---- Participating media: the same ones, and around the same things ---- */

/* Of media by their numbers in a medium_stack. */
static void append_names(GString *out, const char *what, const scene *s, uint32_t inside,
                         uint32_t outside)
{
    const medium *in = scene_medium(s, inside), *beyond = scene_medium(s, outside);
    g_string_append_printf(out, "%s %s|%s\n", what, in ? in->name : "",
                           beyond ? beyond->name : "");
}

static void append_medium(GString *out, const medium *m)
{
    g_string_append_printf(out, "%s %g %g\n", m->name, (double)m->scale, (double)m->g);
    for (float nm = 400.0f; nm <= 700.0f; nm += 50.0f)
        g_string_append_printf(out, " %.9g %.9g\n",
                               m->absorption ? (double)curve_at(m->absorption, nm) : 0.0,
                               m->scattering ? (double)curve_at(m->scattering, nm) : 0.0);
}

static char *media_of(const char *path)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(view) v = load_view(path, NULL, &error);
    g_assert_no_error(error);
    GString *out = g_string_new(NULL);
    append_names(out, "camera", v->scene, 0, v->camera.media.participating);
    for (guint i = 0; i < v->scene->media->len; i++)
        append_medium(out, v->scene->media->pdata[i]);
    for (guint i = 0; i < v->scene->shapes->len; i++) {
        const shape *one = v->scene->shapes->pdata[i];
        append_names(out, "shape", v->scene, one->media.inside, one->media.outside);
    }
    for (guint i = 0; i < v->scene->lights->len; i++)
        append_names(out, "light", v->scene, scene_light(v->scene, (int)i)->media.inside,
                     scene_light(v->scene, (int)i)->media.outside);
    return g_string_free(out, FALSE);
}

/* Single quotes stand for double ones. @return what the media are, in both scenes */
static char *check_media(const char *quoted)
{
    g_autofree char *text = g_strdelimit(g_strdup(quoted), "'", '"');
    g_autofree char *folder = g_dir_make_tmp("nephroid-convert-XXXXXX", NULL);
    g_autofree char *out = g_build_filename(folder, "b.pbrt", NULL);
    g_autoptr(GError) error = NULL;
    scene_folder f = folder_new(text);
    g_assert_true(format_convert(f.main, out, NULL, &error));
    g_assert_no_error(error);
    char *a = media_of(f.main);
    g_autofree char *b = media_of(out);
    g_assert_cmpstr(a, ==, b);
    remove_tree(folder);
    folder_remove(&f);
    return a;
}

static const char media_in_scopes[] =
    "MakeNamedMedium 'a b' 'string type' 'homogeneous' 'float g' 0.25\n"
    "  'spectrum sigma_a' [300 1 900 2]\n"
    "MediumInterface 'a b'\n"
    "LookAt 0 -5 3 0 0 0 0 0 1 Camera 'perspective' WorldBegin\n"
    "Shape 'sphere'\n"
    "MakeNamedMedium 'c' 'string type' 'homogeneous' 'string preset' 'Cream'\n"
    "  'float scale' 10\n"
    "AttributeBegin MediumInterface 'c' '' Shape 'sphere' LightSource 'point'\n"
    "AttributeEnd LightSource 'point'\n"
    "ColorSpace 'rec2020'\n"
    "MakeNamedMedium 'd' 'string type' 'homogeneous' 'rgb sigma_s' [1 .1 .2]\n"
    "MakeNamedMedium 'e' 'string type' 'homogeneous' 'rgb sigma_a' [.1 1 .2]\n"
    "ColorSpace 'srgb'\n"
    "MakeNamedMedium 'f' 'string type' 'homogeneous' 'rgb sigma_a' [.1 1 .2]\n"
    "MediumInterface 'c' 'd' LightSource 'infinite'\n"
    "AreaLightSource 'diffuse' Shape 'sphere'\n";

static void test_participating_media(void)
{
    g_autofree char *all = check_media(media_in_scopes);
    g_assert_nonnull(strstr(all, "camera |a b\n"));
    g_assert_nonnull(strstr(all, "shape c|\n"));
    g_assert_nonnull(strstr(all, "light c|d\n"));
    g_autofree char *moving = check_media(
        "Camera 'perspective' WorldBegin LightSource 'point'\n"
        "MakeNamedMedium 'a' 'string type' 'homogeneous' MediumInterface '' 'a'\n"
        "ActiveTransform EndTime Translate 1 0 0 Shape 'sphere'\n");
    g_assert_nonnull(strstr(moving, "camera |\n"));
    g_assert_nonnull(strstr(moving, "shape |a\n"));
}

/* ObjectEnd takes back what an object says, though all that is told after it is alike. */
static void test_media_of_objects(void)
{
    g_autofree char *all =
        check_media("Camera 'perspective' WorldBegin LightSource 'point'\n"
                    "MakeNamedMedium 'a' 'string type' 'homogeneous'\n"
                    "ObjectBegin 'o' MediumInterface 'a' Shape 'sphere' ObjectEnd\n"
                    "MediumInterface 'a' Shape 'sphere' ObjectInstance 'o'\n"
                    "MediumInterface '' Shape 'sphere'\n");
    g_assert_nonnull(strstr(all, "shape a|a\nshape a|a\nshape |\n"));
}

static void test_defaults_of_media(void)
{
    g_autofree char *all = check_media(
        "Camera 'perspective'\n"
        "Attribute 'medium' 'float g' 0.5 'float density' 7 'float sigma_a' 4\n"
        "WorldBegin LightSource 'point' Shape 'sphere'\n"
        "MakeNamedMedium 'a' 'string type' 'homogeneous' 'string preset' 'Cream'\n"
        "AttributeBegin Attribute 'medium' 'float scale' 2\n"
        "MakeNamedMedium 'b' 'string type' 'homogeneous' AttributeEnd\n"
        "MakeNamedMedium 'c' 'string type' 'homogeneous' 'float g' 0\n");
    g_assert_nonnull(strstr(all, "b 2 0.5\n 4 1\n"));
    g_assert_nonnull(strstr(all, "c 1 0\n 4 1\n"));
}

/* The picture is the same, too. */
static void test_foggy_picture(void)
{
    check_text_with("MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"float "
                    "scale\" 0.05 MediumInterface \"\" \"fog\"",
                    "MakeNamedMedium \"ink\" \"string type\" \"homogeneous\" \"rgb "
                    "sigma_a\" [3 2 1]\nMediumInterface \"\" \"fog\"\nMaterial "
                    "\"diffuse\" Shape \"disk\" \"float radius\" 3\nMediumInterface "
                    "\"ink\" \"fog\" Material \"interface\" Shape \"sphere\"\n");
}

static void test_objects_and_motion(void)
{
    check_text(
        "Material \"diffuse\" \"rgb reflectance\" [.7 .5 .1]\n"
        "ObjectBegin \"o\" Material \"conductor\" Translate 0 0 .5 Shape \"sphere\" "
        "\"float radius\" .3 ObjectEnd\nShape \"disk\" \"float radius\" 4\n"
        "AttributeBegin Translate -1 0 0 Scale 1 1 2 ObjectInstance \"o\" "
        "AttributeEnd\nTranslate 1 0 0 Rotate 20 0 1 0 ObjectInstance \"o\"\n");
    check_text(
        "Shape \"disk\" \"float radius\" 4\nActiveTransform EndTime Translate .5 0 0 "
        "Rotate 30 0 0 1 ActiveTransform All Shape \"sphere\" \"float radius\" .6\n");
    scene_folder f = folder_new(
        "LookAt 0 -5 3  0 0 0.5  0 0 1 ActiveTransform EndTime Translate 0.3 0 0 "
        "ActiveTransform All TransformTimes 0 0.5 Camera \"perspective\" WorldBegin "
        "LightSource \"point\" \"point3 from\" [0 0 3] Shape \"sphere\"\n");
    check_same(f.main);
    folder_remove(&f);
}

static void test_files(void)
{
    static const char ply[] =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
        "property float y\nproperty float z\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n"
        "-3 -3 0\n3 -3 0\n3 3 0\n-3 3 0.5\n4 0 1 2 3\n";
    scene_folder f = folder_new("");
    folder_write(&f, "a.ply", ply, -1);
    g_autofree char *path = g_build_filename(f.path, "a.ply", NULL);
    check_same(path); /* with the sky and the camera it gets */
    folder_remove(&f);
    check_same(SOURCE_ROOT "/scenes/glass-ball/glass-ball.pbrt");
    check_same(SOURCE_ROOT "/scenes/cobblers-globe/cobblers-globe.pbrt");
}

/* Media, maps with transforms, embedded images, lamps; repeated nodes are in gltf-maps.
 */
static void test_shared(void)
{
    static const char *const names[] = {"EmissiveStrengthTest", "AttenuationTest",
                                        "GlassHurricaneCandleHolder",
                                        "LightsPunctualLamp"};
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        g_autofree char *path = g_strdup_printf(
            SOURCE_ROOT "/../shared/data/gltf/%s/glTF/%s.gltf", names[i], names[i]);
        if (!g_file_test(path, G_FILE_TEST_EXISTS)) {
            g_test_skip("no ../shared/data/gltf");
            return;
        }
        check_same(path);
    }
}

/* Maps by second coordinates, colours of vertices and instances, from Debian's package of
   assimp's models. */
static void test_models(void)
{
    static const char *const names[] = {"textureTransform/TextureTransformTest.gltf",
                                        "2CylinderEngine-glTF-Binary/2CylinderEngine.glb",
                                        "BoxTexcoords-glTF/boxTexcoords.gltf",
                                        "ClearCoat-glTF/ClearCoatTest.gltf"};
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        g_autofree char *path =
            g_strdup_printf("/usr/share/assimp/models/glTF2/%s", names[i]);
        if (!g_file_test(path, G_FILE_TEST_EXISTS)) {
            g_test_skip("no package assimp-testmodels");
            return;
        }
        check_same(path);
    }
}

static void refuse(const char *in, const char *out, const char *message)
{
    g_autoptr(GError) error = NULL;
    g_assert_false(format_convert(in, out, NULL, &error));
    if (!strstr(error->message, message))
        g_error("%s does not say %s", error->message, message);
}

static void test_refused(void)
{
    const char *in = SOURCE_ROOT "/scenes/ring/ring.pbrt";
    refuse(in, "/tmp/a.obj", "expected a name that ends in .pbrt");
    refuse(in, "/nowhere/a.pbrt", "/nowhere/a.pbrt");
    refuse("/nowhere/b.pbrt", "/tmp/nephroid-none.pbrt", "No such file");
    g_assert_false(g_file_test("/tmp/nephroid-none.pbrt", G_FILE_TEST_EXISTS));
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/convert/shapes", test_shapes);
    g_test_add_func("/convert/materials", test_materials);
    g_test_add_func("/convert/textures-and-lights", test_textures_and_lights);
    g_test_add_func("/convert/options", test_options);
    g_test_add_func("/convert/attributes", test_attributes);
    g_test_add_func("/convert/objects-and-motion", test_objects_and_motion);
    g_test_add_func("/convert/media", test_media);
    g_test_add_func("/convert/participating-media", test_participating_media);
    g_test_add_func("/convert/media-of-objects", test_media_of_objects);
    g_test_add_func("/convert/defaults-of-media", test_defaults_of_media);
    g_test_add_func("/convert/foggy-picture", test_foggy_picture);
    g_test_add_func("/convert/files", test_files);
    g_test_add_func("/convert/shared", test_shared);
    g_test_add_func("/convert/models", test_models);
    g_test_add_func("/convert/refused", test_refused);
    return g_test_run();
}
