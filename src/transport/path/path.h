/*
 * Path tracing with next-event estimation and multiple importance sampling (Veach 1997;
 * Pharr et al. 2023, chapter 13): no photons, no bias, and so the oracle that photon
 * mapping is held to.
 */
#pragma once

#include "photon/spots.h"
#include "transport/transport.h"

/** @brief A pass of path tracing; with a caustic map, what the map holds is left to it.
 */
typedef struct path_pass {
    const transport_plan *plan;
    wavelengths w;
    bsdf_options options;
    struct photonmap_pass *caustics;       /**< NULL: paths find all light themselves */
    photon_spots *spots[MOST_TIME_SLICES]; /**< by slice of the shutter's time; owned;
                                              NULL: there are none, or not looked at */
    int n_slices;                          /**< of them */
    float p_spots;            /**< probability of looking at them from a surface */
    struct spot_trial *trial; /**< to measure with: what looking is worth; else NULL */
    GArray *lit; /**< to measure with, of lit_place: gets those that light sampling finds
                    and how much of the picture they light, MOST_PLACES at most; else
                    NULL */
    bool without_caustics; /**< to measure with: light by way of a specular or glossy
                              bounce to the first diffuse surface is left out; that to a
                              later one is in LAYER_CAUSTIC */
    bool caustics_apart;   /**< to measure with: those of the first diffuse surface are in
                              their layer, also behind glass and in mirrors */
    bool sees_lights;      /**< there are some that can be seen */
    bool without_lights;   /**< to measure with: lights that are seen, also in mirrors and
                              through clear glass, are left out */
} path_pass;

/** @brief Traces one camera path through a path_pass (transport_kind.radiance). */
void path_radiance(const void *pass, const ray *r, sampler *random,
                   transport_scratch *scratch, radiance_sample *out);
