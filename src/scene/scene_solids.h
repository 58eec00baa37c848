/*
 * Finding the solids of a scene, and what stands in them.
 */
#pragma once

#include "scene/scene.h"

/** @brief Tells the shapes of a scene with its acceleration structure what they bound,
 * and finds the solids that the lights are in. */
void scene_find_solids(scene *s);
