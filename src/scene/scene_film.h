/*
 * Film settings from a film directive.
 */
#pragma once

#include "scene/scene.h"

/** @brief pbrt's defaults: 1280 x 720, iso 100, the whole film, sRGB. */
film_settings film_default(void);
/** @brief Name of kind number i; NULL behind the last. @param parameters those that act,
 * blank-separated @param idle those that are accepted and change nothing */
const char *film_kind_at(size_t i, const char **parameters, const char **idle);
/** @brief Reads a directive. *film is left as it is on failure; filename is owned.
 * @param log where it is noted what is not as pbrt has it */
bool film_init(film_settings *film, const char *name, const params *p,
               const log_sink *log, GError **error);
