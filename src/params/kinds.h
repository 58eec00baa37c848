/*
 * Kinds of a registry by their names: materials, textures, shapes, lights.
 */
#pragma once

#include "base/error.h"

/** @brief The name of kind i of a table; NULL behind the last. Neighbours may share one;
 * an empty one is not to be asked for. */
typedef const char *(*kind_name)(size_t i);

/** @brief The first kind of that name.
 *  @return its number; -1 if there is none, with kind_unknown's error */
int kind_find(kind_name name_of, const char *what, const char *name, source_place place,
              GError **error);

/** @brief Sets ERROR_INPUT: "expected WHAT of kind A, B, C, found 'NAME'". */
void kind_unknown(kind_name name_of, const char *what, const char *name,
                  source_place place, GError **error);
