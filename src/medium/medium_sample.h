/*
 * Drawing where on a ray through a medium light is scattered.
 *
 * The density is a mixture of those of the wavelengths by what each carries, so the
 * weighted throughput never exceeds its sum before (Wilkie et al., "Hero Wavelength
 * Spectral Sampling", 2014, for distances).
 *
 * Light from a light in the medium falls off with the squared distance from it, and
 * points near it would be found too seldom. Where one is known, a part of the points is
 * drawn in proportion to that, equally by the angle under which the light sees what it
 * can light of the ray (Kulla & Fajardo, "Importance Sampling Techniques for Path Tracing
 * in Participating Media", 2012), and weighed by the density of both together.
 */
#pragma once

#include "math/cone.h"
#include "medium/medium.h"

/** @brief Where light is scattered next. */
typedef struct medium_sample {
    bool scatters;   /**< false: not before t_max */
    float t;         /**< m, < t_max */
    spectrum weight; /**< to multiply a path's throughput with: σs T(t) over the density
                        of t, or T(t_max) over the probability of getting there */
} medium_sample;

/** @brief Draws a free path in a medium that scatters.
 *  @param throughput of the path, by wavelength
 *  @param u uniform in [0,1) */
medium_sample medium_sample_free(const medium *m, const wavelengths *w,
                                 spectrum throughput, float t_max, float u);
/** @brief The same, but always before t_max: weight is σs T(t) over that density. */
medium_sample medium_sample_within(const medium *m, const wavelengths *w,
                                   spectrum throughput, float t_max, float u);

/** @brief A point that light comes from, as a ray passes it. */
typedef struct medium_pivot {
    float t;        /**< m along the ray, where it is nearest; may be < 0 */
    float distance; /**< m, > 0: there */
    line_span lit;  /**< of the ray: where light comes from it at all */
} medium_pivot;

/** @brief How a ray passes a point. @param lit not empty, as far as the medium reaches */
medium_pivot medium_pivot_at(const ray *r, vec3 p, line_span lit);

/** @brief medium_sample_free with points near the pivot drawn more often; the more so the
 * more is scattered at all. */
medium_sample medium_sample_free_near(const medium *m, const wavelengths *w,
                                      spectrum throughput, float t_max,
                                      const medium_pivot *pivot, float u);
/** @brief The same of medium_sample_within. */
medium_sample medium_sample_within_near(const medium *m, const wavelengths *w,
                                        spectrum throughput, float t_max,
                                        const medium_pivot *pivot, float u);
