#include "image/compare.h"

#include "base/memory.h"
#include "image/flip.h"

#include <math.h>
#include <string.h>

/* Both images as doubles, three numbers a pixel, and which pixels count. */
typedef struct pair {
    int width, height;
    size_t n;
    double *a, *b;
    bool *finite;
    size_t n_finite;
} pair;

static bool comparable(const image *a, const image *b, GError **error)
{
    if (a->width != b->width || a->height != b->height) {
        error_set(error, ERROR_INPUT,
                  "images of %d x %d and %d x %d pixels cannot be compared", a->width,
                  a->height, b->width, b->height);
        return false;
    }
    int rgba[4];
    bool a_has = image_colors(a, rgba), b_has = image_colors(b, rgba);
    if (!a_has || !b_has)
        error_set(error, ERROR_INPUT,
                  "the %s image has no channels 'R', 'G', 'B' or 'Y' to compare",
                  a_has ? "second" : "first");
    return a_has && b_has;
}

static void load(const image *img, size_t n, double *out)
{
    int rgba[4];
    image_colors(img, rgba);
    for (int c = 0; c < 3; c++) {
        const float *from = img->pixels + rgba[c];
        for (size_t i = 0; i < n; i++)
            out[3 * i + (size_t)c] = (double)from[i * (size_t)img->n_channels];
    }
}

static bool all_finite(const double v[3])
{
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

/* Pixels that are not finite in either image become black in both: the filters of FLIP
 * reach them from their neighbours. */
static void sort_out(pair *p)
{
    for (size_t i = 0; i < p->n; i++) {
        double *a = p->a + 3 * i, *b = p->b + 3 * i;
        p->finite[i] = all_finite(a) && all_finite(b);
        p->n_finite += p->finite[i];
        for (int c = 0; c < 3 && !p->finite[i]; c++)
            a[c] = b[c] = 0.0;
    }
}

static bool pair_init(pair *p, const image *a, const image *b, GError **error)
{
    *p = (pair){.width = a->width, .height = a->height};
    p->n = (size_t)a->width * (size_t)a->height;
    p->a = big_alloc(p->n, 3 * sizeof(double), "image comparison", error);
    p->b = p->a ? big_alloc(p->n, 3 * sizeof(double), "image comparison", error) : NULL;
    p->finite = p->b ? big_alloc(p->n, sizeof(bool), "image comparison", error) : NULL;
    if (!p->finite)
        return false;
    load(a, p->n, p->a);
    load(b, p->n, p->b);
    sort_out(p);
    return true;
}

static void pair_clear(pair *p)
{
    big_free(p->a);
    big_free(p->b);
    big_free(p->finite);
}

static double luminance(const double rgb[3])
{
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

static double displayed(double linear)
{
    return (double)srgb_encode((float)fmin(fmax(linear, 0.0), 1.0));
}

/* Everything but FLIP; the sums run over pixels that are finite, which exist. */
static void measure(const pair *p, image_difference *out)
{
    const double floor = 0.01;
    double squares = 0, relative = 0, shown = 0;
    for (size_t i = 0; i < 3 * p->n; i++) {
        if (!p->finite[i / 3])
            continue;
        double a = p->a[i], b = p->b[i], d = a - b, s = displayed(a) - displayed(b);
        squares += d * d;
        relative += d * d / (b * b + floor);
        shown += s * s;
    }
    for (size_t i = 0; i < p->n; i++) {
        out->mean_a += luminance(p->a + 3 * i);
        out->mean_b += luminance(p->b + 3 * i);
    }
    double n = (double)p->n_finite;
    out->mean_a /= n;
    out->mean_b /= n;
    out->rmse = sqrt(squares / (3.0 * n));
    out->relmse = relative / (3.0 * n);
    out->psnr = shown > 0.0 ? 10.0 * log10(3.0 * n / shown) : (double)INFINITY;
}

static bool measure_flip(const pair *p, image_difference *out, GError **error)
{
    double *map = big_alloc(p->n, sizeof(double), "image comparison", error);
    for (size_t i = 0; map && i < 3 * p->n; i++) {
        p->a[i] = fmin(fmax(p->a[i], 0.0), 1.0);
        p->b[i] = fmin(fmax(p->b[i], 0.0), 1.0);
    }
    bool done = map && flip_error(p->a, p->b, p->width, p->height, map, error);
    for (size_t i = 0; done && i < p->n; i++)
        out->flip += p->finite[i] ? map[i] : 0.0;
    out->flip /= (double)p->n_finite;
    big_free(map);
    return done;
}

bool image_compare(const image *a, const image *b, image_difference *out, GError **error)
{
    *out = (image_difference){0};
    if (!comparable(a, b, error))
        return false;
    pair p;
    bool done = pair_init(&p, a, b, error);
    if (done && p.n_finite == 0) {
        error_set(error, ERROR_INPUT, "no pixel is finite in both images");
        done = false;
    }
    if (done) {
        out->n_not_finite = p.n - p.n_finite;
        measure(&p, out);
        done = measure_flip(&p, out, error);
    }
    pair_clear(&p);
    return done;
}

/* ---- As a picture ---- */

/* Of the luminance: this much off is the end of the scale; below this share of its mean
   the scale shrinks no more. */
#define SCALE 0.5
#define DARK 0.1

/* Linear, for the eye: 0 is black, then a hue, then white. */
static void signed_colour(double off, float rgb[3])
{
    double size = fmin(fabs(off), 1.0), pale = fmax(2.0 * size - 1.0, 0.0);
    double full = fmin(2.0 * size, 1.0);
    rgb[0] = (float)(off > 0.0 ? full : pale);
    rgb[1] = (float)(0.25 * full * full + 0.75 * pale);
    rgb[2] = (float)(off > 0.0 ? pale : full);
}

static void fill_map(const pair *p, image *out)
{
    static const float bad[3] = {0.0f, 1.0f, 0.0f};
    double mean = 0.0;
    for (size_t i = 0; i < p->n; i++)
        mean += luminance(p->b + 3 * i) / (double)MAX(p->n_finite, 1);
    for (size_t i = 0; i < p->n; i++) {
        double a = luminance(p->a + 3 * i), b = luminance(p->b + 3 * i);
        double whole = SCALE * fmax(b, DARK * mean);
        if (!p->finite[i])
            memcpy(out->pixels + 3 * i, bad, sizeof bad);
        else if (whole > 0.0)
            signed_colour((a - b) / whole, out->pixels + 3 * i);
        else
            signed_colour(a > b ? 1.0 : 0.0, out->pixels + 3 * i);
    }
}

image *image_difference_map(const image *a, const image *b, GError **error)
{
    pair p = {0};
    image *out = NULL;
    if (comparable(a, b, error) && pair_init(&p, a, b, error))
        out = image_new(a->width, a->height, 3, image_rgb_names, error);
    if (out)
        fill_map(&p, out);
    pair_clear(&p);
    return out;
}
