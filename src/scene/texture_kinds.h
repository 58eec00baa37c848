/*
 * The kinds of textures: one file and one row each.
 */
#pragma once

#include "scene/texture.h"

extern const texture_kind texture_constant;
extern const texture_kind texture_imagemap;
extern const texture_kind texture_gltf;
