/*
 * Where the camera looks: points on surfaces that gather, found by camera rays spread
 * evenly over the picture and followed through mirrors and glass.
 */
#pragma once

#include "transport/transport.h"

/** @brief Up to n points into out. @return how many. */
size_t find_visible_points(const transport_plan *plan, uint32_t n, visible_point *out);

/** @brief Fills plan->sight, unless it is filled; as many points as the work is worth. */
void plan_look(transport_plan *plan);

/** @brief Over plan->sight, which must be filled; owned by the caller. */
point_set *visible_index(const transport_plan *plan, GError **error);

/** @brief The median width of a pixel's footprint on what the camera sees, m, but not
 * much more than on what it sees from nearby, before a landscape; 0 if it sees nothing.
 */
float visible_pixel(transport_plan *plan);
