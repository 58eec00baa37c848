/*
 * Film settings from a film directive.
 */
#pragma once

#include "scene/scene.h"

/** @brief pbrt's defaults: 1280 x 720, iso 100, the whole film, sRGB. */
film_settings film_default(void);
/** @brief Reads a directive. *film is left as it is on failure; filename is owned. */
bool film_init(film_settings *film, const char *kind, const params *p, GError **error);
