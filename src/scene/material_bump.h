/*
 * What bends the shading normal of any material: a normal map, or a displacement that is
 * felt but not moved (Blinn, "Simulation of Wrinkled Surfaces", 1978).
 */
#pragma once

#include "scene/hit.h"
#include "scene/params.h"

struct scene;

typedef struct bump bump;

/** @brief Reads "normalmap" (a file, or ours: a texture), "normalscale" (ours) or
 * "displacement". *out is NULL if none is given; owned by the caller. @return false with
 * ERROR_INPUT */
bool bump_new(bump **out, const struct scene *s, const params *p, GError **error);
void bump_free(bump *b); /**< NULL is allowed */

/** @brief The shading frame at a hit: n bent, s along the surface's tangent. */
frame bump_frame(const bump *b, const surface_hit *hit);
