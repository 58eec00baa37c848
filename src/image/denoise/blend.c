#include "image/denoise/blend.h"

#include "base/memory.h"
#include "math/vec.h"

#include <math.h>

/* What the filter lost is put back as far as it is surely more than noise: so many of its
   standard errors are taken off its mean over a patch. */
#define SURE 1.0f

enum { N_PLANES = 3 };

typedef struct blend_loop {
    const blend *b;
    const grid *g;
    float *errors[N_PLANES]; /* of the bandwidths; then see lost_row */
    float *around[N_PLANES]; /* those summed over patches */
    float *noise;            /* variance, summed over patches */
} blend_loop;

/* What a regression says of a pixel's half; as it was where none said anything. */
static void said(const blend_loop *loop, int band, int half, size_t at, float out[3])
{
    float *const *sum = loop->b->done->sum[band][half];
    float weight = sum[3][at];
    for (int c = 0; c < 3; c++)
        out[c] = weight > 0.0f ? sum[c][at] / weight : loop->b->raw[half][c][at];
}

static float brightness(const float *const planes[3], size_t at)
{
    return luminance(planes[0][at], planes[1][at], planes[2][at]);
}

/* ---- Which bandwidth ---- */

/* Squared error of what a bandwidth says, up to what is the same for all: each half's
   against the other's, which it does not know. */
static float cross_error(const blend_loop *loop, int band, size_t at)
{
    float rgb[3], y[N_HALVES], sum = 0.0f;
    for (int h = 0; h < N_HALVES; h++) {
        said(loop, band, h, at, rgb);
        y[h] = luminance(rgb[0], rgb[1], rgb[2]);
        float other = brightness(loop->b->done->color[1 - h], at);
        sum += 0.5f * (y[h] - other) * (y[h] - other);
    }
    return sum - 0.25f * (y[0] - y[1]) * (y[0] - y[1]);
}

static void error_row(int y, void *data)
{
    const blend_loop *loop = data;
    for (int x = 0; x < loop->g->width; x++) {
        size_t at = plane_at(loop->g, x, y);
        for (int k = 0; k < N_BANDS; k++)
            loop->errors[k][at] = cross_error(loop, k, at);
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

/* ---- How much of it ---- */

/* A filtered half, of both bandwidths. */
static void filtered(const blend_loop *loop, int half, size_t at, float out[3])
{
    float narrow = loop->around[0][at] / PATCH_PIXELS, wide[3];
    said(loop, 0, half, at, wide);
    said(loop, 1, half, at, out);
    for (int c = 0; c < 3; c++)
        out[c] = (1.0f - narrow) * wide[c] + narrow * out[c];
}

static void raw(const blend_loop *loop, size_t at, float out[3])
{
    float share = loop->b->share;
    for (int c = 0; c < 3; c++)
        out[c] = share * loop->b->raw[0][c][at] + (1.0f - share) * loop->b->raw[1][c][at];
}

/*
 * Of a pixel's truth u, picture u + n and filtered picture u + e, the best mean has
 *
 *   (E[e²] - E[n e]) / (E[e²] - 2 E[n e] + E[n²])
 *
 * of the picture. As the halves share no noise, E[e²] - 2 E[n e] is what they agree that
 * the filter lost, and E[n e] is how far it follows their difference. Into the planes:
 * the numerator, and the variance of what it is taken from.
 */
static void lost_row(int y, void *data)
{
    const blend_loop *loop = data;
    float share = loop->b->share;
    for (int x = 0; x < loop->g->width; x++) {
        size_t at = plane_at(loop->g, x, y);
        float a[3], b[3], noise = loop->b->variance[at];
        filtered(loop, 0, at, a);
        filtered(loop, 1, at, b);
        for (int c = 0; c < 3; c++)
            loop->b->out[c][at] = share * a[c] + (1.0f - share) * b[c];
        float is = brightness((const float *const *)loop->b->out, at);
        float was_a = brightness(loop->b->raw[0], at);
        float was_b = brightness(loop->b->raw[1], at);
        float apart = luminance(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
        float lost2 = (was_a - is) * (was_b - is) +
                      share * (1.0f - share) * (was_a - was_b) * apart;
        float noise_a = noise / share, noise_b = noise / (1.0f - share);
        loop->errors[0][at] = lost2;
        loop->errors[1][at] = noise_a * noise_b + maxf(lost2, 0.0f) * (noise_a + noise_b);
        loop->errors[2][at] = share * (1.0f - share) * (was_a - was_b) * apart;
    }
}

/* Share of the picture as it was in the best mean of it and the filtered one. */
static float share_of_raw(const blend_loop *loop, size_t at)
{
    float lost2 = loop->around[0][at] - SURE * sqrtf(loop->around[1][at]);
    float whole = loop->noise[at] - loop->around[2][at];
    return lost2 > 0.0f ? lost2 / (lost2 + maxf(whole, 0.0f)) : 0.0f;
}

static void shrink_row(int y, void *data)
{
    const blend_loop *loop = data;
    for (int x = 0; x < loop->g->width; x++) {
        size_t at = plane_at(loop->g, x, y);
        float was[3], back = share_of_raw(loop, at);
        raw(loop, at, was);
        for (int c = 0; c < 3; c++) {
            float *out = &loop->b->out[c][at];
            *out += back * (was[c] - *out);
        }
    }
}

static bool blend_rows(const blend_loop *loop)
{
    const grid *g = loop->g;
    if (!plane_rows(g, error_row, (void *)loop))
        return false;
    for (int k = 0; k < N_BANDS; k++) {
        plane_mirror(g, loop->errors[k]);
        plane_box(g, loop->errors[k], PATCH, loop->around[k]);
    }
    if (!plane_rows(g, narrow_row, (void *)loop))
        return false;
    plane_mirror(g, loop->errors[0]);
    plane_box(g, loop->errors[0], PATCH, loop->around[0]);
    if (!plane_rows(g, lost_row, (void *)loop))
        return false;
    for (int k = 0; k < N_PLANES; k++) {
        plane_mirror(g, loop->errors[k]);
        plane_box(g, loop->errors[k], PATCH, loop->around[k]);
    }
    plane_box(g, loop->b->variance, PATCH, loop->noise);
    return plane_rows(g, shrink_row, (void *)loop);
}

bool blend_all(const blend *b, GError **error)
{
    blend_loop loop = {.b = b, .g = &b->done->g};
    bool ok = (loop.noise = plane_new(loop.g, error)) != NULL;
    for (int k = 0; k < N_PLANES && ok; k++) {
        loop.errors[k] = plane_new(loop.g, error);
        loop.around[k] = loop.errors[k] ? plane_new(loop.g, error) : NULL;
        ok = loop.around[k] != NULL;
    }
    if (ok && !(ok = blend_rows(&loop)))
        error_set(error, ERROR_CANCELLED, "cancelled");
    big_free(loop.noise);
    for (int k = 0; k < N_PLANES; k++) {
        big_free(loop.errors[k]);
        big_free(loop.around[k]);
    }
    return ok;
}
