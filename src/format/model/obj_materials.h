/*
 * The files of materials that a Wavefront OBJ file names, found before it is imported:
 * the importer can open none by itself. It puts grey in the place of what is missing, and
 * says nothing.
 */
#pragma once

#include "scene/builder.h"

/** @brief Finds the files of materials (mtllib), and warns of those and of materials
 * (usemtl) that are named and missing.
 * @return import_file, those that are there; owned by the caller */
GArray *obj_material_files(scene_builder *to, const char *path);
