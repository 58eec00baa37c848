/*
 * What becomes of glTF's extensions: the one list that files which require any are
 * checked by, that notes are made of, and that the manual's table is.
 */
#pragma once

#include <glib.h>
#include <stdbool.h>

typedef enum gltf_support {
    GLTF_RENDERED,
    GLTF_APPROXIMATED,
    GLTF_LEFT_OUT, /**< with a note, also where a file requires it: only looks differ */
    GLTF_REFUSED,  /**< data that can not be read without it */
} gltf_support;

typedef struct gltf_extension_row {
    const char *name;
    gltf_support support;
    const char *note; /**< for the manual; "" if none */
} gltf_extension_row;

/** @brief A row by name, or NULL. */
const gltf_extension_row *gltf_find_extension(const char *name);
/** @brief Markdown lines of a table with the columns extension, what becomes of it, note.
 */
void gltf_append_features(GString *out);
