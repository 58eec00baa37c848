/*
 * base/input: files are read whole and stay as they were read; whatever a scene names, a
 * pipe, a device and a folder are refused and never waited for.
 */
#include "base/input.h"

#include "gltf_text.h"
#include "image/image.h"
#include "nephroid/nephroid.h"
#include "settings/settings.h"

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

enum { PATIENCE = 20 }; /* s: who waits for a pipe is ended by the alarm */

#define WORLD                                                                            \
    "Camera \"perspective\"\nWorldBegin\nLightSource \"point\"\n"                        \
    "Shape \"sphere\"\n"

/* What stands in a scene in place of '%', all in one scene.pbrt. */
static const char *const namings[] = {
    "Include \"%\"\n",
    "Import \"%\"\n",
    "Shape \"plymesh\" \"string filename\" \"%\"\n",
    "Material \"diffuse\" \"spectrum reflectance\" \"%\"\n",
    "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"%\"\n",
    "Texture \"t\" \"float\" \"gltf\" \"string filename\" \"%\"\n",
    "LightSource \"infinite\" \"string filename\" \"%\"\n",
    "LightSource \"goniometric\" \"string filename\" \"%\"\n",
    "LightSource \"projection\" \"string filename\" \"%\"\n",
    "Material \"diffuse\" \"string normalmap\" \"%\"\n",
};

static void assert_unread(scene *s, const GError *error, const char *what)
{
    if (s || !strstr(error->message, "which is none"))
        g_error("%s\n%s", what, s ? "was read" : error->message);
}

/* Names of what is no file, those ending as files do which are known by their names. */
static void refuse_named(const scene_folder *f, const char *target)
{
    for (size_t i = 0; i < G_N_ELEMENTS(namings); i++) {
        g_auto(GStrv) parts = g_strsplit(namings[i], "%", -1);
        g_autofree char *line = g_strjoinv(target, parts);
        g_autofree char *text = g_strconcat(WORLD, line, NULL);
        g_autoptr(GError) error = NULL;
        g_assert_true(g_file_set_contents(f->main, text, -1, NULL));
        g_autoptr(scene) s = format_load(f->main, 1, NULL, &error);
        assert_unread(s, error, line);
    }
}

static scene_folder folder_with_pipe(const char *name, char **pipe)
{
    scene_folder f = folder_new("");
    *pipe = g_build_filename(f.path, name, NULL);
    g_assert_cmpint(mkfifo(*pipe, 0600), ==, 0);
    g_ptr_array_add(f.files, g_strdup(*pipe));
    return f;
}

static void test_named(void)
{
    g_autofree char *pipe = NULL;
    scene_folder f = folder_with_pipe("pipe", &pipe);
    alarm(PATIENCE);
    refuse_named(&f, pipe);
    refuse_named(&f, "/dev/zero");
    refuse_named(&f, f.path);
    alarm(0);
    folder_remove(&f);
}

static void test_profile(void)
{
    g_autofree char *pipe = NULL;
    scene_folder f = folder_with_pipe("pipe.ies", &pipe);
    g_autofree char *text = g_strdup_printf(
        WORLD "LightSource \"goniometric\" \"string filename\" \"%s\"\n", pipe);
    g_autoptr(GError) error = NULL;
    g_assert_true(g_file_set_contents(f.main, text, -1, NULL));
    alarm(PATIENCE);
    g_autoptr(scene) s = format_load(f.main, 1, NULL, &error);
    assert_unread(s, error, text);
    alarm(0);
    folder_remove(&f);
}

static void test_scenes(void)
{
    static const char *const names[] = {"a.pbrt", "a.gltf", "a.glb", "a.ply",
                                        "a.obj",  "a.stl",  "a",     "a.pbrt.gz"};
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        g_autofree char *pipe = NULL;
        scene_folder f = folder_with_pipe(names[i], &pipe);
        g_autoptr(GError) error = NULL;
        alarm(PATIENCE);
        g_assert_null(format_load(pipe, 1, NULL, &error));
        g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
        alarm(0);
        folder_remove(&f);
    }
}

static void test_gltf(void)
{
    static const char *const texts[] = {
        HEAD MESH("0") NODES
        "\"materials\":[{}],\"buffers\":[{\"byteLength\":104,\"uri\":\"pipe\"}]," VIEWS
        "}",
        HEAD MESH("0") NODES
        "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}],"
        "\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"pipe\"}],"
        "\"buffers\":[{\"byteLength\":104,\"uri\":\"body.bin\"}]," VIEWS "}"};
    for (size_t i = 0; i < G_N_ELEMENTS(texts); i++) {
        g_autofree char *pipe = NULL;
        scene_folder f = folder_with_pipe("pipe", &pipe);
        folder_write(&f, "a.gltf", texts[i], -1);
        folder_write(&f, "body.bin", (const char *)&tetrahedron, sizeof tetrahedron);
        g_autofree char *path = g_build_filename(f.path, "a.gltf", NULL);
        g_autoptr(GError) error = NULL;
        alarm(PATIENCE);
        g_autoptr(scene) s = format_load(path, 1, NULL, &error);
        assert_unread(s, error, texts[i]);
        alarm(0);
        folder_remove(&f);
    }
}

static void test_others(void)
{
    g_autofree char *pipe = NULL;
    scene_folder f = folder_with_pipe("pipe", &pipe);
    g_autoptr(GError) settings_error = NULL, image_error = NULL, camera_error = NULL;
    settings set = settings_default();
    NephCamera look = {0};
    alarm(PATIENCE);
    g_assert_false(settings_load(&set, pipe, &settings_error));
    g_assert_nonnull(strstr(settings_error->message, "which is none"));
    g_assert_null(image_read(pipe, NULL, &image_error));
    g_assert_nonnull(strstr(image_error->message, "which is none"));
    g_assert_false(neph_camera_save(&look, pipe, &camera_error));
    g_assert_nonnull(strstr(camera_error->message, "which is none"));
    alarm(0);
    folder_remove(&f);
}

/* A file that is cut short while it is read would end a program that mapped it. */
static void test_shrinks(void)
{
    enum { SIZE = 1 << 20 };
    scene_folder f = folder_new("");
    g_autofree char *bytes = g_malloc(SIZE);
    for (int i = 0; i < SIZE; i++)
        bytes[i] = (char)(i * 7 + 1);
    g_assert_true(g_file_set_contents(f.main, bytes, SIZE, NULL));
    input in;
    g_autoptr(GBytes) whole = input_bytes(f.main, NULL);
    g_assert_true(input_open(&in, f.main, NULL));
    g_assert_cmpint(truncate(f.main, 0), ==, 0);
    g_assert_cmpmem(in.data, in.size, bytes, SIZE);
    g_assert_cmpmem(g_bytes_get_data(whole, NULL), g_bytes_get_size(whole), bytes, SIZE);
    g_assert_cmpint(in.data[in.size], ==, 0);
    input_close(&in);
    folder_remove(&f);
}

static void test_whole(void)
{
    static const char text[] = "some text with a \0 in it";
    scene_folder f = folder_new("");
    char start[8] = "";
    input in;
    gzFile packed = gzopen(f.main, "wb");
    gzwrite(packed, text, sizeof text);
    gzclose(packed);
    g_assert_true(input_open(&in, f.main, NULL));
    g_assert_cmpmem(in.data, in.size, text, sizeof text);
    input_close(&in);
    g_assert_true(input_read(&in, f.main, NULL));
    g_assert_cmpmem(in.data, 2, "\x1f\x8b", 2);
    input_close(&in);
    g_assert_cmpuint(input_peek(f.main, start, sizeof start), ==, sizeof start);
    g_assert_cmpmem(start, 2, "\x1f\x8b", 2);
    g_assert_cmpuint(input_peek("/nowhere", start, sizeof start), ==, 0);
    g_assert_true(g_file_set_contents(f.main, "", 0, NULL));
    g_assert_true(input_open(&in, f.main, NULL));
    g_assert_cmpuint(in.size, ==, 0);
    g_assert_cmpstr(in.data, ==, "");
    input_close(&in);
    folder_remove(&f);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/input/whole", test_whole);
    g_test_add_func("/input/shrinks", test_shrinks);
    g_test_add_func("/input/named", test_named);
    g_test_add_func("/input/profile", test_profile);
    g_test_add_func("/input/scenes", test_scenes);
    g_test_add_func("/input/gltf", test_gltf);
    g_test_add_func("/input/others", test_others);
    return g_test_run();
}
