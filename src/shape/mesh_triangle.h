/*
 * One triangle of a mesh in double precision, and the solid angle it fills.
 */
#pragma once

#include "math/dvec.h"
#include "shape/shape.h"

typedef struct triangle {
    uint32_t vertex[3];
    dvec3 p[3];
    dvec3 edge[2]; /**< p1 - p0, p2 - p0 */
    dvec3 cross;   /**< edge[0] x edge[1]: twice the area, along the normal */
} triangle;

void triangle_get(const mesh *m, size_t primitive, triangle *t);
double triangle_area(const triangle *t);

/** @brief A triangle as it is seen from a point. */
typedef struct seen_triangle {
    dvec3 d[3];         /**< unit, to the corners */
    double solid_angle; /**< 0..2 pi (Van Oosterom & Strackee, "The Solid Angle of a Plane
                           Triangle", 1983) */
} seen_triangle;

seen_triangle triangle_seen_from(const triangle *t, vec3 ref);
/** @brief Barycentric weights of a point, uniform by solid angle at ref (Arvo,
 * "Stratified Sampling of Spherical Triangles", 1995). @param seen from ref */
void triangle_sample_solid_angle(const triangle *t, const seen_triangle *seen, vec3 ref,
                                 vec2 u, double b[3]);
