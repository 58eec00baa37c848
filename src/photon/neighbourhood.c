#include "photon/neighbourhood.h"

#include "math/sampler.h"

#include <string.h>

enum {
    RIM_PROBES = 6,
    AREA_PROBES = 24,
};

/* How far probes are lifted off the surface, and where the rim is probed, over the
 * radius. */
#define LIFT 0.06f
#define RIM 0.9f

/* A surface that is met near the rim under a greater angle is a wall (cosine). */
#define LEAST_SAME_NORMAL 0.8f

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
    return p + hood->n * (LIFT * hood->radius);
}

/* How far the surface of the disc lies off the point q of its plane, over what is
 * allowed; 1 or more: there is none. */
static float surface_height(const neighbourhood *hood, vec3 q)
{
    float slab = NEIGHBOURHOOD_FLATTEN * hood->radius, height = LIFT * hood->radius;
    ray down = {lifted(hood, q), -hood->n, height + slab, hood->time, {{NULL}}};
    surface_hit hit;
    return scene_intersect(hood->scene, &down, &hit) ? fabsf(hit.t - height) / slab
                                                     : 1.0f;
}

/* True if what a ray from the lifted centre meets near the rim, in direction d, is the
 * disc's own surface: in its plane, and no wall across the way. */
static bool rim_is_surface(const neighbourhood *hood, vec3 d)
{
    float height = LIFT * hood->radius, rim = RIM * hood->radius;
    float slope = 1.0f / sqrtf(rim * rim + height * height);
    vec3 across = (d * rim - hood->n * height) * slope;
    float down = height * slope; /* per metre of the way */
    float slab = NEIGHBOURHOOD_FLATTEN * hood->radius;
    ray r = {.origin = lifted(hood, hood->p),
             .time = hood->time,
             .direction = across,
             .t_max = (height + slab) / down};
    surface_hit hit;
    return scene_intersect(hood->scene, &r, &hit) && hit.t * down > height - slab &&
           fabsf(dot3(hit.n_geom, hood->n)) > LEAST_SAME_NORMAL;
}

bool neighbourhood_is_whole(neighbourhood *hood)
{
    const turn sixth = {0.5f, 0.86602540f};
    turn a = {1.0f, 0.0f};
    turn_frame(hood);
    for (int i = 0; i < RIM_PROBES; i++, a = turn_further(a, sixth)) {
        if (!rim_is_surface(hood, direction_at(hood, a)))
            return false;
    }
    return true;
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
