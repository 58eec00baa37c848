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

/** @brief The width of a pixel's footprint on what the camera sees, m: the harmonic mean,
 * by which what is near counts before a landscape; 0 if it sees nothing. */
float visible_pixel(transport_plan *plan);

/** A radius of so many pixels is sharp, and still holds some photons: what merging takes
 * where connections find smooth light, and what trials take it for before radii are
 * known. By vcm relMSE x time is with 1 1.1 to 2.4 times as much; with 4 0.65 to 0.85 in
 * five scenes, alike in two and 1.2 around a glass ball, where with no bound it is 1.8
 * (eight scenes, 128 x 128, 4 passes, three seeds). By auto it is 0.99 to 1.01 with 4,
 * and 0.95 to 1.1 with 1 (four scenes, 8 passes, six seeds). */
#define SHARP_PIXELS 2.0

/** No radius is wider than this share of the scene's: beyond it nothing is local. Where
 * nothing tells of one it is this share of the widest. With 0.03 and 0.3 relMSE x time is
 * 1.2 and 1.3 times as much, with no bound but the scene 2.2 times (geometric means of
 * nine scenes by photon mapping, auto or vcm, 18 cases, 128 x 128, 4 and 8 passes, three
 * seeds: 0.8 to 4.3, 0.95 to 2.2 and 0.96 to 6.3). */
#define WIDEST_SHARE 0.1

/** @brief The widest radius, m. */
static inline double widest_radius(const transport_plan *plan)
{
    return WIDEST_SHARE * (double)plan->scene->radius;
}

/** @brief What stands for one of which nothing is known, m. */
static inline double unknown_radius(const transport_plan *plan)
{
    return WIDEST_SHARE * widest_radius(plan);
}

/** @brief SHARP_PIXELS of what the camera sees, m; unknown_radius if it sees nothing. */
double sharp_radius(transport_plan *plan);
