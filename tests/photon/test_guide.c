/*
 * The guide of photon emission: whatever it learned, what is drawn with it stays an
 * unbiased sample of the cube, and what it saw few arrivals of is not drawn with weights
 * that show as bright dots.
 */
#include "photon/trace/guide.h"

#include <math.h>

enum { N = 1 << 16 };

/* Flux that starts at u and arrives: a slanted sheet, thin in two dimensions, as a small
   object seen from a wide lamp gives; and a faint patch elsewhere. */
static double flux_of(const float u[EMISSION_DIMENSIONS])
{
    bool sheet = fabsf(u[2] - u[4]) < 0.06f && fabsf(u[3] - u[5]) < 0.1f;
    bool patch = u[0] > 0.98f && u[4] < 0.1f;
    return sheet ? 1.0 : patch ? 0.3 : 0.0;
}

static size_t draw_records(const emission_guide *guide, uint64_t key,
                           emission_record records[N])
{
    size_t n = 0;
    for (uint32_t i = 0; i < N; i++) {
        sampler random = sampler_make(key, i);
        emission_record r;
        r.density = emission_guide_draw(guide, &random, r.u);
        r.value = (float)flux_of(r.u) / r.density;
        if (r.value > 0.0f)
            records[n++] = r;
    }
    return n;
}

static emission_guide *learned_guide(emission_record records[N])
{
    g_autoptr(emission_guide) guide = NULL;
    for (uint64_t round = 0; round < 4; round++) {
        size_t n = draw_records(guide, round, records);
        emission_guide_free(guide);
        guide = emission_guide_learn(records, n);
    }
    return g_steal_pointer(&guide);
}

/* The integral of the density over the cube is one, and a drawn point has it. */
static void test_density(void)
{
    g_autofree emission_record *records = g_new(emission_record, N);
    g_autoptr(emission_guide) guide = learned_guide(records);
    double sum = 0.0;
    for (uint32_t i = 0; i < N; i++) {
        float u[EMISSION_DIMENSIONS];
        sampler random = sampler_make(77, i);
        float density = emission_guide_draw(NULL, &random, u);
        g_assert_cmpfloat(density, ==, 1.0f);
        sum += (double)emission_guide_density(guide, u) / N;
        sampler drawn = sampler_make(78, i);
        density = emission_guide_draw(guide, &drawn, u);
        for (int a = 0; a < EMISSION_DIMENSIONS; a++)
            g_assert_true(u[a] >= 0.0f && u[a] < 1.0f);
        g_assert_cmpfloat(fabsf(emission_guide_density(guide, u) / density - 1.0f), <,
                          1e-4);
    }
    g_assert_cmpfloat(fabs(sum - 1.0), <, 0.05);
}

/* Closed form of flux_of's integral: the sheet, and of the patch what the sheet leaves.
 */
static double true_flux(void)
{
    const double near_2 = 1.0 - (1.0 - 0.06) * (1.0 - 0.06); /* P(|u2 - u4| < 0.06) */
    const double near_3 = 1.0 - (1.0 - 0.1) * (1.0 - 0.1);
    const double near_2_and_low = 0.06 * 0.06 * 1.5 + 0.04 * 0.12; /* and u4 < 0.1 */
    return near_2 * near_3 + 0.3 * 0.02 * (0.1 - near_2_and_low * near_3);
}

/* Flux drawn with the guide has the right mean (5 standard errors: one alarm in a
   million), much of it arrives, and no photon is so heavy that it shows. */
static void test_flux(void)
{
    g_autofree emission_record *records = g_new(emission_record, N);
    g_autoptr(emission_guide) guide = learned_guide(records);
    size_t n = draw_records(guide, 99, records);
    double sum = 0.0, sum2 = 0.0, heaviest = 0.0;
    for (size_t i = 0; i < n; i++) {
        double value = (double)records[i].value;
        sum += value;
        sum2 += value * value;
        heaviest = MAX(heaviest, value);
    }
    double mean = sum / N, error = sqrt((sum2 / N - mean * mean) / N);
    g_test_message("%zu of %d arrive, flux %g +- %g (%g), the heaviest weighs %.1f", n, N,
                   mean, error, true_flux(), heaviest * (double)n / sum);
    g_assert_cmpfloat(fabs(mean - true_flux()), <, 5.0 * error);
    g_assert_cmpfloat(error, <, 0.02 * mean);
    g_assert_cmpuint(n, >, N / 5);
    g_assert_cmpfloat(heaviest * (double)n / sum, <, 100.0);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/guide/density", test_density);
    g_test_add_func("/guide/flux", test_flux);
    return g_test_run();
}
