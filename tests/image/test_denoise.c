/*
 * denoise: pictures of which the truth is known, with noise of known size.
 */
#include "base/memory.h"
#include "image/denoise/denoise.h"
#include "noisy_picture.h"

#include <string.h>

/* ---- Pictures ---- */

static float flat(int x, int y)
{
    (void)x;
    (void)y;
    return 0.7f;
}

/* An edge that runs askew, as a caustic's. */
static float edge(int x, int y)
{
    return 3 * x + y > 120 ? 4.0f : 0.25f;
}

static float checks(int x, int y)
{
    return (x / 3 + y / 3) % 2 ? 0.9f : 0.15f;
}

static void read_halves(const void *data, int y, float *const *const half[2],
                        float *variance)
{
    const picture *p = data;
    for (int x = 0; x < W; x++) {
        for (int h = 0; h < 2; h++)
            for (int c = 0; c < 3; c++)
                half[h][c][x] = p->half[h][3 * (y * W + x) + c];
        if (variance)
            variance[x] = NAN;
    }
}

static void read_all(const void *data, int y, float *const *const half[2],
                     float *variance)
{
    const picture *p = data;
    read_halves(data, y, half, variance);
    if (variance)
        memcpy(variance, p->variance + y * W, W * sizeof(float));
}

static denoise_source source_of(const picture *p)
{
    return (denoise_source){read_all, p};
}

/* Whose variance only the halves tell. */
static denoise_source untold_source_of(const picture *p)
{
    return (denoise_source){read_halves, p};
}

static int add(denoiser *d, const denoise_source *feature, GError **error)
{
    const int n_channels[] = {3};
    return denoiser_add(d, feature, n_channels, 1, error);
}

static bool filter(const denoiser *d, const denoise_source *light, int n_beside,
                   int number, float *out, GError **error)
{
    memset(out, 0, 3 * N * sizeof *out);
    return denoiser_filter(d, light, n_beside, number, out, error);
}

static double squared_error(const picture *p, const float *out)
{
    double sum = 0.0;
    for (int i = 0; i < 3 * N; i++)
        sum += pow((double)(out[i] - p->truth[i]), 2.0);
    return sum / (3 * N);
}

static double raw_error(const picture *p)
{
    float *mean = g_new(float, 3 * N);
    for (int i = 0; i < 3 * N; i++)
        mean[i] = 0.5f * (p->half[0][i] + p->half[1][i]);
    double error = squared_error(p, mean);
    g_free(mean);
    return error;
}

static const denoise_size size = {W, H, 0.5f, 1.0f, 0.7f, 2, NULL, false};

/* Filters light, with up to one feature. @return the squared error over that of the raw
 */
static double gain_of(picture *p, denoise_source light, const denoise_source *feature,
                      bool divide, float distinct)
{
    GError *error = NULL;
    denoise_size by = size;
    by.distinct = distinct;
    g_autoptr(denoiser) d = denoiser_new(&by, &error);
    int number = feature ? add(d, feature, &error) : -1;
    g_assert_no_error(error);
    g_assert_true(filter(d, &light, 0, divide ? number : -1, p->out, &error));
    g_assert_no_error(error);
    return squared_error(p, p->out) / raw_error(p);
}

static double gain(picture *p, const denoise_source *feature, bool divide)
{
    return gain_of(p, source_of(p), feature, divide, 1.0f);
}

/* ---- Closed cases ---- */

static void test_constant(void)
{
    g_autofree picture *p = noisy(flat, 0.2, 1);
    double mean = 0.0, raw = 0.0;
    g_assert_cmpfloat(gain(p, NULL, false), <, 0.02);
    for (int i = 0; i < N; i++) {
        mean += (double)p->out[3 * i + 1] / N;
        raw += 0.5 * (double)(p->half[0][3 * i + 1] + p->half[1][3 * i + 1]) / N;
    }
    /* Half a standard error of the mean. */
    g_assert_cmpfloat_with_epsilon(mean, raw, 0.5 * 0.2 * 0.7 / sqrt(N));
}

/* Each half has one of two rows for both, as of a single pass. */
static void lend_rows(picture *p)
{
    const size_t row = 3 * W;
    for (size_t y = 0; y + 1 < H; y += 2) {
        memcpy(p->half[0] + (y + 1) * row, p->half[0] + y * row, row * sizeof(float));
        memcpy(p->half[1] + y * row, p->half[1] + (y + 1) * row, row * sizeof(float));
    }
}

/* Rows that have others' noise agree by chance, which is no reason to put it back. */
static void test_lent(void)
{
    double told = 0.0, untold = 0.0;
    for (guint32 seed = 60; seed < 66; seed++) {
        g_autofree picture *p = noisy(flat, 0.2, seed);
        lend_rows(p);
        const denoise_source light = untold_source_of(p);
        told += gain_of(p, light, NULL, false, 0.5f);
        untold += gain_of(p, light, NULL, false, 1.0f);
    }
    g_test_message("of one error %g is left, untold %g", told / 6.0, untold / 6.0);
    g_assert_cmpfloat(told, <, 0.8 * untold);
}

/* First order: a slope is no steeper and no flatter after. */
static void test_slope_known_to_feature(void)
{
    g_autofree picture *p = noisy(slope, 0.2, 2), *known = noisy(slope, 0.0, 2);
    const denoise_source feature = source_of(known);
    g_assert_cmpfloat(gain(p, &feature, false), <, 0.03);
    float left = 0.0f, right = 0.0f;
    for (int y = 10; y < H - 10; y++) {
        left += p->out[3 * (y * W + 2) + 1];
        right += p->out[3 * (y * W + W - 3) + 1];
    }
    g_assert_cmpfloat_with_epsilon((double)(right - left) / (H - 20), 0.01 * (W - 5),
                                   0.05);
}

/* A converged picture stays what it is, whatever is in it and whatever features say. */
static void test_converged(void)
{
    static const pattern patterns[] = {flat, edge, checks, slope, detail};
    g_autofree picture *false_edge = noisy(checks, 0.0, 9);
    const denoise_source feature = source_of(false_edge);
    for (size_t i = 0; i < G_N_ELEMENTS(patterns); i++) {
        for (double sigma = 0.02; sigma > 0.0001; sigma *= 0.2) {
            g_autofree picture *p = noisy(patterns[i], sigma, 3 + (guint32)i);
            double alone = gain(p, NULL, false), misled = gain(p, &feature, false);
            g_test_message("pattern %zu, noise %g: %g, %g", i, sigma, alone, misled);
            g_assert_cmpfloat(alone, <, 1.05);
            g_assert_cmpfloat(misled, <, 1.05);
        }
    }
}

/* Squared error of the means over squares of 7 x 7 pixels: what is seen from afar. */
static double error_of_means(const picture *p, const float *out)
{
    double sum = 0.0;
    for (int y = 3; y < H - 3; y++) {
        for (int x = 3; x < W - 3; x++) {
            double mean = 0.0;
            for (int k = 0; k < 49; k++) {
                int i = 3 * ((y + k / 7 - 3) * W + x + k % 7 - 3) + 1;
                mean += (double)(out[i] - p->truth[i]) / 49.0;
            }
            sum += mean * mean;
        }
    }
    return sum;
}

/* A soft spot that no feature knows of. */
static float spot(int x, int y)
{
    float dx = (float)x - 37.0f, dy = (float)y - 30.0f;
    return 0.2f + 2.0f * expf(-(dx * dx + dy * dy) / 60.0f);
}

/* What noise is in single pixels leaves their mean well known: the filter, which rather
   loses a little everywhere, must not make that worse. */
static void test_means_stay(void)
{
    for (double sigma = 0.2; sigma > 0.01; sigma *= 0.5) {
        g_autofree picture *p = noisy(spot, sigma, 41);
        float *raw = g_new(float, 3 * N);
        double grain = gain(p, NULL, false);
        for (int i = 0; i < 3 * N; i++)
            raw[i] = 0.5f * (p->half[0][i] + p->half[1][i]);
        double ratio = error_of_means(p, p->out) / error_of_means(p, raw);
        g_test_message("noise %g: %g, of means %g", sigma, grain, ratio);
        g_assert_cmpfloat(ratio, <, 1.2);
        g_free(raw);
    }
}

/* With half the noise in the picture there is less in what is shown. */
static void test_error_falls(void)
{
    static const pattern patterns[] = {flat, edge, checks, detail};
    for (size_t i = 0; i < G_N_ELEMENTS(patterns); i++) {
        double before = (double)INFINITY;
        for (double sigma = 0.5; sigma > 0.001; sigma *= 0.5) {
            g_autofree picture *p = noisy(patterns[i], sigma, 20);
            double error = gain(p, NULL, false) * raw_error(p);
            g_assert_cmpfloat(error, <, before);
            before = error;
        }
    }
}

static void test_edge_known_to_feature(void)
{
    g_autofree picture *p = noisy(edge, 0.3, 5), *known = noisy(edge, 0.1, 6);
    const denoise_source feature = source_of(known);
    double blind = gain(p, NULL, false), seeing = gain(p, &feature, false);
    g_test_message("edge: %g without the feature, %g with it", blind, seeing);
    g_assert_cmpfloat(seeing, <, 0.06);
    g_assert_cmpfloat(seeing, <, 0.5 * blind);
}

static void test_texture_known_to_albedo(void)
{
    g_autofree picture *p = noisy(checks, 0.3, 7), *albedo = noisy(checks, 0.0, 8);
    const denoise_source feature = source_of(albedo);
    g_assert_cmpfloat(gain(p, &feature, true), <, 0.03);
    g_assert_cmpfloat(gain(p, &feature, false), <, 0.06);
}

/* Feature and light have nothing to do with each other: its noise does not come in. */
static void test_noisy_feature_of_nothing(void)
{
    g_autofree picture *p = noisy(flat, 0.2, 11), *other = noisy(flat, 1.0, 12);
    const denoise_source feature = source_of(other);
    g_assert_cmpfloat(gain(p, &feature, false), <, 0.03);
}

/* ---- What must not happen ---- */

static double most_off(const picture *p)
{
    double most = 0.0;
    for (int i = 0; i < 3 * N; i++) {
        g_assert_true(isfinite(p->out[i]));
        most = fmax(most, fabs((double)(p->out[i] - p->truth[i])));
    }
    return most;
}

/* No pixel is farther off than without them. */
static void test_not_finite(void)
{
    g_autofree picture *p = noisy(flat, 0.1, 13), *whole = noisy(flat, 0.1, 13);
    const denoise_source same = source_of(whole);
    gain(whole, &same, false);
    static const float odd[] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 30; i++)
        p->half[i % 2][3 * (i * 149 % N) + i % 3] = odd[i % 3];
    p->half[0][3000] = p->half[1][3000] = NAN;
    p->variance[77] = NAN;
    p->variance[78] = INFINITY;
    GError *error = NULL;
    g_autoptr(denoiser) d = denoiser_new(&size, &error);
    const denoise_source light = source_of(p);
    g_assert_cmpint(add(d, &light, &error), ==, 0);
    g_assert_true(filter(d, &light, 0, -1, p->out, &error));
    g_test_message("off by %g, without faults %g", most_off(p), most_off(whole));
    g_assert_cmpfloat(most_off(p), <, 1.1 * most_off(whole));
}

/* One path that hardly anyone finds leaves no spot. */
static void test_outlier(void)
{
    g_autofree picture *p = noisy(flat, 0.1, 14);
    int at = 30 * W + 40;
    for (int c = 0; c < 3; c++)
        p->half[1][3 * at + c] = 1000.0f;
    p->variance[at] = 500.0f * 500.0f;
    gain(p, NULL, false);
    for (int i = 0; i < 3 * N; i++)
        g_assert_cmpfloat(fabsf(p->out[i] - p->truth[i]), <, 0.15);
}

/* @return the most that a pixel is off */
static float greatest_error(picture *p, int n_beside)
{
    float most = 0.0f;
    const denoise_source light = untold_source_of(p);
    g_autoptr(denoiser) d = denoiser_new(&size, NULL);
    g_assert_true(filter(d, &light, n_beside, -1, p->out, NULL));
    for (int i = 0; i < 3 * N; i++)
        most = fmaxf(most, fabsf(p->out[i] - p->truth[i]));
    return most;
}

/* Three of them together, where such are known to be. */
static void test_outliers_together(void)
{
    g_autofree picture *p = noisy(flat, 0.1, 14);
    for (int i = 0; i < 3; i++) {
        int at = (30 + i / 2) * W + 40 + i % 2;
        for (int c = 0; c < 3; c++)
            p->half[1][3 * at + c] = 1000.0f;
    }
    g_assert_cmpfloat(greatest_error(p, 0), >, 1.0f);
    g_assert_cmpfloat(greatest_error(p, 2), <, 0.2f);
}

/* A wall in the dark that one path of eight finds a bright place from: the halves agree
   by chance on what each has of them, which is no reason to show it. */
static void test_few_bright_paths(void)
{
    enum { PATHS = 4, BRIGHT = 8 };
    g_autofree picture *p = noisy(flat, 0.0, 0);
    g_autoptr(GRand) random = g_rand_new_with_seed(15);
    for (int i = 0; i < N; i++) {
        p->variance[i] = 0.49f * (BRIGHT - 1) / (2 * PATHS);
        for (int h = 0; h < 2; h++) {
            int n = 0;
            for (int k = 0; k < PATHS; k++)
                n += g_rand_int_range(random, 0, BRIGHT) == 0;
            for (int c = 0; c < 3; c++)
                p->half[h][3 * i + c] *= (float)n * BRIGHT / PATHS;
        }
    }
    double left = gain(p, NULL, false);
    g_test_message("%.4f of the squared error", left);
    g_assert_cmpfloat(left, <, 0.012); /* .0163 where means come back without doubt */
}

/* Light that a lens or a glossy plate gathers: no feature knows of it. */
static float burn(int x, int y)
{
    float dx = (float)x - 37.2f, dy = (float)y - 30.4f;
    return 0.5f + 100.0f * expf(-(dx * dx + dy * dy) / 8.0f);
}

/* Squared error relative to what is there. */
static double relative_error(const picture *p, const float *out)
{
    double sum = 0.0;
    for (int i = 0; i < 3 * N; i++)
        sum += pow((double)(out[i] / p->truth[i]) - 1.0, 2.0) / (3 * N);
    return sum;
}

/* No pixel is like another. */
static float unlike(int x, int y)
{
    guint32 hash = ((guint32)x * 73856093u ^ (guint32)y * 19349663u) * 2654435761u;
    hash = (hash ^ hash >> 15) * 2246822519u;
    return 0.25f * expf(4.0f * (float)(hash >> 16) / 65536.0f);
}

/* What nothing is like is what itself says, also where no window is around it. */
static void test_unlike(void)
{
    const double sigma = 0.2;
    g_autofree picture *p = noisy(unlike, sigma, 52);
    gain(p, NULL, false);
    double left = relative_error(p, p->out) / (sigma * sigma);
    g_test_message("%.3f of the squared error", left);
    g_assert_cmpfloat(left, <, 1.5);
}

/* The noise of what is bright is no reason to keep from the dark beside it what the
   filter smeared there. */
static void test_beside_bright(void)
{
    for (double sigma = 0.4; sigma > 0.02; sigma *= 0.5) {
        g_autofree picture *p = noisy(burn, sigma, 51);
        gain(p, NULL, false);
        double left = relative_error(p, p->out) / (sigma * sigma);
        g_test_message("noise %g: %.3f of the squared error", sigma, left);
        g_assert_cmpfloat(left, <, 0.1);
    }
}

/* Flecks of light, of sharp edges, that a ball of mirrors throws on a dark wall. */
static bool is_lit(double x, double y)
{
    double u = fmod(x + 0.3 * y, 17.0), v = fmod(y - 0.2 * x + 19.0, 13.0);
    return u > 4.0 && u < 8.5 && v > 5.0 && v < 8.0;
}

/* Mean of n x n places in a pixel, or of as many that chance chooses, each with noise. */
static double fleck(int i, int n, GRand *random, double sigma)
{
    double sum = 0.0;
    for (int k = 0; k < n * n; k++) {
        double u = random ? g_rand_double(random) : (k % n + 0.5) / n;
        double v = random ? g_rand_double(random) : (k / n + 0.5) / n;
        double noise = random ? 1.0 + sigma * normal(random) : 1.0;
        sum += (is_lit(i % W + u, i / W + v) ? 4.0 : 0.05) * noise / (n * n);
    }
    return sum;
}

/* Two samples a pixel, in halves of one. */
static picture *flecks(double sigma, guint32 seed)
{
    picture *p = g_new0(picture, 1);
    g_autoptr(GRand) random = g_rand_new_with_seed(seed);
    for (int i = 0; i < N; i++) {
        double truth = fleck(i, 16, NULL, 0.0), half[2];
        for (int h = 0; h < 2; h++)
            half[h] = fleck(i, 1, random, sigma);
        p->variance[i] = (float)(0.25 * (half[0] - half[1]) * (half[0] - half[1]));
        for (int c = 0; c < 3; c++) {
            p->truth[3 * i + c] = (float)truth;
            for (int h = 0; h < 2; h++)
                p->half[h][3 * i + c] = (float)half[h];
        }
    }
    return p;
}

/* Squared error relative to what is there, where nothing is lit. */
static double error_in_the_dark(const picture *p)
{
    double sum = 0.0;
    int n = 0;
    for (int i = 0; i < 3 * N; i++) {
        bool dark = p->truth[i] < 0.051f;
        sum += dark ? pow((double)(p->out[i] / p->truth[i]) - 1.0, 2.0) : 0.0;
        n += dark;
    }
    return sum / n;
}

/* The dark beside them takes on less of their light than is there, though no patch is
   like another, and the flecks have more noise than the dark has light. */
static void test_flecks(void)
{
    for (double sigma = 0.4; sigma > 0.05; sigma *= 0.5) {
        g_autofree picture *p = flecks(sigma, 53);
        gain(p, NULL, false);
        double left = error_in_the_dark(p);
        g_test_message("noise %g: %.2f of the light", sigma, left);
        g_assert_cmpfloat(left, <, 2.0); /* 5 to 8 without own_row */
    }
}

static void test_black(void)
{
    g_autofree picture *p = noisy(flat, 0.1, 15);
    memset(p->half, 0, sizeof p->half);
    memset(p->variance, 0, sizeof p->variance);
    gain(p, NULL, false);
    for (int i = 0; i < 3 * N; i++)
        g_assert_cmpfloat(p->out[i], ==, 0.0f);
}

/* Any number of threads gives the same bits. */
static void test_threads(void)
{
    g_autofree picture *p = noisy(detail, 0.3, 16), *other = noisy(edge, 0.2, 17);
    g_autofree float *first = g_new(float, 3 * N);
    const denoise_source light = source_of(p), feature = source_of(other);
    for (unsigned threads = 1; threads <= 7; threads += 3) {
        denoise_size by = size;
        by.threads = threads;
        g_autoptr(denoiser) d = denoiser_new(&by, NULL);
        g_assert_cmpint(add(d, &feature, NULL), ==, 0);
        g_assert_true(filter(d, &light, 0, -1, threads == 1 ? first : p->out, NULL));
        if (threads > 1)
            g_assert_cmpmem(first, 3 * N * sizeof(float), p->out, 3 * N * sizeof(float));
    }
}

static void read_grey(const void *data, int y, float *const *const half[2],
                      float *variance)
{
    const denoise_size *of = data;
    (void)y;
    for (int x = 0; x < of->width; x++) {
        for (int h = 0; h < 2; h++)
            for (int c = 0; c < 3; c++)
                half[h][c][x] = 0.25f;
        variance[x] = NAN;
    }
}

static void test_small_pictures(void)
{
    for (int w = 1; w < 20; w += 6) {
        float out[3 * 20 * 3] = {0};
        const denoise_size small = {w, 3, 0.5f, 1.0f, 0.7f, 1, NULL, false};
        const denoise_source light = {read_grey, &small};
        g_autoptr(denoiser) d = denoiser_new(&small, NULL);
        g_assert_true(denoiser_filter(d, &light, 0, -1, out, NULL));
        for (int i = 0; i < 3 * 3 * w; i++)
            g_assert_cmpfloat_with_epsilon(out[i], 0.25f, 1e-5f);
    }
}

static void test_no_memory(void)
{
    g_autofree picture *p = noisy(flat, 0.1, 18);
    const denoise_source light = source_of(p);
    bool done = false;
    for (unsigned n = 1; !done; n++) {
        GError *error = NULL;
        g_autoptr(denoiser) d = denoiser_new(&size, NULL);
        big_alloc_fail_at(n);
        done = add(d, &light, &error) == 0 && filter(d, &light, 0, -1, p->out, &error);
        big_alloc_fail_at(0);
        g_assert_true(done || g_error_matches(error, NEPH_ERROR, ERROR_FAILED));
        g_clear_error(&error);
        g_assert_cmpuint(n, <, 200);
    }
}

static void test_cancelled(void)
{
    g_autofree picture *p = noisy(flat, 0.1, 19);
    const denoise_source light = source_of(p);
    cancel_flag cancel = {.set = true};
    denoise_size stopped = size;
    stopped.cancel = &cancel;
    GError *error = NULL;
    g_autoptr(denoiser) d = denoiser_new(&stopped, NULL);
    g_assert_false(filter(d, &light, 0, -1, p->out, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_CANCELLED);
    g_clear_error(&error);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/denoise/constant", test_constant);
    g_test_add_func("/denoise/lent", test_lent);
    g_test_add_func("/denoise/slope-known-to-feature", test_slope_known_to_feature);
    g_test_add_func("/denoise/converged", test_converged);
    g_test_add_func("/denoise/means-stay", test_means_stay);
    g_test_add_func("/denoise/error-falls", test_error_falls);
    g_test_add_func("/denoise/edge-known-to-feature", test_edge_known_to_feature);
    g_test_add_func("/denoise/texture-known-to-albedo", test_texture_known_to_albedo);
    g_test_add_func("/denoise/noisy-feature-of-nothing", test_noisy_feature_of_nothing);
    g_test_add_func("/denoise/not-finite", test_not_finite);
    g_test_add_func("/denoise/outlier", test_outlier);
    g_test_add_func("/denoise/outliers-together", test_outliers_together);
    g_test_add_func("/denoise/few-bright-paths", test_few_bright_paths);
    g_test_add_func("/denoise/beside-bright", test_beside_bright);
    g_test_add_func("/denoise/unlike", test_unlike);
    g_test_add_func("/denoise/flecks", test_flecks);
    g_test_add_func("/denoise/black", test_black);
    g_test_add_func("/denoise/threads", test_threads);
    g_test_add_func("/denoise/small-pictures", test_small_pictures);
    g_test_add_func("/denoise/no-memory", test_no_memory);
    g_test_add_func("/denoise/cancelled", test_cancelled);
    return g_test_run();
}
