/*
 * Animations: where nodes stand, and how meshes are bent, at a time.
 *
 *   key frames:  time[k] ─► value[k]      constant, linear (turns along the shorter arc)
 *                                         or by cubic splines in between
 *
 * Before the first key and after the last a channel stands still. Of several animations
 * the first is taken. Khronos, "glTF 2.0 Specification", 3.11 and appendix C, 2021.
 */
#pragma once

#include "format/gltf/gltf.h"

/** @brief What animations make of a node. */
struct gltf_moved {
    bool has_translation, has_rotation, has_scale;
    double translation[3], rotation[4], scale[3];
    double *weights; /**< of morph targets, owned; NULL: as the node says */
    guint n_weights;
};

/** @brief Fills g->moved if the scene is asked for at a time; else notes that animations
 * are left out, if there are any. Errors are noted. */
void gltf_read_animations(gltf *g);
void gltf_forget_animations(gltf *g);
