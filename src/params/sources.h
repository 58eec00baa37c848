/*
 * Which files a scene is read from. Who opens one for a scene says so first, so that the
 * list is whole also where reading fails: a program that watches them sees the mended or
 * missing one come.
 */
#pragma once

#include <glib.h>

typedef struct scene_sources scene_sources;

/** @brief Told every path as it comes. */
typedef void (*source_func)(const char *path, void *data);

/** @param told may be NULL */
scene_sources *scene_sources_new(source_func told, void *data);
void scene_sources_free(scene_sources *sources);
/** @brief A file is about to be opened. The path may be relative to the working folder; a
 * file counts once. sources may be NULL: nobody asks. */
void scene_sources_add(scene_sources *sources, const char *path);
/** @brief Absolute paths in the order they came; NULL-terminated, borrowed. */
const char *const *scene_sources_paths(const scene_sources *sources);
