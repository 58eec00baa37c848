/*
 * A pass that is not whole yet: in which order its pixels come, which are there, and how
 * one is added to a sum.
 */
#include "render/film/film_halves.h"

int film_cell(const film *f, int x, int y)
{
    static const unsigned within[2][2] = {{0, 2},
                                          {3, 1}}; /* [y][x]: the far corner second */
    unsigned cell = 0, column = (unsigned)(x - f->x0), row = (unsigned)(y - f->y0);
    for (int step = 1; step < FILM_COARSE; step *= 2, column /= 2, row /= 2)
        cell = 4 * cell + within[row % 2][column % 2];
    return (int)cell;
}

bool film_pass_counts(const film *f, size_t pixel)
{
    int x = (int)(pixel % (size_t)f->width), y = (int)(pixel / (size_t)f->width);
    return film_cell(f, f->x0 + x, f->y0 + y) < f->n_cells;
}

/* The pixels on its sides. */
static int pixels_beside(const film *f, size_t i, size_t beside[4])
{
    size_t width = (size_t)f->width, x = i % width, y = i / width;
    int n = 0;
    if (x > 0)
        beside[n++] = i - 1;
    if (x + 1 < width)
        beside[n++] = i + 1;
    if (y > 0)
        beside[n++] = i - width;
    if (y + 1 < (size_t)f->height)
        beside[n++] = i + width;
    return n;
}

/* The nearest on a coarser grid of its tile that is there. */
static size_t pixel_before(const film *f, size_t i)
{
    size_t width = (size_t)f->width, x = i % width, y = i / width;
    for (size_t step = 1; step <= FILM_COARSE; step *= 2) {
        size_t at = (y - y % step) * width + x - x % step;
        if (film_pass_counts(f, at))
            return at;
    }
    return i;
}

/* Of a pass that is not whole yet: whether some light is in sight. */
static bool is_lit(const film *f, size_t i)
{
    const float *seen = f->pass[i].number + HALF_AT(color[LAYER_EMISSION]);
    bool lit = seen[FILM_Y] > 0.0f;
    return lit || (f->halves && f->pass_guides[i].lit > 0.0f);
}

/* Lights are so bright that the mean with one is one: those that see any, or the others,
   whichever are more. */
static int keep_most_alike(const film *f, size_t *pixels, int n)
{
    int n_lit = 0, kept = 0;
    for (int k = 0; k < n; k++)
        n_lit += is_lit(f, pixels[k]);
    for (int k = 0; k < n; k++)
        if (is_lit(f, pixels[k]) == (2 * n_lit > n))
            pixels[kept++] = pixels[k];
    return kept;
}

/* After half of the cells every other pixel is there, like the black squares of a
   chessboard: around each white one are four. */
int film_pixels_for(const film *f, size_t i, size_t for_it[4])
{
    bool is_there = f->n_passes > 0 || film_pass_counts(f, i);
    if (!is_there && f->n_cells >= FILM_CELLS / 2)
        return keep_most_alike(f, for_it, pixels_beside(f, i, for_it));
    for_it[0] = is_there ? i : pixel_before(f, i);
    return 1;
}

void film_add_pixel(const film *f, size_t i, film_sum *sum)
{
    const double *more = (const double *)&f->pixels[i].sum;
    double *number = (double *)sum;
    for (int k = 0; k < FILM_NUMBERS; k++)
        number[k] += more[k];
    if (film_pass_counts(f, i))
        film_add_pass(sum, &f->pass[i]);
}

void film_add_pass(film_sum *sum, const pass_pixel *pass)
{
    double *number = (double *)sum;
    for (int k = 0; k < FILM_NUMBERS; k++)
        number[k] += (double)pass->number[k];
}
