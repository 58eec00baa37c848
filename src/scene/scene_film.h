/*
 * Film settings from a film directive.
 */
#pragma once

#include "base/log.h"
#include "color/space.h"
#include "params/params.h"

/** @brief What the film directive asks for. */
typedef struct film_settings {
    int width, height;
    char *filename; /**< absolute or relative to the working folder, NULL if not given */
    float iso;      /**< pbrt's sensor speed; radiance is scaled by iso / 100 */
    bool is_unexposed; /**< the file's format has no words for how bright its picture is
                          to be */
    float most;        /**< the largest of X, Y, Z of a sample on the sensor; 0: any */
    float kelvin;      /**< daylight that is to look white; 0: no white balance */
    bool gbuffer;      /**< with the layers that pbrt's film of that name has */
    bool in_camera;    /**< places and normals in camera space */
    float crop[4];     /**< x0, x1, y0, y1 in 0..1; pixels ceil(crop * size) as in pbrt */
    const color_space *space;
} film_settings;

/** @brief pbrt's defaults: 1280 x 720, iso 100, the whole film, sRGB. */
film_settings film_default(void);
/** @brief Name of kind number i; NULL behind the last. @param parameters those that act,
 * blank-separated @param idle those that are accepted and change nothing */
const char *film_kind_at(size_t i, const char **parameters, const char **idle);
/** @brief Reads a directive. *film is left as it is on failure; filename is owned.
 * @param log where it is noted what is not as pbrt has it */
bool film_init(film_settings *film, const char *name, const params *p,
               const log_sink *log, GError **error);
