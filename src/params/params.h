/*
 * Parameter lists: what a scene file says of one shape, material, light ..., typed, each
 * with its place. A reader (pbrt text, glTF) fills one; the kind that is made from it
 * asks for what it knows, and what nobody asked for is an error at its place.
 */
#pragma once

#include "base/error.h"
#include "base/log.h"
#include "color/curve.h"
#include "math/transform.h"
#include "math/vec.h"

typedef enum param_type {
    PARAM_FLOAT,
    PARAM_INTEGER,
    PARAM_BOOL,
    PARAM_STRING,
    PARAM_POINT2,
    PARAM_VECTOR2,
    PARAM_POINT3,
    PARAM_VECTOR3,
    PARAM_NORMAL,
    PARAM_RGB,       /**< three numbers, read by role and colour space when asked for */
    PARAM_BLACKBODY, /**< kelvin */
    PARAM_SPECTRUM,  /**< (nm, value) pairs, already read from the file if it was one */
    PARAM_SPECTRUM_NAME, /**< a name, in strings[0] */
    PARAM_TEXTURE,       /**< a texture's name in strings[0] */
} param_type;

/** @brief pbrt's word for a type: "float", "point3". */
const char *param_type_name(param_type type);

/** @brief One parameter. Owned by its list. */
typedef struct param {
    const char *name; /**< interned */
    param_type type;
    source_place place; /**< where its declaration stands */
    size_t n;           /**< numbers or strings given */
    float *numbers;     /**< FLOAT, POINT.., RGB, BLACKBODY, SPECTRUM; n of them */
    int *integers;      /**< INTEGER, BOOL */
    char **strings;     /**< STRING, SPECTRUM_NAME, TEXTURE */
    bool used;          /**< asked for by its consumer */
    bool is_default;    /**< of an Attribute: for whichever kind wants it */
} param;

/** @brief A list of parameters with the context they were read in. */
typedef struct params {
    GPtrArray *list;            /**< of param* */
    source_place place;         /**< of the directive */
    const char *base_directory; /**< interned; relative file names are relative to it */
    const color_space *space;
    transform to_world;  /**< from the space that the directive stands in; identity unless
                            the reader says otherwise */
    const log_sink *log; /**< where consumers note what they do not take; may be NULL */
    bool lets_unknown;   /**< a parameter that its consumer does not know is noted, and
                            no error: pbrt-v3 goes on too */
} params;

params *params_new(source_place place, const char *base_directory,
                   const color_space *space);
/** @brief An empty list with the context of another. */
params *params_new_like(const params *p);
void params_free(params *p);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(params, params_free)

/* Adding; numbers and strings are copied. ERROR_INPUT if the name is already there. */
bool params_add_numbers(params *p, source_place place, param_type type, const char *name,
                        const float *numbers, size_t n, GError **error);
bool params_add_integers(params *p, source_place place, param_type type, const char *name,
                         const int *integers, size_t n, GError **error);
bool params_add_strings(params *p, source_place place, param_type type, const char *name,
                        const char *const *strings, size_t n, GError **error);

/** @brief Adds a copy of a parameter of another list. */
bool params_add_copy(params *p, const param *q, GError **error);
/** @brief Takes the parameter of that name out, if there is one. */
void params_remove(params *p, const char *name);
/** @brief The parameter of that name, marked used; NULL if there is none. */
const param *params_find(const params *p, const char *name);
bool params_has(const params *p, const char *name); /**< does not mark it used */
/** @brief The parameter, to be changed by who reads the file; does not mark it used.
 * @return NULL: there is none */
param *params_look_up(const params *p, const char *name);

/*
 * Asking. Each marks the parameter used. Absent: *out is left as it is and true returned.
 * Present with another type or count, or not finite: false with ERROR_INPUT at its place.
 */
bool params_float(const params *p, const char *name, float *out, GError **error);
bool params_integer(const params *p, const char *name, int *out, GError **error);
bool params_bool(const params *p, const char *name, bool *out, GError **error);
/** @brief *out is owned by the list. */
bool params_string(const params *p, const char *name, const char **out, GError **error);
bool params_point3(const params *p, const char *name, vec3 *out, GError **error);
/** @brief A spectrum by role: rgb, blackbody, spectrum or spectrum name; *out owned by
 * caller. */
bool params_curve(const params *p, const char *name, curve_role role, curve **out,
                  GError **error);
/** @brief One of a NULL-terminated list of words; *out is its index. */
bool params_choice(const params *p, const char *name, const char *const *words, int *out,
                   GError **error);
/** @brief An absolute path from a string parameter (relative to base_directory); owned by
 * the caller; NULL if absent. */
bool params_path(const params *p, const char *name, char **out, GError **error);

/** @brief false with ERROR_INPUT at the first parameter that is in none of two lists of
 * names (with spaces between; either may be NULL) and that nobody asked for:
 *  "unknown parameter 'x' of <what>". */
bool params_known(const params *p, const char *what, const char *names, const char *more,
                  GError **error);
/** @brief false with ERROR_INPUT at the first parameter nobody asked for:
 *  "unknown parameter 'x' of <what>". */
bool params_all_used(const params *p, const char *what, GError **error);
