/*
 * Rectangles, as most area lights are: points drawn on them uniformly by the solid angle
 * in which they are seen (Ureña, Fajardo & King, "An Area-Preserving Parametrization for
 * Spherical Rectangles", 2013). Two triangles are one of them, so that neither must be
 * chosen first and the numbers that draw the point stay stratified over both.
 */
#pragma once

#include "math/mesh.h"
#include "math/vec.h"

/** @brief A rectangle in space. */
typedef struct rectangle {
    vec3 corner;
    vec3 x, y, n; /**< unit: along its sides, and across */
    float width, height;
} rectangle;

/** @brief The rectangle with sides from p00 to p10 and to p01. @return false if p11 does
 * not make it one, or it has no area */
bool rectangle_from_corners(vec3 p00, vec3 p10, vec3 p01, vec3 p11, rectangle *out);

/** @brief A rectangle as it is seen from a point: that is the origin, the rectangle's
 * axes are the axes. */
typedef struct seen_rectangle {
    float x0, x1, y0, y1;
    float z;           /**< how far off its plane is, >= 0 */
    float solid_angle; /**< 0..2 pi; 0 also where it is small and far */
} seen_rectangle;

seen_rectangle rectangle_seen_from(const rectangle *r, vec3 ref);

/** @brief True if points are drawn by solid angle; else that loses digits or is not worth
 * its price, and they are drawn by area. */
bool rectangle_by_angle(const seen_rectangle *seen);

/** @brief Where in the rectangle, 0..1 along x and y: uniform by solid angle, or by area
 * as rectangle_by_angle tells. */
vec2 rectangle_sample(const seen_rectangle *seen, vec2 u);

/** @brief pdf_solid_angle with which rectangle_sample finds point p of r, seen from ref.
 */
float rectangle_pdf(const rectangle *r, const seen_rectangle *seen, vec3 ref, vec3 p);

/** @brief Which corner of a rectangle the corners of a mesh's two triangles are. */
typedef struct mesh_rectangle {
    rectangle whole;
    int part[2][3]; /**< of a triangle's corner: 0 where its right angle is, 1 and 2 at
                       the diagonal, that both have */
} mesh_rectangle;

/** @brief Finds it. @return false if the mesh is no two triangles that make one and face
 * one way */
bool mesh_rectangle_find(const mesh *m, mesh_rectangle *out);

/** @brief The triangle that a place in the rectangle is in, and its weights there. */
int mesh_rectangle_weights(const mesh_rectangle *r, vec2 place, double b[3]);
