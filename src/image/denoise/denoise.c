#include "image/denoise/denoise.h"

#include "base/memory.h"
#include "image/denoise/blend.h"
#include "image/denoise/prefilter.h"
#include "math/vec.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

enum {
    BLEND_PLANES = 4,  /* while blend_all works */
    OUTLIER_REACH = 2, /* pixels around one that may be an outlier */
    MOST_OUTLIERS = 8, /* that lie together */
};

/* A pixel of one half is cut to so many times the brightest around it, in the other half
   and beside it, but for its like: more has come by a path that hardly anyone finds. */
#define OUTLIER 4.0f

/* Features that scatter in a window by less than this of what they do in the picture tell
   nothing there. */
#define LEAST_SCATTER 1e-3f

/* Differences of less than this of the mean light are not seen. */
#define LEAST_CONTRAST 1e-3f

/* Planes while a light is filtered. */
typedef struct light_planes {
    float *raw[2][3];
    float *variance;             /* of the mean of both */
    float *color[2][3];          /* without outliers */
    float *bright[2], *noise[2]; /* luminance, and its variance summed over patches */
    float *sum[N_BANDS][N_HALVES][N_SUMS];
    float *out[3];
} light_planes;

enum {
    LIGHT_PLANES = sizeof(light_planes) / sizeof(float *),
    READ_PLANES = offsetof(light_planes, color) / sizeof(float *), /* the first */
};

struct denoiser {
    grid g;
    spare_planes spare;                /* of the grid */
    float share, distinct, brightness; /* as in denoise_size */
    int step;                          /* regression.step */
    int n_planes;
    float *plane[MOST_FEATURES];
    float *doubt[MOST_FEATURES]; /* of the plane's feature */
    float least[MOST_FEATURES];
    int n_features;
    float *doubts[MOST_FEATURES]; /* one a feature */
    int first[MOST_FEATURES];     /* planes of the features */
};

denoiser *denoiser_new(const denoise_size *size, GError **error)
{
    if (size->width < 1 || size->height < 1 || !(size->share > 0.0f) ||
        !(size->share < 1.0f) || !(size->distinct > 0.0f)) {
        error_set(error, ERROR_INPUT, "nothing to denoise");
        return NULL;
    }
    denoiser *d = g_new0(denoiser, 1);
    d->g = grid_make(size->width, size->height, size->threads, size->cancel);
    d->g.spare = &d->spare;
    d->share = size->share;
    d->distinct = size->distinct;
    d->brightness = size->brightness;
    d->step = size->coarse ? 4 : 2;
    return d;
}

void denoiser_free(denoiser *d)
{
    if (!d)
        return;
    for (int i = 0; i < d->n_planes; i++)
        big_free(d->plane[i]);
    for (int i = 0; i < d->n_features; i++)
        big_free(d->doubts[i]);
    spare_planes_clear(&d->spare);
    g_free(d);
}

/* Of the halves of features there are fewer. */
size_t denoise_bytes(int width, int height, int n_features, int n_feature_channels)
{
    const grid g = grid_make(width, height, 1, NULL);
    const int doubts = n_features;
    return sizeof(float) * g.n *
           (size_t)(LIGHT_PLANES + BLEND_PLANES + n_feature_channels + doubts);
}

static bool planes_new(const grid *g, float **planes, int n, GError **error)
{
    for (int i = 0; i < n; i++) {
        planes[i] = plane_new(g, error);
        if (!planes[i])
            return false;
    }
    return true;
}

static void planes_free(const grid *g, float **planes, int n)
{
    for (int i = 0; i < n; i++) {
        plane_free(g, planes[i]);
        planes[i] = NULL;
    }
}

/* ---- Reading ---- */

/* What is there becomes planes, channel by channel. */
typedef struct read_loop {
    const grid *g;
    const denoise_source *from;
    float *const *half[2];
    int n_channels;
    float *variance;   /* or NULL */
    atomic_bool *some; /* is set where a number is not zero; or NULL */
} read_loop;

/* A number of a half: the other half's where it is not finite, or what stood before. */
static float finite_number(float of, float other, float before)
{
    if (isfinite(of))
        return of;
    return isfinite(other) ? other : before;
}

/* @return whether any is not zero */
static bool make_finite(float *a, float *b, int n)
{
    float before[2] = {0.0f, 0.0f};
    bool some = false;
    for (int i = 0; i < n; i++) {
        before[0] = finite_number(a[i], b[i], before[0]);
        before[1] = finite_number(b[i], a[i], before[1]);
        a[i] = before[0];
        b[i] = before[1];
        some |= a[i] != 0.0f || b[i] != 0.0f;
    }
    return some;
}

static void read_row(int y, void *data)
{
    const read_loop *loop = data;
    size_t at = plane_at(loop->g, 0, y);
    float *row[2][MOST_FEATURES];
    for (int h = 0; h < 2; h++)
        for (int c = 0; c < loop->n_channels; c++)
            row[h][c] = loop->half[h][c] + at;
    float *const *const rows[2] = {row[0], row[1]};
    loop->from->read(loop->from->data, y, rows,
                     loop->variance ? loop->variance + at : NULL);
    for (int c = 0; c < loop->n_channels; c++)
        if (make_finite(row[0][c], row[1][c], loop->g->width) && loop->some)
            atomic_store_explicit(loop->some, true, memory_order_relaxed);
}

/* ---- Features ---- */

static float scatter_of(const grid *g, const float *plane)
{
    plane_means mean = plane_mean(g, plane);
    return (float)sqrt(fmax(mean.square - mean.plain * mean.plain, 0.0));
}

static bool filter_feature(denoiser *d, const noisy_feature *f, GError **error)
{
    float *doubt = d->doubts[d->n_features];
    for (int h = 0; h < 2; h++)
        plane_mirror(&d->g, f->half[h], f->n_channels);
    if (!prefilter(f, d->plane + d->n_planes, doubt, error))
        return false;
    for (int p = d->n_planes; p < d->n_planes + f->n_channels; p++) {
        d->least[p] = LEAST_SCATTER * scatter_of(&d->g, d->plane[p]);
        d->doubt[p] = doubt;
    }
    return true;
}

/* One feature, of which both halves are given back. */
static bool add_feature(denoiser *d, int n_channels, float **a, float **b, GError **error)
{
    float **planes = d->plane + d->n_planes, **doubt = d->doubts + d->n_features;
    noisy_feature f = {.g = &d->g, .n_channels = n_channels, .share = d->share};
    memcpy(f.half[0], a, (size_t)n_channels * sizeof *a);
    memcpy(f.half[1], b, (size_t)n_channels * sizeof *b);
    bool ok = planes_new(&d->g, planes, n_channels, error) &&
              planes_new(&d->g, doubt, 1, error) && filter_feature(d, &f, error);
    planes_free(&d->g, a, n_channels);
    planes_free(&d->g, b, n_channels);
    if (!ok) {
        planes_free(&d->g, planes, n_channels);
        planes_free(&d->g, doubt, 1);
        return false;
    }
    d->first[d->n_features++] = d->n_planes;
    d->n_planes += n_channels;
    return true;
}

int denoiser_add(denoiser *d, const denoise_source *from, const int *n_channels, int n,
                 GError **error)
{
    float *half[2][MOST_FEATURES] = {{0}};
    int number = d->n_features, all = 0, done = 0;
    for (int i = 0; i < n; i++)
        all += n_channels[i];
    if (d->n_planes + all > MOST_FEATURES) {
        error_set(error, ERROR_INPUT, "more than %d features", (int)MOST_FEATURES);
        return -1;
    }
    bool ok =
        planes_new(&d->g, half[0], all, error) && planes_new(&d->g, half[1], all, error);
    read_loop loop = {.g = &d->g, .from = from, .half = {half[0], half[1]}};
    loop.n_channels = all;
    if (ok)
        plane_rows(&d->g, read_row, &loop);
    for (int i = 0; i < n && ok; done += n_channels[i++])
        ok = add_feature(d, n_channels[i], half[0] + done, half[1] + done, error);
    planes_free(&d->g, half[0], all);
    planes_free(&d->g, half[1], all);
    return ok ? number : -1;
}

/* ---- Light ---- */

typedef struct light_loop {
    const denoiser *d;
    int n_beside;
    float *const *albedo; /* three planes, or NULL */
    light_planes p;
} light_loop;

static void divide_row(int y, void *data)
{
    const light_loop *loop = data;
    const grid *g = &loop->d->g;
    for (int x = 0; x < g->width; x += LANES) {
        size_t at = plane_at(g, x, y);
        for (int h = 0; h < 2; h++) {
            lane_floats rgb[3];
            for (int c = 0; c < 3; c++) {
                float *raw = loop->p.raw[h][c] + at;
                rgb[c] = load_lanes(raw) / divisor(loop->albedo, c, at);
                store_lanes(raw, rgb[c]);
            }
            store_lanes(loop->p.bright[h] + at, luminance_lanes(rgb[0], rgb[1], rgb[2]));
        }
    }
}

static void variance_row(int y, void *data)
{
    const light_loop *loop = data;
    const grid *g = &loop->d->g;
    float share = loop->d->share;
    for (int x = 0; x < g->width; x += LANES) {
        size_t at = plane_at(g, x, y);
        lane_floats by = mean_divisor(loop->albedo, at);
        lane_floats apart =
            load_lanes(loop->p.bright[0] + at) - load_lanes(loop->p.bright[1] + at);
        lane_floats told = load_lanes(loop->p.variance + at); /* NAN: it is not */
        lane_ints known = (told >= 0.0f) & (told < INFINITY);
        store_lanes(loop->p.variance + at,
                    choose_lanes(known, told / (by * by),
                                 share * (1.0f - share) * apart * apart));
    }
}

/* Puts a number among the n greatest, which fall; in each lane. */
static void put_among(lane_floats *greatest, int n, lane_floats number)
{
    for (int i = 0; i < n; i++) {
        lane_floats less = min_lanes(greatest[i], number);
        greatest[i] = max_lanes(greatest[i], number);
        number = less;
    }
}

/* The brightest around a pixel of half h, itself only in the other half, but for those
   that are outliers with it; of LANES pixels. */
static lane_floats brightest_around(const light_loop *loop, int h, size_t at)
{
    lane_floats most[MOST_OUTLIERS] = {{0.0f}};
    int n = 1 + CLAMP(loop->n_beside, 0, MOST_OUTLIERS - 1);
    for (int v = -OUTLIER_REACH; v <= OUTLIER_REACH; v++) {
        for (int u = -OUTLIER_REACH; u <= OUTLIER_REACH; u++) {
            size_t i =
                (size_t)((ptrdiff_t)at + v * (ptrdiff_t)loop->d->g.stride + (ptrdiff_t)u);
            put_among(most, n, load_lanes(loop->p.bright[1 - h] + i));
            if (u != 0 || v != 0)
                put_among(most, n, load_lanes(loop->p.bright[h] + i));
        }
    }
    return most[n - 1];
}

static void cut_row(int y, void *data)
{
    const light_loop *loop = data;
    const grid *g = &loop->d->g;
    const lane_floats none = fill_lanes(0.0f), one = fill_lanes(1.0f);
    for (int x = 0; x < g->width; x += LANES) {
        size_t at = plane_at(g, x, y);
        for (int h = 0; h < 2; h++) {
            lane_floats most = OUTLIER * brightest_around(loop, h, at);
            lane_floats bright = max_lanes(load_lanes(loop->p.bright[h] + at), none);
            lane_floats scale = min_lanes(most / bright, one); /* one, of none / none */
            for (int c = 0; c < 3; c++)
                store_lanes(loop->p.color[h][c] + at,
                            scale * load_lanes(loop->p.raw[h][c] + at));
        }
    }
}

/* Luminance again, of what is left. */
static void bright_row(int y, void *data)
{
    const light_loop *loop = data;
    const grid *g = &loop->d->g;
    for (int x = 0; x < g->width; x += LANES) {
        size_t at = plane_at(g, x, y);
        for (int h = 0; h < 2; h++)
            store_lanes(loop->p.bright[h] + at,
                        luminance_lanes(load_lanes(loop->p.color[h][0] + at),
                                        load_lanes(loop->p.color[h][1] + at),
                                        load_lanes(loop->p.color[h][2] + at)));
    }
}

/* Fills all planes but the sums, of what was read. */
static bool prepare_light(const light_loop *loop)
{
    const grid *g = &loop->d->g;
    if (!plane_rows(g, divide_row, (void *)loop) ||
        !plane_rows(g, variance_row, (void *)loop))
        return false;
    plane_mirror(g, loop->p.bright, 2);
    for (int h = 0; h < 2; h++)
        plane_mirror(g, loop->p.raw[h], 3);
    if (!plane_rows(g, cut_row, (void *)loop) || !plane_rows(g, bright_row, (void *)loop))
        return false;
    plane_mirror(g, loop->p.bright, 2);
    for (int h = 0; h < 2; h++)
        plane_mirror(g, loop->p.color[h], 3);
    patch_noise(g, loop->p.variance, loop->d->share, loop->p.noise);
    return true;
}

static regression regression_of(const light_loop *loop)
{
    const denoiser *d = loop->d;
    regression r = {.g = d->g, .step = d->step, .n_features = d->n_planes};
    float mean = (float)plane_mean(&d->g, loop->p.bright[0]).absolute * LEAST_CONTRAST;
    for (int f = 0; f < d->n_planes; f++) {
        r.feature[f] = d->plane[f];
        r.doubt[f] = d->doubt[f];
        r.least[f] = d->least[f];
    }
    for (int h = 0; h < N_HALVES; h++) {
        r.alike[h] = (patch_source){.g = &d->g,
                                    .n_channels = 1,
                                    .value = {loop->p.bright[1 - h]},
                                    .noise = loop->p.noise[1 - h],
                                    .least = mean * mean + 1e-30f};
        for (int c = 0; c < 3; c++)
            r.color[h][c] = loop->p.color[h][c];
        for (int k = 0; k < N_BANDS; k++)
            memcpy(r.sum[k][h], loop->p.sum[k][h], sizeof r.sum[k][h]);
    }
    return r;
}

static blend blend_of(const light_loop *loop, const regression *r)
{
    blend b = {.done = r,
               .share = loop->d->share,
               .distinct = loop->d->distinct,
               .variance = loop->p.variance,
               .albedo = loop->albedo,
               .brightness = loop->d->brightness};
    for (int c = 0; c < 3; c++) {
        b.out[c] = loop->p.out[c];
        for (int h = 0; h < N_HALVES; h++)
            b.raw[h][c] = loop->p.raw[h][c];
    }
    return b;
}

typedef struct write_loop {
    const light_loop *light;
    float *out;
} write_loop;

static void write_row(int y, void *data)
{
    const write_loop *loop = data;
    const grid *g = &loop->light->d->g;
    float *out = loop->out + 3 * (size_t)y * (size_t)g->width;
    for (int x = 0; x < g->width; x += LANES) {
        size_t at = plane_at(g, x, y);
        lane_floats rgb[3];
        for (int c = 0; c < 3; c++)
            rgb[c] = load_lanes(loop->light->p.out[c] + at) *
                     divisor(loop->light->albedo, c, at);
        for (int i = 0; i < MIN(g->width - x, (int)LANES); i++)
            for (int c = 0; c < 3; c++)
                *out++ += rgb[c][i];
    }
}

static bool write_light(const light_loop *light, float *out)
{
    write_loop loop = {light, out};
    return plane_rows(&light->d->g, write_row, &loop);
}

/* @param some set where there is any */
static bool read_light(const light_loop *loop, const denoise_source *light,
                       atomic_bool *some)
{
    float *const *planes = (float *const *)loop->p.raw;
    read_loop read = {.g = &loop->d->g,
                      .from = light,
                      .half = {planes, planes + 3},
                      .n_channels = 3,
                      .variance = loop->p.variance,
                      .some = some};
    return plane_rows(&loop->d->g, read_row, &read);
}

static bool refuse_cancelled(GError **error)
{
    error_set(error, ERROR_CANCELLED, "cancelled");
    return false;
}

static bool filter_lit(const light_loop *loop, float *out, GError **error)
{
    if (!prepare_light(loop))
        return refuse_cancelled(error);
    regression r = regression_of(loop);
    blend b = blend_of(loop, &r);
    if (!regress(&r))
        return refuse_cancelled(error);
    return blend_all(&b, error) && (write_light(loop, out) || refuse_cancelled(error));
}

static bool filter(light_loop *loop, const denoise_source *light, float *out,
                   GError **error)
{
    atomic_bool some = false;
    float **more = (float **)&loop->p + READ_PLANES;
    if (!read_light(loop, light, &some))
        return refuse_cancelled(error);
    return !atomic_load(&some) ||
           (planes_new(&loop->d->g, more, LIGHT_PLANES - READ_PLANES, error) &&
            filter_lit(loop, out, error));
}

bool denoiser_filter(const denoiser *d, const denoise_source *light, int n_beside,
                     int divide_by, float *out, GError **error)
{
    light_loop loop = {.d = d, .n_beside = n_beside};
    if (divide_by >= 0)
        loop.albedo = d->plane + d->first[divide_by];
    float **planes = (float **)&loop.p;
    bool ok =
        planes_new(&d->g, planes, READ_PLANES, error) && filter(&loop, light, out, error);
    planes_free(&d->g, planes, LIGHT_PLANES);
    return ok;
}
