/*
 * Ray queries, by Embree (3 or 4), of which nobody else knows: see accel_embree.h.
 */
#pragma once

#include "medium/hit.h"
#include "shape/instance.h"
#include "shape/shape.h"

typedef struct accel accel;

/** @brief What rays may meet. Everything is borrowed and must outlive the result. */
typedef struct accel_input {
    shape *const *shapes; /**< of the world and of all objects */
    size_t n_shapes;
    const instance *instances;
    size_t n_instances, n_objects;
    double shutter[2]; /**< s: when rays of time 0 and 1 are */
} accel_input;

/** @brief Builds what the queries below ask. threads: 0 = all. ERROR_FAILED if Embree
 * does not start or runs out of memory. */
accel *accel_build(const accel_input *in, unsigned threads, GError **error);
void accel_free(accel *a);
/** @brief Nearest hit in (0, r->t_max): geometry only, hit->shape and hit->instance tell
 * the rest. Cut-outs (alpha) are passed by a choice that the ray alone decides.
 * Thread-safe. */
bool accel_intersect(const accel *a, const ray *r, surface_hit *hit);
/** @brief The same with all cut-outs solid. */
bool accel_intersect_solid(const accel *a, const ray *r, surface_hit *hit);
/** Rays of a packet, at most. */
enum { RAY_PACKET = 16 };
/** @brief accel_intersect of n rays together, which pays where they begin or go side by
 * side. @param hits [n]: shape is NO_INDEX where nothing was met */
void accel_intersect_packet(const accel *a, const ray *rays, int n, surface_hit *hits);
/** @brief Fills in what a nearest hit of the ray is beyond its t, time, shape, instance,
 * primitive and corners. */
void accel_fill_hit(const accel *a, const ray *r, surface_hit *hit);
/** @brief True if anything lies in (0, r->t_max) but what lets light through (shape).
 * Thread-safe. */
bool accel_occluded(const accel *a, const ray *r);
/** @brief Where an instance is at a time of the shutter, 0..1. */
transform accel_instance_at(const accel *a, int i, float time);
/** @brief True if it moves while the shutter is open. */
bool accel_instance_moves(const accel *a, int i);
