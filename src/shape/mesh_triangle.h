/*
 * One triangle of a mesh in double precision, and the solid angle it fills.
 */
#pragma once

#include "shape/shape.h"

/** @brief x, y, z and a lane that is zero: vec3 in double. */
typedef double dvec3 __attribute__((vector_size(32)));

typedef struct triangle {
    uint32_t vertex[3];
    dvec3 p[3];
    dvec3 edge[2]; /**< p1 - p0, p2 - p0 */
    dvec3 cross;   /**< edge[0] x edge[1]: twice the area, along the normal */
} triangle;

static inline double dvec3_dot(dvec3 a, dvec3 b)
{
    dvec3 product = a * b;
    return product[0] + product[1] + product[2];
}

static inline dvec3 dvec3_cross(dvec3 a, dvec3 b)
{
    dvec3 a_yzx = __builtin_shufflevector(a, a, 1, 2, 0, 3);
    dvec3 b_yzx = __builtin_shufflevector(b, b, 1, 2, 0, 3);
    dvec3 c = a * b_yzx - a_yzx * b;
    return __builtin_shufflevector(c, c, 1, 2, 0, 3);
}

static inline double dvec3_length(dvec3 a)
{
    return sqrt(dvec3_dot(a, a));
}

static inline vec3 dvec3_to_float(dvec3 a)
{
    return __builtin_convertvector(a, vec3);
}

static inline dvec3 dvec3_from_float(vec3 a)
{
    return __builtin_convertvector(a, dvec3);
}

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
