/*
 * Who listens while a scene is built: the same calls, as they come, to one who writes the
 * scene down. Each is told before the scene has looked at it; what is wrong ends the
 * building anyway.
 */
#pragma once

#include "math/motion.h"
#include "params/params.h"

struct mesh;
struct shape_place;

/** @brief Any of the calls may be NULL. See the builder_ functions of the like names. */
typedef struct scene_listener {
    void *data;
    void (*texture)(void *data, const char *name, const char *kind, bool is_spectrum,
                    const params *p);
    /** @param index that it gets */
    void (*material)(void *data, int index, const char *name, const char *kind,
                     const params *p);
    /** A material that shapes may have before it is made. */
    void (*material_awaited)(void *data, int index, const char *name);
    void (*medium)(void *data, const char *name, const char *kind, const params *p);
    /** @param inside,outside names; NULL: none */
    void (*medium_interface)(void *data, const char *inside, const char *outside);
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
    void (*camera_motion)(void *data, const motion *to_world);
    /** @param name may be NULL */
    void (*object_begin)(void *data, int index, const char *name);
    void (*object_end)(void *data);
    void (*instance)(void *data, int object, const motion *to_world);
} scene_listener;

/** @brief Calls one of the functions of a builder's listener, if it has it. */
#define LISTENER_TELL(b, call, ...)                                                      \
    do {                                                                                 \
        if ((b)->listener && (b)->listener->call)                                        \
            (b)->listener->call((b)->listener->data, __VA_ARGS__);                       \
    } while (0)
