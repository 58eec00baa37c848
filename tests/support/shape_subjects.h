/*
 * Shapes for the tests: every kind, whole and cut, at places that turn, mirror, stretch
 * and shrink; and a soup of random triangles.
 */
#pragma once

#include "accel/accel.h"
#include "base/memory.h"
#include "math/sampler.h"
#include "math/warp.h"
#include "shape/shape_kinds.h"

#include <glib.h>
#include <string.h>

static const source_place here = {"shapes.pbrt", 7, 3};

/* A shape for the tests, with the numbers that made it. */
typedef struct subject {
    const char *kind;
    float radius, z_min, z_max, phi_max, inner;
} subject;

static const subject quadrics[] = {
    {"sphere", 1.3f, -1.3f, 1.3f, 360, 0},   {"sphere", 0.8f, -0.5f, 0.7f, 250, 0},
    {"disk", 1.1f, 0.25f, 0, 360, 0},        {"disk", 1.4f, -0.5f, 0, 200, 0.6f},
    {"cylinder", 0.7f, -1.2f, 0.9f, 360, 0}, {"cylinder", 1.2f, -0.2f, 0.5f, 130, 0},
};

enum { N_PLACES = 6 };

static inline shape_place place_at(int i)
{
    transform t = transform_identity();
    const transform steps[] = {transform_translate(0.3, -0.7, 0.2),
                               transform_rotate(37, 1, 2, -0.5),
                               transform_scale(-1, 1, 1), transform_scale(2.5, 0.7, 1.2),
                               transform_scale(1e-3, 1e-3, 1e-3)};
    for (int k = 0; k < i && k < 3; k++)
        t = transform_multiply(&t, &steps[k]);
    if (i >= 4)
        t = transform_multiply(&steps[3], &t);
    if (i == 5)
        t = transform_multiply(&steps[4], &t);
    return (shape_place){.to_world = t, .reverse_orientation = i % 2 == 1, .material = 0};
}

static inline params *describe(const subject *s)
{
    params *p = params_new(here, "/", NULL);
    bool is_disk = strcmp(s->kind, "disk") == 0;
    params_add_numbers(p, here, PARAM_FLOAT, "radius", &s->radius, 1, NULL);
    params_add_numbers(p, here, PARAM_FLOAT, is_disk ? "height" : "zmin", &s->z_min, 1,
                       NULL);
    params_add_numbers(p, here, PARAM_FLOAT, is_disk ? "innerradius" : "zmax",
                       is_disk ? &s->inner : &s->z_max, 1, NULL);
    params_add_numbers(p, here, PARAM_FLOAT, "phimax", &s->phi_max, 1, NULL);
    return p;
}

static inline shape *make(const subject *s, const shape_place *at)
{
    g_autoptr(params) p = describe(s);
    GError *error = NULL;
    shape *made = shape_new(s->kind, p, at, &error);
    g_assert_no_error(error);
    return made;
}

/* The square -1..1 in the plane z = 0, front up. */
static inline shape *unit_square(const shape_place *at)
{
    static const float points[12] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    static const int indices[6] = {0, 1, 2, 0, 2, 3};
    g_autoptr(params) p = params_new(here, "/", NULL);
    params_add_numbers(p, here, PARAM_POINT3, "P", points, 12, NULL);
    params_add_integers(p, here, PARAM_INTEGER, "indices", indices, 6, NULL);
    return shape_new("trianglemesh", p, at, NULL);
}

static inline accel *accel_of(shape *const *shapes, size_t n)
{
    GError *error = NULL;
    const accel_input in = {.shapes = shapes, .n_shapes = n, .shutter = {0.0, 1.0}};
    accel *a = accel_build(&in, 1, &error);
    g_assert_no_error(error);
    return a;
}

static inline ray random_ray(sampler *s, const transform *to_world)
{
    vec3 o = 3.0f * sampler_1d(s) * warp_sphere(sampler_2d(s));
    vec3 to = 1.2f * sampler_1d(s) * warp_sphere(sampler_2d(s));
    o = transform_point(to_world, o);
    to = transform_point(to_world, to);
    return (ray){o, normalize3(to - o), INFINITY, 0, {{0}, 0}};
}

enum { SOUP = 150 };

static inline mesh random_soup(uint64_t key)
{
    mesh m = {.n_vertices = 3 * SOUP, .n_triangles = SOUP};
    m.positions = big_alloc(9 * SOUP + 1, sizeof(float), "test", NULL);
    m.indices = big_alloc(3 * SOUP, sizeof(uint32_t), "test", NULL);
    for (uint32_t i = 0; i < SOUP; i++) {
        sampler s = sampler_make(key, i);
        vec3 center = warp_sphere(sampler_2d(&s));
        for (uint32_t k = 0; k < 3; k++) {
            vec3 p = center + 0.4f * warp_sphere(sampler_2d(&s));
            memcpy(m.positions + 9 * i + 3 * k, &p, 3 * sizeof(float));
            m.indices[3 * i + k] = 3 * i + k;
        }
    }
    return m;
}

static inline double dot_double(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void cross_double(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* The 1 - 1e-6 quantile of chi-square (Wilson & Hilferty 1931). */
static inline double chi2_limit(double freedom)
{
    double a = 2 / (9 * freedom), root = 1 - a + 4.7534 * sqrt(a);
    return freedom * root * root * root;
}
