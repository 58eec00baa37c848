#include "image/denoise/plane.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

grid grid_make(int width, int height, unsigned threads, const cancel_flag *cancel)
{
    size_t blocks = ((size_t)width + BLOCK - 1) / BLOCK;
    grid g = {width, height, blocks * BLOCK + 2 * MARGIN, 0, threads, cancel, NULL};
    g.n = g.stride * ((size_t)height + 2 * MARGIN);
    return g;
}

/* ---- Rows ---- */

typedef struct row_loop {
    row_body body;
    void *data;
    int first;
} row_loop;

static void do_rows(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const row_loop *loop = data;
    for (size_t i = begin; i < end; i++)
        loop->body(loop->first + (int)i, loop->data);
}

bool plane_rows(const grid *g, row_body body, void *data)
{
    row_loop loop = {body, data, 0};
    return parallel_for((size_t)g->height, ROWS_AT_ONCE, g->threads, g->cancel, do_rows,
                        &loop);
}

/* Those of the margin too. */
static void plane_all_rows(const grid *g, row_body body, void *data)
{
    row_loop loop = {body, data, -MARGIN};
    parallel_for((size_t)g->height + 2 * MARGIN, ROWS_AT_ONCE, g->threads, g->cancel,
                 do_rows, &loop);
}

typedef struct plane_loop {
    const grid *g;
    float *const *planes;
    int n;
} plane_loop;

/* ---- New planes ---- */

static void zero_row(int y, void *data)
{
    const plane_loop *loop = data;
    float *row = loop->planes[0] + plane_at(loop->g, -MARGIN, y);
    memset(row, 0, loop->g->stride * sizeof *row);
}

float *plane_new(const grid *g, GError **error)
{
    if (!g->spare || g->spare->n == 0)
        return big_alloc(g->n, sizeof(float), "denoising", error);
    float *plane = g->spare->plane[--g->spare->n];
    plane_loop loop = {g, &plane, 1};
    plane_all_rows(g, zero_row, &loop);
    return plane;
}

void plane_free(const grid *g, float *plane)
{
    if (plane && g->spare && g->spare->n < MOST_SPARE_PLANES)
        g->spare->plane[g->spare->n++] = plane;
    else
        big_free(plane);
}

void spare_planes_clear(spare_planes *spare)
{
    while (spare->n > 0)
        big_free(spare->plane[--spare->n]);
}

/* ---- Margins ---- */

/* Where in 0..n-1 the mirrored picture has what lies at i. */
static int mirrored(int i, int n)
{
    while (i < 0 || i >= n)
        i = i < 0 ? -1 - i : 2 * n - 1 - i;
    return i;
}

/* A row of the margin is like the one of the picture that it mirrors, of which only what
   is in the picture is read. */
static void mirror_row_of(const grid *g, float *plane, int y)
{
    const float *from = plane + plane_at(g, 0, mirrored(y, g->height));
    float *row = plane + plane_at(g, 0, y);
    int end = (int)g->stride - MARGIN;
    if (row != from)
        memcpy(row, from, (size_t)g->width * sizeof *row);
    for (int x = -MARGIN; x < 0; x++)
        row[x] = from[mirrored(x, g->width)];
    for (int x = g->width; x < end; x++)
        row[x] = from[mirrored(x, g->width)];
}

static void mirror_row(int y, void *data)
{
    const plane_loop *loop = data;
    for (int i = 0; i < loop->n; i++)
        mirror_row_of(loop->g, loop->planes[i], y);
}

void plane_mirror(const grid *g, float *const *planes, int n)
{
    plane_loop loop = {g, planes, n};
    plane_all_rows(g, mirror_row, &loop);
}

/* ---- Means ---- */

typedef struct mean_loop {
    const grid *g;
    const float *plane;
    plane_means *rows;
} mean_loop;

static void mean_row(int y, void *data)
{
    const mean_loop *loop = data;
    const float *row = loop->plane + plane_at(loop->g, 0, y);
    plane_means sum = {0.0, 0.0, 0.0};
    for (int x = 0; x < loop->g->width; x++) {
        double v = (double)row[x];
        sum.plain += v;
        sum.square += v * v;
        sum.absolute += fabs(v);
    }
    loop->rows[y] = sum;
}

/* Row by row, so that it is the same on any number of threads. */
plane_means plane_mean(const grid *g, const float *plane)
{
    mean_loop loop = {g, plane, g_new0(plane_means, g->height)};
    plane_means sum = {0.0, 0.0, 0.0};
    plane_rows(g, mean_row, &loop);
    for (int y = 0; y < g->height; y++) {
        sum.plain += loop.rows[y].plain;
        sum.square += loop.rows[y].square;
        sum.absolute += loop.rows[y].absolute;
    }
    g_free(loop.rows);
    double n = (double)g->width * (double)g->height;
    return (plane_means){sum.plain / n, sum.square / n, sum.absolute / n};
}

/* ---- Sums over squares ---- */

typedef struct box_loop {
    const grid *g;
    const float *const *from;
    int n, radius;
    float *const *to;
} box_loop;

/* Of n vectors so far from one another. */
static lane_floats sum_lanes(const float *first, int n, size_t step)
{
    lane_floats sum = {0};
    for (int i = 0; i < n; i++)
        sum += load_lanes(first + (size_t)i * step);
    return sum;
}

static void box_row_of(const grid *g, const float *from, int radius, int y, float *to)
{
    int across = 2 * radius + 1;
    float columns[ACROSS];
    for (int x0 = 0; x0 < g->width; x0 += BLOCK) {
        const float *first = from + plane_at(g, x0 - radius, y - radius);
        for (int i = 0; i < ACROSS; i += LANES)
            store_lanes(columns + i, sum_lanes(first + i, across, g->stride));
        for (int i = 0; i < BLOCK; i += LANES)
            store_lanes(to + plane_at(g, x0 + i, y), sum_lanes(columns + i, across, 1));
    }
}

static void box_row(int y, void *data)
{
    const box_loop *loop = data;
    for (int i = 0; i < loop->n; i++)
        box_row_of(loop->g, loop->from[i], loop->radius, y, loop->to[i]);
}

void plane_box(const grid *g, const float *const *from, int n, int radius,
               float *const *to)
{
    box_loop loop = {g, from, n, radius, to};
    plane_rows(g, box_row, &loop);
}
