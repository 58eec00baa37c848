/*
 * The command line at work: images and statistics written, settings in their order of
 * precedence, photons saved and told, and Ctrl-C that loses nothing.
 */
#include "cli_run.h"
#include "json_check.h"

#include <glib/gstdio.h>
#include <math.h>
#include <signal.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* ---- Rendering ---- */

static void test_render_writes_all(folder *f, gconstpointer data)
{
    (void)data;
    g_auto(result) r =
        run(f, "render box.pbrt -o a.exr -o a.png --stats a.json --exposure -1");
    g_assert_cmpint(r.code, ==, 0);
    contains(r.out, "wrote a.exr");
    contains(r.out, "wrote a.png");
    contains(r.out, "passes");
    contains(r.err, "100 %");
    g_assert_null(strchr(r.err, '\r'));
    g_autofree char *exr = folder_read(f, "a.exr");
    g_autofree char *json = folder_read(f, "a.json");
    g_assert_cmpmem(exr, 4, "\x76\x2f\x31\x01", 4);
    g_assert_true(json_is_valid(json));
    g_assert_cmpfloat(json_find_number(json, "passes"), ==, 2.0);
    g_assert_cmpfloat(json_find_number(json, "total"), >, 0.0);
    g_assert_cmpfloat(json_find_number(strstr(json, "\"caustic\""), "emitted"), >, 0.0);
    g_assert_cmpfloat(json_find_number(json, "not_finite"), ==, 0.0);
    g_assert_cmpuint(folder_count(f), ==, 4);
}

/* Layers are pictures of their own; what is none is refused before anything is rendered.
 */
static void test_layers(folder *f, gconstpointer data)
{
    (void)data;
    g_auto(result) none = run(f, "render box.pbrt -q --layer nothing=n.png -o a.exr");
    g_assert_cmpint(none.code, ==, 2);
    contains(none.err, "--layer: expected a layer's name (");
    contains(none.err, "caustic");
    contains(none.err, "), found 'nothing'");
    g_assert_false(folder_has(f, "a.exr"));
    g_auto(result) half = run(f, "render box.pbrt -q --layer caustic -o a.exr");
    g_assert_cmpint(half.code, ==, 2);
    contains(half.err, "--layer: expected NAME=FILE, found 'caustic'");
    g_auto(result) twice = run(f, "render box.pbrt -q --layer depth=a.exr -o a.exr");
    g_assert_cmpint(twice.code, ==, 2);
    run_well(f, "render box.pbrt --layer direct=d.pfm --layer normal=n.png -o a.exr");
    run_well(f, "image a.exr --layer direct -o e.pfm");
    run_well(f, "image a.exr --layer normal -o m.png");
    run_well(f, "image a.exr --layer depth -o z.pfm");
    g_auto(result) same = run(f, "compare d.pfm e.pfm --json");
    g_auto(result) normals = run(f, "compare n.png m.png --json");
    g_assert_cmpfloat(json_find_number(same.out, "rmse"), ==, 0.0);
    g_assert_cmpfloat(json_find_number(same.out, "mean_a"), >, 0.0);
    g_assert_cmpfloat(json_find_number(normals.out, "rmse"), ==, 0.0);
    g_auto(result) missing = run(f, "image d.pfm --layer depth -o y.png");
    g_assert_cmpint(missing.code, ==, 2);
    contains(missing.err, "expected a layer's name (raw), found 'depth'");
}

/* A preset stands over the scene, and under what is said otherwise. */
static void test_presets(folder *f, gconstpointer data)
{
    (void)data;
    folder_write(f, "own.settings", "photons = 700\nspp = 2\n");
    run_well(f, "photons box.pbrt -q --preset 003 -o p.ply");
    run_well(f, "render box.pbrt -q --preset 003 --settings own.settings --set spp=1 "
                "--stats s.json -o p.exr");
    g_autofree char *json = folder_read(f, "s.json");
    g_assert_cmpfloat(json_find_number(json, "passes"), ==, 1.0);
    g_assert_cmpfloat(json_find_number(strstr(json, "\"indirect\""), "emitted"), ==,
                      700.0);
    g_assert_cmpfloat(json_find_number(strstr(json, "\"caustic\""), "emitted"), ==, 0.0);
    g_auto(result) list = run(f, "settings --presets");
    g_auto(result) one = run(f, "settings --preset 003");
    g_auto(result) none = run(f, "render box.pbrt --preset 004");
    contains(list.out, "002  ");
    contains(one.out, "photon_survivors = true");
    g_assert_cmpint(none.code, ==, 2);
    contains(none.err, "expected a preset's name (000, 002, 003), found '004'");
}

/* The photons over the wireframe: those of a class alone leave the others out. */
static void test_photon_pictures(folder *f, gconstpointer data)
{
    (void)data;
    run_well(f, "photons box.pbrt -q --size 48x32 --set integrator=photonmap -o all.pfm");
    run_well(f, "photons box.pbrt -q --size 48x32 --set integrator=photonmap --class "
                "indirect -o one.pfm");
    run_well(f, "photons box.pbrt -q --size 48x32 --set integrator=path -o wire.pfm");
    g_auto(result) all = run(f, "compare all.pfm wire.pfm --json");
    g_auto(result) one = run(f, "compare one.pfm wire.pfm --json");
    double of_all = json_find_number(all.out, "mean_a");
    double of_one = json_find_number(one.out, "mean_a");
    double of_wire = json_find_number(all.out, "mean_b");
    g_assert_cmpfloat(of_wire, >, 0.0);
    g_assert_cmpfloat(of_one, >, 1.2 * of_wire);
    g_assert_cmpfloat(of_all, >=, of_one);
    g_auto(result) wrong = run(f, "photons box.pbrt --class red -o a.png");
    g_assert_cmpint(wrong.code, ==, 2);
    contains(wrong.err, "--class: expected direct, indirect or caustic, found 'red'");
    g_auto(result) ply = run(f, "photons box.pbrt --size 8x8 -o a.ply");
    g_assert_cmpint(ply.code, ==, 2);
}

static void test_quiet_is_quiet(folder *f, gconstpointer data)
{
    (void)data;
    g_auto(result) r = run(f, "render box.pbrt -q");
    g_assert_cmpint(r.code, ==, 0);
    g_assert_cmpstr(r.out, ==, "");
    g_assert_cmpstr(r.err, ==, "");
    g_assert_true(folder_has(f, "box.exr"));
    g_assert_cmpuint(folder_count(f), ==, 2);
}

/* What is decided, in words, the same on any number of threads; and a picture. */
static void test_explain(folder *f, gconstpointer data)
{
    (void)data;
    static const char *const words[] = {"plan        ", "photons     ", "radius      ",
                                        "bright spots", "slices      ", "planning    "};
    g_auto(result) one = run(f, "render box.pbrt -q --explain -j 1 -o one.exr");
    g_auto(result) three = run(f, "render box.pbrt -q --explain -j 3");
    g_auto(result) none = run(f, "render box.pbrt -q --explain --integrator path");
    g_assert_cmpint(one.code, ==, 0);
    for (size_t i = 0; i < G_N_ELEMENTS(words); i++)
        contains(one.out, words[i]);
    g_assert_cmpstr(one.out, ==, three.out);
    contains(none.out, "photons     none");
    g_assert_true(folder_has(f, "one.exr"));
}

static void test_scene_names_the_output(folder *f, gconstpointer data)
{
    (void)data;
    static const char *const names[] = {"named.pfm", "../named.pfm", "/named.pfm",
                                        "a/b/named.pfm"};
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        g_autofree char *scene =
            g_strconcat(scene_head, "    \"string filename\" \"", names[i], "\"\n",
                        scene_integrator, scene_body, NULL);
        folder_write(f, "box.pbrt", scene);
        run_well(f, "render box.pbrt -q");
        g_assert_true(folder_has(f, "named.pfm"));
        g_assert_cmpuint(folder_count(f), ==, 2);
        g_autofree char *path = g_build_filename(f->path, "named.pfm", NULL);
        g_assert_cmpint(g_remove(path), ==, 0);
    }
}

/* ---- Exposure ---- */

/* Red in the middle of a picture of any kind, linear. */
static double middle_of(const folder *f, const char *name)
{
    int width, height;
    float pixel[3];
    g_autofree char *line = g_strdup_printf("image %s -o middle.pfm", name);
    g_autofree char *path = g_build_filename(f->path, "middle.pfm", NULL);
    run_well(f, line);
    g_autofree char *bytes = folder_read(f, "middle.pfm");
    const char *scale = strchr(strchr(bytes, '\n') + 1, '\n') + 1;
    g_assert_cmpint(sscanf(bytes, "PF %d %d", &width, &height), ==, 2);
    memcpy(pixel, strchr(scale, '\n') + 1 + 12 * (width * (height / 2) + width / 2),
           sizeof pixel);
    g_assert_cmpint(g_remove(path), ==, 0);
    return (double)pixel[0];
}

/* A square of white, 0.8, that a lamp of so many lux shines on straight. */
static void write_gltf(const folder *f, const char *lux)
{
    static const float corners[] = {-1, -1, 0, 1, -1, 0, 1,  1, 0,
                                    -1, -1, 0, 1, 1,  0, -1, 1, 0};
    g_autofree char *code = g_base64_encode((const guchar *)corners, sizeof corners);
    g_autofree char *text = g_strdup_printf(
        "{\"asset\":{\"version\":\"2.0\"},\"materials\":[{\"pbrMetallicRoughness\":{"
        "\"baseColorFactor\":[0.8,0.8,0.8,1],\"metallicFactor\":0},\"extensions\":{"
        "\"KHR_materials_specular\":{\"specularFactor\":0}}}],\"meshes\":[{"
        "\"primitives\":[{"
        "\"attributes\":{\"POSITION\":0},\"material\":0}]}],\"cameras\":[{\"type\":"
        "\"perspective\",\"perspective\":{\"yfov\":0.5,\"aspectRatio\":1}}],\"nodes\":[{"
        "\"mesh\":0},{\"camera\":0,\"translation\":[0,0,3]},{\"extensions\":{"
        "\"KHR_lights_punctual\":{\"light\":0}}}],\"extensions\":{\"KHR_lights_"
        "punctual\":{"
        "\"lights\":[{\"type\":\"directional\",\"intensity\":%s}]}},\"buffers\":[{"
        "\"byteLength\":72,\"uri\":\"data:application/octet-stream;base64,%s\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":72}],\"accessors\":[{"
        "\"bufferView\":0,"
        "\"componentType\":5126,\"count\":6,\"type\":\"VEC3\"}]}",
        lux, code);
    folder_write(f, "sun.gltf", text);
}

#define RENDER_SUN "render sun.gltf --size 8x8 --passes 1 --spp 4 -o a.png -o a.pfm"

/* 2.5 lx are a picture as viewers show it, 0.8 * 2.5 / pi; what would show nothing is
   exposed, which is said, unless an exposure is asked for. Floats are true. */
static void test_exposure_of_gltf(folder *f, gconstpointer data)
{
    (void)data;
    static const struct {
        const char *lux, *more, *said;
        double seen; /* 0: not asked */
    } cases[] = {
        {"2.5", "", NULL, 0.8 * 2.5 / G_PI},
        {"0.002", "", "are exposed by +10", 0.0},
        {"100000", "", "are exposed by -15", 0.0},
        {"0.002", " --exposure 0", "'--exposure 10' shows it", 0.8 * 0.002 / G_PI},
        {"0.002", " --exposure 10", NULL, 1024 * 0.8 * 0.002 / G_PI},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autofree char *line = g_strconcat(RENDER_SUN, cases[i].more, NULL);
        write_gltf(f, cases[i].lux);
        g_auto(result) r = run(f, line);
        g_assert_cmpint(r.code, ==, 0);
        g_test_message("%s%s: %s", cases[i].lux, cases[i].more, r.err);
        g_assert_true((strstr(r.err, "exposure") != NULL) == (cases[i].said != NULL));
        if (cases[i].said)
            contains(r.err, cases[i].said);
        double seen = middle_of(f, "a.png"), light = middle_of(f, "a.pfm");
        double expected = 0.8 * g_ascii_strtod(cases[i].lux, NULL) / G_PI;
        g_assert_cmpfloat(fabs(light / expected - 1.0), <, 0.04);
        if (cases[i].seen > 0.0)
            g_assert_cmpfloat(fabs(seen - cases[i].seen), <, 0.03);
        else
            g_assert_true(seen > 0.3 && seen < 0.7);
    }
}

/* A pbrt scene is shown as it says; that it shows nothing is told. */
static void test_exposure_of_pbrt(folder *f, gconstpointer data)
{
    (void)data;
    g_auto(result) good = run(f, "render box.pbrt -q -o a.pfm -o a.png");
    g_assert_cmpstr(good.err, ==, "");
    g_auto(result) low = run(f, "render box.pbrt -q -o b.png -o b.pfm --exposure -12");
    contains(low.err, "warning: the picture is nearly black: '--exposure ");
    g_auto(result) again = run(f, "image a.pfm -o c.png --exposure -12");
    contains(again.err, "warning: the picture is nearly black: '--exposure ");
    g_auto(result) floats = run(f, "image a.pfm -o c.pfm --exposure -12");
    g_assert_cmpstr(floats.err, ==, "");
    g_assert_cmpfloat(fabs(middle_of(f, "a.pfm") - middle_of(f, "b.pfm")), <, 1e-9);
}

static void test_order_of_settings(folder *f, gconstpointer data)
{
    (void)data;
    static const struct {
        const char *arguments;
        double passes;
    } cases[] = {
        {"", 2.0},
        {"--settings three.ini", 3.0},
        {"--set passes=5 --settings three.ini --set passes=4", 4.0},
        {"--passes 1 --set passes=4 --settings three.ini", 1.0},
    };
    folder_write(f, "three.ini", "# comment\npasses = 3\n");
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autofree char *line = g_strdup_printf(
            "render box.pbrt -q --size 4x4 --stats s.json %s", cases[i].arguments);
        run_well(f, line);
        g_autofree char *json = folder_read(f, "s.json");
        g_assert_cmpfloat(json_find_number(json, "passes"), ==, cases[i].passes);
    }
}

/* Settings that do nothing are said, wherever they are set; those that act are not. */
static void test_unread_settings(folder *f, gconstpointer data)
{
    (void)data;
    static const struct {
        const char *arguments;
        unsigned notes;
    } cases[] = {
        {"--integrator auto --set final_gather=true", 1},
        {"--integrator auto --set final_gather=false --set gather_rays=4", 2},
        {"--integrator path --settings two.ini --set spp=1", 2},
        {"--set final_gather=true --integrator photonmap", 0},
        {"--integrator vcm --set photons=100 --passes 1 --seed 2 -j1", 0},
    };
    folder_write(f, "two.ini", "final_gather = true\nphotons = 100\n");
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autofree char *line =
            g_strdup_printf("render box.pbrt --size 4x4 %s", cases[i].arguments);
        g_auto(result) r = run(f, line);
        g_assert_cmpint(r.code, ==, 0);
        g_assert_cmpuint(count_parts(r.err, "is not read by"), ==, cases[i].notes);
    }
    g_auto(result) one = run(f, "render box.pbrt --size 4x4 --integrator auto "
                                "--set final_gather=true");
    contains(one.err, "note: final_gather is not read by auto, only by photonmap\n");
    g_autofree char *scene = g_strconcat(
        scene_head, "Integrator \"auto\" \"bool final_gather\" true\n", scene_body, NULL);
    folder_write(f, "idle.pbrt", scene);
    g_auto(result) in_file = run(f, "render idle.pbrt --size 4x4");
    contains(in_file.err, "idle.pbrt:5:");
    contains(in_file.err, "final_gather is not read by auto, only by photonmap\n");
}

/* auto sends no more photons than pay, also where more are asked for, and says so. */
static void test_photons_capped(folder *f, gconstpointer data)
{
    (void)data;
    g_auto(result) capped =
        run(f, "render box.pbrt --integrator auto --set photons=100000000000");
    g_assert_cmpint(capped.code, ==, 0);
    contains(capped.err, "note: of photons = 100000000000 a pass ");
    g_auto(result) all = run(f, "render box.pbrt --set photons=1000");
    g_assert_null(strstr(all.err, "of photons"));
}

/* A letter may have its value at once, numbers their unit. */
static void test_ways_to_say_it(folder *f, gconstpointer data)
{
    (void)data;
    static const char *const same[] = {
        "render box.pbrt -q -oa.pfm -sspp=2 -j1",
        "render box.pbrt -qoa.pfm -s spp=2 -j 1",
        "render -qj1 -oa.pfm --set spp=2 box.pbrt",
        ("render -q -j1 -o a.pfm --time 1000s --set 'spp = 2 samples/pixel' "
         "--passes 2 -- box.pbrt"),
    };
    g_autofree char *path = g_build_filename(f->path, "a.pfm", NULL);
    g_autofree char *first = NULL;
    gsize size = 0;
    for (size_t i = 0; i < G_N_ELEMENTS(same); i++) {
        run_well(f, same[i]);
        g_autofree char *bytes = NULL;
        gsize n = 0;
        g_assert_true(g_file_get_contents(path, &bytes, &n, NULL));
        g_assert_cmpint(g_remove(path), ==, 0);
        if (first)
            g_assert_cmpmem(bytes, n, first, size);
        else
            first = g_steal_pointer(&bytes), size = n;
    }
    static const char *const wrong[] = {"-jx", "-k1", "--time 30m", "--time s",
                                        "--exposure -x"};
    for (size_t i = 0; i < G_N_ELEMENTS(wrong); i++) {
        g_autofree char *line = g_strdup_printf("render box.pbrt %s", wrong[i]);
        g_auto(result) r = run(f, line);
        g_assert_cmpint(r.code, ==, 2);
    }
    run_well(f, "render box.pbrt -q -o -j1.pfm"); /* a value that looks like an option */
    g_assert_true(folder_has(f, "-j1.pfm"));
}

/* ---- When it ends ---- */

static void test_stops_by_rules(folder *f, gconstpointer data)
{
    (void)data;
    static const struct {
        const char *arguments, *stopped_by;
        double least, most;
    } cases[] = {
        {"--passes 3", "\"passes\"", 3, 3},
        {"--set passes=0", "\"passes\"", 16, 16},
        {"--noise 1", "\"noise\"", 4, 4}, /* the scene's two passes are no limit */
        {"--noise 1e-9 --passes 5", "\"passes\"", 5, 5},
        {"--time 1", "\"time\"", 1, 1e9},
        {"--time 1e6 --set passes=3", "\"passes\"", 3, 3},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autofree char *line = g_strdup_printf(
            "render box.pbrt -q --size 4x4 --stats s.json %s", cases[i].arguments);
        run_well(f, line);
        g_autofree char *json = folder_read(f, "s.json");
        const double passes = json_find_number(json, "passes");
        g_test_message("%s: %g passes", cases[i].arguments, passes);
        g_assert_true(json_is_valid(json));
        contains(strstr(json, "stopped_by"), cases[i].stopped_by);
        g_assert_cmpfloat(passes, >=, cases[i].least);
        g_assert_cmpfloat(passes, <=, cases[i].most);
    }
}

/* A pass would take minutes: the picture is there all the same, and not black. */
static void test_time_is_short(folder *f, gconstpointer data)
{
    (void)data;
    double start = (double)g_get_monotonic_time() * 1e-6;
    g_auto(result) r = run(f, "render box.pbrt --size 800x600 --spp 4000 --time 0.5 -o "
                              "a.pfm");
    double took = (double)g_get_monotonic_time() * 1e-6 - start;
    g_test_message("%g s", took);
    g_assert_cmpint(r.code, ==, 0);
    contains(r.err, "note: ");
    contains(r.out, "stopped by time");
    g_assert_cmpfloat(took, <, 10.0); /* on a busy machine */
    run_well(f, "image a.pfm -o one.pfm --size 1x1");
    g_autofree char *path = g_build_filename(f->path, "one.pfm", NULL);
    g_autofree char *one = NULL;
    gsize size;
    float red;
    g_assert_true(g_file_get_contents(path, &one, &size, NULL));
    memcpy(&red, one + size - 3 * sizeof red, sizeof red);
    g_assert_cmpfloat((double)red, >, 0.0);
}

/* Looks at the image of a render under way until it has changed so often; each time it
   must be whole. */
static void test_every(folder *f, gconstpointer data)
{
    enum { CHANGES = 3, TRIES = 6000 };
    (void)data;
    g_autofree char *path = g_build_filename(f->path, "a.pfm", NULL);
    const char *arguments[] = {run_program(), "render",  "box.pbrt", "-q",
                               "-o",          "a.pfm",   "--every",  "0.05s",
                               "--passes",    "1000000", NULL};
    GPid child;
    g_assert_true(g_spawn_async(f->path, (char **)arguments, NULL,
                                G_SPAWN_DO_NOT_REAP_CHILD, NULL, NULL, &child, NULL));
    g_autofree char *last = NULL;
    gsize size = 0, first_size = 0;
    int changes = 0;
    for (int tries = 0; tries < TRIES && changes < CHANGES; tries++) {
        g_autofree char *now = NULL;
        g_usleep(5000);
        if (!g_file_get_contents(path, &now, &size, NULL))
            continue;
        first_size = first_size ? first_size : size;
        g_assert_cmpuint(size, ==, first_size);
        if (!last || memcmp(now, last, size) != 0) {
            changes++;
            g_free(last);
            last = g_steal_pointer(&now);
        }
    }
    int status;
    kill(child, SIGINT);
    g_assert_cmpint(waitpid(child, &status, 0), ==, child);
    g_assert_cmpint(changes, ==, CHANGES);
    g_assert_cmpuint(first_size, >=, 16 * 12 * 3 * sizeof(float));
    g_assert_cmpint(WEXITSTATUS(status), ==, 3);
    g_assert_cmpuint(folder_count(f), ==, 2);
}

static void test_every_is_read(folder *f, gconstpointer data)
{
    (void)data;
    const char *const wrong[] = {"0", "-1", "s", "1.5", "0s", "3m", "''", "1e99s"};
    for (size_t i = 0; i < G_N_ELEMENTS(wrong); i++) {
        g_autofree char *line = g_strdup_printf("render box.pbrt --every=%s", wrong[i]);
        g_auto(result) r = run(f, line);
        g_assert_cmpint(r.code, ==, 2);
        contains(r.err, "--every: expected a number of passes");
    }
    run_well(f, "render box.pbrt -q --every 1");
}

/* ---- Ctrl-C ---- */

static void stop_by(const folder *f, int signal_number)
{
    g_autofree char *name = NULL;
    int terminal = terminal_open(&name);
    if (terminal < 0) {
        g_test_skip("no pseudo-terminals here");
        return;
    }
    const char *argv[] = {run_program(), "render",  "box.pbrt", "--passes", "1000000",
                          "-o",          "cut.exr", "--stats",  "cut.json", NULL};
    GPid child;
    g_autoptr(GError) error = NULL;
    g_autoptr(GString) seen = g_string_new(NULL);
    g_spawn_async(f->path, (char **)argv, NULL,
                  G_SPAWN_DO_NOT_REAP_CHILD | G_SPAWN_STDOUT_TO_DEV_NULL, terminal_enter,
                  name, &child, &error);
    g_assert_no_error(error);
    bool begun = terminal_wait(terminal, "pass 2", seen);
    kill(child, begun ? signal_number : SIGKILL);
    bool told = begun && terminal_wait(terminal, "writing what there is", seen);
    if (!told)
        kill(child, SIGKILL);
    int status = 0;
    g_assert_cmpint(waitpid(child, &status, 0), ==, child);
    close(terminal);
    g_test_message("%s", seen->str);
    g_assert_true(begun && told);
    g_assert_true(WIFEXITED(status));
    g_assert_cmpint(WEXITSTATUS(status), ==, 3);
    contains(seen->str, "\r[");
}

static void test_ctrl_c_writes(folder *f, gconstpointer data)
{
    stop_by(f, GPOINTER_TO_INT(data));
    g_autofree char *json = folder_read(f, "cut.json");
    if (g_test_failed() || !json)
        return;
    g_assert_true(json_is_valid(json));
    g_assert_cmpfloat(json_find_number(json, "passes"), >=, 1.0);
    g_auto(result) same = run(f, "compare cut.exr cut.exr");
    g_assert_cmpint(same.code, ==, 0);
}

/* ---- The other commands ---- */

static void test_compare(folder *f, gconstpointer data)
{
    (void)data;
    run_well(f, "render box.pbrt -q -o a.exr");
    run_well(f, "render box.pbrt -q -o b.exr --seed 9");
    run_well(f, "render box.pbrt -q -o c.exr --size 8x8");
    g_auto(result) same = run(f, "compare a.exr a.exr --metric rmse");
    g_assert_cmpstr(same.out, ==, "0\n");
    g_auto(result) other = run(f, "compare a.exr b.exr --json");
    g_assert_true(json_is_valid(other.out));
    g_assert_cmpfloat(json_find_number(other.out, "rmse"), >, 0.0);
    g_auto(result) one = run(f, "compare a.exr a.exr --json --metric psnr");
    g_assert_true(json_is_valid(one.out));
    contains(one.out, "null");
    g_auto(result) size = run(f, "compare a.exr c.exr");
    g_assert_cmpint(size.code, ==, 1);
}

/* The map of a picture against a darker one is red, of equal ones black; sheets have room
   for all; a scaled image has the mean. */
static void test_image(folder *f, gconstpointer data)
{
    (void)data;
    run_well(f, "render box.pbrt -q -o a.exr --size 12x8");
    run_well(f, "compare a.exr a.exr -o map.pfm");
    run_well(f, "image a.exr -o small.exr --size 3x2");
    run_well(f, "image small.exr -o back.exr --size 12x8");
    g_auto(result) means = run(f, "compare back.exr a.exr --json");
    double a = json_find_number(means.out, "mean_a");
    g_assert_cmpfloat(fabs(a - json_find_number(means.out, "mean_b")), <, 1e-5 * a);
    run_well(f, "image a.exr small.exr a.exr -o sheet.pfm --columns 2");
    g_autofree char *sheet = folder_read(f, "sheet.pfm");
    g_assert_true(g_str_has_prefix(sheet, "PF\n27 28\n"));
    g_autofree char *map = folder_read(f, "map.pfm");
    g_assert_true(g_str_has_prefix(map, "PF\n12 8\n"));
    g_auto(result) none = run(f, "image nowhere.exr -o b.png");
    g_assert_cmpint(none.code, ==, 1);
    g_auto(result) wrong = run(f, "compare a.exr small.exr -o other.png");
    g_assert_cmpint(wrong.code, ==, 1);
    g_autofree char *other = g_build_filename(f->path, "other.png", NULL);
    g_assert_false(g_file_test(other, G_FILE_TEST_EXISTS));
}

static void test_photons(folder *f, gconstpointer data)
{
    (void)data;
    g_auto(result) r = run(f, "photons box.pbrt -o p.ply");
    g_assert_cmpint(r.code, ==, 0);
    contains(r.out, "trace time");
    contains(r.out, "photon rays");
    contains(r.out, "caustic");
    g_autofree char *ply = folder_read(f, "p.ply");
    g_assert_true(g_str_has_prefix(ply, "ply\nformat binary_"));
    size_t n = (size_t)g_ascii_strtoull(strstr(ply, "element vertex ") + 15, NULL, 10);
    g_assert_cmpuint(n, >, 0);
    g_autofree char *path = g_build_filename(f->path, "p.ply", NULL);
    GStatBuf info;
    g_stat(path, &info);
    size_t header = (size_t)(strstr(ply, "end_header\n") - ply) + 11;
    g_assert_cmpuint((size_t)info.st_size, ==, header + 37 * n);
    g_auto(result) told = run(f, "photons box.pbrt --trace 2");
    g_assert_cmpint(told.code, ==, 0);
    g_assert_cmpuint(count_parts(told.out, "\n"), >=, 4);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder_add_test("/cli/render", test_render_writes_all);
    folder_add_test("/cli/layers", test_layers);
    folder_add_test("/cli/presets", test_presets);
    folder_add_test("/cli/photon-pictures", test_photon_pictures);
    folder_add_test("/cli/quiet", test_quiet_is_quiet);
    folder_add_test("/cli/explain", test_explain);
    folder_add_test("/cli/named", test_scene_names_the_output);
    folder_add_test("/cli/render/exposure-of-gltf", test_exposure_of_gltf);
    folder_add_test("/cli/render/exposure-of-pbrt", test_exposure_of_pbrt);
    folder_add_test("/cli/order", test_order_of_settings);
    folder_add_test("/cli/render/unread", test_unread_settings);
    folder_add_test("/cli/render/photons-capped", test_photons_capped);
    folder_add_test("/cli/render/ways", test_ways_to_say_it);
    folder_add_test("/cli/render/stops-by-rules", test_stops_by_rules);
    folder_add_test("/cli/render/time-is-short", test_time_is_short);
    folder_add_test("/cli/render/every", test_every);
    folder_add_test("/cli/render/every-is-read", test_every_is_read);
    g_test_add("/cli/interrupt", folder, GINT_TO_POINTER(SIGINT), folder_set_up,
               test_ctrl_c_writes, folder_tear_down);
    g_test_add("/cli/terminate", folder, GINT_TO_POINTER(SIGTERM), folder_set_up,
               test_ctrl_c_writes, folder_tear_down);
    g_test_add("/cli/hang-up", folder, GINT_TO_POINTER(SIGHUP), folder_set_up,
               test_ctrl_c_writes, folder_tear_down);
    folder_add_test("/cli/compare", test_compare);
    folder_add_test("/cli/image", test_image);
    folder_add_test("/cli/photons", test_photons);
    return g_test_run();
}
