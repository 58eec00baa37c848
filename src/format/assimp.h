/*
 * The state shared by the parts of the reader that goes through assimp.
 */
#pragma once

#include "scene/scene.h"

#include <assimp/scene.h>

/** @brief A material as a scene has it. */
typedef struct assimp_material {
    int index;      /**< NO_INDEX: not made yet */
    int open_index; /**< the same on a mesh that encloses nothing; NO_INDEX: not yet */
    bool is_glass;  /**< its meshes are asked whether they are closed */
    params *area_light; /**< owned; NULL: does not shine */
    params *alpha;      /**< "alpha" of its shapes, owned; NULL: opaque */
    bool is_read;
} assimp_material;

typedef struct assimp_reader {
    scene *scene;
    const char *path;
    char *directory;
    const struct aiScene *source;
    assimp_material *materials; /**< per material */
    GHashTable *notes;          /**< texts given already */
    vec3 up;
} assimp_reader;

/** @brief aiImportFile; the files it opens go to sources, which may be NULL. */
const struct aiScene *assimp_import(scene_sources *sources, const char *path,
                                    unsigned steps);

params *assimp_params(const assimp_reader *r);
/** @brief A note, once however often it is met. */
void assimp_note(assimp_reader *r, const char *format, ...) G_GNUC_PRINTF(2, 3);

/** @brief What is known of a material; NULL with ERROR_INPUT. */
const assimp_material *assimp_material_of(assimp_reader *r, unsigned index,
                                          GError **error);
/** @brief Its index in the scene, made if it is new; NO_INDEX with ERROR_INPUT.
 * @param closed the mesh encloses a volume */
int assimp_material_index(assimp_reader *r, unsigned index, bool closed, GError **error);

/** @brief Lights and the first camera; false with ERROR_INPUT. */
bool assimp_add_lights(assimp_reader *r, GError **error);
bool assimp_add_camera(assimp_reader *r, GError **error);
/** @brief The transform of the node of that name to the world; identity if there is none.
 */
transform assimp_node_to_world(const assimp_reader *r, const char *name);
/** @brief false if it flattens space. */
bool assimp_transform(const struct aiMatrix4x4 *m, transform *out);
