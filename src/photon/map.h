/*
 * Photon maps: three structures behind one interface, same answers.
 *
 * Built once from a store, const afterwards; queries write only into the caller's struct.
 * A photon is "within r" if its squared distance is < r². Photons that tie for the k-th
 * place are taken in the order of their index in the store the map was built from, so
 * that all maps agree to the bit.
 */
#pragma once

#include "base/parallel.h"
#include "photon/photon.h"
#include "scene/settings.h"

typedef struct photon_map photon_map;

/** @brief Photons found: indices into photon_map_store(map) and squared distances. */
typedef struct photon_hits {
    size_t n, capacity;
    size_t *index;
    float *distance2;
} photon_hits;

void photon_hits_clear(photon_hits *hits);

typedef struct photon_map_kind {
    const char *name; /**< "list", "kdtree", "grid" */
    /** Orders the store (taken over) and builds. radius: of the queries to come, for the
     * grid. */
    bool (*build)(photon_map *map, float radius, unsigned threads, GError **error);
    void (*free)(photon_map *map);
    /* Both append to hits without order; false when memory is refused. */
    bool (*within)(const photon_map *map, vec3 p, float radius, photon_hits *hits);
    /** The k nearest within radius (INFINITY allowed). */
    bool (*nearest)(const photon_map *map, vec3 p, size_t k, float radius,
                    photon_hits *hits);
} photon_map_kind;

/** @brief Builds a map over *store, whose arrays are taken (also on failure).
 *  @param radius that fixed-radius queries will mostly use, m; 0 if unknown
 *  The result does not depend on the number of threads. */
photon_map *photon_map_build(map_choice choice, photon_store *store, float radius,
                             unsigned threads, GError **error);
void photon_map_free(photon_map *map);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(photon_map, photon_map_free)
const photon_store *photon_map_store(const photon_map *map);
size_t photon_map_bytes(const photon_map *map); /**< memory kept */

/** @brief hits->n is reset first. */
bool photon_map_within(const photon_map *map, vec3 p, float radius, photon_hits *hits);
bool photon_map_nearest(const photon_map *map, vec3 p, size_t k, float radius,
                        photon_hits *hits);
