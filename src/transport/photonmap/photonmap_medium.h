/*
 * What photon mapping sees in a medium (Jensen 2001, §10.4): light that is scattered once
 * from a point on the ray, all else from the volume photon map.
 */
#pragma once

#include "transport/direct.h"
#include "transport/photonmap/photonmap.h"

/** @brief A ray through the medium that it starts in. */
typedef struct medium_look {
    const ray *ray;
    float length;        /**< m: how far the medium reaches on it */
    spectrum throughput; /**< what its radiance counts, by wavelength */
    int wavelength;
    bool every_light; /**< sample each light, where they are few, instead of one */
} medium_look;

/** @brief Light that comes straight from lights and is scattered once, toward the ray's
 * origin: from one point of the ray that stands for all, by sampling lights and the phase
 * function; scratch->estimate.groups are its parts. */
spectrum photonmap_direct_in_medium(const photonmap_pass *pass, const medium_look *look,
                                    sampler *random, transport_scratch *scratch);

/** @brief Radiance that photons of one class, which were scattered in the medium that a
 * ray starts in, send along it; scratch->estimate.groups are its parts.
 *  @param length m: how far the medium reaches */
spectrum photonmap_gather_medium(const photonmap_pass *pass, photon_class c, const ray *r,
                                 float length, transport_scratch *scratch);

/** @brief Makes pass->in_media of a slice and class from photons in media, whose arrays
 * are taken, unless there are none. */
bool photonmap_keep_in_media(photonmap_pass *pass, int slice, photon_class c,
                             photon_store *photons, GError **error);
