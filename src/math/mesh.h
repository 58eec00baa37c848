/*
 * Triangles as plain arrays: what readers fill in, and what a hit on a mesh looks its
 * vertices up in.
 */
#pragma once

#include "math/vec.h"

#include <stddef.h>
#include <stdint.h>

/** @brief A triangle mesh; arrays big_alloc'ed, owned. */
typedef struct mesh {
    size_t n_vertices, n_triangles;
    float *positions; /**< 3 per vertex, one float of padding at the end (Embree) */
    float *normals;   /**< 3 per vertex, unit; NULL: flat */
    float *tangents;  /**< 3 per vertex; NULL */
    vec2 *uvs;        /**< per vertex; NULL: pbrt's default (0,0) (1,0) (1,1) by corner */
    vec2 *uvs2;       /**< a second set, for textures that ask for it; NULL: as uvs */
    float *colors;    /**< 4 per vertex, linear and opacity, likewise; NULL: white */
    uint32_t *indices; /**< 3 per triangle */
} mesh;

/** @brief Frees the arrays; the mesh is empty after. */
void mesh_clear(mesh *m);
