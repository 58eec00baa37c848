/*
 * What 'nephroid info' says that rendering takes, against the peak of a process that
 * renders, as the system counts it: within a tenth of it, and 4 MiB. These are the
 * process' own, which no scene tells of: code and tables that only rendering touches,
 * stacks of threads, and what malloc keeps of pieces that were freed.
 *
 * And a limit of memory is kept: by fewer photons, or no render.
 */
#include "cli_run.h"

#include <math.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>

#define SHARE 0.1
#define OWN (4.0 * 1024.0 * 1024.0)

/* Two passes, or one. */
#define SAID "\"integer spp\" 1 \"integer passes\" "
#define AUTO "Integrator \"auto\" " SAID
#define PATH "Integrator \"auto\" \"string integrator\" \"path\" " SAID
#define VCM "Integrator \"vcm\" " SAID
#define SPPM "Integrator \"sppm\" \"integer iterations\" "

/* A glass ball over a floor, and the floor alone. */
static const char *const bodies[] = {
    "LightSource \"point\" \"point3 from\" [0 3 3] \"rgb I\" [9 9 9]\n"
    "Shape \"disk\" \"float radius\" 3\n"
    "Material \"dielectric\"\nTranslate 0 0 1 Shape \"sphere\" \"float radius\" 0.5\n",
    "LightSource \"point\" \"point3 from\" [0 3 3] \"rgb I\" [9 9 9]\n"
    "Shape \"disk\" \"float radius\" 3\n",
};

typedef struct example {
    const char *integrator, *passes; /**< and what else is set */
    int width, height, body;
} example;

static void write_scene(const folder *f, const example *e)
{
    g_autofree char *text = g_strdup_printf(
        "%s%s\n"
        "Film \"rgb\" \"integer xresolution\" %d \"integer yresolution\" %d\n"
        "LookAt 0 -6 3 0 0 0.5 0 0 1\nCamera \"perspective\" \"float fov\" 40\n"
        "WorldBegin\n%s",
        e->integrator, e->passes, e->width, e->height, bodies[e->body]);
    folder_write(f, "sized.pbrt", text);
}

static double told(const folder *f)
{
    static const char key[] = "\"rendering\": ";
    g_auto(result) r = run(f, "info --json sized.pbrt");
    const char *at = strstr(r.out, key);
    g_assert_nonnull(at);
    return g_ascii_strtod(at + strlen(key), NULL);
}

static double measured(const folder *f)
{
    const char *argv[] = {run_program(), "render", "sized.pbrt", "-q",
                          "-o",          "a.exr",  NULL};
    GPid child;
    int status = 0;
    struct rusage used;
    g_assert_true(g_spawn_async(f->path, (char **)argv, NULL, G_SPAWN_DO_NOT_REAP_CHILD,
                                NULL, NULL, &child, NULL));
    g_assert_cmpint(wait4(child, &status, 0, &used), ==, child);
    g_assert_cmpint(status, ==, 0);
    return (double)used.ru_maxrss * 1024.0;
}

static void check(const folder *f, const example *e)
{
    write_scene(f, e);
    double expected = told(f), peak = measured(f);
    g_test_message("%s%s, %d x %d, scene %d: told %.1f MiB, measured %.1f", e->integrator,
                   e->passes, e->width, e->height, e->body, expected / 0x1p20,
                   peak / 0x1p20);
    g_assert_cmpfloat(expected, <=, peak * (1.0 + SHARE) + OWN);
    g_assert_cmpfloat(expected, >=, peak * (1.0 - SHARE) - OWN);
}

static void test_info_tells(folder *f, gconstpointer data)
{
    (void)data;
    static const example all[] = {
        {AUTO, "2", 64, 64, 0},
        {PATH, "2", 64, 64, 0},
        {SPPM, "2", 64, 64, 0},
        {SPPM, "2", 64, 64, 1},
        {SPPM, "2 \"integer photonsperiteration\" 400000", 64, 64, 0},
        {VCM, "2", 64, 64, 0},
        {VCM, "2 \"integer photons\" 200000", 64, 64, 0},
        {AUTO, "2", 512, 512, 0},
        {AUTO, "1", 512, 512, 1},
        {PATH, "2 \"bool denoise\" false", 512, 512, 1},
        {SPPM, "2", 256, 256, 0},
        {VCM, "2", 256, 256, 1},
        {PATH, "1", 1024, 768, 1},
        {PATH, "2 \"bool denoise\" false", 1024, 768, 0},
        {PATH, "2", 640, 480, 1}, /* auto plans long, for the same film */
    };
    for (size_t i = 0; i < G_N_ELEMENTS(all); i++)
        check(f, &all[i]);
}

/* ---- A limit ---- */

#define PHOTONS "\"integer photons\" 1500000"

/* Renders that take more than the limits below, most of it for photons. */
static const example greedy[] = {
    {SPPM, "2 \"integer photonsperiteration\" 1500000", 64, 64, 0},
    {AUTO, "2 \"integer caustic_photons\" 900000", 64, 64, 0},
    {VCM, "2 " PHOTONS, 64, 64, 0},
    {"Integrator \"photonmap\" " SAID,
     "2 \"integer photons\" 2500000 \"bool final_gather\" true", 64, 64, 0},
};

/* @return MiB that were taken at most */
static double check_kept(const folder *f, double mebibytes, bool fits)
{
    struct rusage used;
    g_autofree char *limit = g_strdup_printf("%.0fM", mebibytes);
    const char *argv[] = {run_program(), "render", "sized.pbrt", "-o",     "a.exr",
                          "--memory",    limit,    "--stats",    "s.json", NULL};
    GPid child;
    int status = 0;
    g_assert_true(g_spawn_async(f->path, (char **)argv, NULL,
                                G_SPAWN_DO_NOT_REAP_CHILD | G_SPAWN_STDOUT_TO_DEV_NULL |
                                    G_SPAWN_STDERR_TO_DEV_NULL,
                                NULL, NULL, &child, NULL));
    g_assert_cmpint(wait4(child, &status, 0, &used), ==, child);
    g_assert_cmpint(status, ==, 0);
    double peak = (double)used.ru_maxrss / 1024.0;
    g_autofree char *stats = folder_read(f, "s.json");
    g_test_message("limit %.0f MiB, measured %.1f", mebibytes, peak);
    g_assert_cmpfloat(peak, <=, mebibytes * (1.0 + SHARE));
    g_assert_true(fits == !strstr(stats, "\"short_of_memory\": true"));
    if (!fits) /* nor is much of it left unused */
        g_assert_cmpfloat(peak, >=, 0.7 * mebibytes);
    return peak;
}

static void test_limit_is_kept(folder *f, gconstpointer data)
{
    (void)data;
    for (size_t i = 0; i < G_N_ELEMENTS(greedy); i++) {
        write_scene(f, &greedy[i]);
        double all = told(f) / 0x1p20;
        g_test_message("%s%s: told %.1f MiB", greedy[i].integrator, greedy[i].passes,
                       all);
        g_assert_cmpfloat(all, >, 55.0);
        double peak = check_kept(f, ceil(1.3 * all), true);
        g_assert_cmpfloat(fabs(all - peak), <=, SHARE * peak); /* it is told as it is */
        check_kept(f, ceil(0.6 * all), false);
    }
}

/* Before the first pass, with what it takes and what there is; nothing is written. */
static void test_too_much_is_refused(folder *f, gconstpointer data)
{
    (void)data;
    static const example all[] = {
        {PATH, "2", 256, 256, 1}, {AUTO, "2", 256, 256, 0}, {SPPM, "2", 256, 256, 0}};
    for (size_t i = 0; i < G_N_ELEMENTS(all); i++) {
        write_scene(f, &all[i]);
        g_auto(result) r = run(f, "render sized.pbrt -o none.png --memory 76M");
        g_assert_cmpint(r.code, ==, 3);
        const char *at = strstr(r.err, "out of memory: ");
        g_assert_nonnull(at);
        g_assert_nonnull(strstr(at, "MiB at least for rendering"));
        double needs = g_ascii_strtod(at + strlen("out of memory: "), NULL);
        g_assert_cmpfloat(needs, >, 76.0);
        g_assert_nonnull(strstr(r.err, "limit of 76.0 MiB"));
        g_assert_null(strstr(r.err, "1 of 2"));
        g_assert_false(folder_has(f, "none.png"));
        /* What it is said to take is enough. */
        g_autofree char *enough = g_strdup_printf(
            "render sized.pbrt -q -o a.png --memory %.0fM", ceil(needs) + 2.0);
        run_well(f, enough);
    }
}

/* Fewer photons are a setting like any other: who has more memory goes on as before. The
   limit lies between two of the steps that their number is rounded down to, where what a
   process has beside does not decide. */
static void test_limit_is_of_one_process(folder *f, gconstpointer data)
{
    (void)data;
    write_scene(f, &greedy[0]);
    run_well(f, "render sized.pbrt -q -o a.exr --memory 53M");
    run_well(f, "render sized.pbrt -q -o b.exr --memory 53M --passes 1 --set "
                "planned_passes=2 --checkpoint kept");
    run_well(f, "render sized.pbrt -q -o b.exr --resume kept --passes 2");
    g_auto(result) same = run(f, "compare a.exr b.exr --json");
    g_assert_cmpint(same.code, ==, 0);
    g_assert_nonnull(strstr(same.out, "\"rmse\": 0,"));
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder_add_test("/cli/footprint", test_info_tells);
    folder_add_test("/cli/footprint/kept", test_limit_is_kept);
    folder_add_test("/cli/footprint/refused", test_too_much_is_refused);
    folder_add_test("/cli/footprint/goes-on", test_limit_is_of_one_process);
    return g_test_run();
}
