/*
 * accel: what a ray meets among many shapes is the nearest of what it meets of each
 * alone, within its length; interfaces are met and hide nothing; a cut-out is passed by
 * as many rays as it says, each always or never; patches are met at the same places
 * whether Embree knows them as triangles or not.
 */
#include "shape_subjects.h"

enum { N_RAYS = 4000, N_SHAPES = G_N_ELEMENTS(quadrics) + 1 };

/* Beside and in one another. */
static shape *shape_number(size_t i)
{
    const shape_place at = {.to_world = transform_translate(0.3 * (double)i, 0.0, 0.1),
                            .material = i % 2 == 0 ? 0 : NO_INDEX};
    return i < G_N_ELEMENTS(quadrics) ? make(&quadrics[i], &at) : unit_square(&at);
}

typedef struct scenery {
    shape *shapes[N_SHAPES];
    accel *alone[N_SHAPES], *all;
} scenery;

static void scenery_make(scenery *s)
{
    for (size_t i = 0; i < N_SHAPES; i++) {
        s->shapes[i] = shape_number(i);
        s->shapes[i]->lets_through = s->shapes[i]->material == NO_INDEX;
        s->alone[i] = accel_of(&s->shapes[i], 1);
    }
    s->all = accel_of(s->shapes, N_SHAPES);
}

static void scenery_clear(scenery *s)
{
    accel_free(s->all);
    for (size_t i = 0; i < N_SHAPES; i++) {
        accel_free(s->alone[i]);
        shape_free(s->shapes[i]);
    }
}

static ray ray_number(uint32_t n)
{
    const transform here_and_now = transform_identity();
    sampler random = sampler_make(5, n);
    return random_ray(&random, &here_and_now);
}

/* How far the nearest is, of each shape by itself; INFINITY: none. */
static float nearest_of_each(const scenery *s, const ray *r, bool opaque_only)
{
    float t = INFINITY;
    for (size_t i = 0; i < N_SHAPES; i++) {
        surface_hit hit;
        if (opaque_only && s->shapes[i]->material == NO_INDEX)
            continue;
        if (accel_intersect(s->alone[i], r, &hit))
            t = minf(t, hit.t);
    }
    return t;
}

static void test_nearest(void)
{
    scenery s;
    unsigned n_met = 0;
    scenery_make(&s);
    for (uint32_t n = 0; n < N_RAYS; n++) {
        ray r = ray_number(n);
        float t = nearest_of_each(&s, &r, false);
        surface_hit hit;
        bool met = accel_intersect(s.all, &r, &hit);
        g_assert_cmpint(met, ==, isfinite(t));
        if (!met)
            continue;
        n_met++;
        g_assert_cmpfloat(fabsf(hit.t - t), <=, 1e-5f * t);
        r.t_max = 0.999f * t;
        g_assert_false(accel_intersect(s.all, &r, &hit));
        r.t_max = 1.001f * t;
        g_assert_true(accel_intersect(s.all, &r, &hit));
    }
    g_assert_cmpuint(n_met, >, N_RAYS / 4);
    scenery_clear(&s);
}

static void test_hidden(void)
{
    scenery s;
    unsigned n_hidden = 0, n_seen_through = 0;
    scenery_make(&s);
    for (uint32_t n = 0; n < N_RAYS; n++) {
        ray r = ray_number(n);
        float t = nearest_of_each(&s, &r, true);
        g_assert_cmpint(accel_occluded(s.all, &r), ==, isfinite(t));
        n_hidden += isfinite(t);
        n_seen_through += nearest_of_each(&s, &r, false) < t;
        if (!isfinite(t))
            continue;
        r.t_max = 0.999f * t;
        g_assert_false(accel_occluded(s.all, &r));
    }
    g_assert_cmpuint(n_hidden, >, N_RAYS / 5);
    g_assert_cmpuint(n_seen_through, >, N_RAYS / 20);
    scenery_clear(&s);
}

/* Two patches of a slanted board, with a seam; or no board, for its last corner is off.
 */
static shape *board(const shape_place *at, float last)
{
    const float points[18] = {-1, -1, 0,  0, -1, 0.25f,  1,    -1, 0.5f,
                              -1, 1,  -1, 0, 1,  -0.75f, last, 1,  -0.5f};
    static const float uvs[12] = {0, 0, 1, 0, 3, 0, 0, 1, 1, 1, 3, 1.5f};
    static const int indices[8] = {0, 1, 3, 4, 1, 2, 4, 5};
    g_autoptr(params) p = params_new(here, "/", NULL);
    params_add_numbers(p, here, PARAM_POINT3, "P", points, 18, NULL);
    params_add_numbers(p, here, PARAM_POINT2, "uv", uvs, 12, NULL);
    params_add_integers(p, here, PARAM_INTEGER, "indices", indices, 8, NULL);
    return shape_new("bilinearmesh", p, at, NULL);
}

static void same_vec3(vec3 a, vec3 b, float tolerance)
{
    g_assert_cmpfloat(max_component3(abs3(a - b)), <=, tolerance);
}

/* A texture coordinate may differ by what the place on the patch does. */
static void same_hit(const surface_hit *a, const surface_hit *b)
{
    const float rounding = 4e-6f;
    g_assert_cmpuint(a->primitive, ==, b->primitive);
    g_assert_cmpfloat(fabsf(a->t - b->t), <=, rounding * (1.0f + a->t));
    same_vec3(a->p, b->p, rounding);
    same_vec3(a->n_geom, b->n_geom, 0.0f);
    same_vec3(a->n, b->n, 0.0f);
    same_vec3(a->dpdu, b->dpdu, 8.0f * rounding);
    same_vec3(a->dpdv, b->dpdv, 8.0f * rounding);
    g_assert_cmpfloat(fabsf(a->uv.x - b->uv.x), <=, 4.0f * rounding);
    g_assert_cmpfloat(fabsf(a->uv.y - b->uv.y), <=, 4.0f * rounding);
}

/* A board alone, and one with triangles far away. */
static void check_halves(const shape_place *at, float last)
{
    const shape_place far = {.to_world = transform_translate(0.0, 0.0, 40.0)};
    shape *shapes[2] = {board(at, last), unit_square(&far)};
    accel *alone = accel_of(shapes, 1), *both = accel_of(shapes, 2);
    unsigned n_met = 0, n_apart = 0;
    for (uint32_t n = 0; n < N_RAYS; n++) {
        ray r = ray_number(n);
        r.t_max = 10.0f;
        surface_hit exact, halved;
        bool met = accel_intersect(alone, &r, &exact);
        n_apart += accel_intersect(both, &r, &halved) != met;
        n_met += met;
        if (met && !n_apart)
            same_hit(&exact, &halved);
    }
    g_assert_cmpuint(n_met, >, N_RAYS / 4);
    g_assert_cmpuint(n_apart, ==, 0);
    accel_free(alone);
    accel_free(both);
    for (int i = 0; i < 2; i++)
        shape_free(shapes[i]);
}

static void test_halves(void)
{
    for (int i = 0; i < 2; i++) {
        const shape_place at = {.to_world = transform_identity(),
                                .reverse_orientation = i};
        check_halves(&at, 1.0f);
        check_halves(&at, 1.5f);
    }
}

/* Five deviations of a binomial count: a false alarm in two million. */
static void test_cut_outs(void)
{
    const float_input alpha = {.constant = 0.3f};
    const shape_place at = {.to_world = transform_identity(), .alpha = &alpha};
    shape *square = unit_square(&at);
    accel *a = accel_of(&square, 1);
    unsigned n_met = 0, n_there = 0;
    for (uint32_t n = 0; n < 10 * N_RAYS; n++) {
        ray r = ray_number(n);
        surface_hit hit, again;
        if (!accel_intersect_solid(a, &r, &hit))
            continue;
        n_there++;
        bool met = accel_intersect(a, &r, &hit);
        g_assert_cmpint(accel_intersect(a, &r, &again), ==, met);
        n_met += met;
    }
    double expected = 0.3 * n_there, deviation = sqrt(0.7 * expected);
    g_test_message("%u of %u", n_met, n_there);
    g_assert_cmpuint(n_there, >, N_RAYS);
    g_assert_cmpfloat(fabs(n_met - expected), <, 5.0 * deviation);
    accel_free(a);
    shape_free(square);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/accel/nearest", test_nearest);
    g_test_add_func("/accel/hidden", test_hidden);
    g_test_add_func("/accel/halves", test_halves);
    g_test_add_func("/accel/cut-outs", test_cut_outs);
    return g_test_run();
}
