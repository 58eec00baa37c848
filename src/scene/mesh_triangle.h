/*
 * One triangle of a mesh in double precision, and the solid angle it fills.
 */
#pragma once

#include "scene/shape.h"

typedef struct triangle {
    uint32_t vertex[3];
    double p[3][3];
    double cross[3]; /**< (p1 - p0) x (p2 - p0): twice the area, along the normal */
} triangle;

void triangle_get(const mesh *m, size_t primitive, triangle *t);
double triangle_area(const triangle *t);
/** @brief The solid angle in which ref sees it, 0..2 pi (Van Oosterom & Strackee, "The
 * Solid Angle of a Plane Triangle", 1983). */
double triangle_solid_angle(const triangle *t, vec3 ref);
/** @brief Barycentric weights of a point, uniform by solid angle at ref (Arvo,
 * "Stratified Sampling of Spherical Triangles", 1995). */
void triangle_sample_solid_angle(const triangle *t, vec3 ref, vec2 u, double b[3]);
