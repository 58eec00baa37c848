/*
 * A model as the importer's child told it (stream.h): a list of what lies where in those
 * bytes, all of it checked. What reads the bytes takes them for hostile: the child may
 * have been taken over by the file that it read.
 */
#pragma once

#include "base/error.h"
#include "format/model/stream.h"

/** @brief Arrays as math/mesh.h's mesh has them; NULL where there are none. */
typedef struct model_mesh {
    size_t n_vertices, n_triangles;
    uint32_t material;
    const float *positions, *normals, *uvs;
    const uint32_t *indices; /**< in range */
} model_mesh;

typedef struct model_material {
    const stream_material *numbers;
    const char *name, *maps[N_STREAM_MAPS]; /**< any bytes but 0 */
} model_material;

typedef struct model_image {
    const char *name, *extension; /**< any bytes but 0 */
    const void *bytes;
    size_t size; /**< 0: of bare pixels */
} model_image;

typedef struct model {
    GArray *meshes, *materials, *images;   /**< of the above */
    GPtrArray *instances, *lights, *notes; /**< stream_instance and so on; notes: char* */
    const stream_camera *camera;           /**< NULL: none */
} model;

/**
 * @brief Reads a stream; a note for the developer goes to g_debug.
 * @param bytes aligned to 8; out points into them
 * @param out cleared by model_clear, also after a failure, when it has the notes that
 * came before; every material, mesh and image that another names is there
 * @return false with ERROR_INPUT, without a place, or ERROR_FAILED (memory); what the
 * child itself says is wrong is such an error
 */
bool model_read(const void *bytes, size_t size, model *out, GError **error);
void model_clear(model *m);
