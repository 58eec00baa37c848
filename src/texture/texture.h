/*
 * Textures: functions of the surface point, float- or spectrum-valued.
 */
#pragma once

#include "color/curve.h"
#include "medium/hit.h"
#include "params/build_context.h"
#include "params/params.h"

/** @brief A texture. Made by a row of the kinds table, immutable after. */
typedef struct texture texture;

/** @brief What a kind of texture must do. `create` reads the parameters it knows. */
typedef struct texture_kind {
    const char *name; /**< "constant", "imagemap" */
    const char
        *parameters; /**< those it reads, with spaces between; others are unknown */
    void *(*create)(const build_context *context, bool is_spectrum, const params *p,
                    GError **error);
    void (*free)(void *self);
    float (*eval_float)(const void *self, const surface_hit *hit);
    spectrum (*eval_spectrum)(const void *self, const surface_hit *hit,
                              const wavelengths *w, curve_role role);
    /** The picture's red, green and blue as they are stored, and the tangents of its
     * coordinates where they are not the hit's own: a normal map. NULL: can be none. */
    void (*eval_normal)(const void *self, const surface_hit *hit, float rgb[3],
                        vec3 *dpdu, vec3 *dpdv);
    /** texture_steps of all textures that it is made of, each as often as it looks at it.
     * NULL: it is made of none. */
    unsigned (*input_steps)(const void *self);
} texture_kind;

texture *texture_new(const build_context *context, const char *kind, bool is_spectrum,
                     const params *p, GError **error);
void texture_free(texture *t);
bool texture_is_spectrum(const texture *t);
/** @brief "imagemap" and the like. */
const char *texture_kind_name(const texture *t);
/** @brief The texture that parameter q names, of the type wanted; NULL with ERROR_INPUT
 * at its place. */
const texture *texture_find(const build_context *context, const param *q,
                            bool is_spectrum, GError **error);
float texture_eval_float(const texture *t, const surface_hit *hit);
spectrum texture_eval_spectrum(const texture *t, const surface_hit *hit,
                               const wavelengths *w, curve_role role);
/** @brief How many textures one evaluation looks at, itself among them: what bounds its
 * time, and how deep it calls. NULL: 0. */
unsigned texture_steps(const texture *t);
/** @brief True if texture_eval_normal may be asked for. */
bool texture_is_normal_map(const texture *t);
/** @brief As texture_kind's eval_normal; *dpdu and *dpdv come as those of the hit. */
void texture_eval_normal(const texture *t, const surface_hit *hit, float rgb[3],
                         vec3 *dpdu, vec3 *dpdv);
/** @brief Kind number i of the table; NULL behind the last. */
const texture_kind *texture_kind_at(size_t i);

/**
 * @brief A material's input: a constant curve or number, or a texture (borrowed from the
 * scene).
 */
typedef struct spectrum_input {
    curve *constant;        /**< owned; NULL if textured */
    const texture *texture; /**< borrowed */
    curve_role role;
} spectrum_input;

typedef struct float_input {
    float constant;
    const texture *texture; /**< borrowed; NULL: constant */
} float_input;

/** @brief Reads parameter `name` (spectrum, rgb, ... or texture). Absent: fallback is
 * what it means (its reference is taken in any case; NULL leaves the input empty). A
 * texture must be named in the scene and of the type. */
bool spectrum_input_init(spectrum_input *in, const build_context *context,
                         const params *p, const char *name, curve_role role,
                         curve *fallback, GError **error);
void spectrum_input_clear(spectrum_input *in);
bool spectrum_input_given(const spectrum_input *in);
spectrum spectrum_input_eval(const spectrum_input *in, const surface_hit *hit,
                             const wavelengths *w);
bool float_input_init(float_input *in, const build_context *context, const params *p,
                      const char *name, float fallback, GError **error);
float float_input_eval(const float_input *in, const surface_hit *hit);
