/*
 * point_index: finds what a naive search finds, ties and all, and names it by its owner's
 * numbers.
 */
#include "math/sampler.h"
#include "math/warp.h"
#include "photon/map/lanes.h"
#include "photon/map/point_index.h"

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

/* The naive search: every point is measured, and all are sorted.
   @param n_facing NULL: all sides */
static size_t search(const cloud *c, vec3 p, const vec3 *n_facing, size_t k, float radius,
                     neighbour *out)
{
    size_t n = 0;
    for (size_t i = 0; i < c->n; i++) {
        vec3 d = c->points[i] - p;
        float d2 = fused(d[2], d[2], fused(d[1], d[1], d[0] * d[0]));
        bool faces = !n_facing || dot3(direction_unpack(c->normals[i]), *n_facing) > 0.0f;
        if (faces && d2 < radius * radius)
            out[n++] = (neighbour){c->points[i], d2, i};
    }
    qsort(out, n, sizeof *out, nearer);
    return MIN(n, k);
}

static void check_found(const cloud *c, const photon_hits *hits, neighbour *wanted,
                        size_t n)
{
    static neighbour found[MOST];
    g_assert_cmpuint(hits->n, ==, n);
    for (size_t i = 0; i < n; i++) {
        size_t k = hits->index[i];
        g_assert_cmpuint(k, <, c->n);
        found[i] = (neighbour){c->points[k], hits->distance2[i], k};
    }
    qsort(found, n, sizeof *found, nearer);
    for (size_t i = 0; i < n; i++) {
        g_assert_cmpuint(found[i].number, ==, wanted[i].number);
        g_assert_true(compare(found[i].distance2, wanted[i].distance2) == 0);
    }
}

static void check_cloud(const cloud *c, unsigned threads)
{
    static neighbour wanted[MOST];
    static const size_t ks[] = {1, 4, 16, 100, MOST + 1};
    g_autoptr(GError) error = NULL;
    g_autoptr(point_index) index =
        point_index_build(c->points, c->normals, c->n, threads, &error);
    g_assert_no_error(error);
    sampler random = sampler_make(5, c->n);
    for (size_t i = 0; i < c->n; i++) {
        vec3 off =
            point_index_position(index, i) - c->points[point_index_number(index, i)];
        g_assert_true(compare(length3_2(off), 0.0f) == 0);
    }
    photon_hits hits = {0};
    for (int i = 0; i < QUERIES; i++) {
        vec2 u = sampler_2d(&random);
        vec3 p = {u.x, u.y, sampler_1d(&random)};
        if (i % 2 && c->n > 0)
            p = c->points[(size_t)i % c->n];
        float radius = 0.4f * sampler_1d(&random);
        g_assert_true(point_index_within(index, p, radius, &hits));
        check_found(c, &hits, wanted, search(c, p, NULL, MOST, radius, wanted));
        size_t k = ks[i % 5];
        float bound = i % 3 ? INFINITY : radius;
        g_assert_true(point_index_nearest(index, p, k, bound, &hits));
        check_found(c, &hits, wanted, search(c, p, NULL, k, bound, wanted));
        vec3 n = warp_sphere(sampler_2d(&random));
        g_assert_true(point_index_nearest_facing(index, p, n, k, bound, &hits));
        check_found(c, &hits, wanted, search(c, p, &n, k, bound, wanted));
    }
    photon_hits_clear(&hits);
}

static void test_naive(void)
{
    static const size_t sizes[] = {0, 1, 7, 16, 17, 129, 700, MOST};
    static cloud c;
    for (size_t i = 0; i < G_N_ELEMENTS(sizes); i++) {
        fill(&c, sizes[i], false);
        check_cloud(&c, 1);
        fill(&c, sizes[i], true);
        check_cloud(&c, 3);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/point_index/naive", test_naive);
    return g_test_run();
}
