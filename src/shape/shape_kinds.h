/*
 * The kinds of shapes, one file each; shape.c has the table.
 */
#pragma once

#include "shape/shape.h"

#define SHAPE(kind, file) extern const shape_kind shape_##kind;
#include "shape/shape.def"
#undef SHAPE

/** @brief What shape_mesh keeps: the mesh moved to world space and checked. Takes the
 * arrays of m, also on failure. */
void *mesh_shape_create(mesh *m, const shape_place *at, source_place place,
                        GError **error);
