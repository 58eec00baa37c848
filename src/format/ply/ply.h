/*
 * Triangle meshes from PLY files: text or binary of either byte order, plain or gzip'ed.
 * Greg Turk, "The PLY Polygon File Format", 1994.
 */
#pragma once

#include "shape/shape.h"

/**
 * @brief Reads the mesh in the file's own space.
 *
 * Of the vertices x y z, nx ny nz and u v (or s t, texture_u texture_v, texture_s
 * texture_t) are read, and, as ply_write has them, u2 v2 (a second set), tx ty tz
 * (tangents) and color_r to color_a; of the faces the list vertex_indices (or
 * vertex_index) with three or four corners; a quad becomes two triangles. Everything else
 * is passed over.
 * @param out gets arrays the caller owns (mesh_clear); untouched on failure
 * @return false with ERROR_INPUT naming file and line or byte, or ERROR_FAILED
 */
bool ply_read(const char *path, mesh *out, GError **error);
