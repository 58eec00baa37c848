/*
 * The state shared by the parts that make a scene of a model.
 */
#pragma once

#include "format/model/model.h"
#include "scene/builder.h"

/** @brief A material as a scene has it. */
typedef struct model_look {
    int index;      /**< NO_INDEX: not made yet */
    int open_index; /**< the same on a mesh that encloses nothing; NO_INDEX: not yet */
    bool is_glass;  /**< its meshes are asked whether they are closed */
    params *area_light; /**< owned; NULL: does not shine */
    params *alpha;      /**< "alpha" of its shapes, owned; NULL: opaque */
    bool is_read;
} model_look;

typedef struct model_builder {
    scene_builder *builder;
    const char *path;
    char *directory;
    const model *source;
    model_look *looks; /**< per material */
    GHashTable *notes; /**< texts given already */
    vec3 up;
} model_builder;

params *model_params(const model_builder *b);
/** @brief A note, once however often it is met. */
void model_tell(model_builder *b, const char *format, ...) G_GNUC_PRINTF(2, 3);

/** @brief What is known of a material; NULL with ERROR_INPUT. */
const model_look *model_look_of(model_builder *b, unsigned index, GError **error);
/** @brief Its index in the scene, made if it is new; NO_INDEX with ERROR_INPUT.
 * @param closed the mesh encloses a volume */
int model_material_index(model_builder *b, unsigned index, bool closed, GError **error);

/** @brief Lights and the first camera; false with ERROR_INPUT. */
bool model_add_lights(model_builder *b, GError **error);
bool model_add_camera(model_builder *b, GError **error);
/** @brief false if it flattens space. */
bool model_transform(const double rows[16], transform *out);
