/*
 * Parts of committing a scene that concern where things are.
 */
#pragma once

#include "scene/scene.h"

/** @brief Bounds of all shapes where they stand, also before the commit. */
box3 scene_world_bounds(const scene *s);
/** @brief Largest coordinate, m, and the extents of a scene that are told apart in
 * floats: squares of lengths, and of areas, must be so too. */
#define FARTHEST_COORDINATE 1e12f
#define SMALLEST_EXTENT 1e-11f

/** @brief False with ERROR_INPUT at place if a box reaches further.
 * @param what "the shape" */
bool scene_check_reach(box3 box, const char *what, source_place place, GError **error);
/** @brief bounds, center, radius. ERROR_INPUT if they are too far out or too small. */
bool scene_find_bounds(scene *s, GError **error);
/** @brief accel, moves. */
bool scene_build_accel(scene *s, unsigned threads, GError **error);
