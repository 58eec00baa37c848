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

static vec3 direction_at(const neighbourhood *hood, float angle)
{
    return hood->frame.s * cosf(angle) + hood->frame.t * sinf(angle);
}

static void turn_frame(neighbourhood *hood)
{
    hood->frame = frame_from_normal(hood->n);
    vec3 s = direction_at(hood, angle_at(hood->p));
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

bool neighbourhood_is_whole(neighbourhood *hood)
{
    turn_frame(hood);
    for (int i = 0; i < RIM_PROBES; i++) {
        vec3 d = direction_at(hood, (2.0f * PI_F / RIM_PROBES) * (float)i);
        float rim = RIM * hood->radius;
        ray along = {lifted(hood, hood->p), d, rim, 0.0f, NULL};
        if (scene_occluded(hood->scene, &along) || !is_surface(hood, hood->p + rim * d))
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
    float reach = OPEN_HORIZON * hood->radius;
    for (int i = 0; i < NEIGHBOURHOOD_SECTORS; i++) {
        float angle = (2.0f * PI_F / NEIGHBOURHOOD_SECTORS) * (float)i;
        ray along = {lifted(hood, hood->p), direction_at(hood, angle), reach, 0.0f, NULL};
        surface_hit hit;
        float way = scene_intersect(hood->scene, &along, &hit) ? hit.t : reach;
        hood->horizon[i] = (vec2){way * cosf(angle), way * sinf(angle)};
    }
    hood->horizon[NEIGHBOURHOOD_SECTORS] = hood->horizon[0];
}

bool neighbourhood_sees(const neighbourhood *hood, vec3 q)
{
    vec3 d = q - hood->p;
    float x = dot3(d, hood->frame.s), y = dot3(d, hood->frame.t);
    float turn = atan2f(y, x) * (0.5f * INV_PI_F);
    int i = (int)((turn < 0.0f ? turn + 1.0f : turn) * NEIGHBOURHOOD_SECTORS);
    i = i < NEIGHBOURHOOD_SECTORS ? i : NEIGHBOURHOOD_SECTORS - 1;
    vec2 a = hood->horizon[i], b = hood->horizon[i + 1];
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x) > 0.0f;
}

/* Probes on a sunflower spiral are even in area; the kernel weighs them. */
float neighbourhood_coverage(neighbourhood *hood, const kernel *k)
{
    const float golden_angle = 2.39996323f;
    float whole = 0.0f, found = 0.0f;
    probe_horizon(hood);
    for (int i = 0; i < AREA_PROBES; i++) {
        float r2 = ((float)i + 0.5f) / AREA_PROBES;
        float weight = kernel_eval(k, r2, 1.0f);
        vec3 d = direction_at(hood, golden_angle * (float)i);
        vec3 q = hood->p + hood->radius * sqrtf(r2) * d;
        whole += weight;
        if (neighbourhood_sees(hood, q) && is_surface(hood, q))
            found += weight;
    }
    return maxf(found / whole, LEAST_COVERAGE);
}
