/*
 * A histogram of luminance in eighths of a stop tells the shares: one walk over the
 * pixels, and no more exact than an eye is.
 */
#include "image/exposure.h"

#include "image/layers.h"

#include <math.h>

enum { LEAST_STOP = -64, N_STOPS = 128, STEPS = 8, N_BINS = N_STOPS * STEPS };

#define BLACK_STOPS (-6.643856f) /* 1 % of white */
#define AIM_STOPS (-1.0f)        /* half of white */

typedef struct histogram {
    size_t bins[N_BINS], n;
} histogram;

static void count(histogram *h, const float *pixel, const int channel[3])
{
    float y = 0.2126f * pixel[channel[0]] + 0.7152f * pixel[channel[1]] +
              0.0722f * pixel[channel[2]];
    if (!(y > 0.0f) || !isfinite(y))
        return;
    int bin = (int)floorf((log2f(y) - LEAST_STOP) * STEPS);
    h->bins[CLAMP(bin, 0, N_BINS - 1)]++;
    h->n++;
}

/* Stops over white that this share of the pixels is below. */
static float stops_of(const histogram *h, double share)
{
    size_t below = 0;
    for (int i = 0; i < N_BINS; i++) {
        below += h->bins[i];
        if ((double)below >= share * (double)h->n)
            return LEAST_STOP + ((float)i + 0.5f) / STEPS;
    }
    return 0.0f;
}

exposure_state image_exposure(const image *img, float stops, float *better)
{
    image_shown shown;
    size_t n_pixels = (size_t)img->width * (size_t)img->height;
    *better = stops;
    if (!image_find_shown(img, &shown) || image_channel(img, "R") < 0)
        return EXPOSURE_GOOD;
    g_autofree histogram *h = g_new0(histogram, 1);
    for (size_t i = 0; i < n_pixels; i++)
        count(h, img->pixels + i * (size_t)img->n_channels, shown.rgba);
    if (h->n == 0)
        return EXPOSURE_BLACK;
    float high = stops_of(h, 0.9), low = stops_of(h, 0.25);
    bool is_dark = high + stops<BLACK_STOPS, is_bright = low + stops> 0.0f;
    if (!is_dark && !is_bright)
        return EXPOSURE_GOOD;
    *better = rintf(4.0f * (AIM_STOPS - high)) / 4.0f;
    return is_dark ? EXPOSURE_DARK : EXPOSURE_BRIGHT;
}
