/*
 * pbrt-v3 scenes, told in the words of pbrt-v4.
 */
#pragma once

#include "base/log.h"
#include "params/params.h"

#include <stdbool.h>
#include <stddef.h>

/** @brief What a directive makes. */
typedef enum pbrt_v3_target {
    V3_MATERIAL,
    V3_MEDIUM,
    V3_TEXTURE,
    V3_LIGHT,
    V3_AREA_LIGHT,
    V3_SHAPE,
    V3_FILM,
    V3_FILTER,
    V3_SAMPLER,
    V3_INTEGRATOR,
    V3_CAMERA,
    N_V3_TARGETS
} pbrt_v3_target;

/** @brief True if text holds words that only pbrt-v3 has. */
bool pbrt_v3_recognises(const char *text, size_t size);

/** @brief Makes a directive's kind and parameters those of pbrt-v4 that come closest.
 * What is lost is noted; what v4 does not know stays, to be refused by name.
 * @param kind may be replaced; owned by the caller (g_free)
 * @return false with ERROR_FAILED if memory is short */
bool pbrt_v3_translate(pbrt_v3_target target, char **kind, params *p, const log_sink *log,
                       GError **error);
