/*
 * Parts of building and committing a scene that concern where things are. Called by
 * scene.c alone.
 */
#pragma once

#include "scene/scene.h"

void scene_open_objects(scene *s);
void scene_close_objects(scene *s);
/** @brief bounds, center, radius. ERROR_INPUT if they overflow. */
/** @brief Bounds of all shapes where they stand, also before the commit. */
box3 scene_world_bounds(const scene *s);
bool scene_find_bounds(scene *s, GError **error);
/** @brief casters, caustic_area and the sphere around them. */
bool scene_find_casters(scene *s, GError **error);
/** @brief accel, moves. */
bool scene_build_accel(scene *s, unsigned threads, GError **error);
