/*
 * How close points lie, from the nearest: a patch of a few is told by itself, however far
 * the next one is, and points that lie evenly are told as by all of them.
 */
#include "math/sampler.h"
#include "transport/radius_cache.h"

#include <glib.h>

enum { N_CASES = 2000 };

/* Evenly in a disc of radius 1 about the place that is asked, which is the first. */
static void fill(float distance2[], size_t n, sampler *random)
{
    for (size_t i = 0; i < n; i++)
        distance2[i] = i == 0 ? 0.0f : sampler_1d(random);
}

static point_hits hits_of(float distance2[], size_t n)
{
    return (point_hits){.n = n, .distance2 = distance2};
}

/* In patches of so many, the next one ten radii away: the area of the disc that would
   hold RADIUS_NEAREST at the patch's density, told over true, the mean of many. */
static double area_told(float (*told)(const point_hits *), size_t in_patch)
{
    double sum = 0.0;
    for (int i = 0; i < N_CASES; i++) {
        sampler random = sampler_make(in_patch, (uint32_t)i);
        float distance2[RADIUS_NEAREST];
        fill(distance2, in_patch, &random);
        for (size_t k = in_patch; k < RADIUS_NEAREST; k++)
            distance2[k] = 100.0f + sampler_1d(&random);
        const point_hits hits = hits_of(distance2, RADIUS_NEAREST);
        float r = told(&hits);
        sum += (double)(r * r) * (double)in_patch / RADIUS_NEAREST / N_CASES;
    }
    return sum;
}

static void test_even(void)
{
    double all = area_told(radius_of_nearest, RADIUS_NEAREST);
    double patch = area_told(radius_in_patch, RADIUS_NEAREST);
    g_test_message("all %g, in patch %g of the disc's area", all, patch);
    g_assert_cmpfloat(patch, <=, all);
    g_assert_cmpfloat(patch, >, 0.9 * all);
}

/* However many are in it, if a quarter or more; each of two steps to fewer adds half as
   much again, and all of them would tell of the next patch. */
static void test_patches(void)
{
    for (size_t n = RADIUS_NEAREST / 4; n < RADIUS_NEAREST; n++) {
        double told = area_told(radius_in_patch, n);
        g_test_message("%zu: %g", n, told);
        g_assert_cmpfloat(told, >, 0.9);
        g_assert_cmpfloat(told, <, 2.5);
        g_assert_cmpfloat(area_told(radius_of_nearest, n), >, 20.0);
    }
}

/* A focus is as fine as may be, and not as where there is nothing. */
static void test_one_place(void)
{
    float distance2[RADIUS_NEAREST] = {0.0f};
    const point_hits hits = hits_of(distance2, RADIUS_NEAREST);
    g_assert_cmpfloat(radius_in_patch(&hits), ==, 0.0f);
    distance2[RADIUS_NEAREST - 1] = 1.0f;
    g_assert_cmpfloat(radius_in_patch(&hits), >, 0.0f);
    g_assert_cmpfloat(radius_in_patch(&hits), <, 1e-6f);
}

/* Fewer than are asked for, and none. */
static void test_few(void)
{
    float distance2[] = {9.0f, 0.0f, 4.0f};
    point_hits hits = hits_of(distance2, 3);
    float widened = 3.0f * sqrtf(RADIUS_NEAREST / 3.0f);
    g_assert_cmpfloat_with_epsilon(radius_of_nearest(&hits), widened, 1e-5f);
    g_assert_cmpfloat_with_epsilon(radius_in_patch(&hits), widened, 1e-5f);
    hits.n = 0;
    g_assert_cmpfloat(radius_of_nearest(&hits), ==, 0.0f);
    g_assert_cmpfloat(radius_in_patch(&hits), ==, 0.0f);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/radius-cache/even", test_even);
    g_test_add_func("/radius-cache/patches", test_patches);
    g_test_add_func("/radius-cache/one-place", test_one_place);
    g_test_add_func("/radius-cache/few", test_few);
    return g_test_run();
}
