/*
 * Moving a camera: around a point, across, along, turning and flying. Pure geometry.
 *
 * The horizon stays level: turning is about the world's up axis, the coordinate axis
 * nearest to the up vector that the scene began with.
 */
#pragma once

#include <nephroid/nephroid.h>

typedef struct viewpoint {
    NephCamera camera;
    double pivot[3]; /**< what orbits and dollies go around */
    double up[3];    /**< of the world, unit */
    double extent;   /**< of the scene, m: what a fast flight crosses in some seconds */
} viewpoint;

/** @brief A camera in a scene with these bounds (low NULL: none). */
void viewpoint_init(viewpoint *v, const NephCamera *camera, const double low[3],
                    const double high[3]);
/** @brief Around the pivot, so that what is before it turns by so many radians to the
 * right and up in the picture. */
void viewpoint_orbit(viewpoint *v, double right, double up);
/** @brief Across by fractions of the picture's height at the pivot's distance; the pivot
 * comes along. */
void viewpoint_pan(viewpoint *v, double right, double up);
/** @brief Nearer to the pivot: the distance is multiplied by factor > 0. */
void viewpoint_dolly(viewpoint *v, double factor);
/** @brief Turns on the spot by so many radians. */
void viewpoint_look(viewpoint *v, double right, double up);
/** @brief Moves along the view's axes, m. */
void viewpoint_fly(viewpoint *v, double right, double up, double forward);
/** @brief Another point to go around, as after a click on a surface; the view stays. */
void viewpoint_set_pivot(viewpoint *v, const double pivot[3]);
/** @brief So far that the bounds fill the picture. */
void viewpoint_frame(viewpoint *v, const double low[3], const double high[3]);
