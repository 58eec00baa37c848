#include "photon/neighbourhood.h"

#include "math/sampler.h"

#include <string.h>

enum {
    RIM_PROBES = 6,
    AREA_PROBES = 32,
};

/* How far probes are lifted off the surface, and where the rim is probed, over the
 * radius. */
#define LIFT 0.06f
#define RIM 0.9f

/* A sight line ends this short of its end, over its length: the end lies on a surface. */
#define SHORTENING 0.02f

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

static bool is_clear(const neighbourhood *hood, vec3 from, vec3 to)
{
    vec3 way = to - from;
    float length = length3(way);
    if (!(length > 0.0f))
        return true;
    ray r = {from, way / length, length * (1.0f - SHORTENING), 0.0f};
    return !scene_occluded(hood->scene, &r);
}

bool neighbourhood_sees(const neighbourhood *hood, vec3 q)
{
    vec3 lift = hood->n * (LIFT * hood->radius);
    return is_clear(hood, hood->p + lift, q + lift);
}

/* True if the surface goes on to q, a point of the disc's plane. */
static bool reaches(const neighbourhood *hood, vec3 q)
{
    if (!neighbourhood_sees(hood, q))
        return false;
    float slab = NEIGHBOURHOOD_FLATTEN * hood->radius, height = LIFT * hood->radius;
    ray down = {q + hood->n * height, -hood->n, height + slab, 0.0f};
    surface_hit hit;
    return scene_intersect(hood->scene, &down, &hit) && hit.t > height - slab;
}

static vec3 disc_point(const neighbourhood *hood, const frame *f, float r, float angle)
{
    return hood->p + hood->radius * r * (f->s * cosf(angle) + f->t * sinf(angle));
}

bool neighbourhood_is_whole(const neighbourhood *hood)
{
    frame f = frame_from_normal(hood->n);
    float first = angle_at(hood->p);
    for (int i = 0; i < RIM_PROBES; i++) {
        float angle = first + (2.0f * PI_F / RIM_PROBES) * (float)i;
        if (!reaches(hood, disc_point(hood, &f, RIM, angle)))
            return false;
    }
    return true;
}

/* Probes on a sunflower spiral are even in area; the kernel weighs them. */
float neighbourhood_coverage(const neighbourhood *hood, const kernel *k)
{
    const float golden_angle = 2.39996323f;
    frame f = frame_from_normal(hood->n);
    float first = angle_at(hood->p), whole = 0.0f, found = 0.0f;
    for (int i = 0; i < AREA_PROBES; i++) {
        float r2 = ((float)i + 0.5f) / AREA_PROBES;
        float weight = kernel_eval(k, r2, 1.0f);
        whole += weight;
        if (reaches(hood,
                    disc_point(hood, &f, sqrtf(r2), first + golden_angle * (float)i)))
            found += weight;
    }
    return maxf(found / whole, LEAST_COVERAGE);
}
