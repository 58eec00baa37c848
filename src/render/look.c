#include "render/look.h"

#include "base/clock.h"
#include "base/memory.h"
#include "render/film/film_halves.h"
#include "render/film/gbuffer.h"

#include <string.h>

enum {
    SAMPLES_BETWEEN_PROGRESS = 64,
    TIMED_SHARE = 16, /* one camera sample in so many is timed: the clock is not free */
};

/* Which camera samples of a thread are timed. */
typedef struct sample_clock {
    uint64_t n_samples;
    int64_t time; /* microseconds, of those that were timed */
} sample_clock;

struct look {
    look_task task;
    film_pass film_pass;
    unsigned n_threads;
    int n_tiles_x;
    size_t n_tiles;
    transport_scratch *scratch; /* one a thread */
    sample_clock *clocks;       /* likewise */
    spectrum *groups; /* 2 n_groups a thread: of a sample, and their sums over a pixel */
    double seconds;

    int first, end; /* cells that are rendered now */
    atomic_size_t tiles_done;
};

/* ---- A pixel ---- */

/* What a pixel gets by light groups. */
typedef struct group_sums {
    size_t n;
    spectrum *sample, *sum; /* NULL if n is 0 */
} group_sums;

/* A thread's, zeroed. */
static group_sums groups_of(const look *l, unsigned thread)
{
    size_t n = (size_t)l->task.film->n_groups;
    if (n == 0)
        return (group_sums){0};
    spectrum *own = l->groups + 2 * n * thread;
    memset(own, 0, 2 * n * sizeof *own);
    return (group_sums){n, own, own + n};
}

/* What a pixel gets in a pass, groups apart. */
typedef struct pixel_sums {
    film_sum film;
    surface_sum surface;
    guide_sum guide;
} pixel_sums;

/* A sample of a pixel: its number among those of even passes, or of odd ones. */
typedef struct pixel_sample {
    vec2 pixel;
    uint64_t key, number;
} pixel_sample;

/* Where in the pixel and on the lens, and when, a sample looks. */
typedef struct pixel_look {
    vec2 offset, u_lens;
    float time, weight;
} pixel_look;

static pixel_look look_at(const view *v, const pixel_sample *which, sampler *random)
{
    pixel_look at;
    at.offset = filter_sample_nth(&v->filter, which->key, which->number,
                                  sampler_2d(random), &at.weight);
    at.u_lens = sampler_2d(random);
    at.time = sampler_1d(random);
    if (v->scene->switches.fixed_pixels)
        at = (pixel_look){{0.0f, 0.0f}, {0.5f, 0.5f}, 0.5f, 1.0f};
    return at;
}

/* What a ray from the eye finds. Within a timed sample all gathers are: so their part of
   it is never more than the whole. */
static void find_radiance(look *l, const ray *from_eye, sampler *random, unsigned thread,
                          radiance_sample *sample)
{
    transport_scratch *scratch = &l->scratch[thread];
    sample_clock *clock = &l->clocks[thread];
    scratch->timed = clock->n_samples++ % TIMED_SHARE == 0;
    int64_t start = scratch->timed ? clock_microseconds() : 0;
    l->task.transport->radiance(l->task.pass, from_eye, random, scratch, sample);
    if (scratch->timed)
        clock->time += clock_microseconds() - start;
}

/* One camera sample of a pixel, random already told which. */
static void render_sample(look *l, const pixel_sample *which, sampler *random,
                          unsigned thread, pixel_sums *sums, const group_sums *groups)
{
    const view *v = l->task.plan->view;
    const vec2 pixel = which->pixel;
    pixel_look at = look_at(v, which, random);
    float weight = at.weight;
    vec2 raster = {pixel.x + 0.5f + at.offset.x, pixel.y + 0.5f + at.offset.y};
    ray from_eye = camera_ray(&v->camera, raster, at.u_lens, at.time);
    radiance_sample sample = {.groups = groups->sample};
    for (size_t k = 0; k < groups->n; k++)
        groups->sample[k] = (spectrum){0};
    find_radiance(l, &from_eye, random, thread, &sample);
    gbuffer_turn(v, from_eye.time, &sample);
    float dimmed = film_add(&sums->film, &l->film_pass, &sample, weight);
    const gbuffer_sample seen = {raster, at.u_lens, from_eye, weight, dimmed};
    guide_add(&sums->guide, &l->film_pass, &sample, weight);
    gbuffer_add(&sums->surface, l->task.film, v, &l->film_pass, &seen, &sample);
    for (size_t k = 0; k < groups->n; k++)
        groups->sum[k] += weight * dimmed * groups->sample[k];
}

static void tell_progress(const cancel_flag *cancel)
{
    if (cancel && cancel->progress)
        cancel->progress(cancel->progress_data);
}

static void render_pixel(look *l, int x, int y, unsigned thread)
{
    const settings *how = &l->task.plan->how;
    uint64_t pixel = (uint64_t)y * (uint64_t)l->task.plan->view->film.width + (uint64_t)x;
    uint64_t eye = hash_mix(pixel, 0x7069786cu + (uint64_t)how->camera_seed);
    uint64_t key = hash_mix((uint64_t)how->seed, eye);
    pixel_sums sums = {0};
    group_sums groups = groups_of(l, thread);
    looked_around_forget(&l->scratch[thread].estimate.looked);
    for (int64_t i = 0; i < how->spp; i++) {
        if (cancelled(l->task.cancel))
            return;
        if (thread == 0 && i % SAMPLES_BETWEEN_PROGRESS == 0)
            tell_progress(l->task.cancel);
        sampler random =
            sampler_make(key, l->task.index * (uint64_t)how->spp + (uint64_t)i);
        const pixel_sample which = {.pixel = {(float)x, (float)y},
                                    .key = hash_mix(key, 0x66696c74u + l->task.index % 2),
                                    .number = l->task.index / 2 * (uint64_t)how->spp +
                                              (uint64_t)i};
        render_sample(l, &which, &random, thread, &sums, &groups);
    }
    if (cancelled(l->task.cancel)) /* then the last sample is not whole */
        return;
    film_put(l->task.film, x, y, &sums.film);
    gbuffer_put(l->task.film, x, y, &sums.surface);
    halves_put(l->task.film, x, y, &sums.guide);
    film_put_groups(l->task.film, &l->film_pass, x, y, groups.sum);
}

/* ---- All pixels ---- */

static void render_tile(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)end;
    look *l = data;
    const film *f = l->task.film;
    int x0 = f->x0 + FILM_TILE * (int)(begin % (size_t)l->n_tiles_x);
    int y0 = f->y0 + FILM_TILE * (int)(begin / (size_t)l->n_tiles_x);
    int x1 = MIN(x0 + FILM_TILE, f->x0 + f->width),
        y1 = MIN(y0 + FILM_TILE, f->y0 + f->height);
    for (int y = y0; y < y1; y++) {
        for (int x = x0; x < x1; x++) {
            int cell = film_cell(f, x, y);
            if (cell >= l->first && cell < l->end)
                render_pixel(l, x, y, thread);
        }
    }
    atomic_fetch_add(&l->tiles_done, 1);
}

bool look_cells(look *l, int first, int end)
{
    double start = clock_seconds();
    l->first = first;
    l->end = end;
    atomic_store(&l->tiles_done, 0);
    bool done = parallel_for(l->n_tiles, 1, l->n_threads, l->task.cancel, render_tile, l);
    l->seconds += clock_seconds() - start;
    return done;
}

double look_fraction(const look *l)
{
    double share = (double)atomic_load(&l->tiles_done) / (double)l->n_tiles;
    return ((double)l->first + share * (double)(l->end - l->first)) / FILM_CELLS;
}

double look_seconds(const look *l)
{
    return l->seconds;
}

static void look_free(look *l)
{
    for (unsigned i = 0; i < l->n_threads && l->scratch; i++)
        transport_scratch_clear(&l->scratch[i]);
    big_free(l->scratch);
    big_free(l->groups);
    g_free(l->clocks);
    g_aligned_free(l);
}

/* Memory of the threads. */
static bool open_threads(look *l, GError **error)
{
    size_t n_groups = (size_t)l->task.film->n_groups;
    l->scratch = big_alloc(l->n_threads, sizeof *l->scratch, "thread scratch", error);
    l->clocks = g_new0(sample_clock, l->n_threads);
    bool ok = l->scratch != NULL;
    for (unsigned i = 0; i < l->n_threads && ok; i++)
        ok = transport_scratch_init(&l->scratch[i], n_groups, error);
    if (ok && n_groups > 0) {
        l->groups = big_alloc(2 * n_groups * l->n_threads, sizeof *l->groups,
                              "light groups", error);
        ok = l->groups != NULL;
    }
    return ok;
}

look *look_open(const look_task *task, GError **error)
{
    const film *f = task->film;
    look *l = g_aligned_alloc0(1, sizeof *l, 64);
    l->task = *task;
    l->film_pass = film_pass_for(f, task->transport->pass_wavelengths(task->pass));
    l->n_threads = (unsigned)task->plan->how.threads;
    l->n_tiles_x = (f->width + FILM_TILE - 1) / FILM_TILE;
    l->n_tiles = (size_t)l->n_tiles_x * (size_t)((f->height + FILM_TILE - 1) / FILM_TILE);
    if (open_threads(l, error))
        return l;
    look_free(l);
    return NULL;
}

bool look_close(look *l, transport_counts *counts, GError **error)
{
    bool failed = false;
    int64_t timed = 0, gathering = 0;
    for (unsigned i = 0; i < l->n_threads; i++) {
        const transport_scratch *scratch = &l->scratch[i];
        counts->camera_rays += scratch->camera_rays;
        counts->shadow_rays += scratch->shadow_rays;
        counts->n_not_finite += scratch->n_not_finite;
        timed += l->clocks[i].time;
        gathering += scratch->time_gather;
        failed |= estimate_scratch_refused(&scratch->estimate);
    }
    if (timed > 0)
        counts->time_gather += l->seconds * ((double)gathering / (double)timed);
    look_free(l);
    if (failed)
        error_set(error, ERROR_FAILED, "out of memory for radiance estimates");
    return !failed;
}
