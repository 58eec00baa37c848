/*
 * What a scene needs that many files of other formats than pbrt's do not say.
 */
#pragma once

#include "scene/scene.h"

/** @brief Gives a scene that has no light a soft sky, and one without a camera a view
 * that frames it, each with a note; and a film if the file had none.
 * @param up the direction that is up in the file, unit
 * @param lit the file has light of its own
 * @return false with ERROR_INPUT naming the file if there is nothing to look at */
bool scene_complete(scene *s, const char *path, vec3 up, bool lit, GError **error);
