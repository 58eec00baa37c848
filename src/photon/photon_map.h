/*
 * The photon map: a photon store, and a point index over its positions
 * (map/point_index.h), of any kind.
 *
 *   x[] y[] z[] ──► index ──► order ──► wi[] flux[] .. follow it
 *
 * Built once from a store, const afterwards; queries write only into the caller's struct.
 * Photons that tie for the k-th place are taken in the order of (x, y, z, wi, flux or
 * number), compared as numbers: no index needs to be kept for it, and photons that tie
 * even then are interchangeable. So maps of all kinds find the same photons to the bit.
 *
 * Of the filter: without one_sided /estimate/even-field-unbiased fails, what arrived from
 * behind counts; without flatten /estimate/flatten does, a wall lights the floor at its
 * foot. For the rest of it see photon_query.h.
 *
 * Memory kept: that of the photons and of the index.
 */
#pragma once

#include "base/parallel.h"
#include "photon/map/point_index.h"
#include "photon/photon.h"

/** Where photons lie thinly no radius, of an estimate or of a bright spot, is wider than
 * so many typical ones: one that lies alone covers no more, and look-ups stay quick.
 * With half as many relMSE is 1.3 times as much behind a window, and relMSE x time 0.86
 * to 0.95 times as much in water, ball and fog; with twice as many that is 1.02 to 1.13
 * times as much in all four (128 x 128, 8 passes, three seeds). */
#define WIDEST_OVER_TYPICAL 4.0f

typedef struct photon_map photon_map;

/** @brief Which photons a query sees, and how it measures their distance. It acts while
 * searching: a photon that does not count never takes a place among the k nearest. */
typedef struct photon_filter {
    vec3 n;         /**< unit normal of the surface at the point */
    bool one_sided; /**< only photons that arrived on the side of n: wi·n > 0 */
    float flatten;  /**< the neighbourhood is a disc of this height over radius: distance
                       is the larger of |d| and |d·n| / flatten, > 0; >= 1: a ball */
    int face; /**< where both sides count: 1, -1: n is, or is opposite to, the normal
                  of the surface itself, and photons off its plane count only if
                  theirs points alike (by PHOTON_BEHIND), so that those on the other
                  face of a thin pane do not; 0: all */
    uint32_t curve; /**< where photons keep their curves: only those on this one, which
                       has no plane, so flatten, face and normals say nothing; 0: only
                       those on none */
} photon_filter;

/** @brief What MAP_AUTO stands for: where radii of queries differ much, a grid has cells
 * that are too small for one and too large for the other. */
static inline map_choice photon_map_chosen(map_choice wanted, bool radii_differ)
{
    return wanted != MAP_AUTO ? wanted : radii_differ ? MAP_KDTREE : MAP_GRID;
}

/** @brief Builds a map over *store, whose arrays are taken (also on failure) and put in
 *  an order of the map's own.
 *  @param choice not MAP_AUTO
 *  @param radius that fixed-radius queries will mostly use, m; 0 if unknown
 *  The result does not depend on the number of threads. */
photon_map *photon_map_build(map_choice choice, photon_store *store, float radius,
                             workers by, GError **error);
void photon_map_free(photon_map *map);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(photon_map, photon_map_free)
const photon_store *photon_map_store(const photon_map *map);
/** @brief By places in the store. */
const point_index *photon_map_index(const photon_map *map);
size_t photon_map_bytes(const photon_map *map); /**< memory kept */

/** @brief All photons within radius, in no order, by their places in the store. hits->n
 * is reset first.
 *  @param filter NULL: every photon counts
 *  @return false when memory is refused */
bool photon_map_within(const photon_map *map, vec3 p, float radius,
                       const photon_filter *filter, point_hits *hits);
/** @brief The k nearest within radius (INFINITY allowed), in no order; else as within. */
bool photon_map_nearest(const photon_map *map, vec3 p, size_t k, float radius,
                        const photon_filter *filter, point_hits *hits);
