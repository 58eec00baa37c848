/*
 * From a point of a surface to the coordinates of a texture: pbrt-v4's four mappings to
 * the plane, and the point itself in the texture's space for textures that fill space.
 *
 *   uv           s = uscale u + udelta, t = vscale v + vdelta
 *   spherical    s = θ / π, t = φ / 2π, of the direction from the origin
 *   cylindrical  s = (π + φ) / 2π, t = z
 *   planar       s = udelta + p·v1, t = vdelta + p·v2
 */
#pragma once

#include "math/transform.h"
#include "medium/hit.h"
#include "params/params.h"

/** @brief Coordinates, and over how much of them the eye looks at once (0: a point). */
typedef struct texture_point2 {
    vec2 st;
    float ds, dt;
} texture_point2;

struct mapping_kind;

/** @brief The parameters that mappings to the plane read. */
#define MAPPING_PARAMETERS "mapping uscale vscale udelta vdelta v1 v2"

/** @brief A mapping to the plane. Plain value. */
typedef struct mapping2 {
    const struct mapping_kind *kind;
    transform to_texture; /**< from the world */
    vec2 scale, delta;    /**< of uv; delta also of planar */
    vec3 v1, v2;          /**< planar */
} mapping2;

/** @brief Reads "mapping" and the parameters of the one chosen. */
bool mapping2_init(mapping2 *m, const params *p, GError **error);
texture_point2 mapping2_eval(const mapping2 *m, const surface_hit *hit);
/** @brief Names of mappings, NULL-terminated. */
const char *const *mapping2_names(void);
