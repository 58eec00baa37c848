/*
 * How long it takes to denoise a film: tries it on a small one of noise that has the same
 * lights, and counts where they are. That tells what a picture takes within 25 %; some of
 * its own rows tell less, since others may be more noisy.
 */
#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "render/film/film_denoise.h"
#include "render/film/film_halves.h"

#include <math.h>

enum {
    TRIAL_ROWS = 24,
    TRIAL_COLUMNS = 128,
    SQUARE = 32, /* pixels across which a light shines everywhere or nowhere */
    MOST_TRIALS = 3,
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
static double work_of(const double share[N_FILTERED], bool together)
{
    double lights = 0.0;
    for (int l = 0; l < N_FILTERED; l++)
        lights += share[l];
    return 1.0 + (together ? fmin(lights, 1.0) : lights);
}

/* ---- Trying it ---- */

static void denoise_part(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    for (size_t i = begin; i < end; i++)
        big_free(film_denoise(data, 1, NULL, NULL));
}

/* A part of it on each thread at once, since two on one core take longer; the least of
   some trials, since one is so short that what else the machine does may double it. */
static double time_part(film *part, unsigned threads, double budget)
{
    double begun = clock_seconds(), now = begun, least = (double)INFINITY;
    for (int n = 0; n == 0 || (n < MOST_TRIALS && now - begun < budget); n++) {
        double start = now;
        parallel_for(threads, 1, threads, NULL, denoise_part, part);
        now = clock_seconds();
        least = fmin(least, now - start);
    }
    return least / (double)threads;
}

/* Those of the picture, or if there is none yet that most have. */
static void expect_lights(const film *f, double share[N_FILTERED])
{
    if (f->n_passes > 0 || f->n_cells > 0)
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

double film_denoise_share_together(const film *f)
{
    double share[N_FILTERED] = {0.0};
    expect_lights(f, share);
    return work_of(share, true) / work_of(share, false);
}

/* Each light that there is shines everywhere. */
static double part_work(const double share[N_FILTERED], bool together)
{
    double whole[N_FILTERED];
    for (int l = 0; l < N_FILTERED; l++)
        whole[l] = share[l] > 0.0 ? 1.0 : 0.0;
    return work_of(whole, together);
}

/* Of a small picture of noise with such lights, s for a pixel of the film. */
static double time_noise(const film *f, const view *v, const double share[N_FILTERED],
                         unsigned threads, double budget)
{
    view few = *v;
    film noise = {0};
    double took = 0.0, pixels;
    few.film.width = MIN(TRIAL_COLUMNS, f->width);
    few.film.height = MIN(TRIAL_ROWS, f->height);
    few.film.crop[0] = few.film.crop[2] = 0.0f;
    few.film.crop[1] = few.film.crop[3] = 1.0f;
    pixels = (double)few.film.width * (double)few.film.height;
    if (film_open(&noise, &few, true, NULL)) {
        noise.coarse = f->coarse;
        noise.together = film_filters_together(f);
        put_noise(&noise, share);
        put_noise(&noise, share);
        took = time_part(&noise, threads, budget) / pixels;
        took *= work_of(share, noise.together) / part_work(share, noise.together);
    }
    film_clear(&noise);
    return took;
}

double film_denoise_seconds(const film *f, const view *v, unsigned threads,
                            bool gets_more, double budget)
{
    double share[N_FILTERED] = {0.0}, pixels = (double)f->width * (double)f->height;
    bool is_begun = f->n_passes > 0 && !gets_more;
    if (!f->halves || f->no_time || (is_begun && !film_can_denoise(f, threads)))
        return 0.0;
    expect_lights(f, share);
    return pixels * time_noise(f, v, share, threads, budget);
}
