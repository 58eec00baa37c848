#include "photon/neighbourhood.h"

#include "math/sampler.h"

#include <string.h>

enum {
    RIM_PROBES = 6,
    AREA_PROBES = 24,
};

/* How far probes are lifted off the surface, at most and at least, and where the rim is
 * probed, over the radius. */
#define LIFT 0.06f
#define LEAST_LIFT 0.006f
#define RIM 0.9f

/* So far off the plane the rim of what bends may be, over the radius. */
#define ARC_HEIGHT 0.35f

/* A surface that is met near the rim under a greater angle is a wall (cosine). */
#define LEAST_SAME_NORMAL 0.8f

/* ... and what is turned further than this is not the disc's surface: the photons of it
   are left out (SAME_SURFACE in probe.h). */
#define LEAST_ALIKE 0.5f

/* Even where no probe passes, the centre itself is surface. */
#define LEAST_COVERAGE (0.5f / AREA_PROBES)

/* Two numbers in [0, 1) of its own for every place, so that probes make no pattern in the
 * picture. */
static vec2 numbers_at(vec3 p)
{
    uint32_t bits[3];
    for (int i = 0; i < 3; i++)
        memcpy(&bits[i], (float[]){p[i]}, sizeof bits[i]);
    uint64_t h = hash_mix(hash_mix(bits[0], bits[1]), bits[2]);
    return (vec2){(float)(h >> 40) * 0x1p-24f, (float)(h & 0xffffff) * 0x1p-24f};
}

/* A direction of the frame's plane, as cosine and sine. */
typedef struct turn {
    float c, s;
} turn;

static turn turn_by(float angle)
{
    return (turn){cosf(angle), sinf(angle)};
}

static turn turn_further(turn a, turn by)
{
    return (turn){a.c * by.c - a.s * by.s, a.s * by.c + a.c * by.s};
}

static vec3 direction_at(const neighbourhood *hood, turn a)
{
    return hood->frame.s * a.c + hood->frame.t * a.s;
}

static void turn_frame(neighbourhood *hood)
{
    hood->frame = frame_from_normal(hood->n);
    vec2 u = numbers_at(hood->p);
    vec3 s = direction_at(hood, turn_by(2.0f * PI_F * u.x));
    hood->offset = u.y;
    hood->frame = (frame){s, cross3(hood->n, s), hood->n};
}

static vec3 lifted(const neighbourhood *hood, vec3 p)
{
    return p + hood->n * hood->lift;
}

/* How far the surface of the disc lies off the point q of its plane, over what is
 * allowed; 1 or more: there is none. */
static float surface_height(const neighbourhood *hood, vec3 q)
{
    float slab = NEIGHBOURHOOD_FLATTEN * hood->radius, height = hood->lift;
    const ray down = {.origin = lifted(hood, q),
                      .direction = -hood->n,
                      .t_max = height + slab,
                      .time = hood->time};
    surface_hit hit;
    bool found = scene_intersect(hood->scene, &down, &hit) &&
                 fabsf(dot3(hit.n_geom, hood->n)) > LEAST_ALIKE;
    return found ? fabsf(hit.t - height) / slab : 1.0f;
}

/* From the lifted centre through the rim, until it is as far below the plane as a surface
   may be. */
static ray along_surface(const neighbourhood *hood, vec3 d)
{
    float lift = hood->lift / hood->radius;
    float slope = 1.0f / sqrtf(RIM * RIM + lift * lift);
    return (ray){.origin = lifted(hood, hood->p),
                 .time = hood->time,
                 .direction = (d * RIM - hood->n * lift) * slope,
                 .t_max = (lift + NEIGHBOURHOOD_FLATTEN) / (lift * slope) * hood->radius};
}

/* Down to the rim. */
static ray onto_rim(const neighbourhood *hood, vec3 d)
{
    vec3 rim = hood->p + d * (RIM * hood->radius);
    return (ray){.origin = rim + hood->n * (ARC_HEIGHT * hood->radius),
                 .time = hood->time,
                 .direction = -hood->n,
                 .t_max = 2.0f * ARC_HEIGHT * hood->radius};
}

static float cosine_to(const neighbourhood *hood, const ray *r, const surface_hit *hit)
{
    return dot3(face_forward(hit->n_geom, -r->direction), hood->n);
}

/* True if what a ray met lies in the disc's plane and is no wall across the way. */
static bool is_flat(const neighbourhood *hood, const ray *r, const surface_hit *hit)
{
    float height = dot3(hit->p - hood->p, hood->n);
    return height < NEIGHBOURHOOD_FLATTEN * hood->radius &&
           cosine_to(hood, r, hit) > LEAST_SAME_NORMAL;
}

/* True if what a ray met is joined to the centre by an arc: then both normals make the
   same angle with the chord. */
static bool is_arc(const neighbourhood *hood, const ray *r, const surface_hit *hit)
{
    vec3 n = face_forward(hit->n_geom, -r->direction);
    float off = dot3(hit->p - hood->p, n + hood->n);
    return fabsf(off) < 2.0f * NEIGHBOURHOOD_FLATTEN * hood->radius &&
           cosine_to(hood, r, hit) > LEAST_SAME_NORMAL;
}

/* True if what a ray from the lifted centre meets near the rim, in direction d, is the
 * disc's own surface, flat or evenly bent. */
static bool rim_is_surface(const neighbourhood *hood, vec3 d)
{
    surface_hit hit;
    ray along = along_surface(hood, d);
    if (scene_intersect(hood->scene, &along, &hit)) {
        if (is_flat(hood, &along, &hit))
            return true;
        if (hit.t < hood->radius && !is_arc(hood, &along, &hit))
            return false;
    }
    ray down = onto_rim(hood, d);
    return scene_intersect(hood->scene, &down, &hit) && is_arc(hood, &down, &hit);
}

static bool whole_rim(const neighbourhood *hood)
{
    const turn sixth = {0.5f, 0.86602540f};
    turn a = {1.0f, 0.0f};
    for (int i = 0; i < RIM_PROBES; i++, a = turn_further(a, sixth)) {
        if (!rim_is_surface(hood, direction_at(hood, a)))
            return false;
    }
    return true;
}

/* Lifts probes to the middle of a gap that is too low for them: from within what lies
 * above, they would not find the surface. @return false: there is no such gap */
static bool stay_below(neighbourhood *hood)
{
    float least = LEAST_LIFT * hood->radius;
    const ray up = {.origin = hood->p + hood->n * (0.5f * least),
                    .direction = hood->n,
                    .t_max = 2.0f * hood->lift,
                    .time = hood->time};
    surface_hit hit;
    if (!scene_intersect(hood->scene, &up, &hit))
        return false;
    hood->lift = maxf(0.5f * (hit.t + 0.5f * least), least);
    return true;
}

bool neighbourhood_is_whole(neighbourhood *hood)
{
    turn_frame(hood);
    hood->lift = LIFT * hood->radius;
    return whole_rim(hood) || (stay_below(hood) && whole_rim(hood));
}

/* Corners of the horizon between open directions lie so far out that its sides clear the
 * disc. */
#define OPEN_HORIZON 1.03f

/* A straight wall between two corners is the side between them: nothing behind it is
 * seen. */
static void probe_horizon(neighbourhood *hood)
{
    const turn sector = {0.92387953f, 0.38268343f}; /* a sixteenth */
    float reach = OPEN_HORIZON * hood->radius;
    turn a = {1.0f, 0.0f};
    vec2 corner[NEIGHBOURHOOD_SECTORS];
    for (int i = 0; i < NEIGHBOURHOOD_SECTORS; i++, a = turn_further(a, sector)) {
        ray along = {.origin = lifted(hood, hood->p),
                     .time = hood->time,
                     .direction = direction_at(hood, a),
                     .t_max = reach};
        surface_hit hit;
        float way = scene_intersect(hood->scene, &along, &hit) ? hit.t : reach;
        corner[i] = (vec2){way * a.c, way * a.s};
    }
    for (int i = 0; i < NEIGHBOURHOOD_SECTORS; i++) {
        vec2 p = corner[i], q = corner[(i + 1) % NEIGHBOURHOOD_SECTORS];
        hood->side[i] = (horizon_side){p.y - q.y, q.x - p.x, p.y * q.x - p.x * q.y};
    }
}

/* Probes on a sunflower spiral are even in area. The kernel weighs them as it does
 * photons: what bends off the plane counts as further away (photon_filter). */
float neighbourhood_coverage(neighbourhood *hood, const kernel *k)
{
    const turn golden = {-0.73736888f, 0.67549029f}; /* the golden angle */
    turn a = {1.0f, 0.0f};
    float whole = 0.0f, found = 0.0f;
    probe_horizon(hood);
    for (int i = 0; i < AREA_PROBES; i++, a = turn_further(a, golden)) {
        float r2 = ((float)i + hood->offset) / AREA_PROBES;
        vec3 q = hood->p + hood->radius * sqrtf(r2) * direction_at(hood, a);
        float height = neighbourhood_sees(hood, q) ? surface_height(hood, q) : 1.0f;
        whole += kernel_eval(k, r2, 1.0f);
        if (height < 1.0f)
            found += kernel_eval(k, maxf(r2, height * height), 1.0f);
    }
    return maxf(found / whole, LEAST_COVERAGE);
}
