#include "image/denoise/regress.h"

#include "math/vec.h"

#include <math.h>

enum {
    WINDOW = SIDE * SIDE,
    LEAST_STEP = 2,
    MOST_STEP = 4,
    BLOCK_CENTRES = BLOCK / LEAST_STEP, /* at most */
    STRIP = 24, /* rows; more than windows of two strips reach over */
    MOST_COLUMNS = MOST_FEATURES + 1,
    MOST_ROWS = MOST_COLUMNS + 3, /* of the normal equations, colours below */
};
_Static_assert((int)STRIP > (int)SIDE && (int)STRIP % MOST_STEP == 0,
               "strips do not meet");
_Static_assert(MARGIN >= SIDE / 2 + MOST_STEP / 2 + PATCH + LANES,
               "windows stay in the planes");

/* Of the squared scatter of a feature, so much is added: where it hardly tells, it is
 * left alone. */
#define RIDGE 1e-3f

/* Farther apart than anything that weighs. */
#define FAR 8.0f

/* A window: columns of the regression, and what is regressed. */
typedef struct window {
    int n_columns; /* the first is all ones */
    float column[MOST_COLUMNS][WINDOW];
    float color[N_HALVES][3][WINDOW];
    float doubt[MOST_COLUMNS]; /* squared error of the columns */
    float weight[N_HALVES][N_BANDS][WINDOW];
} window;

/* Four systems are solved at once: both halves', with both bandwidths. */
typedef floats4 systems;
enum { N_SYSTEMS = N_HALVES * N_BANDS };
_Static_assert(sizeof(systems) == N_SYSTEMS * sizeof(float), "each has a lane");

/* What a window's pixels are by the features: a linear function a colour. */
typedef systems solution[3][MOST_COLUMNS];
typedef systems equations[MOST_ROWS][MOST_COLUMNS];

static int system_of(int half, int band)
{
    return half * N_BANDS + band;
}

/* Distances of a block's windows: [half][offset][centre]; and what a window's words weigh
   besides, which falls to its sides, so that no edge of one is seen. */
typedef struct block {
    float distance[N_HALVES][WINDOW][BLOCK_CENTRES];
    float taper[WINDOW];
} block;

/* ---- Windows ---- */

/* From where to where a window is. */
typedef struct place {
    int x0, y0; /* its first pixel */
    int centre; /* in the window */
} place;

/* A window begins so many pixels before its centre. */
static int pixels_before(const regression *r)
{
    return (SIDE - r->step) / 2;
}

static place place_of(const regression *r, int x, int y)
{
    int before = pixels_before(r);
    return (place){x - before, y - before, before * SIDE + before};
}

static void gather(const grid *g, const float *plane, place at, float *out)
{
    for (int i = 0; i < WINDOW; i += LANES) {
        size_t from = plane_at(g, at.x0 + i % SIDE, at.y0 + i / SIDE);
        store_lanes(out + i, load_lanes(plane + from));
    }
}

/* Makes a feature one of the differences to the window's centre, in units of their
   scatter. @return false: it tells nothing */
static bool scale_column(float *column, float centre, float least, float *doubt)
{
    lane_floats sum2 = {0};
    for (int i = 0; i < WINDOW; i += LANES) {
        lane_floats difference = load_lanes(column + i) - centre;
        store_lanes(column + i, difference);
        sum2 += difference * difference;
    }
    float scatter2 = sum_of_lanes(sum2) / (float)WINDOW;
    if (!(scatter2 > least * least + *doubt))
        return false;
    *doubt /= scatter2;
    float scale = 1.0f / sqrtf(scatter2);
    for (int i = 0; i < WINDOW; i++)
        column[i] *= scale;
    return true;
}

static void gather_features(const regression *r, place at, window *w)
{
    for (int i = 0; i < WINDOW; i++)
        w->column[0][i] = 1.0f;
    w->n_columns = 1;
    for (int f = 0; f < r->n_features; f++) {
        float *column = w->column[w->n_columns], *doubt = &w->doubt[w->n_columns];
        gather(&r->g, r->feature[f], at, column);
        *doubt = r->doubt[f][plane_at(&r->g, at.x0 + at.centre % SIDE,
                                      at.y0 + at.centre / SIDE)];
        w->n_columns += scale_column(column, column[at.centre], r->least[f], doubt);
    }
}

/* Whether any of n numbers, a multiple of LANES, is not zero. */
static bool shine(const float *numbers, int n)
{
    lane_floats most = {0};
    for (int i = 0; i < n; i += LANES)
        most = max_lanes(abs_lanes(load_lanes(numbers + i)), most);
    return bits_below(fill_lanes(0.0f), most) != 0;
}

/* @return false: all is black */
static bool gather_colors(const regression *r, place at, window *w)
{
    bool black = true;
    for (int h = 0; h < N_HALVES; h++) {
        for (int c = 0; c < 3; c++) {
            gather(&r->g, r->color[h][c], at, w->color[h][c]);
            black = black && !shine(w->color[h][c], WINDOW);
        }
    }
    return !black;
}

/* Pixels out of the picture weigh nothing. */
static void cut_at_edges(const grid *g, place at, float *distance)
{
    for (int v = 0; v < SIDE; v++) {
        for (int u = 0; u < SIDE; u++) {
            int qx = at.x0 + u, qy = at.y0 + v;
            if (qx < 0 || qx >= g->width || qy < 0 || qy >= g->height)
                distance[v * SIDE + u] = FAR;
        }
    }
}

static void weigh(const grid *g, place at, const float (*distance)[BLOCK_CENTRES],
                  int half, window *w)
{
    static const float scale[N_BANDS] = {1.0f, 4.0f}; /* 1/k² */
    float d[WINDOW];
    for (int i = 0; i < WINDOW; i++)
        d[i] = distance[i][0];
    if (at.x0 < 0 || at.x0 + SIDE > g->width || at.y0 < 0 || at.y0 + SIDE > g->height)
        cut_at_edges(g, at, d);
    for (int k = 0; k < N_BANDS; k++) {
        for (int i = 0; i < WINDOW; i += LANES)
            store_lanes(w->weight[half][k] + i,
                        patch_weight(scale[k] * load_lanes(d + i)));
    }
}

/* ---- Least squares ---- */

/* Scalar products with four columns, of one weighed with both bandwidths. */
static void dot_4(float a[N_BANDS][WINDOW], const float *const b[4], floats4 out[N_BANDS])
{
    lane_floats sum[N_BANDS][4] = {{{0}}};
    for (int i = 0; i < WINDOW; i += LANES) {
        lane_floats wide = load_lanes(a[0] + i), narrow = load_lanes(a[1] + i);
        for (int k = 0; k < 4; k++) {
            lane_floats v = load_lanes(b[k] + i);
            sum[0][k] += wide * v;
            sum[1][k] += narrow * v;
        }
    }
    for (int k = 0; k < N_BANDS; k++)
        out[k] = sums_of_lanes(sum[k]);
}

/* The lower half of a half's normal equations; their right-hand sides in the last three
   rows. */
static void make_equations(const window *w, int half, equations m)
{
    int n = w->n_columns, wide = system_of(half, 0), narrow = system_of(half, 1);
    float weighed[N_BANDS][WINDOW];
    for (int j = 0; j < n; j++) {
        for (int b = 0; b < N_BANDS; b++) {
            for (int i = 0; i < WINDOW; i += LANES)
                store_lanes(weighed[b] + i, load_lanes(w->weight[half][b] + i) *
                                                load_lanes(w->column[j] + i));
        }
        for (int i = j; i < n + 3; i += 4) {
            const float *with[4];
            floats4 product[N_BANDS];
            for (int k = 0; k < 4; k++) {
                int row = MIN(i + k, n + 2);
                with[k] = row < n ? w->column[row] : w->color[half][row - n];
            }
            dot_4(weighed, with, product);
            for (int k = 0; k < 4 && i + k < n + 3; k++) {
                m[i + k][j][wide] = product[0][k];
                m[i + k][j][narrow] = product[1][k];
            }
        }
    }
}

/* 1 / sqrt(d); 0 where d is not positive */
static systems inverse_root(systems d)
{
    systems out = {0};
    for (int i = 0; i < N_SYSTEMS; i++)
        if (d[i] > 0.0f)
            out[i] = 1.0f / sqrtf(d[i]);
    return out;
}

/* Cholesky's, in place; the right-hand sides become L⁻¹ b on the way. */
static void factor(equations m, int n)
{
    for (int j = 0; j < n; j++) {
        systems d = m[j][j];
        for (int k = 0; k < j; k++)
            d -= m[j][k] * m[j][k];
        systems inverse = m[j][j] = inverse_root(d);
        for (int i = j + 1; i < n + 3; i++) {
            systems sum = m[i][j];
            for (int k = 0; k < j; k++)
                sum -= m[i][k] * m[j][k];
            m[i][j] = sum * inverse;
        }
    }
}

/* What the factors and L⁻¹ b give. */
static void substitute(equations m, int n, solution s)
{
    for (int c = 0; c < 3; c++) {
        for (int j = n - 1; j >= 0; j--) {
            systems sum = m[n + c][j];
            for (int k = j + 1; k < n; k++)
                sum -= m[k][j] * s[c][k];
            s[c][j] = sum * m[j][j];
        }
    }
}

/* Features that are in doubt themselves count less: by as much as doubt adds to their
   scatter. */
static void solve(const window *w, equations m, solution s)
{
    for (int j = 1; j < w->n_columns; j++)
        m[j][j] += (RIDGE + w->doubt[j]) * m[0][0] + RIDGE;
    factor(m, w->n_columns);
    substitute(m, w->n_columns, s);
}

/* ---- What is said of the window's pixels ---- */

/* Adds to the sums of LANES pixels. */
static void say(const window *w, lane_floats weight, float by[3][MOST_COLUMNS], int i,
                float *const to[N_SUMS])
{
    lane_floats red = {0}, green = {0}, blue = {0};
    for (int j = 0; j < w->n_columns; j++) {
        lane_floats x = load_lanes(w->column[j] + i);
        red += by[0][j] * x;
        green += by[1][j] * x;
        blue += by[2][j] * x;
    }
    store_lanes(to[0], load_lanes(to[0]) + weight * red);
    store_lanes(to[1], load_lanes(to[1]) + weight * green);
    store_lanes(to[2], load_lanes(to[2]) + weight * blue);
    store_lanes(to[3], load_lanes(to[3]) + weight);
}

static void spread(const regression *r, place at, const window *w, const float *taper,
                   int half, int band, solution s)
{
    float *const *sum = r->sum[band][half];
    float by[3][MOST_COLUMNS];
    for (int c = 0; c < 3; c++)
        for (int j = 0; j < w->n_columns; j++)
            by[c][j] = s[c][j][system_of(half, band)];
    for (int i = 0; i < WINDOW; i += LANES) {
        size_t p = plane_at(&r->g, at.x0 + i % SIDE, at.y0 + i / SIDE);
        float *const to[N_SUMS] = {sum[0] + p, sum[1] + p, sum[2] + p, sum[3] + p};
        say(w, load_lanes(w->weight[half][band] + i) * load_lanes(taper + i), by, i, to);
    }
}

static void regress_at(const regression *r, place at, const block *b, int centre)
{
    window w;
    equations m;
    solution s;
    if (!gather_colors(r, at, &w))
        return;
    gather_features(r, at, &w);
    for (int h = 0; h < N_HALVES; h++) {
        weigh(&r->g, at, (const float(*)[BLOCK_CENTRES]) & b->distance[h][0][centre], h,
              &w);
        make_equations(&w, h, m);
    }
    solve(&w, m, s);
    for (int h = 0; h < N_HALVES; h++)
        for (int k = 0; k < N_BANDS; k++)
            spread(r, at, &w, b->taper, h, k, s);
}

/* ---- Blocks and strips ---- */

/* Whether anything in reach of the block's windows shines. */
static bool block_shines(const regression *r, int x0, int y)
{
    int before = pixels_before(r);
    for (int h = 0; h < N_HALVES; h++) {
        for (int c = 0; c < 3; c++) {
            for (int v = 0; v < SIDE; v++) {
                size_t at = plane_at(&r->g, x0 - before, y - before + v);
                if (shine(r->color[h][c] + at, BLOCK + SIDE))
                    return true;
            }
        }
    }
    return false;
}

/* Whole in the middle half of a row, and none beyond its ends. */
static float taper_at(int i)
{
    float beside = fabsf((float)i + 0.5f - SIDE / 2.0f) / (SIDE / 2.0f);
    return minf(2.0f - 2.0f * beside, 1.0f);
}

static void make_taper(float *taper)
{
    for (int i = 0; i < WINDOW; i++)
        taper[i] = taper_at(i % SIDE) * taper_at(i / SIDE);
}

static void measure_block(const regression *r, int x0, int y, block *b)
{
    float d[BLOCK];
    int before = pixels_before(r);
    for (int h = 0; h < N_HALVES; h++) {
        for (int o = 0; o < WINDOW; o++) {
            patch_distances(&r->alike[h], x0, y, o % SIDE - before, o / SIDE - before, d);
            for (int i = 0; i < MIN(BLOCK / r->step, BLOCK_CENTRES); i++)
                b->distance[h][o][i] = d[i * r->step];
        }
    }
}

static void regress_row(const regression *r, int y, block *b)
{
    for (int x0 = 0; x0 < r->g.width; x0 += BLOCK) {
        if (cancelled(r->g.cancel) || !block_shines(r, x0, y))
            continue;
        measure_block(r, x0, y, b);
        for (int x = x0; x < MIN(x0 + BLOCK, r->g.width); x += r->step)
            regress_at(r, place_of(r, x, y), b, (x - x0) / r->step);
    }
}

typedef struct strip_loop {
    const regression *r;
    size_t odd; /* 0 or 1 */
} strip_loop;

static void regress_strip(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)end;
    (void)thread;
    const strip_loop *loop = data;
    block b;
    make_taper(b.taper);
    int y0 = (int)(2 * begin + loop->odd) * STRIP;
    int y1 = MIN(y0 + STRIP, loop->r->g.height);
    for (int y = y0; y < y1; y += loop->r->step)
        regress_row(loop->r, y, &b);
}

bool regress(const regression *r)
{
    size_t strips = ((size_t)r->g.height + STRIP - 1) / STRIP;
    strip_loop even = {r, 0}, odd = {r, 1};
    return parallel_for((strips + 1) / 2, 1, r->g.threads, r->g.cancel, regress_strip,
                        &even) &&
           parallel_for(strips / 2, 1, r->g.threads, r->g.cancel, regress_strip, &odd);
}
