/*
 * Affine and projective transforms with their inverses, composed in double precision.
 *
 * Points are columns: p' = M p. Composition follows pbrt: transform_multiply(a, b)
 * applies b first, so a current matrix C becomes C * T when a directive T is read.
 */
#pragma once

#include "math/box.h"
#include "math/vec.h"

/** @brief A 4x4 matrix and its inverse, row-major: m[row][column]. */
typedef struct transform {
    double m[4][4];
    double inverse[4][4];
} transform;

transform transform_identity(void);
/** @brief A matrix given row by row. @return false if it is singular or not finite. */
bool transform_from_matrix(const double m[4][4], transform *out);
/** @brief The same, but a matrix may flatten: what stands for its inverse then is its
 * adjugate, up to a factor, so that transform_normal still gives the direction of
 * normals, of products too. @return false if it is not finite. */
bool transform_from_any_matrix(const double m[4][4], transform *out);
/** @brief False of a transform that flattens. */
bool transform_can_invert(const transform *t);
transform transform_multiply(const transform *a, const transform *b);
transform transform_inverse(const transform *t);
transform transform_translate(double x, double y, double z);
/** @brief Scale by factors that must not be zero. */
transform transform_scale(double x, double y, double z);
/** @brief Rotation by degrees counter-clockwise about a non-zero axis. */
transform transform_rotate(double degrees, double x, double y, double z);
/** @brief pbrt's LookAt: world to camera, camera at eye looking along +z (left-handed).
 *  @return false if eye = target or up is parallel to the view. */
bool transform_look_at(const double eye[3], const double target[3], const double up[3],
                       transform *out);

vec3 transform_point(const transform *t, vec3 p);
vec3 transform_vector(const transform *t, vec3 v);
/** @brief A normal, by the inverse transpose; not normalised. */
vec3 transform_normal(const transform *t, vec3 n);
box3 transform_box(const transform *t, box3 box);
/** @brief True if the transform mirrors (negative determinant of the upper 3x3). */
bool transform_swaps_handedness(const transform *t);
/** @brief True if all elements differ by no more than rounding. */
bool transform_equal(const transform *a, const transform *b);
