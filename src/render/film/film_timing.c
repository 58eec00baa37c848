/*
 * How long it takes to denoise a film: tries a few rows, and counts where else light is.
 */
#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "render/film/film_denoise.h"
#include "render/film/film_halves.h"

enum {
    TRIAL_ROWS = 24,
    TRIAL_COLUMNS = 128,
    SQUARE = 32, /* pixels across which a light shines everywhere or nowhere */
};

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

/* What a pixel takes on average: its features about as much as a light that shines. */
static double work_of(const double share[N_FILTERED])
{
    double work = 1.0;
    for (int l = 0; l < N_FILTERED; l++)
        work += share[l];
    return work;
}

/* What a pixel takes where lights have such shares, over one of a part of the picture. */
static double over_part(const double share[N_FILTERED], const film *part)
{
    double tried[N_FILTERED];
    find_lights(part, tried);
    return work_of(share) / work_of(tried);
}

/* ---- Trying it ---- */

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
    double share[N_FILTERED];
    if (f->n_passes == 0 || !(gets_more ? can_try(f) : film_can_denoise(f, threads)))
        return 0.0;
    part.height = MIN(TRIAL_ROWS, f->height);
    part.denoise_size = 0;
    part.n_cells = 0;
    size_t first = (size_t)((f->height - part.height) / 2) * (size_t)f->width;
    part.pixels += first;
    part.halves += first;
    memory_release(f->denoise_size);
    find_lights(f, share);
    double took = time_part(f, &part, threads) * over_part(share, &part);
    memory_count(f->denoise_size);
    return took;
}

/* ---- Of none yet ---- */

/* By the pass under way; before that those that most pictures have. */
static void expect_lights(const film *f, double share[N_FILTERED])
{
    if (f->n_cells > 0)
        find_lights(f, share);
    else
        share[LAYER_DIRECT] = share[LAYER_INDIRECT] = 1.0;
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

double film_denoise_seconds_ahead(const film *f, const view *v, unsigned threads)
{
    view few = *v;
    film noise = {0};
    double share[N_FILTERED] = {0.0}, took = 0.0;
    few.film.width = MIN(TRIAL_COLUMNS, f->width);
    few.film.height = MIN(TRIAL_ROWS, f->height);
    few.film.crop[0] = few.film.crop[2] = 0.0f;
    few.film.crop[1] = few.film.crop[3] = 1.0f;
    if (f->halves && !f->no_time && film_open(&noise, &few, true, NULL)) {
        noise.coarse = f->coarse;
        expect_lights(f, share);
        put_noise(&noise, share);
        put_noise(&noise, share);
        took = time_part(f, &noise, threads) * over_part(share, &noise);
    }
    film_clear(&noise);
    return took;
}
