/*
 * phase: how a medium scatters. Henyey and Greenstein's function against its closed form
 * in double: it integrates to one, its mean cosine is g along the way on, it is
 * reciprocal and round, sampling follows it, and its lobe is there for those who ask for
 * it only.
 *
 * Statistical checks: χ² with p > 1e-8 each, seeds fixed.
 */
#include "bsdf/bsdf_models.h"
#include "chi2.h"

#define TINY_P 1e-8

/* Around the limit below which sampling takes the round form, too. */
static const float GS[] = {-0.95f,  -0.7f,    -0.3f, -1.01e-3f, -9.9e-4f, 0.0f,
                           9.9e-4f, 1.01e-3f, 0.01f, 0.3f,      0.7f,     0.95f};

static const transport_mode MODES[] = {TRANSPORT_RADIANCE, TRANSPORT_IMPORTANCE};

/* cosine: of the angle by which light is turned; 1 is straight on. */
static double closed_form(double g, double cosine)
{
    return (1 - g * g) / (4 * G_PI * pow(1 + g * g - 2 * g * cosine, 1.5));
}

/* Share of light that is turned by more than acos(cosine). */
static double cumulative(double g, double cosine)
{
    if (fabs(g) < 1e-9)
        return (1 + cosine) / 2;
    return (1 - g * g) / (2 * g) * (1 / sqrt(1 + g * g - 2 * g * cosine) - 1 / (1 + g));
}

static bsdf phase_with(float g, int wavelength)
{
    bsdf b;
    memset(&b, 0xff, sizeof b); /* nothing need be set before */
    bsdf_make_phase(&b, g, wavelength);
    return b;
}

/* The i-th of n directions spread evenly (a spiral). */
static vec3 spread(int i, int n)
{
    return normalize3(chi2_direction(2.0 * (i + 0.5) / n - 1.0, 2.399963 * i));
}

static double turned_by(vec3 wo, vec3 wi)
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum -= (double)wo[i] * (double)wi[i];
    return sum;
}

static void test_is_one_value(void)
{
    enum { N = 40 };
    for (size_t k = 0; k < G_N_ELEMENTS(GS); k++) {
        const bsdf b = phase_with(GS[k], ALL_WAVELENGTHS);
        g_assert_true(b.is_phase);
        for (int i = 0; i < N * N; i++) {
            vec3 wo = spread(i / N, N), wi = spread(i % N, N);
            float pdf = bsdf_pdf(&b, wo, wi, LOBE_ALL, TRANSPORT_RADIANCE);
            double expected = closed_form((double)GS[k], turned_by(wo, wi));
            g_assert_cmpfloat(fabs((double)pdf / expected - 1), <, 2e-4);
            for (int m = 0; m < 2; m++) {
                spectrum f = bsdf_eval(&b, wo, wi, LOBE_ALL, MODES[m]);
                for (int wavelength = 0; wavelength < N_WAVELENGTHS; wavelength++)
                    g_assert_cmpfloat(f[wavelength], ==, pdf);
                g_assert_cmpfloat(bsdf_pdf(&b, wi, wo, LOBE_ALL, MODES[m]), ==, pdf);
            }
            g_assert_cmpfloat(bsdf_cosine(&b, wi), ==, 1.0f);
        }
    }
}

/* By midpoints over the turn, each at another azimuth. The substitution puts them where
   the peak is: cosine = ±(1 - 2 x³). */
static void test_moments(void)
{
    enum { N = 4000 };
    const frame about = frame_from_normal(normalize3(vec3_make(-0.4f, 0.7f, 0.2f)));
    for (size_t k = 0; k < G_N_ELEMENTS(GS); k++) {
        const bsdf b = phase_with(GS[k], ALL_WAVELENGTHS);
        double sum = 0, first = 0;
        for (int i = 0; i < N; i++) {
            double x = (i + 0.5) / N, cosine = 1 - 2 * x * x * x;
            if (GS[k] < 0)
                cosine = -cosine;
            vec3 wi = frame_to_world(&about, chi2_direction(cosine, 2.399963 * i));
            double p = (double)bsdf_pdf(&b, -about.n, wi, LOBE_ALL, MODES[i & 1]);
            double dp = p * 2 * G_PI * 6 * x * x / N;
            sum += dp, first += dp * cosine;
        }
        g_test_message("g = %g: %.6f, %.6f", (double)GS[k], sum, first);
        g_assert_cmpfloat(fabs(sum - 1), <, 1e-4);
        g_assert_cmpfloat(fabs(first - (double)GS[k]), <, 1e-4);
    }
}

typedef struct drawing {
    bsdf b;
    vec3 wo;
} drawing;

static bool draw(void *data, float u_lobe, vec2 u, vec3 *w)
{
    const drawing *d = data;
    bsdf_sample s;
    if (!bsdf_sample_direction(&d->b, d->wo, u_lobe, u, LOBE_ALL, TRANSPORT_RADIANCE, &s))
        return false;
    *w = s.wi;
    return true;
}

static float density(void *data, vec3 w)
{
    const drawing *d = data;
    return bsdf_pdf(&d->b, d->wo, w, LOBE_ALL, TRANSPORT_RADIANCE);
}

/* On the sphere, about an axis that is none of its own. */
static void test_follows_density(void)
{
    for (size_t k = 0; k < G_N_ELEMENTS(GS); k++) {
        drawing d = {phase_with(GS[k], ALL_WAVELENGTHS),
                     normalize3(vec3_make(0.3f, -0.5f, 0.4f))};
        double p = chi2_directions(draw, density, &d, 40000, 5 + k);
        if (p < TINY_P)
            g_error("g = %g: p = %g", (double)GS[k], p);
    }
}

/* The turn alone, in bins of equal probability by the closed form. */
static void test_follows_closed_form(void)
{
    enum { BINS = 200, N = 200000 };
    for (size_t k = 0; k < G_N_ELEMENTS(GS); k++) {
        drawing d = {phase_with(GS[k], ALL_WAVELENGTHS),
                     normalize3(vec3_make(-0.2f, 0.1f, 0.9f))};
        double counts[BINS] = {0}, expected[BINS];
        sampler s = sampler_make(hash_mix(3, k), 0);
        s.dimension = 1u << 20;
        for (int i = 0; i < N; i++) {
            vec3 wi = {0};
            vec2 u = sampler_2d(&s);
            g_assert_true(draw(&d, 0.0f, u, &wi));
            double c = cumulative((double)GS[k], turned_by(d.wo, wi));
            counts[CLAMP((int)(c * BINS), 0, BINS - 1)]++;
        }
        for (int i = 0; i < BINS; i++)
            expected[i] = (double)N / BINS;
        double p = chi2_p(counts, expected, BINS);
        if (p < TINY_P)
            g_error("g = %g: p = %g", (double)GS[k], p);
    }
}

/* What a draw says of itself, at the ends of the unit square too. */
static void check_draw(const bsdf *b, vec3 wo, vec2 u, transport_mode mode)
{
    bsdf_sample s;
    g_assert_true(bsdf_sample_direction(b, wo, 0.5f, u, LOBE_ALL, mode, &s));
    g_assert_cmpfloat(fabsf(length3(s.wi) - 1), <, 1e-5f);
    g_assert_cmpfloat(s.pdf, ==, bsdf_pdf(b, wo, s.wi, LOBE_ALL, mode));
    g_assert_true(isfinite(s.pdf) && s.pdf > 0);
    for (int wavelength = 0; wavelength < N_WAVELENGTHS; wavelength++)
        g_assert_cmpfloat(s.weight[wavelength], ==, 1.0f);
    g_assert_cmpint(s.wavelength, ==, b->wavelength);
    g_assert_cmpfloat(s.eta, ==, 1.0f);
    g_assert_cmpuint(s.lobe & ~b->lobes, ==, 0);
    g_assert_true(s.lobe & LOBE_DIFFUSE);
    g_assert_true(s.lobe & LOBE_ANY_SIDE);
}

static void test_draws(void)
{
    const float ends[] = {0.0f, 0x1p-24f, 0.5f, 0x1.fffffep-1f};
    const vec3 ways[] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0.6f, 0, 0.8f}};
    for (size_t k = 0; k < G_N_ELEMENTS(GS); k++)
        for (int i = 0; i < 4 * 4 * 4; i++)
            for (int m = 0; m < 2; m++) {
                const bsdf b = phase_with(GS[k], i % 3 ? ALL_WAVELENGTHS : 5);
                check_draw(&b, ways[i % 4], (vec2){ends[i / 4 % 4], ends[i / 16]},
                           MODES[m]);
            }
}

static void test_masks(void)
{
    static const struct {
        unsigned mask;
        bool there;
    } cases[] = {
        {LOBE_ALL, true},
        {LOBE_GATHERED, true},
        {LOBE_DIFFUSE | LOBE_REFLECTION, true},
        {LOBE_DIFFUSE | LOBE_TRANSMISSION, true},
        {LOBE_FOLLOWED, false},
        {LOBE_SPECULAR | LOBE_ANY_SIDE, false},
        {LOBE_GLOSSY | LOBE_ANY_SIDE, false},
        {LOBE_DIFFUSE, false},
        {LOBE_ANY_SIDE, false},
        {0, false},
    };
    const bsdf b = phase_with(0.4f, ALL_WAVELENGTHS);
    const vec3 wo = {0, 0, 1}, wi = {0.6f, 0, -0.8f};
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++)
        for (int m = 0; m < 2; m++) {
            bsdf_sample s;
            unsigned mask = cases[i].mask;
            bool there = cases[i].there;
            spectrum f = bsdf_eval(&b, wo, wi, mask, MODES[m]);
            g_assert_cmpint(!spectrum_is_black(f), ==, there);
            g_assert_cmpint(bsdf_pdf(&b, wo, wi, mask, MODES[m]) > 0, ==, there);
            g_assert_cmpint(
                bsdf_sample_direction(&b, wo, 0, (vec2){0.3f, 0.3f}, mask, MODES[m], &s),
                ==, there);
            spectrum albedo = bsdf_albedo(&b, wo, mask);
            for (int wavelength = 0; wavelength < N_WAVELENGTHS; wavelength++)
                g_assert_cmpfloat(albedo[wavelength], ==, there ? 1.0f : 0.0f);
        }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/phase/is-one-value", test_is_one_value);
    g_test_add_func("/phase/moments", test_moments);
    g_test_add_func("/phase/follows-density", test_follows_density);
    g_test_add_func("/phase/follows-closed-form", test_follows_closed_form);
    g_test_add_func("/phase/draws", test_draws);
    g_test_add_func("/phase/masks", test_masks);
    return g_test_run();
}
