/*
 * The volume photon map (Jensen & Christensen, "Efficient Simulation of Light Transport
 * in Scenes with Participating Media using Photon Maps", 1998), asked along whole rays
 * (Jarosz, Zwicker & Jensen, "The Beam Radiance Estimate for Volumetric Photon Mapping",
 * 2008).
 *
 * A photon is kept where it is scattered in a medium, with the flux that is scattered
 * there. Each is a disc that faces the ray, of a radius of its own, and what those that
 * the ray crosses send along it is its in-scattered radiance:
 *
 *   L(o, ω) = Σ T(t_p) p(-ω, wi_p) κ(d_p) Φ_p / ∫∫ κ(s) s ds dθ
 *
 * with t_p and d_p the photon's distance along the ray and from it. So no step along the
 * ray is to be chosen, and a beam of light is seen whole by every ray through it.
 */
#pragma once

#include "medium/medium.h"
#include "photon/kernel.h"
#include "photon/photon.h"

typedef struct volume_map volume_map;

/** @brief Builds a map over *store, of at least one photon, whose arrays are taken (also
 * on failure).
 *  @param radii m, one per photon, > 0 */
volume_map *volume_map_build(photon_store *store, const float *radii, unsigned threads,
                             GError **error);
/** @brief A map of the same photons whose discs are wider, that many times; the photons
 * stay those of map, which must outlive it. */
volume_map *volume_map_widened(const volume_map *map, float by, unsigned threads,
                               GError **error);
void volume_map_free(volume_map *map);
size_t volume_map_bytes(const volume_map *map); /**< memory kept */
const photon_store *volume_map_store(const volume_map *map);

/** @brief What to ask for. */
typedef struct volume_query {
    const ray *ray;
    const medium *medium; /**< that it is in, ... */
    const medium *solid;  /**< ... and the solid, if that absorbs; else NULL */
    float length;         /**< m: how far the medium reaches on it */
    const wavelengths *w;
    kernel kernel;
    spectrum *groups; /**< gets what the photons of each tag gave of it ... */
    size_t n_groups;  /**< 0: not asked for */
} volume_query;

/** @brief Radiance that arrives at the ray's origin from photons in its medium.
 *  @param n_weighed gets the number of those that it crosses */
spectrum volume_map_radiance(const volume_map *map, const volume_query *query,
                             size_t *n_weighed);
