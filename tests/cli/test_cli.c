/*
 * The command line before anything is rendered: help everywhere, exit codes, messages
 * that name the place, and no file left by what was refused.
 */
#include "cli_run.h"
#include "json_check.h"

/* ---- Help, version, usage ---- */

static void test_help_everywhere(folder *f, gconstpointer data)
{
    (void)data;
    static const char *const commands[] = {
        "",          "render ", "photons ",  "info ", "compare ",
        "settings ", "image ",  "features ", "bsdf ", "view "};
    for (size_t i = 0; i < G_N_ELEMENTS(commands); i++) {
        g_autofree char *help = g_strconcat(commands[i], "--help", NULL);
        g_autofree char *version = g_strconcat(commands[i], "--version", NULL);
        g_auto(result) helped = run(f, help);
        g_auto(result) told = run(f, version);
        g_assert_cmpint(helped.code, ==, 0);
        g_assert_cmpint(told.code, ==, 0);
        contains(helped.out, "Usage:");
        contains(helped.out, "--version");
        g_assert_true(g_str_has_prefix(told.out, "nephroid 0."));
        g_assert_cmpstr(helped.err, ==, "");
    }
}

static void test_bad_usage(folder *f, gconstpointer data)
{
    (void)data;
    static const char *const cases[][2] = {
        {"", "no command"},
        {"rendr box.pbrt", "unknown command 'rendr'"},
        {"render", "expected SCENE"},
        {"render a.pbrt b.pbrt", "unexpected argument 'b.pbrt'"},
        {"render box.pbrt --frobnicate", "--frobnicate"},
        {"render box.pbrt --spp 4x", "'spp': expected a whole number"},
        {"render box.pbrt --spp 4.5", "'spp'"},
        {"render box.pbrt --passes -1", "'passes'"},
        {"render box.pbrt --seed -1", "'seed'"},
        {"render box.pbrt --threads many", "'threads'"},
        {"render box.pbrt --integrator magic", "expected one of photonmap, path"},
        {"render box.pbrt --set photns=1", "did you mean 'photons'?"},
        {"render box.pbrt --set photons", "expected name=value"},
        {"render box.pbrt --set alpha=1,5", "'alpha'"},
        {"render box.pbrt --size 10", "--size"},
        {"render box.pbrt --size 0x10", "--size"},
        {"render box.pbrt --size 10x10x10", "--size"},
        {"render box.pbrt --size 99999999999x1", "--size"},
        {"render box.pbrt --exposure bright", "--exposure"},
        {"render box.pbrt --exposure nan", "--exposure"},
        {"photons box.pbrt --trace -1", "--trace"},
        {"photons box.pbrt --trace 2.5", "--trace"},
        {"info", "expected SCENE"},
        {"info box.pbrt --memory lots", "--memory: expected a size as 2G or 500M"},
        {"info box.pbrt --memory 0", "--memory"},
        {"info box.pbrt --memory 2GG", "--memory"},
        {"info box.pbrt --memory -2G", "--memory"},
        {"compare a.exr", "expected IMAGE REFERENCE"},
        {"compare a.exr b.exr --metric ssim", "expected rmse, relmse, psnr or flip"},
        {"image", "expected IMAGE..."},
        {"image a.exr b.exr", "-o FILE is missing"},
        {"image a.exr -o b.png --size 3", "--size"},
        {"image a.exr -o b.png --columns 0", "--columns"},
        {"settings --json --markdown", "exclude each other"},
        {"settings box.pbrt", "unexpected argument 'box.pbrt'"},
        {"bsdf", "expected MATERIAL"},
        {"bsdf diffuse --incidence 90", "--incidence"},
        {"bsdf purple --scene box.pbrt", "no material 'purple'"},
        {"view --frobnicate", "--frobnicate"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_auto(result) r = run(f, cases[i][0]);
        g_assert_cmpint(r.code, ==, 2);
        g_assert_cmpstr(r.out, ==, "");
        contains(r.err, cases[i][1]);
        contains(r.err, "--help'");
    }
    g_assert_cmpuint(folder_count(f), ==, 1);
}

static void test_settings_listed(folder *f, gconstpointer data)
{
    (void)data;
    g_auto(result) text = run(f, "settings");
    g_auto(result) json = run(f, "settings --json");
    g_auto(result) markdown = run(f, "settings --markdown");
    g_assert_true(json_is_valid(json.out));
    unsigned n = count_parts(json.out, "\"name\":");
    g_assert_cmpuint(n, >, 30);
    g_assert_cmpuint(count_parts(markdown.out, "\n"), ==, n + 2);
    g_assert_cmpuint(count_parts(text.out, "Read by:"), ==, n);
    g_assert_cmpint(text.code | json.code | markdown.code, ==, 0);
}

/* ---- Bad input ---- */

static const char nan_mesh[] = "WorldBegin\nLightSource \"point\"\n"
                               "Shape \"trianglemesh\" \"integer indices\" [0 1 2]\n"
                               "    \"point3 P\" [0 0 0  nan 0 0  0 1 0]\n";
static const char zero_light[] =
    "WorldBegin\nAreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n"
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2]\n"
    "    \"point3 P\" [0 0 0  1 0 0  2 0 0]\n";
static const char unknown[] = "WorldBegin\nFrobnicate \"x\"\n";
static const char wrong_type[] =
    "WorldBegin\nLightSource \"point\"\nShape \"sphere\" \"string radius\" \"big\"\n";
static const char bad_ply[] =
    "WorldBegin\nLightSource \"point\"\nShape \"plymesh\" \"string filename\" "
    "\"cut.ply\"\n";
static const char cut_ply[] =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
    "end_header\n0 0 0\n1 0 0\n";
static const char huge_film[] = "Film \"rgb\" \"integer xresolution\" 2000000000\n"
                                "    \"integer yresolution\" 2000000000\n";

/* Renders a scene that must be refused with a message that holds `part`. */
static void refuse(const folder *f, const char *first, const char *second,
                   const char *part)
{
    g_autofree char *scene = g_strconcat(first, second, NULL);
    folder_write(f, "bad.pbrt", scene);
    unsigned before = folder_count(f);
    g_auto(result) r = run(f, "render bad.pbrt -o bad.exr --stats bad.json");
    g_assert_cmpint(r.code, ==, 1);
    g_assert_cmpstr(r.out, ==, "");
    contains(r.err, part);
    contains(r.err, "error: ");
    g_assert_cmpuint(folder_count(f), ==, before);
}

/* As compilers say it: what begins a line of stderr is a place, then what kind of line it
 * is; without a place, the kind. */
static void test_form_of_messages(folder *f, gconstpointer data)
{
    static const char *const cases[][3] = {
        {"unknown", "render bad.pbrt", "bad.pbrt:6:1: error: expected a directive"},
        {"no file", "render none.pbrt", "error: "},
        {"usage", "frobnicate", "error: unknown command 'frobnicate'\nnote: try "},
        {"option", "render --frobnicate", "error: "},
        {"folder", "info .", ".: error: "},
    };
    (void)data;
    g_autofree char *bad = g_strconcat(scene_head, unknown, NULL);
    folder_write(f, "bad.pbrt", bad);
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_auto(result) r = run(f, cases[i][1]);
        if (!g_str_has_prefix(r.err, cases[i][2]))
            g_error("%s: expected %s, found %s", cases[i][0], cases[i][2], r.err);
    }
    g_autofree char *noted =
        g_strconcat("Accelerator \"bvh\"\n", scene_head, scene_body, NULL);
    folder_write(f, "noted.pbrt", noted);
    g_auto(result) r = run(f, "info noted.pbrt");
    g_assert_true(g_str_has_prefix(r.err, "noted.pbrt:1:13: note: Accelerator 'bvh'"));
    g_autofree char *strange = g_strconcat(
        scene_head, "WorldBegin LightSource \"point\"\nMaterial \"hair\"\n", NULL);
    folder_write(f, "hair.pbrt", strange);
    g_auto(result) warned = run(f, "info --lenient hair.pbrt");
    contains(warned.err, "hair.pbrt:6:1: warning: material \"hair\" becomes");
}

static void test_bad_input(folder *f, gconstpointer data)
{
    (void)data;
    folder_write(f, "cut.ply", cut_ply);
    refuse(f, scene_head, unknown, "bad.pbrt:6:1: ");
    refuse(f, scene_head, wrong_type, "bad.pbrt:7:");
    refuse(f, scene_head, nan_mesh, "bad.pbrt:");
    refuse(f, scene_head, zero_light, "bad.pbrt:");
    refuse(f, scene_head, bad_ply, "cut.ply");
    refuse(f, huge_film, scene_body, "bad.pbrt:");
    refuse(f, "Integrator \"photonmap\" \"integer photns\" 1\n", scene_body,
           "bad.pbrt:1:");
}

static void test_missing_files(folder *f, gconstpointer data)
{
    (void)data;
    static const char *const cases[] = {
        "render nowhere.pbrt -o x.exr",
        "info nowhere.pbrt",
        "photons nowhere.pbrt",
        "compare nowhere.exr nowhere.exr",
        "render box.pbrt --settings nowhere.ini",
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_auto(result) r = run(f, cases[i]);
        g_assert_cmpint(r.code, ==, 1);
        contains(r.err, "nowhere.");
    }
    g_assert_cmpuint(folder_count(f), ==, 1);
}

static void test_unwritable_output(folder *f, gconstpointer data)
{
    (void)data;
    static const char *const cases[][2] = {
        {"render box.pbrt -o missing/x.exr", "missing/x.exr"},
        {"render box.pbrt -o good.exr -o missing/x.png", "missing/x.png"},
        {"render box.pbrt -o x.tiff", "x.tiff"},
        {"render box.pbrt -o x.exr --stats missing/x.json", "missing/x.json"},
        {"render nowhere.pbrt -o missing/x.exr", "missing/x.exr"},
        {"photons box.pbrt -o missing/x.ply", "missing/x.ply"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_auto(result) r = run(f, cases[i][0]);
        g_assert_cmpint(r.code, ==, 1);
        contains(r.err, cases[i][1]);
        g_assert_cmpuint(folder_count(f), ==, 1);
    }
}

static void test_settings_file_is_read_strictly(folder *f, gconstpointer data)
{
    (void)data;
    folder_write(f, "bad.ini", "passes = 3\nspp = lots\n");
    g_auto(result) r = run(f, "render box.pbrt --settings bad.ini");
    g_assert_cmpint(r.code, ==, 1);
    contains(r.err, "bad.ini:2:");
}

/* ---- The other commands ---- */

static void test_info(folder *f, gconstpointer data)
{
    (void)data;
    g_auto(result) text = run(f, "info box.pbrt");
    g_assert_cmpint(text.code, ==, 0);
    contains(text.out, "sphere         2");
    contains(text.out, "point          1");
    contains(text.out, "1 casting caustics");
    contains(text.out, "16 x 12 pixels");
    contains(text.out, "passes         2");
    g_auto(result) json = run(f, "info --json box.pbrt");
    g_assert_cmpint(json.code, ==, 0);
    g_assert_true(json_is_valid(json.out));
    g_assert_cmpfloat(json_find_number(json.out, "width"), ==, 16.0);
}

/* Any command takes a limit, and tells who wanted more. */
static void test_memory(folder *f, gconstpointer data)
{
    (void)data;
    run_well(f, "info box.pbrt --memory 1.5G");
    run_well(f, "render box.pbrt -q --memory=500m");
    g_auto(result) info = run(f, "info box.pbrt --memory 1K");
    g_auto(result) render = run(f, "render box.pbrt -q --memory 40K -o none.png");
    g_assert_cmpint(info.code, ==, 3);
    g_assert_cmpint(render.code, ==, 3);
    contains(info.err, "box.pbrt: error: out of memory: ");
    contains(info.err, "limit of 1.0 KiB");
    contains(render.err, "limit of 40.0 KiB");
    g_assert_false(folder_has(f, "none.png"));
}

static void test_bsdf(folder *f, gconstpointer data)
{
    (void)data;
    run_well(f, "bsdf 'diffuse \"rgb reflectance\" [.2 .3 .4]' -o paint.svg");
    g_autofree char *paint = folder_read(f, "paint.svg");
    contains(paint, "<svg");
    g_auto(result) named = run(f, "bsdf dielectric --scene box.pbrt --incidence 30");
    g_assert_cmpint(named.code, ==, 0);
    contains(named.out, "30°");
    g_auto(result) wrong = run(f, "bsdf conduktor");
    g_assert_cmpint(wrong.code, ==, 1);
    contains(wrong.err, "MATERIAL");
    g_assert_cmpuint(folder_count(f), ==, 2);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder_add_test("/cli/help", test_help_everywhere);
    folder_add_test("/cli/usage", test_bad_usage);
    folder_add_test("/cli/settings", test_settings_listed);
    folder_add_test("/cli/input", test_bad_input);
    folder_add_test("/cli/form-of-messages", test_form_of_messages);
    folder_add_test("/cli/missing", test_missing_files);
    folder_add_test("/cli/unwritable", test_unwritable_output);
    folder_add_test("/cli/settings-file", test_settings_file_is_read_strictly);
    folder_add_test("/cli/info", test_info);
    folder_add_test("/cli/bsdf", test_bsdf);
    folder_add_test("/cli/memory", test_memory);
    return g_test_run();
}
