/*
 * Goodness of fit: does a sampler draw with the density it claims?
 *
 * Directions are counted in bins of equal solid angle; the density is integrated over
 * each bin by adaptive quadrature. What is not drawn (absorbed, rejected or specular) is
 * one bin more, whose share is what is missing from one. Pearson's χ² then tells the
 * probability of counts at least this far off.
 */
#pragma once

#include "math/sampler.h"

#include <glib.h>
#include <string.h>

enum { CHI2_ROWS = 12, CHI2_COLUMNS = 24, CHI2_BINS = CHI2_ROWS * CHI2_COLUMNS };

/** @brief Draws one direction from u; false: nothing drawn. */
typedef bool (*chi2_draw)(void *data, float u_lobe, vec2 u, vec3 *w);
/** @brief pdf_solid_angle of drawing w. */
typedef float (*chi2_density)(void *data, vec3 w);

/** @brief P(χ²_k >= x) by Wilson and Hilferty's cube root, good to the tails for k > 10.
 */
static inline double chi2_tail(double x, int degrees)
{
    double k = 2.0 / (9.0 * degrees);
    return 0.5 * erfc((cbrt(x / degrees) - (1.0 - k)) / sqrt(2.0 * k));
}

/** @brief p-value of counts against expectations; bins that expect fewer than ten are
 * put together. */
static inline double chi2_p(const double *counts, const double *expected, int n)
{
    double x = 0.0, few = 0.0, few_expected = 0.0;
    int bins = 0;
    for (int i = 0; i < n; i++) {
        if (expected[i] < 10.0) {
            few += counts[i];
            few_expected += expected[i];
            continue;
        }
        x += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
        bins++;
    }
    if (few_expected > 1.0 || few > 0.0) {
        x += (few - few_expected) * (few - few_expected) / fmax(few_expected, 0.5);
        bins++;
    }
    return bins > 1 ? chi2_tail(x, bins - 1) : 1.0;
}

static inline vec3 chi2_direction(double z, double phi)
{
    double r = sqrt(fmax(0.0, 1.0 - z * z));
    return vec3_make((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z);
}

static inline double chi2_midpoints(chi2_density density, void *data, const double box[4])
{
    enum { N = 4 };
    double sum = 0.0, dz = (box[1] - box[0]) / N, dphi = (box[3] - box[2]) / N;
    for (int i = 0; i < N * N; i++)
        sum += (double)density(data, chi2_direction(box[0] + (i / N + 0.5) * dz,
                                                    box[2] + (i % N + 0.5) * dphi));
    return sum * dz * dphi;
}

/** @brief ∫ density over z in [box0, box1], phi in [box2, box3]. */
static inline double chi2_integral(chi2_density density, void *data, const double box[4],
                                   int depth)
{
    double z = 0.5 * (box[0] + box[1]), phi = 0.5 * (box[2] + box[3]), sum = 0.0;
    double parts[4][4] = {{box[0], z, box[2], phi},
                          {box[0], z, phi, box[3]},
                          {z, box[1], box[2], phi},
                          {z, box[1], phi, box[3]}};
    double coarse = chi2_midpoints(density, data, box), fine[4];
    for (int i = 0; i < 4; i++)
        sum += fine[i] = chi2_midpoints(density, data, parts[i]);
    if (depth >= 1 && (depth >= 7 || fabs(sum - coarse) < 1e-5 + 1e-3 * sum))
        return sum;
    sum = 0.0;
    for (int i = 0; i < 4; i++)
        sum += chi2_integral(density, data, parts[i], depth + 1);
    return sum;
}

static inline int chi2_bin(vec3 w)
{
    double phi = atan2((double)w[1], (double)w[0]) / (2.0 * G_PI);
    int row = (int)((1.0 + (double)w[2]) * 0.5 * CHI2_ROWS);
    int column = (int)((phi < 0.0 ? phi + 1.0 : phi) * CHI2_COLUMNS);
    return CLAMP(row, 0, CHI2_ROWS - 1) * CHI2_COLUMNS +
           CLAMP(column, 0, CHI2_COLUMNS - 1);
}

/** @brief p-value of n draws against the density. */
static inline double chi2_directions(chi2_draw draw, chi2_density density, void *data,
                                     int n, uint64_t seed)
{
    double counts[CHI2_BINS + 1] = {0}, expected[CHI2_BINS + 1], total = 0.0;
    for (int i = 0; i < CHI2_BINS; i++) {
        int row = i / CHI2_COLUMNS, column = i % CHI2_COLUMNS;
        double box[4] = {2.0 * row / CHI2_ROWS - 1.0, 2.0 * (row + 1) / CHI2_ROWS - 1.0,
                         2.0 * G_PI * column / CHI2_COLUMNS,
                         2.0 * G_PI * (column + 1) / CHI2_COLUMNS};
        expected[i] = n * chi2_integral(density, data, box, 0);
        total += expected[i];
    }
    expected[CHI2_BINS] = fmax(0.0, n - total);
    for (int i = 0; i < n; i++) {
        /* Hashed numbers: χ² presumes independent draws. */
        sampler s = {.key = hash_mix(seed, (uint64_t)i), .dimension = 1u << 20};
        vec3 w;
        float u_lobe = sampler_1d(&s);
        vec2 u = sampler_2d(&s);
        counts[draw(data, u_lobe, u, &w) ? chi2_bin(w) : CHI2_BINS]++;
    }
    return chi2_p(counts, expected, CHI2_BINS + 1);
}
