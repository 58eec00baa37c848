/*
 * A naive twin of light in fog, to hold the renderer to: one homogeneous medium in one
 * convex body, black space around it, one lamp far away or in a point. A walk from the
 * eye goes as far as an analogue free path says, at each scattering looks at the lamp
 * and goes on as the phase function says. Scalar, in double, with its own random numbers;
 * and single scattering by quadrature, to hold the twin to.
 */
#pragma once

#include <glib.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

enum { TWIN_ORDERS = 3 };

typedef struct twin {
    double sigma_a, sigma_s, g;
    double radius;    /* of a ball around the origin; 0: a slab instead ... */
    double thickness; /* ... of all with 0 <= z <= thickness; 0: endless */
    bool distant;     /* the lamp shines from a direction */
    double lamp[3];   /* its place, or the unit direction toward it */
    double strength;  /* intensity of a point, or irradiance across the beam */
} twin;

/* What the eye sees. */
typedef struct twin_result {
    double sum, error;         /* of all orders, with its standard error */
    double order[TWIN_ORDERS]; /* light scattered once, twice ... */
} twin_result;

static inline double twin_random(uint64_t *state)
{
    uint64_t x = *state += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return (double)((x ^ (x >> 31)) >> 11) * 0x1p-53;
}

static inline double twin_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Light turned by an angle of this cosine. */
static inline double twin_phase(double g, double cosine)
{
    return (1 - g * g) / (4 * G_PI * pow(1 + g * g - 2 * g * cosine, 1.5));
}

/* The part of a line within the body, from 0 on; false: none. */
static inline bool twin_span(const twin *t, const double p[3], const double d[3],
                             double *from, double *to)
{
    *from = 0, *to = INFINITY;
    if (t->radius > 0) {
        double b = twin_dot(p, d), c = twin_dot(p, p) - t->radius * t->radius;
        double root = b * b - c;
        if (root < 0)
            return false;
        *from = -b - sqrt(root), *to = -b + sqrt(root);
    } else if (t->thickness > 0 && fabs(d[2]) > 1e-12) {
        double near = -p[2] / d[2], far = (t->thickness - p[2]) / d[2];
        *from = fmin(near, far), *to = fmax(near, far);
    }
    *from = fmax(*from, 0);
    return *to > *from;
}

/* Light of the lamp that is scattered at p out of its way towards -d, over σs. */
static inline double twin_lamp(const twin *t, const double p[3], const double d[3])
{
    double to[3], distance = INFINITY, in = t->strength, from, out;
    for (int i = 0; i < 3; i++)
        to[i] = t->distant ? t->lamp[i] : t->lamp[i] - p[i];
    if (!t->distant) {
        distance = sqrt(twin_dot(to, to));
        in /= distance * distance;
        for (int i = 0; i < 3; i++)
            to[i] /= distance;
    }
    twin_span(t, p, to, &from, &out);
    /* Light goes on by -to before, by -d after. */
    return in * twin_phase(t->g, twin_dot(to, d)) *
           exp(-(t->sigma_a + t->sigma_s) * fmin(out, distance));
}

/* By Henyey and Greenstein's function about d. */
static inline void twin_turn(double g, double d[3], uint64_t *state)
{
    double u = twin_random(state), phi = 2 * G_PI * twin_random(state);
    double s = (1 - g * g) / (1 - g + 2 * g * u);
    double cosine = fabs(g) < 1e-6 ? 2 * u - 1 : (1 + g * g - s * s) / (2 * g);
    double sine = sqrt(fmax(0, 1 - cosine * cosine));
    double a[3] = {0}, b[3], length = 0;
    a[fabs(d[0]) < 0.7 ? 0 : 1] = 1;
    double along = twin_dot(a, d);
    for (int i = 0; i < 3; i++) {
        a[i] -= along * d[i];
        length += a[i] * a[i];
    }
    for (int i = 0; i < 3; i++)
        a[i] /= sqrt(length);
    for (int i = 0; i < 3; i++)
        b[i] = d[(i + 1) % 3] * a[(i + 2) % 3] - d[(i + 2) % 3] * a[(i + 1) % 3];
    for (int i = 0; i < 3; i++)
        d[i] = cosine * d[i] + sine * (cos(phi) * a[i] + sin(phi) * b[i]);
}

static inline void twin_walk(const twin *t, const double eye[3], const double way[3],
                             uint64_t *state, double order[TWIN_ORDERS], double *sum)
{
    double p[3] = {eye[0], eye[1], eye[2]}, d[3] = {way[0], way[1], way[2]}, from, to;
    double sigma_t = t->sigma_a + t->sigma_s, weight = 1;
    for (int n = 0; twin_span(t, p, d, &from, &to); n++) {
        double step = from - log(1 - twin_random(state)) / sigma_t;
        if (step >= to)
            return;
        for (int i = 0; i < 3; i++)
            p[i] += step * d[i];
        weight *= t->sigma_s / sigma_t;
        double seen = weight * twin_lamp(t, p, d);
        *sum += seen;
        if (n < TWIN_ORDERS)
            order[n] += seen;
        if (weight < 1e-4)
            return; /* what is cut off is far below the noise */
        twin_turn(t->g, d, state);
    }
}

/* Mean of n walks from the eye along a unit direction. */
static inline twin_result twin_radiance(const twin *t, const double eye[3],
                                        const double way[3], int n, uint64_t seed)
{
    twin_result out = {0};
    double squares = 0;
    uint64_t state = seed * 0x632be59bd9b4e019u;
    for (int i = 0; i < n; i++) {
        double seen = 0;
        twin_walk(t, eye, way, &state, out.order, &seen);
        out.sum += seen / n;
        squares += seen * seen / n;
    }
    for (int i = 0; i < TWIN_ORDERS; i++)
        out.order[i] /= n;
    out.error = sqrt((squares - out.sum * out.sum) / n);
    return out;
}

/* Light that is scattered once, by midpoints in what the fog leaves of the way. */
static inline double twin_single(const twin *t, const double eye[3], const double way[3])
{
    enum { N = 20000 };
    double from, to, sum = 0, sigma_t = t->sigma_a + t->sigma_s;
    if (!twin_span(t, eye, way, &from, &to))
        return 0;
    double lost = -expm1(-sigma_t * (to - from));
    for (int i = 0; i < N; i++) {
        double s = from - log1p(-lost * (i + 0.5) / N) / sigma_t;
        double p[3] = {eye[0] + s * way[0], eye[1] + s * way[1], eye[2] + s * way[2]};
        sum += twin_lamp(t, p, way);
    }
    return t->sigma_s * sum / N * lost / sigma_t;
}
