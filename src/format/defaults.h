/*
 * What a scene needs that many files of other formats than pbrt's do not say.
 */
#pragma once

#include "scene/builder.h"

/** @brief Gives a scene that has no light a soft environment, and one without a camera a
 * view that frames it, each with a note; and a film if the file had none. Its formats do
 * not say how the picture is exposed (film_settings.is_unexposed).
 *
 * A scene is lit by a light, or by surfaces that shine if they send out a hundredth at
 * least of what a white environment would send into a sphere around it.
 * @param up the direction that is up in the file, unit
 * @param glow_is_look surfaces that shine are meant to be seen, not to light anything
 * @return false with ERROR_INPUT naming the file if there is nothing to look at */
bool scene_complete(scene_builder *to, const char *path, vec3 up, bool glow_is_look,
                    GError **error);
