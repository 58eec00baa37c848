/*
 * What `auto` costs where photons bring nothing: thread seconds of a render, setup
 * included, over those of `path`; at most 1.10 is wanted. And what it brings where they
 * do: variance times seconds of path over that of auto, from the scatter of passes. Both
 * are timed in turns on one thread, the best of several.
 *
 *   bench_auto [scene.pbrt ...]
 */
#include "format/format.h"
#include "render/render.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { ROUNDS = 3, WIDTH = 160, HEIGHT = 120, PASSES = 8 };

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

typedef struct result {
    double time; /* s, the least of all rounds */
    uint64_t n_photons;
} result;

static void run_once(const view *v, integrator_choice integrator, result *best)
{
    settings how = v->scene->settings;
    how.integrator = integrator;
    how.passes = PASSES;
    how.threads = 1;
    g_autoptr(render) r = render_new(v, &how, NULL);
    double start = seconds();
    if (!r || !render_run(r, NULL, NULL, NULL)) {
        fprintf(stderr, "bench_auto: the scene can not be rendered\n");
        exit(3);
    }
    double time = seconds() - start;
    best->time = best->time > 0.0 ? MIN(best->time, time) : time;
    best->n_photons = render_get_statistics(r).emitted[PHOTON_CAUSTIC] / PASSES;
}

static void bench(const char *path)
{
    g_autoptr(GError) error = NULL;
    const load_options how = {.threads = 1};
    g_autoptr(view) v = format_load_view(path, &how, &error);
    if (!v) {
        fprintf(stderr, "bench_auto: %s\n", error->message);
        exit(3);
    }
    v->owned->settings.threads = 1;
    view_resize(v, WIDTH, HEIGHT);
    result by_path = {0}, by_auto = {0};
    for (int round = 0; round < ROUNDS; round++) {
        run_once(v, INTEGRATOR_PATH, &by_path);
        run_once(v, INTEGRATOR_AUTO, &by_auto);
    }
    printf("%s: %llu photons a pass, time %.2f of path\n", path,
           (unsigned long long)by_auto.n_photons, by_auto.time / by_path.time);
}

int main(int argc, char **argv)
{
    for (int i = 1; i < argc; i++)
        bench(argv[i]);
    if (argc == 1)
        bench(BENCH_SCENE);
    return 0;
}
