/*
 * The files that stand beside a converted scene: meshes, and the images and spectra that
 * it names, copied once each into one folder.
 *
 *   OUT.pbrt ── OUT-files/mesh-1.ply, wood.png ...
 *
 * They appear together, when all that is converted has been read: what is there by those
 * names may be among it.
 */
#pragma once

#include "base/output.h"

#include <glib.h>
#include <stdbool.h>

struct scene_builder;

typedef struct converted_files {
    const struct scene_builder
        *builder;             /**< that may hold some of them itself; borrowed */
    char *directory, *folder; /**< owned: its path, and its name beside the scene */
    GHashTable *names;        /**< absolute path -> name relative to the scene */
    GPtrArray *outputs;       /**< closed, of all files; owned */
    GPtrArray *paths;         /**< where each will be; owned */
    bool made_folder;         /**< it was not there before */
    GError *error;            /**< the first one */
} converted_files;

/** @brief For a scene that is written to `out`; nothing is made yet. */
void converted_files_init(converted_files *f, const char *out);
/** @brief Drops what was not committed. */
void converted_files_clear(converted_files *f);
/** @brief Begins a file in the folder. @return NULL if there has been an error */
output *converted_files_open(converted_files *f, const char *name);
/** @brief Ends it. */
void converted_files_close(converted_files *f, const char *name, output *out);
/** @brief Puts all of them in place, unless that replaced one that was read. */
bool converted_files_commit(converted_files *f, GError **error);
/** @brief Where a file now is, relative to the scene; NULL if there is no such file. */
const char *converted_files_copy(converted_files *f, const char *path);
