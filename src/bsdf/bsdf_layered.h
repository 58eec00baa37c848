/*
 * The walk of light between a coat's face and the base under it, by which bsdf_layered.c
 * evaluates. Local directions, above: z > 0.
 */
#pragma once

#include "bsdf/bsdf_models.h"

/** @brief Light by way of the base or the coat's particles, in two parts. */
typedef struct layered_light {
    spectrum clear;  /**< by the metal's facets and the coat's face alone */
    spectrum cloudy; /**< by particles, or by a diffuse base */
} layered_light;

/** @brief f(o, i) without the coat's own reflection: the mean of n_walks random walks.
 * The same to the bit for o and i exchanged. metal_eta and metal_k are over the coat's.
 */
layered_light layered_inside(const coat_layers *l, vec3 o, vec3 i);

/** @brief Of light from o, the share that comes out again without the coat's own
 * reflection, by so many walks. */
layered_light layered_escaping(const coat_layers *l, vec3 o, int n);
