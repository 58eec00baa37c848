/*
 * Who listens while a scene is built: the same calls, as they come, to one who writes the
 * scene down. Each is told before the scene has looked at it; what is wrong ends the
 * building anyway.
 */
#pragma once

#include "math/transform.h"
#include "scene/params.h"

struct mesh;
struct scene;
struct shape_place;

/** @brief Any of the calls may be NULL. See the scene_ functions of the like names. */
typedef struct scene_listener {
    void *data;
    void (*texture)(void *data, const char *name, const char *kind, bool is_spectrum,
                    const params *p);
    /** @param index that it gets */
    void (*material)(void *data, int index, const char *name, const char *kind,
                     const params *p);
    void (*light)(void *data, const char *kind, const params *p,
                  const transform *to_world);
    void (*shape)(void *data, const char *kind, const params *p,
                  const struct shape_place *at);
    /** @param m in object space */
    void (*mesh)(void *data, const struct mesh *m, const struct shape_place *at);
    void (*film)(void *data, const char *kind, const params *p);
    void (*filter)(void *data, const char *kind, const params *p);
    void (*camera)(void *data, const char *kind, const params *p,
                   const transform *to_world);
} scene_listener;
