/*
 * What stands between Embree (3 or 4) and the rest: accel.c builds and asks, and
 * accel_geometry.c is what Embree calls back. No other room includes Embree.
 *
 * Embree 3 passes a context with every query, Embree 4 optional arguments: the functions
 * embree_nearest… and embree_any… hold the whole difference.
 */
#pragma once

#include "accel/accel.h"

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

enum { RAY_SOLID = 1 }; /**< RTCRay.flags: cut-outs do not count */

/** @brief A shape as Embree is given it. */
typedef struct given_shape {
    shape *shape; /**< borrowed */
    float
        per_metre; /**< Embree's units in a metre of the shape's space: a power of two */
    bool is_beside_triangles;
    bool is_halved; /**< given as triangles, by shape_kind.halves */
} given_shape;

/** @brief Where on a shape it is that Embree's numbers tell. */
typedef struct given_place {
    uint32_t primitive;
    vec2 corners; /**< u and v, as shape_kind.fill_hit takes them */
} given_place;

static inline given_place given_place_of(const given_shape *given, uint32_t number,
                                         float u, float v)
{
    if (!given->is_halved)
        return (given_place){number, {u, v}};
    bool second = number & 1;
    return (given_place){number / 2, {second ? u : u + v, second ? u + v : v}};
}

/** @brief An object as an instance places it. All is borrowed. */
typedef struct placed {
    const instance *is;
    const double *shutter; /**< s: [2], when rays of time 0 and 1 are */
    RTCScene object;       /**< committed */
    box3 bounds;           /**< of the object, in its own space, m */
    float per_metre;       /**< Embree's units in a metre of the object's space ... */
    float world_per_metre; /**< ... and of the world */
    bool moves;
    transform still; /**< where it is if it does not move */
} placed;

/** @brief Embree reads origin and tnear, direction and time, as vectors: written as
 * vectors they reach it without waiting for the cache. @param per_metre its units */
static inline struct RTCRay embree_ray(const ray *r, float per_metre)
{
    const vec3_bits xyz = {-1, -1, -1, 0};
    const vec3 origin =
        choose3(xyz, r->origin * per_metre, (vec3){0.0f, 0.0f, 0.0f, FLT_MIN});
    const vec3 direction = choose3(xyz, r->direction, (vec3){0.0f, 0.0f, 0.0f, r->time});
    struct RTCRay to = {.tfar = r->t_max * per_metre, .mask = ~0u};
    memcpy(&to.org_x, &origin, sizeof origin);
    memcpy(&to.dir_x, &direction, sizeof direction);
    return to;
}

/** How far from the origin a ray of the world may begin, in Embree's units; and one in
 * the space of an object. Embree ends the program for what is beyond 1.8e18, or not a
 * number. */
#define WORLD_REACH 1e12f
#define OBJECT_REACH 1e18f

/** @brief Whether a ray begins within reach; one that does not meets nothing. */
static inline bool embree_takes(const struct RTCRay *r, float reach)
{
    const vec3 most = {reach, reach, reach, 0.0f};
    const vec3 steepest = {OBJECT_REACH, OBJECT_REACH, OBJECT_REACH, 0.0f};
    const vec3_bits fits = (abs3(vec3_make(r->org_x, r->org_y, r->org_z)) <= most) &
                           (abs3(vec3_make(r->dir_x, r->dir_y, r->dir_z)) <= steepest);
    return (fits[0] & fits[1] & fits[2]) && !isnan(r->tfar);
}

/** @brief Where it is at a time of the shutter, 0..1. */
transform placed_at(const placed *p, float time);

/** @brief A shape, which must outlive it; to be committed and attached. Sets is_halved.
 */
RTCGeometry shape_geometry(RTCDevice device, given_shape *given);
/** @brief A placed object, which must outlive it. */
RTCGeometry placed_geometry(RTCDevice device, placed *p);

/* ---- Packets ----
 *
 * Of n rays together Embree keeps each member of RTCRay, and after them of RTCHit, as a
 * row of n. */

enum {
    RAY_ROWS = sizeof(struct RTCRay) / sizeof(float),
    HIT_ROWS = offsetof(struct RTCHit, instID) / sizeof(float) + 1
};

/** @brief Ray or hit number i of n. */
static inline void packet_get(void *one, const void *rows, size_t n_rows, unsigned n,
                              unsigned i)
{
    for (size_t k = 0; k < n_rows; k++)
        memcpy((float *)one + k, (const float *)rows + k * n + i, sizeof(float));
}

static inline void packet_put(void *rows, const void *one, size_t n_rows, unsigned n,
                              unsigned i)
{
    for (size_t k = 0; k < n_rows; k++)
        memcpy((float *)rows + k * n + i, (const float *)one + k, sizeof(float));
}

/* ---- Queries ---- */

static inline void embree_nearest(RTCScene scene, struct RTCRayHit *query)
{
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(scene, query, NULL);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, query);
#endif
}

/** @brief embree_nearest of the rays of a packet whose valid is -1, not 0. */
static inline void embree_nearest_packet(RTCScene scene, const int *valid,
                                         struct RTCRayHit16 *query)
{
#if RTC_VERSION_MAJOR >= 4
    struct RTCIntersectArguments args;
    rtcInitIntersectArguments(&args);
    args.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect16(valid, scene, query, &args);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(valid, scene, &context, query);
#endif
}

static inline void embree_any(RTCScene scene, struct RTCRay *query)
{
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded1(scene, query, NULL);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, query);
#endif
}
