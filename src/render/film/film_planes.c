#include "render/film/film_planes.h"

#include "base/memory.h"
#include "image/exr.h"
#include "render/film/film_denoise.h"
#include "render/film/film_halves.h"

#include <math.h>
#include <string.h>

size_t film_planes(const film *f, film_plane out[FILM_MOST_PLANES])
{
    size_t n_pixels = (size_t)f->width * (size_t)f->height, n = 0;
    out[n++] = (film_plane){"pixels", f->pixels, n_pixels, 0,
                            sizeof *f->pixels / sizeof(double)};
    if (f->groups)
        out[n++] =
            (film_plane){"groups", f->groups, n_pixels, 0, 3 * (size_t)f->n_groups};
    if (f->surfaces)
        out[n++] = (film_plane){"surfaces", f->surfaces, n_pixels, 0,
                                sizeof *f->surfaces / sizeof(double)};
    if (f->halves)
        out[n++] = (film_plane){"halves", f->halves, n_pixels, HALF_FLOATS, N_LIGHTS};
    return n;
}

static size_t pixel_bytes(const film_plane *plane)
{
    return plane->n_floats * sizeof(float) + plane->n_doubles * sizeof(double);
}

size_t film_plane_bytes(const film_plane *plane)
{
    return plane->n * pixel_bytes(plane);
}

size_t film_count_sums(const film *f)
{
    film_plane planes[FILM_MOST_PLANES];
    size_t n = film_planes(f, planes), count = 0;
    for (size_t i = 0; i < n; i++)
        count += planes[i].n * (planes[i].n_floats + planes[i].n_doubles);
    return count;
}

/* ---- Numbers, counted through all planes ---- */

/* One of them; NULL, what is not at its address. */
typedef struct number {
    float *f;
    double *d;
} number;

static number number_at(const film_plane *plane, size_t i)
{
    size_t each = plane->n_floats + plane->n_doubles, k = i % each;
    char *pixel = (char *)plane->data + i / each * pixel_bytes(plane);
    double *doubles = (double *)(void *)(pixel + plane->n_floats * sizeof(float));
    return k < plane->n_floats ? (number){.f = (float *)(void *)pixel + k}
                               : (number){.d = doubles + (k - plane->n_floats)};
}

/* Calls for each number of [first, first + n). */
static void visit(const film *f, size_t first, size_t n,
                  void (*each)(number at, size_t i, void *data), void *data)
{
    film_plane planes[FILM_MOST_PLANES];
    size_t n_planes = film_planes(f, planes), begin = 0;
    for (size_t p = 0; p < n_planes; p++) {
        size_t count = planes[p].n * (planes[p].n_floats + planes[p].n_doubles);
        size_t from = MAX(first, begin), to = MIN(first + n, begin + count);
        for (size_t i = from; i < to; i++)
            each(number_at(&planes[p], i - begin), i - first, data);
        begin += count;
    }
}

static void get(number at, size_t i, void *data)
{
    ((double *)data)[i] = at.f ? (double)*at.f : *at.d;
}

static void add(number at, size_t i, void *data)
{
    double more = ((const double *)data)[i];
    if (at.f)
        *at.f += (float)more;
    else
        *at.d += more;
}

void film_get_sums(const film *f, size_t first, size_t n, double *out)
{
    visit(f, first, n, get, out);
}

void film_add_sums(film *f, size_t first, size_t n, const double *more)
{
    visit(f, first, n, add, (void *)more);
}

void film_reset(film *f)
{
    film_plane planes[FILM_MOST_PLANES];
    size_t n = film_planes(f, planes);
    for (size_t i = 0; i < n; i++)
        big_zero(planes[i].data, film_plane_bytes(&planes[i]));
    f->n_passes = 0;
    f->n_cells = 0;
}

/* Of the pass under way. */
static size_t pass_bytes(const film *f)
{
    size_t n_pixels = (size_t)f->width * (size_t)f->height;
    size_t bytes = n_pixels * sizeof *f->pass;
    if (f->pass_groups)
        bytes += n_pixels * 3 * (size_t)f->n_groups * sizeof *f->pass_groups;
    if (f->pass_surfaces)
        bytes += n_pixels * sizeof *f->pass_surfaces;
    if (f->pass_guides)
        bytes += n_pixels * film_guide_bytes();
    return bytes;
}

size_t film_bytes(const film *f)
{
    film_plane planes[FILM_MOST_PLANES];
    size_t n = film_planes(f, planes), bytes = pass_bytes(f);
    for (size_t i = 0; i < n; i++)
        bytes += film_plane_bytes(&planes[i]);
    return bytes;
}

size_t film_bytes_in_all(const film *f)
{
    return film_bytes(f) + f->image_size + f->denoise_size;
}

static size_t scaled(size_t bytes, double by)
{
    return (size_t)((double)bytes * by);
}

/* A small film tells what a pixel takes. */
film_size film_size_for(const view *v, bool denoise)
{
    enum { SIDE = 16 };
    const float *crop = v->film.crop;
    int width = (int)(fmaxf(crop[1] - crop[0], 0.0f) * (float)v->film.width);
    int height = (int)(fmaxf(crop[3] - crop[2], 0.0f) * (float)v->film.height);
    double more = (double)width * (double)height / (SIDE * SIDE);
    view small = *v;
    film f;
    small.film.width = small.film.height = SIDE;
    small.film.crop[0] = small.film.crop[2] = 0.0f;
    small.film.crop[1] = small.film.crop[3] = 1.0f;
    film_size size = {0};
    if (film_open(&f, &small, denoise, NULL))
        size = (film_size){
            .pass = scaled(pass_bytes(&f), more),
            .sums = scaled(film_bytes(&f), more),
            .image = scaled(f.image_size, more),
            .denoising = denoise ? film_denoise_bytes(width, height) : 0,
            .writing = exr_writing_bytes(
                width, height, (int)(f.image_size / sizeof(float) / (SIDE * SIDE))),
        };
    film_clear(&f);
    return size;
}
