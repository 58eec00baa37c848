/*
 * Whether the materials that a Wavefront OBJ file names are there. The importer puts grey
 * in the place of what is missing, and says nothing.
 */
#pragma once

#include "scene/scene.h"

/** @brief Warns of files of materials (mtllib) and of materials (usemtl) that an OBJ file
 * names and that are missing; of a file of another kind, or none, nothing. */
void obj_check_materials(scene *s, const char *path);
