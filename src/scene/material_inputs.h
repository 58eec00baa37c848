/*
 * Parameters that several materials have.
 */
#pragma once

#include "scene/microfacet.h"
#include "scene/texture.h"

/** @brief pbrt's roughness, uroughness, vroughness and remaproughness. */
typedef struct roughness_input {
    float_input u, v;
    bool remap; /**< alpha = sqrt(roughness), else roughness itself */
} roughness_input;

/** @param prefix of the names, "" or "interface." and the like; remaproughness has none
 */
bool roughness_input_init(roughness_input *in, const char *prefix, const struct scene *s,
                          const params *p, GError **error);
ggx roughness_input_eval(const roughness_input *in, const surface_hit *hit);
bool roughness_input_is_constant(const roughness_input *in);
/** @brief Lobe classes that may occur. */
unsigned roughness_input_classes(const roughness_input *in);

/** @brief Parameter `name` as a number or a spectrum, 1.5 if absent; NULL with
 * ERROR_INPUT unless it is > 0 over the range of wavelengths. */
curve *eta_input(const params *p, const char *name, GError **error);

/** @brief Checks "albedo" and "g" of the medium in a coat: it may not scatter. */
bool coat_input_medium(const params *p, GError **error);
/** @brief A number >= 1. */
bool coat_input_count(const params *p, const char *name, int *out, GError **error);
/** @brief "thickness" >= 0, pbrt-v4's 0.01 if absent. */
bool coat_input_thickness(const params *p, float *out, GError **error);
