/*
 * What sphere, disk and cylinder share: object space in double precision.
 *
 * A ray goes to object space without normalising its direction, so t is the same in both
 * spaces. The hit is put exactly on the surface there and taken back to the world, where
 * only the rounding of the coordinates themselves remains.
 *
 * Areas: an affine map M turns an area element with unit normal n into |det M| |M⁻ᵀ n|
 * times itself. For rotations and uniform scales that is one number; else a shape is
 * sampled uniformly in object space and thinned to be uniform in the world.
 */
#pragma once

#include "math/dvec.h"
#include "shape/shape.h"

/** @brief A point of the surface in object space. */
typedef struct quadric_point {
    double p[3], n[3]; /**< n unit, before orientation */
    vec2 uv;
} quadric_point;

/** @brief Maps [0,1)² to the surface, uniformly by area in object space. */
typedef quadric_point (*quadric_map)(const void *self, vec2 u);

/** @brief The first member of every quadric shape. */
typedef struct quadric {
    transform to_world;
    dvec3_stored to_object[4]; /**< columns of its inverse */
    bool flip;       /**< normals point to the other side: reversed xor mirrored */
    bool is_similar; /**< to_world keeps shapes: rotation, mirroring, uniform scale */
    double phi_max;  /**< rad, in (0, 2 pi] */
    double factor;   /**< largest area factor (the only one if is_similar) */
    int mean_steps;  /**< at most, each way, to sum the mean area factor */
    float area;      /**< m², world */
    quadric_map map;
} quadric;

/** @brief A ray in object space; d is not unit. */
typedef struct quadric_ray {
    dvec3 o, d;
} quadric_ray;

/** @brief What the place tells; phi_max is a full turn. */
void quadric_place(quadric *q, const shape_place *at);
/** @brief The same, and phimax. */
bool quadric_init(quadric *q, const params *p, const shape_place *at, GError **error);
/** @brief Sets area and map, given the area in object space; first member of self is q.
 * false: the shape has no area. */
bool quadric_set_area(quadric *q, quadric_map map, double object_area, const params *p,
                      GError **error);

static inline quadric_ray quadric_to_object(const quadric *q, const ray *r)
{
    const dvec3_stored *column = q->to_object;
    dvec3 d = column[0] * (double)r->direction[0] + column[1] * (double)r->direction[1] +
              column[2] * (double)r->direction[2];
    dvec3 o = column[0] * (double)r->origin[0] + column[1] * (double)r->origin[1] +
              column[2] * (double)r->origin[2] + column[3];
    return (quadric_ray){o, d};
}

/** @brief Puts a point of the surface into the world: p, n_geom, n, uv; dpdu and dpdv
 * given in object space. */
void quadric_fill_hit(const quadric *q, const quadric_point *at, const double dpdu[3],
                      const double dpdv[3], surface_hit *hit);
/** @brief The angle of (x, y) in 0..2 pi. */
double quadric_phi(const double p[3]);
/** @brief True if p is on the part of the turn that there is: an arc tangent, but for a
 * full turn. */
static inline bool quadric_in_turn(const quadric *q, const double p[3])
{
    return q->phi_max >= 2.0 * G_PI * (1.0 - 1e-9) || quadric_phi(p) <= q->phi_max;
}

/** @brief World bounds of a box in object space, rounded outward. */
box3 quadric_bounds(const quadric *q, const double low[3], const double high[3]);

/** @brief The product of the first n coordinates. */
static inline double quadric_dot(dvec3 a, dvec3 b, int n)
{
    dvec3 p = a * b;
    return n == 2 ? p[0] + p[1] : p[0] + p[1] + p[2];
}

/** @brief Both roots of |d t + o|² = r² over the first n coordinates, 2 or 3, ascending:
 * from the point of the line nearest the axis or centre, where nothing cancels. */
static inline bool quadric_roots(const quadric_ray *r, int n, double radius,
                                 double roots[2])
{
    double a = quadric_dot(r->d, r->d, n);
    double middle = -quadric_dot(r->o, r->d, n) / a;
    dvec3 near = r->o + middle * r->d;
    double distance2 = quadric_dot(near, near, n);
    if (!(distance2 <= radius * radius)) /* also where there is no such point */
        return false;
    double distance = sqrt(distance2);
    double half2 = (radius - distance) * (radius + distance) / a;
    double half = sqrt(half2);
    roots[0] = middle - half;
    roots[1] = middle + half;
    return true;
}

float quadric_area(const void *self);
shape_sample quadric_sample_area(const void *self, float u_primitive, vec2 u);
