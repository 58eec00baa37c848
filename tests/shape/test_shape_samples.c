/*
 * shape: areas and samples agree with the parametrisation summed up in small steps, and
 * samples toward a point with the solid angle seen from there.
 *
 * Statistical tests: chi-square below its 1 - 1e-6 quantile.
 */
#include "shape_subjects.h"

/* ---- Areas and samples ---- */

enum { BINS = 8, STEPS = 48 };

/* The surface at parameters a, b in 0..1, as pbrt parametrises it, in the world. */
static void parametric(const subject *s, const transform *t, double a, double b,
                       double out[3])
{
    double phi = a * (double)s->phi_max * G_PI / 180, r = (double)s->radius, z;
    if (strcmp(s->kind, "sphere") == 0) {
        double low = acos((double)(s->z_min / s->radius));
        double theta = low + b * (acos((double)(s->z_max / s->radius)) - low);
        z = r * cos(theta);
        r *= sin(theta);
    } else if (strcmp(s->kind, "disk") == 0) {
        z = (double)s->z_min;
        r += b * ((double)s->inner - r);
    } else {
        z = (double)s->z_min + b * (double)(s->z_max - s->z_min);
    }
    const double p[3] = {r * cos(phi), r * sin(phi), z};
    for (int i = 0; i < 3; i++)
        out[i] = t->m[i][3] + t->m[i][0] * p[0] + t->m[i][1] * p[1] + t->m[i][2] * p[2];
}

static double area_of_step(const subject *s, const transform *t, double a, double b,
                           double step)
{
    double p[4][3], e[3], f[3], c[3];
    for (int i = 0; i < 4; i++)
        parametric(s, t, a + (i & 1 ? step : 0), b + (i & 2 ? step : 0), p[i]);
    for (int k = 0; k < 3; k++) { /* diagonals */
        e[k] = p[3][k] - p[0][k];
        f[k] = p[2][k] - p[1][k];
    }
    cross_double(e, f, c);
    return 0.5 * sqrt(dot_double(c, c));
}

static double area_of_bins(const subject *s, const transform *t, double area[BINS * BINS])
{
    double total = 0, step = 1.0 / (BINS * STEPS);
    for (int i = 0; i < BINS * STEPS; i++) {
        for (int k = 0; k < BINS * STEPS; k++) {
            double piece = area_of_step(s, t, i * step, k * step, step);
            area[i / STEPS * BINS + k / STEPS] += piece;
            total += piece;
        }
    }
    return total;
}

static int bin_of(float x)
{
    return CLAMP((int)(x * BINS), 0, BINS - 1);
}

static void test_area_and_uniform_samples(void)
{
    enum { N = 20000 };
    for (size_t i = 0; i < G_N_ELEMENTS(quadrics); i++) {
        for (int k = 2; k < N_PLACES - 1; k++) {
            shape_place at = place_at(k);
            shape *s = make(&quadrics[i], &at);
            double expected[BINS * BINS] = {0};
            double total = area_of_bins(&quadrics[i], &at.to_world, expected);
            g_assert_cmpfloat(fabs((double)s->area / total - 1), <, 2e-4);
            unsigned count[BINS * BINS] = {0};
            for (uint32_t n = 0; n < N; n++) {
                sampler random = sampler_make(31 + i, n);
                random.dimension = 40;
                float u = sampler_1d(&random);
                shape_sample at_random = shape_sample_area(s, u, sampler_2d(&random));
                count[bin_of(at_random.uv.x) * BINS + bin_of(at_random.uv.y)]++;
                g_assert_cmpfloat(fabsf(at_random.pdf * s->area - 1), <, 1e-5);
            }
            double chi2 = 0;
            for (int b = 0; b < BINS * BINS; b++) {
                double mean = N * expected[b] / total;
                chi2 += (count[b] - mean) * (count[b] - mean) / mean;
            }
            g_assert_cmpfloat(chi2, <, chi2_limit(BINS * BINS - 1));
            shape_free(s);
        }
    }
}

static void test_mesh_samples_are_uniform(void)
{
    enum { N = 100000 };
    shape_place at = place_at(4);
    mesh m = random_soup(5);
    shape *s = shape_new_mesh(&m, &at, here, NULL);
    const float *p = shape_mesh.triangles(s->self)->positions;
    double total = 0, expected[SOUP];
    for (int i = 0; i < SOUP; i++) {
        vec3 c[3];
        for (int k = 0; k < 3; k++)
            c[k] =
                vec3_make(p[9 * i + 3 * k], p[9 * i + 3 * k + 1], p[9 * i + 3 * k + 2]);
        expected[i] = 0.5 * (double)length3(cross3(c[1] - c[0], c[2] - c[0]));
        total += expected[i];
    }
    g_assert_cmpfloat(fabs((double)s->area / total - 1), <, 1e-5);
    unsigned count[4 * SOUP] = {0}; /* the three corners and the middle of each */
    for (uint32_t n = 0; n < N; n++) {
        sampler random = sampler_make(41, n);
        random.dimension = 40;
        float u = sampler_1d(&random);
        shape_sample to = shape_sample_area(s, u, sampler_2d(&random));
        float b[3] = {1 - to.uv.x, to.uv.x - to.uv.y, to.uv.y};
        int part = b[0] > 0.5f ? 0 : b[1] > 0.5f ? 1 : b[2] > 0.5f ? 2 : 3;
        count[4 * to.primitive + (uint32_t)part]++;
    }
    double chi2 = 0;
    for (int i = 0; i < 4 * SOUP; i++) {
        double mean = N * expected[i / 4] / (4 * total);
        chi2 += (count[i] - mean) * (count[i] - mean) / mean;
    }
    g_assert_cmpfloat(chi2, <, chi2_limit(4 * SOUP - 1));
    shape_free(s);
}

/* The mean of 1/pdf over samples toward a point is the solid angle. */
static double solid_angle(const shape *s, vec3 ref)
{
    enum { N = 1 << 14 };
    double sum = 0;
    for (uint32_t n = 0; n < N; n++) {
        sampler random = sampler_make(51, n);
        shape_sample at;
        vec2 u = sampler_2d(&random);
        if (!shape_sample_toward(s, ref, sampler_1d(&random), u, &at))
            continue;
        surface_hit hit = {.p = at.p, .n_geom = at.n, .primitive = at.primitive};
        g_assert_cmpfloat(fabsf(shape_pdf_toward(s, ref, &hit) / at.pdf - 1), <, 1e-3);
        sum += 1 / (double)at.pdf;
    }
    return sum / N;
}

static void test_solid_angles(void)
{
    shape_place at = {.to_world = transform_identity()};
    shape *disk = make(&(subject){"disk", 1, 0, 0, 360, 0}, &at);
    double expected = 2 * G_PI * (1 - 0.5 / sqrt(1.25));
    g_assert_cmpfloat(fabs(solid_angle(disk, vec3_make(0, 0, 0.5f)) / expected - 1), <,
                      1e-3);
    shape_free(disk);
    const subject ball = {"sphere", 2, -2, 2, 360, 0};
    shape *sphere = make(&ball, &at);
    for (int i = 0; i < 5; i++) {
        const double distance[5] = {2.001, 2.5, 10, 1e4, 1e6};
        double sine = 2 / distance[i];
        expected = 2 * G_PI * sine * sine / (1 + sqrt(1 - sine * sine));
        vec3 ref = vec3_make(0, (float)distance[i], 0);
        g_assert_cmpfloat(fabs(solid_angle(sphere, ref) / expected - 1), <, 1e-3);
    }
    g_assert_cmpfloat(
        fabs(solid_angle(sphere, vec3_make(0.5f, 0.5f, 0)) / (4 * G_PI) - 1), <, 1e-3);
    shape_free(sphere);
    shape *square_shape = unit_square(&at);
    for (int i = 0; i < 4; i++) { /* close: each triangle half the view; far: tiny */
        const double height[4] = {0.05, 0.5, 3, 200};
        expected = 4 * asin(1 / (1 + height[i] * height[i]));
        vec3 ref = vec3_make(0, 0, (float)height[i]);
        g_assert_cmpfloat(fabs(solid_angle(square_shape, ref) / expected - 1), <, 1e-3);
    }
    shape_free(square_shape);
}

/* ---- Rectangles ---- */

/* That the part of a rectangle in its own axes fills, seen from the origin, z off. */
static double angle_of_part(double x0, double x1, double y0, double y1, double z)
{
    const double x[2] = {x0, x1}, y[2] = {y0, y1};
    double sum = 0;
    for (int i = 0; i < 4; i++) {
        double a = x[i & 1], b = y[i >> 1];
        sum += (i == 0 || i == 3 ? 1 : -1) * atan2(a * b, z * sqrt(a * a + b * b + z * z));
    }
    return sum;
}

/* Samples of the square [-1, 1]² toward ref are uniform by solid angle. */
static void check_rectangle(const shape *s, vec3 ref)
{
    enum { N = 20000 };
    unsigned count[BINS * BINS] = {0};
    double x = (double)ref[0], y = (double)ref[1], z = (double)ref[2], chi2 = 0;
    double whole = angle_of_part(-1 - x, 1 - x, -1 - y, 1 - y, z);
    for (uint32_t n = 0; n < N; n++) {
        sampler random = sampler_make(71, n);
        random.dimension = 40;
        shape_sample to;
        vec2 u = sampler_2d(&random);
        g_assert_true(shape_sample_toward(s, ref, sampler_1d(&random), u, &to));
        g_assert_cmpfloat(fabs((double)to.pdf * whole - 1), <, 1e-5);
        g_assert_cmpfloat(fabsf(to.n[2] - 1), <, 1e-6f);
        const surface_hit hit = {.p = to.p, .n_geom = to.n, .primitive = to.primitive};
        g_assert_cmpfloat(fabsf(shape_pdf_toward(s, ref, &hit) / to.pdf - 1), <, 1e-6f);
        count[bin_of(0.5f + 0.5f * to.p[0]) * BINS + bin_of(0.5f + 0.5f * to.p[1])]++;
    }
    for (int i = 0; i < BINS * BINS; i++) {
        double a = -1 + i / BINS * 2.0 / BINS - x, b = -1 + i % BINS * 2.0 / BINS - y;
        double mean = N * angle_of_part(a, a + 2.0 / BINS, b, b + 2.0 / BINS, z) / whole;
        chi2 += (count[i] - mean) * (count[i] - mean) / mean;
    }
    g_assert_cmpfloat(chi2, <, chi2_limit(BINS * BINS - 1));
}

static shape *two_triangles(const int indices[6])
{
    static const float points[18] = {-1, -1, 0, 1, -1, 0, 1, 1, 0,
                                     -1, 1,  0, 1, 1,  0, -1, -1, 0};
    const shape_place at = {.to_world = transform_identity()};
    g_autoptr(params) p = params_new(here, "/", NULL);
    params_add_numbers(p, here, PARAM_POINT3, "P", points, 18, NULL);
    params_add_integers(p, here, PARAM_INTEGER, "indices", indices, 6, NULL);
    return shape_new("trianglemesh", p, &at, NULL);
}

static shape *square_patch(void)
{
    static const float points[12] = {-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0};
    const shape_place at = {.to_world = transform_identity()};
    g_autoptr(params) p = params_new(here, "/", NULL);
    params_add_numbers(p, here, PARAM_POINT3, "P", points, 12, NULL);
    return shape_new("bilinearmesh", p, &at, NULL);
}

static void test_rectangle_samples(void)
{
    /* whichever corner comes first, and whether they share vertices or only places */
    static const int indices[4][6] = {
        {0, 1, 2, 0, 2, 3}, {2, 0, 1, 3, 0, 2}, {1, 2, 0, 4, 3, 5}, {3, 0, 1, 2, 3, 1}};
    const vec3 refs[4] = {vec3_make(0.2f, -0.1f, 0.3f), vec3_make(0.5f, 0.9f, 3.0f),
                          vec3_make(1.5f, 0.3f, 0.05f), vec3_make(2.5f, -3.0f, 0.8f)};
    for (int i = 0; i < 5; i++) {
        shape *s = i < 4 ? two_triangles(indices[i]) : square_patch();
        for (int k = 0; k < 4; k++)
            check_rectangle(s, refs[k]);
        shape_free(s);
    }
}

/* Triangles that face two ways are no rectangle: each keeps its own normal. */
static void test_folded_is_no_rectangle(void)
{
    static const int indices[6] = {0, 1, 2, 0, 3, 2};
    shape *s = two_triangles(indices);
    unsigned n_up = 0;
    for (uint32_t n = 0; n < 64; n++) {
        sampler random = sampler_make(81, n);
        shape_sample to;
        vec2 u = sampler_2d(&random);
        float u_primitive = sampler_1d(&random);
        g_assert_true(
            shape_sample_toward(s, vec3_make(0, 0, 0.5f), u_primitive, u, &to));
        g_assert_true((to.n[2] > 0) == (to.primitive == 0));
        n_up += to.n[2] > 0;
    }
    g_assert_cmpuint(n_up, >, 16);
    g_assert_cmpuint(n_up, <, 48);
    shape_free(s);
}

/* Toward a sphere, a ray in the sampled direction first meets the sampled point. */
static void test_sphere_samples_are_seen(void)
{
    shape_place at = place_at(3);
    shape *s = make(&quadrics[0], &at);
    accel *a = accel_of(&s, 1);
    for (uint32_t n = 0; n < 2000; n++) {
        sampler random = sampler_make(61, n);
        vec3 ref = vec3_make(0.3f, -0.7f, 0.2f) +
                   (1.4f + 20 * sampler_1d(&random)) * warp_sphere(sampler_2d(&random));
        shape_sample to;
        vec2 u = sampler_2d(&random);
        g_assert_true(shape_sample_toward(s, ref, 0.5f, u, &to));
        ray r = {ref, normalize3(to.p - ref), INFINITY, 0, {{0}, 0}};
        surface_hit hit;
        if (u.x > 0.999f) /* grazing */
            continue;
        g_assert_true(accel_intersect(a, &r, &hit));
        g_assert_cmpfloat(length3(hit.p - to.p), <, 1e-3);
    }
    accel_free(a);
    shape_free(s);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/shape-samples/area", test_area_and_uniform_samples);
    g_test_add_func("/shape-samples/mesh/samples", test_mesh_samples_are_uniform);
    g_test_add_func("/shape-samples/solid-angle", test_solid_angles);
    g_test_add_func("/shape-samples/rectangle", test_rectangle_samples);
    g_test_add_func("/shape-samples/rectangle/folded", test_folded_is_no_rectangle);
    g_test_add_func("/shape-samples/sphere/seen", test_sphere_samples_are_seen);
    return g_test_run();
}
