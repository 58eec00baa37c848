/*
 * A number for every place in the scene, from how close photons lie there: a photon map
 * of some of the photons' places, whose flux[0] is the number. What is asked anywhere is
 * answered by the nearest place.
 */
#pragma once

#include "photon/map/map.h"

/** Photons whose distance tells how close they lie. */
enum { PLACES_NEAREST = 16 };

/** @brief Distance from p to the PLACES_NEAREST-th nearest photon; 0 if there are not so
 * many. @param hits scratch */
float places_distance(const photon_map *map, vec3 p, photon_hits *hits);

/** @brief The number at p, from places_distance there. Thread-safe. @param hits scratch
 */
typedef float (*places_value)(const void *data, vec3 p, float distance,
                              photon_hits *hits);

/** @brief Keeps numbers at some of the map's photons, evenly chosen, that do not depend
 * on the number of threads. @return owned by the caller; NULL: out of memory */
photon_map *places_keep(const photon_map *map, unsigned threads, places_value value,
                        const void *data, GError **error);

/** @brief The number nearest to p, or `none` if none is kept.
 *  @param hits gets the place whose number it is */
float places_at(const photon_map *places, vec3 p, float none, photon_hits *hits);
