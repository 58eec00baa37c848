/*
 * A scene's settings as pbrt's directives.
 */
#pragma once

#include "scene/scene.h"

/** @brief An Integrator with all that is not its default, of the types that the settings'
 * table has. */
void convert_append_settings(GString *out, const settings *s);
/** @brief What pbrt's options have switched. */
void convert_append_switches(GString *out, const scene_switches *on);
