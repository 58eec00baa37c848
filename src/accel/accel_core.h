/*
 * The core of a world, for rays that come from afar.
 *
 *    o ─────────────────────────────────── ─ ─ ──────┤core├─────
 *    a ray, where floats know the core as a point     few steps further on they do not
 *
 * Where one thing reaches a million times further than all others, a ground or a vertex
 * gone astray, light comes from so far off that distances along its rays are not known to
 * the size of the core: every box of it would be met, and any of its triangles. Such a
 * ray is asked in parts, and the last begins by the core.
 */
#pragma once

#include "medium/hit.h"
#include "shape/shape.h"

/** @brief A box around all but what is far larger than it. */
typedef struct accel_core {
    vec3 low, high;
    float far; /**< m: rays from further off are asked in parts; INFINITY: none are */
} accel_core;

/** @brief Looks for the core of what is added to it. */
typedef struct core_search {
    box3 box;
    float most;     /**< m: the largest core that makes a difference */
    size_t n_large; /**< things that are larger than that */
} core_search;

/** @param bounds of all that will be added, or more */
core_search core_search_begin(box3 bounds);
/** @brief Adds what has this box; an empty one adds nothing. */
void core_search_add(core_search *search, box3 box);
/** @brief Adds the parts of a shape, no more of them than it takes to know. */
void core_search_add_shape(core_search *search, const shape *s);
/** @brief True if what else is added changes nothing. */
bool core_search_is_over(const core_search *search);
/** @brief Empty if there is no core: little is small, or it is spread over the world. */
box3 core_search_end(const core_search *search);

accel_core accel_core_make(box3 box);

static inline bool accel_core_exists(const accel_core *core)
{
    return core->far < INFINITY;
}

/** @brief How far along a ray from afar a part of it ends that does not come to the core;
 * 0: nowhere, or it is not from afar. */
float accel_core_ahead(const accel_core *core, const ray *r);
