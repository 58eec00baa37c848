/*
 * What is taken for things that can not be rendered, where the user asked for that
 * (--lenient): every replacement is told as a warning with its place.
 */
#pragma once

#include "params/build_context.h"
#include "params/params.h"

/** @brief The material that is taken for one of a kind that can not be rendered (hair,
 * subsurface, measured, v3's fourier and others), with the parameters that it shares with
 * it; owned by the caller.
 * @param kind becomes that of the substitute
 * @return NULL: nothing is to be replaced (kind is as it was), or, with ERROR_INPUT, the
 * scene is not read leniently */
params *lenient_material(const build_context *context, const char **kind, const params *p,
                         GError **error);
/** @brief True if a participating medium of one of pbrt's kinds that can not be rendered
 * becomes empty space. Else *error is set if the scene is not read leniently, and
 * nothing is if the kind is another. */
bool lenient_medium(const build_context *context, const char *name, const char *kind,
                    const params *p, GError **error);
/** @brief True if a shape of one of v3's kinds that can not be rendered is left out; as
 * lenient_medium. */
bool lenient_shape(const build_context *context, const char *kind, const params *p,
                   GError **error);
/** @brief The same as lenient_material for textures: ptex. */
params *lenient_texture(const build_context *context, const char **kind, bool is_spectrum,
                        const params *p, GError **error);
