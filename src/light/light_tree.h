/*
 * Which light to sample at a point: in proportion to about how much each sends there, so
 * that a small light nearby is not forgotten beside a wide environment, and many lights
 * cost little.
 *
 *   environment and distant lights ── a short list, each with its irradiance
 *   all others ── a binary tree over their places; a node is worth Φ / (4π max(d², r²)),
 *                 Φ its power, r the radius of its bounding sphere, d the way to its
 * centre
 *
 * Conty Estevez & Kulla, "Importance Sampling of Many Lights with Adaptive Tree
 * Splitting", 2018, without the cones of normals.
 */
#pragma once

#include "math/box.h"

#include <glib.h>

/** @brief What the choice knows of a light. */
typedef struct light_bound {
    bool is_local;    /**< has a place; else irradiance is the same everywhere */
    box3 box;         /**< of a local light */
    float power;      /**< of a local light, mean over wavelengths */
    float irradiance; /**< of another: on a plane that faces it */
} light_bound;

typedef struct light_tree light_tree;

light_tree *light_tree_new(const light_bound *bounds, int n);
void light_tree_free(light_tree *tree);
/** @brief Picks a light for the point ref; *u, uniform in [0,1), is used up.
 *  @return its index with its probability, or -1 if no light sends anything */
int light_tree_sample(const light_tree *tree, vec3 ref, float u, float *probability);
/** @brief The probability with which light_tree_sample picks light i at ref. */
float light_tree_probability(const light_tree *tree, vec3 ref, int i);
/** @brief Sum over the local lights whose box holds a place of what `ask` says of each,
 *  times the probability with which light_tree_sample picks it at ref. */
float light_tree_sum_at(const light_tree *tree, vec3 ref, vec3 place,
                        float (*ask)(const void *data, int light), const void *data);
