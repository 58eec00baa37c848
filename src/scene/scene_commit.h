/*
 * What building a scene needs of committing it; scene_commit itself is in scene.h.
 */
#pragma once

#include "scene/scene.h"

/** @brief True until the scene is committed; then ERROR_USAGE. */
bool scene_may_change(const scene *s, GError **error);
/** @brief Frees all that a commit finds; the scene is as it was before. */
void scene_forget_commit(scene *s);
