/*
 * exposure: what is said of pictures whose shares of dark and bright are known, and that
 * the exposure suggested puts nine tenths of what is lit below half of white.
 */
#include "image/exposure.h"

#include <math.h>

/* So many pixels of each luminance, by tens of a hundred. */
typedef struct shares {
    const char *what;
    int tenths[4];
    float y[4];
    exposure_state at_zero;
    float better; /* stops */
} shares;

static image *picture_of(const shares *s)
{
    static const char *const names[] = {"R", "G", "B"};
    image *img = image_new(10, 10, 3, names, NULL);
    int at = 0;
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < 10 * s->tenths[k]; i++, at++)
            for (int c = 0; c < 3; c++)
                img->pixels[3 * at + c] = s->y[k];
    return img;
}

static const shares cases[] = {
    {"a usual picture", {5, 5}, {0.2f, 0.5f}, EXPOSURE_GOOD, 0.0f},
    {"a room at night", {9, 1}, {0.015f, 0.5f}, EXPOSURE_GOOD, 0.0f},
    {"nothing", {10}, {0.0f}, EXPOSURE_BLACK, 0.0f},
    {"a sun of 1/683", {10}, {1.0f / 1024}, EXPOSURE_DARK, 9.0f},
    {"a lamp in the dark", {9, 1}, {1.0f / 1024, 8.0f}, EXPOSURE_DARK, 9.0f},
    {"in front of nothing", {8, 2}, {0.0f, 1.0f / 1024}, EXPOSURE_DARK, 9.0f},
    {"lit in front of nothing", {9, 1}, {0.0f, 0.5f}, EXPOSURE_GOOD, 0.0f},
    {"in the sun", {2, 8}, {100.0f, 16384.0f}, EXPOSURE_BRIGHT, -15.0f},
    {"half white", {5, 5}, {0.2f, 16.0f}, EXPOSURE_GOOD, 0.0f},
    {"not finite", {8, 2}, {NAN, 0.5f}, EXPOSURE_GOOD, 0.0f},
    {"infinite", {8, 2}, {INFINITY, 1.0f / 1024}, EXPOSURE_DARK, 9.0f},
};

static void test_states(void)
{
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autoptr(image) img = picture_of(&cases[i]);
        float better;
        g_test_message("%s", cases[i].what);
        g_assert_cmpint(image_exposure(img, 0.0f, &better), ==, cases[i].at_zero);
        g_assert_cmpfloat(fabsf(better - cases[i].better), <, 0.3f);
    }
}

/* What is suggested is good, and what was good is not at an absurd exposure. */
static void test_better_is_good(void)
{
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autoptr(image) img = picture_of(&cases[i]);
        float better, same;
        exposure_state at_zero = image_exposure(img, 0.0f, &better);
        if (at_zero == EXPOSURE_BLACK)
            continue;
        g_assert_cmpint(image_exposure(img, better, &same), ==, EXPOSURE_GOOD);
        g_assert_cmpfloat(fabsf(same - better), <, 1e-6f);
        g_assert_cmpint(image_exposure(img, -30.0f, &same), ==, EXPOSURE_DARK);
        g_assert_cmpint(image_exposure(img, 30.0f, &same), ==, EXPOSURE_BRIGHT);
    }
}

static void test_other_channels(void)
{
    static const char *const names[] = {"Y"};
    g_autoptr(image) img = image_new(2, 2, 1, names, NULL);
    float better;
    g_assert_cmpint(image_exposure(img, 2.0f, &better), ==, EXPOSURE_GOOD);
    g_assert_cmpfloat(fabsf(better - 2.0f), <, 1e-6f);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/exposure/states", test_states);
    g_test_add_func("/exposure/better-is-good", test_better_is_good);
    g_test_add_func("/exposure/other-channels", test_other_channels);
    return g_test_run();
}
