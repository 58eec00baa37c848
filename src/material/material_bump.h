/*
 * What bends the shading normal of any material: a normal map, or a displacement that is
 * felt but not moved (Blinn, "Simulation of Wrinkled Surfaces", 1978).
 */
#pragma once

#include "medium/hit.h"
#include "params/build_context.h"
#include "params/params.h"

typedef struct bump bump;

/** @brief Reads "normalmap" (a file, or ours: a texture), "normalscale" (ours) or
 * "displacement". *out is NULL if none is given; owned by the caller. @return false with
 * ERROR_INPUT */
bool bump_new(bump **out, const build_context *context, const params *p, GError **error);
void bump_free(bump *b); /**< NULL is allowed */

/** @brief The shading frame at a hit: n bent, s along the surface's tangent. */
frame bump_frame(const bump *b, const surface_hit *hit);
