/*
 * The photon query: what each photon is tested with, prepared once a search. Distance is
 * the index's (map/query.h); here is which photons count. The scalar form is what
 * "accepted" means; the form for a lane each gives the same bits.
 *
 *   accepted    where photons keep curves: it is on the same one, or on none
 *               where photons keep normals: the photon's surface is not turned by more
 *               than 60 degrees, so that walls at a corner are told apart; one-sided,
 *               not upside down either, as the other side of a thin wall is
 *               one-sided: the photon's direction lies on the side of n
 *               of one face: its direction and its flag say that its own surface lies
 *               alike, or it lies in the plane, |d·n|² < 1e-5 |d|² (so that triangles of
 *               a sheet may be wound as they like)
 *
 * Without the normals /neighbourhood/bright-wall fails, a wall lights the floor at its
 * foot; without the faces /verify/agree/thin-pane does, vcm shows 3 % too much; without
 * the plane /map/sheet does, where triangles of a leaf are wound each its own way.
 */
#pragma once

#include "photon/direction.h"
#include "photon/photon_map.h"

typedef struct photon_query {
    point_query at; /* without rules: see photon_rules_of */
    const photon_store *store;
    point_arrays points;            /* the store's */
    const uint32_t *wi;             /* what one_sided and face look at */
    const uint32_t *normal, *curve; /* NULL if they keep none, or none are asked for */
    bool one_sided;
    int face;
    uint32_t on_curve;
} photon_query;

static inline photon_query photon_query_of(const photon_store *store, vec3 p,
                                           const photon_filter *filter)
{
    photon_query query = {.at.p = p, .store = store, .wi = store->wi};
    query.points = photon_points(store);
    if (filter) {
        bool on_curve = filter->curve != 0;
        query.normal = on_curve ? NULL : store->normal;
        query.curve = store->home;
        query.on_curve = filter->curve;
        query.one_sided = filter->one_sided;
        query.face = on_curve ? 0 : filter->face;
        query.at.n = filter->n;
        query.at.flat = !on_curve && filter->flatten < 1.0f;
        query.at.inv_flatten = 1.0f / filter->flatten;
    }
    return query;
}

/** @brief Squared sine of the elevation over the plane up to which rounding may lift a
 * photon that lies in it: there any face is the same. */
#define SAME_PLANE 1e-5f

/** @brief True if photon i lies on the query's face, or in its plane. */
static inline bool photon_is_of_face(const photon_query *query, size_t i)
{
    const point_arrays *at = &query->points;
    vec3 n = query->at.n, p = query->at.p;
    bool above = direction_dot(query->wi[i], n) > 0.0f;
    bool behind = direction_flags(query->wi[i]) & PHOTON_BEHIND;
    if (above == (behind == (query->face < 0)))
        return true;
    float x = at->x[i] - p[0], y = at->y[i] - p[1], z = at->z[i] - p[2];
    float dot = fused(z, n[2], fused(y, n[1], x * n[0]));
    return dot * dot <= SAME_PLANE * fused(z, z, fused(y, y, x * x));
}

/** @brief Squared cosine of the angle from which on surfaces are not the same. In
 * bench/edges relMSE with twice as much is 1.15 and 1.3 times as much at the widest
 * radius, of indirect and of all light, alike at the other three and with a quarter. */
#define SAME_SURFACE 0.25f

/** @brief True if the surface of photon i is not turned away from the query's, nor, on
 * one side, is it the other side of something thin. */
static inline bool photon_is_alike(const photon_query *query, size_t i)
{
    vec3 o = direction_octahedron(query->normal[i]);
    float dot = direction_dot(query->normal[i], query->at.n);
    float side = query->one_sided ? dot : fabsf(dot);
    return side * fabsf(dot) > SAME_SURFACE * fused_dot3(o, o);
}

/** @brief True if some photons are not accepted. */
static inline bool photon_query_selects(const photon_query *query)
{
    return query->one_sided || query->normal || query->curve || query->face;
}

static inline bool photon_query_accepts(const photon_query *query, size_t i)
{
    if (query->curve && query->curve[i] != query->on_curve)
        return false;
    if (query->normal && !photon_is_alike(query, i))
        return false;
    if (query->face && !photon_is_of_face(query, i))
        return false;
    return !query->one_sided || direction_dot(query->wi[i], query->at.n) > 0.0f;
}

/** @brief photon_is_alike by packed normals. */
static inline unsigned photons_alike(const photon_query *query, lane_ints normal)
{
    lane_vec3 n = lane_directions_of(normal);
    lane_floats dot = dot3_lanes(n, query->at.n), size = abs_lanes(dot);
    lane_floats length2 = fused_lanes(n.z, n.z, fused_lanes(n.y, n.y, n.x * n.x));
    return bits_below(SAME_SURFACE * length2, (query->one_sided ? dot : size) * size);
}

/** @brief True if photon i passes what is looked at one by one. */
static inline bool photon_is_at_home(const photon_query *query, size_t i)
{
    return (!query->curve || query->curve[i] == query->on_curve) &&
           (!query->face || photon_is_of_face(query, i));
}

/** @brief Of those photons in bits, the bits of those that are accepted; the photon of a
 * lane is index[lane], also where its bit is not set. */
static inline __attribute__((always_inline)) unsigned
photon_query_accepted_of(const photon_query *query, const uint32_t *index, unsigned bits)
{
    if (query->one_sided)
        bits &= directions_on_side(gather_lanes(query->wi, index), query->at.n);
    if (query->normal)
        bits &= photons_alike(query, gather_lanes(query->normal, index));
    for (unsigned left = query->curve || query->face ? bits : 0u; left;
         left &= left - 1u) {
        int lane = __builtin_ctz(left);
        if (!photon_is_at_home(query, index[lane]))
            bits &= ~(1u << lane);
    }
    return bits;
}

/** @brief The same of photons first .. first + LANES - 1. */
static inline unsigned photon_query_accepted(const photon_query *query, size_t first,
                                             unsigned bits)
{
    if (query->one_sided)
        bits &= directions_on_side(load_lane_ints(query->wi + first), query->at.n);
    if (bits && query->normal)
        bits &= photons_alike(query, load_lane_ints(query->normal + first));
    for (unsigned left = query->curve || query->face ? bits : 0u; left;
         left &= left - 1u) {
        int lane = __builtin_ctz(left);
        if (!photon_is_at_home(query, first + (size_t)lane))
            bits &= ~(1u << lane);
    }
    return bits;
}

/** @brief What the map's index is asked: the query is to outlive the answer. */
point_query photon_rules_of(const photon_query *query);

/** @brief photon_map_within and photon_map_nearest by a query of the map's store. */
bool photon_map_query_within(const photon_map *map, const photon_query *query,
                             float radius, point_hits *hits);
bool photon_map_query_nearest(const photon_map *map, const photon_query *query, size_t k,
                              float radius, point_hits *hits);
