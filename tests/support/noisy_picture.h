/*
 * Pictures of which the truth is known, in two halves with noise of known size.
 */
#pragma once

#include <glib.h>
#include <math.h>

enum { W = 75, H = 61, N = W * H };

/* A truth and two noisy halves of it. */
typedef struct picture {
    float truth[3 * N], half[2][3 * N], variance[N], out[3 * N];
} picture;

typedef float (*pattern)(int x, int y);

static inline float slope(int x, int y)
{
    return 0.5f + 0.01f * (float)x + 0.005f * (float)y;
}

/* Fine detail that no feature tells of. */
static inline float detail(int x, int y)
{
    return 1.0f + 0.5f * sinf(1.1f * (float)x) * cosf(0.9f * (float)y);
}

static inline double normal(GRand *random)
{
    double u = 1.0 - g_rand_double(random);
    return sqrt(-2.0 * log(u)) * cos(2.0 * G_PI * g_rand_double(random));
}

/* @param sigma of the mean of both halves, relative */
static inline picture *noisy(pattern what, double sigma, guint32 seed)
{
    picture *p = g_new0(picture, 1);
    g_autoptr(GRand) random = g_rand_new_with_seed(seed);
    for (int i = 0; i < N; i++) {
        float value = what(i % W, i / W);
        p->variance[i] = (float)(sigma * sigma) * value * value;
        for (int c = 0; c < 3; c++)
            p->truth[3 * i + c] = value * (c == 1 ? 1.0f : 0.8f);
        for (int h = 0; h < 2; h++) {
            double scale = 1.0 + sigma * sqrt(2.0) * normal(random);
            for (int c = 0; c < 3; c++)
                p->half[h][3 * i + c] = p->truth[3 * i + c] * (float)scale;
        }
    }
    return p;
}
