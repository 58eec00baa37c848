/*
 * shape: rays meet what a naive search in double precision says they meet, normals point
 * where pbrt's rules say, rays that leave a surface do not meet it again, bad input is
 * named.
 */
#include "shape_subjects.h"

/* ---- Naive twins, in double ---- */

static void to_object(const transform *t, vec3 v, double w, double out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = t->inverse[i][3] * w;
        for (int k = 0; k < 3; k++)
            out[i] += t->inverse[i][k] * (double)v[k];
    }
}

static double phi_of(const double p[3])
{
    double phi = atan2(p[1], p[0]);
    return phi < 0 ? phi + 2 * G_PI : phi;
}

/* How far inside its cuts a point of the full quadric lies; negative: cut away. */
static double margin(const subject *s, const double p[3])
{
    double phi_max = (double)s->phi_max * G_PI / 180, m = 1;
    if (s->phi_max < 360)
        m = fmin(phi_max - phi_of(p), phi_of(p) < 1e-4 ? 0 : 1);
    double r = sqrt(p[0] * p[0] + p[1] * p[1]);
    if (strcmp(s->kind, "disk") == 0)
        return fmin(m,
                    fmin((double)s->radius - r, s->inner > 0 ? r - (double)s->inner : 1));
    if (strcmp(s->kind, "sphere") == 0 && s->z_max >= s->radius)
        return m;
    return fmin(m, fmin(p[2] - (double)s->z_min, (double)s->z_max - p[2]));
}

/* All t where the line meets the full quadric. */
static int all_roots(const subject *s, const double o[3], const double d[3], double t[2])
{
    if (strcmp(s->kind, "disk") == 0) {
        t[0] = ((double)s->z_min - o[2]) / d[2];
        return 1;
    }
    int n = strcmp(s->kind, "sphere") == 0 ? 3 : 2;
    double a = 0, b = 0, c = -(double)s->radius * (double)s->radius;
    for (int i = 0; i < n; i++) {
        a += d[i] * d[i];
        b += 2 * o[i] * d[i];
        c += o[i] * o[i];
    }
    double discriminant = b * b - 4 * a * c;
    if (discriminant < 0)
        return 0;
    t[0] = (-b - sqrt(discriminant)) / (2 * a);
    t[1] = (-b + sqrt(discriminant)) / (2 * a);
    return 2;
}

/* 1: a hit at *t, p in object space; 0: none; -1: too close to a border to say. */
static int naive_hit(const subject *s, const transform *to_world, const ray *r, double *t,
                     double p[3])
{
    double o[3], d[3], roots[2];
    to_object(to_world, r->origin, 1, o);
    to_object(to_world, r->direction, 0, d);
    int n = all_roots(s, o, d, roots);
    if (n == 2 && roots[1] - roots[0] < 1e-3 * fabs(roots[1]))
        return -1;
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < 3; k++)
            p[k] = o[k] + roots[i] * d[k];
        if (fabs(margin(s, p)) < 1e-4)
            return -1;
        if (roots[i] > 0 && margin(s, p) > 0) {
            *t = roots[i];
            return 1;
        }
    }
    return 0;
}

/* The outer normal at an object point, turned by the rules, in the world. */
static vec3 naive_normal(const subject *s, const shape_place *at, const double p[3])
{
    double n[3] = {p[0], p[1], strcmp(s->kind, "sphere") == 0 ? p[2] : 0};
    if (strcmp(s->kind, "disk") == 0)
        n[0] = n[1] = 0, n[2] = 1;
    vec3 out = normalize3(transform_normal(
        &at->to_world, vec3_make((float)n[0], (float)n[1], (float)n[2])));
    bool flip = at->reverse_orientation != transform_swaps_handedness(&at->to_world);
    return flip ? -out : out;
}

static void compare_hit(const subject *s, const shape_place *at, const accel *a,
                        const ray *r, unsigned count[2])
{
    double t = 0, p[3];
    int expected = naive_hit(s, &at->to_world, r, &t, p);
    if (expected < 0)
        return;
    surface_hit hit;
    bool found = accel_intersect(a, r, &hit);
    g_assert_cmpint(found, ==, expected);
    g_assert_cmpint(accel_occluded(a, r), ==, expected);
    count[expected]++;
    if (!found)
        return;
    g_assert_cmpfloat(fabs((double)hit.t - t), <, 2e-5 * t);
    vec3 world =
        transform_point(&at->to_world, vec3_make((float)p[0], (float)p[1], (float)p[2]));
    float size = max_component3(abs3(world)) + hit.t;
    g_assert_cmpfloat(length3(hit.p - world), <, 2e-6f * size);
    g_assert_cmpfloat(length3(hit.n_geom - naive_normal(s, at, p)), <, 2e-4);
    g_assert_cmpfloat(fabsf(dot3(hit.n, normalize3(hit.dpdu))), <, 1e-4);
    g_assert_true(hit.uv.x >= 0 && hit.uv.x <= 1.0001f && hit.uv.y > -0.0001f);
}

static void test_quadrics_against_twin(void)
{
    for (size_t i = 0; i < G_N_ELEMENTS(quadrics); i++) {
        for (int k = 0; k < N_PLACES; k++) {
            shape_place at = place_at(k);
            shape *s = make(&quadrics[i], &at);
            accel *a = accel_of(&s, 1);
            unsigned count[2] = {0};
            for (uint32_t n = 0; n < 2000; n++) {
                sampler random = sampler_make(11 + i, n);
                ray r = random_ray(&random, &at.to_world);
                compare_hit(&quadrics[i], &at, a, &r, count);
            }
            g_assert_cmpuint(count[1], >, 200);
            accel_free(a);
            shape_free(s);
        }
    }
}

/* ---- Meshes ---- */

/* Moeller-Trumbore; *edge is the smallest barycentric weight. */
static bool meets_triangle(const float *positions, const ray *r, double *t, double *edge)
{
    double p[3][3], e1[3], e2[3], d[3], o[3], h[3], q[3];
    for (int i = 0; i < 9; i++)
        p[i / 3][i % 3] = (double)positions[i];
    for (int k = 0; k < 3; k++) {
        e1[k] = p[1][k] - p[0][k];
        e2[k] = p[2][k] - p[0][k];
        d[k] = (double)r->direction[k];
        o[k] = (double)r->origin[k] - p[0][k];
    }
    cross_double(d, e2, h);
    double scale = 1 / dot_double(e1, h);
    cross_double(o, e1, q);
    double u = dot_double(o, h) * scale, v = dot_double(d, q) * scale;
    *t = dot_double(e2, q) * scale;
    *edge = fmin(fmin(u, v), 1 - u - v);
    return *t > 0;
}

/* Nearest triangle, or -1; *doubtful if an edge is too near. */
static int naive_nearest(const mesh *m, const ray *r, double *t_best, bool *doubtful)
{
    int best = -1;
    *t_best = HUGE_VAL;
    *doubtful = false;
    for (int i = 0; i < SOUP; i++) {
        double t, edge;
        if (!meets_triangle(m->positions + 9 * i, r, &t, &edge) || edge < -1e-4)
            continue;
        *doubtful = *doubtful || edge < 1e-4;
        if (t < *t_best) {
            *t_best = t;
            best = i;
        }
    }
    return best;
}

static void test_mesh_against_twin(void)
{
    for (int k = 0; k < N_PLACES; k++) {
        shape_place at = place_at(k);
        mesh m = random_soup(5);
        shape *s = shape_new_mesh(&m, &at, here, NULL);
        accel *a = accel_of(&s, 1);
        const mesh *moved = shape_mesh.triangles(s->self);
        unsigned hits = 0;
        for (uint32_t n = 0; n < 3000; n++) {
            sampler random = sampler_make(21, n);
            ray r = random_ray(&random, &at.to_world);
            double t;
            bool doubtful;
            int best = naive_nearest(moved, &r, &t, &doubtful);
            surface_hit hit;
            if (doubtful)
                continue;
            g_assert_cmpint(accel_intersect(a, &r, &hit), ==, best >= 0);
            if (best < 0)
                continue;
            hits++;
            g_assert_cmpint((int)hit.primitive, ==, best);
            g_assert_cmpfloat(fabs((double)hit.t - t), <, 1e-4 * t);
            vec3 p = r.origin + hit.t * r.direction;
            g_assert_cmpfloat(length3(hit.p - p), <, 1e-5f * length3(p) + 1e-5f * hit.t);
        }
        g_assert_cmpuint(hits, >, 500);
        accel_free(a);
        shape_free(s);
    }
}

/* One triangle in the xy plane, counter-clockwise seen from +z. */
static shape *one_triangle(const shape_place *at, const float *normal)
{
    static const float points[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    g_autoptr(params) p = params_new(here, "/", NULL);
    params_add_numbers(p, here, PARAM_POINT3, "P", points, 9, NULL);
    if (normal) {
        float n[9];
        for (int i = 0; i < 9; i++)
            n[i] = normal[i % 3];
        params_add_numbers(p, here, PARAM_NORMAL, "N", n, 9, NULL);
    }
    GError *error = NULL;
    shape *s = shape_new("trianglemesh", p, at, &error);
    g_assert_no_error(error);
    return s;
}

static void test_orientation(void)
{
    static const float tilted_down[3] = {0.6f, 0, -0.8f};
    const ray r = {{0.2f, 0.2f, 1.0f}, {0, 0, -1.0f}, INFINITY, 0, {{0}, 0}};
    for (int i = 0; i < 8; i++) {
        bool reverse = i & 1, mirror = i & 2, normals = i & 4;
        shape_place at = {.to_world = transform_identity(),
                          .reverse_orientation = reverse};
        if (mirror) { /* x and y swapped: mirrors, the plane stays */
            const double swap[4][4] = {
                {0, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
            g_assert_true(transform_from_matrix(swap, &at.to_world));
        }
        shape *s = one_triangle(&at, normals ? tilted_down : NULL);
        accel *a = accel_of(&s, 1);
        surface_hit hit;
        g_assert_true(accel_intersect(a, &r, &hit));
        /* world winding is reversed by the swap; pbrt turns it back */
        float expected = normals ? (reverse ? 1.0f : -1.0f) : (reverse ? -1.0f : 1.0f);
        g_assert_cmpfloat(hit.n_geom[2], ==, expected);
        if (normals)
            g_assert_cmpfloat(fabsf(hit.n[2] - 0.8f * expected), <, 1e-6);
        g_assert_cmpfloat(shape_sample_area(s, 0.5f, (vec2){0.3f, 0.6f}).n[2], ==,
                          expected);
        accel_free(a);
        shape_free(s);
    }
}

static void test_uv_and_tangents(void)
{
    static const float points[9] = {0, 0, 0, 2, 0, 0, 2, 3, 0};
    static const float uvs[6] = {0, 0, 0, 1, 1, 1}; /* v along x, u along y */
    static const float tangents[9] = {0, 0, 5, 0, 0, 5, 0, 0, 5};
    for (int i = 0; i < 3; i++) {
        g_autoptr(params) p = params_new(here, "/", NULL);
        params_add_numbers(p, here, PARAM_POINT3, "P", points, 9, NULL);
        if (i > 0)
            params_add_numbers(p, here, PARAM_POINT2, "uv", uvs, 6, NULL);
        if (i > 1)
            params_add_numbers(p, here, PARAM_VECTOR3, "S", tangents, 9, NULL);
        shape_place at = {.to_world = transform_identity()};
        shape *s = shape_new("trianglemesh", p, &at, NULL);
        accel *a = accel_of(&s, 1);
        surface_hit hit;
        ray r = {{1.0f, 0.75f, 1.0f}, {0, 0, -1.0f}, INFINITY, 0, {{0}, 0}};
        g_assert_true(accel_intersect(a, &r, &hit));
        vec3 expected[3] = {vec3_make(2, 0, 0), vec3_make(0, 3, 0), vec3_make(0, 0, 5)};
        g_assert_cmpfloat(length3(hit.dpdu - expected[i]), <, 1e-5);
        g_assert_cmpfloat(fabsf(hit.uv.x - (i ? 0.25f : 0.5f)), <, 1e-6);
        g_assert_cmpfloat(fabsf(hit.uv.y - (i ? 0.5f : 0.25f)), <, 1e-6);
        accel_free(a);
        shape_free(s);
    }
}

/* ---- Leaving a surface ---- */

static void leave_and_expect_nothing(const accel *a, sampler *random, const ray *r)
{
    surface_hit hit = {0};
    if (!accel_intersect(a, r, &hit))
        return;
    for (int i = 0; i < 8; i++) {
        vec3 w = warp_sphere(sampler_2d(random));
        if (i < 4) /* grazing ones are the hard ones */
            w = normalize3(w - hit.n_geom * (dot3(w, hit.n_geom) * 0.999f));
        ray leaving = hit_ray(&hit, face_forward(w, hit.n_geom));
        g_assert_false(accel_occluded(a, &leaving));
    }
}

/* Two rays close by: what p moves is what dpdu, dpdv say of the way that uv moves. */
static void assert_moves_with_uv(const accel *a, const ray *r, float scale)
{
    surface_hit first, second;
    ray moved = *r;
    if (!accel_intersect(a, r, &first))
        return;
    const vec3 aside = frame_from_normal(r->direction).s;
    moved.direction = normalize3(r->direction + 2e-3f * scale / first.t * aside);
    if (!accel_intersect(a, &moved, &second) || fabsf(second.uv.x - first.uv.x) > 0.01f ||
        fabsf(second.uv.y - first.uv.y) > 0.01f || second.primitive != first.primitive ||
        length3(second.p - first.p) > 0.01f * scale)
        return; /* over a seam, an edge or the horizon */
    vec3 by_uv =
        (second.uv.x - first.uv.x) * first.dpdu + (second.uv.y - first.uv.y) * first.dpdv;
    float moved_by = length3(second.p - first.p);
    g_assert_cmpfloat(length3(by_uv - (second.p - first.p)), <,
                      0.05f * moved_by + 2e-5f * scale);
}

static void test_tangents_follow_uv(void)
{
    for (int k = 0; k < N_PLACES; k++) {
        shape_place at = place_at(k);
        for (size_t i = 0; i <= G_N_ELEMENTS(quadrics); i++) {
            bool is_mesh = i == G_N_ELEMENTS(quadrics);
            shape *s = is_mesh ? unit_square(&at) : make(&quadrics[i], &at);
            accel *a = accel_of(&s, 1);
            for (uint32_t n = 0; n < 300; n++) {
                sampler random = sampler_make(70, n);
                ray r = random_ray(&random, &at.to_world);
                assert_moves_with_uv(a, &r, k == 5 ? 1e-3f : 1.0f);
            }
            accel_free(a);
            shape_free(s);
        }
    }
}

static void test_offset_rays_leave_spheres(void)
{
    for (int e = -3; e <= 3; e++) {
        double scale = pow(10, e);
        transform size = transform_scale(scale, scale, scale);
        transform shift = transform_translate(1.5, -0.4, 2.0);
        shape_place at = {.to_world = transform_multiply(&size, &shift)};
        shape *s = make(&quadrics[0], &at);
        accel *a = accel_of(&s, 1);
        for (uint32_t n = 0; n < 3000; n++) {
            sampler random = sampler_make(71, n);
            ray r = random_ray(&random, &at.to_world);
            surface_hit hit = {0}; /* from outside only: the normal points outward */
            if (accel_intersect(a, &r, &hit) && dot3(hit.n_geom, r.direction) < 0)
                leave_and_expect_nothing(a, &random, &r);
        }
        accel_free(a);
        shape_free(s);
    }
}

/* A large slanted square through the origin: hits have tiny coordinates there. */
static void test_offset_rays_leave_squares(void)
{
    for (int e = -3; e <= 3; e++) {
        for (int turn = 0; turn < 4; turn++) {
            double scale = pow(10, e);
            transform size = transform_scale(scale, scale, scale);
            transform rotate = transform_rotate(17.0 + 31.0 * turn, turn, 1, 0.3);
            shape_place at = {.to_world = transform_multiply(&size, &rotate)};
            shape *s = unit_square(&at);
            accel *a = accel_of(&s, 1);
            for (uint32_t n = 0; n < 2000; n++) {
                sampler random = sampler_make(81, n);
                ray r = random_ray(&random, &at.to_world);
                vec3 to = (n % 2 ? 1e-4f : 1.0f) * warp_sphere(sampler_2d(&random));
                to = transform_point(&at.to_world, to);
                r.direction = normalize3(to - r.origin);
                leave_and_expect_nothing(a, &random, &r);
            }
            accel_free(a);
            shape_free(s);
        }
    }
}

static void test_scale_by_thousand(void)
{
    for (size_t i = 0; i < G_N_ELEMENTS(quadrics); i++) {
        shape_place small = place_at(4), large = small;
        transform size = transform_scale(1000, 1000, 1000);
        large.to_world = transform_multiply(&size, &small.to_world);
        shape *s[2] = {make(&quadrics[i], &small), make(&quadrics[i], &large)};
        accel *a[2] = {accel_of(&s[0], 1), accel_of(&s[1], 1)};
        g_assert_cmpfloat(fabsf(s[1]->area / s[0]->area * 1e-6f - 1), <, 1e-5);
        for (uint32_t n = 0; n < 500; n++) {
            sampler random = sampler_make(91, n);
            ray r = random_ray(&random, &small.to_world), r_large = r;
            r_large.origin *= 1000.0f;
            surface_hit hit, hit_large;
            double t, p[3];
            if (naive_hit(&quadrics[i], &small.to_world, &r, &t, p) < 0)
                continue;
            bool found = accel_intersect(a[0], &r, &hit);
            g_assert_cmpint(found, ==, accel_intersect(a[1], &r_large, &hit_large));
            if (found)
                g_assert_cmpfloat(fabsf(hit_large.t / hit.t * 1e-3f - 1), <, 1e-4);
        }
        for (int k = 0; k < 2; k++) {
            accel_free(a[k]);
            shape_free(s[k]);
        }
    }
}

/* Several shapes of all kinds at once, against asking each alone; and t_max. */
static void test_many_shapes(void)
{
    shape *s[G_N_ELEMENTS(quadrics) + 1];
    for (size_t i = 0; i < G_N_ELEMENTS(quadrics); i++) {
        shape_place at = place_at((int)i % 5);
        s[i] = make(&quadrics[i], &at);
    }
    shape_place at = place_at(4);
    mesh m = random_soup(6);
    s[G_N_ELEMENTS(quadrics)] = shape_new_mesh(&m, &at, here, NULL);
    accel *all = accel_of(s, G_N_ELEMENTS(s)), *one[G_N_ELEMENTS(s)];
    for (size_t i = 0; i < G_N_ELEMENTS(s); i++)
        one[i] = accel_of(&s[i], 1);
    for (uint32_t n = 0; n < 3000; n++) {
        sampler random = sampler_make(101, n);
        transform identity = transform_identity();
        ray r = random_ray(&random, &identity);
        float nearest = INFINITY;
        for (size_t i = 0; i < G_N_ELEMENTS(s); i++) {
            surface_hit hit;
            if (accel_intersect(one[i], &r, &hit))
                nearest = fminf(nearest, hit.t);
        }
        surface_hit hit;
        bool found = accel_intersect(all, &r, &hit);
        g_assert_cmpint(found, ==, isfinite(nearest));
        if (!found)
            continue;
        g_assert_cmpfloat(fabsf(hit.t - nearest), <=, 1e-5f * nearest);
        r.t_max = nearest * 0.999f;
        g_assert_false(accel_intersect(all, &r, &hit));
        g_assert_false(accel_occluded(all, &r));
    }
    accel_free(all);
    for (size_t i = 0; i < G_N_ELEMENTS(s); i++) {
        accel_free(one[i]);
        shape_free(s[i]);
    }
}

static void test_degenerate_triangles_are_harmless(void)
{
    static const float points[12] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0};
    static const int indices[9] = {0, 1, 2, 0, 0, 0, 0, 1, 3};
    g_autoptr(params) p = params_new(here, "/", NULL);
    params_add_numbers(p, here, PARAM_POINT3, "P", points, 12, NULL);
    params_add_integers(p, here, PARAM_INTEGER, "indices", indices, 9, NULL);
    shape_place at = {.to_world = transform_identity()};
    shape *s = shape_new("trianglemesh", p, &at, NULL);
    accel *a = accel_of(&s, 1);
    g_assert_cmpfloat(fabsf(s->area - 0.5f), <, 1e-6);
    for (uint32_t i = 0; i < 1000; i++) {
        sampler random = sampler_make(111, i);
        float u = sampler_1d(&random);
        g_assert_cmpuint(shape_sample_area(s, u, sampler_2d(&random)).primitive, ==, 2);
        ray r = random_ray(&random, &at.to_world);
        surface_hit hit;
        if (accel_intersect(a, &r, &hit))
            g_assert_true(finite3(hit.p) && finite3(hit.n));
    }
    accel_free(a);
    shape_free(s);
}

static void test_empty_accel(void)
{
    accel *a = accel_of(NULL, 0);
    ray r = {{0}, {0, 0, 1}, INFINITY, 0, {{0}, 0}};
    surface_hit hit;
    g_assert_false(accel_intersect(a, &r, &hit));
    g_assert_false(accel_occluded(a, &r));
    accel_free(a);
}

/* ---- Bad input ---- */

static void expect_error(const char *kind, const params *p, const char *text)
{
    shape_place at = {.to_world = transform_identity()};
    GError *error = NULL;
    g_assert_null(shape_new(kind, p, &at, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_true(g_str_has_prefix(error->message, "shapes.pbrt:7:3: "));
    g_assert_nonnull(strstr(error->message, text));
    g_error_free(error);
}

static void expect_bad_number(const char *kind, const char *name, float value,
                              const char *text)
{
    g_autoptr(params) p = params_new(here, "/", NULL);
    params_add_numbers(p, here, PARAM_FLOAT, name, &value, 1, NULL);
    expect_error(kind, p, text);
}

static void expect_bad_mesh(size_t n_points, const int *indices, size_t n_indices,
                            size_t n_uv, const char *text)
{
    float numbers[30] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    g_autoptr(params) p = params_new(here, "/", NULL);
    params_add_numbers(p, here, PARAM_POINT3, "P", numbers, n_points, NULL);
    if (indices)
        params_add_integers(p, here, PARAM_INTEGER, "indices", indices, n_indices, NULL);
    if (n_uv)
        params_add_numbers(p, here, PARAM_POINT2, "uv", numbers, n_uv, NULL);
    expect_error("trianglemesh", p, text);
}

static void test_bad_input_is_named(void)
{
    expect_bad_number("sphere", "radius", -1, "radius must be positive");
    expect_bad_number("sphere", "zmin", 5, "no area");
    expect_bad_number("sphere", "phimax", -10, "phimax");
    expect_bad_number("sphere", "raduis", 1, "raduis");
    expect_bad_number("cylinder", "radius", 0, "radius must be positive");
    expect_bad_number("disk", "innerradius", 2, "innerradius");
    expect_bad_number("cone", "radius", 2,
                      "expected a shape of kind trianglemesh, sphere, disk, cylinder, "
                      "bilinearmesh, loopsubdiv, curve, found 'cone'");
    const int indices[] = {0, 1, 3, 0, -1};
    expect_bad_mesh(9, indices, 3, 0, "index 3 of triangle 0 is out of range");
    expect_bad_mesh(9, indices + 2, 3, 0, "out of range");
    expect_bad_mesh(9, indices, 2, 0, "three \"indices\" a triangle");
    expect_bad_mesh(12, NULL, 0, 0, "needs \"indices\"");
    expect_bad_mesh(8, NULL, 0, 0, "\"P\" has 8 numbers");
    expect_bad_mesh(0, NULL, 0, 0, "needs \"P\"");
    expect_bad_mesh(9, NULL, 0, 4, "\"uv\" has 4 numbers");
}

static void test_bad_mesh_is_named(void)
{
    shape_place at = {.to_world = transform_identity()};
    for (int i = 0; i < 3; i++) {
        mesh m = random_soup(3);
        if (i == 0)
            m.positions[10] = NAN;
        else if (i == 1)
            m.indices[5] = 4000;
        else
            m.n_triangles = 0;
        const char *texts[] = {"position 3 of the mesh is not finite",
                               "index 4000 of triangle 1", "no triangles"};
        GError *error = NULL;
        g_assert_null(shape_new_mesh(&m, &at, here, &error));
        g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
        g_assert_nonnull(strstr(error->message, texts[i]));
        g_assert_null(m.positions);
        g_error_free(error);
    }
}

static void test_memory_refused(void)
{
    static const float points[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    g_autoptr(params) p = params_new(here, "/", NULL);
    params_add_numbers(p, here, PARAM_POINT3, "P", points, 9, NULL);
    params_add_numbers(p, here, PARAM_NORMAL, "N", points, 9, NULL);
    shape_place at = {.to_world = transform_identity()};
    for (unsigned n = 1;; n++) {
        GError *error = NULL;
        big_alloc_fail_at(n);
        shape *s = shape_new("trianglemesh", p, &at, &error);
        big_alloc_fail_at(0);
        if (s) {
            g_assert_cmpuint(n, >, 4);
            shape_free(s);
            return;
        }
        g_assert_error(error, NEPH_ERROR, ERROR_FAILED);
        g_error_free(error);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/shape/quadric/twin", test_quadrics_against_twin);
    g_test_add_func("/shape/mesh/twin", test_mesh_against_twin);
    g_test_add_func("/shape/orientation", test_orientation);
    g_test_add_func("/shape/uv", test_uv_and_tangents);
    g_test_add_func("/shape/tangents-follow-uv", test_tangents_follow_uv);
    g_test_add_func("/shape/leave/sphere", test_offset_rays_leave_spheres);
    g_test_add_func("/shape/leave/square", test_offset_rays_leave_squares);
    g_test_add_func("/shape/scale", test_scale_by_thousand);
    g_test_add_func("/shape/many", test_many_shapes);
    g_test_add_func("/shape/degenerate", test_degenerate_triangles_are_harmless);
    g_test_add_func("/shape/empty", test_empty_accel);
    g_test_add_func("/shape/bad/input", test_bad_input_is_named);
    g_test_add_func("/shape/bad/mesh", test_bad_mesh_is_named);
    g_test_add_func("/shape/bad/memory", test_memory_refused);
    return g_test_run();
}
