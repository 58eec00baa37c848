/*
 * The probe: what a query tests each photon with, prepared once a query. The scalar form
 * is what "found" means; the form for eight gives the same bits.
 *
 *   distance2   (dx² + dy²) + dz², or (d·n / flatten)² where that is larger
 *   accepted    where photons keep curves: it is on the same one, or on none
 *               where photons keep normals: the photon's surface is not turned by more
 *               than 60 degrees, so that walls at a corner are told apart
 *               one-sided: the photon's direction lies on the side of n
 *               of one face: its direction and its flag say that its own surface lies
 *               alike, or it lies in the plane, |d·n|² < 1e-5 |d|² (so that triangles of
 *               a sheet may be wound as they like)
 *
 * Rounding is monotone at each step, so |dx| < r holds in floats for every photon within
 * r: a structure that looks at all x in [p - r, p + r] misses none.
 */
#pragma once

#include "photon/direction.h"
#include "photon/map/map.h"

typedef struct photon_probe {
    const photon_store *store; /* NULL: of points that are no photons (point_index.h) */
    const size_t *number;      /* of those, their owner's */
    const float *x, *y, *z;    /* of the store or the points */
    const uint32_t *wi; /* what one_sided and face look at: of points their normals */
    const uint32_t *normal, *curve; /* NULL if they keep none */
    vec3 p;
    vec3 n;
    bool one_sided, flat;
    int face;
    uint32_t on_curve;
    float inv_flatten;
} photon_probe;

static inline photon_probe photon_probe_make(const photon_store *store, vec3 p,
                                             const photon_filter *filter)
{
    photon_probe probe = {.store = store, .p = p};
    probe.x = store->x;
    probe.y = store->y;
    probe.z = store->z;
    probe.wi = store->wi;
    if (filter) {
        bool on_curve = filter->curve != 0;
        probe.normal = on_curve ? NULL : store->normal;
        probe.curve = store->home;
        probe.on_curve = filter->curve;
        probe.n = filter->n;
        probe.one_sided = filter->one_sided;
        probe.face = on_curve ? 0 : filter->face;
        probe.flat = !on_curve && filter->flatten < 1.0f;
        probe.inv_flatten = 1.0f / fmaxf(filter->flatten, 1e-3f);
    }
    return probe;
}

/** @brief Squared distance to photon i. */
static inline float probe_distance2(const photon_probe *probe, size_t i)
{
    const photon_store *s = probe->store;
    float x = s->x[i] - probe->p[0], y = s->y[i] - probe->p[1], z = s->z[i] - probe->p[2];
    float d2 = fused(z, z, fused(y, y, x * x));
    if (!probe->flat)
        return d2;
    float dot = fused(z, probe->n[2], fused(y, probe->n[1], x * probe->n[0]));
    float height = dot * probe->inv_flatten;
    float height2 = height * height;
    return height2 > d2 ? height2 : d2;
}

/** @brief Squared sine of the elevation over the plane within which any face is the same.
 */
#define SAME_PLANE 1e-5f

/** @brief True if photon i lies on the probe's face, or in its plane. */
static inline bool probe_is_face(const photon_probe *probe, size_t i)
{
    const photon_store *s = probe->store;
    bool above = direction_dot(probe->wi[i], probe->n) > 0.0f;
    bool behind = direction_flags(probe->wi[i]) & PHOTON_BEHIND;
    if (above == (behind == (probe->face < 0)))
        return true;
    float x = s->x[i] - probe->p[0], y = s->y[i] - probe->p[1], z = s->z[i] - probe->p[2];
    float dot = fused(z, probe->n[2], fused(y, probe->n[1], x * probe->n[0]));
    return dot * dot <= SAME_PLANE * fused(z, z, fused(y, y, x * x));
}

/** @brief Squared cosine of the angle from which on surfaces are not the same. */
#define SAME_SURFACE 0.25f

/** @brief True if the surface of photon i is not turned away from the probe's. */
static inline bool probe_is_alike(const photon_probe *probe, size_t i)
{
    vec3 o = direction_octahedron(probe->normal[i]);
    float dot = direction_dot(probe->normal[i], probe->n);
    return dot * dot > SAME_SURFACE * fused(o[2], o[2], fused(o[1], o[1], o[0] * o[0]));
}

static inline bool probe_accepts(const photon_probe *probe, size_t i)
{
    if (probe->curve && probe->curve[i] != probe->on_curve)
        return false;
    if (probe->normal && !probe_is_alike(probe, i))
        return false;
    if (probe->face && !probe_is_face(probe, i))
        return false;
    return !probe->one_sided || direction_dot(probe->wi[i], probe->n) > 0.0f;
}

/** @brief probe_distance2 of photons i .. i + 7. */
static inline floats8 probe_distance2_8(const photon_probe *probe, size_t i)
{
    floats8 x = load8(probe->x + i) - probe->p[0], y = load8(probe->y + i) - probe->p[1],
            z = load8(probe->z + i) - probe->p[2];
    floats8 d2 = fused8(z, z, fused8(y, y, x * x));
    if (!probe->flat)
        return d2;
    floats8 nx = fill8(probe->n[0]), ny = fill8(probe->n[1]), nz = fill8(probe->n[2]);
    floats8 height = fused8(z, nz, fused8(y, ny, x * nx)) * probe->inv_flatten;
    return max8(height * height, d2);
}

/** @brief Bits of those photons of i .. min(i + 8, end) - 1 that are accepted and nearer
 * than limit; *distance2 of all. */
static inline unsigned probe_block(const photon_probe *probe, size_t i, size_t end,
                                   float limit, floats8 *distance2)
{
    *distance2 = probe_distance2_8(probe, i);
    unsigned bits = bits8(*distance2 < limit);
    if (end - i < LANES)
        bits &= (1u << (end - i)) - 1u;
    if (bits && probe->one_sided) {
        directions8 wi = directions8_load(probe->wi + i);
        bits &= bits8(directions8_dot(wi, probe->n) > 0.0f);
    }
    if (bits && probe->normal) {
        directions8 n = directions8_load(probe->normal + i);
        floats8 dot = directions8_dot(n, probe->n);
        floats8 length2 = fused8(n.z, n.z, fused8(n.y, n.y, n.x * n.x));
        bits &= bits8(dot * dot > SAME_SURFACE * length2);
    }
    for (unsigned left = probe->curve || probe->face ? bits : 0u; left;
         left &= left - 1u) {
        size_t lane = (size_t)__builtin_ctz(left);
        bool alike = !probe->curve || probe->curve[i + lane] == probe->on_curve;
        if (!alike || (probe->face && !probe_is_face(probe, i + lane)))
            bits &= ~(1u << lane);
    }
    return bits;
}
