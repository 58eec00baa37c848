/*
 * Weights of vertex connection and merging, known from quantities that grow along each
 * subpath (Georgiev, "Implementing Vertex Connection and Merging", 2012).
 *
 * The weight of a strategy is 1 / Σ p_i / p, over all strategies i that find the same
 * path. With light and camera subpath apart the sum is light + 1 + camera, and each part
 * follows from three numbers at the subpath's last vertex and the densities there:
 *
 *   vcm_1 = (p0 connected / p0 traced) / p_1   vc_1 = g0 / (p0 p_1)      vm_1 = vc_1 / η
 *   vcm_i = 1 / p_i
 *   vc_i  = g_{i-1} / p_i (η a_{i-1} + vcm_{i-1} + p'_{i-2} vc_{i-1})
 *   vm_i  = g_{i-1} / p_i (a_{i-1} + vcm_{i-1} / η + p'_{i-2} vm_{i-1}),     η = π r² N
 *
 * p: densities per area in the subpath's direction, p': per solid angle against it, g:
 * cos / d². At a mirror vcm is zero, and p and p' cancel. Cosines are those of the
 * geometric normals, for areas are (Veach 1997, §5.3). What roulette leaves out, it
 * leaves out of all strategies nearly alike, so it has no part in the weights.
 *
 * Merging counts as N samples by η, but the light vertices it finds at once all hang on
 * the one camera subpath that led there: however many they are, they find no more than it
 * does. So where K of them lie within reach, merging there counts as K / (1 + K) samples
 * of the place instead of K: a = 1 / (1 + K). (For the variance of a merge is that of its
 * photons plus that of its place. Correlation in these weights: Grittmann, Georgiev &
 * Slusallek, "Correlation-Aware Multiple Importance Sampling for Bidirectional Rendering
 * Algorithms", 2021.) The first place the eye sees is no matter of chance: there a = 1.
 */
#pragma once

#include "scene/scene.h"

/** @brief The three numbers at a vertex (the report's dVCM, dVC, dVM). */
typedef struct partial_weights {
    float vcm, vc, vm;
} partial_weights;

/** @brief How merging stands to connecting, with zero for a strategy that does not run.
 */
typedef struct strategy_ratios {
    float merge;   /**< η */
    float connect; /**< 1 / η */
} strategy_ratios;

/** @brief How a light could have sent light to a vertex. */
typedef struct light_start {
    const light *light;
    float p_traced; /**< probability that a light subpath starts from it */
    vec3 p, n; /**< point and normal on the light; n = direction where there is none */
    vec3 direction;  /**< from the light to the vertex, unit */
    float distance2; /**< between them, m² */
    float pdf;    /**< pdf_solid_angle with which the vertex is connected to p, with the
                     choice of the light; for delta lights that choice alone */
    float cosine; /**< geometric, at the vertex */
} light_start;

/** @brief Density with which the light's subpaths arrive at the vertex over that with
 * which the vertex is connected to the light. */
float light_start_traced_over_connected(const light_start *start);

/** @brief The weights at a light subpath's first vertex. */
partial_weights weights_from_light(const light_start *start,
                                   const strategy_ratios *ratios);

/** @brief Arrives at the next vertex, at a distance of sqrt(distance2), under the
 * geometric cosine there. */
void weights_arrive(partial_weights *w, float distance2, float cosine);

/** @brief Goes on from a vertex under the geometric cosine, with the density pdf per
 * solid angle; the reverse is sampled with pdf_reverse. @param alone a of that vertex */
void weights_bounce(partial_weights *w, float cosine, float pdf, float pdf_reverse,
                    const strategy_ratios *ratios, float alone);

/** @brief The same at a mirror. */
void weights_bounce_specular(partial_weights *w, float cosine);

/** @brief One subpath's share of the sum when its end is connected: the other side makes
 * this end with density pdf_area, and goes on with pdf_reverse. */
static inline float weights_connected(const partial_weights *w, float pdf_area,
                                      float pdf_reverse, const strategy_ratios *ratios,
                                      float alone)
{
    return pdf_area * (ratios->merge * alone + w->vcm + pdf_reverse * w->vc);
}

/** @brief The same when it is merged. */
static inline float weights_merged(const partial_weights *w, float pdf_reverse,
                                   const strategy_ratios *ratios, float alone)
{
    return (w->vcm * ratios->connect + pdf_reverse * w->vm) / alone;
}

/** @brief The weight of a camera subpath that ran into a light, where w are those of its
 * arrival there: the light could have been connected to with density `connected`, and
 * traced from with density `traced` of place and direction (both with its choice). */
static inline float weights_met(const partial_weights *w, float connected, float traced)
{
    return 1.0f / (1.0f + connected * w->vcm + traced * w->vc);
}
