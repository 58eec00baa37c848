/*
 * Ray queries. The one file that calls Embree (3 or 4) is accel.c.
 */
#pragma once

#include "scene/hit.h"
#include "scene/shape.h"

typedef struct accel accel;

/** @brief Builds over n shapes (borrowed; they must outlive the result). */
accel *accel_build(shape *const *shapes, size_t n, unsigned threads, GError **error);
void accel_free(accel *a);
/** @brief Nearest hit in (0, r->t_max): geometry only, hit->shape tells the rest.
 * Thread-safe. */
bool accel_intersect(const accel *a, const ray *r, surface_hit *hit);
/** @brief True if anything but interfaces (shapes without a material) lies in (0, r->t_max).
 *  Thread-safe. */
bool accel_occluded(const accel *a, const ray *r);
