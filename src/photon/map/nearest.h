/*
 * The k nearest so far: a buffer that is cut back to k when it is full.
 *
 * A bounded heap (Jensen 2001) moves log k entries for every photon that enters. Here one
 * that enters is just appended, eight at a time, and when the buffer holds twice k it is
 * cut back by selection, which is linear: a constant cost a photon. After each cut the
 * limit is the k-th distance found, so the search closes in as with a heap.
 */
#pragma once

#include "photon/map/runs.h"

typedef struct nearest_set {
    const point_query *query;
    photon_hits *hits;
    size_t k;
    size_t full; /**< cut back when more than this are held */
    float limit; /**< squared distances at or beyond can not enter */
} nearest_set;

/** @brief An empty set of at most k photons within radius; false if memory is refused. */
bool nearest_begin(nearest_set *set, const point_query *query, size_t k, float radius,
                   photon_hits *hits);
/** @brief Empties the set and sets a new radius. */
void nearest_restart(nearest_set *set, float radius);
/** @brief Lets the photons of a run enter. */
void nearest_add_run(nearest_set *set, size_t begin, size_t end);
/** @brief Keeps only the k nearest and lowers the limit to the k-th. */
void nearest_cut(nearest_set *set);
/** @brief True if point a of the query's arrays, at distance2 da, comes before b: by
 * distance, then x, y, z; then photons by wi and flux or number, others by number. */
bool nearest_before(const point_query *query, size_t a, float da, size_t b, float db);
