/*
 * surface: bilinear patches, subdivision surfaces and curves. Patches and curves against
 * the surface sampled densely and, where they are one, against spheres' and cylinders'
 * closed forms; subdivision against the closed form of its limit; cut-outs against the
 * share of rays that they stop.
 */
#include "shape_subjects.h"

static params *start(void)
{
    return params_new(here, "/", NULL);
}

static void add_floats(params *p, param_type type, const char *name, const float *v,
                       size_t n)
{
    g_assert_true(params_add_numbers(p, here, type, name, v, n, NULL));
}

static void add_word(params *p, const char *name, const char *word)
{
    g_assert_true(params_add_strings(p, here, PARAM_STRING, name, &word, 1, NULL));
}

static void add_integer(params *p, const char *name, int v)
{
    g_assert_true(params_add_integers(p, here, PARAM_INTEGER, name, &v, 1, NULL));
}

static shape *make_shape(const char *kind, const params *p, const shape_place *at)
{
    GError *error = NULL;
    shape *s = shape_new(kind, p, at, &error);
    g_assert_no_error(error);
    return s;
}

static void refuse(const char *kind, const params *p, const char *text)
{
    shape_place at = {.to_world = transform_identity()};
    GError *error = NULL;
    g_assert_null(shape_new(kind, p, &at, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_nonnull(strstr(error->message, text));
    g_error_free(error);
}

/* ---- Bilinear patches ---- */

static shape *make_patch(const float corners[12], const shape_place *at)
{
    g_autoptr(params) p = start();
    add_floats(p, PARAM_POINT3, "P", corners, 12);
    return make_shape("bilinearmesh", p, at);
}

/* A square patch is the square of two triangles. */
static void test_flat_patch_is_two_triangles(void)
{
    static const float corners[12] = {-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0};
    for (int i = 0; i < N_PLACES; i++) {
        shape_place at = place_at(i);
        shape *a = make_patch(corners, &at), *b = unit_square(&at);
        accel *patch = accel_of(&a, 1), *triangles = accel_of(&b, 1);
        g_assert_cmpfloat(fabsf(a->area - b->area), <, 1e-5f * b->area);
        unsigned n = 0;
        for (uint32_t k = 0; k < 2000; k++) {
            sampler s = sampler_make(11, k);
            ray r = random_ray(&s, &at.to_world);
            surface_hit x, y;
            bool met = accel_intersect(triangles, &r, &y);
            vec2 uv = y.uv;
            bool near_edge = met && (uv.x < 1e-3f || uv.y < 1e-3f);
            if (accel_intersect(patch, &r, &x) != met) {
                g_assert_true(near_edge || !met);
                continue;
            }
            if (!met)
                continue;
            float size = max_component3(abs3(y.p)) + y.t;
            g_assert_cmpfloat(length3(x.p - y.p), <, 2e-5f * size);
            g_assert_cmpfloat(length3(x.n_geom - y.n_geom), <, 1e-4f);
            n++;
        }
        g_assert_cmpuint(n, >, 300);
        accel_free(patch);
        accel_free(triangles);
        shape_free(a);
        shape_free(b);
    }
}

static const float twisted[12] = {-1,    -1,   0.3f,  1,    -0.8f, -0.6f,
                                  -0.9f, 1.2f, -0.5f, 1.1f, 1,     0.8f};

static vec3 twisted_point(float u, float v)
{
    vec3 c[4];
    for (int i = 0; i < 4; i++)
        c[i] = vec3_make(twisted[3 * i], twisted[3 * i + 1], twisted[3 * i + 2]);
    return (1 - v) * ((1 - u) * c[0] + u * c[1]) + v * ((1 - u) * c[2] + u * c[3]);
}

/* Rays at known points hit there, or nearer. */
static void test_patch_is_where_it_is(void)
{
    shape_place at = place_at(3);
    shape *s = make_patch(twisted, &at);
    accel *a = accel_of(&s, 1);
    unsigned exact = 0;
    for (uint32_t i = 0; i < 3000; i++) {
        sampler random = sampler_make(5, i);
        vec2 uv = sampler_2d(&random);
        vec3 p = transform_point(&at.to_world, twisted_point(uv.x, uv.y));
        vec3 d = warp_sphere(sampler_2d(&random));
        ray r = {p - 5.0f * d, d, INFINITY, 0, {{0}, 0}};
        surface_hit hit = {0};
        g_assert_true(accel_intersect(a, &r, &hit));
        g_assert_cmpfloat(hit.t, <, 5.0f + 1e-4f);
        vec3 again = transform_point(&at.to_world, twisted_point(hit.uv.x, hit.uv.y));
        g_assert_cmpfloat(length3(again - hit.p), <, 1e-5f);
        exact += fabsf(hit.t - 5.0f) < 1e-4f && fabsf(hit.uv.x - uv.x) < 1e-3f;
        /* Normal and tangent by differences. */
        float h = 1e-2f;
        vec3 du =
            twisted_point(hit.uv.x + h, hit.uv.y) - twisted_point(hit.uv.x - h, hit.uv.y);
        vec3 dv =
            twisted_point(hit.uv.x, hit.uv.y + h) - twisted_point(hit.uv.x, hit.uv.y - h);
        du = transform_vector(&at.to_world, du);
        dv = transform_vector(&at.to_world, dv);
        g_assert_cmpfloat(fabsf(dot3(hit.n_geom, normalize3(du))), <, 1e-4f);
        g_assert_cmpfloat(fabsf(dot3(hit.n_geom, normalize3(dv))), <, 1e-4f);
        g_assert_cmpfloat(length3(hit.dpdu - du / (2 * h)), <, 1e-3f);
        g_assert_cmpfloat(length3(hit.dpdv - dv / (2 * h)), <, 1e-3f);
        /* What leaves it does not meet it where it left. */
        ray off = hit_ray(&hit, dot3(d, hit.n_geom) < 0 ? hit.n_geom : -hit.n_geom);
        if (accel_intersect(a, &off, &hit))
            g_assert_cmpfloat(hit.t, >, 1e-3f);
    }
    g_assert_cmpuint(exact, >, 1500);
    accel_free(a);
    shape_free(s);
}

/* The area by a fine net, and samples uniform by it: chi-square over a grid in (u, v). */
static void test_patch_samples_are_uniform(void)
{
    enum { N = 6, NET = 40, SAMPLES = 40000 };
    shape_place at = place_at(5);
    shape *s = make_patch(twisted, &at);
    double expected[N][N] = {{0}}, total = 0, found[N][N] = {{0}}, chi2 = 0;
    for (int i = 0; i < N * NET; i++) {
        for (int k = 0; k < N * NET; k++) {
            float h = 0.5f / (N * NET), u = (float)(2 * i + 1) * h,
                  v = (float)(2 * k + 1) * h;
            vec3 du = twisted_point(u + h, v) - twisted_point(u - h, v);
            vec3 dv = twisted_point(u, v + h) - twisted_point(u, v - h);
            double cell = (double)length3(cross3(transform_vector(&at.to_world, du),
                                                 transform_vector(&at.to_world, dv)));
            expected[i / NET][k / NET] += cell;
            total += cell;
        }
    }
    g_assert_cmpfloat(fabs((double)s->area - total), <, 1e-4 * total);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        sampler random = sampler_make(77, i);
        float u = sampler_1d(&random);
        shape_sample x = shape_sample_area(s, u, sampler_2d(&random));
        g_assert_cmpfloat(fabsf(x.pdf * s->area - 1), <, 1e-5f);
        vec3 p = transform_point(&at.to_world, twisted_point(x.uv.x, x.uv.y));
        g_assert_cmpfloat(length3(p - x.p), <, 1e-6f);
        found[MIN((int)(x.uv.x * N), N - 1)][MIN((int)(x.uv.y * N), N - 1)] += 1;
    }
    for (int i = 0; i < N * N; i++) {
        double e = expected[i / N][i % N] / total * SAMPLES;
        chi2 += (found[i / N][i % N] - e) * (found[i / N][i % N] - e) / e;
    }
    g_assert_cmpfloat(chi2, <, chi2_limit(N * N - 1));
    shape_free(s);
}

static void test_patch_parameters(void)
{
    static const float corners[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0,
                                      1, 1, 0, 2, 0, 0, 2, 1, 0};
    static const int two[8] = {0, 1, 2, 3, 1, 4, 3, 5};
    static const float uv[12] = {0, 0, 0.5f, 0, 0, 3, 0.5f, 3, 1, 0, 1, 3};
    static const float down[18] = {0, 0, -1, 0, 0, -1, 0, 0, -1,
                                   0, 0, -1, 0, 0, -1, 0, 0, -1};
    shape_place at = {.to_world = transform_identity()};
    g_autoptr(params) p = start();
    add_floats(p, PARAM_POINT3, "P", corners, 18);
    g_assert_true(params_add_integers(p, here, PARAM_INTEGER, "indices", two, 8, NULL));
    add_floats(p, PARAM_POINT2, "uv", uv, 12);
    add_floats(p, PARAM_NORMAL, "N", down, 18);
    add_word(p, "emissionfilename", "lamp.png");
    const int faces[2] = {4, 5};
    params_add_integers(p, here, PARAM_INTEGER, "faceIndices", faces, 2, NULL);
    shape *s = make_shape("bilinearmesh", p, &at);
    accel *a = accel_of(&s, 1);
    ray r = {{1.5f, 0.25f, 3}, {0, 0, -1}, INFINITY, 0, {{0}, 0}};
    surface_hit hit;
    g_assert_true(accel_intersect(a, &r, &hit));
    g_assert_cmpuint(hit.primitive, ==, 1);
    g_assert_cmpfloat(fabsf(hit.uv.x - 0.75f) + fabsf(hit.uv.y - 0.75f), <, 1e-6f);
    g_assert_cmpfloat(hit.n[2], <, -0.999f);
    g_assert_cmpfloat(hit.n_geom[2], <, -0.999f);
    g_assert_cmpfloat(length3(hit.dpdu - vec3_make(2, 0, 0)), <, 1e-5f);
    accel_free(a);
    shape_free(s);
    g_autoptr(params) bad = start();
    add_floats(bad, PARAM_POINT3, "P", corners, 18);
    refuse("bilinearmesh", bad, "needs \"indices\"");
}

/* ---- Subdivision ---- */

static const float golden = 1.6180339887f;

static params *icosahedron(int levels)
{
    const float g = golden;
    const float points[36] = {-1, g,  0,  1, g, 0, -1, -g, 0,  1,  -g, 0,
                              0,  -1, g,  0, 1, g, 0,  -1, -g, 0,  1,  -g,
                              g,  0,  -1, g, 0, 1, -g, 0,  -1, -g, 0,  1};
    static const int faces[60] = {0, 11, 5, 0, 5,  1,  0,  1,  7,  0,  7, 10, 0, 10, 11,
                                  1, 5,  9, 5, 11, 4,  11, 10, 2,  10, 7, 6,  7, 1,  8,
                                  3, 9,  4, 3, 4,  2,  3,  2,  6,  3,  6, 8,  3, 8,  9,
                                  4, 9,  5, 2, 4,  11, 6,  2,  10, 8,  6, 7,  9, 8,  1};
    params *p = start();
    add_floats(p, PARAM_POINT3, "P", points, 36);
    g_assert_true(
        params_add_integers(p, here, PARAM_INTEGER, "indices", faces, 60, NULL));
    add_integer(p, "levels", levels);
    return p;
}

/* All twelve corners of an icosahedron have valence 5: their limit is
 * (1 - 5γ) v + γ Σ ring, γ = 1 / (5 + 3 / (8 β)), β = 3/40, and the ring's sum is √5 v.
 */
static void test_limit_of_the_icosahedron(void)
{
    shape_place at = {.to_world = transform_identity()};
    double gamma = 1.0 / (5.0 + 5.0);
    double corner = sqrt(1.0 + (double)golden * (double)golden);
    double limit = corner * (1.0 - 5.0 * gamma + gamma * sqrt(5.0));
    double before = 0;
    for (int levels = 0; levels <= 4; levels++) {
        g_autoptr(params) p = icosahedron(levels);
        shape *s = make_shape("loopsubdiv", p, &at);
        const mesh *m = s->kind->triangles(s->self);
        g_assert_cmpuint(m->n_triangles, ==, 20u << (2 * levels));
        g_assert_cmpuint(m->n_vertices, ==, (10u << (2 * levels)) + 2);
        for (size_t i = 0; i < 12; i++) {
            const float *v = m->positions + 3 * i, *n = m->normals + 3 * i;
            double length = sqrt((double)(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
            double along = -(double)(v[0] * n[0] + v[1] * n[1] + v[2] * n[2]) / length;
            g_assert_cmpfloat(fabs(length - limit), <, 1e-6);
            g_assert_cmpfloat(fabs(along - 1.0), <, 1e-6);
        }
        /* Finer meshes only fill in: the area settles. */
        double area = (double)s->area;
        if (levels > 2)
            g_assert_cmpfloat(fabs(area - before), <, 0.02 * area);
        before = area;
        shape_free(s);
    }
}

/* A flat square stays flat, and its boundary is the curve of its own: corners at the
 * limit 4/6 v + 1/6 (both neighbours), whatever the level. */
static void test_boundary_of_subdivision(void)
{
    static const float points[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    static const int faces[6] = {0, 1, 2, 0, 2, 3};
    shape_place at = {.to_world = transform_identity()};
    for (int levels = 0; levels < 4; levels++) {
        g_autoptr(params) p = start();
        add_floats(p, PARAM_POINT3, "P", points, 12);
        params_add_integers(p, here, PARAM_INTEGER, "indices", faces, 6, NULL);
        add_integer(p, "levels", levels);
        add_word(p, "scheme", "loop");
        shape *s = make_shape("loopsubdiv", p, &at);
        const mesh *m = s->kind->triangles(s->self);
        g_assert_cmpfloat(fabsf(m->positions[0] - 1 / 6.0f) +
                              fabsf(m->positions[1] - 1 / 6.0f),
                          <, 1e-6f);
        for (size_t i = 0; i < m->n_vertices; i++) {
            g_assert_cmpfloat(fabsf(m->positions[3 * i + 2]), <, 1e-7f);
            g_assert_cmpfloat(m->normals[3 * i + 2], <, -0.999f);
        }
        shape_free(s);
    }
}

static void test_subdivision_refuses(void)
{
    g_autoptr(params) deep = icosahedron(13);
    refuse("loopsubdiv", deep, "\"levels\"");
    static const float points[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0};
    static const int fan[9] = {0, 1, 2, 0, 1, 3, 1, 0, 4};
    g_autoptr(params) p = start();
    add_floats(p, PARAM_POINT3, "P", points, 15);
    params_add_integers(p, here, PARAM_INTEGER, "indices", fan, 9, NULL);
    refuse("loopsubdiv", p, "at most two triangles");
}

/* ---- Curves ---- */

static params *curve_params(const char *type, const float *points, size_t n, float width)
{
    params *p = start();
    add_word(p, "type", type);
    add_floats(p, PARAM_POINT3, "P", points, 3 * n);
    add_floats(p, PARAM_FLOAT, "width", &width, 1);
    return p;
}

static const float straight[12] = {0, 0, -1.2f, 0, 0, -0.5f, 0, 0, 0.2f, 0, 0, 0.9f};

/* A straight tube is pbrt's cylinder, wherever it stands. */
static void test_straight_tube_is_a_cylinder(void)
{
    for (int i = 0; i < N_PLACES; i++) {
        shape_place at = place_at(i);
        g_autoptr(params) p = curve_params("cylinder", straight, 4, 1.4f);
        shape *tube = make_shape("curve", p, &at);
        shape *cylinder = make(&quadrics[4], &at);
        accel *a = accel_of(&tube, 1), *b = accel_of(&cylinder, 1);
        g_assert_cmpfloat(fabsf(tube->area - cylinder->area), <, 5e-3f * cylinder->area);
        unsigned n = 0, differ = 0;
        for (uint32_t k = 0; k < 3000; k++) {
            sampler s = sampler_make(21, k);
            ray r = random_ray(&s, &at.to_world);
            surface_hit x, y;
            bool met = accel_intersect(b, &r, &y);
            if (accel_intersect(a, &r, &x) != met) {
                differ++;
                continue;
            }
            if (!met)
                continue;
            if (fabsf(x.t - y.t) > 1e-4f * y.t) {
                differ++;
                continue;
            }
            g_assert_cmpfloat(length3(x.n_geom - y.n_geom), <, 2e-3f);
            g_assert_cmpfloat(fabsf(dot3(x.n, normalize3(x.dpdu))), <, 1e-4f);
            n++;
        }
        g_assert_cmpuint(n, >, 700);
        g_assert_cmpuint(differ, <, 6); /* at the rim, and where rays graze */
        accel_free(a);
        accel_free(b);
        shape_free(tube);
        shape_free(cylinder);
    }
}

static const float bent[12] = {0,     0,    -1,   1.2f, 0.3f, -0.3f,
                               -0.8f, 0.8f, 0.4f, 0.2f, 0,    1.1f};

static vec3 bent_point(float u, vec3 *tangent)
{
    vec3 p[4];
    for (int i = 0; i < 4; i++)
        p[i] = vec3_make(bent[3 * i], bent[3 * i + 1], bent[3 * i + 2]);
    float v = 1 - u;
    *tangent = normalize3(v * v * (p[1] - p[0]) + 2 * u * v * (p[2] - p[1]) +
                          u * u * (p[3] - p[2]));
    return v * v * v * p[0] + 3 * u * v * v * p[1] + 3 * u * u * v * p[2] +
           u * u * u * p[3];
}

/* Rays at points of the tube's surface from outside of it meet it there or before; what
 * they meet lies on the tube, and its normal points out. */
static void test_bent_tube(void)
{
    const float r0 = 0.10f, r1 = 0.04f;
    shape_place at = {.to_world = transform_identity()};
    static const int splits[] = {0, 5, 20}; /* of 20, 8 are enough */
    for (size_t k = 0; k < G_N_ELEMENTS(splits); k++) {
        g_autoptr(params) p = start();
        add_word(p, "type", "cylinder");
        add_floats(p, PARAM_POINT3, "P", bent, 12);
        add_floats(p, PARAM_FLOAT, "width0", (const float[]){2 * r0}, 1);
        add_floats(p, PARAM_FLOAT, "width1", (const float[]){2 * r1}, 1);
        add_integer(p, "splitdepth", splits[k]);
        shape *s = make_shape("curve", p, &at);
        accel *a = accel_of(&s, 1);
        for (uint32_t i = 0; i < 4000; i++) {
            sampler random = sampler_make(31, i);
            float u = 0.01f + 0.98f * sampler_1d(&random);
            vec3 tangent, c = bent_point(u, &tangent);
            float angle = 2 * PI_F * sampler_1d(&random), radius = lerpf(r0, r1, u);
            frame f = frame_from_normal(tangent);
            vec3 n = f.s * cosf(angle) + f.t * sinf(angle);
            vec3 d = -normalize3(n + 0.8f * warp_sphere(sampler_2d(&random)));
            if (dot3(d, n) > -0.2f)
                continue;
            vec3 target = c + radius * n;
            ray r = {target - 4.0f * d, d, INFINITY, 0, {{0}, 0}};
            surface_hit hit = {0};
            g_assert_true(accel_intersect(a, &r, &hit));
            g_assert_cmpfloat(hit.t, <, 4.0f + 1e-4f);
            vec3 axis = bent_point(hit.uv.x, &tangent), off = hit.p - axis;
            float expected = lerpf(r0, r1, hit.uv.x);
            g_assert_cmpfloat(fabsf(length3(off) - expected), <, 1e-5f);
            g_assert_cmpfloat(fabsf(dot3(off, tangent)), <, 1e-5f);
            g_assert_cmpfloat(dot3(hit.n_geom, off) / expected, >, 0.98f);
            /* From inside only by way of an open end. */
            g_assert_true(dot3(hit.n_geom, d) < 1e-3f || hit.uv.x < 0.1f);
            g_assert_true(accel_occluded(a, &r));
            ray away = hit_ray(&hit, hit.n_geom);
            if (accel_intersect(a, &away, &hit))
                g_assert_cmpfloat(hit.t, >, 1e-2f);
        }
        accel_free(a);
        shape_free(s);
    }
}

/* A flat curve is as wide as it says from every side. */
static void test_flat_curve_width(void)
{
    shape_place at = place_at(2);
    g_autoptr(params) p = curve_params("flat", bent, 4, 0.1f);
    shape *s = make_shape("curve", p, &at);
    accel *a = accel_of(&s, 1);
    for (uint32_t i = 0; i < 2000; i++) {
        sampler random = sampler_make(41, i);
        vec3 tangent, c = bent_point(0.02f + 0.96f * sampler_1d(&random), &tangent);
        vec3 d = warp_sphere(sampler_2d(&random));
        if (fabsf(dot3(d, tangent)) > 0.5f)
            continue;
        vec3 side = normalize3(cross3(d, tangent));
        float off = 0.12f * (sampler_1d(&random) - 0.5f);
        vec3 o = transform_point(&at.to_world, c + off * side - 3.0f * d);
        vec3 to = transform_vector(&at.to_world, d);
        ray r = {o, normalize3(to), INFINITY, 0, {{0}, 0}};
        surface_hit hit;
        bool met = accel_intersect(a, &r, &hit);
        if (fabsf(off) < 0.0495f) {
            g_assert_true(met);
            g_assert_cmpfloat(dot3(hit.n_geom, r.direction), <, -0.5f);
            g_assert_cmpfloat(hit.error, >=, 0.19f);
        } else if (fabsf(off) > 0.051f && met) { /* another part of the curve */
            g_assert_cmpfloat(length3(hit.p - transform_point(&at.to_world, c)), >,
                              0.05f);
        }
        if (met)
            g_assert_true(hit.uv.x >= 0 && hit.uv.x <= 1 && hit.uv.y >= 0 &&
                          hit.uv.y <= 1);
    }
    accel_free(a);
    shape_free(s);
}

/* A straight ribbon with one normal is a rectangle; with two it turns evenly. */
static void test_ribbon(void)
{
    static const float flat[6] = {0, 1, 0, 0, 1, 0}, turning[6] = {0, 1, 0, 1, 0, 0};
    for (int twist = 0; twist < 2; twist++) {
        shape_place at = place_at(2);
        g_autoptr(params) p = curve_params("ribbon", straight, 4, 0.6f);
        add_floats(p, PARAM_NORMAL, "N", twist ? turning : flat, 6);
        shape *s = make_shape("curve", p, &at);
        accel *a = accel_of(&s, 1);
        for (uint32_t i = 0; i < 2000; i++) {
            sampler random = sampler_make(51, i);
            float u = 0.01f + 0.98f * sampler_1d(&random),
                  angle = twist ? u * PI_F / 2 : 0;
            float side = 0.31f * (2 * sampler_1d(&random) - 1);
            vec3 n = vec3_make(sinf(angle), cosf(angle), 0);
            vec3 across = cross3(n, vec3_make(0, 0, 1));
            vec3 target = vec3_make(0, 0, lerpf(-1.2f, 0.9f, u)) + side * across;
            vec3 d = normalize3(n + 0.5f * warp_sphere(sampler_2d(&random)));
            ray r = {transform_point(&at.to_world, target + 0.5f * d),
                     -normalize3(transform_vector(&at.to_world, d)),
                     INFINITY,
                     0,
                     {{0}, 0}};
            surface_hit hit;
            bool met = accel_intersect(a, &r, &hit);
            if (fabsf(side) < 0.299f) {
                g_assert_true(met);
                vec3 p_world = transform_point(&at.to_world, target);
                if (!twist)
                    g_assert_cmpfloat(length3(hit.p - p_world), <, 1e-5f);
                if (length3(hit.p - p_world) < 1e-4f && fabsf(side) < 0.05f) {
                    vec3 expected = normalize3(transform_normal(&at.to_world, n));
                    g_assert_cmpfloat(dot3(hit.n_geom, expected), >, 0.98f);
                    g_assert_cmpfloat(fabsf(hit.uv.x - u), <, 1e-3f);
                }
            } else if (!twist && fabsf(side) > 0.301f) {
                g_assert_false(met);
            }
        }
        accel_free(a);
        shape_free(s);
    }
}

/* The same curve by another basis or degree is the same curve. */
static void test_bases_and_degrees(void)
{
    static const float parabola[9] = {-1, 0, 0, 0, 2, 0, 1, 0, 0};
    static const float raised[12] = {-1,       0,        0, -1.0f / 3, 4.0f / 3, 0,
                                     1.0f / 3, 4.0f / 3, 0, 1,         0,        0};
    static const float spline2[9] = {-2, -2, 0, 0, 2, 0, 2, -2, 0}; /* the parabola */
    static const float spline[15] = {-2, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0};
    static const float line[6] = {-1, 0, 0, 1, 0, 0};
    (void)line;
    shape_place at = {.to_world = transform_identity()};
    g_autoptr(params) a = curve_params("cylinder", raised, 4, 0.2f);
    g_autoptr(params) b = curve_params("cylinder", parabola, 3, 0.2f);
    g_autoptr(params) c = curve_params("cylinder", spline2, 3, 0.2f);
    g_autoptr(params) d = curve_params("cylinder", spline, 5, 0.2f);
    add_integer(b, "degree", 2);
    add_integer(c, "degree", 2);
    add_word(c, "basis", "bspline");
    add_word(d, "basis", "bspline");
    shape *same[3] = {make_shape("curve", a, &at), make_shape("curve", b, &at),
                      make_shape("curve", c, &at)};
    shape *row = make_shape("curve", d, &at);
    accel *by[3];
    for (int i = 0; i < 3; i++)
        by[i] = accel_of(&same[i], 1);
    for (uint32_t k = 0; k < 1000; k++) {
        sampler s = sampler_make(61, k);
        transform identity = transform_identity();
        ray r = random_ray(&s, &identity);
        surface_hit x, y;
        bool met = accel_intersect(by[0], &r, &x);
        for (int i = 1; i < 3; i++) {
            g_assert_cmpint(accel_intersect(by[i], &r, &y), ==, met);
            if (met)
                g_assert_cmpfloat(length3(x.p - y.p), <, 1e-5f);
        }
    }
    /* Points evenly in a row make a straight spline from the second to the last but one.
     */
    box3 box = row->kind->bounds(row->self);
    g_assert_cmpfloat(fabsf(box.low[0] + 1.1f), <, 1e-3f);
    g_assert_cmpfloat(fabsf(box.high[0] - 1.1f), <, 1e-3f);
    g_assert_cmpuint(row->kind->n_primitives(row->self), ==, 2 * 8);
    for (int i = 0; i < 3; i++) {
        accel_free(by[i]);
        shape_free(same[i]);
    }
    shape_free(row);
}

static void test_curve_refuses(void)
{
    g_autoptr(params) five = curve_params("flat", (const float[15]){0, 0, 0, 1}, 5, 1);
    refuse("curve", five, "\"P\" of a curve");
    g_autoptr(params) thin = curve_params("flat", straight, 4, 0);
    refuse("curve", thin, "\"width\"");
    g_autoptr(params) bare = curve_params("ribbon", straight, 4, 1);
    refuse("curve", bare, "\"N\"");
    g_autoptr(params) square = curve_params("square", straight, 4, 1);
    refuse("curve", square, "square");
    g_autoptr(params) four = curve_params("flat", straight, 4, 1);
    add_integer(four, "degree", 4);
    refuse("curve", four, "\"degree\"");
}

/* ---- Cut-outs ---- */

/* Of rays at a surface of opacity a, the share a is stopped: by every query, and by the
 * near side before the far one. A thousand times over, within five standard errors. */
static void test_cut_outs_stop_their_share(void)
{
    const float_input third = {.constant = 0.3f};
    shape_place at = {.to_world = transform_identity(), .alpha = &third};
    static const float corners[12] = {-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0};
    shape *subjects[3] = {unit_square(&at), make_patch(corners, &at),
                          make(&quadrics[0], &at)};
    for (int k = 0; k < 3; k++) {
        accel *a = accel_of(&subjects[k], 1);
        unsigned stopped = 0, hidden = 0, second = 0, solid = 0, n = 20000;
        for (uint32_t i = 0; i < n; i++) {
            sampler random = sampler_make(71, i);
            vec2 u = sampler_2d(&random);
            ray r = {{u.x - 0.5f, u.y - 0.5f, 4}, {0, 0, -1}, INFINITY, 0, {{0}, 0}};
            surface_hit hit, again;
            bool met = accel_intersect(a, &r, &hit);
            stopped += met && hit.p[2] > -1e-3f;
            second += met && hit.p[2] < -1e-3f;
            hidden += accel_occluded(a, &r);
            solid += accel_intersect_solid(a, &r, &again);
            if (met) { /* the same every time */
                g_assert_true(accel_intersect(a, &r, &again));
                g_assert_cmpfloat(fabsf(again.t - hit.t), <, 1e-7f);
                g_assert_true(accel_occluded(a, &r));
            }
        }
        double tolerance = 5 * sqrt(0.3 * 0.7 * n);
        g_assert_cmpfloat(fabs(stopped - 0.3 * n), <, tolerance);
        g_assert_cmpuint(hidden, ==, stopped + second);
        g_assert_cmpuint(solid, ==, n);
        if (k == 2)
            g_assert_cmpfloat(fabs(second - 0.7 * 0.3 * n), <, tolerance);
        accel_free(a);
        shape_free(subjects[k]);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/surface/patch/flat", test_flat_patch_is_two_triangles);
    g_test_add_func("/surface/patch/twisted", test_patch_is_where_it_is);
    g_test_add_func("/surface/patch/samples", test_patch_samples_are_uniform);
    g_test_add_func("/surface/patch/parameters", test_patch_parameters);
    g_test_add_func("/surface/subdivision/limit", test_limit_of_the_icosahedron);
    g_test_add_func("/surface/subdivision/boundary", test_boundary_of_subdivision);
    g_test_add_func("/surface/subdivision/refuses", test_subdivision_refuses);
    g_test_add_func("/surface/curve/straight", test_straight_tube_is_a_cylinder);
    g_test_add_func("/surface/curve/bent", test_bent_tube);
    g_test_add_func("/surface/curve/flat", test_flat_curve_width);
    g_test_add_func("/surface/curve/ribbon", test_ribbon);
    g_test_add_func("/surface/curve/bases", test_bases_and_degrees);
    g_test_add_func("/surface/curve/refuses", test_curve_refuses);
    g_test_add_func("/surface/cutout", test_cut_outs_stop_their_share);
    return g_test_run();
}
