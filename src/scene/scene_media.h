/*
 * The participating media of a scene.
 */
#pragma once

#include "scene/scene.h"

/** @brief The participating medium, as in a medium_stack, at the end of a ray, as changed
 * by the interfaces on it, whatever else stands there. */
uint32_t scene_medium_behind(const scene *s, ray r);
/** @brief Finds the medium around all, from the one at a place (as in a medium_stack),
 * and where it ends. */
void scene_find_outer_medium(scene *s, vec3 from, uint32_t there);

/** @brief How far around center light from beyond is looked for (m): around the scene, or
 * as far as a medium that scatters it and has no bounds. */
float scene_lit_radius(const scene *s);
