/*
 * Who carries a caustic: photons, or paths from the eye.
 *
 *   y0 ──► y1 ──► ... ──► yk        y0 on the light; y1 .. y(k-1) specular or glossy; yk
 *   light   first           diffuse  the first diffuse surface, where a photon would land
 *
 * A path from the eye that scatters at yk may find the rest of this path by itself: it
 * meets the light (met), or samples it from a glossy y1 (sampled). Photons find it too,
 * N of them a pass, each for a disc of radius r (merged). All three share the light by
 * the balance heuristic (Veach 1997, §9.2), merging being counted as by Georgiev et al.
 * ("Light Transport Simulation with Vertex Connection and Merging", 2012):
 *
 *     photons' weight = merged / (merged + met + sampled)
 *
 * Over the density with which the path from the eye follows this one up to y1,
 *
 *     met     = p_scatter                 per solid angle, y1 → y0 by scattering
 *     sampled = p_lights                  the same by choosing a point on the lights
 *     merged  = p_scatter π e (π r² N),   e = density of the emission y0 → y1,
 *
 * where what the chain in between does to either density has been taken as equal, and yk
 * as scattering by the cosine: any function of the path will do, as long as both sides
 * use the same, and these make it one of the light's end alone. So a sharp caustic of a
 * small light is the photons', what a large window or the environment sends through a
 * pane is the path's, and from mirrors to dull metal the one goes over into the other
 * without a step.
 */
#pragma once

#include "photon/trace/casters.h"

/** @brief What the MIS weights of a pass depend on. */
typedef struct caustic_mis {
    const caustic_casters *casters;
    float discs; /**< π r² N over the camera's samples that see the same photons, m² */
    const float *boost; /**< how much denser guided emission is, by light; NULL: 1 */
} caustic_mis;

/** @brief The light's end of a path. */
typedef struct caustic_end {
    int light;
    vec3 p, n;         /**< on the light, as its emission has them (light_emission) */
    vec3 direction;    /**< from the light to y1, unit */
    float distance;    /**< between them, m; not asked for of parallel light */
    bool specular;     /**< y1 scattered as a mirror: it is neither sampled from, nor
                          p_scatter known */
    float pdf_scatter; /**< of the path from the eye at y1 toward the light, per sr */
    float pdf_lights;  /**< of sampling the light from y1, with its choice, per sr; that
                          choice alone for delta lights */
} caustic_end;

/** @brief The photons' weight, 0..1. mis NULL: all of it. */
float caustic_mis_weight(const caustic_mis *mis, const caustic_end *end);
