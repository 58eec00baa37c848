/*
 * Axis-aligned boxes.
 */
#pragma once

#include "math/vec.h"

/** @brief All points with low <= p <= high in each axis; empty when low > high. */
typedef struct box3 {
    vec3 low, high;
} box3;

static inline box3 box3_empty(void)
{
    return (box3){vec3_make(INFINITY, INFINITY, INFINITY),
                  vec3_make(-INFINITY, -INFINITY, -INFINITY)};
}

static inline box3 box3_with_point(box3 box, vec3 p)
{
    return (box3){min3(box.low, p), max3(box.high, p)};
}

static inline box3 box3_union(box3 a, box3 b)
{
    return (box3){min3(a.low, b.low), max3(a.high, b.high)};
}

static inline bool box3_is_empty(box3 box)
{
    return box.low[0] > box.high[0];
}

static inline vec3 box3_center(box3 box)
{
    return 0.5f * (box.low + box.high);
}

/** @brief Half the length of the diagonal: the radius of the bounding sphere; 0 if empty.
 */
static inline float box3_radius(box3 box)
{
    return box3_is_empty(box) ? 0.0f : 0.5f * length3(box.high - box.low);
}
