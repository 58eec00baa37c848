/*
 * The kinds of shapes, one file each; shape.c has the table.
 */
#pragma once

#include "shape/shape.h"

extern const shape_kind mesh_kind;
extern const shape_kind sphere_kind;
extern const shape_kind disk_kind;
extern const shape_kind cylinder_kind;
extern const shape_kind bilinear_kind;
extern const shape_kind subdivision_kind; /**< becomes a mesh */
extern const shape_kind curve_kind;

/** @brief What mesh_kind keeps: the mesh moved to world space and checked. Takes the
 * arrays of m, also on failure. */
void *mesh_shape_create(mesh *m, const shape_place *at, source_place place,
                        GError **error);
