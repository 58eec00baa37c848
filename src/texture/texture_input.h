/*
 * What textures are made from: a number, a spectrum or another texture, of the type that
 * the texture itself has. A spectrum's role is only known where it is asked for: an rgb
 * value is another curve as an albedo than as a light.
 */
#pragma once

#include "texture/texture.h"

typedef struct texture_input {
    const texture *texture; /**< borrowed; NULL: constant */
    float number;           /**< of a float texture's */
    curve *by_role[3];      /**< of a spectrum texture's; owned */
} texture_input;

/** @brief Reads parameter `name`; absent it is fallback. Cleared by texture_input_clear
 * also on failure. */
bool texture_input_init(texture_input *in, const build_context *context, const params *p,
                        const char *name, bool is_spectrum, float fallback,
                        GError **error);
void texture_input_clear(texture_input *in);
float texture_input_float(const texture_input *in, const surface_hit *hit);
spectrum texture_input_spectrum(const texture_input *in, const surface_hit *hit,
                                const wavelengths *w, curve_role role);
