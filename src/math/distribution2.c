#include "math/distribution2.h"

#include "base/memory.h"
#include "base/wanted.h"

#include <glib.h>

bool distribution2_init(distribution2 *d, const float *weights, size_t width,
                        size_t height, GError **error)
{
    *d = (distribution2){.width = width, .height = height};
    float *totals = big_alloc(height, sizeof *totals, "a sampling table", error);
    d->columns = big_alloc(height, sizeof *d->columns, "a sampling table", error);
    bool done = totals && d->columns;
    for (size_t y = 0; y < height && done; y++) {
        done = still_wanted(error) &&
               distribution_init(&d->columns[y], weights + y * width, width, error);
        totals[y] = done ? (float)distribution_total(&d->columns[y]) : 0.0f;
    }
    done = done && distribution_init(&d->rows, totals, height, error);
    big_free(totals);
    if (!done)
        distribution2_clear(d);
    return done;
}

void distribution2_clear(distribution2 *d)
{
    for (size_t y = 0; y < d->height && d->columns; y++)
        distribution_clear(&d->columns[y]);
    big_free(d->columns);
    distribution_clear(&d->rows);
    *d = (distribution2){0};
}

static float cell_pdf(const distribution2 *d, size_t x, size_t y)
{
    return distribution_pdf(&d->rows, y) * distribution_pdf(&d->columns[y], x) *
           (float)d->width * (float)d->height;
}

static float into_cell(size_t i, float u, size_t n)
{
    return minf(((float)i + u) / (float)n, 0x1.fffffep-1f);
}

vec2 distribution2_sample(const distribution2 *d, vec2 u, float *pdf)
{
    size_t y = distribution_sample(&d->rows, &u.y);
    size_t x = distribution_sample(&d->columns[y], &u.x);
    *pdf = cell_pdf(d, x, y);
    return (vec2){into_cell(x, u.x, d->width), into_cell(y, u.y, d->height)};
}

static size_t cell_of(float t, size_t n)
{
    float i = t * (float)n;
    if (!(i > 0.0f))
        return 0;
    return i < (float)n ? MIN((size_t)i, n - 1) : n - 1;
}

float distribution2_pdf(const distribution2 *d, vec2 at)
{
    if (!(distribution_total(&d->rows) > 0.0))
        return 0.0f;
    size_t y = cell_of(at.y, d->height);
    if (!(distribution_total(&d->columns[y]) > 0.0))
        return 0.0f;
    return cell_pdf(d, cell_of(at.x, d->width), y);
}

double distribution2_mean(const distribution2 *d)
{
    return distribution_total(&d->rows) / ((double)d->width * (double)d->height);
}
