/*
 * Where the camera looks: points on surfaces that gather, found by camera rays spread
 * evenly over the picture and followed through mirrors and glass.
 */
#pragma once

#include "transport/transport.h"

/** @brief Up to n points into out. @return how many. */
size_t find_visible_points(const transport_plan *plan, uint32_t n, visible_point *out);

/** A radius of so many pixels is sharp, and still holds some photons: what merging takes
 * where connections find smooth light, and what stands for radii that are not known. */
#define SHARP_PIXELS 2.0

/** @brief Fills plan->sight, unless it is filled; as many points as the work is worth. */
void plan_look(transport_plan *plan);

/** @brief Over plan->sight, which must be filled; owned by the caller. */
point_set *visible_index(const transport_plan *plan, GError **error);

/** @brief The width of a pixel's footprint on what the camera sees, m: the harmonic mean,
 * by which what is near counts before a landscape; 0 if it sees nothing. */
float visible_pixel(transport_plan *plan);
