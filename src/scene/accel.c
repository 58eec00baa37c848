/*
 * Embree behind one file. Triangles are handed over as shared buffers, quadrics as user
 * geometry that is intersected exactly; Embree's geometry number is the shape's index.
 *
 * Embree 3 passes a context with every query, Embree 4 optional arguments: the two
 * functions query_nearest and query_any hold the whole difference.
 */
#include "scene/accel.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <float.h>
#include <string.h>

struct accel {
    RTCDevice device;
    RTCScene scene;
    shape **shapes;    /* a copy of the array; the shapes are borrowed */
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

/* ---- Quadrics as user geometry ---- */

static void user_bounds(const struct RTCBoundsFunctionArguments *args)
{
    const shape *s = args->geometryUserPtr;
    box3 box = s->kind->bounds(s->self);
    struct RTCBounds *out = args->bounds_o;
    out->lower_x = box.low[0];
    out->lower_y = box.low[1];
    out->lower_z = box.low[2];
    out->upper_x = box.high[0];
    out->upper_y = box.high[1];
    out->upper_z = box.high[2];
}

static ray from_embree(const struct RTCRay *r)
{
    return (ray){.origin = vec3_make(r->org_x, r->org_y, r->org_z),
                 .direction = vec3_make(r->dir_x, r->dir_y, r->dir_z),
                 .t_max = r->tfar};
}

static void user_intersect(const struct RTCIntersectFunctionNArguments *args)
{
    const shape *s = args->geometryUserPtr;
    struct RTCRayHit *query = (struct RTCRayHit *)args->rayhit;
    if (!args->valid[0])
        return;
    ray r = from_embree(&query->ray);
    float t, u, v;
    if (!s->kind->intersect(s->self, &r, &t, &u, &v))
        return;
    query->ray.tfar = t;
    query->hit.u = u;
    query->hit.v = v;
    query->hit.primID = 0;
    query->hit.geomID = args->geomID;
}

static void user_occluded(const struct RTCOccludedFunctionNArguments *args)
{
    const shape *s = args->geometryUserPtr;
    struct RTCRay *query = (struct RTCRay *)args->ray;
    if (!args->valid[0] || s->material == NO_INDEX)
        return;
    ray r = from_embree(query);
    float t, u, v;
    if (s->kind->intersect(s->self, &r, &t, &u, &v))
        query->tfar = -INFINITY;
}

/* Interfaces without a material hide nothing. */
static void let_through(const struct RTCFilterFunctionNArguments *args)
{
    args->valid[0] = 0;
}

/* ---- Building ---- */

static void note_error(void *data, enum RTCError code, const char *message)
{
    accel *a = data;
    a->code = code;
    g_strlcpy(a->message, message ? message : "no reason given", sizeof a->message);
}

static RTCGeometry make_geometry(accel *a, shape *s)
{
    const mesh *m = s->kind->triangles ? s->kind->triangles(s->self) : NULL;
    RTCGeometry g = rtcNewGeometry(a->device, m ? RTC_GEOMETRY_TYPE_TRIANGLE
                                                : RTC_GEOMETRY_TYPE_USER);
    if (m) {
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   m->positions, 0, 3 * sizeof(float), m->n_vertices);
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   m->indices, 0, 3 * sizeof(uint32_t), m->n_triangles);
        if (s->material == NO_INDEX)
            rtcSetGeometryOccludedFilterFunction(g, let_through);
    } else {
        rtcSetGeometryUserPrimitiveCount(g, 1);
        rtcSetGeometryUserData(g, s);
        rtcSetGeometryBoundsFunction(g, user_bounds, NULL);
        rtcSetGeometryIntersectFunction(g, user_intersect);
        rtcSetGeometryOccludedFunction(g, user_occluded);
    }
    return g;
}

static void build(accel *a, size_t n)
{
    a->scene = rtcNewScene(a->device);
    rtcSetSceneFlags(a->scene, RTC_SCENE_FLAG_ROBUST);
    for (size_t i = 0; i < n; i++) {
        RTCGeometry g = make_geometry(a, a->shapes[i]);
        rtcCommitGeometry(g);
        rtcAttachGeometryByID(a->scene, g, (unsigned)i);
        rtcReleaseGeometry(g);
    }
    rtcCommitScene(a->scene);
}

accel *accel_build(shape *const *shapes, size_t n, unsigned threads, GError **error)
{
    g_autofree char *config = g_strdup_printf("threads=%u,set_affinity=0", threads);
    accel *a = g_new0(accel, 1);
    a->shapes = g_memdup2(shapes, n * sizeof(shape *));
    a->device = rtcNewDevice(config);
    if (!a->device) {
        error_set(error, ERROR_FAILED, "Embree does not start (error %d)",
                  (int)rtcGetDeviceError(NULL));
        g_free(a->shapes);
        g_free(a);
        return NULL;
    }
    rtcSetDeviceErrorFunction(a->device, note_error, a);
    build(a, n);
    if (a->code != RTC_ERROR_NONE) {
        error_set(error, ERROR_FAILED, "Embree can not build the scene: %s%s",
                  a->code == RTC_ERROR_OUT_OF_MEMORY ? "out of memory: " : "",
                  a->message);
        accel_free(a);
        return NULL;
    }
    return a;
}

void accel_free(accel *a)
{
    if (!a)
        return;
    rtcReleaseScene(a->scene);
    rtcReleaseDevice(a->device);
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
    const vec3 direction = choose3(xyz, r->direction, (vec3){0});
    struct RTCRay to = {.tfar = r->t_max, .mask = ~0u};
    memcpy(&to.org_x, &origin, sizeof origin);
    memcpy(&to.dir_x, &direction, sizeof direction);
    return to;
}

bool accel_intersect(const accel *a, const ray *r, surface_hit *hit)
{
    struct RTCRayHit query = {.ray = to_embree(r)};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    query_nearest(a->scene, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    const shape *s = a->shapes[query.hit.geomID];
    hit->t = query.ray.tfar;
    hit->time = r->time;
    hit->shape = (int)query.hit.geomID;
    hit->primitive = query.hit.primID;
    hit->dpdv = (vec3){0};
    hit->footprint = 0.0f;
    s->kind->fill_hit(s->self, r, query.hit.u, query.hit.v, hit);
    return true;
}

bool accel_occluded(const accel *a, const ray *r)
{
    struct RTCRay query = to_embree(r);
    query_any(a->scene, &query);
    return query.tfar < 0.0f;
}
