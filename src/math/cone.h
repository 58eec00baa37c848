/*
 * A cone, and what of a line lies in it.
 */
#pragma once

#include "math/vec.h"

/** @brief Lengths along a line, m; none where end <= begin. */
typedef struct line_span {
    float begin, end;
} line_span;

/** @brief All directions from the apex that are no further than an angle from the axis.
 */
typedef struct cone3 {
    vec3 apex;
    vec3 axis;    /**< unit */
    float cosine; /**< of the angle */
} cone3;

/** @brief What of a line lies in the cone, between its start and length; where the cone
 * is wider than half of space, all of it.
 *  @param direction unit
 *  @param length m, may be INFINITY */
line_span cone3_clip(const cone3 *c, vec3 start, vec3 direction, float length);
