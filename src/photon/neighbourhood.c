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

/* An angle of its own for every place, so that probes make no pattern in the picture. */
static float angle_at(vec3 p)
{
    uint32_t bits[3];
    for (int i = 0; i < 3; i++)
        memcpy(&bits[i], (float[]){p[i]}, sizeof bits[i]);
    uint64_t h = hash_mix(hash_mix(bits[0], bits[1]), bits[2]);
    return 2.0f * PI_F * (float)(h >> 40) * 0x1p-24f;
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
    vec3 s = direction_at(hood, turn_by(angle_at(hood->p)));
    hood->frame = (frame){s, cross3(hood->n, s), hood->n};
}

static vec3 lifted(const neighbourhood *hood, vec3 p)
{
    return p + hood->n * (LIFT * hood->radius);
}

/* True if there is surface of the disc under or at the point q of its plane. */
static bool is_surface(const neighbourhood *hood, vec3 q)
{
    float slab = NEIGHBOURHOOD_FLATTEN * hood->radius, height = LIFT * hood->radius;
    ray down = {lifted(hood, q), -hood->n, height + slab, 0.0f, NULL};
    surface_hit hit;
    return scene_intersect(hood->scene, &down, &hit) && hit.t > height - slab;
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

/* Probes on a sunflower spiral are even in area; the kernel weighs them. */
float neighbourhood_coverage(neighbourhood *hood, const kernel *k)
{
    const turn golden = {-0.73736888f, 0.67549029f}; /* the golden angle */
    turn a = {1.0f, 0.0f};
    float whole = 0.0f, found = 0.0f;
    probe_horizon(hood);
    for (int i = 0; i < AREA_PROBES; i++, a = turn_further(a, golden)) {
        float r2 = ((float)i + 0.5f) / AREA_PROBES;
        float weight = kernel_eval(k, r2, 1.0f);
        vec3 d = direction_at(hood, a);
        vec3 q = hood->p + hood->radius * sqrtf(r2) * d;
        whole += weight;
        if (neighbourhood_sees(hood, q) && is_surface(hood, q))
            found += weight;
    }
    return maxf(found / whole, LEAST_COVERAGE);
}
