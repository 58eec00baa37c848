#include "photon/neighbourhood.h"

#include "math/sampler.h"
#include "photon/photon_query.h"
#include "scene/advance.h"

#include <string.h>

/* How often the disc is looked at for what of it is surface: as many rays as go to Embree
   together. */
enum { AREA_LOOKS = RAY_PACKET };

/* math: even where no look finds any, the centre itself is surface. */
#define LEAST_COVERAGE (0.5f / AREA_LOOKS)

/* How much denser they lie where the kernel is high: from 0, even in area, to 1, as dense
   as Epanechnikov's is high. With 0 the squared error of bench/edges is 1.8 and 1.15
   times as much, at the widest radius and at half of it (indirect light, as many
   samples); with 24 that are even 1.09 and 1.01. */
#define CLOSENESS 0.75f

/* Two numbers in [0, 1) of its own for every place, so that looks make no pattern in the
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

/* Height up to which a surface counts as the disc's, and from which it is looked at: what
   stands closer above, as the foot of a glass on a table, hides nothing. */
static float slab(const neighbourhood *hood)
{
    return NEIGHBOURHOOD_FLATTEN * hood->radius;
}

static vec3 lifted(const neighbourhood *hood, vec3 p)
{
    return p + hood->n * slab(hood);
}

/* Turned as the disc is, as photons are told apart. */
static bool lies_along(const neighbourhood *hood, const surface_hit *hit)
{
    float cosine = dot3(hit->n_geom, hood->n);
    return cosine * cosine > SAME_SURFACE;
}

/* Mirrors and clear glass keep none. */
static bool keeps_photons(const neighbourhood *hood, const surface_hit *hit)
{
    return scene_possible_lobes(hood->scene, hit) & (LOBE_DIFFUSE | LOBE_GLOSSY);
}

static bool is_clear(const neighbourhood *hood, const surface_hit *hit)
{
    return !keeps_photons(hood, hit) &&
           (scene_possible_lobes(hood->scene, hit) & LOBE_TRANSMISSION);
}

/* True if what a ray met may be the disc's own surface. */
static bool is_alike(const neighbourhood *hood, const surface_hit *hit)
{
    return lies_along(hood, hit) && keeps_photons(hood, hit);
}

/* Clear glass that lies along the disc, a pane in a wall or the foot of a glass, is
   looked through. */
static bool look_behind(neighbourhood *hood, const ray *r, surface_hit *hit)
{
    for (int i = 0; i < MOST_CROSSINGS && hit->shape != NO_INDEX; i++) {
        if (!lies_along(hood, hit) || !is_clear(hood, hit))
            break;
        hood->n_looks++;
        scene_meet_behind(hood->scene, r, hit);
    }
    return hit->shape != NO_INDEX;
}

static bool look(neighbourhood *hood, const ray *r, surface_hit *hit)
{
    hood->n_looks++;
    return scene_meet_surface(hood->scene, r, hit) && look_behind(hood, r, hit);
}

/* hits[i].shape is NO_INDEX where nothing was met. */
static void look_together(neighbourhood *hood, const ray *rays, int n, surface_hit *hits)
{
    hood->n_looks += (uint32_t)n;
    for (int i = 0; i < n; i += RAY_PACKET)
        scene_meet_surfaces(hood->scene, rays + i, MIN(n - i, RAY_PACKET), hits + i);
}

/* From above a point q of the plane through all that counts as surface. */
static ray down_to(const neighbourhood *hood, vec3 q)
{
    return (ray){.origin = lifted(hood, q),
                 .direction = -hood->n,
                 .t_max = 2.0f * slab(hood),
                 .time = hood->time};
}

/* How far the surface that such a ray met lies off the plane, over what is allowed; 1 or
   more: there is none. */
static float surface_height(neighbourhood *hood, const ray *r, surface_hit *hit)
{
    bool found = look_behind(hood, r, hit) && is_alike(hood, hit);
    return found ? fabsf(hit->t / slab(hood) - 1.0f) : 1.0f;
}

/* From the lifted centre through the rim, until it is as far below the plane as a surface
   may be. */
static ray along_surface(const neighbourhood *hood, vec3 d)
{
    vec3 to = d * hood->radius - hood->n * slab(hood);
    float length = length3(to);
    return (ray){.origin = lifted(hood, hood->p),
                 .time = hood->time,
                 .direction = to / length,
                 .t_max = 2.0f * length};
}

/* From above the rim down to what bends away. */
static ray below_rim(const neighbourhood *hood, vec3 d)
{
    return (ray){.origin = lifted(hood, hood->p + d * hood->radius),
                 .time = hood->time,
                 .direction = -hood->n,
                 .t_max = hood->radius + slab(hood)};
}

/* True if what a ray met is joined to the centre by a line or an arc: then both normals
   make the same angle with the chord. */
static bool is_joined(const neighbourhood *hood, const ray *r, const surface_hit *hit)
{
    vec3 n = face_forward(hit->n_geom, -r->direction);
    float off = dot3(hit->p - hood->p, n + hood->n);
    return dot3(n, hood->n) > 0.0f && is_alike(hood, hit) &&
           fabsf(off) < 2.0f * slab(hood);
}

/* True if what a ray from the lifted centre meets near the rim, in direction d, is the
 * disc's own surface, flat or evenly bent. */
static bool rim_is_surface(neighbourhood *hood, vec3 d)
{
    surface_hit hit;
    ray along = along_surface(hood, d);
    if (look(hood, &along, &hit)) {
        bool joined = is_joined(hood, &along, &hit);
        if (joined || hit.t < hood->radius)
            return joined;
    }
    ray down = below_rim(hood, d);
    return look(hood, &down, &hit) && is_joined(hood, &down, &hit);
}

/* One after the other: all eight rays together take longer than those that it needs. */
static bool whole_rim(neighbourhood *hood)
{
    vec3 s = hood->frame.s, t = hood->frame.t;
    return rim_is_surface(hood, s) && rim_is_surface(hood, t) &&
           rim_is_surface(hood, -s) && rim_is_surface(hood, -t);
}

bool neighbourhood_is_whole(neighbourhood *hood)
{
    turn_frame(hood);
    return whole_rim(hood);
}

/* A straight wall between two corners is the side between them: nothing behind it is
 * seen. */
static void find_horizon(neighbourhood *hood)
{
    const float half = PI_F / NEIGHBOURHOOD_SECTORS; /* of a sector */
    const turn sector = turn_by(2.0f * half);
    /* Sides between open corners clear the disc, and those that share it. */
    float reach = (1.0f + SHARED_REACH) * hood->radius / cosf(half);
    turn a[NEIGHBOURHOOD_SECTORS] = {{1.0f, 0.0f}};
    ray along[NEIGHBOURHOOD_SECTORS];
    surface_hit hit[NEIGHBOURHOOD_SECTORS];
    vec2 corner[NEIGHBOURHOOD_SECTORS];
    for (int i = 0; i < NEIGHBOURHOOD_SECTORS; i++) {
        if (i > 0)
            a[i] = turn_further(a[i - 1], sector);
        along[i] = (ray){.origin = lifted(hood, hood->p),
                         .time = hood->time,
                         .direction = direction_at(hood, a[i]),
                         .t_max = reach};
    }
    look_together(hood, along, NEIGHBOURHOOD_SECTORS, hit);
    for (int i = 0; i < NEIGHBOURHOOD_SECTORS; i++) {
        float free = hit[i].shape != NO_INDEX ? hit[i].t : reach;
        corner[i] = (vec2){free * a[i].c, free * a[i].s};
    }
    for (int i = 0; i < NEIGHBOURHOOD_SECTORS; i++) {
        vec2 p = corner[i], q = corner[(i + 1) % NEIGHBOURHOOD_SECTORS];
        hood->horizon.nx[i] = p.y - q.y;
        hood->horizon.ny[i] = q.x - p.x;
        hood->horizon.c[i] = p.y * q.x - p.x * q.y;
    }
}

/* Where they lie, of a disc of radius 1: so dense at t = d² as 1 + m (1 - 2 t). */
typedef struct look_spread {
    float m;
} look_spread;

/* As the kernel falls, they lie denser inside. */
static look_spread spread_for(const kernel *k)
{
    float inner = kernel_eval(k, 0.0f, 1.0f), outer = kernel_eval(k, 1.0f, 1.0f);
    return (look_spread){CLOSENESS * (inner - outer) / (inner + outer)};
}

/* d² within which a share of the places lies. */
static float spread_within(look_spread spread, float share)
{
    float half = 0.5f * (1.0f + spread.m);
    return share / (half + sqrtf(half * half - spread.m * share));
}

static float spread_density(look_spread spread, float d2)
{
    return 1.0f + spread.m * (1.0f - 2.0f * d2);
}

/* Places on a sunflower spiral. The kernel weighs them as it does photons: what bends off
   the plane counts as further away (photon_filter). */
float neighbourhood_coverage(neighbourhood *hood, const kernel *k)
{
    const turn golden = turn_by(PI_F * (3.0f - sqrtf(5.0f))); /* math: its angle */
    const look_spread spread = spread_for(k);
    turn a = {1.0f, 0.0f};
    float whole = 0.0f, found = 0.0f, d2[AREA_LOOKS];
    ray down[AREA_LOOKS];
    surface_hit hit[AREA_LOOKS];
    int n = 0;
    find_horizon(hood);
    for (int i = 0; i < AREA_LOOKS; i++, a = turn_further(a, golden)) {
        d2[n] = spread_within(spread, ((float)i + hood->offset) / AREA_LOOKS);
        vec3 q = hood->p + hood->radius * sqrtf(d2[n]) * direction_at(hood, a);
        whole += kernel_eval(k, d2[n], 1.0f) / spread_density(spread, d2[n]);
        if (neighbourhood_sees(hood, q))
            down[n++] = down_to(hood, q);
    }
    look_together(hood, down, n, hit);
    for (int i = 0; i < n; i++) {
        float height = surface_height(hood, &down[i], &hit[i]);
        if (height < 1.0f)
            found += kernel_eval(k, maxf(d2[i], height * height), 1.0f) /
                     spread_density(spread, d2[i]);
    }
    return maxf(found / whole, LEAST_COVERAGE);
}
