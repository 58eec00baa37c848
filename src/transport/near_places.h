/*
 * The nearest of some thousand places, for who asks millions of times.
 *
 * A grid of cells, some two a place. Any point of a cell has its nearest place among
 * those that lie no further from the cell's centre than the nearest of all does and the
 * cell's diagonal besides, q for the point p and n for the centre c:
 *
 *   |q - c| <= |q - p| + |p - c| <= |n - p| + |p - c| <= |n - c| + 2 |p - c|
 *
 * These are listed when a cell is first asked for, and are few: whose list would be
 * longer than a search through a tree is left to the tree.
 *
 * The tree alone finds the same places, only later: bench_map says what a query pays.
 */
#pragma once

#include "photon/map/point_set.h"

typedef struct near_places near_places;

/** @brief Over n places, 0 allowed, which stay the caller's and as they are. NULL: out of
 * memory. */
near_places *near_places_build(const vec3 *places, size_t n, GError **error);
void near_places_free(near_places *near);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(near_places, near_places_free)

typedef struct near_place {
    size_t which;
    float distance2;
} near_place;

/** @brief Finds the place nearest to p; of those that are equally near one, always the
 * same. Thread-safe. @param hits scratch @return false: there is none */
bool near_places_find(const near_places *near, vec3 p, near_place *found,
                      point_hits *hits);
