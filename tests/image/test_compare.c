/*
 * compare: errors that can be worked out by hand, and FLIP against a naive twin that
 * filters with whole two-dimensional kernels, as the paper writes them. Images made of
 * images: against counting.
 */
#include "image/arrange.h"
#include "image/compare.h"
#include "image/flip.h"

#include <math.h>
#include <string.h>

static const char *const names[] = {"R", "G", "B"};

static image *uniform(int width, int height, float r, float g, float b)
{
    image *img = image_new(width, height, 3, names, NULL);
    for (int i = 0; i < width * height; i++) {
        img->pixels[3 * i] = r;
        img->pixels[3 * i + 1] = g;
        img->pixels[3 * i + 2] = b;
    }
    return img;
}

static image *noise(int width, int height, guint32 seed)
{
    g_autoptr(GRand) random = g_rand_new_with_seed(seed);
    image *img = image_new(width, height, 3, names, NULL);
    for (int i = 0; i < width * height * 3; i++)
        img->pixels[i] = (float)g_rand_double(random);
    return img;
}

static image_difference compare(const image *a, const image *b)
{
    image_difference d;
    GError *error = NULL;
    g_assert_true(image_compare(a, b, &d, &error));
    g_assert_no_error(error);
    return d;
}

static double flip_of_colors(const float a[3], const float b[3])
{
    g_autoptr(image) x = uniform(24, 24, a[0], a[1], a[2]);
    g_autoptr(image) y = uniform(24, 24, b[0], b[1], b[2]);
    return compare(x, y).flip;
}

static void test_identical(void)
{
    g_autoptr(image) a = noise(19, 13, 1);
    image_difference d = compare(a, a);
    g_assert_cmpfloat(d.rmse, ==, 0);
    g_assert_cmpfloat(d.relmse, ==, 0);
    g_assert_cmpfloat(d.flip, ==, 0);
    g_assert_true(isinf(d.psnr));
    g_assert_cmpfloat(d.mean_a, ==, d.mean_b);
    g_assert_cmpuint(d.n_not_finite, ==, 0);
}

static void test_by_hand(void)
{
    g_autoptr(image) a = uniform(8, 4, 0.5f, 0.5f, 0.5f);
    g_autoptr(image) b = uniform(8, 4, 0.25f, 0.5f, 0.5f);
    image_difference d = compare(a, b);
    g_assert_cmpfloat_with_epsilon(d.rmse, sqrt(0.0625 / 3), 1e-9);
    g_assert_cmpfloat_with_epsilon(d.relmse, 0.0625 / (0.0625 + 0.01) / 3, 1e-9);
    double step = (double)(srgb_encode(0.5f) - srgb_encode(0.25f));
    g_assert_cmpfloat_with_epsilon(d.psnr, -10 * log10(step * step / 3), 1e-6);
    g_assert_cmpfloat_with_epsilon(d.mean_a, 0.5, 1e-6);
    g_assert_cmpfloat_with_epsilon(d.mean_b, 0.5 - 0.2126 * 0.25, 1e-6);
}

static void test_not_finite_is_left_out(void)
{
    g_autoptr(image) a = uniform(8, 8, 1, 1, 1), b = uniform(8, 8, 1, 1, 1);
    a->pixels[3 * 20 + 1] = NAN;
    b->pixels[3 * 30] = INFINITY;
    b->pixels[0] = 0.5f;
    image_difference d = compare(a, b);
    g_assert_cmpuint(d.n_not_finite, ==, 2);
    g_assert_cmpfloat_with_epsilon(d.rmse, sqrt(0.25 / (3 * 62)), 1e-9);
    g_assert_cmpfloat_with_epsilon(d.mean_a, 1, 1e-9);
    g_assert_true(isfinite(d.flip));
}

static void test_refuses(void)
{
    const char *const colourless[] = {"U", "V"};
    image_difference d;
    GError *error = NULL;
    g_autoptr(image) a = uniform(8, 8, 1, 1, 1), b = uniform(8, 9, 1, 1, 1);
    g_autoptr(image) c = image_new(8, 8, 2, colourless, NULL);
    g_assert_false(image_compare(a, b, &d, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_nonnull(strstr(error->message, "8 x 8 and 8 x 9"));
    g_clear_error(&error);
    g_assert_false(image_compare(a, c, &d, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_nonnull(strstr(error->message, "second image has no channels 'R'"));
    g_clear_error(&error);
    for (int i = 0; i < 8 * 8 * 3; i++)
        a->pixels[i] = NAN;
    g_assert_false(image_compare(a, a, &d, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_clear_error(&error);
}

/* ---- FLIP ---- */

/* Uniform images have no features, so FLIP is the spread HyAB distance alone. For greys
 * that is |L* - L*'|^0.7, and the largest distance is green to blue. */
static void test_flip_of_greys(void)
{
    /* L, a, b of sRGB green and blue (CIE 15, D65): 87.735, -86.183, 83.180 and
     * 32.299, 79.191, -107.865; FLIP scales a and b by L / 100. */
    double a = 0.87735 * -86.183 - 0.32299 * 79.191;
    double b = 0.87735 * 83.180 + 0.32299 * 107.865;
    double largest = pow(87.735 - 32.299 + hypot(a, b), 0.7);
    const float black[3] = {0, 0, 0}, white[3] = {1, 1, 1};
    double knee = 0.4 * largest;
    double far = 0.95 + 0.05 * (pow(100, 0.7) - knee) / (largest - knee);
    g_assert_cmpfloat_with_epsilon(flip_of_colors(black, white), far, 1e-4);
    g_assert_cmpfloat(far, >, 0.96);
    /* L* = 50 is Y = 0.184187. */
    const float grey[3] = {0.184187f, 0.184187f, 0.184187f};
    double near = pow(50, 0.7) * 0.95 / knee;
    g_assert_cmpfloat_with_epsilon(flip_of_colors(black, grey), near, 1e-4);
}

static void test_flip_reaches_one(void)
{
    const float green[3] = {0, 1, 0}, blue[3] = {0, 0, 1};
    g_assert_cmpfloat_with_epsilon(flip_of_colors(green, blue), 1, 1e-6);
}

static void test_flip_is_symmetric_and_grows(void)
{
    g_autoptr(image) a = noise(21, 17, 2), b = noise(21, 17, 3);
    g_assert_cmpfloat_with_epsilon(compare(a, b).flip, compare(b, a).flip, 1e-12);
    double last = 0;
    for (int step = 1; step <= 5; step++) {
        g_autoptr(image) mixed = image_new(21, 17, 3, names, NULL);
        float t = 0.2f * (float)step;
        for (int i = 0; i < 21 * 17 * 3; i++)
            mixed->pixels[i] = (1 - t) * a->pixels[i] + t * b->pixels[i];
        double flip = compare(mixed, a).flip;
        g_assert_cmpfloat(flip, >, last);
        last = flip;
    }
    g_assert_cmpfloat(last, <=, 1);
}

/* ---- the naive twin ---- */

typedef struct plane {
    int width, height;
    double *v;
} plane;

typedef double (*kernel2)(double x, double y, int which);

static double at(const plane *p, int x, int y)
{
    return p->v[CLAMP(y, 0, p->height - 1) * p->width + CLAMP(x, 0, p->width - 1)];
}

/* Kernel over a square of pixels; positive and negative weights each sum to one. */
static double filter_at(const plane *p, int x, int y, int radius, kernel2 k, int which)
{
    double sums[2] = {0, 0}, weights[2] = {0, 0};
    for (int j = -radius; j <= radius; j++)
        for (int i = -radius; i <= radius; i++) {
            double w = k(i, j, which);
            weights[w < 0] += fabs(w);
            sums[w < 0] += w * at(p, x + i, y + j);
        }
    return sums[0] / weights[0] + (weights[1] > 0 ? sums[1] / weights[1] : 0);
}

static double eye(double x, double y, int plane_index)
{
    const double a1[] = {1, 1, 34.1}, b1[] = {0.0047, 0.0053, 0.04};
    double d2 = (x * x + y * y) / (67.0 * 67.0), pi2 = G_PI * G_PI;
    double b = b1[plane_index];
    double g = a1[plane_index] * sqrt(G_PI / b) * exp(-pi2 * d2 / b);
    if (plane_index == 2)
        g += 13.5 * sqrt(G_PI / 0.025) * exp(-pi2 * d2 / 0.025);
    return g;
}

static double feature(double x, double y, int which)
{
    double sigma = 0.5 * 0.082 * 67.0, g = exp(-(x * x + y * y) / (2 * sigma * sigma));
    double along = which & 1 ? y : x;
    return which & 2 ? (along * along / (sigma * sigma) - 1) * g : -along * g;
}

static double determinant(const double a[3], const double b[3], const double c[3])
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) +
           c[0] * (a[1] * b[2] - a[2] * b[1]);
}

/* Shares of a, b and c in v, by Cramer's rule. */
static void solve(double columns[3][3], const double v[3], double out[3])
{
    double *a = columns[0], *b = columns[1], *c = columns[2], d = determinant(a, b, c);
    out[0] = determinant(v, b, c) / d;
    out[1] = determinant(a, v, c) / d;
    out[2] = determinant(a, b, v) / d;
}

static void xyz_of_xy(double x, double y, double out[3])
{
    out[0] = x / y;
    out[1] = 1;
    out[2] = (1 - x - y) / y;
}

/* XYZ of sRGB's primaries, scaled so that they add up to D65 (IEC 61966-2-1). */
static void primaries(double columns[3][3], double white[3])
{
    const double xy[3][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};
    double scale[3];
    xyz_of_xy(0.3127, 0.3290, white);
    for (int c = 0; c < 3; c++)
        xyz_of_xy(xy[c][0], xy[c][1], columns[c]);
    solve(columns, white, scale);
    for (int i = 0; i < 9; i++)
        columns[i / 3][i % 3] *= scale[i / 3];
}

/* Relative to white. */
static void to_xyz(const double rgb[3], double out[3])
{
    double p[3][3], white[3];
    primaries(p, white);
    for (int i = 0; i < 3; i++)
        out[i] = (rgb[0] * p[0][i] + rgb[1] * p[1][i] + rgb[2] * p[2][i]) / white[i];
}

static void to_rgb(const double xyz[3], double out[3])
{
    double p[3][3], white[3], absolute[3];
    primaries(p, white);
    for (int i = 0; i < 3; i++)
        absolute[i] = xyz[i] * white[i];
    solve(p, absolute, out);
    for (int i = 0; i < 3; i++)
        out[i] = CLAMP(out[i], 0.0, 1.0);
}

static double cube_root_curve(double t)
{
    return t > 216.0 / 24389.0 ? cbrt(t) : (24389.0 / 27.0 * t + 16) / 116;
}

typedef struct analysis {
    plane opponent[3];
} analysis;

static analysis analyse(const image *img)
{
    analysis out;
    int n = img->width * img->height;
    for (int c = 0; c < 3; c++)
        out.opponent[c] = (plane){img->width, img->height, g_new(double, n)};
    for (int i = 0; i < n; i++) {
        const double rgb[3] = {(double)img->pixels[3 * i], (double)img->pixels[3 * i + 1],
                               (double)img->pixels[3 * i + 2]};
        double xyz[3];
        to_xyz(rgb, xyz);
        out.opponent[0].v[i] = 116 * xyz[1] - 16;
        out.opponent[1].v[i] = 500 * (xyz[0] - xyz[1]);
        out.opponent[2].v[i] = 200 * (xyz[1] - xyz[2]);
    }
    return out;
}

static void hunt(const double rgb[3], double lab[3])
{
    double xyz[3], f[3];
    to_xyz(rgb, xyz);
    for (int c = 0; c < 3; c++)
        f[c] = cube_root_curve(xyz[c]);
    lab[0] = 116 * f[1] - 16;
    lab[1] = lab[0] / 100 * 500 * (f[0] - f[1]);
    lab[2] = lab[0] / 100 * 200 * (f[1] - f[2]);
}

static void seen_color(const analysis *a, int x, int y, double lab[3])
{
    double ycc[3], xyz[3], rgb[3];
    for (int c = 0; c < 3; c++)
        ycc[c] = filter_at(&a->opponent[c], x, y, 10, eye, c);
    xyz[1] = (ycc[0] + 16) / 116;
    xyz[0] = xyz[1] + ycc[1] / 500;
    xyz[2] = xyz[1] - ycc[2] / 200;
    to_rgb(xyz, rgb);
    hunt(rgb, lab);
}

static double color_distance(const double a[3], const double b[3])
{
    return pow(fabs(a[0] - b[0]) + hypot(a[1] - b[1], a[2] - b[2]), 0.7);
}

static double color_error(const analysis *a, const analysis *b, int x, int y)
{
    const double green[3] = {0, 1, 0}, blue[3] = {0, 0, 1};
    double p[3], q[3];
    hunt(green, p);
    hunt(blue, q);
    double largest = color_distance(p, q), knee = 0.4 * largest;
    seen_color(a, x, y, p);
    seen_color(b, x, y, q);
    double d = color_distance(p, q);
    return d < knee ? d * 0.95 / knee : 0.95 + 0.05 * (d - knee) / (largest - knee);
}

/* Length of the two derivatives of Y; kind 0 = edges, 2 = points. */
static double strength(const analysis *a, int x, int y, int kind)
{
    return hypot(filter_at(&a->opponent[0], x, y, 9, feature, kind),
                 filter_at(&a->opponent[0], x, y, 9, feature, kind + 1)) /
           116;
}

static double naive_flip(const analysis *a, const analysis *b, int x, int y)
{
    double edge = fabs(strength(a, x, y, 0) - strength(b, x, y, 0));
    double point = fabs(strength(a, x, y, 2) - strength(b, x, y, 2));
    double features = sqrt(fmax(edge, point) / sqrt(2));
    return pow(color_error(a, b, x, y), 1 - features);
}

/* Images of soft and hard shapes, so that both pipelines have something to see. */
static image *shapes(int width, int height, int variant)
{
    image *img = noise(width, height, 5);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            float *p = img->pixels + 3 * (y * width + x);
            bool inside = (x - 9) * (x - 9) + (y - 8) * (y - 8) < 30 + 20 * variant;
            for (int c = 0; c < 3; c++)
                p[c] = 0.3f * p[c] + (inside ? 0.6f : 0.05f * (float)(x % (c + 3)));
        }
    return img;
}

static void test_flip_equals_naive_twin(void)
{
    enum { W = 26, H = 19 };
    g_autoptr(image) a = shapes(W, H, 0), b = shapes(W, H, 1);
    double rgb[2][W * H * 3], map[W * H], sum = 0;
    for (int i = 0; i < W * H * 3; i++) {
        rgb[0][i] = (double)a->pixels[i];
        rgb[1][i] = (double)b->pixels[i];
    }
    g_assert_true(flip_error(rgb[0], rgb[1], W, H, map, NULL));
    analysis x = analyse(a), y = analyse(b);
    for (int i = 0; i < W * H; i++) {
        g_assert_cmpfloat_with_epsilon(map[i], naive_flip(&x, &y, i % W, i / W), 1e-9);
        sum += map[i];
    }
    g_assert_cmpfloat(sum / (W * H), >, 0.05);
    g_assert_cmpfloat_with_epsilon(compare(a, b).flip, sum / (W * H), 1e-9);
    for (int c = 0; c < 3; c++) {
        g_free(x.opponent[c].v);
        g_free(y.opponent[c].v);
    }
}

/* Smaller than the filters: the image goes on beyond its ends. */
static void test_flip_of_one_pixel(void)
{
    const float black[3] = {0, 0, 0}, white[3] = {1, 1, 1};
    g_autoptr(image) a = uniform(1, 1, 0, 0, 0), b = uniform(1, 1, 1, 1, 1);
    g_assert_cmpfloat_with_epsilon(compare(a, b).flip, flip_of_colors(black, white),
                                   1e-9);
}

/* ---- Images of images ---- */

static void test_map(void)
{
    g_autoptr(image) a = uniform(4, 2, 0.5f, 0.5f, 0.5f),
                     b = uniform(4, 2, 0.5f, 0.5f, 0.5f);
    float *at = a->pixels;
    for (int c = 0; c < 3; c++) {
        at[c] = 0.625f;    /* a quarter brighter: half of the scale */
        at[3 + c] = 0.25f; /* half darker: all of it */
        at[9 + c] = 9.0f;
    }
    at[6] = NAN;
    g_autoptr(image) map = image_difference_map(a, b, NULL);
    static const float expected[5][3] = {
        {1.0f, 0.25f, 0.0f}, {1, 1, 1}, {0, 1, 0}, {1, 1, 1}, {0, 0, 0}};
    for (int i = 0; i < 15; i++)
        g_assert_cmpfloat_with_epsilon(map->pixels[i], expected[i / 3][i % 3], 1e-5f);
    g_autoptr(image) darker = image_difference_map(b, a, NULL);
    g_assert_cmpfloat_with_epsilon(darker->pixels[2], 0.8f, 1e-5f); /* 0.125 of 0.3125 */
    g_assert_cmpfloat(darker->pixels[0], ==, 0.0f);
    g_autoptr(image) small = uniform(4, 3, 1, 1, 1);
    g_assert_null(image_difference_map(a, small, NULL));
}

/* Every pixel is cut into as many as make both sizes' grids one. */
static void test_scaled(void)
{
    enum { W = 5, H = 3, TO_W = 7, TO_H = 2 };
    g_autoptr(image) img = noise(W, H, 3);
    g_autoptr(image) scaled = image_scaled(img, TO_W, TO_H, NULL);
    double sums[TO_W * TO_H] = {0};
    for (int y = 0; y < H * TO_H; y++)
        for (int x = 0; x < W * TO_W; x++)
            sums[y / H * TO_W + x / W] +=
                (double)img->pixels[3 * (y / TO_H * W + x / TO_W) + 1];
    for (int i = 0; i < TO_W * TO_H; i++)
        g_assert_cmpfloat_with_epsilon((double)scaled->pixels[3 * i + 1],
                                       sums[i] / (W * H), 1e-6);
    g_autoptr(image) same = image_scaled(img, W, H, NULL);
    for (int i = 0; i < 3 * W * H; i++)
        g_assert_cmpfloat_with_epsilon(same->pixels[i], img->pixels[i], 1e-6f);
}

static void test_sheet(void)
{
    g_autoptr(image) a = uniform(3, 2, 1, 0, 0), b = uniform(1, 4, 0, 1, 0);
    const image *const three[] = {a, b, a};
    g_autoptr(image) sheet = image_sheet(three, 3, 2, NULL);
    double sums[3] = {0};
    g_assert_cmpint(sheet->width, ==, 4 + 3 + 4 + 1 + 4);
    g_assert_cmpint(sheet->height, ==, 4 + 4 + 4 + 2 + 4);
    for (int i = 0; i < 3 * sheet->width * sheet->height; i++)
        sums[i % 3] += sheet->pixels[i] > 0.5f;
    g_assert_cmpfloat(sums[0], ==, 12);
    g_assert_cmpfloat(sums[1], ==, 4);
    g_assert_cmpfloat(sums[2], ==, 0);
    const char *const colourless[] = {"U", "V"};
    g_autoptr(image) other = image_new(2, 2, 2, colourless, NULL);
    const image *const two[] = {a, other};
    g_autoptr(GError) error = NULL;
    g_assert_null(image_sheet(two, 2, 2, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/compare/identical", test_identical);
    g_test_add_func("/compare/by-hand", test_by_hand);
    g_test_add_func("/compare/not-finite", test_not_finite_is_left_out);
    g_test_add_func("/compare/refuses", test_refuses);
    g_test_add_func("/compare/flip-greys", test_flip_of_greys);
    g_test_add_func("/compare/flip-one", test_flip_reaches_one);
    g_test_add_func("/compare/flip-symmetric", test_flip_is_symmetric_and_grows);
    g_test_add_func("/compare/flip-naive", test_flip_equals_naive_twin);
    g_test_add_func("/compare/flip-pixel", test_flip_of_one_pixel);
    g_test_add_func("/compare/map", test_map);
    g_test_add_func("/compare/scaled", test_scaled);
    g_test_add_func("/compare/sheet", test_sheet);
    return g_test_run();
}
