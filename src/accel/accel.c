/*
 * Building Embree's scenes, and asking them.
 *
 *   the world ── its own shapes, numbered as in world.shapes
 *             └─ instances, numbered from world.n on ── an object ── its shapes
 *
 * Embree takes 1 / x for at most 10¹⁸, so that it misses triangles of less than
 * 10⁻¹⁸ m², and no coordinate beyond. Objects or a world that are very small or large go
 * to it in units of their own, powers of two of a metre, which change no digit. Rays that
 * come from afar are asked in parts: see accel_core.h.
 */
#include "accel/accel_core.h"
#include "accel/embree_device.h"
#include "accel/embree_threads.h"
#include "base/memory.h"
#include "base/wanted.h"

#include <string.h>

/* Shapes with one acceleration structure. */
typedef struct accel_group {
    RTCScene scene;
    unsigned
        *shapes; /* indices in accel.shapes; their places here are Embree's numbers */
    unsigned n;
    size_t n_parts; /* of all of them, that a ray may meet */
    bool has_triangles;
    box3 bounds;     /* m */
    float per_metre; /* Embree's units: a power of two */
    box3 core;       /* of an object, m; empty: it has none */
    bool core_is_known;
} accel_group;

/* Extents that are given to Embree in metres, and what others become, in its units. */
#define SMALLEST_IN_METRES 1e-3f
#define LARGEST_IN_METRES 1e6f
enum { USUAL_EXTENT = 10 }; /* log2 */

/* Of a ray from afar: each begins 2¹⁹ times nearer than the one before. */
enum { MOST_PARTS = 3 };

struct accel {
    embree_device embree;
    given_shape *shapes; /* as they were given; the shapes are borrowed */
    accel_group world, *objects;
    accel_core core; /* of the world */
    size_t n_objects, n_instances;
    size_t reserved; /* bytes of what Embree does not tell of */
    placed *instances;
    double shutter[2]; /* s: when rays of time 0 and 1 are */

    GThread *builder;     /* while it is built: who asked for it ... */
    atomic_bool unwanted; /* ... and wants it no more */
};

/* ---- Building ---- */

static void attach(accel_group *to, RTCGeometry g, unsigned number)
{
    rtcCommitGeometry(g);
    rtcAttachGeometryByID(to->scene, g, number);
    rtcReleaseGeometry(g);
}

/* For the largest coordinate of what is within bounds. */
static float units_for(box3 bounds)
{
    if (box3_is_empty(bounds))
        return 1.0f;
    float far = max_component3(max3(abs3(bounds.low), abs3(bounds.high)));
    if (!(far > 0.0f) || (far >= SMALLEST_IN_METRES && far <= LARGEST_IN_METRES))
        return 1.0f;
    return ldexpf(1.0f, CLAMP(USUAL_EXTENT - ilogbf(far), -120, 120));
}

/* Embree's threads ask, too: the caller is told of it on its own. */
static bool goes_on(void *data, double fraction)
{
    embree_take_over();
    accel *a = data;
    (void)fraction;
    if (g_thread_self() == a->builder && !still_wanted(NULL))
        atomic_store(&a->unwanted, true);
    bool wanted = !atomic_load(&a->unwanted);
    embree_hand_over();
    return wanted;
}

/* In units that suit its bounds. */
static void group_open(accel *a, accel_group *group)
{
    group->scene = rtcNewScene(a->embree.device);
    group->per_metre = units_for(group->bounds);
    rtcSetSceneFlags(group->scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneProgressMonitorFunction(group->scene, goes_on, a);
}

static accel_group *group_of(accel *a, const shape *s)
{
    return s->object == NO_INDEX ? &a->world : &a->objects[s->object];
}

static void make_room(accel_group *group)
{
    group->shapes = g_new(unsigned, MAX(group->n, 1));
    group->n = 0;
}

/* Into the world and the objects. */
static void sort_shapes(accel *a, const accel_input *in)
{
    for (size_t i = 0; i < in->n_shapes; i++)
        group_of(a, in->shapes[i])->n++;
    make_room(&a->world);
    for (size_t i = 0; i < a->n_objects; i++)
        make_room(&a->objects[i]);
    for (size_t i = 0; i < in->n_shapes; i++) {
        accel_group *group = group_of(a, in->shapes[i]);
        group->shapes[group->n++] = (unsigned)i;
    }
}

static void find_bounds(accel *a, accel_group *group)
{
    group->bounds = box3_empty();
    for (unsigned i = 0; i < group->n; i++) {
        const shape *s = a->shapes[group->shapes[i]].shape;
        group->n_parts += core_parts_of(s);
        group->has_triangles |= s->kind->triangles && !s->is_invisible;
        if (!s->is_invisible)
            group->bounds = box3_union(group->bounds, s->kind->bounds(s->self));
    }
}

static void attach_shapes(accel *a, accel_group *group)
{
    for (unsigned i = 0; i < group->n && still_wanted(NULL); i++) {
        given_shape *given = &a->shapes[group->shapes[i]];
        given->per_metre = group->per_metre;
        given->is_beside_triangles = group->has_triangles;
        if (!given->shape->is_invisible)
            attach(group, shape_geometry(a->embree.device, given), i);
    }
}

static void place_instance(accel *a, placed *p, const instance *is)
{
    const accel_group *object = &a->objects[is->object];
    *p = (placed){.is = is,
                  .shutter = a->shutter,
                  .object = object->scene,
                  .bounds = object->bounds,
                  .per_metre = object->per_metre};
    transform open = motion_at(&is->to_world, a->shutter[0]);
    transform close = motion_at(&is->to_world, a->shutter[1]);
    transform middle = motion_at(&is->to_world, 0.5 * (a->shutter[0] + a->shutter[1]));
    p->still = open;
    p->moves = !transform_equal(&open, &close) || !transform_equal(&open, &middle);
}

static void build_object(accel *a, accel_group *object)
{
    find_bounds(a, object);
    group_open(a, object);
    attach_shapes(a, object);
    embree_commit(object->scene);
}

/* Places the instances, which the world's bounds and units must hold. */
static void open_world(accel *a, const accel_input *in)
{
    find_bounds(a, &a->world);
    for (size_t i = 0; i < in->n_instances; i++) {
        placed *p = &a->instances[i];
        place_instance(a, p, &in->instances[i]);
        if (!box3_is_empty(p->bounds))
            a->world.bounds =
                box3_union(a->world.bounds, motion_bounds(&p->is->to_world, p->bounds,
                                                          a->shutter[0], a->shutter[1]));
    }
    group_open(a, &a->world);
}

/* ---- Its core ---- */

/* Shapes of the world, or of an object. */
typedef struct group_walk {
    accel *of;
    accel_group *group;
} group_walk;

static void add_shapes(core_search *search, void *data)
{
    const group_walk *walk = data;
    const accel_group *group = walk->group;
    for (unsigned i = 0; i < group->n && !core_is_out_of_question(search); i++)
        core_add_shape(search, walk->of->shapes[group->shapes[i]].shape);
}

/* Looked for where an object reaches far. */
static box3 object_core(accel *a, accel_group *object)
{
    group_walk walk = {a, object};
    if (!object->core_is_known)
        object->core = core_find(object->bounds, add_shapes, &walk);
    object->core_is_known = true;
    return object->core;
}

static void add_instance(accel *a, const placed *p, core_search *search)
{
    box3 all = motion_bounds(&p->is->to_world, p->bounds, a->shutter[0], a->shutter[1]);
    if (max_component3(all.high - all.low) > search->most) {
        box3 core = object_core(a, &a->objects[p->is->object]);
        if (!box3_is_empty(core))
            all = motion_bounds(&p->is->to_world, core, a->shutter[0], a->shutter[1]);
    }
    core_add(search, all, a->objects[p->is->object].n_parts);
}

static void add_world(core_search *search, void *data)
{
    accel *a = data;
    group_walk walk = {a, &a->world};
    add_shapes(search, &walk);
    for (size_t i = 0; i < a->n_instances && !core_is_out_of_question(search); i++)
        if (!box3_is_empty(a->instances[i].bounds))
            add_instance(a, &a->instances[i], search);
}

/* ---- All of it ---- */

static void build(accel *a, const accel_input *in)
{
    sort_shapes(a, in);
    for (size_t i = 0; i < a->n_objects && still_wanted(NULL); i++)
        build_object(a, &a->objects[i]);
    if (!still_wanted(NULL))
        return;
    open_world(a, in);
    a->core = accel_core_make(core_find(a->world.bounds, add_world, a));
    attach_shapes(a, &a->world);
    for (size_t i = 0; i < in->n_instances && still_wanted(NULL); i++) {
        placed *p = &a->instances[i];
        p->world_per_metre = a->world.per_metre;
        if (a->objects[p->is->object].n > 0)
            attach(&a->world, placed_geometry(a->embree.device, p),
                   a->world.n + (unsigned)i);
    }
    if (still_wanted(NULL))
        embree_commit(a->world.scene);
}

/* Embree 3.13 mallocs 260 bytes a geometry and 1.2 kB a scene, 4.1 kB with one geometry.
 */
#define SHAPE_SIZE ((size_t)320)
#define OBJECT_SIZE ((size_t)4096)

static bool reserve_things(accel *a, size_t n_shapes, GError **error)
{
    const size_t each = 384; /* Embree 3.13 takes 298, with malloc */
    size_t size = a->n_instances * each;
    if (!memory_ask(n_shapes * SHAPE_SIZE + a->n_objects * OBJECT_SIZE, "shapes", error))
        return false;
    if (memory_reserve(size, "instances", error))
        a->reserved = size;
    return a->reserved == size;
}

accel *accel_build(const accel_input *in, unsigned threads, GError **error)
{
    accel *a = g_new0(accel, 1);
    a->shapes = g_new0(given_shape, MAX(in->n_shapes, 1));
    for (size_t i = 0; i < in->n_shapes; i++)
        a->shapes[i].shape = in->shapes[i];
    a->n_objects = in->n_objects;
    a->objects = g_new0(accel_group, MAX(in->n_objects, 1));
    a->n_instances = in->n_instances;
    a->instances = big_alloc(in->n_instances, sizeof(placed), "instances", error);
    memcpy(a->shutter, in->shutter, sizeof a->shutter);
    if (a->instances && reserve_things(a, in->n_shapes, error) &&
        embree_device_open(&a->embree, "the search structure", threads, error)) {
        a->builder = g_thread_self();
        build(a, in);
        a->builder = NULL;
        if (still_wanted(error) && embree_device_check(&a->embree, error))
            return a;
    }
    accel_free(a);
    return NULL;
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
    embree_device_close(&a->embree);
    memory_release(a->reserved);
    g_free(a->objects);
    big_free(a->instances);
    g_free(a->shapes);
    g_free(a);
}

/* ---- Queries ---- */

/* Of an instance: filled in the object's space, then placed. */
static void fill_instance(const accel *a, const shape *s, const ray *r, surface_hit *hit)
{
    transform to_world = placed_at(&a->instances[hit->instance], r->time);
    ray local = instance_ray(&to_world, r);
    s->kind->fill_hit(s->self, &local, hit->corners.x, hit->corners.y, hit);
    instance_place_hit(&to_world, hit);
}

void accel_fill_hit(const accel *a, const ray *r, surface_hit *hit)
{
    const shape *s = a->shapes[hit->shape].shape;
    hit->dpdv = (vec3){0};
    hit->footprint = 0.0f;
    hit->mesh = NULL;
    hit->camera_facing = false;
    if (hit->instance != NO_INDEX)
        fill_instance(a, s, r, hit);
    else
        s->kind->fill_hit(s->self, r, hit->corners.x, hit->corners.y, hit);
}

/* The shape and the instance that Embree's numbers stand for. */
static void name_hit(const accel *a, const struct RTCHit *found, surface_hit *hit)
{
    bool placed_there = found->instID[0] != RTC_INVALID_GEOMETRY_ID;
    hit->instance = placed_there ? (int)(found->instID[0] - a->world.n) : NO_INDEX;
    const accel_group *group =
        placed_there ? &a->objects[a->instances[hit->instance].is->object] : &a->world;
    hit->shape = (int)group->shapes[found->geomID];
}

/* The nearest hit, in Embree's words. */
static bool ask_nearest(const accel *a, const ray *r, unsigned flags,
                        struct RTCRayHit *query)
{
    *query = (struct RTCRayHit){.ray = embree_ray(r, a->world.per_metre)};
    if (!embree_takes(&query->ray, WORLD_REACH))
        return false;
    query->ray.flags = flags;
    query->hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query->hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree_nearest(a->world.scene, query);
    return query->hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

static bool ask_any(const accel *a, const ray *r)
{
    struct RTCRay query = embree_ray(r, a->world.per_metre);
    if (!embree_takes(&query, WORLD_REACH))
        return false;
    embree_any(a->world.scene, &query);
    return query.tfar < 0.0f;
}

/* Cuts off the part of the ray that comes first, if the ray comes from afar. */
static bool next_part(const accel *a, ray *rest, ray *part)
{
    float ahead = accel_core_ahead(&a->core, rest);
    if (!(ahead > 0.0f))
        return false;
    *part = *rest;
    part->t_max = ahead;
    for (int i = 0; i < 3; i++)
        rest->origin[i] =
            (float)((double)rest->origin[i] + (double)ahead * (double)rest->direction[i]);
    rest->t_max -= ahead;
    return true;
}

/* What is asked for part by part begins at *begin, along the ray. */
static bool ask_nearest_in_parts(const accel *a, const ray *r, unsigned flags,
                                 struct RTCRayHit *query, float *begin)
{
    ray part, rest = *r;
    for (int i = 0; i < MOST_PARTS && next_part(a, &rest, &part); i++) {
        if (ask_nearest(a, &part, flags, query))
            return true;
        *begin += part.t_max;
    }
    return ask_nearest(a, &rest, flags, query);
}

static bool ask_any_in_parts(const accel *a, const ray *r)
{
    ray part, rest = *r;
    for (int i = 0; i < MOST_PARTS && next_part(a, &rest, &part); i++)
        if (ask_any(a, &part))
            return true;
    return ask_any(a, &rest);
}

/* What Embree found at t on a ray, but not yet what follows from it (accel_fill_hit). */
static void place_hit(const accel *a, const struct RTCHit *found, float t, float time,
                      surface_hit *hit)
{
    name_hit(a, found, hit);
    const given_place at =
        given_place_of(&a->shapes[hit->shape], found->primID, found->u, found->v);
    hit->t = t;
    hit->time = time;
    hit->primitive = at.primitive;
    hit->corners = at.corners;
}

static bool intersect(const accel *a, const ray *r, unsigned flags, surface_hit *hit)
{
    struct RTCRayHit query;
    float begin = 0.0f;
    bool met = accel_core_exists(&a->core)
                   ? ask_nearest_in_parts(a, r, flags, &query, &begin)
                   : ask_nearest(a, r, flags, &query);
    if (!met)
        return false;
    place_hit(a, &query.hit, begin + query.ray.tfar / a->world.per_metre, r->time, hit);
    accel_fill_hit(a, r, hit);
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

/* The nearest hits, in Embree's words. Where a processor has no vectors of 16, Embree
   asks for all rays that end behind their beginning, whichever are valid. */
static void ask_packet(const accel *a, const ray *rays, int n, struct RTCRayHit16 *query)
{
    static const struct RTCRay none = {.tnear = 1.0f, .tfar = 0.0f};
    int valid[RAY_PACKET] __attribute__((aligned(64))) = {0};
    for (int i = 0; i < RAY_PACKET; i++) {
        struct RTCRay one = i < n ? embree_ray(&rays[i], a->world.per_metre) : none;
        valid[i] = i < n && embree_takes(&one, WORLD_REACH) ? -1 : 0;
        packet_put(&query->ray, valid[i] ? &one : &none, RAY_ROWS, RAY_PACKET,
                   (unsigned)i);
        query->hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        query->hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    embree_nearest_packet(a->world.scene, valid, query);
}

static void intersect_one_by_one(const accel *a, const ray *rays, int n,
                                 surface_hit *hits)
{
    for (int i = 0; i < n; i++)
        if (!accel_intersect(a, &rays[i], &hits[i]))
            hits[i].shape = NO_INDEX;
}

void accel_intersect_packet(const accel *a, const ray *rays, int n, surface_hit *hits)
{
    struct RTCRayHit16 query;
    if (accel_core_exists(&a->core)) {
        intersect_one_by_one(a, rays, n, hits);
        return;
    }
    ask_packet(a, rays, n, &query);
    for (int i = 0; i < n; i++) {
        struct RTCHit found;
        packet_get(&found, &query.hit, HIT_ROWS, RAY_PACKET, (unsigned)i);
        hits[i].shape = NO_INDEX;
        if (found.geomID == RTC_INVALID_GEOMETRY_ID)
            continue;
        place_hit(a, &found, query.ray.tfar[i] / a->world.per_metre, rays[i].time,
                  &hits[i]);
        accel_fill_hit(a, &rays[i], &hits[i]);
    }
}

bool accel_occluded(const accel *a, const ray *r)
{
    return accel_core_exists(&a->core) ? ask_any_in_parts(a, r) : ask_any(a, r);
}

transform accel_instance_at(const accel *a, int i, float time)
{
    return placed_at(&a->instances[i], time);
}

bool accel_instance_moves(const accel *a, int i)
{
    return a->instances[i].moves;
}
