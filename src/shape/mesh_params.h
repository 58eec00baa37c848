/*
 * The parameters that all shapes made of vertices and faces share: trianglemesh,
 * bilinearmesh, loopsubdiv.
 */
#pragma once

#include "params/params.h"

#include <stdint.h>

/** @brief How messages call the shape, and the corners of its faces. */
typedef struct mesh_words {
    const char *shape, *face;
    size_t corners;
} mesh_words;

/** @brief The numbers of a per-vertex parameter, `width` each, big_alloc'ed with one
 * float of padding behind. *out stays NULL if absent or empty.
 * @param n_vertices 0: not known yet, this parameter tells */
bool mesh_read_numbers(const mesh_words *words, const params *p, const char *name,
                       param_type type, size_t width, size_t *n_vertices, float **out,
                       GError **error);
/** @brief "P", which must be there. */
bool mesh_read_points(const mesh_words *words, const params *p, size_t *n_vertices,
                      float **out, GError **error);
/** @brief "indices" in range, big_alloc'ed; they may be absent if the vertices make one
 * face in their order. "faceIndices", which numbers faces for Ptex files, is checked and
 * has no further meaning. */
bool mesh_read_indices(const mesh_words *words, const params *p, size_t n_vertices,
                       size_t *n_faces, uint32_t **out, GError **error);
