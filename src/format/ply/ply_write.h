/*
 * Meshes as binary PLY files.
 */
#pragma once

#include "base/output.h"
#include "shape/shape.h"

/** @brief Writes positions, normals and uv (whichever there are) and triangles; what
 * fails shows at the output's end. */
void ply_write(output *out, const mesh *m);
