/*
 * A transform that moves from one to another, as pbrt moves it: both are taken apart into
 * a translation, a rotation and what is left (M = T R S, by polar decomposition), the
 * rotation turns evenly about one axis, the rest changes linearly (Shoemake & Duff,
 * "Matrix Animation and Polar Decomposition", 1992). Before its start and after its end
 * it stands still.
 */
#pragma once

#include "math/transform.h"

typedef struct motion_pose {
    double translation[3];
    double rotation[4]; /**< quaternion x y z w, unit */
    double rest[3][3];
} motion_pose;

typedef struct motion {
    transform start, end;
    double start_time, end_time;
    bool moves; /**< false: end is start, and nothing below is set */
    motion_pose pose[2];
    double half_angle; /**< of the turn from one pose to the other */
} motion;

/** @brief A transform that stands still. */
motion motion_still(const transform *at);
/** @brief From start at start_time to end at end_time. Equal ones, or times that are not
 * in order, stand still at start. */
motion motion_make(const transform *start, const transform *end, double start_time,
                   double end_time);
/** @brief The transform at a time. */
transform motion_at(const motion *m, double time);
/** @brief What box covers in the time from begin to end. */
box3 motion_bounds(const motion *m, box3 box, double begin, double end);
