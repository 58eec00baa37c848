#include "render/pace.h"

#include "base/clock.h"
#include "render/photon_share.h"

#include <float.h>
#include <math.h>

enum {
    PASSES_WANTED = 20,   /* so that the last one ends close to the time asked for */
    PARTS = 64,           /* of a pass are planned for at least */
    TRIAL_PHOTONS = 4096, /* a thread */
    MOST_TRIAL_THREADS = 16,
    FIRST_SAMPLES = 64, /* of the trial; then twice as many, until they tell enough */
    LEAST_SAMPLES = 256,
    MOST_SAMPLES = 1 << 14,
    SAMPLES_CHUNK = 8,
    TRIAL_PLANNED = 1 << 15, /* samples that its planning counts on: few */
    ROWS_A_THREAD = 16,      /* of a trial write: OpenEXR's chunks have as many */
    MORE_ROWS = 4,           /* times as many, while there is time */
    TRIAL_PASSES = 2,        /* the first one finds the machine cold */
};

/* The camera's part of the trial takes about so much. */
#define TRIAL_SHARE 0.02
#define TRIAL_SECONDS 0.1

/* A shorter one tells of threads that wake up more than of samples. */
#define LEAST_SECONDS 0.001

/* Of the time are photons sent at most before the eye looks, where passes are few. */
#define PHOTON_SHARE 0.08

/* Time is never as short as that: a picture there must be. */
#define LEAST_LEFT 0.05

/* ---- Measuring ---- */

typedef struct trial_look {
    const transport_kind *transport;
    const transport_plan *plan;
    const film *film;
    const void *pass;
    transport_scratch *scratch; /* one a thread */
    size_t first;
} trial_look;

static void look_somewhere(size_t begin, size_t end, unsigned thread, void *data)
{
    const trial_look *all = data;
    const film *f = all->film;
    size_t last = SIZE_MAX; /* pixel */
    for (size_t i = begin; i < end; i++) {
        size_t pixel = (all->first + i) / (size_t)all->plan->how.spp;
        sampler where = sampler_make((uint64_t)all->plan->how.seed, pixel);
        sampler random = sampler_make(hash_mix(where.key, pixel), all->first + i);
        vec2 u = sampler_2d(&where), within = sampler_2d(&random);
        vec2 raster = {(float)f->x0 + floorf(u.x * (float)f->width) + within.x,
                       (float)f->y0 + floorf(u.y * (float)f->height) + within.y};
        vec2 u_lens = sampler_2d(&random);
        radiance_sample out = {.groups = NULL};
        if (pixel != last)
            looked_around_forget(&all->scratch[thread].estimate.looked);
        last = pixel;
        ray from_eye =
            camera_ray(&all->plan->view->camera, raster, u_lens, sampler_1d(&random));
        all->transport->radiance(all->pass, &from_eye, &random, &all->scratch[thread],
                                 &out);
    }
}

/* Seconds for one sample, at best: what else the machine does now it may not do later. */
static double time_samples(trial_look *all, double budget, const cancel_flag *cancel)
{
    double begun = clock_seconds(), now = begun, least = (double)INFINITY;
    unsigned threads = (unsigned)all->plan->how.threads;
    for (size_t n = FIRST_SAMPLES; n <= MOST_SAMPLES && !cancelled(cancel); n *= 2) {
        double start = now;
        parallel_for(n, SAMPLES_CHUNK, threads, cancel, look_somewhere, all);
        all->first += n;
        now = clock_seconds();
        least = fmin(least, (now - start) / (double)n);
        if (n >= LEAST_SAMPLES && now - begun > fmax(0.5 * budget, LEAST_SECONDS))
            break;
    }
    return least;
}

static bool time_camera(trial_look *all, double budget, const cancel_flag *cancel,
                        double *out, GError **error)
{
    size_t n_threads = (size_t)all->plan->how.threads;
    all->scratch = g_aligned_alloc0(n_threads, sizeof *all->scratch, 64);
    bool ok = true;
    for (size_t i = 0; i < n_threads && ok; i++)
        ok = transport_scratch_init(&all->scratch[i], 0, error);
    if (ok)
        *out = time_samples(all, budget, cancel);
    for (size_t i = 0; i < n_threads; i++)
        transport_scratch_clear(&all->scratch[i]);
    g_aligned_free(all->scratch);
    return ok;
}

/* The trial's plan: as few of all as tell what they cost, and nothing gathered, for which
   so few tell nothing. @return share of the photons */
static double shrink(transport_plan *trial, double n_pixels)
{
    settings *how = &trial->how;
    double threads = (double)MIN(how->threads, MOST_TRIAL_THREADS);
    double before = (double)settings_photons(how);
    how->spp = 1;
    how->planned_passes = TRIAL_PLANNED / n_pixels;
    how->gather_indirect = false;
    photon_share_take(how, TRIAL_PHOTONS * threads / before);
    return (double)settings_photons(how) / before;
}

/* Notes what the pass took at least. */
static void *begin_trial(transport_plan *trial, const trial_look *look, uint32_t index,
                         const cancel_flag *cancel, pace_costs *out, GError **error)
{
    transport_counts counts = {0};
    double start = clock_seconds();
    void *pass = look->transport->begin_pass(trial, index, cancel, &counts, error);
    double photons = counts.time_trace + counts.time_build;
    out->pass = fmin(out->pass, fmax(clock_seconds() - start - photons, 0.0));
    out->photons = fmin(out->photons, photons);
    /* cppcheck-suppress returnDanglingLifetime ; a pass keeps no counts */
    return pass;
}

static bool measure(transport_plan *trial, trial_look *look, double budget,
                    const cancel_flag *cancel, pace_costs *out, GError **error)
{
    double n_pixels = (double)look->film->width * (double)look->film->height;
    double share = shrink(trial, n_pixels);
    if (!transport_plan_prepare(trial, cancel, error))
        return false;
    trial->looked_share = (float)sqrt(share); /* as narrow as the discs of all photons */
    *out = (pace_costs){(double)INFINITY, (double)INFINITY, (double)INFINITY};
    for (uint32_t i = 0; i < TRIAL_PASSES; i++) {
        void *pass = begin_trial(trial, look, i, cancel, out, error);
        if (!pass)
            return false;
        look->pass = pass;
        bool last = i == TRIAL_PASSES - 1;
        bool ok = !last || time_camera(look, budget, cancel, &out->sample, error);
        look->transport->end_pass(pass);
        if (!ok)
            return false;
    }
    out->photons /= share;
    if (cancelled(cancel))
        error_set(error, ERROR_CANCELLED, "cancelled");
    return !cancelled(cancel);
}

bool pace_measure(const transport_plan *plan, const film *f, double left,
                  const cancel_flag *cancel, pace_costs *out, GError **error)
{
    transport_plan *trial = g_aligned_alloc0(1, sizeof *trial, 64);
    *trial = transport_plan_of(plan->view, &plan->how);
    trial_look look = {
        .transport = transport_find(plan->how.integrator), .plan = trial, .film = f};
    double budget = fmin(TRIAL_SHARE * fmax(left, LEAST_LEFT), TRIAL_SECONDS);
    bool ok = measure(trial, &look, budget, cancel, out, error);
    transport_plan_clear(trial);
    g_aligned_free(trial);
    return ok;
}

/* ---- Choosing ---- */

settings pace_choose(const settings *how, const pace_costs *costs, double n_pixels,
                     double left)
{
    settings out = *how;
    if (how->passes > 0)
        return out;
    left = fmax(left, LEAST_LEFT);
    double most = left / PASSES_WANTED, look = costs->sample * n_pixels;
    double photons = 1.0;
    double whole = costs->pass + costs->photons + look * (double)how->spp;
    if (whole > most) {
        out.spp = MAX((int64_t)((double)how->spp * most / whole), 1);
        look *= (double)out.spp;
        /* Photons no longer than the camera; but where not even one pass will be whole,
           there must be time for the eye to see something. */
        double time_for_photons = fmax(most, fmin(look, PHOTON_SHARE * left));
        photons = fmin(time_for_photons / fmax(costs->photons, DBL_MIN), 1.0);
        photon_share_take(&out, photons);
        whole = costs->pass + photons * costs->photons + look;
    }
    if (out.spp > 1 && how->first_spp == 0)
        out.first_spp = 1;
    double usual = settings_planned_passes(how) * (double)how->spp / (double)out.spp;
    if (!(how->planned_passes > 0.0))
        out.planned_passes = fmax(floor(PARTS * fmin(left / whole, usual)), 1.0) / PARTS;
    return out;
}

double pace_pass_seconds(const pace_costs *costs, const settings *asked,
                         const settings *chosen, double n_pixels)
{
    double photons = (double)settings_photons(asked);
    double share = photons > 0.0 ? (double)settings_photons(chosen) / photons : 1.0;
    return costs->pass + share * costs->photons +
           costs->sample * n_pixels * (double)chosen->spp;
}

/* ---- Writing ---- */

/* Before there is a picture: noise in a third of the channels, the others even, is about
   as hard to pack as one. */
static void fill_with_noise(image *img)
{
    size_t n = (size_t)img->n_channels, noisy = MAX(n / 3, 4);
    size_t n_pixels = (size_t)img->width * (size_t)img->height;
    uint32_t random = 1;
    for (size_t i = 0; i < n_pixels * n; i++) {
        random = random * 1664525u + 1013904223u;
        img->pixels[i] = i % n < noisy ? (float)(random >> 8) * 0x1p-24f : 0.5f;
    }
}

/* Makes the picture's middle rows and writes them. @return s */
static double time_writing(const film *f, int rows, unsigned threads, char **paths)
{
    double start = clock_seconds();
    g_autoptr(image) some =
        film_image_rows(f, (f->height - rows) / 2, rows, threads, NULL);
    if (!some)
        return 0.0;
    double took = clock_seconds() - start;
    if (f->n_passes == 0 && f->n_cells == 0)
        fill_with_noise(some);
    for (char **path = paths; *path; path++)
        took += image_write_seconds(some, *path);
    return took;
}

double pace_write_seconds(const film *f, unsigned threads, char **paths, double budget)
{
    unsigned few = ROWS_A_THREAD * MIN(threads, MOST_TRIAL_THREADS);
    int rows = (int)MIN(few, (unsigned)f->height);
    if (!paths)
        return 0.0;
    double took = time_writing(f, rows, threads, paths);
    for (double spent = took; spent + MORE_ROWS * took < budget && rows < f->height;
         spent += took) {
        rows = MIN(MORE_ROWS * rows, f->height);
        took = time_writing(f, rows, threads, paths);
    }
    return took * f->height / rows;
}
