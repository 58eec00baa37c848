/*
 * The grid: points sorted by cell, so that a query reads a few runs of memory.
 *
 *   start[slot] ──► x[] y[] z[]   one run per cell, x fastest: the three cells of a row
 *                   wi[] flux[]   that a query meets are one run
 *
 * Workload: built once per pass from 10⁵..10⁸ points, queried at every camera hit with
 * the radius it was built for. Cells are as wide as the radius, so a query meets 3×3×3
 * cells, nine runs, most of them empty since points lie on surfaces; or up to four times
 * as wide where that makes the grid small enough: then few points lie within the radius,
 * and looking at more is cheaper than hashing (8 within it: 73 ns in place of 259). With
 * no radius given, cells are sized so that there is one for every four points.
 *
 * The grid covers the points' bounds densely while it has at most one cell a point.
 * Beyond that (a light in a landscape) rows of cells are hashed into that many slots: row
 * (y, z) begins at a hashed slot and x counts on from there, wrapping round. Photons of
 * far cells that share a slot fail the distance test; a query's rows that overlap are
 * merged, so that it meets none twice.
 *
 * Counting sort: O(n), no comparisons. Ma & McCool, "Low Latency Photon Mapping Using
 * Block Hashing", 2002.
 */
#include "base/memory.h"
#include "base/parallel.h"
#include "math/box.h"
#include "math/sampler.h"
#include "photon/map/cell_sort.h"
#include "photon/map/index_kind.h"
#include "photon/map/nearest.h"

#include <float.h>

enum {
    MAX_CELLS_AN_AXIS = 1 << 20, /* size: their numbers are exact in floats */
    MIN_SLOTS = 1 << 12,         /* size: of the smallest table */
    MAX_HASHED_ROWS = 256,       /* size: a query that meets more looks at all points */
    MOST_RADII = 4,              /* size: a cell may be wide */
    POINTS_A_CELL = 4,           /* size: where no radius is known */
};

/* size: steps in which the width of cells is tried */
#define CELL_STEP 1.0625f

typedef struct grid {
    vec3 low, high; /* of the points */
    float cell;     /* width, m */
    float inv_cell;
    int32_t count[3]; /* cells an axis */
    bool hashed;
    size_t n_slots;  /* a power of two if hashed */
    uint32_t *start; /* points of slot s: start[s] .. start[s + 1] - 1 */
} grid;

/* Cells low..high an axis, inclusive. */
typedef struct cell_range {
    int32_t low[3], high[3];
} cell_range;

/* Monotone in x, and clamped: no point is beyond the outermost cells. */
static int32_t cell_index(const grid *g, int axis, float x)
{
    float t = (x - g->low[axis]) * g->inv_cell;
    float last = (float)(g->count[axis] - 1);
    return t >= last ? g->count[axis] - 1 : t > 0.0f ? (int32_t)t : 0;
}

static size_t row_slot(const grid *g, int32_t y, int32_t z)
{
    if (g->hashed)
        return hash_mix((uint64_t)y, (uint64_t)z) & (g->n_slots - 1);
    return ((size_t)z * (size_t)g->count[1] + (size_t)y) * (size_t)g->count[0];
}

static size_t slot_of_point(size_t i, const void *data)
{
    const point_index *index = data;
    const grid *g = index->structure;
    size_t x = (size_t)cell_index(g, 0, index->points.x[i]);
    int32_t y = cell_index(g, 1, index->points.y[i]),
            z = cell_index(g, 2, index->points.z[i]);
    size_t slot = row_slot(g, y, z) + x;
    return g->hashed ? slot & (g->n_slots - 1) : slot;
}

/* ---- Building ---- */

typedef struct bounds_loop {
    const point_arrays *points;
    box3 *boxes; /* of each chunk */
} bounds_loop;

static void bound_chunk(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const bounds_loop *loop = data;
    const point_arrays *s = loop->points;
    box3 box = box3_empty();
    for (size_t i = begin; i < end; i++) {
        vec3 p = vec3_make(s->x[i], s->y[i], s->z[i]);
        box.low = min3(p, box.low); /* in this order a NaN changes nothing */
        box.high = max3(p, box.high);
    }
    loop->boxes[begin / ITEMS_AT_ONCE] = box;
}

static bool find_bounds(grid *g, const point_arrays *s, workers by, GError **error)
{
    size_t n_chunks = (s->n + ITEMS_AT_ONCE - 1) / ITEMS_AT_ONCE;
    box3 all = box3_empty();
    bounds_loop loop = {s, big_alloc(n_chunks, sizeof(box3), "grid of points", error)};
    if (!loop.boxes)
        return false;
    bool done = parallel_work(s->n, ITEMS_AT_ONCE, by, bound_chunk, &loop, error);
    for (size_t i = 0; i < n_chunks && done; i++)
        all = box3_union(all, loop.boxes[i]);
    big_free(loop.boxes);
    g->low = all.low;
    g->high = all.high;
    return done;
}

static double count_cells(grid *g, float cell)
{
    double n = 1.0;
    g->cell = cell;
    g->inv_cell = 1.0f / cell;
    for (int axis = 0; axis < 3; axis++) {
        float extent =
            fminf((g->high[axis] - g->low[axis]) / cell, MAX_CELLS_AN_AXIS - 1);
        g->count[axis] = extent > 0.0f ? (int32_t)extent + 1 : 1;
        n *= (double)g->count[axis];
    }
    return n;
}

/* Chooses the width of cells for a radius; returns their number, which is above `most`
 * only if MOST_RADII would not help. */
static double choose_cell(grid *g, float radius, double most)
{
    for (float cell = radius; cell < MOST_RADII * radius; cell *= CELL_STEP) {
        double cells = count_cells(g, cell);
        if (cells <= most)
            return cells;
    }
    return count_cells(g, radius);
}

/* The same when no radius is known. */
static double choose_cell_by_density(grid *g, float extent, size_t n)
{
    float cell = extent;
    while (count_cells(g, cell) < (double)n / POINTS_A_CELL &&
           cell > extent / MAX_CELLS_AN_AXIS)
        cell /= CELL_STEP;
    return count_cells(g, cell);
}

static size_t power_of_two_at_most(size_t n)
{
    size_t power = 1;
    while (power <= n / 2)
        power *= 2;
    return power;
}

/* Sets the width of cells, their number, and whether they are hashed. */
static void shape_grid(grid *g, size_t n, float radius)
{
    size_t most = MAX(n, MIN_SLOTS);
    float extent = fmaxf(max_component3(g->high - g->low), FLT_MIN);
    double cells =
        radius > 0.0f
            ? choose_cell(g, fmaxf(radius, extent / MAX_CELLS_AN_AXIS), (double)most)
            : choose_cell_by_density(g, extent, n);
    g->hashed = cells > (double)most;
    g->n_slots = g->hashed ? power_of_two_at_most(most) : (size_t)cells;
}

static void grid_free(point_index *index)
{
    grid *g = index->structure;
    big_free(g->start);
    big_free(g);
}

static size_t *grid_sort(point_index *index, float radius, workers by, GError **error)
{
    grid *g = index->structure = big_alloc(1, sizeof *g, "grid of points", error);
    if (!g)
        return NULL;
    if (!find_bounds(g, &index->points, by, error))
        return NULL;
    shape_grid(g, index->points.n, radius);
    g->start = big_alloc(g->n_slots + 1, sizeof *g->start, "grid of points", error);
    if (!g->start)
        return NULL;
    return cell_sort(index->points.n, g->n_slots, slot_of_point, index, g->start, by,
                     error);
}

static size_t grid_bytes(const point_index *index)
{
    const grid *g = index->structure;
    return sizeof *g + (g->n_slots + 1) * sizeof *g->start;
}

/* ---- Runs ---- */

/* The cells that [p - r, p + r] meets; false if it misses the points' bounds. */
static bool cells_within(const grid *g, vec3 p, float radius, cell_range *range)
{
    for (int axis = 0; axis < 3; axis++) {
        float low = p[axis] - radius, high = p[axis] + radius;
        if (!(low <= g->high[axis] && high >= g->low[axis]))
            return false;
        range->low[axis] = cell_index(g, axis, low);
        range->high[axis] = cell_index(g, axis, high);
    }
    return true;
}

static void dense_runs(const grid *g, const cell_range *range, run_batch *batch)
{
    for (int32_t z = range->low[2]; z <= range->high[2]; z++) {
        for (int32_t y = range->low[1]; y <= range->high[1]; y++) {
            const uint32_t *row = g->start + row_slot(g, y, z);
            run_batch_add(batch, row[range->low[0]], row[range->high[0] + 1]);
        }
    }
}

/* Slots first .. last - 1. */
typedef struct slot_run {
    size_t first, last;
} slot_run;

/* Adds a run, keeping runs sorted by their first slot. */
static size_t insert_run(slot_run *runs, size_t n, slot_run run)
{
    size_t i = n;
    for (; i > 0 && runs[i - 1].first > run.first; i--)
        runs[i] = runs[i - 1];
    runs[i] = run;
    return n + 1;
}

/* The slots of all rows in range, sorted; a row that wraps round makes two. */
static size_t collect_rows(const grid *g, const cell_range *range, slot_run *runs)
{
    size_t n = 0, width = (size_t)(range->high[0] - range->low[0]) + 1;
    for (int32_t z = range->low[2]; z <= range->high[2]; z++) {
        for (int32_t y = range->low[1]; y <= range->high[1]; y++) {
            size_t first = (row_slot(g, y, z) + (size_t)range->low[0]) & (g->n_slots - 1);
            size_t last = first + width;
            n = insert_run(runs, n, (slot_run){first, MIN(last, g->n_slots)});
            if (last > g->n_slots)
                n = insert_run(runs, n, (slot_run){0, last - g->n_slots});
        }
    }
    return n;
}

static void hashed_runs(const grid *g, const cell_range *range, run_batch *batch)
{
    slot_run runs[2 * MAX_HASHED_ROWS];
    double width = (double)(range->high[0] - range->low[0]) + 1.0;
    double rows = ((double)(range->high[1] - range->low[1]) + 1.0) *
                  ((double)(range->high[2] - range->low[2]) + 1.0);
    if (rows > MAX_HASHED_ROWS || rows * width > 0.5 * (double)g->n_slots) {
        run_batch_add(batch, 0, g->start[g->n_slots]);
        return;
    }
    size_t n = collect_rows(g, range, runs), slot = 0;
    for (size_t i = 0; i < n; i++) {
        size_t first = MAX(runs[i].first, slot);
        if (first >= runs[i].last)
            continue;
        slot = runs[i].last;
        run_batch_add(batch, g->start[first], g->start[slot]);
    }
}

static void grid_runs(const point_index *index, vec3 p, float radius,
                      point_run_visitor visit, void *data)
{
    const grid *g = index->structure;
    cell_range range;
    if (!cells_within(g, p, radius, &range))
        return;
    run_batch batch;
    run_batch_begin(&batch, &index->points, visit, data);
    if (g->hashed)
        hashed_runs(g, &range, &batch);
    else
        dense_runs(g, &range, &batch);
    run_batch_flush(&batch);
}

/* ---- Nearest ---- */

static void count_runs(const point_run *runs, size_t n, void *data)
{
    for (size_t i = 0; i < n; i++)
        *(size_t *)data += runs[i].end - runs[i].begin;
}

static void nearest_runs(const point_run *runs, size_t n, void *data)
{
    for (size_t i = 0; i < n; i++)
        nearest_add_run(data, runs[i].begin, runs[i].end);
}

/* The radius beyond which there is no point. */
static float radius_of_all(const grid *g, vec3 p)
{
    vec3 reach = max3(abs3(p - g->low), abs3(p - g->high));
    return 2.0f * length3(reach);
}

/* A first radius, from the number of points in the cells around p, taken to lie on a
 * surface: a little more than k should be in it. */
static float guess_radius(const point_index *index, vec3 p, size_t k, float largest)
{
    const grid *g = index->structure;
    float radius = 0.5f * g->cell;
    size_t found = 0;
    for (; radius < largest; radius *= 2.0f) {
        grid_runs(index, p, radius, count_runs, &found);
        if (found > 0)
            break;
    }
    float side = 2.0f * radius + g->cell;
    float wanted = 1.5f * (float)k / (float)MAX(found, 1); /* size: of the search */
    return fminf(side * sqrtf(INV_PI_F * wanted), largest);
}

/* Searches shells growing outwards until k points are within the radius searched. */
static bool grid_nearest(const point_index *index, const point_query *query, size_t k,
                         float radius, point_hits *hits)
{
    const grid *g = index->structure;
    nearest_set set;
    if (!nearest_begin(&set, &index->points, query, k, radius, hits))
        return false;
    float all = radius_of_all(g, query->p);
    float largest = all < radius ? all : radius;
    float r = guess_radius(index, query->p, k, largest);
    for (;; r *= 2.0f) {
        bool last = !(r < largest);
        nearest_restart(&set, last ? radius : r);
        grid_runs(index, query->p, last ? radius : r, nearest_runs, &set);
        if (last || hits->n >= k)
            break;
    }
    nearest_cut(&set);
    return true;
}

const point_index_kind point_index_grid = {
    .name = "grid",
    .sort = grid_sort,
    .free = grid_free,
    .bytes = grid_bytes,
    .runs = grid_runs,
    .nearest = grid_nearest,
};
