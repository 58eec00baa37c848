/*
 * How much of a render no second thread helps with: from the start of the process to the
 * file, on one thread, what of its processor time is outside of all parallel loops. The
 * linker's --wrap counts that. So the speed of n threads is known where others disturb
 * the clock: at most 1 / (serial + (1 - serial) / n); what it leaves out is threads that
 * wait for one another at the end of a loop, and memory that they share.
 *
 *   bench_serial INTEGRATOR SCENE FILE      prints seconds, and of these the serial ones
 */
#include "base/parallel.h"
#include "format/format.h"
#include "image/image.h"
#include "render/render.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { SIDE = 256, PASSES = 4 };

static double in_parallel; /* s */
static int depth;

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

bool __real_parallel_for(size_t, size_t, unsigned, const cancel_flag *, parallel_body,
                         void *);
bool __wrap_parallel_for(size_t n, size_t chunk_size, unsigned threads,
                         const cancel_flag *cancel, parallel_body body, void *data);

bool __real_parallel_work(size_t, size_t, workers, parallel_body, void *, GError **);
bool __wrap_parallel_work(size_t n, size_t chunk_size, workers by, parallel_body body,
                          void *data, GError **error);

/* Of a loop that began then. */
static void end_loop(double start, size_t n, size_t chunk_size)
{
    depth--;
    if (depth == 0 && n > chunk_size) /* one piece is one thread's */
        in_parallel += seconds() - start;
}

bool __wrap_parallel_for(size_t n, size_t chunk_size, unsigned threads,
                         const cancel_flag *cancel, parallel_body body, void *data)
{
    double start = seconds();
    depth++;
    bool done = __real_parallel_for(n, chunk_size, threads, cancel, body, data);
    end_loop(start, n, chunk_size);
    return done;
}

/* Calls parallel_for within its own file, where nothing is wrapped. */
bool __wrap_parallel_work(size_t n, size_t chunk_size, workers by, parallel_body body,
                          void *data, GError **error)
{
    double start = seconds();
    depth++;
    bool done = __real_parallel_work(n, chunk_size, by, body, data, error);
    end_loop(start, n, chunk_size);
    return done;
}

static void give_up(const char *what)
{
    fprintf(stderr, "bench_serial: %s\n", what);
    exit(3);
}

int main(int argc, char **argv)
{
    const load_options how = {.threads = 1};
    g_autoptr(view) v = argc == 4 ? format_load_view(argv[2], &how, NULL) : NULL;
    if (!v)
        give_up("expected an integrator, a scene and a file to write");
    settings s = v->scene->settings;
    if (!settings_set(&s, "integrator", argv[1], NULL))
        give_up("no such integrator");
    s.passes = PASSES;
    s.threads = 1;
    view_resize(v, SIDE, SIDE);
    g_autoptr(render) r = render_new(v, &s, NULL);
    if (!r || !render_run(r, NULL, NULL, NULL))
        give_up("the scene can not be rendered");
    image *picture = render_image(r, NULL);
    if (!picture || !image_write(picture, argv[3], NULL, NULL))
        give_up("the picture can not be written");
    image_free(picture);
    double whole = seconds();
    printf("%.4f\t%.4f\n", whole, whole - in_parallel);
    return 0;
}
