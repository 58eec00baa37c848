#include "image/denoise/prefilter.h"

#include <string.h>

enum { AROUND = 4 /* pixels that are looked at in both directions */ };

/* 1/k² of the bandwidth k = 1/2. */
#define SHARPNESS 4.0f

typedef struct feature_loop {
    const noisy_feature *f;
    patch_source alike[2]; /* weights that filter half h: of the other */
    float *out[2][MOST_CHANNELS];
    float *error2; /* of the result, over the pixels of a patch */
} feature_loop;

/* ---- Noise ---- */

typedef struct noise_loop {
    const noisy_feature *f;
    float *variance;
} noise_loop;

/* Variance of the mean of the halves, summed over channels, as their difference tells. */
static void variance_row(int y, void *data)
{
    const noise_loop *loop = data;
    const noisy_feature *f = loop->f;
    for (int x = 0; x < f->g->width; x += LANES) {
        size_t at = plane_at(f->g, x, y);
        lane_floats sum = fill_lanes(0.0f);
        for (int c = 0; c < f->n_channels; c++) {
            lane_floats d = load_lanes(f->half[0][c] + at);
            d -= load_lanes(f->half[1][c] + at);
            sum += f->share * (1.0f - f->share) * d * d;
        }
        store_lanes(loop->variance + at, sum);
    }
}

/* Noise of patches of the halves into the planes. */
static bool find_noise(const noisy_feature *f, float *noise[2], GError **error)
{
    float *variance = plane_new(f->g, error);
    if (!variance)
        return false;
    noise_loop loop = {f, variance};
    plane_rows(f->g, variance_row, &loop);
    patch_noise(f->g, variance, f->share, noise);
    plane_free(f->g, variance);
    return true;
}

/* ---- Smoothing ---- */

/* Some rows of a block. */
typedef struct block_rows {
    int x, y, n;
} block_rows;

static bool are_noisy(const grid *g, const float *noise, block_rows at)
{
    float sum = 0.0f;
    for (int v = 0; v < at.n; v++)
        for (int i = 0; i < BLOCK; i++)
            sum += noise[plane_at(g, at.x + i, at.y + v)];
    return sum > 0.0f;
}

/* Sums of the channels, and of the weights. */
typedef float block_sums[MOST_CHANNELS + 1][ROWS_AT_ONCE][BLOCK];

/* Adds what those pixels say that are so far away. */
static void add_pixels(const feature_loop *loop, int h, block_rows at, int dx, int dy,
                       block_sums sum)
{
    const noisy_feature *f = loop->f;
    float d[ROWS_AT_ONCE][BLOCK];
    patch_distances_of_rows(&loop->alike[h], at.x, at.y, at.n, dx, dy, d);
    for (int v = 0; v < at.n; v++) {
        size_t there = plane_at(f->g, at.x + dx, at.y + v + dy);
        for (int i = 0; i < BLOCK; i += LANES) {
            lane_floats weight = patch_weight(SHARPNESS * load_lanes(d[v] + i));
            float *all = sum[MOST_CHANNELS][v] + i;
            store_lanes(all, load_lanes(all) + weight);
            for (int c = 0; c < f->n_channels; c++) {
                float *to = sum[c][v] + i;
                store_lanes(to, load_lanes(to) +
                                    weight * load_lanes(f->half[h][c] + there + i));
            }
        }
    }
}

static void smooth_rows(const feature_loop *loop, int h, block_rows at)
{
    const grid *g = loop->f->g;
    block_sums sum = {{{0}}};
    for (int dy = -AROUND; dy <= AROUND; dy++)
        for (int dx = -AROUND; dx <= AROUND; dx++)
            add_pixels(loop, h, at, dx, dy, sum);
    for (int c = 0; c < loop->f->n_channels; c++) {
        for (int v = 0; v < at.n; v++) {
            float *out = loop->out[h][c] + plane_at(g, at.x, at.y + v);
            for (int i = 0; i < BLOCK; i++)
                out[i] = sum[c][v][i] / sum[MOST_CHANNELS][v][i];
        }
    }
}

static void copy_rows(const feature_loop *loop, int h, block_rows at)
{
    const noisy_feature *f = loop->f;
    for (int c = 0; c < f->n_channels; c++) {
        for (int v = 0; v < at.n; v++) {
            size_t i = plane_at(f->g, at.x, at.y + v);
            memcpy(loop->out[h][c] + i, f->half[h][c] + i, BLOCK * sizeof(float));
        }
    }
}

static void smooth_some(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const feature_loop *loop = data;
    const grid *g = loop->f->g;
    block_rows at = {0, (int)begin, (int)(end - begin)};
    for (; at.x < g->width && !cancelled(g->cancel); at.x += BLOCK) {
        bool noisy = are_noisy(g, loop->alike[0].noise, at);
        for (int h = 0; h < 2; h++)
            (noisy ? smooth_rows : copy_rows)(loop, h, at);
    }
}

/* Joins the smoothed halves, of which those of the second become the result; by how much
   they differ is what is left of the noise. */
static void join_row(int y, void *data)
{
    const feature_loop *loop = data;
    const noisy_feature *f = loop->f;
    float share = f->share, n = PATCH_PIXELS * (float)f->n_channels;
    for (int x = 0; x < f->g->width; x += LANES) {
        size_t at = plane_at(f->g, x, y);
        lane_floats sum = fill_lanes(0.0f);
        for (int c = 0; c < f->n_channels; c++) {
            lane_floats a = load_lanes(loop->out[0][c] + at);
            lane_floats b = load_lanes(loop->out[1][c] + at);
            sum += share * (1.0f - share) * (a - b) * (a - b);
            store_lanes(loop->out[1][c] + at, share * a + (1.0f - share) * b);
        }
        store_lanes(loop->error2 + at, sum / n);
    }
}

static bool smooth(feature_loop *loop, float *const noise[2])
{
    const noisy_feature *f = loop->f;
    for (int h = 0; h < 2; h++) {
        loop->alike[h] = (patch_source){.g = f->g,
                                        .n_channels = f->n_channels,
                                        .noise = noise[1 - h],
                                        .least = 1e-20f};
        for (int c = 0; c < f->n_channels; c++)
            loop->alike[h].value[c] = f->half[1 - h][c];
    }
    if (!parallel_for((size_t)f->g->height, ROWS_AT_ONCE, f->g->threads, f->g->cancel,
                      smooth_some, loop) ||
        !plane_rows(f->g, join_row, loop))
        return false;
    plane_mirror(f->g, loop->out[1], f->n_channels);
    plane_mirror(f->g, &loop->error2, 1);
    return true;
}

bool prefilter(const noisy_feature *f, float *const out[MOST_CHANNELS], float *doubt,
               GError **error)
{
    enum { NOISE = MOST_CHANNELS, N = MOST_CHANNELS + 2 };
    feature_loop loop = {.f = f};
    float *planes[N] = {0};
    bool ok = true;
    for (int i = 0; i < N && ok; i++)
        ok = (planes[i] = plane_new(f->g, error)) != NULL;
    for (int c = 0; c < MOST_CHANNELS; c++) {
        loop.out[0][c] = planes[c];
        loop.out[1][c] = out[c];
    }
    if (ok && (ok = find_noise(f, planes + NOISE, error))) {
        loop.error2 = planes[NOISE]; /* no longer wanted by then */
        ok = smooth(&loop, planes + NOISE);
        if (ok)
            plane_box(f->g, (const float *const[]){loop.error2}, 1, PATCH, &doubt);
        else
            error_set(error, ERROR_CANCELLED, "cancelled");
    }
    for (int i = 0; i < N; i++)
        plane_free(f->g, planes[i]);
    return ok;
}
