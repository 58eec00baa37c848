/*
 * What Embree calls back. Triangles are handed over as shared buffers; quadrics, patches
 * and curves as user geometry that is intersected exactly.
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
#include "math/sampler.h"

#include <string.h>

enum {
    MOTION_BOXES = 9,  /* times at which the box of a moving instance is told */
    MOST_LAYERS = 256, /* of cut-outs in one primitive, against endless loops */
};

static ray from_embree(const struct RTCRay *r)
{
    return (ray){.origin = vec3_make(r->org_x, r->org_y, r->org_z),
                 .direction = vec3_make(r->dir_x, r->dir_y, r->dir_z),
                 .t_max = r->tfar,
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

/* Filter of triangles with cut-outs. */
static void filter_cut_out(const struct RTCFilterFunctionNArguments *args)
{
    const struct RTCRay *query = (const struct RTCRay *)args->ray;
    const struct RTCHit *hit = (const struct RTCHit *)args->hit;
    if (!args->valid[0] || (query->flags & RAY_SOLID))
        return;
    ray r = from_embree(query);
    const float tuv[3] = {query->tfar, hit->u, hit->v};
    if (!stops(args->geometryUserPtr, &r, hit->primID, tuv))
        args->valid[0] = 0;
}

/* Interfaces without a material hide nothing. */
static void let_through(const struct RTCFilterFunctionNArguments *args)
{
    args->valid[0] = 0;
}

/* ---- Exact surfaces as user geometry ---- */

static void give_bounds(const struct RTCBoundsFunctionArguments *args, box3 box)
{
    struct RTCBounds *out = args->bounds_o;
    out->lower_x = box.low[0];
    out->lower_y = box.low[1];
    out->lower_z = box.low[2];
    out->upper_x = box.high[0];
    out->upper_y = box.high[1];
    out->upper_z = box.high[2];
}

static void user_bounds(const struct RTCBoundsFunctionArguments *args)
{
    const shape *s = args->geometryUserPtr;
    give_bounds(args, s->kind->n_primitives
                          ? s->kind->primitive_bounds(s->self, args->primID)
                          : s->kind->bounds(s->self));
}

/* The nearest hit that stops the ray. */
static bool user_meets(const shape *s, uint32_t primitive, const struct RTCRay *query,
                       float tuv[3])
{
    ray r = from_embree(query);
    float t_min = 0.0f;
    for (int i = 0; i < MOST_LAYERS; i++) {
        bool met = s->kind->intersect(s->self, primitive, &r, t_min, tuv);
        if (!met || !s->has_alpha || (query->flags & RAY_SOLID))
            return met;
        if (stops(s, &r, primitive, tuv))
            return true;
        t_min = nextafterf(tuv[0], INFINITY); /* the same hit is rounded to this */
    }
    return false;
}

static void user_intersect(const struct RTCIntersectFunctionNArguments *args)
{
    struct RTCRayHit *query = (struct RTCRayHit *)args->rayhit;
    float tuv[3];
    if (!args->valid[0] ||
        !user_meets(args->geometryUserPtr, args->primID, &query->ray, tuv))
        return;
    query->ray.tfar = tuv[0];
    query->hit.u = tuv[1];
    query->hit.v = tuv[2];
    query->hit.primID = args->primID;
    query->hit.geomID = args->geomID;
    query->hit.instID[0] = args->context->instID[0];
}

static void user_occluded(const struct RTCOccludedFunctionNArguments *args)
{
    const shape *s = args->geometryUserPtr;
    struct RTCRay *query = (struct RTCRay *)args->ray;
    float tuv[3];
    if (args->valid[0] && s->material != NO_INDEX &&
        user_meets(s, args->primID, query, tuv))
        query->tfar = -INFINITY;
}

static RTCGeometry triangle_geometry(RTCDevice device, const shape *s, const mesh *m)
{
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               m->positions, 0, 3 * sizeof(float), m->n_vertices);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, m->indices,
                               0, 3 * sizeof(uint32_t), m->n_triangles);
    if (s->has_alpha) {
        rtcSetGeometryIntersectFilterFunction(g, filter_cut_out);
        rtcSetGeometryOccludedFilterFunction(g, filter_cut_out);
    }
    if (s->material == NO_INDEX)
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

RTCGeometry shape_geometry(RTCDevice device, shape *s)
{
    const mesh *m = s->kind->triangles ? s->kind->triangles(s->self) : NULL;
    RTCGeometry g = m ? triangle_geometry(device, s, m) : exact_geometry(device, s);
    rtcSetGeometryUserData(g, s);
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
    const placed *p = args->geometryUserPtr;
    const double *shutter = p->shutter;
    double step = (shutter[1] - shutter[0]) / (MOTION_BOXES - 1);
    double at = shutter[0] + args->timeStep * step;
    give_bounds(args, motion_bounds(&p->is->to_world, p->bounds, at - step, at + step));
}

/* The query in the object's space. */
static struct RTCRay taken_to_object(const placed *p, const struct RTCRay *query)
{
    transform to_world = placed_at(p, query->time);
    ray world = from_embree(query), r = instance_ray(&to_world, &world);
    struct RTCRay out = *query;
    out.org_x = r.origin[0];
    out.org_y = r.origin[1];
    out.org_z = r.origin[2];
    out.dir_x = r.direction[0];
    out.dir_y = r.direction[1];
    out.dir_z = r.direction[2];
    return out;
}

static void moving_intersect(const struct RTCIntersectFunctionNArguments *args)
{
    const placed *p = args->geometryUserPtr;
    struct RTCRayHit *query = (struct RTCRayHit *)args->rayhit;
    if (!args->valid[0])
        return;
    struct RTCRayHit inner = {.ray = taken_to_object(p, &query->ray)};
    if (!embree_takes(&inner.ray, OBJECT_REACH))
        return;
    inner.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    embree_nearest(p->object, &inner);
    if (inner.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return;
    query->ray.tfar = inner.ray.tfar;
    query->hit = inner.hit;
    query->hit.instID[0] = args->geomID;
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

static RTCGeometry still_geometry(RTCDevice device, const placed *p)
{
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    float matrix[12];
    for (int i = 0; i < 12; i++)
        matrix[i] = (float)p->still.m[i / 4][i % 4];
    rtcSetGeometryInstancedScene(g, p->object);
    rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, matrix);
    return g;
}

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
static bool may_be_embrees(const transform *to_world)
{
    const double largest = 1e9, most_reach = (double)(OBJECT_REACH / WORLD_REACH) / 10.0;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            if (!(fabs(to_world->m[i][k]) <= largest) ||
                !(fabs(to_world->inverse[i][k]) <= most_reach))
                return false;
        if (!(fabs(to_world->inverse[i][3]) <= (double)OBJECT_REACH / 10.0))
            return false;
    }
    return true;
}

RTCGeometry placed_geometry(RTCDevice device, placed *p)
{
    bool asks_us = p->moves || !may_be_embrees(&p->still);
    return asks_us ? moving_geometry(device, p) : still_geometry(device, p);
}
