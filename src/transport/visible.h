/*
 * Where the camera looks: points on surfaces that gather, found by camera rays spread
 * evenly over the picture and followed through mirrors and glass.
 */
#pragma once

#include "transport/transport.h"

typedef struct visible_point {
    vec3 p;
    float pixel; /**< width of a pixel's footprint there, m */
} visible_point;

/** @brief Up to n points into out. @return how many. */
size_t find_visible_points(const transport_plan *plan, uint32_t n, visible_point *out);

/** @brief The median width of a pixel's footprint on what the camera sees, m, but not
 * much more than on what it sees from nearby, before a landscape; 0 if it sees nothing.
 */
float visible_pixel(const transport_plan *plan);
