/*
 * Embree behind one file. Triangles are handed over as shared buffers; quadrics, patches
 * and curves as user geometry that is intersected exactly.
 *
 *   the world ── its own shapes, numbered as in world.shapes
 *             └─ instances, numbered from world.n on ── an object ── its shapes
 *
 * An instance that stands still is Embree's own. One that moves is user geometry too: the
 * ray is taken to the object's space at its own time by the same transform that later
 * places the hit, so motion is exact at every time, and no steps show. What Embree is
 * told of the motion is boxes at a few times, each large enough for the time around.
 *
 * Cut-outs: whether a ray passes a place of opacity a is decided by a hash of the ray and
 * the place, so that pictures are the same bits whatever the order of work.
 *
 * Embree 3 passes a context with every query, Embree 4 optional arguments: the two
 * functions query_nearest and query_any hold the whole difference.
 */
#include "scene/accel.h"

#include "math/sampler.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <float.h>
#include <string.h>

enum {
    MOTION_BOXES = 9,  /* times at which the box of a moving instance is told */
    RAY_SOLID = 1,     /* RTCRay.flags: cut-outs do not count */
    MOST_LAYERS = 256, /* of cut-outs in one primitive, against endless loops */
};

/* Shapes with one acceleration structure. */
typedef struct accel_group {
    RTCScene scene;
    unsigned
        *shapes; /* indices in accel.shapes; their places here are Embree's numbers */
    unsigned n;
    box3 bounds;
} accel_group;

typedef struct placed {
    const accel *owner;
    const instance *is;
    accel_group *object;
    bool moves;
    transform still; /* where it is if it does not move */
} placed;

struct accel {
    RTCDevice device;
    shape **shapes; /* a copy of the array; the shapes are borrowed */
    accel_group world, *objects;
    size_t n_objects, n_instances;
    placed *instances;
    double shutter[2];
    char message[256]; /* the last thing the device complained of, while building */
    enum RTCError code;
};

static void query_nearest(RTCScene scene, struct RTCRayHit *query)
{
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(scene, query, NULL);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, query);
#endif
}

static void query_any(RTCScene scene, struct RTCRay *query)
{
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded1(scene, query, NULL);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, query);
#endif
}

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

/* ---- Moving instances as user geometry ---- */

static transform placed_at(const placed *p, float time)
{
    const double *shutter = p->owner->shutter;
    if (!p->moves)
        return p->still;
    return motion_at(&p->is->to_world,
                     shutter[0] + (double)time * (shutter[1] - shutter[0]));
}

static void moving_bounds(const struct RTCBoundsFunctionArguments *args)
{
    const placed *p = args->geometryUserPtr;
    const double *shutter = p->owner->shutter;
    double step = (shutter[1] - shutter[0]) / (MOTION_BOXES - 1);
    double at = shutter[0] + args->timeStep * step;
    give_bounds(args,
                motion_bounds(&p->is->to_world, p->object->bounds, at - step, at + step));
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
    inner.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query_nearest(p->object->scene, &inner);
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
    query_any(p->object->scene, &inner);
    if (inner.tfar < 0.0f)
        query->tfar = -INFINITY;
}

/* ---- Building ---- */

static void note_error(void *data, enum RTCError code, const char *message)
{
    accel *a = data;
    a->code = code;
    g_strlcpy(a->message, message ? message : "no reason given", sizeof a->message);
}

static RTCGeometry triangle_geometry(const accel *a, const shape *s, const mesh *m)
{
    RTCGeometry g = rtcNewGeometry(a->device, RTC_GEOMETRY_TYPE_TRIANGLE);
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

static RTCGeometry exact_geometry(const accel *a, const shape *s)
{
    RTCGeometry g = rtcNewGeometry(a->device, RTC_GEOMETRY_TYPE_USER);
    size_t n = s->kind->n_primitives ? s->kind->n_primitives(s->self) : 1;
    rtcSetGeometryUserPrimitiveCount(g, (unsigned)n);
    rtcSetGeometryBoundsFunction(g, user_bounds, NULL);
    rtcSetGeometryIntersectFunction(g, user_intersect);
    rtcSetGeometryOccludedFunction(g, user_occluded);
    return g;
}

static RTCGeometry shape_geometry(const accel *a, shape *s)
{
    const mesh *m = s->kind->triangles ? s->kind->triangles(s->self) : NULL;
    RTCGeometry g = m ? triangle_geometry(a, s, m) : exact_geometry(a, s);
    rtcSetGeometryUserData(g, s);
    return g;
}

static RTCGeometry still_geometry(const accel *a, const placed *p)
{
    RTCGeometry g = rtcNewGeometry(a->device, RTC_GEOMETRY_TYPE_INSTANCE);
    float matrix[12];
    for (int i = 0; i < 12; i++)
        matrix[i] = (float)p->still.m[i / 4][i % 4];
    rtcSetGeometryInstancedScene(g, p->object->scene);
    rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, matrix);
    return g;
}

static RTCGeometry moving_geometry(const accel *a, placed *p)
{
    RTCGeometry g = rtcNewGeometry(a->device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(g, 1);
    rtcSetGeometryTimeStepCount(g, MOTION_BOXES);
    rtcSetGeometryUserData(g, p);
    rtcSetGeometryBoundsFunction(g, moving_bounds, NULL);
    rtcSetGeometryIntersectFunction(g, moving_intersect);
    rtcSetGeometryOccludedFunction(g, moving_occluded);
    return g;
}

static void attach(accel_group *to, RTCGeometry g, unsigned number)
{
    rtcCommitGeometry(g);
    rtcAttachGeometryByID(to->scene, g, number);
    rtcReleaseGeometry(g);
}

static void group_open(accel *a, accel_group *group)
{
    group->scene = rtcNewScene(a->device);
    group->bounds = box3_empty();
    rtcSetSceneFlags(group->scene, RTC_SCENE_FLAG_ROBUST);
}

/* Sorts the shapes into the world and the objects. */
static void sort_shapes(accel *a, const accel_input *in)
{
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < in->n_shapes; i++) {
            int object = in->shapes[i]->object;
            accel_group *group = object == NO_INDEX ? &a->world : &a->objects[object];
            if (pass == 1)
                group->shapes[group->n] = (unsigned)i;
            group->n++;
        }
        for (size_t k = 0; k <= a->n_objects && pass == 0; k++) {
            accel_group *group = k == 0 ? &a->world : &a->objects[k - 1];
            group->shapes = g_new(unsigned, MAX(group->n, 1));
            group->n = 0;
        }
    }
}

static void attach_shapes(accel *a, accel_group *group)
{
    group_open(a, group);
    for (unsigned i = 0; i < group->n; i++) {
        shape *s = a->shapes[group->shapes[i]];
        if (s->is_invisible)
            continue;
        attach(group, shape_geometry(a, s), i);
        group->bounds = box3_union(group->bounds, s->kind->bounds(s->self));
    }
}

static void place_instance(accel *a, placed *p, const instance *is)
{
    *p = (placed){.owner = a, .is = is, .object = &a->objects[is->object]};
    transform open = motion_at(&is->to_world, a->shutter[0]);
    transform close = motion_at(&is->to_world, a->shutter[1]);
    transform middle = motion_at(&is->to_world, 0.5 * (a->shutter[0] + a->shutter[1]));
    p->still = open;
    p->moves = !transform_equal(&open, &close) || !transform_equal(&open, &middle);
}

static void build(accel *a, const accel_input *in)
{
    sort_shapes(a, in);
    for (size_t i = 0; i < a->n_objects; i++) {
        attach_shapes(a, &a->objects[i]);
        rtcCommitScene(a->objects[i].scene);
    }
    attach_shapes(a, &a->world);
    for (size_t i = 0; i < in->n_instances; i++) {
        placed *p = &a->instances[i];
        place_instance(a, p, &in->instances[i]);
        if (p->object->n > 0)
            attach(&a->world, p->moves ? moving_geometry(a, p) : still_geometry(a, p),
                   a->world.n + (unsigned)i);
    }
    rtcCommitScene(a->world.scene);
}

accel *accel_build_scene(const accel_input *in, unsigned threads, GError **error)
{
    g_autofree char *config = g_strdup_printf("threads=%u,set_affinity=0", threads);
    accel *a = g_new0(accel, 1);
    a->shapes = g_memdup2(in->shapes, in->n_shapes * sizeof(shape *));
    a->n_objects = in->n_objects;
    a->objects = g_new0(accel_group, MAX(in->n_objects, 1));
    a->n_instances = in->n_instances;
    a->instances = g_new0(placed, MAX(in->n_instances, 1));
    memcpy(a->shutter, in->shutter, sizeof a->shutter);
    a->device = rtcNewDevice(config);
    if (!a->device) {
        error_set(error, ERROR_FAILED, "Embree does not start (error %d)",
                  (int)rtcGetDeviceError(NULL));
        accel_free(a);
        return NULL;
    }
    rtcSetDeviceErrorFunction(a->device, note_error, a);
    build(a, in);
    if (a->code != RTC_ERROR_NONE) {
        error_set(error, ERROR_FAILED, "Embree can not build the scene: %s%s",
                  a->code == RTC_ERROR_OUT_OF_MEMORY ? "out of memory: " : "",
                  a->message);
        accel_free(a);
        return NULL;
    }
    return a;
}

accel *accel_build(shape *const *shapes, size_t n, unsigned threads, GError **error)
{
    const accel_input in = {.shapes = shapes, .n_shapes = n, .shutter = {0.0, 1.0}};
    return accel_build_scene(&in, threads, error);
}

static void group_close(accel_group *group)
{
    if (group->scene)
        rtcReleaseScene(group->scene);
    g_free(group->shapes);
}

void accel_free(accel *a)
{
    if (!a)
        return;
    group_close(&a->world);
    for (size_t i = 0; i < a->n_objects; i++)
        group_close(&a->objects[i]);
    if (a->device)
        rtcReleaseDevice(a->device);
    g_free(a->objects);
    g_free(a->instances);
    g_free(a->shapes);
    g_free(a);
}

/* ---- Queries ---- */

/* Embree reads origin and tnear, direction and time, as vectors: written as vectors they
 * reach it without waiting for the cache. */
static struct RTCRay to_embree(const ray *r)
{
    const vec3_bits xyz = {-1, -1, -1, 0};
    const vec3 origin = choose3(xyz, r->origin, (vec3){0.0f, 0.0f, 0.0f, FLT_MIN});
    const vec3 direction = choose3(xyz, r->direction, (vec3){0.0f, 0.0f, 0.0f, r->time});
    struct RTCRay to = {.tfar = r->t_max, .mask = ~0u};
    memcpy(&to.org_x, &origin, sizeof origin);
    memcpy(&to.dir_x, &direction, sizeof direction);
    return to;
}

/* Of an instance: filled in the object's space, then placed. */
static void fill_instance(const accel *a, const struct RTCRayHit *query, const ray *r,
                          surface_hit *hit)
{
    hit->instance = (int)(query->hit.instID[0] - a->world.n);
    const placed *p = &a->instances[hit->instance];
    hit->shape = (int)p->object->shapes[query->hit.geomID];
    const shape *s = a->shapes[hit->shape];
    transform to_world = placed_at(p, r->time);
    ray local = instance_ray(&to_world, r);
    s->kind->fill_hit(s->self, &local, query->hit.u, query->hit.v, hit);
    instance_place_hit(&to_world, hit);
}

static bool intersect(const accel *a, const ray *r, unsigned flags, surface_hit *hit)
{
    struct RTCRayHit query = {.ray = to_embree(r)};
    query.ray.flags = flags;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    query_nearest(a->world.scene, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    hit->t = query.ray.tfar;
    hit->time = r->time;
    hit->primitive = query.hit.primID;
    hit->dpdv = (vec3){0};
    hit->footprint = 0.0f;
    hit->mesh = NULL;
    if (query.hit.instID[0] != RTC_INVALID_GEOMETRY_ID) {
        fill_instance(a, &query, r, hit);
        return true;
    }
    hit->instance = NO_INDEX;
    hit->shape = (int)a->world.shapes[query.hit.geomID];
    const shape *s = a->shapes[hit->shape];
    s->kind->fill_hit(s->self, r, query.hit.u, query.hit.v, hit);
    return true;
}

bool accel_intersect(const accel *a, const ray *r, surface_hit *hit)
{
    return intersect(a, r, 0, hit);
}

bool accel_intersect_solid(const accel *a, const ray *r, surface_hit *hit)
{
    return intersect(a, r, RAY_SOLID, hit);
}

bool accel_occluded(const accel *a, const ray *r)
{
    struct RTCRay query = to_embree(r);
    query_any(a->world.scene, &query);
    return query.tfar < 0.0f;
}

transform accel_instance_at(const accel *a, int i, float time)
{
    return placed_at(&a->instances[i], time);
}

bool accel_instance_moves(const accel *a, int i)
{
    return a->instances[i].moves;
}
