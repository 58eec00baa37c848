/*
 * What a dielectric coat does to light on its way to the base and back, tabulated when a
 * material is made.
 *
 *   above   μ ──┬── reflected(μ)              η, GGX alpha, thickness
 *   coat        └── crossing(μ) ──► base      absorbed on the way: exp(-thickness / cos)
 *               base ──► internal ──► base, or ──► escape ──► above
 *
 * All are for light of one wavelength; internal and escape are for light that leaves the
 * base by Lambert's law.
 */
#pragma once

#include "bsdf/microfacet.h"

#include <stdbool.h>

/** @brief Ranges of the coat's numbers; min = max if constant. */
typedef struct coat_range {
    float alpha_min, alpha_max;
    float eta_min, eta_max; /**< coat over outside */
    float thickness;        /**< optical depth of the coat, straight through */
} coat_range;

typedef struct coat_table coat_table;

coat_table *coat_table_new(const coat_range *range);
void coat_table_free(coat_table *table);

/** @brief A coat of one roughness and index: the table's nodes around it, to be looked up
 * once and asked often. */
typedef struct coat_response {
    const struct coat_node *nodes[4];
    float weights[4];
    int n;
    bool smooth;
    float eta, thickness;
} coat_response;

/** @brief @param alpha,eta within the table's ranges @return borrows from the table */
coat_response coat_find(const coat_table *table, float alpha, float eta);

/** @brief Share of light from cosine mu reflected by the coat's facets. */
float coat_reflected(const coat_response *c, float mu);
/** @brief Share of light from cosine mu that reaches the base. By reciprocity it is also
 * η² times the radiance that leaves towards mu for unit radiance leaving the base. */
float coat_crossing(const coat_response *c, float mu);
/** @brief Share of light leaving the base that the coat sends back to it. */
float coat_internal(const coat_response *c);
/** @brief Share of light leaving the base that gets out. */
float coat_escape(const coat_response *c);
