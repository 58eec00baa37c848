/*
 * Guided emission: photons are started where they will land in the class that is wanted,
 * on surfaces that the camera sees.
 *
 * Every light turns six uniform numbers into a photon (which light, which part of it,
 * where on it, which way). A binary tree over that unit cube holds the flux that starts
 * in each cell and arrives usefully; numbers are drawn from the tree instead of uniformly
 * and the flux is divided by the density. So one mechanism serves all lights, many of
 * them, and any correlation between position and direction; a defensive share of uniform
 * numbers keeps every path possible.
 *
 *       ┌───┴───┐     split in the middle of the axis along which
 *     ┌─┴─┐   ┌─┴─┐   arrivals are least even; a drawn number is stretched
 *      ...     ...    on its way down, so that its stratification survives
 *
 * Jensen's projection maps (1996) and the histograms of Grittmann et al. ("Efficient
 * Caustic Rendering with Lightweight Photon Mapping", 2018), in primary sample space.
 */
#pragma once

#include "base/bytes.h"
#include "base/parallel.h"
#include "math/sampler.h"

#include <glib.h>

/** math: of a start: light, primitive, position (2), direction (2) */
enum { EMISSION_DIMENSIONS = 6 };

/** The share that what is not known gets. Of photons, and of each cell's, so many are
 * drawn without regard to what was learned inside it: next to where much arrives it thins
 * out step by step, and what arrives from there unforeseen is not much heavier than its
 * neighbours. Of two sides of glass that the eye's path may go on by each gets so much at
 * least. A photon that lands out of the camera's sight is worth this share of one in
 * sight: it may still be seen by way of other surfaces. Of classes that share photons
 * none gets less than this share of what another gets. With half as much relMSE x time
 * is 1.3 times as much by auto in a Cornell box with glass, alike by sppm and in ball,
 * water, fog and scenes/ring; with twice as much it is alike in all of them (128 x 128, 4
 * and 8 passes, three seeds). */
#define DEFENSIVE_SHARE 0.05f

typedef struct emission_guide emission_guide;

/** @brief A photon that arrived usefully: where it started, and what it was worth. */
typedef struct emission_record {
    float u[EMISSION_DIMENSIONS];
    float value;   /**< useful flux, already over the density it was drawn with; > 0 */
    float density; /**< that density */
} emission_record;

void emission_guide_free(emission_guide *guide);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(emission_guide, emission_guide_free)

/** @brief A guide by n records, which are put in another order: cells are split where
 * arrivals crowd. @param n 0: one that draws uniformly @return owned */
emission_guide *emission_guide_learn(emission_record *records, size_t n);

/** @brief Draws the six numbers. @param guide NULL: uniform
 *  @return the density they were drawn with, > 0, mean of 1/density is 1 */
float emission_guide_draw(const emission_guide *guide, sampler *random,
                          float u[EMISSION_DIMENSIONS]);

/** @brief Density at a point of the cube. */
float emission_guide_density(const emission_guide *guide,
                             const float u[EMISSION_DIMENSIONS]);

/** @brief Appends the guide, which may be NULL. */
void emission_guide_put(const emission_guide *guide, GByteArray *to);
/** @brief Reads what emission_guide_put wrote. @return owned; NULL: there was none, or
 * the reader has failed */
emission_guide *emission_guide_get(bytes_reader *from);
