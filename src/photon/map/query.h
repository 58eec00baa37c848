/*
 * The query: what each photon is tested with, prepared once a search. The scalar form
 * is what "found" means; the form for a lane each gives the same bits.
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

typedef struct point_query {
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
} point_query;

static inline point_query point_query_of(const photon_store *store, vec3 p,
                                         const photon_filter *filter)
{
    point_query query = {.store = store, .p = p};
    query.x = store->x;
    query.y = store->y;
    query.z = store->z;
    query.wi = store->wi;
    if (filter) {
        bool on_curve = filter->curve != 0;
        query.normal = on_curve ? NULL : store->normal;
        query.curve = store->home;
        query.on_curve = filter->curve;
        query.n = filter->n;
        query.one_sided = filter->one_sided;
        query.face = on_curve ? 0 : filter->face;
        query.flat = !on_curve && filter->flatten < 1.0f;
        query.inv_flatten = 1.0f / maxf(filter->flatten, 1e-3f);
    }
    return query;
}

/** @brief Squared distance to photon i. */
static inline float query_distance2(const point_query *query, size_t i)
{
    const photon_store *s = query->store;
    float x = s->x[i] - query->p[0], y = s->y[i] - query->p[1], z = s->z[i] - query->p[2];
    float d2 = fused(z, z, fused(y, y, x * x));
    if (!query->flat)
        return d2;
    float dot = fused(z, query->n[2], fused(y, query->n[1], x * query->n[0]));
    float height = dot * query->inv_flatten;
    float height2 = height * height;
    return height2 > d2 ? height2 : d2;
}

/** @brief Squared sine of the elevation over the plane within which any face is the same.
 */
#define SAME_PLANE 1e-5f

/** @brief True if photon i lies on the query's face, or in its plane. */
static inline bool query_is_face(const point_query *query, size_t i)
{
    const photon_store *s = query->store;
    bool above = direction_dot(query->wi[i], query->n) > 0.0f;
    bool behind = direction_flags(query->wi[i]) & PHOTON_BEHIND;
    if (above == (behind == (query->face < 0)))
        return true;
    float x = s->x[i] - query->p[0], y = s->y[i] - query->p[1], z = s->z[i] - query->p[2];
    float dot = fused(z, query->n[2], fused(y, query->n[1], x * query->n[0]));
    return dot * dot <= SAME_PLANE * fused(z, z, fused(y, y, x * x));
}

/** @brief Squared cosine of the angle from which on surfaces are not the same. */
#define SAME_SURFACE 0.25f

/** @brief True if the surface of photon i is not turned away from the query's. */
static inline bool query_is_alike(const point_query *query, size_t i)
{
    vec3 o = direction_octahedron(query->normal[i]);
    float dot = direction_dot(query->normal[i], query->n);
    return dot * dot > SAME_SURFACE * fused(o[2], o[2], fused(o[1], o[1], o[0] * o[0]));
}

static inline bool query_accepts(const point_query *query, size_t i)
{
    if (query->curve && query->curve[i] != query->on_curve)
        return false;
    if (query->normal && !query_is_alike(query, i))
        return false;
    if (query->face && !query_is_face(query, i))
        return false;
    return !query->one_sided || direction_dot(query->wi[i], query->n) > 0.0f;
}

/** @brief query_distance2 of photons i .. i + LANES - 1. */
static inline lane_floats query_distance2_lanes(const point_query *query, size_t i)
{
    lane_floats x = load_lanes(query->x + i) - query->p[0],
                y = load_lanes(query->y + i) - query->p[1],
                z = load_lanes(query->z + i) - query->p[2];
    lane_floats d2 = fused_lanes(z, z, fused_lanes(y, y, x * x));
    if (!query->flat)
        return d2;
    lane_floats nx = fill_lanes(query->n[0]), ny = fill_lanes(query->n[1]),
                nz = fill_lanes(query->n[2]);
    lane_floats height =
        fused_lanes(z, nz, fused_lanes(y, ny, x * nx)) * query->inv_flatten;
    return max_lanes(height * height, d2);
}

/** @brief Bits of packed directions on the side of n. */
static inline unsigned query_sides(const point_query *query, lane_ints wi)
{
    lane_directions d = lane_directions_of(wi);
    return bits_below(fill_lanes(0.0f), lane_directions_dot(d, query->n));
}

/** @brief query_is_alike by packed normals. */
static inline unsigned query_alike(const point_query *query, lane_ints normal)
{
    lane_directions n = lane_directions_of(normal);
    lane_floats dot = lane_directions_dot(n, query->n);
    lane_floats length2 = fused_lanes(n.z, n.z, fused_lanes(n.y, n.y, n.x * n.x));
    return bits_below(SAME_SURFACE * length2, dot * dot);
}

/** @brief Bits of those photons of i .. min(i + LANES, end) - 1 that are nearer than
 * limit, accepted or not; *distance2 of all. */
static inline __attribute__((always_inline)) unsigned
query_nearer(const point_query *query, size_t i, size_t end, float limit,
             lane_floats *distance2)
{
    *distance2 = query_distance2_lanes(query, i);
    return bits_below(*distance2, fill_lanes(limit)) & bits_first(end - i);
}

/** @brief True if some photons are not accepted. */
static inline bool query_selects(const point_query *query)
{
    return query->one_sided || query->normal || query->curve || query->face;
}

/** @brief Of those photons in bits, the bits of those that are accepted; the photon of a
 * lane is index[lane], also where its bit is not set. */
static inline __attribute__((always_inline)) unsigned
query_accepted(const point_query *query, const uint32_t *index, unsigned bits)
{
    if (query->one_sided)
        bits &= query_sides(query, gather_lanes(query->wi, index));
    if (query->normal)
        bits &= query_alike(query, gather_lanes(query->normal, index));
    for (unsigned left = query->curve || query->face ? bits : 0u; left;
         left &= left - 1u) {
        int lane = __builtin_ctz(left);
        bool alike = !query->curve || query->curve[index[lane]] == query->on_curve;
        if (!alike || (query->face && !query_is_face(query, index[lane])))
            bits &= ~(1u << lane);
    }
    return bits;
}

/** @brief query_nearer that are accepted. */
static inline unsigned query_block(const point_query *query, size_t i, size_t end,
                                   float limit, lane_floats *distance2)
{
    unsigned bits = query_nearer(query, i, end, limit, distance2);
    if (bits && query->one_sided)
        bits &= query_sides(query, load_lane_ints(query->wi + i));
    if (bits && query->normal)
        bits &= query_alike(query, load_lane_ints(query->normal + i));
    for (unsigned left = query->curve || query->face ? bits : 0u; left;
         left &= left - 1u) {
        size_t lane = (size_t)__builtin_ctz(left);
        bool alike = !query->curve || query->curve[i + lane] == query->on_curve;
        if (!alike || (query->face && !query_is_face(query, i + lane)))
            bits &= ~(1u << lane);
    }
    return bits;
}
