/*
 * Discs that face every ray, and which of them a ray crosses: what photons in a medium
 * are to a camera ray.
 */
#pragma once

#include "base/error.h"
#include "medium/hit.h"

#include <stddef.h>
#include <stdint.h>

typedef struct disc_set disc_set;

/** @brief A disc that a ray crosses. */
typedef struct disc_crossing {
    uint32_t index;  /**< of the disc */
    float t;         /**< m along the ray, where it is nearest to the disc's middle */
    float distance2; /**< m², of that middle from the ray */
} disc_crossing;

/** @brief Those of one ray, by index. Zero-initialise, clear at the end; reused from
 * query to query. */
typedef struct disc_crossings {
    size_t n, capacity;
    disc_crossing *at;
} disc_crossings;

void disc_crossings_clear(disc_crossings *c);

/** @brief In metres. */
typedef struct disc {
    float x, y, z; /**< of the middle */
    float radius;
} disc;

/** @brief Builds a set over n discs, which are borrowed and must outlive it. ERROR_FAILED
 * when memory is refused. @param threads 0 = all */
disc_set *disc_set_build(const disc *discs, size_t n, unsigned threads, GError **error);
void disc_set_free(disc_set *set);

/** @brief All discs that the ray crosses in (0, t_max). Thread-safe. @return false when
 * memory is refused. */
bool disc_set_cross(const disc_set *set, const ray *r, disc_crossings *out);
