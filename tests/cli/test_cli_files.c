/*
 * No file is lost: signals at the worst moments, outputs that are inputs, and what a
 * command that was stopped or refused leaves behind.
 */
#include "cli_run.h"
#include "sanitizers.h"

#include <fcntl.h>
#include <glib/gstdio.h>
#include <signal.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static char *path_in(const folder *f, const char *name)
{
    return g_build_filename(f->path, name, NULL);
}

/* ---- Signals ---- */

static GPid start(const folder *f, const char *line, char *terminal)
{
    g_auto(GStrv) argv = NULL;
    GPid child = 0;
    g_autoptr(GError) error = NULL;
    g_assert_true(g_shell_parse_argv(line, NULL, &argv, &error));
    g_free(argv[0]);
    argv[0] = g_strdup(run_program());
    g_spawn_async(f->path, argv, NULL,
                  G_SPAWN_DO_NOT_REAP_CHILD | G_SPAWN_STDOUT_TO_DEV_NULL |
                      (terminal ? 0 : G_SPAWN_STDERR_TO_DEV_NULL),
                  terminal ? terminal_enter : NULL, terminal, &child, &error);
    g_assert_no_error(error);
    return child;
}

/* Sent while the first pass is under way: what was there stays. */
static void test_first_pass(folder *f, gconstpointer data)
{
    (void)data;
    g_autofree char *name = NULL;
    int terminal = terminal_open(&name);
    if (terminal < 0) {
        g_test_skip("no pseudo-terminals here");
        return;
    }
    folder_write(f, "good.pfm", "a good picture");
    g_autoptr(GString) seen = g_string_new(NULL);
    GPid child =
        start(f, "nephroid render box.pbrt --spp 65536 -o good.pfm --stats s.json", name);
    bool begun = terminal_wait(terminal, "pass 1", seen);
    kill(child, begun ? SIGINT : SIGKILL);
    bool told = begun && terminal_wait(terminal, "nothing is written", seen);
    int status = 0;
    if (!told)
        kill(child, SIGKILL);
    g_assert_cmpint(waitpid(child, &status, 0), ==, child);
    close(terminal);
    g_test_message("%s", seen->str);
    g_assert_true(told);
    g_assert_true(WIFEXITED(status));
    g_assert_cmpint(WEXITSTATUS(status), ==, 3);
    g_autofree char *good = folder_read(f, "good.pfm");
    g_assert_cmpstr(good, ==, "a good picture");
    g_assert_cmpuint(folder_count(f), ==, 2);
}

/* A pipe that nobody empties holds up the final write. */
typedef struct held_write {
    int pipe;
    GPid child;
} held_write;

/* True when the pipe has begun to fill. */
static bool held_write_begin(held_write *w, const folder *f)
{
    g_autofree char *path = path_in(f, "slow.pfm");
    g_assert_cmpint(mkfifo(path, 0600), ==, 0);
    w->pipe = open(path, O_RDONLY | O_NONBLOCK);
    w->child = start(f,
                     "nephroid render box.pbrt --passes 1 --size 160x120 -o slow.pfm -o "
                     "last.pfm",
                     NULL);
    char first;
    for (int tries = 0; tries < 1000; tries++) {
        if (read(w->pipe, &first, 1) == 1)
            return true;
        g_usleep(10000);
    }
    return false;
}

static int held_write_end(held_write *w)
{
    int status = 0;
    g_assert_cmpint(waitpid(w->child, &status, 0), ==, w->child);
    close(w->pipe);
    return status;
}

static void drain(const held_write *w)
{
    char buffer[4096];
    for (int idle = 0; idle < 100;) {
        ssize_t n = read(w->pipe, buffer, sizeof buffer);
        if (n == 0)
            return; /* the other end is closed */
        idle = n > 0 ? 0 : idle + 1;
        if (n < 0)
            g_usleep(10000);
    }
}

static void test_final_write(folder *f, gconstpointer data)
{
    held_write w;
    bool begun = held_write_begin(&w, f);
    kill(w.child, begun ? GPOINTER_TO_INT(data) : SIGKILL);
    g_usleep(20000);
    drain(&w);
    int status = held_write_end(&w);
    g_assert_true(begun);
    g_assert_true(WIFEXITED(status));
    g_assert_cmpint(WEXITSTATUS(status), ==, 0);
    g_autofree char *picture = folder_read(f, "last.pfm");
    g_assert_nonnull(picture);
    g_assert_true(g_str_has_prefix(picture, "PF\n160 120\n"));
    g_assert_cmpuint(folder_count(f), ==, 3);
}

static void test_second_signal(folder *f, gconstpointer data)
{
    (void)data;
    if (THREADS_ARE_WATCHED) {
        g_test_skip("the thread sanitizer holds signals back until the write returns");
        return;
    }
    held_write w;
    bool begun = held_write_begin(&w, f);
    kill(w.child, begun ? SIGINT : SIGKILL);
    g_usleep(20000);
    kill(w.child, SIGINT);
    int status = held_write_end(&w);
    g_assert_true(begun);
    g_assert_true(WIFSIGNALED(status));
    g_assert_cmpint(WTERMSIG(status), ==, SIGINT);
    g_assert_cmpuint(folder_count(f), ==, 2);
}

/* ---- Outputs that are inputs ---- */

static const char meshes[] =
    "LookAt 0 0 -2  0 0 0  0 1 0\nCamera \"perspective\"\n"
    "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\n"
    "WorldBegin\nLightSource \"point\"\n"
    "Shape \"plymesh\" \"string filename\" \"two-files/mesh-2.ply\"\n"
    "Shape \"plymesh\" \"string filename\" \"two-files/mesh-1.ply\"\n";

static const char triangle[] =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
    "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

static void test_inputs_are_spared(folder *f, gconstpointer data)
{
    (void)data;
    static const char *const refused[] = {
        "render scene.pbrt -o wood.pfm",
        "render scene.pbrt -o link.pfm",
        "render scene.pbrt -o new.pfm -o ./new.pfm",
        "render scene.pbrt -o new.exr -o new.pfm -o ./new.exr",
        "render scene.pbrt -o new.exr --stats scene.pbrt",
        "render scene.pbrt -o new.exr --stats part.pbrt",
        "render scene.pbrt -o new.exr --stats new.exr",
        "render scene.pbrt -o new.exr --settings more.ini --stats more.ini",
        "render named.pbrt",
        "photons scene.pbrt -o part.pbrt",
        "convert scene.pbrt scene.pbrt",
        "convert scene.pbrt part.pbrt",
        "convert scene.pbrt ./link.pbrt",
        "image wood.pfm -o wood.pfm",
        "image wood.pfm wood.pfm -o link.pfm",
        "compare wood.pfm wood.pfm -o link.pfm",
        "bsdf diffuse --scene scene.pbrt -o part.pbrt",
    };
    g_autofree char *scene =
        g_strconcat(scene_head, scene_integrator, scene_body,
                    "Texture \"wood\" \"spectrum\" \"imagemap\" \"string filename\" "
                    "\"wood.pfm\"\nInclude \"part.pbrt\"\n",
                    NULL);
    g_autofree char *named =
        g_strconcat(scene_head, "    \"string filename\" \"/tmp/wood.pfm\"\n",
                    scene_integrator, strstr(scene, "WorldBegin"), NULL);
    g_autofree char *soft = path_in(f, "link.pfm"), *hard = path_in(f, "link.pbrt");
    g_autofree char *part = path_in(f, "part.pbrt");
    folder_write(f, "scene.pbrt", scene);
    folder_write(f, "named.pbrt", named);
    folder_write(f, "part.pbrt", "Material \"diffuse\"\nShape \"sphere\"\n");
    folder_write(f, "more.ini", "spp = 1\n");
    run_well(f, "render box.pbrt -q -o wood.pfm --size 2x2");
    g_assert_cmpint(symlink("wood.pfm", soft), ==, 0);
    g_assert_cmpint(link(part, hard), ==, 0);
    run_well(f, "render scene.pbrt -q -o x.pfm --settings more.ini");
    unsigned before = folder_count(f);
    for (size_t i = 0; i < G_N_ELEMENTS(refused); i++) {
        g_auto(result) r = run(f, refused[i]);
        g_assert_cmpint(r.code, ==, 2);
        contains(r.err, "it would replace");
        g_assert_cmpuint(folder_count(f), ==, before);
    }
    g_autofree char *after = folder_read(f, "scene.pbrt");
    g_assert_cmpstr(after, ==, scene);
}

/* The first mesh that is read becomes mesh-1, which is the name of the one read next. */
static void test_convert_beside_its_meshes(folder *f, gconstpointer data)
{
    (void)data;
    g_autofree char *files = path_in(f, "two-files");
    g_autofree char *one = path_in(f, "two-files/mesh-1.ply");
    g_autofree char *two = path_in(f, "two-files/mesh-2.ply");
    g_assert_cmpint(g_mkdir(files, 0700), ==, 0);
    folder_write(f, "two-files/mesh-1.ply", triangle);
    folder_write(f, "two-files/mesh-2.ply", triangle);
    folder_write(f, "in.pbrt", meshes);
    g_auto(result) r = run(f, "convert in.pbrt two.pbrt");
    g_autofree char *mesh_1 = folder_read(f, "two-files/mesh-1.ply");
    g_autofree char *mesh_2 = folder_read(f, "two-files/mesh-2.ply");
    const folder inside = {files};
    unsigned n = folder_count(&inside);
    run_well(f, "convert in.pbrt other.pbrt");
    run_well(f, "convert in.pbrt other.pbrt"); /* over what it wrote itself */
    g_autofree char *other = path_in(f, "other-files");
    const folder others = {other};
    unsigned n_others = folder_count(&others);
    static const char *const made[] = {"other-files/mesh-1.ply", "other-files/mesh-2.ply",
                                       "other-files"};
    for (size_t i = 0; i < G_N_ELEMENTS(made); i++) {
        g_autofree char *path = path_in(f, made[i]);
        g_remove(path);
    }
    g_remove(one);
    g_remove(two);
    g_assert_cmpint(r.code, ==, 2);
    contains(r.err, "it would replace");
    g_assert_cmpstr(mesh_1, ==, triangle);
    g_assert_cmpstr(mesh_2, ==, triangle);
    g_assert_cmpuint(n, ==, 2);
    g_assert_cmpuint(n_others, ==, 2);
}

/* What is refused half way leaves no folder. */
static void test_convert_refused(folder *f, gconstpointer data)
{
    (void)data;
    g_autofree char *scene = g_strconcat(
        scene_head, "WorldBegin\nLightSource \"point\"\n",
        "Shape \"plymesh\" \"string filename\" \"mesh.ply\"\nFrobnicate\n", NULL);
    folder_write(f, "mesh.ply", triangle);
    folder_write(f, "bad.pbrt", scene);
    g_auto(result) r = run(f, "convert bad.pbrt out.pbrt");
    g_assert_cmpint(r.code, ==, 1);
    g_assert_cmpuint(folder_count(f), ==, 3);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder_add_test("/files/first-pass", test_first_pass);
    g_test_add("/files/final-write/interrupt", folder, GINT_TO_POINTER(SIGINT),
               folder_set_up, test_final_write, folder_tear_down);
    g_test_add("/files/final-write/terminate", folder, GINT_TO_POINTER(SIGTERM),
               folder_set_up, test_final_write, folder_tear_down);
    g_test_add("/files/final-write/hang-up", folder, GINT_TO_POINTER(SIGHUP),
               folder_set_up, test_final_write, folder_tear_down);
    folder_add_test("/files/second-signal", test_second_signal);
    folder_add_test("/files/inputs", test_inputs_are_spared);
    folder_add_test("/files/convert/meshes", test_convert_beside_its_meshes);
    folder_add_test("/files/convert/refused", test_convert_refused);
    return g_test_run();
}
