/*
 * By Embree, as user geometry: every disc that a ray crosses is noted and lets it pass.
 * The order in which Embree meets them is its own affair, so they are sorted.
 */
#include "photon/disc_set.h"

#include "accel/embree_device.h"
#include "accel/embree_threads.h"

struct disc_set {
    embree_device embree;
    RTCScene scene;
    const disc *discs;
};

/* A query, with what Embree hands on to the function that intersects. */
typedef struct disc_query {
    embree_context context; /* first */
    const disc_set *set;
    disc_crossings *out;
    bool failed;
} disc_query;

static void disc_bounds(const struct RTCBoundsFunctionArguments *args)
{
    embree_take_over();
    const disc_set *set = args->geometryUserPtr;
    const disc *d = &set->discs[args->primID];
    struct RTCBounds *out = args->bounds_o;
    out->lower_x = d->x - d->radius;
    out->lower_y = d->y - d->radius;
    out->lower_z = d->z - d->radius;
    out->upper_x = d->x + d->radius;
    out->upper_y = d->y + d->radius;
    out->upper_z = d->z + d->radius;
    embree_hand_over();
}

static bool grow(disc_crossings *c)
{
    size_t capacity = c->capacity > 0 ? 2 * c->capacity : 64;
    disc_crossing *more = g_try_renew(disc_crossing, c->at, capacity);
    if (!more)
        return false;
    c->at = more;
    c->capacity = capacity;
    return true;
}

static void disc_occluded(const struct RTCOccludedFunctionNArguments *args)
{
    disc_query *query = (disc_query *)args->context;
    const struct RTCRay *r = (const struct RTCRay *)args->ray;
    const disc *d = &query->set->discs[args->primID];
    vec3 to = vec3_make(d->x - r->org_x, d->y - r->org_y, d->z - r->org_z);
    vec3 direction = vec3_make(r->dir_x, r->dir_y, r->dir_z);
    float t = dot3(to, direction);
    if (!args->valid[0] || !(t > 0.0f && t < r->tfar))
        return;
    float distance2 = length3_2(to - t * direction);
    if (!(distance2 < d->radius * d->radius))
        return;
    if (query->out->n == query->out->capacity && !grow(query->out))
        query->failed = true;
    else
        query->out->at[query->out->n++] = (disc_crossing){args->primID, t, distance2};
}

static void build(disc_set *set, size_t n)
{
    RTCGeometry g = rtcNewGeometry(set->embree.device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(g, (unsigned)n);
    rtcSetGeometryUserData(g, set);
    rtcSetGeometryBoundsFunction(g, disc_bounds, NULL);
    rtcSetGeometryOccludedFunction(g, disc_occluded);
    rtcCommitGeometry(g);
    set->scene = rtcNewScene(set->embree.device);
    rtcSetSceneFlags(set->scene, RTC_SCENE_FLAG_ROBUST);
    rtcAttachGeometry(set->scene, g);
    rtcReleaseGeometry(g);
    embree_commit(set->scene);
}

disc_set *disc_set_build(const disc *discs, size_t n, unsigned threads, GError **error)
{
    disc_set *set = g_new0(disc_set, 1);
    set->discs = discs;
    if (n >= RTC_INVALID_GEOMETRY_ID)
        error_set(error, ERROR_FAILED, "%zu photons in media are too many for Embree", n);
    else if (embree_device_open(&set->embree, "photons in media", threads, error)) {
        build(set, n);
        if (embree_device_check(&set->embree, error))
            return set;
    }
    disc_set_free(set);
    return NULL;
}

void disc_set_free(disc_set *set)
{
    if (!set)
        return;
    if (set->scene)
        rtcReleaseScene(set->scene);
    embree_device_close(&set->embree);
    g_free(set);
}

static int by_index(const void *a, const void *b)
{
    uint32_t i = ((const disc_crossing *)a)->index;
    uint32_t k = ((const disc_crossing *)b)->index;
    return i < k ? -1 : i > k;
}

bool disc_set_cross(const disc_set *set, const ray *r, disc_crossings *out)
{
    disc_query query = {.set = set, .out = out};
    struct RTCRay along = embree_ray(r, 1.0f);
    out->n = 0;
    if (embree_takes(&along, WORLD_REACH))
        embree_any_within(set->scene, &query.context, &along);
    if (out->n > 1)
        qsort(out->at, out->n, sizeof *out->at, by_index);
    return !query.failed;
}

void disc_crossings_clear(disc_crossings *c)
{
    g_free(c->at);
    *c = (disc_crossings){0};
}
