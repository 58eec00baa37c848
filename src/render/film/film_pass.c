/*
 * A pass that is not whole yet: in which order its pixels come, which are there, and how
 * one is added to a sum.
 */
#include "render/film/film.h"

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

size_t film_pixel_put(const film *f, size_t i)
{
    size_t width = (size_t)f->width, x = i % width, y = i / width;
    for (size_t step = 1; step <= FILM_COARSE; step *= 2) {
        size_t at = (y - y % step) * width + x - x % step;
        if (film_pass_counts(f, at))
            return at;
    }
    return i;
}

void film_add_pass(film_sum *sum, const pass_pixel *pass)
{
    double *number = (double *)sum;
    for (int k = 0; k < FILM_NUMBERS; k++)
        number[k] += (double)pass->number[k];
}
