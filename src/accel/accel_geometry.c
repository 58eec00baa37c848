/*
 * What Embree calls back: with one ray, or to intersect also with a packet of them.
 * Triangles are handed over as shared buffers; quadrics, patches and curves as user
 * geometry that is intersected exactly. Patches that are parallelograms are handed over
 * as triangles where there are others: every kind of geometry has a tree of its own, and
 * a ray goes through each (a room of triangles with a patch for a lamp takes .84 of the
 * time); where there are none, a tree of patches is as fast.
 *
 * An instance that stands still is Embree's own. One that moves is user geometry too: the
 * ray is taken to the object's space at its own time by the same transform that later
 * places the hit, so motion is exact at every time, and no steps show. What Embree is
 * told of the motion is boxes at a few times, each large enough for the time around.
 *
 * Cut-outs: whether a ray passes a place of opacity a is decided by a hash of the ray and
 * the place, so that pictures are the same bits whatever the order of work.
 */
#include "accel/accel_embree.h"
#include "accel/embree_threads.h"
#include "math/sampler.h"

#include <string.h>

enum {
    MOTION_BOXES = 9,  /* times at which the box of a moving instance is told */
    MOST_LAYERS = 256, /* of cut-outs in one primitive, against endless loops */
};

/* In metres. */
static ray from_embree(const struct RTCRay *r, float per_metre)
{
    const float metres = 1.0f / per_metre;
    return (ray){.origin = vec3_make(r->org_x, r->org_y, r->org_z) * metres,
                 .direction = vec3_make(r->dir_x, r->dir_y, r->dir_z),
                 .t_max = r->tfar * metres,
                 .time = r->time};
}

/* ---- Cut-outs ---- */

static uint64_t hash_floats(uint64_t h, const float *values, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        h = hash_mix(h, bits);
    }
    return h;
}

/* True if the surface stops the ray at (u, v) of a primitive, t away. */
static bool stops(const shape *s, const ray *r, uint32_t primitive, const float tuv[3])
{
    surface_hit hit = {.t = tuv[0], .time = r->time, .primitive = primitive};
    s->kind->fill_hit(s->self, r, tuv[1], tuv[2], &hit);
    float opacity = shape_opacity(s, &hit);
    if (!(opacity > 0.0f) || opacity >= 1.0f)
        return opacity > 0.0f;
    const float key[6] = {r->origin[0],    r->origin[1],    r->origin[2],
                          r->direction[0], r->direction[1], r->direction[2]};
    uint64_t h = hash_floats(hash_floats(primitive, key, 6), tuv, 3);
    return (float)(h >> 40) * 0x1p-24f < opacity;
}

static bool cut_out_stops(const given_shape *given, const struct RTCRay *query,
                          const struct RTCHit *hit)
{
    const given_place at = given_place_of(given, hit->primID, hit->u, hit->v);
    ray r = from_embree(query, given->per_metre);
    const float tuv[3] = {r.t_max, at.corners.x, at.corners.y};
    return (query->flags & RAY_SOLID) || stops(given->shape, &r, at.primitive, tuv);
}

/* Filter of triangles with cut-outs. */
static void filter_cut_out(const struct RTCFilterFunctionNArguments *args)
{
    for (unsigned i = 0; i < args->N; i++) {
        struct RTCRay query;
        struct RTCHit hit;
        if (!args->valid[i])
            continue;
        packet_get(&query, args->ray, RAY_ROWS, args->N, i);
        packet_get(&hit, args->hit, HIT_ROWS, args->N, i);
        if (!cut_out_stops(args->geometryUserPtr, &query, &hit))
            args->valid[i] = 0;
    }
}

/* Interfaces without a material hide nothing. */
static void let_through(const struct RTCFilterFunctionNArguments *args)
{
    args->valid[0] = 0;
}

/* ---- One by one ---- */

typedef struct RTCIntersectFunctionNArguments intersect_arguments;
typedef bool (*intersect_one)(const intersect_arguments *args, struct RTCRayHit *query);

/* The rays of a packet; of one alone the packet is the ray. */
static inline void intersect_each(const intersect_arguments *args, intersect_one meets)
{
    float *rows = (float *)args->rayhit;
    const unsigned n = args->N;
    if (n == 1) {
        if (args->valid[0])
            meets(args, (struct RTCRayHit *)args->rayhit);
        return;
    }
    for (unsigned i = 0; i < n; i++) {
        struct RTCRayHit one = {0};
        if (!args->valid[i])
            continue;
        packet_get(&one.ray, rows, RAY_ROWS, n, i);
        if (!meets(args, &one))
            continue;
        packet_put(rows, &one.ray, RAY_ROWS, n, i);
        packet_put(rows + (size_t)RAY_ROWS * n, &one.hit, HIT_ROWS, n, i);
    }
}

/* ---- Exact surfaces as user geometry ---- */

/* Of a box in metres. */
static void give_bounds(const struct RTCBoundsFunctionArguments *args, box3 box,
                        float per_metre)
{
    struct RTCBounds *out = args->bounds_o;
    box = (box3){box.low * per_metre, box.high * per_metre};
    out->lower_x = box.low[0];
    out->lower_y = box.low[1];
    out->lower_z = box.low[2];
    out->upper_x = box.high[0];
    out->upper_y = box.high[1];
    out->upper_z = box.high[2];
}

static void user_bounds(const struct RTCBoundsFunctionArguments *args)
{
    embree_take_over();
    const given_shape *given = args->geometryUserPtr;
    const shape *s = given->shape;
    give_bounds(args,
                s->kind->n_primitives ? s->kind->primitive_bounds(s->self, args->primID)
                                      : s->kind->bounds(s->self),
                given->per_metre);
    embree_hand_over();
}

/* The nearest hit that stops the ray, in metres. */
static bool meets(const shape *s, uint32_t primitive, const ray *r, bool solid,
                  float tuv[3])
{
    float t_min = 0.0f;
    for (int i = 0; i < MOST_LAYERS; i++) {
        bool met = s->kind->intersect(s->self, primitive, r, t_min, tuv);
        if (!met || !s->has_alpha || solid)
            return met;
        if (stops(s, r, primitive, tuv))
            return true;
        t_min = nextafterf(tuv[0], INFINITY); /* the same hit is rounded to this */
    }
    return false;
}

static bool user_meets(const given_shape *given, uint32_t primitive,
                       const struct RTCRay *query, float tuv[3])
{
    ray r = from_embree(query, given->per_metre);
    bool met = meets(given->shape, primitive, &r, query->flags & RAY_SOLID, tuv);
    tuv[0] *= given->per_metre;
    return met;
}

static bool user_intersect_one(const intersect_arguments *args, struct RTCRayHit *query)
{
    float tuv[3];
    if (!user_meets(args->geometryUserPtr, args->primID, &query->ray, tuv))
        return false;
    query->ray.tfar = tuv[0];
    query->hit.u = tuv[1];
    query->hit.v = tuv[2];
    query->hit.primID = args->primID;
    query->hit.geomID = args->geomID;
    query->hit.instID[0] = args->context->instID[0];
    return true;
}

static void user_intersect(const intersect_arguments *args)
{
    intersect_each(args, user_intersect_one);
}

static void user_occluded(const struct RTCOccludedFunctionNArguments *args)
{
    const given_shape *given = args->geometryUserPtr;
    struct RTCRay *query = (struct RTCRay *)args->ray;
    float tuv[3];
    if (args->valid[0] && !given->shape->lets_through &&
        user_meets(given, args->primID, query, tuv))
        query->tfar = -INFINITY;
}

/* The mesh's own positions where a metre is Embree's unit, else a copy that Embree owns.
 */
static void give_positions(RTCGeometry g, const mesh *m, float per_metre)
{
    const size_t width = 3 * sizeof(float);
    if (per_metre == 1.0f) {
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   m->positions, 0, width, m->n_vertices);
        return;
    }
    float *copy = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                          width, m->n_vertices);
    for (size_t i = 0; copy && i < 3 * m->n_vertices; i++)
        copy[i] = m->positions[i] * per_metre;
}

static RTCGeometry triangle_geometry(RTCDevice device, const given_shape *given,
                                     const mesh *m)
{
    const shape *s = given->shape;
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    give_positions(g, m, given->per_metre);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, m->indices,
                               0, 3 * sizeof(uint32_t), m->n_triangles);
    if (s->has_alpha) {
        rtcSetGeometryIntersectFilterFunction(g, filter_cut_out);
        rtcSetGeometryOccludedFilterFunction(g, filter_cut_out);
    }
    if (s->lets_through)
        rtcSetGeometryOccludedFilterFunction(g, let_through);
    return g;
}

static RTCGeometry exact_geometry(RTCDevice device, const shape *s)
{
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    size_t n = s->kind->n_primitives ? s->kind->n_primitives(s->self) : 1;
    rtcSetGeometryUserPrimitiveCount(g, (unsigned)n);
    rtcSetGeometryBoundsFunction(g, user_bounds, NULL);
    rtcSetGeometryIntersectFunction(g, user_intersect);
    rtcSetGeometryOccludedFunction(g, user_occluded);
    return g;
}

RTCGeometry shape_geometry(RTCDevice device, given_shape *given)
{
    const shape *s = given->shape;
    const mesh *m = s->kind->triangles ? s->kind->triangles(s->self) : NULL;
    mesh halves;
    given->is_halved = given->is_beside_triangles && s->kind->halves &&
                       s->kind->halves(s->self, &halves);
    if (given->is_halved)
        m = &halves;
    RTCGeometry g = m ? triangle_geometry(device, given, m) : exact_geometry(device, s);
    rtcSetGeometryUserData(g, given);
    return g;
}

/* ---- Placed objects ---- */

transform placed_at(const placed *p, float time)
{
    const double *shutter = p->shutter;
    if (!p->moves)
        return p->still;
    return motion_at(&p->is->to_world,
                     shutter[0] + (double)time * (shutter[1] - shutter[0]));
}

static void moving_bounds(const struct RTCBoundsFunctionArguments *args)
{
    embree_take_over();
    const placed *p = args->geometryUserPtr;
    const double *shutter = p->shutter;
    double step = (shutter[1] - shutter[0]) / (MOTION_BOXES - 1);
    double at = shutter[0] + args->timeStep * step;
    give_bounds(args, motion_bounds(&p->is->to_world, p->bounds, at - step, at + step),
                p->world_per_metre);
    embree_hand_over();
}

/* The query in the object's space, with the same distances along it. */
static struct RTCRay taken_to_object(const placed *p, const struct RTCRay *query)
{
    transform to_world = placed_at(p, query->time);
    ray world = from_embree(query, p->world_per_metre);
    ray r = instance_ray(&to_world, &world);
    vec3 origin = r.origin * p->per_metre;
    vec3 direction = r.direction * (p->per_metre / p->world_per_metre);
    struct RTCRay out = *query;
    out.org_x = origin[0];
    out.org_y = origin[1];
    out.org_z = origin[2];
    out.dir_x = direction[0];
    out.dir_y = direction[1];
    out.dir_z = direction[2];
    return out;
}

static bool moving_intersect_one(const intersect_arguments *args, struct RTCRayHit *query)
{
    const placed *p = args->geometryUserPtr;
    struct RTCRayHit inner = {.ray = taken_to_object(p, &query->ray)};
    if (!embree_takes(&inner.ray, OBJECT_REACH))
        return false;
    inner.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    embree_nearest(p->object, &inner);
    if (inner.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    query->ray.tfar = inner.ray.tfar;
    query->hit = inner.hit;
    query->hit.instID[0] = args->geomID;
    return true;
}

static void moving_intersect(const intersect_arguments *args)
{
    intersect_each(args, moving_intersect_one);
}

static void moving_occluded(const struct RTCOccludedFunctionNArguments *args)
{
    const placed *p = args->geometryUserPtr;
    struct RTCRay *query = (struct RTCRay *)args->ray;
    if (!args->valid[0])
        return;
    struct RTCRay inner = taken_to_object(p, query);
    if (!embree_takes(&inner, OBJECT_REACH))
        return;
    embree_any(p->object, &inner);
    if (inner.tfar < 0.0f)
        query->tfar = -INFINITY;
}

/* Between Embree's units of object and world. */
static double unit_ratio(const placed *p)
{
    return (double)p->world_per_metre / (double)p->per_metre;
}

static RTCGeometry still_geometry(RTCDevice device, const placed *p)
{
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    float matrix[12];
    for (int i = 0; i < 12; i++) {
        double scale = i % 4 == 3 ? (double)p->world_per_metre : unit_ratio(p);
        matrix[i] = (float)(p->still.m[i / 4][i % 4] * scale);
    }
    rtcSetGeometryInstancedScene(g, p->object);
    rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, matrix);
    return g;
}

/* Also of what stands still, but is too much larger or smaller than its object. */
static RTCGeometry moving_geometry(RTCDevice device, placed *p)
{
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(g, 1);
    rtcSetGeometryTimeStepCount(g, MOTION_BOXES);
    rtcSetGeometryUserData(g, p);
    rtcSetGeometryBoundsFunction(g, moving_bounds, NULL);
    rtcSetGeometryIntersectFunction(g, moving_intersect);
    rtcSetGeometryOccludedFunction(g, moving_occluded);
    return g;
}

/* Embree inverts the matrix in single precision, and hands rays on unasked: those of the
   whole world must stay within an object's reach. */
static bool may_be_embrees(const placed *p)
{
    const double largest = 1e9, most_reach = (double)(OBJECT_REACH / WORLD_REACH) / 10.0;
    const double ratio = unit_ratio(p), units = (double)p->per_metre;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            if (!(fabs(p->still.m[i][k] * ratio) <= largest) ||
                !(fabs(p->still.inverse[i][k] / ratio) <= most_reach))
                return false;
        if (!(fabs(p->still.inverse[i][3] * units) <= (double)OBJECT_REACH / 10.0))
            return false;
    }
    return true;
}

RTCGeometry placed_geometry(RTCDevice device, placed *p)
{
    bool asks_us = p->moves || !may_be_embrees(p);
    return asks_us ? moving_geometry(device, p) : still_geometry(device, p);
}
