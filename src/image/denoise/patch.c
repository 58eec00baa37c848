#include "image/denoise/patch.h"

enum { ROWS = ROWS_AT_ONCE + 2 * PATCH /* that patches of some rows reach over */ };
_Static_assert(PATCH == 3, "sum_down adds seven rows");

/* ---- Noise ---- */

typedef struct noise_loop {
    const grid *g;
    float share;
    float *const *noise;
} noise_loop;

/* Of what the mean has, each half. */
static void part_row(int y, void *data)
{
    const noise_loop *loop = data;
    for (int x = 0; x < loop->g->width; x += LANES) {
        size_t at = plane_at(loop->g, x, y);
        lane_floats both = load_lanes(loop->noise[0] + at);
        store_lanes(loop->noise[0] + at, both / loop->share);
        store_lanes(loop->noise[1] + at, both / (1.0f - loop->share));
    }
}

void patch_noise(const grid *g, float *variance, float share, float *const noise[2])
{
    noise_loop loop = {g, share, noise};
    plane_mirror(g, &variance, 1);
    plane_box(g, (const float *const[]){variance}, 1, PATCH, noise);
    plane_rows(g, part_row, &loop);
    plane_mirror(g, noise, 2);
}

/* ---- A row ---- */

/* Squared differences of LANES numbers from p on, added to. */
static lane_floats add_squares(lane_floats to, const float *p, ptrdiff_t offset)
{
    lane_floats difference = load_lanes(p) - load_lanes(p + offset);
    return to + difference * difference;
}

/* Squared differences, summed over columns of patches. */
static void sum_columns(const patch_source *s, size_t at, ptrdiff_t offset,
                        float *columns)
{
    for (int i = 0; i < ACROSS; i += LANES) {
        lane_floats sum = {0};
        for (int c = 0; c < s->n_channels; c++) {
            const float *p = s->value[c] + at + i;
            for (int v = -PATCH; v <= PATCH; v++)
                sum = add_squares(sum, p + v * (ptrdiff_t)s->g->stride, offset);
        }
        store_lanes(columns + i, sum);
    }
}

/* Distances of a row, of sums over columns. */
static void end_distances(const patch_source *s, size_t at, ptrdiff_t offset,
                          const float *columns, float *d)
{
    const float *noise = s->noise + at;
    for (int i = 0; i < BLOCK; i += LANES) {
        lane_floats sum = {0};
        for (int u = 0; u <= 2 * PATCH; u++)
            sum += load_lanes(columns + i + u);
        lane_floats here = load_lanes(noise + i), there = load_lanes(noise + i + offset);
        lane_floats beyond =
            max_lanes(sum - (here + min_lanes(here, there)), fill_lanes(0.0f));
        store_lanes(d + i, beyond / (here + there + s->least));
    }
}

void patch_distances(const patch_source *s, int x, int y, int dx, int dy, float *d)
{
    float columns[ACROSS];
    ptrdiff_t offset = dy * (ptrdiff_t)s->g->stride + dx;
    sum_columns(s, plane_at(s->g, x - PATCH, y), offset, columns);
    end_distances(s, plane_at(s->g, x, y), offset, columns, d);
}

/* ---- Some rows, whose patches share most of theirs ---- */

/* Squared differences of n rows from at on. */
static void square_rows(const patch_source *s, size_t at, int n, ptrdiff_t offset,
                        float (*squares)[ACROSS])
{
    for (int v = 0; v < n; v++, at += s->g->stride) {
        for (int i = 0; i < ACROSS; i += LANES) {
            lane_floats sum = {0};
            for (int c = 0; c < s->n_channels; c++)
                sum = add_squares(sum, s->value[c] + at + i, offset);
            store_lanes(squares[v] + i, sum);
        }
    }
}

/* Of each of n rows and the six that follow it: four, two and one, and four are two of a
   row and of the next but one. */
static void sum_down(int n, float (*rows)[ACROSS], int i)
{
    lane_floats twos[ROWS];
    for (int v = 0; v < n + 5; v++)
        twos[v] = load_lanes(rows[v] + i) + load_lanes(rows[v + 1] + i);
    for (int v = 0; v < n; v++)
        store_lanes(rows[v] + i,
                    twos[v] + twos[v + 2] + twos[v + 4] + load_lanes(rows[v + 6] + i));
}

void patch_distances_of_rows(const patch_source *s, int x, int y, int n, int dx, int dy,
                             float (*d)[BLOCK])
{
    float rows[ROWS][ACROSS];
    ptrdiff_t offset = dy * (ptrdiff_t)s->g->stride + dx;
    square_rows(s, plane_at(s->g, x - PATCH, y - PATCH), n + 2 * PATCH, offset, rows);
    for (int i = 0; i < ACROSS; i += LANES)
        sum_down(n, rows, i);
    for (int v = 0; v < n; v++)
        end_distances(s, plane_at(s->g, x, y + v), offset, rows[v], d[v]);
}
