/*
 * Photons: where light landed, from where, and how much of it.
 *
 * A photon stores its incident state, before the bounce: it travels along -wi. Stores
 * keep arrays, not structs: positions apart from the rest, so that a distance test loads
 * only what it needs.
 *
 *   x[] y[] z[]   4 bytes each   read for every candidate
 *   wi[]          4 bytes        octahedral and flags, read for blocks with some in reach
 *   flux[]        32 bytes       eight wavelengths, read for those in reach;
 *                                24 in a map (packed_flux.h); or
 *   number[]      8 bytes        where the owner keeps what lies there
 *
 * 48 bytes a photon, 40 in a map, and four more each for normals, tags and homes where
 * they are asked for.
 * Stores count in size_t; a map names its photons in 32 bits.
 */
#pragma once

#include "base/error.h"
#include "color/spectrum.h"
#include "math/vec.h"
#include "photon/map/points.h"
#include "photon/packed_flux.h"

#include <stdint.h>

/** @brief What a photon did before it landed. Each class has its own map and budget. */
typedef enum photon_class {
    PHOTON_DIRECT,   /**< light → here */
    PHOTON_INDIRECT, /**< at least one diffuse bounce before here */
    PHOTON_CAUSTIC,  /**< light → specular or glossy bounces → here */
    N_PHOTON_CLASSES
} photon_class;

/** id: Came from a light no ray can hit (point, spot, distant) by specular bounces
 * only: a camera path that meets it on a glossy lobe has no other way to find this light.
 */
enum { PHOTON_FROM_DELTA = 1u };

/** id: Arrived on the side of its surface that the geometric normal points away from.
 */
enum { PHOTON_BEHIND = 2u };

/** @brief One photon, unpacked. */
typedef struct photon {
    vec3 p;
    vec3 wi;        /**< unit, to where it came from */
    spectrum flux;  /**< W per nm */
    unsigned flags; /**< PHOTON_FROM_DELTA, PHOTON_BEHIND */
    vec3 n; /**< kept by oriented stores only: the surface's unit geometric normal on
               the side it arrived */
    uint32_t tag;  /**< kept by tagged stores only: the light's group */
    uint32_t home; /**< kept by homed stores only: the flat curve that it is on, see
                      scene_curve_of, 0: it is on none; or the medium that it is in, see
                      medium_home */
    size_t number; /**< kept by numbered stores only, in place of flux: of what their
                      owner keeps of it */
} photon;

/** @brief What stores keep of a photon, in a cache line: until it is known how many there
 * are. */
typedef struct packed_photon {
    spectrum flux;
    float p[3];
    uint32_t wi, normal, tag, home;
} packed_photon;

/** @brief Photons as arrays of n, big_alloc'ed; capacity >= n. The arrays go on behind
 * capacity for at least one SIMD block, so that as many photons may be loaded from any.
 */
typedef struct photon_store {
    size_t n, capacity;
    float *x, *y, *z;
    uint32_t *wi;
    spectrum *flux;      /**< NULL once it is packed */
    packed_flux *packed; /**< NULL until then */
    bool oriented;       /**< set before room is made: photons keep the normals of their
                            surfaces */
    uint32_t *normal;    /**< packed (direction_pack); NULL unless oriented */
    bool tagged;         /**< set before room is made: photons keep their tags */
    uint32_t *tag;       /**< NULL unless tagged */
    bool homed;     /**< set before room is made: photons keep their curves or media */
    uint32_t *home; /**< NULL unless homed */
    bool numbered;  /**< set before room is made: photons keep numbers and no flux */
    size_t *number; /**< NULL unless numbered; flux is NULL if so */
} photon_store;

/** @brief Makes room for capacity photons in all; on failure the store holds what it did:
 * nothing that needs to be freed, if it had no room before. */
bool photon_store_reserve(photon_store *store, size_t capacity, GError **error);
/** @brief Appends; room must have been reserved. */
void photon_store_put(photon_store *store, const photon *p);
/** @brief Writes photon i < capacity; n stays as it is. */
void photon_store_set(photon_store *store, size_t i, const photon *p);
/** @brief What this store keeps of a photon, its number apart. */
packed_photon photon_store_packed(const photon_store *store, const photon *p);
/** @brief As photon_store_set, but for the number. */
void photon_store_set_packed(photon_store *store, size_t i, const packed_photon *p);
photon photon_store_get(const photon_store *store, size_t i);
void photon_store_clear(photon_store *store);
/** @brief Copies all photons of a store of the same sort to place `at` of another one,
 * where there is room; its n stays as it is. */
void photon_store_copy(const photon_store *to, size_t at, const photon_store *from);
/** @brief Memory held. */
size_t photon_store_bytes(const photon_store *store);
/** @brief The positions of a store; the arrays stay its own. */
static inline point_arrays photon_points(const photon_store *store)
{
    return (point_arrays){store->n, store->x, store->y, store->z};
}

/** @brief Flux of photon i of a store that is not numbered. */
static inline spectrum photon_store_flux(const photon_store *store, size_t i)
{
    return store->packed ? flux_unpack(store->packed + i) : store->flux[i];
}

/** @brief After positions were put in an order (point_index_build), what lies at them
 * follows: photon i is the one that was order[i]. NULL: they stayed as they were. Of flux
 * it keeps what packed_flux does, so nothing can be put into the store any more. One array
 * at a time, so the extra memory is that of flux. On failure the store may only be
 * cleared. */
bool photon_store_follow(photon_store *store, const size_t *order, workers by,
                         GError **error);

/** @brief Direction and flags in 32 bits; error below 1e-4 rad. */
uint32_t direction_pack(vec3 w, unsigned flags);
vec3 direction_unpack(uint32_t packed);
