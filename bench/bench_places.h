/*
 * What map benchmarks ask: photons on the faces of a unit box, and where and how far.
 *
 *   in no order      photons lie evenly, queries too, all with one radius
 *   in pixel order   photons are those of a light in the box, five times as dense below
 * it as in the corners and more; queries are what a camera in the box sees, tile by tile
 * as a picture is rendered, each with the radius of its place as photon mapping takes it,
 * from a radius cache over a pilot of few photons
 */
#pragma once

#include "photon/photon_map.h"
#include "transport/radius_cache.h"

/** @brief A query. */
typedef struct place {
    vec3 p, n;    /**< and the normal, into the box */
    float radius; /**< with WANTED photons, on average */
} place;

/** @brief Photons within place.radius. */
enum { PLACE_WANTED = 50 };

typedef struct places {
    bool in_pixel_order;
    size_t n_photons, n;
    photon_store photons;
    float *xyz; /**< of the photons, one after the other */
    place *at;
    float typical;       /**< median radius */
    radius_cache *radii; /**< NULL: there is one */
} places;

/** @brief Exits the program where memory is refused. */
places places_make(bool in_pixel_order, size_t n_photons, size_t n);
void places_clear(places *from);
/** @brief A copy of all photons, owned by the caller. */
photon_store places_photons(const places *from);
