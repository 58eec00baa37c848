/*
 * math: transforms invert, warps have the density they claim, and sampler points are
 * (0,2)-nets.
 */
#include "math/cone.h"
#include "math/distribution.h"
#include "math/frame.h"
#include "math/median.h"
#include "math/noise.h"
#include "math/sampler.h"
#include "math/transform.h"
#include "math/warp.h"

#include <glib.h>
#include <stdlib.h>
#include <string.h>

static void test_transform_inverts(void)
{
    transform a = transform_translate(1, 2, 3), b = transform_rotate(33, 1, 1, 0.5);
    transform c = transform_scale(2, -3, 0.5), t = transform_multiply(&a, &b);
    t = transform_multiply(&t, &c);
    transform back = transform_inverse(&t), unit = transform_multiply(&t, &back);
    transform identity = transform_identity();
    g_assert_true(transform_equal(&unit, &identity));
    g_assert_true(transform_swaps_handedness(&t));
    g_assert_false(transform_swaps_handedness(&b));
}

static void test_rotation_turns_counter_clockwise(void)
{
    transform t = transform_rotate(90, 0, 0, 1);
    vec3 y = transform_vector(&t, vec3_make(1, 0, 0));
    g_assert_cmpfloat(length3(y - vec3_make(0, 1, 0)), <, 1e-6);
}

static void test_look_at(void)
{
    const double eye[3] = {1, 2, 3}, target[3] = {4, 2, 3}, up[3] = {0, 1, 0};
    transform t;
    g_assert_true(transform_look_at(eye, target, up, &t));
    g_assert_cmpfloat(length3(transform_point(&t, vec3_make(1, 2, 3))), <, 1e-6);
    vec3 ahead = transform_point(&t, vec3_make(3, 2, 3));
    g_assert_cmpfloat(length3(ahead - vec3_make(0, 0, 2)), <, 1e-6);
    g_assert_false(transform_look_at(eye, eye, up, &t));
}

/* Every 2^m points of a stream fall one into each elementary interval of area 2^-m. */
static void check_net(const sampler *points, unsigned dimension, unsigned m)
{
    for (unsigned a = 0; a <= m; a++) {
        unsigned char filled[1024] = {0};
        for (uint32_t i = 0; i < 1u << m; i++) {
            sampler s = sampler_make(points->key, points->index + i);
            s.dimension = dimension;
            vec2 u = sampler_2d(&s);
            unsigned x = (unsigned)(u.x * (float)(1u << a));
            unsigned y = (unsigned)(u.y * (float)(1u << (m - a)));
            filled[(x << (m - a)) + y]++;
        }
        for (unsigned i = 0; i < 1u << m; i++)
            g_assert_cmpuint(filled[i], ==, 1);
    }
}

static void test_sampler_pairs_are_nets(void)
{
    for (uint64_t key = 0; key < 10; key++) {
        sampler s = {.key = key * 77, .index = 0};
        for (unsigned dimension = 0; dimension < 8; dimension += 2)
            check_net(&s, dimension, 8);
        s.index = 1024;
        check_net(&s, 0, 10);
    }
}

static bool same_bits(float a, float b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

static void test_sampler_side_by_side_is_one_by_one(void)
{
    for (uint32_t i = 0; i < 2000; i++) {
        sampler one = sampler_make(i % 7, i * 2654435761u), four = one;
        for (int draw = 0; draw < 6; draw++) { /* past the last stratified dimension */
            float lobe = sampler_1d(&one);
            vec2 direction = sampler_2d(&one);
            float roulette = sampler_1d(&one);
            scatter_numbers s = sampler_scatter(&four);
            g_assert_true(same_bits(s.lobe, lobe) && same_bits(s.roulette, roulette));
            g_assert_true(same_bits(s.direction.x, direction.x) &&
                          same_bits(s.direction.y, direction.y));
            float light = sampler_1d(&one), primitive = sampler_1d(&one);
            vec2 place = sampler_2d(&one);
            light_numbers l = sampler_light(&four);
            g_assert_true(same_bits(l.light, light) && same_bits(l.primitive, primitive));
            g_assert_true(same_bits(l.place.x, place.x) && same_bits(l.place.y, place.y));
        }
        g_assert_cmpuint(one.dimension, ==, four.dimension);
    }
}

/* Numbers known ahead are those that a stream draws by itself; a stranger to them draws
   its own. */
static void test_sampler_ahead_is_as_drawn(void)
{
    const uint64_t firsts[3] = {0, 12345, UINT32_MAX - 5};
    for (int i = 0; i < 3; i++) {
        const sampler first = sampler_make(9, firsts[i]);
        sampler_ahead ahead;
        sampler_look_ahead(&first, &ahead);
        for (uint64_t k = 0; k < 2 * AHEAD_STREAMS; k++) {
            sampler one = sampler_make(9, firsts[i] + k), with = one;
            sampler_use_ahead(&with, &ahead);
            bool is_known = k < AHEAD_STREAMS && with.key == ahead.key;
            g_assert_true((with.ahead == &ahead) == is_known);
            light_numbers l = sampler_light(&one), m = sampler_light(&with);
            vec2 u = sampler_2d(&one), v = sampler_2d(&with);
            g_assert_true(same_bits(l.light, m.light));
            g_assert_true(same_bits(l.primitive, m.primitive));
            g_assert_true(same_bits(l.place.x, m.place.x));
            g_assert_true(same_bits(l.place.y, m.place.y));
            g_assert_true(same_bits(u.x, v.x) && same_bits(u.y, v.y));
            for (int draw = 0; draw < 2; draw++) {
                scatter_numbers s = sampler_scatter(&one), t = sampler_scatter(&with);
                g_assert_true(same_bits(s.lobe, t.lobe));
                g_assert_true(same_bits(s.roulette, t.roulette));
                g_assert_true(same_bits(s.direction.x, t.direction.x));
                g_assert_true(same_bits(s.direction.y, t.direction.y));
            }
            g_assert_cmpuint(one.dimension, ==, with.dimension);
        }
    }
}

static void test_sampler_is_uniform_and_uncorrelated(void)
{
    enum { N = 1 << 14 };
    for (unsigned dimension = 0; dimension < 40; dimension += 7) {
        double sum = 0, product = 0;
        for (uint32_t i = 0; i < N; i++) {
            sampler s = sampler_make(5, i);
            s.dimension = dimension;
            double a = (double)sampler_1d(&s), b = (double)sampler_1d(&s);
            sum += a;
            product += (a - 0.5) * (b - 0.5);
        }
        /* six standard errors of independent numbers: false alarm below 1e-8 */
        g_assert_cmpfloat(fabs(sum / N - 0.5), <, 6 * 0.289 / 128);
        g_assert_cmpfloat(fabs(product / N), <, 6 * 0.0833 / 128);
    }
}

static void test_warps_integrate(void)
{
    enum { N = 1 << 14 };
    double z_sphere = 0, z2_sphere = 0, z_cosine = 0, z_cone = 0, r2_disk = 0,
           b_triangle = 0;
    for (uint32_t i = 0; i < N; i++) {
        sampler s = sampler_make(9, i);
        vec2 u = sampler_2d(&s);
        float z = warp_sphere(u)[2];
        z_sphere += (double)z;
        z2_sphere += (double)(z * z);
        z_cosine += (double)warp_cosine_hemisphere(u)[2];
        z_cone += (double)warp_cone(u, 0.5f)[2];
        vec2 d = warp_disk(u);
        r2_disk += (double)(d.x * d.x + d.y * d.y);
        vec2 b = warp_triangle(u);
        b_triangle += (double)(b.x * b.y);
        g_assert_cmpfloat(fabsf(length3(warp_sphere(u)) - 1.0f), <, 1e-5);
        g_assert_true(b.x >= 0 && b.y >= 0 && b.x + b.y <= 1.000001f);
    }
    g_assert_cmpfloat(fabs(z_sphere / N), <, 1e-3);
    g_assert_cmpfloat(fabs(z2_sphere / N - 1.0 / 3), <, 1e-3);
    g_assert_cmpfloat(fabs(z_cosine / N - 2.0 / 3), <, 1e-3);
    g_assert_cmpfloat(fabs(z_cone / N - 0.75), <, 1e-3);
    g_assert_cmpfloat(fabs(r2_disk / N - 0.5), <, 1e-3);
    g_assert_cmpfloat(fabs(b_triangle / N - 1.0 / 12), <, 1e-3);
}

static void test_frames_are_orthonormal(void)
{
    for (uint32_t i = 0; i < 1000; i++) {
        sampler s = sampler_make(3, i);
        vec3 n = warp_sphere(sampler_2d(&s)), tangent = warp_sphere(sampler_2d(&s));
        frame f = i % 2 ? frame_from_normal(n) : frame_from_tangent(n, tangent);
        g_assert_cmpfloat(fabsf(dot3(f.s, f.t)) + fabsf(dot3(f.s, f.n)), <, 1e-5);
        g_assert_cmpfloat(length3(cross3(f.s, f.t) - f.n), <, 1e-5);
    }
}

static void test_distribution_follows_its_weights(void)
{
    const float weights[5] = {1, 0, 3, 0, 4};
    distribution d;
    g_assert_true(distribution_init(&d, weights, 5, NULL));
    unsigned count[5] = {0};
    for (unsigned i = 0; i < 8000; i++) {
        float u = ((float)i + 0.5f) / 8000.0f;
        count[distribution_sample(&d, &u)]++;
        g_assert_true(u >= 0.0f && u < 1.0f);
    }
    for (unsigned i = 0; i < 5; i++)
        g_assert_cmpfloat(fabs(count[i] / 8000.0 - (double)distribution_pdf(&d, i)), <,
                          1e-3);
    distribution_clear(&d);
}

/* What a walk from the first weight finds, for many weights and numbers of all kinds. */
static void test_distribution_picks_by_definition(void)
{
    static const size_t sizes[] = {1, 2, 3, 7, 64, 1000, 4097};
    for (size_t k = 0; k < G_N_ELEMENTS(sizes); k++) {
        g_autofree float *weights = g_new0(float, sizes[k]);
        for (size_t i = 0; i < sizes[k]; i++)
            weights[i] = i % 5 == 1 ? 0.0f : powf(10.0f, (float)(i * 7 % 11) - 5.0f);
        distribution d;
        g_assert_true(distribution_init(&d, weights, sizes[k], NULL));
        for (uint32_t j = 0; j < 3000; j++) {
            sampler s = sampler_make(5, j);
            float u = j < 1024 ? (float)j / 1024.0f : sampler_1d(&s);
            u = j == 1024 ? 0x1.fffffep-1f : u;
            double target = (double)u * distribution_total(&d);
            size_t expected = 0;
            while (expected + 1 < d.n && d.cumulative[expected + 1] <= target)
                expected++;
            while (expected > 0 && !(weights[expected] > 0.0f))
                expected--;
            g_assert_cmpuint(distribution_sample(&d, &u), ==, expected);
        }
        distribution_clear(&d);
    }
}

/* Perlin's gradients (2002): at whole points noise is zero and rises along one of the
   twelve directions to the edges of a cube, all of which occur. */
static void test_noise_has_perlins_gradients(void)
{
    bool seen[3][3][3] = {{{false}}};
    int n_seen = 0;
    for (int i = 0; i < 1000; i++) {
        vec3 p = vec3_make((float)(i % 10), (float)(i / 10 % 10), (float)(i / 100));
        int component[3], n_zero = 0;
        g_assert_cmpfloat(fabsf(noise3(p)), <, 1e-6f);
        for (int k = 0; k < 3; k++) {
            vec3 step = {0};
            step[k] = 1.0f / 64;
            float slope = 32 * (noise3(p + step) - noise3(p - step));
            component[k] = (int)roundf(slope);
            g_assert_cmpfloat(fabsf(slope - (float)component[k]), <, 0.05f);
            g_assert_cmpint(abs(component[k]), <=, 1);
            n_zero += component[k] == 0;
        }
        g_assert_cmpint(n_zero, ==, 1);
        bool *one = &seen[component[0] + 1][component[1] + 1][component[2] + 1];
        n_seen += !*one;
        *one = true;
    }
    g_assert_cmpint(n_seen, ==, 12);
}

/* As many values are below the median as above, or one more. */
static void test_median_is_in_the_middle(void)
{
    sampler random = sampler_make(3, 0);
    for (size_t n = 1; n <= 9; n++) {
        float values[9], sorted[9];
        for (size_t i = 0; i < n; i++)
            values[i] = sorted[i] = floorf(5.0f * sampler_1d(&random));
        float middle = median(sorted, n);
        size_t below = 0, above = 0;
        for (size_t i = 0; i < n; i++) {
            below += values[i] < middle;
            above += values[i] > middle;
        }
        g_assert_cmpuint(below, <=, n / 2);
        g_assert_cmpuint(above, <=, (n - 1) / 2);
    }
}

/* ---- Cones ---- */

static vec3 random_direction(sampler *random)
{
    return warp_sphere(sampler_2d(random));
}

static bool is_in_cone(const cone3 *c, vec3 p)
{
    return dot3(normalize3(p - c->apex), c->axis) >= c->cosine;
}

/* How much of a line, cut into pieces, is in a cone and not said to be, or the other way
   around. */
static int n_wrong(const cone3 *c, vec3 start, vec3 direction, float length,
                   line_span said)
{
    int n = 0;
    for (int i = 0; i < 1000; i++) {
        float t = length * ((float)i + 0.5f) / 1000.0f;
        bool inside = t >= said.begin && t < said.end;
        n += inside != is_in_cone(c, start + t * direction);
    }
    return n;
}

/* Of cones of all angles and lines of all ways, from within, without, and from the apex,
   what is said to be inside is. */
static void test_cones_cut_lines(void)
{
    sampler random = sampler_make(9, 0);
    int n_cut = 0;
    for (int i = 0; i < 2000; i++) {
        cone3 c = {random_direction(&random), random_direction(&random),
                   i % 4 ? sampler_1d(&random) : 1.0f - 0.01f * sampler_1d(&random)};
        vec3 start = 3.0f * sampler_1d(&random) * random_direction(&random);
        vec3 direction = random_direction(&random);
        if (i % 8 == 0)
            start = c.apex;
        line_span said = cone3_clip(&c, start, direction, 5.0f);
        g_assert_cmpint(n_wrong(&c, start, direction, 5.0f, said), <=, 1);
        n_cut += said.end > said.begin && said.end < 5.0f;
    }
    g_assert_cmpint(n_cut, >, 200);
}

/* A line that has no end may lie in the cone without one; and one wider than half of
   space cuts nothing. */
static void test_cones_cut_endless_lines(void)
{
    const vec3 z = vec3_make(0, 0, 1), x = vec3_make(1, 0, 0);
    const cone3 narrow = {(vec3){0}, z, 0.8f}, wide = {(vec3){0}, z, -0.1f};
    line_span along = cone3_clip(&narrow, vec3_make(0.75f, 0, 0), z, INFINITY);
    g_assert_cmpfloat_with_epsilon(along.begin, 1.0f, 1e-6);
    g_assert_true(isinf(along.end));
    line_span across = cone3_clip(&narrow, vec3_make(-9, 0, 4), x, INFINITY);
    g_assert_cmpfloat_with_epsilon(across.begin, 6.0f, 1e-6);
    g_assert_cmpfloat_with_epsilon(across.end, 12.0f, 1e-5);
    line_span behind = cone3_clip(&narrow, vec3_make(-9, 0, -4), x, INFINITY);
    g_assert_cmpfloat(behind.end, <=, behind.begin);
    line_span whole = cone3_clip(&wide, vec3_make(0, 0, -4), x, INFINITY);
    g_assert_true(whole.begin == 0.0f && isinf(whole.end));
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/math/transform/inverts", test_transform_inverts);
    g_test_add_func("/math/transform/rotates", test_rotation_turns_counter_clockwise);
    g_test_add_func("/math/transform/look-at", test_look_at);
    g_test_add_func("/math/sampler/nets", test_sampler_pairs_are_nets);
    g_test_add_func("/math/sampler/side-by-side",
                    test_sampler_side_by_side_is_one_by_one);
    g_test_add_func("/math/sampler/ahead", test_sampler_ahead_is_as_drawn);
    g_test_add_func("/math/sampler/uniform", test_sampler_is_uniform_and_uncorrelated);
    g_test_add_func("/math/warp/integrals", test_warps_integrate);
    g_test_add_func("/math/frame/orthonormal", test_frames_are_orthonormal);
    g_test_add_func("/math/distribution/weights", test_distribution_follows_its_weights);
    g_test_add_func("/math/distribution/definition",
                    test_distribution_picks_by_definition);
    g_test_add_func("/math/noise/gradients", test_noise_has_perlins_gradients);
    g_test_add_func("/math/median/middle", test_median_is_in_the_middle);
    g_test_add_func("/math/cone/lines", test_cones_cut_lines);
    g_test_add_func("/math/cone/endless", test_cones_cut_endless_lines);
    return g_test_run();
}
