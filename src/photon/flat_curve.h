/*
 * Photons on flat curves.
 *
 * A flat curve turns to face every ray, so that light and the eye see two surfaces there,
 * which share the axis. Photons are kept on the axis, and those of one curve within reach
 * along it are a density over as much area as pieces of it show across the axis.
 *
 * Without photons on curves no path brings the sun to them through glass
 * (test: flat-curves/under-glass).
 */
#pragma once

#include "photon/kernel.h"
#include "scene/scene.h"

/** @brief A place on a flat curve, where its photons are kept (scene_hit_place). */
typedef struct flat_curve {
    const scene *scene;
    const surface_hit *hit; /**< surface_hit.camera_facing is set */
} flat_curve;

/** @brief The area that the curve shows within radius of p, a place on its axis, each
 * piece weighted by the kernel, m². */
float flat_curve_area(const flat_curve *flat, vec3 p, float radius, const kernel *kappa);
