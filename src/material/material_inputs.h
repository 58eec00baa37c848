/*
 * Parameters that several materials have.
 */
#pragma once

#include "bsdf/microfacet.h"
#include "texture/texture.h"

struct bsdf_options;
struct coat_layers;

/** @brief pbrt's roughness, uroughness, vroughness and remaproughness. */
typedef struct roughness_input {
    float_input u, v;
    bool remap; /**< alpha = sqrt(roughness), else roughness itself */
} roughness_input;

/** @param prefix of the names, "" or "interface." and the like; remaproughness has none
 */
bool roughness_input_init(roughness_input *in, const char *prefix,
                          const build_context *context, const params *p, GError **error);
ggx roughness_input_eval(const roughness_input *in, const surface_hit *hit);
bool roughness_input_is_constant(const roughness_input *in);
/** @brief Lobe classes that may occur. */
unsigned roughness_input_classes(const roughness_input *in);

/** @brief Parameter `name` as a number or a spectrum, 1.5 if absent; NULL with
 * ERROR_INPUT unless it is > 0 over the range of wavelengths. */
curve *eta_input(const params *p, const char *name, GError **error);

/** @brief A metal: its index, copper's if nothing is given, or in place of it the
 * reflectance at normal incidence, which is read as eta = 1 and
 * k = 2 sqrt(r / (1 - r)) as pbrt-v4 does. */
typedef struct metal_input {
    spectrum_input eta, k, reflectance;
} metal_input;

/** @param prefix of "eta" and "k"; "reflectance" has none. Cleared by metal_input_clear
 * also on failure. */
bool metal_input_init(metal_input *in, const char *prefix, const build_context *context,
                      const params *p, GError **error);
void metal_input_clear(metal_input *in);
void metal_input_eval(const metal_input *in, const surface_hit *hit, const wavelengths *w,
                      spectrum *eta, spectrum *k);

/** @brief What pbrt's coats have beside their face and their base: "thickness" (0.01 if
 * absent), "albedo" (0) and "g" (0) of the particles in them, "maxdepth" (10) and
 * "nsamples" (1) of the walks. */
typedef struct coat_input {
    float_input thickness, g;
    spectrum_input albedo;
    int max_depth, n_walks;
} coat_input;

/** @brief Cleared by coat_input_clear also on failure. */
bool coat_input_init(coat_input *in, const build_context *context, const params *p,
                     GError **error);
void coat_input_clear(coat_input *in);
/** @brief True if nothing is scattered in it and it is alike everywhere. */
bool coat_input_is_plain(const coat_input *in);
/** @brief Fills thickness, g, albedo, max_depth, n_walks and seed. */
void coat_input_eval(const coat_input *in, const surface_hit *hit, const wavelengths *w,
                     const struct bsdf_options *options, struct coat_layers *out);
