/*
 * Parts of building and committing a scene that concern where things are.
 */
#pragma once

#include "scene/scene.h"

/** @brief Empty lists of objects and instances, and their end. */
void scene_open_objects(scene *s);
void scene_close_objects(scene *s);
/** @brief Bounds of all shapes where they stand, also before the commit. */
box3 scene_world_bounds(const scene *s);
/** @brief bounds, center, radius. ERROR_INPUT if they overflow. */
bool scene_find_bounds(scene *s, GError **error);
/** @brief casters, caustic_area and the sphere around them. */
bool scene_find_casters(scene *s, GError **error);
/** @brief accel, moves. */
bool scene_build_accel(scene *s, unsigned threads, GError **error);
