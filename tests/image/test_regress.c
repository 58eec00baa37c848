/*
 * regress: distances, noise and regressions against naive twins in double precision.
 */
#include "base/memory.h"
#include "image/denoise/regress.h"
#include "noisy_picture.h"

/* ---- A bench ---- */

/* Everything a regression needs, made of a picture: halves as they are, noise the same
   everywhere. */
typedef struct workbench {
    regression r;
    GPtrArray *planes;
} workbench;

static float *bench_plane(workbench *b)
{
    float *plane = plane_new(&b->r.g, NULL);
    g_ptr_array_add(b->planes, plane);
    return plane;
}

static float *filled_plane(workbench *b, const float *from, int c)
{
    float *plane = bench_plane(b);
    for (int i = 0; i < N; i++)
        plane[plane_at(&b->r.g, i % W, i / W)] = from[3 * i + c];
    plane_mirror(&b->r.g, &plane, 1);
    return plane;
}

static workbench bench_open(const picture *p, const picture *feature, float noise)
{
    workbench b = {.planes = g_ptr_array_new_with_free_func(big_free)};
    b.r.g = grid_make(W, H, 2, NULL);
    float *all = bench_plane(&b), *zero = bench_plane(&b);
    for (size_t i = 0; i < b.r.g.n; i++)
        all[i] = noise;
    for (int h = 0; h < N_HALVES; h++) {
        for (int c = 0; c < 3; c++)
            b.r.color[h][c] = filled_plane(&b, p->half[h], c);
        for (int k = 0; k < N_BANDS; k++) {
            for (int i = 0; i < N_SUMS; i++)
                b.r.sum[k][h][i] = bench_plane(&b);
        }
    }
    for (int h = 0; h < N_HALVES; h++)
        b.r.alike[h] =
            (patch_source){NULL, 1, {b.r.color[1 - h][1]}, all, .least = 1e-6f};
    b.r.n_features = 1;
    b.r.feature[0] = filled_plane(&b, feature->half[0], 1);
    b.r.doubt[0] = zero;
    return b;
}

static double naive_distance(const patch_source *s, int x, int y, int qx, int qy)
{
    double sum = 0.0;
    for (int v = -PATCH; v <= PATCH; v++) {
        for (int u = -PATCH; u <= PATCH; u++)
            sum += pow((double)s->value[0][plane_at(s->g, x + u, y + v)] -
                           (double)s->value[0][plane_at(s->g, qx + u, qy + v)],
                       2.0);
    }
    double here = (double)s->noise[plane_at(s->g, x, y)];
    double there = (double)s->noise[plane_at(s->g, qx, qy)];
    return fmax(sum - (here + fmin(here, there)), 0.0) /
           (here + there + (double)s->least);
}

static void test_distances(void)
{
    g_autofree picture *p = noisy(detail, 0.2, 30);
    workbench b = bench_open(p, p, 0.3f);
    patch_source s = b.r.alike[0];
    float d[BLOCK];
    s.g = &b.r.g;
    for (int i = 0; i < 60; i++) {
        int x = i * 7 % (W - 32), y = i * 13 % H, dx = i % 15 - 7, dy = i / 4 - 7;
        patch_distances(&s, x, y, dx, dy, d);
        for (int k = 0; k < BLOCK; k++) {
            double want = naive_distance(&s, x + k, y, x + k + dx, y + dy);
            g_assert_cmpfloat_with_epsilon((double)d[k], want, 1e-4 * (1.0 + want));
        }
    }
    g_ptr_array_unref(b.planes);
}

/* A window's line through colours by one feature, in closed form. */
typedef struct line {
    double a, b, weight[SIDE * SIDE];
} line;

static int before(const regression *r)
{
    return SIDE / 2 - r->step / 2;
}

static double naive_weight(double d)
{
    return pow(fmax(1.0 - d / 8.0, 0.0), 8.0);
}

static line naive_line(const regression *r, int h, int band, int x, int y)
{
    line out = {0};
    double w0 = 0, f1 = 0, f2 = 0, c1 = 0, fc = 0, spread = 0;
    const grid *g = &r->g;
    for (int i = 0; i < SIDE * SIDE; i++) {
        int qx = x + i % SIDE - before(r), qy = y + i / SIDE - before(r);
        double f = (double)r->feature[0][plane_at(g, qx, qy)] -
                   (double)r->feature[0][plane_at(g, x, y)];
        double c = (double)r->color[h][1][plane_at(g, qx, qy)];
        double d = naive_distance(&r->alike[h], x, y, qx, qy) * (band ? 4.0 : 1.0);
        bool in = qx >= 0 && qx < W && qy >= 0 && qy < H;
        double w = out.weight[i] = in ? naive_weight(d) : 0.0;
        spread += f * f / (SIDE * SIDE);
        w0 += w;
        f1 += w * f;
        f2 += w * f * f;
        c1 += w * c;
        fc += w * f * c;
    }
    f2 += (1e-3 * w0 + 1e-3) * spread; /* the ridge */
    out.b = (w0 * fc - f1 * c1) / (w0 * f2 - f1 * f1);
    out.a = (c1 - out.b * f1) / w0;
    return out;
}

static double tent(int i)
{
    return fmin(2.0 - 2.0 * fabs(i + 0.5 - SIDE / 2.0) / (SIDE / 2.0), 1.0);
}

static void naive_regress(const regression *r, int h, int band, double *sum,
                          double *weights)
{
    const grid *g = &r->g;
    for (int y = 0; y < H; y += r->step) {
        for (int x = 0; x < W; x += r->step) {
            line l = naive_line(r, h, band, x, y);
            for (int i = 0; i < SIDE * SIDE; i++) {
                int qx = x + i % SIDE - before(r), qy = y + i / SIDE - before(r);
                if (qx < 0 || qx >= W || qy < 0 || qy >= H)
                    continue;
                double f = (double)r->feature[0][plane_at(g, qx, qy)] -
                           (double)r->feature[0][plane_at(g, x, y)];
                double w = l.weight[i] * tent(i % SIDE) * tent(i / SIDE);
                sum[qy * W + qx] += w * (l.a + l.b * f);
                weights[qy * W + qx] += w;
            }
        }
    }
}

static void check_regression(int step)
{
    g_autofree picture *p = noisy(detail, 0.2, 31), *feature = noisy(slope, 0.05, 32);
    workbench b = bench_open(p, feature, 0.4f);
    b.r.step = step;
    for (int h = 0; h < N_HALVES; h++)
        b.r.alike[h].g = &b.r.g;
    g_assert_true(regress(&b.r));
    for (int band = 0; band < N_BANDS; band++) {
        double *sum = g_new0(double, N), *weights = g_new0(double, N);
        naive_regress(&b.r, 1, band, sum, weights);
        for (int i = 0; i < N; i++) {
            size_t at = plane_at(&b.r.g, i % W, i / W);
            double value = (double)b.r.sum[band][1][1][at],
                   weight = (double)b.r.sum[band][1][3][at];
            g_assert_cmpfloat_with_epsilon(weight, weights[i], 1e-3 * (1.0 + weights[i]));
            g_assert_cmpfloat_with_epsilon(value, sum[i], 2e-3 * (1.0 + weights[i]));
        }
        g_free(sum);
        g_free(weights);
    }
    g_ptr_array_unref(b.planes);
}

static void test_regression(void)
{
    check_regression(2);
    check_regression(4);
}

/* Sums over patches, mirrored where they reach over the side, of what each half has. */
static void test_noise(void)
{
    const float share = 0.3f;
    g_autofree picture *p = noisy(detail, 0.2, 33);
    workbench b = bench_open(p, p, 0.0f);
    const grid *g = &b.r.g;
    float *variance = filled_plane(&b, p->half[0], 1);
    float *noise[2] = {bench_plane(&b), bench_plane(&b)};
    patch_noise(g, variance, share, noise);
    for (int i = 0; i < N; i++) {
        double sum = 0.0;
        for (int k = 0; k < PATCH_PIXELS; k++) {
            int x = i % W + k % 7 - PATCH, y = i / W + k / 7 - PATCH;
            x = x < 0 ? -1 - x : x >= W ? 2 * W - 1 - x : x;
            y = y < 0 ? -1 - y : y >= H ? 2 * H - 1 - y : y;
            sum += (double)p->half[0][3 * (y * W + x) + 1];
        }
        size_t at = plane_at(g, i % W, i / W);
        g_assert_cmpfloat_with_epsilon((double)noise[0][at], sum / 0.3, 1e-4 * sum);
        g_assert_cmpfloat_with_epsilon((double)noise[1][at], sum / 0.7, 1e-4 * sum);
    }
    for (int y = 0; y < H; y++) /* the margin mirrors the side */
        for (int h = 0; h < 2; h++) {
            const float *row = noise[h] + plane_at(g, 0, y);
            g_assert_cmpfloat(row[-1], ==, row[0]);
            g_assert_cmpfloat(row[W + 1], ==, row[W - 2]);
        }
    g_ptr_array_unref(b.planes);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/regress/distances", test_distances);
    g_test_add_func("/regress/noise", test_noise);
    g_test_add_func("/regress/regression", test_regression);
    return g_test_run();
}
