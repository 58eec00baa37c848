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

/** @brief A box around nearly all but what is far larger than it. */
typedef struct accel_core {
    vec3 low, high;
    float far; /**< m: rays from further off are asked in parts; INFINITY: none are */
} accel_core;

/** @brief What is taken for the core while things are gone through. */
typedef struct core_search {
    box3 box;
    float most;                 /**< m: the largest core that matters */
    size_t n_odd;               /**< times that what was added did not join it */
    size_t n_inside, n_outside; /**< parts; those outside are small too */
    size_t n_votes;             /**< of the parts inside, that others have not outvoted */
    bool is_found;              /**< parts join the core, but do not move it */
} core_search;

/** @brief Adds all that there is. */
typedef void (*core_walk)(core_search *search, void *data);

/** @brief Looks for a core where most of what is small lies, walking twice at most.
 * @param bounds of all that is added, or more
 * @return empty if there is none: little is small, or it is spread over the world */
box3 core_find(box3 bounds, core_walk walk, void *data);

/** @brief Adds what is of n parts and has this box; an empty one adds nothing. */
void core_add(core_search *search, box3 box, size_t n);
/** @brief Of how many parts a shape is: 0 if no ray meets it. */
size_t core_parts_of(const shape *s);
/** @brief Adds the parts of a shape, no more of them than it takes to know. */
void core_add_shape(core_search *search, const shape *s);
/** @brief True if what else is added changes nothing. */
bool core_is_out_of_question(const core_search *search);

accel_core accel_core_make(box3 box);

static inline bool accel_core_exists(const accel_core *core)
{
    return core->far < INFINITY;
}

/** @brief How far along a ray from afar a part of it ends that does not come to the core;
 * 0: nowhere, or it is not from afar. */
float accel_core_ahead(const accel_core *core, const ray *r);
