/*
 * The kinds of textures: one file and one row each.
 */
#pragma once

#include "texture/texture.h"

extern const texture_kind texture_bilerp;
extern const texture_kind texture_checkerboard;
extern const texture_kind texture_constant;
extern const texture_kind texture_direction_mix;
extern const texture_kind texture_dots;
extern const texture_kind texture_fbm;
extern const texture_kind texture_marble;
extern const texture_kind texture_mix;
extern const texture_kind texture_scale;
extern const texture_kind texture_windy;
extern const texture_kind texture_wrinkled;
extern const texture_kind texture_imagemap;
extern const texture_kind texture_gltf;
