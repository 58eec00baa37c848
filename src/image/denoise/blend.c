#include "image/denoise/blend.h"

#include "math/vec.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* What the filter lost comes back as far as it is surely more than noise: so many of its
   standard errors are taken off its mean over a patch, of single pixels and of means over
   squares. With none off means, what few bright paths leave came back as specks (Sponza,
   32 samples a pixel), though nine scenes after 4 passes have .86 to 1.0 of the relative
   squared error; with a whole one they have 1.0 to 1.21. Half a one off pixels: .86 to
   1.0, chandelier 1.01 of FLIP. */
#define SURE_PIXELS 1.0f
#define SURE_MEANS 0.3f

/* What a pixel's own colour weighs beside what windows say of it, where a pixel that is
   like their centre weighs up to 1. Of one that nothing is like (a lamp, a spot of light
   of a pixel or two) and that no window has at its centre, windows say hardly a word, and
   a wrong one. Relative squared errors of 17 scenes, 4 and 16 passes, but for the worst
   thousandth of all pixels, over those without: .98 in the mean, .78 (candles behind
   glass) to 1.00. Ten times as much: .976, but means of what is smooth are worse. */
#define OWN_WEIGHT 0.005f

/* Of a pixel that is like the centre of so few windows (of 36, all of whose weights are
   whole where one is around every second pixel), windows know little: own_row. Relative
   squared errors after 2 passes over those without, eight scenes: .89 in the mean, .63 (a
   glass ball's caustic) to 1.00. With half as many again textures that features know keep
   more noise than they may [/denoise/texture-known-to-albedo]. */
#define FEW_WORDS 10.0f

/* What it weighs where bandwidths are chosen by how well windows tell: only where they
   say nothing. */
#define LEAST_WEIGHT 1e-9f

/* What the filter lost comes back in rounds: where few windows know anything, pixels that
   outliers were cut from (own_row); then everywhere, as it was, means over squares of
   2 r + 1 pixels first: they have the least noise, and the eye, which sees little of
   single pixels, sees them. */
typedef struct give_round {
    int radius;
    bool of_few;
} give_round;

static const give_round rounds[] = {{0, true}, {PATCH, false}, {1, false}, {0, false}};

enum {
    N_OWN = 4,      /* planes; all others were sums of the regression */
    N_MEANS = 3,    /* see residual_row */
    N_PRODUCTS = 5, /* see product_row */
    N_OF_FEW = 2,   /* of them, for own_row */
};

enum { LOST2, APART, FOLLOWS, ERROR2, GIVEN };

typedef struct blend_loop {
    const blend *b;
    const grid *g;
    float *errors[N_BANDS], *around[N_BANDS]; /* own; later any */
    float *filtered[N_HALVES][3];             /* the halves */
    float *words; /* what windows weigh that were asked for a pixel; one of the first */
    /* Of one round; planes that are no longer needed are used again: */
    give_round round;
    float *residual[N_MEANS], *mean[N_MEANS];
    float *noise; /* variance as it is given, summed over squares */
    float *product[N_PRODUCTS], *sum[N_PRODUCTS];
} blend_loop;

/* All rows are worked on LANES pixels at a time, some of the margin's behind the last. */

static lane_floats brightness(const float *const planes[3], size_t at)
{
    return luminance_lanes(load_lanes(planes[0] + at), load_lanes(planes[1] + at),
                           load_lanes(planes[2] + at));
}

/* Of the mean of both halves. */
static lane_floats joined(const blend_loop *loop, lane_floats a, lane_floats b)
{
    return loop->b->share * a + (1.0f - loop->b->share) * b;
}

/* What a regression says of a half of pixels, and these themselves. */
static void said(const blend_loop *loop, int band, int half, size_t at, float own_weight,
                 lane_floats out[3])
{
    float *const *sum = loop->b->done->sum[band][half];
    const float *const *own = loop->b->done->color[half];
    lane_floats weight = load_lanes(sum[3] + at) + own_weight;
    for (int c = 0; c < 3; c++)
        out[c] =
            (load_lanes(sum[c] + at) + own_weight * load_lanes(own[c] + at)) / weight;
}

/* ---- Which bandwidth ---- */

/* Squared error of what a bandwidth says, up to what is the same for all: each half's
   against the other's, which it does not know. */
static lane_floats cross_error(const blend_loop *loop, int band, size_t at)
{
    lane_floats rgb[3], y[N_HALVES], sum = fill_lanes(0.0f);
    for (int h = 0; h < N_HALVES; h++) {
        said(loop, band, h, at, LEAST_WEIGHT, rgb);
        y[h] = luminance_lanes(rgb[0], rgb[1], rgb[2]);
        lane_floats other = brightness(loop->b->done->color[1 - h], at);
        sum += 0.5f * (y[h] - other) * (y[h] - other);
    }
    return sum - 0.25f * (y[0] - y[1]) * (y[0] - y[1]);
}

static void error_row(int y, void *data)
{
    const blend_loop *loop = data;
    for (int x = 0; x < loop->g->width; x += LANES) {
        size_t at = plane_at(loop->g, x, y);
        for (int k = 0; k < N_BANDS; k++)
            store_lanes(loop->errors[k] + at, cross_error(loop, k, at));
    }
}

/* 1 where the narrower errs less. */
static void narrow_row(int y, void *data)
{
    const blend_loop *loop = data;
    for (int x = 0; x < loop->g->width; x++) {
        size_t at = plane_at(loop->g, x, y);
        loop->errors[0][at] = loop->around[1][at] < loop->around[0][at] ? 1.0f : 0.0f;
    }
}

/* Of the mean of both halves, as if there were a window around every second pixel. */
static lane_floats words_of(const blend_loop *loop, size_t at, lane_floats narrow)
{
    float *const(*sum)[N_HALVES][N_SUMS] = loop->b->done->sum;
    float step = (float)loop->b->done->step, windows = step * step / 4.0f;
    lane_floats w[N_BANDS];
    for (int k = 0; k < N_BANDS; k++)
        w[k] = joined(loop, load_lanes(sum[k][0][3] + at), load_lanes(sum[k][1][3] + at));
    return windows * ((1.0f - narrow) * w[0] + narrow * w[1]);
}

/* Halves of both bandwidths. */
static void filter_row(int y, void *data)
{
    const blend_loop *loop = data;
    for (int x = 0; x < loop->g->width; x += LANES) {
        size_t at = plane_at(loop->g, x, y);
        lane_floats share = load_lanes(loop->around[0] + at) / PATCH_PIXELS;
        lane_floats wide[3], narrow[3];
        store_lanes(loop->words + at, words_of(loop, at, share));
        for (int h = 0; h < N_HALVES; h++) {
            said(loop, 0, h, at, OWN_WEIGHT, wide);
            said(loop, 1, h, at, OWN_WEIGHT, narrow);
            for (int c = 0; c < 3; c++)
                store_lanes(loop->filtered[h][c] + at,
                            (1.0f - share) * wide[c] + share * narrow[c]);
        }
    }
}

static void box_all(const grid *g, float *const *from, int n, int radius,
                    float *const *to)
{
    plane_mirror(g, from, n);
    plane_box(g, (const float *const *)from, n, radius, to);
}

static bool choose_bandwidth(const blend_loop *loop)
{
    const grid *g = loop->g;
    if (!plane_rows(g, error_row, (void *)loop))
        return false;
    box_all(g, loop->errors, N_BANDS, PATCH, loop->around);
    if (!plane_rows(g, narrow_row, (void *)loop))
        return false;
    box_all(g, loop->errors, 1, PATCH, loop->around);
    return plane_rows(g, filter_row, (void *)loop);
}

/* ---- How much of it ---- */

/* Luminance: each half less the filtered picture, and how far its halves are apart. */
static void residual_row(int y, void *data)
{
    const blend_loop *loop = data;
    for (int x = 0; x < loop->g->width; x += LANES) {
        size_t at = plane_at(loop->g, x, y);
        lane_floats a = brightness((const float *const *)loop->filtered[0], at);
        lane_floats b = brightness((const float *const *)loop->filtered[1], at);
        lane_floats is = joined(loop, a, b);
        for (int h = 0; h < N_HALVES; h++)
            store_lanes(loop->residual[h] + at, brightness(loop->b->raw[h], at) - is);
        store_lanes(loop->residual[2] + at, a - b);
    }
}

/* What a squared error at a pixel counts among those of a patch: relative to what light
   is there, or in the picture, or to its noise. Absolute, the noise of a bright spot kept
   what the filter smears from coming off the dark beside it [/denoise/beside-bright]: of
   a burning glass and of veach-mis, 4 passes, the relative squared error was ten times
   this one. Relative to the light there alone, specks came back to a dark floor (coffee:
   1.1 of the error as FLIP has it). */
static lane_floats error_weight(const blend_loop *loop, size_t at, lane_floats noise)
{
    lane_floats here =
        joined(loop, brightness((const float *const *)loop->filtered[0], at),
               brightness((const float *const *)loop->filtered[1], at));
    lane_floats mean = loop->b->brightness / mean_divisor(loop->b->albedo, at);
    return 1.0f / max_lanes(here * here + mean * mean + noise, fill_lanes(FLT_MIN));
}

/* 1 where no window knows a pixel, 0 where enough do. */
static lane_floats few_words(const blend_loop *loop, size_t at)
{
    lane_floats few = 1.0f - load_lanes(loop->words + at) / FEW_WORDS;
    few = max_lanes(few, fill_lanes(0.0f));
    return few * few;
}

static float square_pixels(int radius)
{
    return (float)((2 * radius + 1) * (2 * radius + 1));
}

/* Those of a square that have noise of their own. */
static float distinct_pixels(const blend_loop *loop)
{
    return maxf(loop->b->distinct * square_pixels(loop->round.radius), 1.0f);
}

/*
 * Of a truth u, picture u + n and filtered picture u + e, the best mean has
 *
 *   (E[e²] - E[n e]) / (E[e²] - 2 E[n e] + E[n²])
 *
 * of the picture. As the halves share no noise, E[e²] - 2 E[n e] is what they agree that
 * the filter lost, and E[n e] is how far it follows their difference. Into the products:
 * the numerator, E[n e], the variance of what the numerator is taken from, and E[n²] as
 * it is given and by how far the halves are apart; each pixel's by its weight.
 */
static void product_row(int y, void *data)
{
    const blend_loop *loop = data;
    float share = loop->b->share, both = share * (1.0f - share);
    float n = square_pixels(loop->round.radius), distinct = distinct_pixels(loop);
    for (int x = 0; x < loop->g->width; x += LANES) {
        size_t at = plane_at(loop->g, x, y);
        lane_floats a = load_lanes(loop->mean[0] + at) / n;
        lane_floats b = load_lanes(loop->mean[1] + at) / n;
        lane_floats follows = both * (a - b) * load_lanes(loop->mean[2] + at) / n;
        lane_floats lost2 = a * b + follows, lost = max_lanes(lost2, fill_lanes(0.0f));
        lane_floats noise = load_lanes(loop->noise + at) / (n * distinct);
        lane_floats noise_a = noise / share, noise_b = noise / (1.0f - share);
        lane_floats weight = error_weight(loop, at, lost + noise);
        weight *= loop->round.of_few ? few_words(loop, at) : fill_lanes(1.0f);
        lane_floats error2 = noise_a * noise_b + lost * (noise_a + noise_b);
        store_lanes(loop->product[LOST2] + at, weight * lost2);
        store_lanes(loop->product[ERROR2] + at, weight * weight * error2);
        store_lanes(loop->product[FOLLOWS] + at, weight * follows);
        store_lanes(loop->product[GIVEN] + at, weight * noise);
        store_lanes(loop->product[APART] + at, weight * both * (a - b) * (a - b));
    }
}

/* Share of the picture as it was in the best mean of it and the filtered one. Noise is
   more than given where pixels share it, as those do that see the same photons. Means
   over squares share their pixels with as many others, so that a sum of their products
   scatters more than one of as many that share none, and so does one of pixels that have
   the numbers of others. A pixel that has more noise of its own than its patch (a path
   that hardly anyone finds) gets no more than that allows, and less the more of its
   squared error is noise. */
static float share_of_raw(const blend_loop *loop, size_t at)
{
    float own = loop->product[GIVEN][at];
    float noise =
        maxf(maxf(loop->sum[APART][at], loop->sum[GIVEN][at]), PATCH_PIXELS * own);
    float sure = loop->round.radius > 0 ? SURE_MEANS : SURE_PIXELS;
    float times = square_pixels(loop->round.radius) / loop->b->distinct;
    float error = sqrtf(loop->sum[ERROR2][at] * times);
    float lost2 = (1.0f - own) * (loop->sum[LOST2][at] - sure * error);
    float whole = noise - loop->sum[FOLLOWS][at];
    return lost2 > 0.0f ? lost2 / (lost2 + maxf(whole, 0.0f)) : 0.0f;
}

static void share_row(int y, void *data)
{
    const blend_loop *loop = data;
    for (int x = 0; x < loop->g->width; x++) {
        size_t at = plane_at(loop->g, x, y);
        loop->errors[0][at] = share_of_raw(loop, at);
    }
}

/* Of all pixels, those that have both halves of their own. By lent ones own_row makes
   1.02 of the error, in sixteen scenes. */
static float share_with_both(const blend *b)
{
    return maxf(2.0f * b->distinct - 1.0f, 0.0f);
}

/* Beside a small bright spot hardly any patch is like another, and what little light
   windows say there is more than all that is: the dark around it takes on its light. So
   there a pixel's own colour speaks too, as far as those around of which windows know as
   little agree that more than noise was lost; among all of a patch they would be few. */
static void own_row(int y, void *data)
{
    const blend_loop *loop = data;
    const lane_floats none = fill_lanes(0.0f), least = fill_lanes(FLT_MIN);
    float most = FEW_WORDS * share_with_both(loop->b);
    for (int x = 0; x < loop->g->width; x += LANES) {
        size_t at = plane_at(loop->g, x, y);
        lane_floats lost = max_lanes(load_lanes(loop->sum[LOST2] + at), none);
        lane_floats noise = load_lanes(loop->sum[APART] + at);
        lane_floats weight = most * few_words(loop, at);
        weight *= lost / max_lanes(lost + noise, least);
        lane_floats all = load_lanes(loop->words + at) + weight;
        store_lanes(loop->errors[0] + at, weight / max_lanes(all, least));
    }
}

/* What a half lost of a colour. */
typedef struct return_loop {
    const blend_loop *loop;
    int half, color;
} return_loop;

static void lost_row(int y, void *data)
{
    const return_loop *all = data;
    const blend_loop *loop = all->loop;
    const float *const *color = loop->b->done->color[all->half];
    const float *raw = (loop->round.of_few ? color : loop->b->raw[all->half])[all->color];
    const float *filtered = loop->filtered[all->half][all->color];
    for (int x = 0; x < loop->g->width; x++) {
        size_t at = plane_at(loop->g, x, y);
        loop->errors[1][at] = raw[at] - filtered[at];
    }
}

static void return_row(int y, void *data)
{
    const return_loop *all = data;
    const blend_loop *loop = all->loop;
    float *filtered = loop->filtered[all->half][all->color];
    float n = square_pixels(loop->round.radius);
    for (int x = 0; x < loop->g->width; x++) {
        size_t at = plane_at(loop->g, x, y);
        filtered[at] += loop->errors[0][at] * loop->around[1][at] / n;
    }
}

static bool give_back(const blend_loop *loop)
{
    bool ok = true;
    for (int k = 0; k < N_HALVES * 3 && ok; k++) {
        return_loop all = {loop, k / 3, k % 3};
        ok = plane_rows(loop->g, lost_row, &all);
        box_all(loop->g, loop->errors + 1, 1, loop->round.radius, loop->around + 1);
        ok = ok && plane_rows(loop->g, return_row, &all);
    }
    return ok;
}

static bool shrink(const blend_loop *loop)
{
    const grid *g = loop->g;
    int n_products = loop->round.of_few ? N_OF_FEW : N_PRODUCTS;
    row_body find_share = loop->round.of_few ? own_row : share_row;
    if (!plane_rows(g, residual_row, (void *)loop))
        return false;
    box_all(g, loop->residual, N_MEANS, loop->round.radius, loop->mean);
    plane_box(g, &loop->b->variance, 1, loop->round.radius, &loop->noise);
    if (!plane_rows(g, product_row, (void *)loop))
        return false;
    box_all(g, loop->product, n_products, PATCH, loop->sum);
    return plane_rows(g, find_share, (void *)loop) && give_back(loop);
}

/* The darkest of the picture around a pixel. */
static lane_floats darkest_around(const blend_loop *loop, int c, size_t at)
{
    lane_floats darkest = fill_lanes(INFINITY);
    for (size_t y = 0; y < 3; y++)
        for (size_t x = 0; x < 3; x++) {
            size_t i = at + (y * loop->g->stride + x) - (loop->g->stride + 1);
            darkest = min_lanes(joined(loop, load_lanes(loop->b->raw[0][c] + i),
                                       load_lanes(loop->b->raw[1][c] + i)),
                                darkest);
        }
    return darkest;
}

/* Lines through the edge of a light swing below what is beside it: nothing is darker than
   all around it was. */
static void join_row(int y, void *data)
{
    const blend_loop *loop = data;
    for (int x = 0; x < loop->g->width; x += LANES) {
        size_t at = plane_at(loop->g, x, y);
        for (int c = 0; c < 3; c++) {
            lane_floats is = joined(loop, load_lanes(loop->filtered[0][c] + at),
                                    load_lanes(loop->filtered[1][c] + at));
            store_lanes(loop->b->out[c] + at, max_lanes(is, darkest_around(loop, c, at)));
        }
    }
}

/* Sums of the regression are planes for what comes after it. */
static void reuse_sums(blend_loop *loop)
{
    float *const(*sum)[N_HALVES][N_SUMS] = loop->b->done->sum;
    for (int h = 0; h < N_HALVES; h++)
        memcpy(loop->filtered[h], sum[0][h], sizeof loop->filtered[h]);
    for (int k = 0; k < N_MEANS; k++) {
        loop->product[k] = loop->residual[k] = sum[1][0][k];
        loop->sum[k] = loop->mean[k] = sum[1][1][k];
    }
    loop->product[GIVEN] = sum[1][0][N_MEANS];
    loop->sum[GIVEN] = loop->noise = sum[1][1][N_MEANS];
    loop->product[ERROR2] = sum[0][0][N_MEANS];
    loop->sum[ERROR2] = sum[0][1][N_MEANS];
}

static bool blend_rows(blend_loop *loop)
{
    bool ok = choose_bandwidth(loop), has_both = share_with_both(loop->b) > 0.0f;
    for (size_t k = 0; k < sizeof rounds / sizeof *rounds && ok; k++) {
        loop->round = rounds[k];
        ok = (loop->round.of_few && !has_both) || shrink(loop);
    }
    return ok && plane_rows(loop->g, join_row, loop);
}

bool blend_all(const blend *b, GError **error)
{
    float *own[N_OWN] = {0};
    bool ok = true;
    for (int k = 0; k < N_OWN && ok; k++)
        ok = (own[k] = plane_new(&b->done->g, error)) != NULL;
    blend_loop loop = {.b = b,
                       .g = &b->done->g,
                       .errors = {own[0], own[1]},
                       .around = {own[2], own[3]},
                       .words = own[2]};
    reuse_sums(&loop);
    if (ok && !(ok = blend_rows(&loop)))
        error_set(error, ERROR_CANCELLED, "cancelled");
    for (int k = 0; k < N_OWN; k++)
        plane_free(&b->done->g, own[k]);
    return ok;
}
