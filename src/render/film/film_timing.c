/*
 * How long it takes to denoise a film: what there is to filter, times what trials on a
 * small one of noise, which has the same lights, take for as much. That tells it within
 * 25 %; some of the picture's own rows tell less, since others may be more noisy.
 */
#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "render/film/film_denoise.h"
#include "render/film/film_halves.h"

#include <math.h>

enum {
    TRIAL_ROWS = 24,
    TRIAL_COLUMNS = 64,
    SQUARE = 32,      /* pixels across which a light shines everywhere or nowhere */
    LEAST_TRIALS = 2, /* the first one finds the machine cold */
    MOST_TRIALS = 3,
};

/* What takes the same however many lights there are, over what each takes; of fewer
   windows more is the same. */
#define SAME_FINE 0.5
#define SAME_COARSE 1.5

/* A pixel of so small a picture takes as much more as margins do. */
#define TRIAL_EXCESS 1.1

/* ---- Where there is something to filter ---- */

static bool pixel_shines(const film *f, size_t i, int layer)
{
    if (f->n_passes > 0)
        return layer == GLINTS ? f->halves[i].guides.glints[FILM_Y] != 0.0f
                               : f->pixels[i].sum.color[layer][FILM_Y] != 0.0;
    if (!film_pass_counts(f, i))
        return false;
    return layer == GLINTS
               ? f->pass_guides[i].glints[FILM_Y] != 0.0f
               : f->pass[i].number[HALF_AT(color) + 3 * layer + FILM_Y] != 0.0f;
}

static bool square_shines(const film *f, int x0, int y0, int layer)
{
    for (int y = y0; y < MIN(y0 + SQUARE, f->height); y++) {
        for (int x = x0; x < MIN(x0 + SQUARE, f->width); x++) {
            if (pixel_shines(f, (size_t)y * (size_t)f->width + (size_t)x, layer))
                return true;
        }
    }
    return false;
}

/* Share of the picture in which a light shines. */
static double lit_share(const film *f, int layer)
{
    int lit = 0, n = 0;
    for (int y = 0; y < f->height; y += SQUARE) {
        for (int x = 0; x < f->width; x += SQUARE, n++)
            lit += square_shines(f, x, y, layer);
    }
    return (double)lit / n;
}

static void find_lights(const film *f, double share[N_FILTERED])
{
    for (int l = 0; l < N_FILTERED; l++)
        share[l] = lit_share(f, l);
}

/* Those of the picture, or if there is none yet that most have. */
static void expect_lights(const film *f, double share[N_FILTERED])
{
    if (f->n_passes > 0 || f->n_cells > 0)
        find_lights(f, share);
    else
        share[LAYER_DIRECT] = share[LAYER_INDIRECT] = 1.0;
}

/* What a pixel takes on average, over what one light takes. */
static double work_of(const film *f, const double share[N_FILTERED])
{
    double lights = 0.0;
    for (int l = 0; l < N_FILTERED; l++)
        lights += share[l];
    return (f->coarse ? SAME_COARSE : SAME_FINE) +
           (film_filters_together(f) ? fmin(lights, 1.0) : lights);
}

double film_denoise_work(const film *f, unsigned threads, bool gets_more)
{
    double share[N_FILTERED] = {0.0};
    bool is_begun = f->n_passes > 0 && !gets_more;
    if (!f->halves || f->no_time || (is_begun && !film_can_denoise(f, threads)))
        return 0.0;
    expect_lights(f, share);
    return (double)f->width * (double)f->height * work_of(f, share);
}

/* ---- Trying it ---- */

static void denoise_trial(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        float *out;
        film_denoise(data, 1, NULL, &out, NULL);
        big_free(out);
    }
}

/* One on each thread at once, since two on one core take longer; the least of some
   trials, since one is so short that what else the machine does may double it. */
static double time_trials(film *noise, unsigned threads, double budget)
{
    double begun = clock_seconds(), now = begun, least = (double)INFINITY;
    for (int n = 0; n < LEAST_TRIALS || (n < MOST_TRIALS && now - begun < budget); n++) {
        double start = now;
        parallel_for(threads, 1, threads, NULL, denoise_trial, noise);
        now = clock_seconds();
        least = fmin(least, now - start);
    }
    return least / (double)threads;
}

/* A pass over walls whose light is noise. */
static void put_noise(film *f, const double share[N_FILTERED])
{
    for (int i = 0; i < f->width * f->height; i++) {
        sampler random = sampler_make((uint64_t)f->n_passes, (uint64_t)i);
        film_sum sum = {.weight = 1.0, .surface_weight = 1.0};
        guide_sum guides = {0};
        for (int k = 0; k < 3; k++) {
            for (int l = 0; l < N_LIGHTS; l++)
                sum.color[l][k] = share[l] > 0.0 ? (double)sampler_1d(&random) : 0.0;
            guides.glints[k] = share[GLINTS] > 0.0 ? sampler_1d(&random) : 0.0f;
            sum.color[LAYER_SPECULAR][k] += (double)guides.glints[k];
            sum.color[N_LAYERS][k] = (double)(guides.albedo[k] = sampler_1d(&random));
            sum.normal[k] = (double)(guides.normal[k] = sampler_1d(&random));
        }
        sum.depth = (double)(guides.depth = sampler_1d(&random));
        film_put(f, i % f->width, i / f->width, &sum);
        halves_put(f, i % f->width, i / f->width, &guides);
    }
    film_end_pass(f, 1);
}

static double time_noise(film *noise, const double share[N_FILTERED], unsigned threads,
                         double budget)
{
    put_noise(noise, share);
    put_noise(noise, share);
    double took = time_trials(noise, threads, budget);
    return took / (TRIAL_EXCESS * film_denoise_work(noise, 1, true));
}

double film_denoise_trial(const film *f, const view *v, unsigned threads, double budget)
{
    view few = *v;
    film noise = {0};
    double share[N_FILTERED] = {0.0}, took = 0.0;
    if (!f->halves || f->no_time)
        return 0.0;
    expect_lights(f, share);
    few.film.width = MIN(TRIAL_COLUMNS, f->width);
    few.film.height = MIN(TRIAL_ROWS, f->height);
    few.film.crop[0] = few.film.crop[2] = 0.0f;
    few.film.crop[1] = few.film.crop[3] = 1.0f;
    if (film_open(&noise, &few, true, NULL)) {
        noise.coarse = f->coarse;
        noise.together = film_filters_together(f);
        took = time_noise(&noise, share, threads, budget);
    }
    film_clear(&noise);
    return took;
}
