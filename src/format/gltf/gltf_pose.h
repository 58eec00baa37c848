/*
 * Morph targets and skins: the shape that a mesh has as its node shows it, at rest.
 */
#pragma once

#include "format/gltf/gltf.h"

/** @brief What a joint does to a vertex: the upper three rows of a matrix. */
typedef struct gltf_joint {
    double m[3][4];
} gltf_joint;

struct gltf_pose {
    double *weights; /**< of morph targets, owned */
    guint n_weights;
    gltf_joint *joints; /**< owned; NULL: no skin */
    guint n_joints;
    bool is_own; /**< the node's: other nodes with the mesh may have another */
};

/** @brief Whether a node says of itself how its mesh is bent. */
bool gltf_pose_is_own(const gltf *g, const json_value *node);
/** @brief The pose that a node gives its mesh `of`. @return false with an error noted;
 * to be cleared in any case */
bool gltf_pose_read(gltf *g, const json_value *node, const json_value *of,
                    gltf_pose *pose);
void gltf_pose_clear(gltf_pose *pose);
/** @brief Bends the mesh of a primitive.
 *  @return true if a skin has put it into the world; check gltf_failed */
bool gltf_pose_apply(gltf *g, const json_value *primitive, const gltf_pose *pose,
                     mesh *m);
