/*
 * Many pictures of one scene: what moves is elsewhere in each, a camera follows its path,
 * frames that are there are not rendered again, and photons are made once.
 */
#include "cli_run.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char path[] = "# three views\n"
                           "LookAt 0 0 -2  0 0 0  0 1 0\n\n"
                           "LookAt 0.5 0 -2  0 0 0  0 1 0 # the second\n"
                           "LookAt 1 0 -2  0 0 0  0 1 0\n";

/* Root of the mean squared difference of two pictures. */
static double difference(const folder *f, const char *a, const char *b)
{
    g_autofree char *line = g_strdup_printf("compare %s %s --metric rmse", a, b);
    g_auto(result) r = run(f, line);
    g_assert_cmpint(r.code, ==, 0);
    return g_ascii_strtod(r.out, NULL);
}

/* Something that moves in the first second, at two frames a second. */
static void test_motion(folder *f, gconstpointer data)
{
    (void)data;
    g_autofree char *moving =
        g_strconcat(scene_head, scene_integrator, scene_body,
                    "ActiveTransform EndTime Translate 0.6 0 0 ActiveTransform All\n"
                    "Material \"diffuse\" Shape \"sphere\" \"float radius\" 0.2\n",
                    NULL);
    folder_write(f, "m.pbrt", moving);
    run_well(f, "render m.pbrt -q --frame 0-3 --fps 2 -o m.##.exr");
    g_assert_true(folder_has(f, "m.00.exr") && folder_has(f, "m.03.exr"));
    run_well(f, "render m.pbrt -q -o still.exr");
    g_assert_cmpfloat(difference(f, "m.00.exr", "still.exr"), ==, 0.0);
    g_assert_cmpfloat(difference(f, "m.00.exr", "m.01.exr"), >, 1e-3);
    g_assert_cmpfloat(difference(f, "m.02.exr", "m.03.exr"), ==, 0.0); /* it has come */
}

static void test_camera(folder *f, gconstpointer data)
{
    (void)data;
    folder_write(f, "path", path);
    run_well(f, "render box.pbrt -q --camera path -o c.exr");
    g_assert_cmpfloat(difference(f, "c.0001.exr", "c.0003.exr"), >, 1e-3);
    run_well(f, "render box.pbrt -q --camera path --frame 2 -o d.#.exr");
    g_assert_cmpfloat(difference(f, "c.0002.exr", "d.2.exr"), ==, 0.0);
    g_assert_false(folder_has(f, "d.1.exr"));
}

static void test_restart(folder *f, gconstpointer data)
{
    (void)data;
    folder_write(f, "path", path);
    run_well(f, "render box.pbrt -q --camera path --frame 2-2 -o c.####.png");
    folder_write(f, "c.0002.png", "mine");
    g_auto(result) r = run(f, "render box.pbrt --camera path -o c.####.png");
    g_assert_cmpint(r.code, ==, 0);
    contains(r.err, "note: frame 2 is skipped: c.0002.png is there");
    g_autofree char *after = folder_read(f, "c.0002.png");
    g_assert_cmpstr(after, ==, "mine");
    g_assert_true(folder_has(f, "c.0001.png") && folder_has(f, "c.0003.png"));
}

/* Photons are made for the first frame, and are the same in all; grain need not be. */
static void test_photons(folder *f, gconstpointer data)
{
    (void)data;
    folder_write(f, "path", "LookAt 0 0 -2 0 0 0 0 1 0\nLookAt 0 0 -2 0 0 0 0 1 0\n");
    run_well(f, "render box.pbrt -q --camera path -o a.#.exr --photons kept --set "
                "integrator=photonmap");
    g_assert_true(folder_has(f, "kept"));
    g_assert_cmpfloat(difference(f, "a.1.exr", "a.2.exr"), ==, 0.0);
    run_well(f, "render box.pbrt -q --camera path -o b.#.exr --photons kept --grain "
                "varying");
    g_assert_cmpfloat(difference(f, "b.1.exr", "b.2.exr"), >, 0.0);
    g_autofree char *kept = folder_read(f, "kept");
    g_assert_true(g_str_has_prefix(kept, "nephroid photons "));
}

static void test_refused(folder *f, gconstpointer data)
{
    (void)data;
    static const refused_run cases[] = {
        {"--frame 3-1 -o a.exr", "--frame: expected a number, or two as in 1-24", 2},
        {"--frame x -o a.exr", "--frame: expected a number", 2},
        {"--frame 1-2", "expected -o FILE too", 2},
        {"--frame 1-2 -o a.exr --every 2", "--every is of one picture", 2},
        {"--frame 1-2 -o a.exr --checkpoint c", "--checkpoint is of one picture", 2},
        {"--fps 25 -o a.exr", "--fps: expected --frame or --camera too", 2},
        {"--frame 1 -o a.exr --grain no", "--grain: expected fixed or varying", 2},
        {"--camera none -o a.exr", "--camera: ", 1},
        {"--camera pipe -o a.exr", "expected a file, found 'pipe', which is none", 1},
        {"--camera path --frame 2-9 -o a.exr", "expected frames 1 to 3", 2},
        {"--camera wrong -o a.exr", "wrong:2: error: expected LookAt and nine", 1},
    };
    g_autofree char *pipe = g_build_filename(f->path, "pipe", NULL);
    g_assert_cmpint(mkfifo(pipe, 0600), ==, 0);
    folder_write(f, "path", path);
    folder_write(f, "wrong", "LookAt 0 0 -2 0 0 0 0 1 0\nLookAt 0 0 -2 0 0 0 0 1\n");
    run_refused(f, "render box.pbrt ", cases, G_N_ELEMENTS(cases));
    g_assert_cmpuint(folder_count(f), ==, 4);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder_add_test("/cli-frames/motion", test_motion);
    folder_add_test("/cli-frames/camera", test_camera);
    folder_add_test("/cli-frames/restart", test_restart);
    folder_add_test("/cli-frames/photons", test_photons);
    folder_add_test("/cli-frames/refused", test_refused);
    return g_test_run();
}
