/*
 * Hits as small as they can be: what a path keeps of its vertices. A hit is 192 bytes,
 * but all of it follows from the ray that met it and the place on the primitive.
 */
#pragma once

#include "scene/scene.h"

/** @brief A hit by a ray of the light's, or of any but the eye's (footprint is lost). */
typedef struct kept_hit {
    float origin[3], direction[3]; /**< of the ray */
    float t, time;
    int shape, instance; /**< these, primitive and corners as in surface_hit */
    uint32_t primitive;
    vec2 corners;
    medium_stack media; /**< that the ray travelled in */
} kept_hit;

/** @brief What is kept of a hit of the ray. */
kept_hit hit_keep(const ray *r, const surface_hit *hit);

/** @brief To where the ray came from, unit. */
static inline vec3 kept_hit_wo(const kept_hit *kept)
{
    const float *d = kept->direction;
    return -(vec3){d[0], d[1], d[2]};
}

/** @brief The hit again, to the bit, footprint apart. */
surface_hit scene_restore_hit(const scene *s, const kept_hit *kept);
