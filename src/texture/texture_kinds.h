/*
 * The kinds of textures: one file and one row each.
 */
#pragma once

#include "texture/texture.h"

#define TEXTURE(kind, file) extern const texture_kind texture_##kind;
#include "texture/texture.def"
#undef TEXTURE
