/*
 * The program is killed at random moments, by a signal that it can not see, and goes on
 * from its checkpoint each time: the picture is bit for bit that of a render that was
 * left alone. NEPHROID_KILLS says how often (4).
 */
#include "cli_run.h"

#include <glib/gstdio.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define JOB "--passes", "60", "--size", "32x24", "--set", "photons=4000"

static int kills_wanted(void)
{
    const char *text = g_getenv("NEPHROID_KILLS");
    return text ? atoi(text) : 4;
}

/* @return what it exited with; -1: it was killed, after so many seconds */
static int render_for(const folder *f, bool resume, double seconds)
{
    const char *argv[] = {run_program(),
                          "render",
                          "box.pbrt",
                          "-q",
                          "-o",
                          "b.exr",
                          "--checkpoint",
                          "b.checkpoint",
                          "--checkpoint-every",
                          "0",
                          JOB,
                          resume ? "--resume" : NULL,
                          "b.checkpoint",
                          NULL};
    GPid child;
    int status = 0;
    g_assert_true(g_spawn_async(f->path, (char **)argv, NULL, G_SPAWN_DO_NOT_REAP_CHILD,
                                NULL, NULL, &child, NULL));
    double end = (double)g_get_monotonic_time() * 1e-6 + seconds;
    bool done = false;
    while (!done && (double)g_get_monotonic_time() * 1e-6 < end) {
        g_usleep(500);
        done = waitpid(child, &status, WNOHANG) == child;
    }
    if (!done) {
        kill(child, SIGKILL);
        g_assert_cmpint(waitpid(child, &status, 0), ==, child);
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* How long an unbroken render takes, which is left as a.exr. */
static double render_whole(const folder *f)
{
    double start = (double)g_get_monotonic_time() * 1e-6;
    run_well(f,
             "render box.pbrt -q -o a.exr --passes 60 --size 32x24 --set photons=4000");
    return (double)g_get_monotonic_time() * 1e-6 - start;
}

static void assert_same_files(const folder *f, const char *a, const char *b)
{
    g_autofree char *path_a = g_build_filename(f->path, a, NULL);
    g_autofree char *path_b = g_build_filename(f->path, b, NULL);
    g_autofree char *bytes_a = NULL, *bytes_b = NULL;
    gsize n_a = 0, n_b = 0;
    g_assert_true(g_file_get_contents(path_a, &bytes_a, &n_a, NULL));
    g_assert_true(g_file_get_contents(path_b, &bytes_b, &n_b, NULL));
    g_assert_cmpmem(bytes_a, n_a, bytes_b, n_b);
}

static void test_killed(folder *f, gconstpointer data)
{
    (void)data;
    double whole = render_whole(f);
    int wanted = kills_wanted(), kills = 0, resumed = 0, rounds = 0;
    g_autoptr(GRand) random = g_rand_new_with_seed(19);
    bool done = false;
    for (int starts = 0; (kills < wanted || !done) && starts < 50 * wanted; starts++) {
        bool goes_on = folder_has(f, "b.checkpoint");
        double time = kills < wanted ? g_rand_double_range(random, 0.0, 0.6 * whole) : 1e9;
        int code = render_for(f, goes_on, time);
        kills += code < 0;
        resumed += code < 0 && goes_on;
        done = code == 0;
        g_assert_cmpint(code, <=, 0); /* whatever it was killed in, the file is good */
        if (!done)
            continue;
        rounds++;
        assert_same_files(f, "a.exr", "b.exr");
        g_autofree char *path = g_build_filename(f->path, "b.checkpoint", NULL);
        g_assert_cmpint(g_remove(path), ==, 0);
        g_autofree char *picture = g_build_filename(f->path, "b.exr", NULL);
        g_assert_cmpint(g_remove(picture), ==, 0);
    }
    g_test_message("%d kills, %d of renders that had gone on; %d pictures, all the same",
                   kills, resumed, rounds);
    g_assert_cmpint(kills, >=, wanted);
    g_assert_cmpint(rounds, >=, 1);
}

/* A stopped render leaves a checkpoint of all it did; settings that may change do. */
static void test_goes_on(folder *f, gconstpointer data)
{
    (void)data;
    run_well(f, "render box.pbrt -q -o a.exr --passes 5 --set planned_passes=3");
    run_well(f, "render box.pbrt -q -o b.exr --passes 3 --size 16x12 --checkpoint c");
    g_auto(result) r = run(f, "render box.pbrt --resume c --passes 5 -o b.exr -j1");
    g_assert_cmpint(r.code, ==, 0);
    contains(r.err, "note: going on after 3 passes");
    g_auto(result) same = run(f, "compare a.exr b.exr --metric rmse");
    g_assert_cmpstr(same.out, ==, "0\n");
}

static void test_refused(folder *f, gconstpointer data)
{
    (void)data;
    static const refused_run cases[] = {
        {"--resume none", "cannot open 'none'", 1},
        {"--resume box.pbrt", "expected a checkpoint, found another file", 1},
        {"--resume c --seed 3", "with seed = 0, not 3", 1},
        {"--resume c --size 9x9", "16x12 pixels, not 9x9", 1},
        {"--checkpoint-every 3", "--checkpoint-every: expected --checkpoint FILE", 2},
        {"--checkpoint c --checkpoint-every x", "--checkpoint-every: expected a", 2},
        {"--checkpoint nowhere/c", "cannot write nowhere/c", 1},
        {"--checkpoint box.pbrt", "it would replace", 2},
        {"--checkpoint a.exr", "it would replace", 2},
        {"--checkpoint s.json --stats s.json", "it would replace", 2},
    };
    run_well(f, "render box.pbrt -q -o a.exr --checkpoint c");
    run_refused(f, "render box.pbrt -o a.exr ", cases, G_N_ELEMENTS(cases));
    g_autofree char *scene = folder_read(f, "box.pbrt");
    g_autofree char *other = g_strconcat(scene, "# other\n", NULL);
    folder_write(f, "box.pbrt", other);
    g_auto(result) changed = run(f, "render box.pbrt --resume c -o a.exr");
    g_assert_cmpint(changed.code, ==, 1);
    contains(changed.err, "of another scene, or of files that have changed");
}

/* A disk that is full ends no render: the picture is there, the old checkpoint is, and
   the program says what it could not do. */
static void test_full_disk(folder *f, gconstpointer data)
{
    (void)data;
    run_well(f, "render box.pbrt -q -o a.exr --passes 2 --checkpoint c");
    g_autofree char *before = folder_read(f, "c");
    g_autofree char *command = g_strdup_printf(
        "cd '%s' && trap '' XFSZ && ulimit -f 8 && '%s' render box.pbrt -q -o a.pfm "
        "--checkpoint c --checkpoint-every 0",
        f->path, run_program());
    const char *argv[] = {"/bin/bash", "-c", command, NULL};
    g_autofree char *err = NULL;
    int status = 0;
    g_assert_true(g_spawn_sync(NULL, (char **)argv, NULL, G_SPAWN_STDOUT_TO_DEV_NULL,
                               NULL, NULL, NULL, &err, &status, NULL));
    g_test_message("%d: %s", status, err);
    g_autofree char *after = folder_read(f, "c");
    g_assert_cmpstr(before, ==, after);
    g_assert_true(WIFEXITED(status));
    g_assert_cmpint(WEXITSTATUS(status), ==, 3);
    contains(err, "cannot write");
    g_assert_cmpuint(count_parts(err, "cannot write"), ==,
                     2); /* at first, and in the end */
    g_assert_true(folder_has(f, "a.pfm"));
    g_assert_cmpuint(folder_count(f), ==, 4); /* nothing half written */
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder_add_test("/cli-checkpoint/killed", test_killed);
    folder_add_test("/cli-checkpoint/goes-on", test_goes_on);
    folder_add_test("/cli-checkpoint/refused", test_refused);
    folder_add_test("/cli-checkpoint/full-disk", test_full_disk);
    return g_test_run();
}
