/*
 * Whether a mesh encloses a volume: what makes glass solid.
 */
#pragma once

#include "shape/shape.h"

typedef struct mesh_body {
    bool closed;   /**< every edge is shared by an even number of triangles */
    double volume; /**< m³, if closed: negative if the corners turn inwards */
} mesh_body;

/** @brief Looks at a mesh whose indices are in range; vertices at one place count as one.
 * @return false with ERROR_FAILED (memory) */
bool mesh_body_of(const mesh *m, mesh_body *out, GError **error);
