/*
 * assimp's scene as records: flat, plain and without what is not rendered, which a note
 * tells.
 */
#pragma once

#include "format/model/child/out.h"

#include <assimp/scene.h>

void tell_scene(out *o, const struct aiScene *scene);
/** @brief Materials, and the images that lie in the model's file. */
void tell_materials(out *o, const struct aiScene *scene);
