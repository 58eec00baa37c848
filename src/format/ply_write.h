/*
 * Meshes as binary PLY files.
 */
#pragma once

#include "scene/shape.h"

/** @brief Writes positions, normals and uv (whichever there are) and triangles.
 * @return false with ERROR_INPUT or ERROR_FAILED naming the file */
bool ply_write(const char *path, const mesh *m, GError **error);
