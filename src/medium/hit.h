/*
 * Rays and what they hit.
 */
#pragma once

#include "math/frame.h"
#include "math/mesh.h"
#include "math/vec.h"
#include "medium/medium_stack.h"

#include <stddef.h>
#include <stdint.h>

/** @brief A half line; points are origin + t * direction, 0 < t < t_max. */
typedef struct ray {
    vec3 origin;
    vec3 direction; /**< unit */
    float t_max;
    float time;         /**< of the shutter: 0 when it opens, 1 when it closes */
    medium_stack media; /**< that it travels in */
} ray;

_Static_assert(sizeof(ray) <= 64, "a ray is at most a cache line");

/** @brief Where a surface parts two participating media (pbrt's MediumInterface): as
 * medium_stack.participating has them. */
typedef struct medium_interface {
    uint32_t inside;  /**< against n_geom; 0: none */
    uint32_t outside; /**< toward n_geom */
} medium_interface;

enum { NO_INDEX = -1 };

/** @brief A point on a surface. n_geom and n are unit and in one hemisphere; they are the
 *  surface's own and are not turned towards the ray. */
typedef struct surface_hit {
    vec3 p;      /**< accurate to a few ulps of the largest coordinate */
    vec3 n_geom; /**< true normal of the surface */
    vec3 n;      /**< shading normal */
    vec3 dpdu;   /**< tangent of the parametrisation, not unit */
    vec3 dpdv;   /**< the other one; zero where a shape does not tell */
    vec2 uv;
    float t;     /**< distance along the ray */
    float error; /**< m: how far off the surface rounding may see a ray that starts at p
                    (large triangles near the origin); 0: the coordinates of p tell */
    float time;
    float footprint;    /**< m: how wide the eye sees at once there; 0 for photons and
                           where it is not known */
    bool camera_facing; /**< the surface faces every ray, as far as it can by turning
                   about dpdu (a flat curve): normals and dpdv are those for this ray */
    int shape;          /**< index in scene->shapes */
    int instance;       /**< index in scene->instances, or NO_INDEX */
    uint32_t primitive; /**< triangle of a mesh, else 0 */
    int material; /**< index in scene->materials, or NO_INDEX: an invisible interface */
    int light;    /**< index in scene->lights of the area light here, or NO_INDEX */
    medium_stack media; /**< that the ray came through */
    const mesh *mesh;   /**< that the triangle is of (mesh_attributes.h); NULL: on
                           another shape */
    vec2 corners;       /**< where on the primitive it is, as shape_kind.fill_hit takes
                           it: of a triangle, weights of its second and third corner */
    uint32_t solid;     /**< behind the surface, against n_geom, as in a
                           medium_stack; 0: it bounds none */
    bool from_inside;   /**< the ray came from behind; only where solid is set */
    const medium_interface *boundary; /**< what the surface parts; NULL: on both sides is
                                         what the ray came through */
} surface_hit;

/** @brief The area that a surface shows to direction w, unit, over its own: the cosine to
 * n_geom. What turns to face every ray shows all but what its axis is foreshortened by.
 */
static inline float hit_cosine(const surface_hit *hit, vec3 w)
{
    return hit->camera_facing ? length3(cross3(w, normalize3(hit->dpdu)))
                              : fabsf(dot3(w, hit->n_geom));
}

/** @brief Where a ray that leaves p in the given direction must start so as not to meet
 * the same surface: moved along n_geom by a distance that scales with the coordinates.
 * @param t,error as in surface_hit; 0 where nothing is known */
static inline vec3 offset_point(vec3 p, vec3 n_geom, float t, float error, vec3 direction)
{
    float scale = maxf(max_component3(abs3(p)), 1e-3f * t) * 4e-6f;
    scale = maxf(scale, error);
    return p + n_geom * (dot3(direction, n_geom) < 0.0f ? -scale : scale);
}

/** @brief offset_point of a hit. */
static inline vec3 hit_offset(const surface_hit *hit, vec3 direction)
{
    return offset_point(hit->p, hit->n_geom, hit->t, hit->error, direction);
}

/** @brief The media that a ray which leaves the hit in a direction travels in. */
static inline medium_stack hit_media(const surface_hit *hit, vec3 direction)
{
    bool inside = dot3(direction, hit->n_geom) < 0.0f;
    medium_stack media = hit->media;
    if (hit->solid && inside != hit->from_inside)
        media = inside ? medium_stack_enter(media, hit->solid)
                       : medium_stack_leave(media, hit->solid);
    if (hit->boundary)
        media.participating = inside ? hit->boundary->inside : hit->boundary->outside;
    return media;
}

/** @brief A point on a ray within the medium that it travels in, as a hit on nothing: it
 * has no normal. */
static inline surface_hit hit_in_medium(const ray *r, float t)
{
    return (surface_hit){.p = r->origin + t * r->direction,
                         .t = t,
                         .time = r->time,
                         .shape = NO_INDEX,
                         .instance = NO_INDEX,
                         .material = NO_INDEX,
                         .light = NO_INDEX,
                         .media = r->media};
}

/** @brief The ray that leaves a hit. */
static inline ray hit_ray(const surface_hit *hit, vec3 direction)
{
    return (ray){hit_offset(hit, direction), direction, INFINITY, hit->time,
                 hit_media(hit, direction)};
}

/** @brief The part of a segment to something beyond which rounding may meet it already.
 */
static inline float distance_short_of(float distance)
{
    return distance * (1.0f - 1e-4f);
}

/** @brief The ray from a hit to a point at distance in direction. It ends short of the
 * point by so much that rounding, which grows with coordinates, does not let it meet the
 * surface there.
 *  @param distance m; INFINITY: never */
static inline ray hit_ray_to(const surface_hit *hit, vec3 direction, float distance)
{
    ray r = hit_ray(hit, direction);
    float margin = 2.0f * length3(r.origin - hit->p);
    r.t_max = maxf(distance_short_of(distance) - margin, 0.0f);
    return r;
}
