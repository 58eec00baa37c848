/*
 * The files that stand beside a converted scene: meshes, and the images and spectra that
 * it names, copied once each into one folder.
 *
 *   OUT.pbrt ── OUT-files/mesh-1.ply, wood.png ...
 */
#pragma once

#include <glib.h>
#include <stdbool.h>

struct scene;

typedef struct converted_files {
    const struct scene *scene; /**< that may hold some of them itself; borrowed */
    char *directory, *folder;  /**< owned: its path, and its name beside the scene */
    GHashTable *names;         /**< absolute path -> name relative to the scene */
    GError *error;             /**< the first one */
} converted_files;

/** @brief For a scene that is written to `out`; nothing is made yet. */
void converted_files_init(converted_files *f, const char *out);
void converted_files_clear(converted_files *f);
/** @brief Makes the folder. @return false if there has been an error */
bool converted_files_folder(converted_files *f);
/** @brief Where a file now is, relative to the scene; NULL if there is no such file. */
const char *converted_files_copy(converted_files *f, const char *path);
