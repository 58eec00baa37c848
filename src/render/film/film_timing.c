/*
 * How long it takes to denoise a film: tries a few rows.
 */
#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "render/film/film_denoise.h"
#include "render/film/film_halves.h"

enum { TRIAL_ROWS = 24, TRIAL_COLUMNS = 128 };

static void denoise_part(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    for (size_t i = begin; i < end; i++)
        big_free(film_denoise(data, 1, NULL, NULL));
}

/* By what a part of it takes on each thread at once, since two on one core take longer.
 */
static double time_part(const film *f, film *part, unsigned threads)
{
    double pixels = (double)f->width * (double)f->height;
    double start = clock_seconds();
    parallel_for(threads, 1, threads, NULL, denoise_part, part);
    double took = clock_seconds() - start;
    return took * pixels / ((double)part->width * (double)part->height) / (double)threads;
}

/* ---- Of a picture ---- */

/* Whether there is something to try it on, though it may all be one half. */
static bool can_try(const film *f)
{
    return f->halves && !f->no_time;
}

double film_denoise_seconds(const film *f, unsigned threads, bool gets_more)
{
    film part = *f;
    if (f->n_passes == 0 || !(gets_more ? can_try(f) : film_can_denoise(f)))
        return 0.0;
    part.height = MIN(TRIAL_ROWS, f->height);
    part.denoise_size = 0;
    part.n_cells = 0;
    size_t first = (size_t)((f->height - part.height) / 2) * (size_t)f->width;
    part.pixels += first;
    part.halves += first;
    memory_release(f->denoise_size);
    double took = time_part(f, &part, threads);
    memory_count(f->denoise_size);
    return took;
}

/* ---- Of none yet ---- */

/* Lights of which the pass under way has shown any, or those that most pictures have. */
static void find_lights(const film *f, bool lit[N_FILTERED])
{
    lit[LAYER_DIRECT] = lit[LAYER_INDIRECT] = f->n_cells == 0;
    for (size_t i = 0; i < (size_t)f->width * (size_t)f->height; i++) {
        const float *color = f->pass[i].number + HALF_AT(color);
        if (!film_pass_counts(f, i))
            continue;
        for (int l = 0; l < N_LIGHTS; l++)
            lit[l] |= color[3 * l + FILM_Y] != 0.0f;
        lit[GLINTS] |= f->pass_guides[i].glints[FILM_Y] != 0.0f;
    }
}

/* A pass over walls whose light is noise. */
static void put_noise(film *f, const bool lit[N_FILTERED])
{
    for (int i = 0; i < f->width * f->height; i++) {
        sampler random = sampler_make((uint64_t)f->n_passes, (uint64_t)i);
        film_sum sum = {.weight = 1.0, .surface_weight = 1.0};
        guide_sum guides = {0};
        for (int k = 0; k < 3; k++) {
            for (int l = 0; l < N_LIGHTS; l++)
                sum.color[l][k] = lit[l] ? (double)sampler_1d(&random) : 0.0;
            guides.glints[k] = lit[GLINTS] ? sampler_1d(&random) : 0.0f;
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

double film_denoise_seconds_ahead(const film *f, const view *v, unsigned threads)
{
    view few = *v;
    film noise = {0};
    bool lit[N_FILTERED] = {false};
    double took = 0.0;
    few.film.width = MIN(TRIAL_COLUMNS, f->width);
    few.film.height = MIN(TRIAL_ROWS, f->height);
    few.film.crop[0] = few.film.crop[2] = 0.0f;
    few.film.crop[1] = few.film.crop[3] = 1.0f;
    if (f->halves && !f->no_time && film_open(&noise, &few, true, NULL)) {
        noise.coarse = f->coarse;
        find_lights(f, lit);
        put_noise(&noise, lit);
        put_noise(&noise, lit);
        took = time_part(f, &noise, threads);
    }
    film_clear(&noise);
    return took;
}
