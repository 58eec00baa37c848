/*
 * What a mesh can do without: normals, tangents and texture coordinates that are no
 * numbers, as exporters write them for vertices of no faces and faces of no area.
 */
#pragma once

#include "base/log.h"
#include "shape/shape.h"

/** @brief Makes those 0, which is none; says in a note at the place how many they were.
 */
void mesh_drop_bad(mesh *m, source_place place, const log_sink *log);
