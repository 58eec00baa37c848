/*
 * Instances: many places of one object. An object is a set of shapes, in a space of its
 * own, with one acceleration structure; an instance puts it into the world, and may move.
 */
#pragma once

#include "base/error.h"
#include "math/motion.h"
#include "medium/hit.h"

typedef struct instance {
    int object;      /**< index in scene->objects */
    motion to_world; /**< times in seconds */
    source_place place;
} instance;

/** @brief A ray in the space of an object at `to_world`; its t are those of the world's
 * ray, its direction is not unit. */
ray instance_ray(const transform *to_world, const ray *r);
/** @brief Takes a hit that was filled in the object's space to the world. */
void instance_place_hit(const transform *to_world, surface_hit *hit);
/** @brief Moves a placed hit on by a motion of the world. */
void instance_move_hit(const transform *by, surface_hit *hit);
/** @brief The most that lengths grow by, or a little more. */
float instance_largest_scale(const transform *t);
/** @brief The area in the world of a small piece of the object's surface that has area 1
 * there, by its unit normal n in the world: |det M| / |Mᵀ n|. */
double instance_area_factor(const transform *to_world, vec3 n);
/** @brief About how many times an area of the object is in the world, |det M|^(2/3). */
double instance_mean_area_factor(const transform *to_world);
