/*
 * The kinds of materials: one file and one row each.
 */
#pragma once

#include "material/material.h"

#define MATERIAL(kind, file) extern const material_kind material_##kind;
#include "material/material.def"
#undef MATERIAL
