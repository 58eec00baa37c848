/*
 * Neighbourhoods: which part of the disc around a point is the same surface and in sight
 * of it.
 *
 * The estimate divides by the area of a disc. Near an edge or a corner part of that disc
 * is no surface, and behind a thin wall it is another room: the estimate would be too
 * dark there, or leak. So the disc is probed with short rays from a point lifted off the
 * surface,
 *
 *        lifted ·───────────►· along the surface: is there a wall between?
 *               │            │ down: is there a surface, in the plane?
 *     ──────────x────────────q──────
 *
 * and where a probe fails, photons are held to the same test and the area is that of the
 * part that passes it.
 */
#pragma once

#include "photon/kernel.h"
#include "scene/scene.h"

enum { NEIGHBOURHOOD_SECTORS = 16 };

/** @brief A disc to be probed. The first three are the caller's; thread-safe. */
typedef struct neighbourhood {
    const scene *scene;
    vec3 p, n;    /**< centre, unit geometric normal on the side that is seen */
    float radius; /**< m */
    frame frame;  /**< turned by an angle of its own for every place */
    /** How far one sees along the surface, in the frame's plane, m: a polygon around the
     * centre whose first corner stands again at the end. */
    vec2 horizon[NEIGHBOURHOOD_SECTORS + 1];
} neighbourhood;

/** Height over radius within which a surface counts as the disc's. */
#define NEIGHBOURHOOD_FLATTEN 0.03f

/** @brief True if a few probes around the rim find nothing amiss. */
bool neighbourhood_is_whole(neighbourhood *hood);

/** @brief Probes the horizon, and gives the share of the kernel's area that is surface in
 * sight, in (0, 1]. After it neighbourhood_sees may be asked. */
float neighbourhood_coverage(neighbourhood *hood, const kernel *k);

/** @brief True if q, a point near the plane, lies within the horizon. */
bool neighbourhood_sees(const neighbourhood *hood, vec3 q);
