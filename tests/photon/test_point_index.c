/*
 * point_index: every kind finds what a naive search finds, by the owner's rules, ties and
 * all; what it calls the order is one. point_set: the same, by its owner's numbers.
 */
#include "base/memory.h"
#include "math/sampler.h"
#include "math/warp.h"
#include "photon/direction.h"
#include "photon/map/point_set.h"
#include "photon/photon.h"

#include <stdlib.h>
#include <string.h>

enum { MOST = 3000, QUERIES = 200 };

typedef struct cloud {
    size_t n;
    vec3 points[MOST];
    uint32_t normals[MOST];
} cloud;

/* On a lattice, so that many lie equally far off, some twice; or anywhere. */
static void fill(cloud *c, size_t n, bool lattice)
{
    sampler random = sampler_make(n, lattice);
    c->n = n;
    for (size_t i = 0; i < n; i++) {
        vec2 u = sampler_2d(&random);
        vec3 p = {u.x, u.y, sampler_1d(&random)};
        for (int axis = 0; axis < 3 && lattice; axis++)
            p[axis] = floorf(8.0f * p[axis]) / 8.0f;
        c->points[i] = p;
        c->normals[i] = direction_pack(warp_sphere(sampler_2d(&random)), 0);
    }
}

typedef struct neighbour {
    vec3 p;
    float distance2;
    size_t number;
} neighbour;

static int compare(float a, float b)
{
    return (a > b) - (a < b);
}

static int nearer(const void *a, const void *b)
{
    const neighbour *l = a, *r = b;
    int order = compare(l->distance2, r->distance2);
    for (int axis = 0; axis < 3 && !order; axis++)
        order = compare(l->p[axis], r->p[axis]);
    return order ? order : (l->number > r->number) - (l->number < r->number);
}

/* How one asks: of all sides, or of points that face n; of a ball, or of a disc. */
typedef struct question {
    vec3 p, n;
    bool facing;
    float flatten;
} question;

static float measure(const question *q, vec3 d)
{
    float d2 = fused(d[2], d[2], fused(d[1], d[1], d[0] * d[0]));
    float dot = fused(d[2], q->n[2], fused(d[1], q->n[1], d[0] * q->n[0]));
    float height = dot * (1.0f / q->flatten);
    return q->flatten < 1.0f && height * height > d2 ? height * height : d2;
}

/* The naive search: every point is measured, and all are sorted. */
static size_t search(const cloud *c, const question *q, size_t k, float radius,
                     neighbour *out)
{
    size_t n = 0;
    for (size_t i = 0; i < c->n; i++) {
        float d2 = measure(q, c->points[i] - q->p);
        bool faces = !q->facing || direction_dot(c->normals[i], q->n) > 0.0f;
        if (faces && d2 < radius * radius)
            out[n++] = (neighbour){c->points[i], d2, i};
    }
    qsort(out, n, sizeof *out, nearer);
    return MIN(n, k);
}

/* @param number of places; NULL: hits are numbers */
static void check_found(const cloud *c, const size_t *number, const point_hits *hits,
                        const neighbour *wanted, size_t n)
{
    static neighbour found[MOST];
    g_assert_cmpuint(hits->n, ==, n);
    for (size_t i = 0; i < n; i++) {
        g_assert_cmpuint(hits->index[i], <, c->n);
        size_t k = number ? number[hits->index[i]] : hits->index[i];
        found[i] = (neighbour){c->points[k], hits->distance2[i], k};
    }
    qsort(found, n, sizeof *found, nearer);
    for (size_t i = 0; i < n; i++) {
        g_assert_cmpuint(found[i].number, ==, wanted[i].number);
        g_assert_true(compare(found[i].distance2, wanted[i].distance2) == 0);
    }
}

static vec3 anywhere(sampler *random, const cloud *c, int i)
{
    vec2 u = sampler_2d(random);
    vec3 p = {u.x, u.y, sampler_1d(random)};
    return i % 2 && c->n > 0 ? c->points[(size_t)i % c->n] : p;
}

static const size_t ks[] = {1, 4, 16, 100, MOST + 1};

/* ---- Sets ---- */

static void check_set(const cloud *c, unsigned threads)
{
    static neighbour wanted[MOST];
    g_autoptr(GError) error = NULL;
    g_autoptr(point_set) set = point_set_build(c->points, c->n, threads, &error);
    g_assert_no_error(error);
    sampler random = sampler_make(5, c->n);
    for (size_t i = 0; i < c->n; i++) {
        vec3 off = point_set_position(set, i) - c->points[point_set_number(set, i)];
        g_assert_true(compare(length3_2(off), 0.0f) == 0);
    }
    point_hits hits = {0};
    for (int i = 0; i < QUERIES; i++) {
        const question q = {.p = anywhere(&random, c, i), .flatten = 1.0f};
        float radius = 0.4f * sampler_1d(&random), bound = i % 3 ? INFINITY : radius;
        g_assert_true(point_set_within(set, q.p, radius, &hits));
        check_found(c, NULL, &hits, wanted, search(c, &q, MOST, radius, wanted));
        g_assert_true(point_set_nearest(set, q.p, ks[i % 5], bound, &hits));
        check_found(c, NULL, &hits, wanted, search(c, &q, ks[i % 5], bound, wanted));
    }
    point_hits_clear(&hits);
}

/* ---- Indices ---- */

/* What lies at the points, in the order of an index. */
typedef struct things {
    size_t *number;
    uint32_t *normal;
    vec3 n;
} things;

static bool faces(const void *data, size_t place)
{
    const things *at = data;
    return direction_dot(at->normal[place], at->n) > 0.0f;
}

static unsigned faces_lanes(const void *data, size_t first, unsigned bits)
{
    const things *at = data;
    g_assert_cmpuint(bits, !=, 0);
    return bits & directions_on_side(load_lane_ints(at->normal + first), at->n);
}

static int compare_numbers(const void *data, size_t a, size_t b)
{
    const size_t *number = ((const things *)data)->number;
    return (number[a] > number[b]) - (number[a] < number[b]);
}

static const point_rules rules[] = {{NULL, NULL, compare_numbers},
                                    {faces, faces_lanes, compare_numbers}};

static point_arrays arrays_of(const cloud *c)
{
    point_arrays points;
    g_assert_true(point_arrays_make(&points, c->n, "test", NULL));
    for (size_t i = 0; i < c->n; i++) {
        points.x[i] = c->points[i][0];
        points.y[i] = c->points[i][1];
        points.z[i] = c->points[i][2];
    }
    return points;
}

/* Numbers and normals follow the order, in which each point comes once. */
static things put_in_order(const cloud *c, const point_arrays *points, size_t *order)
{
    static bool seen[MOST];
    things at = {order, big_alloc(points_padded(c->n), 4, "test", NULL), {0}};
    if (!order)
        at.number = big_alloc(c->n, sizeof *at.number, "test", NULL);
    memset(seen, 0, sizeof seen);
    for (size_t i = 0; i < c->n; i++) {
        at.number[i] = order ? order[i] : i;
        at.normal[i] = c->normals[at.number[i]];
        vec3 p = {points->x[i], points->y[i], points->z[i]};
        g_assert_true(compare(length3_2(p - c->points[at.number[i]]), 0.0f) == 0);
        g_assert_false(seen[at.number[i]]);
        seen[at.number[i]] = true;
    }
    return at;
}

static void ask(const cloud *c, const point_index *index, things *at)
{
    static neighbour wanted[MOST];
    static const float flatten[] = {1.0f, 0.3f, 0.01f};
    sampler random = sampler_make(6, c->n);
    point_hits hits = {0};
    for (int i = 0; i < QUERIES; i++) {
        question q = {anywhere(&random, c, i), warp_sphere(sampler_2d(&random)),
                      i % 7 < 4, flatten[i % 3]};
        float radius = 0.4f * sampler_1d(&random), bound = i % 4 ? INFINITY : radius;
        const point_query query = {
            q.p, q.n, q.flatten < 1.0f, 1.0f / q.flatten, &rules[q.facing], at};
        at->n = q.n;
        g_assert_true(point_index_within(index, &query, radius, &hits));
        check_found(c, at->number, &hits, wanted, search(c, &q, MOST, radius, wanted));
        g_assert_true(point_index_nearest(index, &query, ks[i % 5], bound, &hits));
        check_found(c, at->number, &hits, wanted,
                    search(c, &q, ks[i % 5], bound, wanted));
    }
    point_hits_clear(&hits);
}

static void check_index(const cloud *c, map_choice choice, float radius, unsigned threads)
{
    size_t *order;
    GError *error = NULL;
    point_arrays points = arrays_of(c);
    g_autoptr(point_index) index = point_index_build(
        choice, &points, radius, (workers){.threads = threads}, &order, &error);
    g_assert_no_error(error);
    things at = put_in_order(c, &points, order);
    ask(c, index, &at);
    point_arrays_clear(&points);
    big_free(at.number);
    big_free(at.normal);
}

/* ---- Tests ---- */

static const size_t sizes[] = {0, 1, 7, 16, 17, 129, 700, MOST};

static void test_set(void)
{
    static cloud c;
    for (size_t i = 0; i < G_N_ELEMENTS(sizes); i++) {
        fill(&c, sizes[i], false);
        check_set(&c, 1);
        fill(&c, sizes[i], true);
        check_set(&c, 3);
    }
}

static void test_kind(const void *data)
{
    map_choice choice = (map_choice)GPOINTER_TO_INT(data);
    static cloud c;
    for (size_t i = 0; i < 2 * G_N_ELEMENTS(sizes); i++) {
        fill(&c, sizes[i / 2], i % 2);
        check_index(&c, choice, i % 3 ? 0.1f : 0.0f, 1 + (unsigned)i % 3);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/point_index/set", test_set);
    g_test_add_data_func("/point_index/list", GINT_TO_POINTER(MAP_LIST), test_kind);
    g_test_add_data_func("/point_index/kdtree", GINT_TO_POINTER(MAP_KDTREE), test_kind);
    g_test_add_data_func("/point_index/grid", GINT_TO_POINTER(MAP_GRID), test_kind);
    return g_test_run();
}
