/*
 * Splats: light that came to the film from the lights' side, wherever it fell.
 *
 * Many threads add them, and still each pixel's sum is of the same numbers in the same
 * order, the splats': the film is cut into bands of rows, each band gets a list of the
 * splats whose filter meets it, in order, and is one thread's. Lists are made as a radix
 * sort makes them: counted chunk by chunk, given their places, filled.
 *
 *   splats   0 1 2 3 4 5 6 7 ...          chunks are counted and filled in parallel
 *   lists    band 0: 1 4 6   band 1: 0 4 7   ...      bands are added in parallel
 */
#include "base/memory.h"
#include "render/film/film.h"

#include <math.h>
#include <stddef.h>

enum { BAND_ROWS = 16 }; /* size: most filters meet one band or two */

/* Pixels that a splat's filter reaches: [x0, x1] by [y0, y1], on the film. */
typedef struct splat_area {
    vec2 at; /* of the splat, from pixels' centres */
    int x0, x1, y0, y1;
} splat_area;

typedef struct splat_loop {
    film *film;
    const film_pass *pass;
    const pixel_filter *filter;
    splat_list splats;
    size_t n_bands;
    size_t *place; /* n_bands for each chunk: how many are in its list, then where it
                      begins */
    size_t *list;  /* indices of splats, band by band */
    size_t *begin; /* of the bands' lists, n_bands + 1 */
} splat_loop;

static splat_area area_of(const splat_loop *l, const splat *s)
{
    const film *f = l->film;
    const vec2 at = {s->raster.x - 0.5f, s->raster.y - 0.5f};
    return (splat_area){
        .at = at,
        .x0 = MAX((int)ceilf(at.x - l->filter->x_radius), f->x0),
        .x1 = MIN((int)floorf(at.x + l->filter->x_radius), f->x0 + f->width - 1),
        .y0 = MAX((int)ceilf(at.y - l->filter->y_radius), f->y0),
        .y1 = MIN((int)floorf(at.y + l->filter->y_radius), f->y0 + f->height - 1),
    };
}

/* ---- Adding ---- */

/* A pixel's sums are still to be divided by its weight, so a splat is multiplied by it.
 */
static void add_to(float *sum, const float xyz[3], float share, float weight)
{
    for (int i = 0; i < 3; i++)
        sum[i] += xyz[i] * share * weight;
}

static void add_to_pixel(film *f, size_t i, const splat *s, const float xyz[3],
                         float share)
{
    float *number = f->pass[i].number;
    float weight = number[offsetof(film_sum, weight) / sizeof(double)];
    size_t layer = 3 * (size_t)s->layer;
    add_to(number + offsetof(film_sum, color) / sizeof(double) + layer, xyz, share,
           weight);
    if (f->n_groups > 0)
        add_to(f->pass_groups + 3 * ((size_t)f->n_groups * i + (size_t)s->group), xyz,
               share, weight);
}

/* To those of its pixels that are in rows y0 to y1. */
static void add_splat(const splat_loop *l, const splat *s, int y0, int y1)
{
    film *f = l->film;
    const splat_area on = area_of(l, s);
    float xyz[3];
    spectrum_to_xyz(l->pass->w, s->value * film_dimming(l->pass, s->value), xyz);
    for (int y = MAX(on.y0, y0); y <= MIN(on.y1, y1); y++) {
        for (int x = on.x0; x <= on.x1; x++) {
            size_t i = (size_t)(y - f->y0) * (size_t)f->width + (size_t)(x - f->x0);
            vec2 offset = {on.at.x - (float)x, on.at.y - (float)y};
            add_to_pixel(f, i, s, xyz, filter_density(l->filter, offset));
        }
    }
}

static void add_band(size_t band, size_t end, unsigned thread, void *data)
{
    (void)end, (void)thread;
    const splat_loop *l = data;
    int y = l->film->y0 + BAND_ROWS * (int)band;
    for (size_t i = l->begin[band]; i < l->begin[band + 1]; i++)
        add_splat(l, &l->splats.splats[l->list[i]], y, y + BAND_ROWS - 1);
}

/* ---- Lists ---- */

/* The bands that a splat meets: [*first, *end). */
static void bands_of(const splat_loop *l, const splat *s, size_t *first, size_t *end)
{
    const splat_area on = area_of(l, s);
    bool any = on.y0 <= on.y1 && on.x0 <= on.x1;
    *first = any ? (size_t)(on.y0 - l->film->y0) / BAND_ROWS : 0;
    *end = any ? (size_t)(on.y1 - l->film->y0) / BAND_ROWS + 1 : 0;
}

static void count_chunk(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const splat_loop *l = data;
    size_t *place = l->place + begin / ITEMS_AT_ONCE * l->n_bands, b, last;
    for (size_t i = begin; i < end; i++)
        for (bands_of(l, &l->splats.splats[i], &b, &last); b < last; b++)
            place[b]++;
}

static void fill_chunk(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const splat_loop *l = data;
    size_t *place = l->place + begin / ITEMS_AT_ONCE * l->n_bands, b, last;
    for (size_t i = begin; i < end; i++)
        for (bands_of(l, &l->splats.splats[i], &b, &last); b < last; b++)
            l->list[place[b]++] = i;
}

/* Gives each chunk its place in each band's list. @return how long all lists are */
static size_t place_chunks(const splat_loop *l, size_t n_chunks)
{
    size_t sum = 0;
    for (size_t b = 0; b < l->n_bands; b++) {
        l->begin[b] = sum;
        for (size_t c = 0; c < n_chunks; c++) {
            size_t n = l->place[c * l->n_bands + b];
            l->place[c * l->n_bands + b] = sum;
            sum += n;
        }
    }
    l->begin[l->n_bands] = sum;
    return sum;
}

/* @return false if there is no memory for lists */
static bool make_lists(splat_loop *l, unsigned threads)
{
    const char *what = "splats";
    size_t n = l->splats.n, n_chunks = (n + ITEMS_AT_ONCE - 1) / ITEMS_AT_ONCE;
    l->place = big_alloc(n_chunks * l->n_bands, sizeof *l->place, what, NULL);
    l->begin = big_alloc(l->n_bands + 1, sizeof *l->begin, what, NULL);
    if (!l->place || !l->begin)
        return false;
    parallel_for(n, ITEMS_AT_ONCE, threads, NULL, count_chunk, l);
    l->list = big_alloc(place_chunks(l, n_chunks), sizeof *l->list, what, NULL);
    if (l->list)
        parallel_for(n, ITEMS_AT_ONCE, threads, NULL, fill_chunk, l);
    return l->list != NULL;
}

void film_add_splats(film *f, const film_pass *pass, const pixel_filter *filter,
                     splat_list splats, unsigned threads)
{
    splat_loop l = {.film = f, .pass = pass, .filter = filter, .splats = splats};
    l.n_bands = ((size_t)f->height + BAND_ROWS - 1) / BAND_ROWS;
    if (threads != 1 && make_lists(&l, threads)) {
        parallel_for(l.n_bands, 1, threads, NULL, add_band, &l);
    } else {
        for (size_t i = 0; i < splats.n; i++)
            add_splat(&l, &splats.splats[i], f->y0, f->y0 + f->height - 1);
    }
    big_free(l.place);
    big_free(l.begin);
    big_free(l.list);
}
