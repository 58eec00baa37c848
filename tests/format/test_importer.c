/*
 * Models that mean harm, and importers that do: whatever the child does, its parent gets
 * an error that says so, in time. The importers are scripts in the true one's place.
 */
#include "scene_text.h"

#include "base/memory.h"
#include "format/model/importer.h"
#include "nephroid/nephroid.h"

#include <fcntl.h>
#include <signal.h>
#include <stdatomic.h>
#include <sys/stat.h>

static const char triangle_obj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/* ---- Importers that are none ---- */

/* Runs a script as the importer of a small file; its error, or NULL. */
static GError *run_script(const char *body, import_limits limits,
                          const cancel_flag *cancel)
{
    scene_folder f = folder_new("");
    g_autofree char *text = g_strdup_printf("#!/bin/sh\n%s\n", body);
    folder_write(&f, "importer", text, -1);
    folder_write(&f, "a.obj", triangle_obj, -1);
    g_autofree char *program = g_build_filename(f.path, "importer", NULL);
    g_autofree char *path = g_build_filename(f.path, "a.obj", NULL);
    g_assert_cmpint(g_chmod(program, 0700), ==, 0);
    g_autofree char *before = g_strdup(g_getenv("NEPHROID_IMPORTER"));
    g_setenv("NEPHROID_IMPORTER", program, TRUE);
    const import_job job = {.path = path,
                            .extension = "obj",
                            .format = "OBJ",
                            .limits = limits,
                            .cancel = cancel};
    GError *error = NULL;
    size_t size;
    void *bytes = importer_run(&job, &size, &error);
    g_assert_true((bytes == NULL) == (error != NULL));
    if (error)
        g_assert_null(strstr(error->message, "importer: "));
    big_free(bytes);
    g_setenv("NEPHROID_IMPORTER", before ? before : "", TRUE);
    folder_remove(&f);
    return error;
}

static const import_limits small = {.memory = 64 << 20, .seconds = 5.0};

static void check_script(const char *body, const char *said)
{
    g_autoptr(GError) error = run_script(body, small, NULL);
    g_test_message("%s: %s", body, error->message);
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_nonnull(strstr(error->message, "a.obj: the importer for OBJ "));
    g_assert_nonnull(strstr(error->message, said));
}

static void test_crashes(void)
{
    check_script("kill -SEGV $$", "crashed (signal 11): the file is damaged");
    check_script("kill -ABRT $$", "crashed (signal 6)");
    check_script("exit 3", "crashed (status 3)");
    check_script("printf nephmdl1; kill -SEGV $$", "crashed (signal 11)");
    check_script("kill -XCPU $$", "was stopped after 5 s");
    check_script("kill -KILL $$", "was killed from outside");
    check_script("printf nephmdl1; kill -KILL $$", "where memory is short");
}

/* It has what is left of the limit, whatever the file's size, and the machine's. */
static void test_limit(void)
{
    const size_t mib = 1 << 20;
    memory_set_limit(900 * mib);
    g_assert_cmpuint(import_limits_of(0).memory, ==, 512 * mib);
    g_assert_cmpuint(import_limits_of(SIZE_MAX).memory, <=, 900 * mib);
    g_assert_true(memory_reserve(500 * mib, "a trial", NULL));
    g_assert_cmpuint(import_limits_of(SIZE_MAX).memory, <=, 400 * mib);
    g_assert_cmpuint(import_limits_of(SIZE_MAX).memory, >, 390 * mib);
    memory_release(500 * mib);
    memory_set_limit(0);
}

static void test_hang(void)
{
    const import_limits short_ = {.memory = 64 << 20, .seconds = 0.05};
    gint64 start = g_get_monotonic_time();
    g_autoptr(GError) error = run_script("exec sleep 100", short_, NULL);
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_nonnull(strstr(error->message, "was stopped after"));
    g_assert_cmpint(g_get_monotonic_time() - start, <, 20 * G_USEC_PER_SEC);
}

/* One that closes its pipe and stays is not waited for. */
static void test_stays(void)
{
    gint64 start = g_get_monotonic_time();
    g_autoptr(GError) error = run_script("exec sleep 100 >&-", small, NULL);
    g_assert_no_error(error);
    g_assert_cmpint(g_get_monotonic_time() - start, <, 15 * G_USEC_PER_SEC);
}

static void test_talks_for_ever(void)
{
    check_script("exec cat /dev/zero", "tells more than 64 MB");
}

/* It is given an end for what it tells, the model, and nothing else that is open here;
 * the shell has its script open as 10 or 255. */
static void test_open_files(void)
{
    static const char script[] =
        "for f in /proc/$$/fd/*; do n=${f##*/}\n"
        "[ -e $f ] && [ $n -gt 2 ] && [ $n != 10 ] && [ $n != 255 ] && exit 1\ndone\n"
        "[ \"$(cat)\" = \"$(printf 'v 0 0 0\\nv 1 0 0\\nv 0 1 0\\nf 1 2 3')\" ] || exit "
        "2";
    int ours = open("/dev/null", O_RDONLY); /* not closed on exec */
    g_autoptr(GError) error = run_script(script, small, NULL);
    g_close(ours, NULL);
    g_assert_no_error(error);
}

static void test_no_program(void)
{
    g_autofree char *before = g_strdup(g_getenv("NEPHROID_IMPORTER"));
    scene_folder f = folder_new("");
    folder_write(&f, "a.obj", triangle_obj, -1);
    g_autofree char *path = g_build_filename(f.path, "a.obj", NULL);
    g_setenv("NEPHROID_IMPORTER", "/nowhere/importer", TRUE);
    g_autoptr(GError) error = NULL;
    g_assert_null(format_load(path, 1, NULL, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_FAILED);
    g_assert_nonnull(strstr(error->message, "cannot start /nowhere/importer"));
    g_setenv("NEPHROID_IMPORTER", before ? before : "", TRUE);
    folder_remove(&f);
}

/* Nonsense that is a stream to the end is the reader's to refuse (test_model.c). */
static void test_nonsense(void)
{
    scene_folder f = folder_new("");
    folder_write(&f, "importer", "#!/bin/sh\nhead -c 100000 /bin/sh\n", -1);
    folder_write(&f, "a.obj", triangle_obj, -1);
    g_autofree char *program = g_build_filename(f.path, "importer", NULL);
    g_autofree char *path = g_build_filename(f.path, "a.obj", NULL);
    g_autofree char *before = g_strdup(g_getenv("NEPHROID_IMPORTER"));
    g_autoptr(GError) error = NULL;
    g_assert_cmpint(g_chmod(program, 0700), ==, 0);
    g_setenv("NEPHROID_IMPORTER", program, TRUE);
    g_assert_null(format_load(path, 1, NULL, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_true(g_str_has_prefix(error->message, path));
    g_assert_nonnull(strstr(error->message, "nonsense"));
    g_setenv("NEPHROID_IMPORTER", before ? before : "", TRUE);
    folder_remove(&f);
}

static void cancel_now(void *flag)
{
    atomic_store((atomic_bool *)flag, true);
}

static void test_cancel(void)
{
    cancel_flag cancel = {.progress = cancel_now};
    cancel.progress_data = &cancel.set;
    gint64 start = g_get_monotonic_time();
    g_autoptr(GError) error = run_script("exec sleep 100", small, &cancel);
    g_assert_error(error, NEPH_ERROR, ERROR_CANCELLED);
    g_assert_cmpint(g_get_monotonic_time() - start, <, 15 * G_USEC_PER_SEC);
}

static bool stop_now(void *data)
{
    ++*(int *)data;
    return false;
}

/* By the header's own way, through the true importer. */
static void test_stopped(void)
{
    int n_asked = 0;
    scene_folder f = folder_new("");
    folder_write(&f, "a.obj", triangle_obj, -1);
    const NephLoadOptions options = {.go_on = stop_now, .go_on_data = &n_asked};
    g_autoptr(GError) error = NULL;
    g_assert_null(neph_scene_load_with(f.files->pdata[1], &options, &error));
    g_assert_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_CANCELLED);
    g_assert_cmpint(n_asked, >=, 1);
    g_clear_error(&error);
    g_autofree char *out = g_build_filename(f.path, "out.pbrt", NULL);
    g_assert_false(neph_scene_convert_with(f.files->pdata[1], out, &options, &error));
    g_assert_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_CANCELLED);
    folder_remove(&f);
}

/* A program that lets the system reap its children, or blocks signals, is served too. */
static void test_strange_parents(void)
{
    sigset_t all, before;
    void (*handler)(int) = signal(SIGCHLD, SIG_IGN);
    sigfillset(&all);
    g_assert_cmpint(sigprocmask(SIG_BLOCK, &all, &before), ==, 0);
    g_autoptr(GError) killed = run_script("kill -TERM $$; sleep 100", small, NULL);
    g_clear_error(&killed); /* how it ended may not be known here */
    g_autoptr(GError) fine = run_script("exit 0", small, NULL);
    sigprocmask(SIG_SETMASK, &before, NULL);
    signal(SIGCHLD, handler);
    g_assert_no_error(fine);
}

/* ---- Models that mean harm, and the true importer ---- */

/* Loads one file in a folder with others; the error, or NULL. */
static GError *load_error(const char *name, const char *bytes, gssize size,
                          const char *other, const char *other_text)
{
    scene_folder f = folder_new("");
    folder_write(&f, name, bytes, size);
    if (other)
        folder_write(&f, other, other_text, -1);
    g_autofree char *path = g_build_filename(f.path, name, NULL);
    GError *error = NULL;
    g_autoptr(scene) s = format_load(path, 1, NULL, &error);
    g_assert_true((s == NULL) == (error != NULL));
    if (error) {
        g_test_message("%s", error->message);
        g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
        g_assert_true(g_str_has_prefix(error->message, path));
    }
    folder_remove(&f);
    return error;
}

/* Kinds that once crashed or hung: what they hold is not looked at. */
static void test_kinds_not_read(void)
{
    static const char *const names[] = {"a.assbin", "a.wrl", "a.ogex", "a.smd", "a.blend",
                                        "a.3ds",    "a.off", "a.lwo",  "a.x",   "a.OGEX",
                                        "a.obj.gz", "a.b3d", "a"};
    static const char bytes[] = "ASSIMP.binary-dump.\0\xff\xff\xff\xff";
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        g_autoptr(GError) error =
            load_error(names[i], bytes, sizeof bytes - 1, NULL, NULL);
        const char *dot = strrchr(names[i], '.');
        g_assert_nonnull(strstr(error->message, dot ? dot : "no extension"));
        g_assert_nonnull(strstr(error->message, "Blender"));
    }
}

/* What is read is listed, and what is listed is read. */
static void test_list_of_kinds(void)
{
    static const char *const read[] = {".pbrt", ".gltf", ".glb", ".ply", ".obj",
                                       ".stl",  ".3mf",  ".dae", ".fbx"};
    const char *const *list = neph_scene_extensions();
    for (size_t i = 0; i < G_N_ELEMENTS(read); i++)
        g_assert_true(g_strv_contains(list, read[i]));
    for (; *list; list++) {
        g_autofree char *name = g_strconcat("a", *list, NULL);
        g_autoptr(GError) error = load_error(name, "?", 1, NULL, NULL);
        g_assert_null(strstr(error->message, "expected a scene file"));
    }
}

/* The importer goes by the name: bytes of another kind are a damaged file of this. */
static void test_other_content(void)
{
    static const char *const names[] = {"a.obj", "a.stl", "a.3mf", "a.dae", "a.fbx"};
    static const struct {
        const char *bytes;
        gssize size;
    } files[] = {
        {"ASSIMP.binary-dump.\0\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff", 32},
        {"version 1\nnodes\n0 \"a\" -1\nend\nskeleton\ntime 0\nend\ntriangles\na\n", -1},
        {"Metric (key = \"distance\") {float {1}}\nGeometryNode $n {ObjectRef {ref "
         "{$g}}}\n"
         "GeometryObject $g {Mesh {VertexArray (attrib = \"position\") {float[3] "
         "{{0,0,0}}}"
         "}}\n",
         -1},
        {"", 0},
        {"\0", 1},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++)
        for (size_t k = 0; k < G_N_ELEMENTS(files); k++) {
            g_autoptr(GError) error =
                load_error(names[i], files[k].bytes, files[k].size, NULL, NULL);
            g_assert_nonnull(error);
        }
}

/* A segmentation fault, in assimp 5.2. */
static void test_map_without_material(void)
{
    g_autofree char *obj = g_strconcat("mtllib a.mtl\n", triangle_obj, NULL);
    g_autoptr(GError) error = load_error("a.obj", obj, -1, "a.mtl", "map_Kd x\n");
    if (error)
        g_assert_nonnull(strstr(error->message, "the importer for OBJ crashed ("));
}

/* More than a stack holds. */
static void test_nested_nodes(void)
{
    enum { DEPTH = 100000 };
    g_autoptr(GString) dae = g_string_new(
        "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/"
        "COLLADASchema\" version=\"1.4.1\"><library_visual_scenes><visual_scene "
        "id=\"s\">");
    for (int i = 0; i < DEPTH; i++)
        g_string_append(dae, "<node>");
    for (int i = 0; i < DEPTH; i++)
        g_string_append(dae, "</node>");
    g_string_append(dae, "</visual_scene></library_visual_scenes><scene>"
                         "<instance_visual_scene url=\"#s\"/></scene></COLLADA>");
    g_autoptr(GError) error = load_error("a.dae", dae->str, (gssize)dae->len, NULL, NULL);
    g_assert_nonnull(error);
}

/* Told as what it is, not as nonsense. */
static void test_not_finite(void)
{
    static const char obj[] = "v 1e99 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    g_autoptr(GError) error = load_error("a.obj", obj, -1, NULL, NULL);
    g_assert_nonnull(error);
    g_assert_nonnull(strstr(error->message, "a position of a mesh is not finite"));
}

/* An STL that says it has four thousand million triangles. */
static void test_lying_count(void)
{
    char bytes[84 + 50] = "binary";
    memset(bytes + 80, 0xff, 4);
    g_autoptr(GError) error = load_error("a.stl", bytes, sizeof bytes, NULL, NULL);
    g_assert_nonnull(error);
}

/* A model that is a folder, a pipe, nothing. */
static void test_no_file(void)
{
    scene_folder f = folder_new("");
    g_autofree char *folder = g_build_filename(f.path, "a.stl", NULL);
    g_autoptr(GError) error = NULL;
    g_assert_cmpint(g_mkdir(folder, 0700), ==, 0);
    g_assert_null(format_load(folder, 1, NULL, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_clear_error(&error);
    g_rmdir(folder);
    g_assert_cmpint(mkfifo(folder, 0600), ==, 0);
    g_assert_null(format_load(folder, 1, NULL, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_unlink(folder);
    folder_remove(&f);
}

static void count_left_out(log_level level, const char *text, void *data)
{
    if (level == LOG_WARNING && strstr(text, "is left out"))
        ++*(int *)data;
}

/* More files of materials than it is given: the last are left out, and it is said. */
static void test_many_libraries(void)
{
    g_autoptr(GString) obj = g_string_new(NULL);
    scene_folder f = folder_new("");
    for (int i = 0; i < 100; i++) {
        g_autofree char *name = g_strdup_printf("m%d.mtl", i);
        g_autofree char *text = g_strdup_printf("newmtl m%d\nKd 1 0 0\n", i);
        g_string_append_printf(obj, "mtllib %s\n", name);
        folder_write(&f, name, text, -1);
    }
    g_string_append(obj, "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m3\nf 1 2 3\n");
    folder_write(&f, "a.obj", obj->str, -1);
    g_autofree char *path = g_build_filename(f.path, "a.obj", NULL);
    g_autoptr(GError) error = NULL;
    int n_left_out = 0;
    const log_sink sink = {count_left_out, &n_left_out};
    g_autoptr(scene) s = format_load(path, 1, &sink, &error);
    g_assert_no_error(error);
    g_assert_cmpint(n_left_out, ==, 100 - MOST_IMPORT_FILES);
    const shape *on = s->shapes->pdata[0];
    const material *m = s->materials->pdata[on->material];
    g_assert_cmpstr(m->name, ==, "m3");
    folder_remove(&f);
}

/* One mesh of twenty thousand triangles, forty thousand times: some 2 MB of file, and ten
 * thousand times as much to render. */
static void test_too_many_instances(void)
{
    g_autoptr(GString) dae = g_string_new(
        "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/"
        "COLLADASchema\" version=\"1.4.1\"><library_geometries><geometry id=\"g\"><mesh>"
        "<source id=\"p\"><float_array id=\"a\" count=\"9\">0 0 0 1 0 0 0 1 "
        "0</float_array>"
        "<technique_common><accessor source=\"#a\" count=\"3\" stride=\"3\">"
        "<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/>"
        "<param name=\"Z\" type=\"float\"/></accessor></technique_common></source>"
        "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>"
        "<triangles count=\"20000\"><input semantic=\"VERTEX\" source=\"#v\" "
        "offset=\"0\"/><p>");
    for (int i = 0; i < 20000; i++)
        g_string_append(dae, "0 1 2 ");
    g_string_append(dae, "</p></triangles></mesh></geometry></library_geometries>"
                         "<library_visual_scenes><visual_scene id=\"s\">");
    for (int i = 0; i < 40000; i++)
        g_string_append(dae, "<node><instance_geometry url=\"#g\"/></node>");
    g_string_append(dae, "</visual_scene></library_visual_scenes><scene>"
                         "<instance_visual_scene url=\"#s\"/></scene></COLLADA>");
    g_autoptr(GError) error = load_error("a.dae", dae->str, (gssize)dae->len, NULL, NULL);
    g_assert_nonnull(error);
    g_assert_nonnull(strstr(error->message, "GB of memory"));
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/importer/crashes", test_crashes);
    g_test_add_func("/importer/hang", test_hang);
    g_test_add_func("/importer/limit", test_limit);
    g_test_add_func("/importer/stays", test_stays);
    g_test_add_func("/importer/talks-for-ever", test_talks_for_ever);
    g_test_add_func("/importer/open-files", test_open_files);
    g_test_add_func("/importer/no-program", test_no_program);
    g_test_add_func("/importer/nonsense", test_nonsense);
    g_test_add_func("/importer/cancel", test_cancel);
    g_test_add_func("/importer/stopped", test_stopped);
    g_test_add_func("/importer/strange-parents", test_strange_parents);
    g_test_add_func("/importer/kinds-not-read", test_kinds_not_read);
    g_test_add_func("/importer/list-of-kinds", test_list_of_kinds);
    g_test_add_func("/importer/other-content", test_other_content);
    g_test_add_func("/importer/map-without-material", test_map_without_material);
    g_test_add_func("/importer/nested-nodes", test_nested_nodes);
    g_test_add_func("/importer/not-finite", test_not_finite);
    g_test_add_func("/importer/lying-count", test_lying_count);
    g_test_add_func("/importer/no-file", test_no_file);
    g_test_add_func("/importer/many-libraries", test_many_libraries);
    g_test_add_func("/importer/too-many-instances", test_too_many_instances);
    return g_test_run();
}
