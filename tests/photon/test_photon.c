/*
 * photon: what is put in a store comes out, directions survive packing, eight lanes do
 * what one does, memory is as promised.
 */
#include "base/memory.h"
#include "math/sampler.h"
#include "math/warp.h"
#include "photon/direction.h"
#include "photon/photon.h"

#include <glib.h>

static vec3 random_direction(sampler *s)
{
    return warp_sphere(sampler_2d(s));
}

/* Angle between unit vectors, exact for small ones. */
static double angle(vec3 a, vec3 b)
{
    return 2.0 * asin(0.5 * (double)length3(a - b));
}

static void test_direction_error(void)
{
    enum { N = 400000 };
    double worst = 0.0, sum[3] = {0}, sum2 = 0.0;
    for (uint32_t i = 0; i < N; i++) {
        sampler s = sampler_make(1, i);
        vec3 w = random_direction(&s), back = direction_unpack(direction_pack(w, 0));
        worst = fmax(worst, angle(w, back));
        vec3 d = back - w;
        for (int axis = 0; axis < 3; axis++)
            sum[axis] += (double)d[axis];
        sum2 += (double)length3_2(d);
    }
    g_test_message("largest error %.3g rad, rms %.3g", worst, sqrt(sum2 / N));
    g_assert_cmpfloat(worst, <, 1e-4);
    g_assert_cmpfloat(worst, >, 5e-5);
    /* The mean error is within 5.5 of its standard deviations of nothing (p < 1e-7). */
    for (int axis = 0; axis < 3; axis++)
        g_assert_cmpfloat(fabs(sum[axis]), <, 5.5 * sqrt(sum2 / 3.0));
}

static void test_direction_special(void)
{
    for (int i = 0; i < 27; i++) {
        vec3 w =
            vec3_make((float)(i % 3 - 1), (float)(i / 3 % 3 - 1), (float)(i / 9 - 1));
        if (!(length3_2(w) > 0.0f))
            continue;
        w = normalize3(w);
        uint32_t packed = direction_pack(w, PHOTON_FROM_DELTA);
        bool axis = max_component3(abs3(w)) > 0.999f;
        g_assert_cmpfloat(angle(w, direction_unpack(packed)), <, axis ? 1e-12 : 1e-4);
        g_assert_cmpuint(direction_flags(packed), ==, PHOTON_FROM_DELTA);
    }
    for (unsigned flags = 0; flags < 4; flags++)
        g_assert_cmpuint(direction_flags(direction_pack(vec3_make(0, 0, -1), flags)), ==,
                         flags);
}

/* The decoder by lanes and dot product give the scalar ones' bits. */
static void test_direction_lanes(void)
{
    for (uint32_t i = 0; i < 20000; i++) {
        sampler s = sampler_make(2, i);
        vec3 n = random_direction(&s);
        uint32_t packed[LANES];
        for (uint32_t lane = 0; lane < LANES; lane++)
            packed[lane] = direction_pack(random_direction(&s), lane % 4);
        lane_vec3 d = lane_directions_of(load_lane_ints(packed));
        lane_floats dot = dot3_lanes(d, n);
        for (int lane = 0; lane < LANES; lane++) {
            vec3 one = direction_octahedron(packed[lane]);
            float expected = direction_dot(packed[lane], n), found = dot[lane];
            g_assert_true(one[0] == d.x[lane] && one[1] == d.y[lane] &&
                          one[2] == d.z[lane]);
            g_assert_cmpmem(&expected, sizeof expected, &found, sizeof found);
        }
    }
}

static photon random_photon(uint32_t i)
{
    sampler s = sampler_make(3, i);
    photon p = {.wi = random_direction(&s), .flags = i % 2};
    p.p = vec3_make(sampler_1d(&s), sampler_1d(&s), sampler_1d(&s));
    for (int lane = 0; lane < N_WAVELENGTHS; lane++)
        p.flux[lane] = sampler_1d(&s);
    return p;
}

static void assert_photon(const photon_store *store, size_t place, uint32_t i)
{
    photon expected = random_photon(i), found = photon_store_get(store, place);
    for (int axis = 0; axis < 3; axis++)
        g_assert_cmpfloat(expected.p[axis], ==, found.p[axis]);
    g_assert_cmpmem(&expected.flux, sizeof expected.flux, &found.flux, sizeof found.flux);
    g_assert_cmpuint(expected.flags, ==, found.flags);
    g_assert_cmpfloat(angle(expected.wi, found.wi), <, 1e-4);
}

/* Positions as an index puts them, and what lies at them. */
static void put_in_order(photon_store *store, const size_t *order)
{
    point_arrays points = photon_points(store);
    g_assert_true(point_arrays_permute(&points, order, (workers){.threads = 2}, NULL));
    store->x = points.x;
    store->y = points.y;
    store->z = points.z;
    g_assert_true(photon_store_follow(store, order, (workers){.threads = 2}, NULL));
}

static void test_store(void)
{
    enum { N = 1000 };
    photon_store store = {0};
    for (uint32_t i = 0; i < N; i++) {
        g_assert_true(photon_store_reserve(&store, i + 1, NULL));
        photon p = random_photon(i);
        photon_store_put(&store, &p);
    }
    for (uint32_t i = 0; i < N; i++)
        assert_photon(&store, i, i);
    photon_store_clear(&store);
    g_assert_cmpuint(store.n + store.capacity, ==, 0);
}

/* Stores of numbers: in place of flux, sorted and copied with the rest. */
static void test_store_numbers(void)
{
    enum { N = 100 };
    photon_store store = {.numbered = true}, twice = {.numbered = true};
    size_t order[N];
    g_assert_true(photon_store_reserve(&store, N, NULL));
    g_assert_true(photon_store_reserve(&twice, 2 * N, NULL));
    g_assert_cmpuint(photon_store_bytes(&store), <=, N * 24 + 32 * 24);
    for (uint32_t i = 0; i < N; i++) {
        photon p = random_photon(i);
        p.number = ((size_t)i << 33) + 5;
        photon_store_put(&store, &p);
        order[i] = i * 7 % N;
    }
    put_in_order(&store, order);
    photon_store_copy(&twice, N, &store);
    for (uint32_t i = 0; i < N; i++) {
        photon expected = random_photon((uint32_t)order[i]);
        const photon found = photon_store_get(&store, i);
        g_assert_cmpfloat(expected.p[0], ==, found.p[0]);
        g_assert_cmpuint(found.number, ==, ((size_t)order[i] << 33) + 5);
        g_assert_cmpuint(photon_store_get(&twice, N + i).number, ==, found.number);
    }
    photon_store_clear(&store);
    photon_store_clear(&twice);
}

static uint64_t chance_of(uint32_t i)
{
    return hash_mix(i, 1);
}

/* Flux in 24 bytes is off by less than its last bit, on average by nothing, and unpacked
   alike by both twins. */
static void test_packed_flux(void)
{
    enum { N = 1 << 16 };
    packed_flux packed[2] = {0};
    double off = 0.0;
    for (uint32_t i = 0; i < N; i++) {
        spectrum flux = random_photon(i % 64).flux * exp2f((float)(i % 200) - 100.0f);
        flux[i % 8] = i % 3 ? flux[i % 8] : 0.0f;
        flux_pack(flux, chance_of(i), packed);
        const spectrum found = flux_unpack(packed), twin = flux_unpack_scalar(packed);
        g_assert_cmpmem(&found, sizeof found, &twin, sizeof twin);
        for (int k = 0; k < N_WAVELENGTHS; k++) {
            g_assert_cmpfloat(fabsf(found[k] - flux[k]), <=, 0x1p-15f * flux[k]);
            off += flux[k] > 0.0f ? (double)(found[k] / flux[k] - 1.0f) : 0.0;
        }
    }
    /* Each is off by 1.3e-5 at most in standard deviation, half a million of them by
       1.8e-8 in the mean: six times that. */
    g_assert_cmpfloat(fabs(off / (8.0 * N)), <, 1.1e-7);
}

static void test_store_follow(void)
{
    enum { N = 1000 };
    photon_store store = {0};
    size_t order[N];
    g_assert_true(photon_store_reserve(&store, N, NULL));
    for (uint32_t i = 0; i < N; i++) {
        photon p = random_photon(i);
        photon_store_put(&store, &p);
        order[i] = i * 7 % N;
    }
    put_in_order(&store, order);
    g_assert_null(store.flux);
    g_assert_cmpuint(photon_store_bytes(&store), <=, N * 40 + 32 * 40);
    for (uint32_t i = 0; i < N; i++) {
        photon expected = random_photon((uint32_t)order[i]);
        photon found = photon_store_get(&store, i);
        for (int axis = 0; axis < 3; axis++)
            g_assert_cmpfloat(expected.p[axis], ==, found.p[axis]);
        g_assert_cmpuint(expected.flags, ==, found.flags);
        g_assert_cmpfloat(angle(expected.wi, found.wi), <, 1e-4);
        for (int k = 0; k < N_WAVELENGTHS; k++)
            g_assert_cmpfloat(fabsf(found.flux[k] - expected.flux[k]), <=,
                              0x1p-15f * expected.flux[k]);
    }
    photon_store_clear(&store);
}

static void test_store_memory(void)
{
    photon_store store = {0};
    g_assert_true(photon_store_reserve(&store, 100000, NULL));
    g_assert_cmpuint(photon_store_bytes(&store), <=, 100000 * 48 + 32 * 48);
    photon_store_clear(&store);
}

/* Whichever array is refused, the store stays whole and reserving again succeeds. */
static void test_store_refused(void)
{
    photon_store store = {0};
    photon p = random_photon(0);
    g_assert_true(photon_store_reserve(&store, 1, NULL));
    photon_store_put(&store, &p);
    for (unsigned n = 1; n <= 5; n++) {
        g_autoptr(GError) error = NULL;
        big_alloc_fail_at(n);
        g_assert_false(photon_store_reserve(&store, 1000, &error));
        g_assert_error(error, NEPH_ERROR, ERROR_FAILED);
        assert_photon(&store, 0, 0);
    }
    g_assert_false(photon_store_reserve(&store, SIZE_MAX, NULL));
    g_assert_true(photon_store_reserve(&store, 1000, NULL));
    assert_photon(&store, 0, 0);
    photon_store_clear(&store);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/photon/direction/error", test_direction_error);
    g_test_add_func("/photon/direction/special", test_direction_special);
    g_test_add_func("/photon/direction/lanes", test_direction_lanes);
    g_test_add_func("/photon/store/put-get", test_store);
    g_test_add_func("/photon/store/numbers", test_store_numbers);
    g_test_add_func("/photon/packed-flux", test_packed_flux);
    g_test_add_func("/photon/store/follow", test_store_follow);
    g_test_add_func("/photon/store/memory", test_store_memory);
    g_test_add_func("/photon/store/refused", test_store_refused);
    return g_test_run();
}
