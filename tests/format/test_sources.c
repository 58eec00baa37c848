/*
 * Which files a scene was read from: those that the test wrote into a folder, all of
 * them, each once, for every way in which a format names another file.
 */
#include "nephroid/nephroid.h"

#include <glib/gstdio.h>
#include <string.h>

static const char camera[] = "LookAt 0 0 -2  0 0 0  0 1 0\n"
                             "Camera \"perspective\"\n"
                             "Film \"rgb\" \"integer xresolution\" 4 \"integer "
                             "yresolution\" 4\n";

static const char triangle_ply[] =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
    "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

static const char grey_pfm[] = "Pf\n1 1\n-1.0\n\0\0\0\x3f";

static const char profile_ies[] = "IESNA:LM-63-1995\nTILT=NONE\n"
                                  "1 -1 1 2 1 1 2 0 0 0\n1 1 10\n0 90\n0\n100 100\n";

static char *folder;

static void fill(void)
{
    folder = g_dir_make_tmp("nephroid-sources-XXXXXX", NULL);
    g_assert_nonnull(folder);
}

static void put(const char *name, const char *bytes, gssize size)
{
    g_autofree char *path = g_build_filename(folder, name, NULL);
    g_assert_true(g_file_set_contents(path, bytes, size, NULL));
}

static void empty(void)
{
    g_autoptr(GDir) dir = g_dir_open(folder, 0, NULL);
    for (const char *name; (name = g_dir_read_name(dir));) {
        g_autofree char *path = g_build_filename(folder, name, NULL);
        g_remove(path);
    }
    g_rmdir(folder);
    g_clear_pointer(&folder, g_free);
}

static void note(const char *path, void *data)
{
    g_ptr_array_add(data, g_strdup(path));
}

/* Every file of the folder was told, and found in the scene; `missing` was told, too. */
static void check(const char *main_name, const char *missing, bool loads)
{
    g_autoptr(GPtrArray) told = g_ptr_array_new_with_free_func(g_free);
    g_autofree char *path = g_build_filename(folder, main_name, NULL);
    const NephLoadOptions options = {.threads = 1, .file = note, .file_data = told};
    g_autoptr(GError) error = NULL;
    g_autoptr(NephScene) scene = neph_scene_load_with(path, &options, &error);
    if (loads)
        g_assert_no_error(error);
    else
        g_assert_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_INPUT);
    g_assert_cmpstr(told->pdata[0], ==, path);
    guint expected = missing ? 1 : 0;
    g_autoptr(GDir) dir = g_dir_open(folder, 0, NULL);
    for (const char *name = missing ? missing : g_dir_read_name(dir); name;
         name = g_dir_read_name(dir)) {
        g_autofree char *whole = g_build_filename(folder, name, NULL);
        g_test_message("%s", name);
        g_assert_true(g_ptr_array_find_with_equal_func(told, whole, g_str_equal, NULL));
        expected += name == missing ? 0 : 1;
    }
    g_assert_cmpuint(told->len, ==, expected);
    for (guint i = 0; scene && i < told->len; i++)
        g_assert_cmpstr(neph_scene_files(scene)[i], ==, told->pdata[i]);
    if (scene)
        g_assert_null(neph_scene_files(scene)[told->len]);
}

/* ---- pbrt ---- */

static void put_pbrt(const char *tail)
{
    g_autofree char *text = g_strconcat(
        camera,
        "WorldBegin\nInclude \"light.pbrt\"\nImport \"shapes.pbrt\"\n"
        "Texture \"again\" \"float\" \"imagemap\" \"string filename\" \"grey.pfm\"\n",
        tail, NULL);
    put("main.pbrt", text, -1);
    put("light.pbrt",
        "LightSource \"goniometric\" \"string filename\" \"lamp.ies\"\n"
        "LightSource \"infinite\" \"spectrum L\" \"white.spd\"\n",
        -1);
    put("shapes.pbrt",
        "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"grey.pfm\"\n"
        "Shape \"plymesh\" \"string filename\" \"triangle.ply\"\n",
        -1);
    put("lamp.ies", profile_ies, -1);
    put("white.spd", "400 1\n700 1\n", -1);
    put("grey.pfm", grey_pfm, sizeof grey_pfm - 1);
    put("triangle.ply", triangle_ply, -1);
}

static void test_pbrt(void)
{
    fill();
    put_pbrt("");
    check("main.pbrt", NULL, true);
    empty();
}

/* What breaks a scene is among its files, also what is not there. */
static void test_broken(void)
{
    fill();
    put_pbrt("Include \"late.pbrt\"\n");
    check("main.pbrt", "late.pbrt", false);
    put("late.pbrt", "Shape \"spere\"\n", -1);
    check("main.pbrt", NULL, false);
    put("late.pbrt", "Shape \"sphere\"\n", -1);
    check("main.pbrt", NULL, true);
    empty();
}

/* ---- Others ---- */

static void test_gltf(void)
{
    static const float corners[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    fill();
    put("model.gltf",
        "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"scene\":0,"
        "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":"
        "{\"POSITION\":0},\"material\":0}]}],"
        "\"materials\":[{\"emissiveTexture\":{\"index\":0},"
        "\"emissiveFactor\":[1,1,1]}],"
        "\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"grey.pfm\"}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
        "\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
        "\"buffers\":[{\"uri\":\"corners.bin\",\"byteLength\":36}]}",
        -1);
    put("corners.bin", (const char *)corners, sizeof corners);
    put("grey.pfm", grey_pfm, sizeof grey_pfm - 1);
    check("model.gltf", NULL, true);
    empty();
}

static void test_obj(void)
{
    fill();
    put("model.obj",
        "mtllib model.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl painted\n"
        "f 1/1 2/1 3/1\n",
        -1);
    put("model.mtl", "newmtl painted\nKd 1 1 1\nmap_Kd grey.pfm\n", -1);
    check("model.obj", "grey.pfm", true);
    put("grey.pfm", grey_pfm, sizeof grey_pfm - 1);
    check("model.obj", NULL, true);
    empty();
}

/* A name relative to the working folder is told in full. */
static void test_relative(void)
{
    fill();
    put("alone.ply", triangle_ply, -1);
    g_autofree char *before = g_get_current_dir();
    g_assert_cmpint(g_chdir(folder), ==, 0);
    g_autoptr(NephScene) scene = neph_scene_load("./alone.ply", 1, NULL, NULL, NULL);
    g_assert_cmpint(g_chdir(before), ==, 0);
    g_assert_nonnull(scene);
    g_autofree char *path = g_build_filename(folder, "alone.ply", NULL);
    g_assert_cmpstr(neph_scene_files(scene)[0], ==, path);
    g_assert_null(neph_scene_files(scene)[1]);
    empty();
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/sources/pbrt", test_pbrt);
    g_test_add_func("/sources/broken", test_broken);
    g_test_add_func("/sources/gltf", test_gltf);
    g_test_add_func("/sources/obj", test_obj);
    g_test_add_func("/sources/relative", test_relative);
    return g_test_run();
}
