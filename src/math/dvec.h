/*
 * Vectors of three doubles in one SIMD register, as vec.h has them of floats.
 */
#pragma once

#include "math/vec.h"

/** @brief x, y, z and a lane that is zero: vec3 in double. */
typedef double dvec3 __attribute__((vector_size(32)));

/** @brief The same where memory is aligned for one number, as what is allocated is. */
typedef dvec3 dvec3_stored __attribute__((aligned(8)));

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
