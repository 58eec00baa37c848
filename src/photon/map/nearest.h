/*
 * The k nearest so far: a buffer that is cut back to k when it is full.
 *
 * A bounded heap (Jensen 2001) moves log k entries for every point that enters. Here one
 * that enters is just appended, a SIMD block at a time, and when the buffer holds twice k
 * it is cut back by selection, which is linear: a constant cost a point. After each cut
 * the limit is the k-th distance found, so the search closes in as with a heap.
 */
#pragma once

#include "photon/map/runs.h"

typedef struct nearest_set {
    const point_arrays *points;
    const point_query *query;
    point_hits *hits;
    size_t k;
    size_t full; /**< cut back when more than this are held */
    float limit; /**< squared distances at or beyond can not enter */
} nearest_set;

/** @brief An empty set of at most k points within radius; false if memory is refused. */
bool nearest_begin(nearest_set *set, const point_arrays *points, const point_query *query,
                   size_t k, float radius, point_hits *hits);
/** @brief Empties the set and sets a new radius. */
void nearest_restart(nearest_set *set, float radius);
/** @brief Lets the points of a run enter. */
void nearest_add_run(nearest_set *set, size_t begin, size_t end);
/** @brief Keeps only the k nearest and lowers the limit to the k-th. */
void nearest_cut(nearest_set *set);
/** @brief True if point a, at distance2 da, comes before b: by distance, then x, y, z,
 * then as their owner says. */
bool nearest_before(const nearest_set *set, size_t a, float da, size_t b, float db);
