/*
 * estimate: kernels integrate to one, an even field of photons is seen as it is from
 * either side of a thin wall, and every short cut gives what the formula says.
 */
#include "base/memory.h"
#include "bsdf/bsdf_models.h"
#include "math/sampler.h"
#include "math/warp.h"
#include "photon/estimate.h"
#include "transport/photonmap/photonmap.h"

#include <glib.h>

static const kernel kernels[] = {
    {KERNEL_CONSTANT, 1.0f}, {KERNEL_CONE, 1.0f},         {KERNEL_CONE, 1.7f},
    {KERNEL_GAUSSIAN, 1.0f}, {KERNEL_EPANECHNIKOV, 1.0f},
};

enum { N_TRIED_KERNELS = G_N_ELEMENTS(kernels) };

/* ---- Kernels ---- */

/* ∫∫ κ / area by the midpoint rule in t = d²/r², where the disc's measure is π r² dt. */
static void test_kernel_integrates_to_one(void)
{
    enum { STEPS = 100000 };
    const float r2 = 0.37f;
    for (size_t i = 0; i < N_TRIED_KERNELS; i++) {
        double sum = 0.0;
        for (int step = 0; step < STEPS; step++) {
            float d2 = r2 * ((float)step + 0.5f) / STEPS;
            sum += (double)kernel_eval(&kernels[i], d2, r2);
        }
        double integral = sum / STEPS * (double)(PI_F * r2);
        g_assert_cmpfloat(fabs(integral / (double)kernel_area(&kernels[i], r2) - 1.0), <,
                          1e-5);
    }
}

static void test_kernel_lanes(void)
{
    for (size_t i = 0; i < N_TRIED_KERNELS; i++) {
        for (int step = 0; step < 1000; step += LANES) {
            lane_floats d2;
            for (int lane = 0; lane < LANES; lane++)
                d2[lane] = 4.0f * (float)(step + lane) / 1000.0f;
            lane_floats eight = kernel_eval_lanes(&kernels[i], d2, 1.0f / 4.0f);
            for (int lane = 0; lane < LANES; lane++) {
                float one = kernel_eval(&kernels[i], d2[lane], 4.0f);
                g_assert_cmpfloat(fabsf(eight[lane] - one), <, 1e-6f);
            }
        }
    }
}

/* ---- Fields and surfaces ---- */

static photon_map *build(map_choice choice, const photon *photons, size_t n, float radius)
{
    photon_store store = {0};
    g_assert_true(photon_store_reserve(&store, n, NULL));
    for (size_t i = 0; i < n; i++)
        photon_store_put(&store, &photons[i]);
    photon_map *map =
        photon_map_build(choice, &store, radius, (workers){.threads = 1}, NULL);
    g_assert_nonnull(map);
    return map;
}

static const spectrum ramp = {1, 2, 3, 4, 5, 6, 7, 8};

/* A photon on the square [-1, 1]² of z = 0, from above or below. */
static photon wall_photon(sampler *s, bool above)
{
    vec2 u = sampler_2d(s);
    vec3 wi = warp_cosine_hemisphere(sampler_2d(s));
    photon p = {.p = vec3_make(2.0f * u.x - 1.0f, 2.0f * u.y - 1.0f, 0.0f)};
    p.wi = above ? wi : -wi;
    p.flux = above ? ramp : spectrum_fill(3.0f);
    return p;
}

static bsdf diffuse_wall(float rho)
{
    bsdf b = {.shading = frame_from_normal(vec3_make(0, 0, 1)),
              .n_geom = vec3_make(0, 0, 1),
              .wavelength = ALL_WAVELENGTHS};
    bsdf_make_diffuse(&b, spectrum_fill(rho));
    return b;
}

static estimate_options options_make(kernel k, size_t nearest, float radius)
{
    return (estimate_options){.kernel = k,
                              .nearest = nearest,
                              .radius = radius,
                              .flatten = 1.0f,
                              .lobes = LOBE_GATHERED};
}

/* ---- Without bias ---- */

/* Mean and variance of a stream of numbers. */
typedef struct moments {
    double n, sum, sum2;
} moments;

static void moments_add(moments *m, double x)
{
    m->n += 1.0;
    m->sum += x;
    m->sum2 += x * x;
}

/* The mean lies within 5.5 standard errors of what is expected (p < 4e-8 each, about 100
 * comparisons), and these are small enough to tell. */
static void assert_mean(const moments *m, double expected)
{
    double mean = m->sum / m->n, variance = m->sum2 / m->n - mean * mean;
    double sigma = sqrt(variance / m->n);
    g_assert_cmpfloat(sigma, <, 0.01 * expected);
    g_assert_cmpfloat(fabs(mean - expected), <, 5.5 * sigma);
}

enum { N_FIELDS = 1200, N_ABOVE = 300, N_BELOW = 700, NEAREST = 24, N_SIDES = 2 };

/* One field, seen by every kernel, both ways, from both sides. */
static void see_field(const photon_map *map, moments m[N_TRIED_KERNELS][2][N_SIDES])
{
    estimate_scratch scratch = {0};
    estimate_info info;
    bsdf wall = diffuse_wall(0.5f);
    for (size_t k = 0; k < N_TRIED_KERNELS; k++) {
        for (int way = 0; way < 2; way++) {
            estimate_options options =
                options_make(kernels[k], way ? NEAREST : 0, way ? INFINITY : 0.3f);
            for (int side = 0; side < N_SIDES; side++) {
                vec3 wo = normalize3(vec3_make(0.3f, 0.2f, side ? -1.0f : 1.0f));
                spectrum l = photon_estimate(map, vec3_make(0, 0, 0), &wall, wo, &options,
                                             &scratch, &info);
                moments_add(&m[k][way][side], (double)l[2]);
                if (way)
                    g_assert_cmpuint(info.n_photons, ==, NEAREST - 1);
            }
        }
    }
    estimate_scratch_clear(&scratch);
}

/* n photons of flux 3 on an area of 4: irradiance 3 n / 4, and L = ρ/π E. */
static void test_even_field_unbiased(void)
{
    moments m[N_MAPS][N_TRIED_KERNELS][2][N_SIDES] = {0};
    photon photons[N_ABOVE + N_BELOW];
    for (uint32_t field = 0; field < N_FIELDS; field++) {
        for (uint32_t i = 0; i < N_ABOVE + N_BELOW; i++) {
            sampler s = sampler_make(hash_mix(5, field), 0);
            s = sampler_split(&s, i);
            photons[i] = wall_photon(&s, i < N_ABOVE);
        }
        for (map_choice choice = MAP_LIST; choice <= MAP_GRID; choice++) {
            g_autoptr(photon_map) map = build(choice, photons, N_ABOVE + N_BELOW, 0.3f);
            see_field(map, m[choice]);
        }
    }
    for (int map = 0; map < N_MAPS; map++) {
        for (size_t k = 0; k < N_TRIED_KERNELS; k++) {
            for (int way = 0; way < 2; way++) {
                assert_mean(&m[map][k][way][0], 0.5 / G_PI * 3.0 / 4.0 * N_ABOVE);
                assert_mean(&m[map][k][way][1], 0.5 / G_PI * 3.0 / 4.0 * N_BELOW);
            }
        }
    }
}

/* ---- The k nearest ---- */

/* Photons of flux 1 at random (a Poisson process) on [-1, 1]²: around its middle, π r_k²
   times their density is a sum of k exponential variables. */
enum { POISSON_FIELDS = 6000, POISSON_MEAN = 240, POISSON_MOST = 400 };

static const size_t few[] = {2, 3, 5, 10, 50};

typedef enum nearest_way { BY_RADIANCE, BY_IRRADIANCE, BY_DISC, N_WAYS } nearest_way;

enum { N_FEW = G_N_ELEMENTS(few) };

/* For two the variance of the estimate is infinite. What is counted is the estimate where
   π r² times the density is above this, and that has a closed form too. */
#define LEAST_IN_REACH 0.1

/* E[(k-1)/G; G > a] of such a sum G of k: P(sum of k-1 > a). */
static double share_above(size_t k, double a)
{
    double term = exp(-a), sum = 0.0;
    for (size_t i = 0; i + 1 < k; i++) {
        sum += term;
        term *= a / (double)(i + 1);
    }
    return sum;
}

static size_t poisson_field(uint32_t field, photon *photons)
{
    sampler s = sampler_make(hash_mix(77, field), 0);
    double left = POISSON_MEAN;
    size_t n = 0;
    for (; n < POISSON_MOST; n++) {
        sampler own = sampler_split(&s, (uint32_t)n);
        left += log1p(-(double)sampler_1d(&own));
        if (left < 0.0)
            break;
        photons[n] = wall_photon(&own, true);
        photons[n].flux = spectrum_fill(1.0f);
    }
    g_assert_cmpuint(n, <, POISSON_MOST);
    return n;
}

/* As a render is told to estimate; over the density of photons. */
static double estimate_nearest(const photon_map *map, size_t k, const kernel *kappa,
                               nearest_way way, estimate_scratch *scratch)
{
    const double density = POISSON_MEAN / 4.0;
    settings how = settings_default();
    how.class_nearest[PHOTON_CAUSTIC] = (int64_t)k;
    how.class_kernel[PHOTON_CAUSTIC] = kappa->choice;
    how.class_cone_k[PHOTON_CAUSTIC] = (double)kappa->cone_k;
    how.flatten = way == BY_DISC ? 0.05 : 1.0;
    estimate_options o = photonmap_estimate_options(&how, PHOTON_CAUSTIC, 0.0);
    const vec3 x = {0}, up = {0, 0, 1};
    const bsdf wall = diffuse_wall(1.0f);
    estimate_info info;
    float e = way == BY_RADIANCE
                  ? PI_F * photon_estimate(map, x, &wall, up, &o, scratch, &info)[3]
                  : photon_irradiance(map, x, up, &o, scratch, &info)[3];
    double in_reach = density * (double)(PI_F * info.radius * info.radius);
    g_assert_cmpuint(info.n_photons, ==, k - 1);
    return in_reach > LEAST_IN_REACH ? (double)e / density : 0.0;
}

/* Each of 225 means within 6 standard errors (p < 5e-7 in all), these below a 20th. */
static void assert_nearest_mean(const moments *m, size_t k)
{
    double mean = m->sum / m->n, sigma = sqrt((m->sum2 / m->n - mean * mean) / m->n);
    double expected = share_above(k, LEAST_IN_REACH);
    g_test_message("k = %zu: %g +- %g of %g", k, mean, sigma, expected);
    g_assert_cmpfloat(sigma, <, 0.05);
    g_assert_cmpfloat(fabs(mean - expected), <, 6.0 * sigma);
}

static void test_nearest_unbiased(void)
{
    static moments m[N_MAPS][N_FEW][N_TRIED_KERNELS][N_WAYS];
    photon photons[POISSON_MOST];
    estimate_scratch scratch = {0};
    for (uint32_t field = 0; field < POISSON_FIELDS; field++) {
        map_choice choice = (map_choice)(field % N_MAPS);
        size_t n = poisson_field(field, photons);
        g_autoptr(photon_map) map = build(choice, photons, n, 0.2f);
        for (size_t i = 0; i < N_FEW * N_TRIED_KERNELS * N_WAYS; i++) {
            size_t k = i / N_WAYS / N_TRIED_KERNELS, kappa = i / N_WAYS % N_TRIED_KERNELS;
            nearest_way way = (nearest_way)(i % N_WAYS);
            moments_add(&m[choice][k][kappa][way],
                        estimate_nearest(map, few[k], &kernels[kappa], way, &scratch));
        }
    }
    estimate_scratch_clear(&scratch);
    for (int map = 0; map < N_MAPS; map++)
        for (size_t k = 0; k < N_FEW; k++)
            for (size_t i = 0; i < N_TRIED_KERNELS * N_WAYS; i++)
                assert_nearest_mean(&m[map][k][i / N_WAYS][i % N_WAYS], few[k]);
}

/* ---- By the formula ---- */

/* Scatters to both sides: 1/10 per lobe class, more toward +x. */
static spectrum both_sides_eval(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                                transport_mode mode)
{
    (void)wo, (void)mode;
    unsigned used = lobes & b->lobes;
    float classes =
        ((used & LOBE_DIFFUSE) ? 1.0f : 0.0f) + ((used & LOBE_GLOSSY) ? 4.0f : 0.0f);
    unsigned side = wo[2] * wi[2] > 0.0f ? LOBE_REFLECTION : LOBE_TRANSMISSION;
    return (used & side) ? ramp * (0.1f * classes * (2.0f + wi[0])) : (spectrum){0};
}

static const bsdf_ops both_sides_ops = {.name = "both sides", .eval = both_sides_eval};

static bsdf test_wall(vec3 n, unsigned lobes)
{
    bsdf b = diffuse_wall(0.7f);
    b.shading = frame_from_normal(normalize3(n));
    if (lobes) {
        b.ops = &both_sides_ops;
        b.lobes = lobes;
        b.lambertian = false;
    }
    return b;
}

/* What one photon adds: straight from the formula, in the order of the paper. */
static spectrum term(const photon *p, float d2, float r2, const bsdf *b, vec3 wo,
                     const estimate_options *o)
{
    unsigned lobes = o->lobes | ((p->flags & PHOTON_FROM_DELTA) ? o->delta_lobes : 0u);
    float ratio = fabsf(dot3(p->wi, b->shading.n) / dot3(p->wi, b->n_geom));
    spectrum f = bsdf_eval(b, wo, p->wi, lobes, TRANSPORT_RADIANCE);
    return f * p->flux * ratio * kernel_eval(&o->kernel, d2, r2);
}

/* Photons that count: on the side seen; where light goes through, on the face seen, that
   is whose normal points as the wall's, and in its plane. */
static bool counts(const photon *p, vec3 x, const bsdf *b, vec3 wo, unsigned lobes)
{
    bool behind = p->flags & PHOTON_BEHIND, above = dot3(p->wi, b->n_geom) > 0.0f;
    float height = fabsf(dot3(p->p - x, b->n_geom));
    if (b->lobes & lobes & LOBE_TRANSMISSION)
        return above != behind || height < sqrtf(1e-5f) * length3(p->p - x);
    return above == (dot3(wo, b->n_geom) > 0.0f);
}

/* Squared radius: fixed, or that of the k-th photon that counts. */
static float formula_radius2(const photon_store *s, vec3 x, const bsdf *b, vec3 wo,
                             const estimate_options *o)
{
    float r2 = 0.0f;
    if (!o->nearest)
        return o->radius * o->radius;
    for (size_t found = 0; found < o->nearest; found++) {
        float next = INFINITY;
        for (size_t i = 0; i < s->n; i++) {
            photon p = photon_store_get(s, i);
            float d2 = length3_2(p.p - x);
            if (d2 > r2 && d2 < next && counts(&p, x, b, wo, o->lobes | o->delta_lobes))
                next = d2;
        }
        r2 = next;
    }
    return r2;
}

static spectrum formula(const photon_store *s, vec3 x, const bsdf *b, vec3 wo,
                        const estimate_options *o)
{
    spectrum sum = {0};
    float r2 = formula_radius2(s, x, b, wo, o);
    float reach2 = r2 * (1.0f - 1e-6f);
    for (size_t i = 0; i < s->n; i++) {
        photon p = photon_store_get(s, i);
        float d2 = length3_2(p.p - x);
        if (d2 < reach2 && counts(&p, x, b, wo, o->lobes | o->delta_lobes))
            sum += term(&p, fminf(d2, r2), r2, b, wo, o);
    }
    return sum / kernel_area(&o->kernel, r2);
}

static void assert_close(spectrum found, spectrum expected)
{
    for (int wavelength = 0; wavelength < N_WAVELENGTHS; wavelength++) {
        float tolerance = 2e-5f * spectrum_max(expected) + 1e-20f;
        g_assert_cmpfloat(fabsf(found[wavelength] - expected[wavelength]), <=, tolerance);
    }
}

static photon cloud_photon(uint32_t i)
{
    sampler s = sampler_make(9, i);
    photon p = {.wi = warp_sphere(sampler_2d(&s)), .flags = i % 3 == 0};
    p.flags |= i % 7 < 3 ? PHOTON_BEHIND : 0;
    p.p = vec3_make(sampler_1d(&s), sampler_1d(&s), 0.1f * sampler_1d(&s));
    for (int wavelength = 0; wavelength < N_WAVELENGTHS; wavelength++)
        p.flux[wavelength] = sampler_1d(&s);
    return p;
}

static const unsigned wall_lobes[] = {
    0,
    LOBE_DIFFUSE | LOBE_REFLECTION,
    LOBE_DIFFUSE | LOBE_ANY_SIDE,
    LOBE_DIFFUSE | LOBE_GLOSSY | LOBE_REFLECTION,
};

static void compare_with_formula(const photon_map *map, uint32_t i)
{
    estimate_scratch scratch = {0};
    sampler s = sampler_make(10, i);
    vec3 x = vec3_make(sampler_1d(&s), sampler_1d(&s), 0.05f);
    vec3 wo = warp_sphere(sampler_2d(&s));
    for (unsigned bent = 0; bent < 2; bent++) {
        for (size_t l = 0; l < G_N_ELEMENTS(wall_lobes); l++) {
            bsdf b = test_wall(vec3_make(bent ? 0.4f : 0, 0, 1), wall_lobes[l]);
            for (unsigned way = 0; way < 2; way++) {
                estimate_options o = options_make(kernels[(i + l) % N_TRIED_KERNELS],
                                                  way ? 9 : 0, way ? 10.0f : 0.2f);
                o.delta_lobes = l == 3 ? LOBE_GLOSSY : 0;
                spectrum expected = formula(photon_map_store(map), x, &b, wo, &o);
                assert_close(photon_estimate(map, x, &b, wo, &o, &scratch, NULL),
                             expected);
            }
        }
    }
    estimate_scratch_clear(&scratch);
}

static void test_formula(void)
{
    enum { N = 300 };
    photon photons[N];
    for (uint32_t i = 0; i < N; i++)
        photons[i] = cloud_photon(i);
    for (map_choice choice = MAP_LIST; choice <= MAP_GRID; choice++) {
        g_autoptr(photon_map) map = build(choice, photons, N, 0.2f);
        for (uint32_t i = 0; i < 40; i++)
            compare_with_formula(map, i);
    }
}

/* Irradiance is π L of a white wall. */
static void test_irradiance(void)
{
    enum { N = 2000 };
    estimate_scratch scratch = {0};
    photon *photons = big_alloc(N, sizeof *photons, "photons", NULL);
    for (uint32_t i = 0; i < N; i++)
        photons[i] = cloud_photon(i);
    for (map_choice choice = MAP_LIST; choice <= MAP_GRID; choice++) {
        g_autoptr(photon_map) map = build(choice, photons, N, 0.2f);
        for (int way = 0; way < 2; way++) {
            vec3 x = vec3_make(0.5f, 0.5f, 0.05f), n = vec3_make(0, 0, 1);
            estimate_options o = options_make(kernels[1], way ? 30 : 0, 0.2f);
            bsdf b = diffuse_wall(1.0f);
            estimate_info info;
            spectrum l = photon_estimate(map, x, &b, n, &o, &scratch, &info);
            g_assert_cmpuint(info.n_photons, >=, 29);
            assert_close(photon_irradiance(map, x, n, &o, &scratch, NULL), l * PI_F);
        }
    }
    estimate_scratch_clear(&scratch);
    big_free(photons);
}

/* ---- At the edges ---- */

/* Photons on a floor and on the wall that meets it: a flat neighbourhood on the floor
 * leaves out the wall's, a ball does not. */
static void test_flatten(void)
{
    enum { N = 40000 };
    estimate_scratch scratch = {0};
    photon *photons = big_alloc(N, sizeof *photons, "photons", NULL);
    for (uint32_t i = 0; i < N; i++) {
        sampler s = sampler_make(12, i / 2);
        photons[i] = wall_photon(&s, true);
        vec3 p = photons[i].p;
        if (i % 2)
            photons[i].p = vec3_make(0, p[1], fabsf(p[0]) + 1e-4f);
        else
            photons[i].p[0] = fabsf(p[0]);
    }
    for (map_choice choice = MAP_LIST; choice <= MAP_GRID; choice++) {
        g_autoptr(photon_map) map = build(choice, photons, N, 0.2f);
        for (int flat = 0; flat < 2; flat++) {
            estimate_options o = options_make(kernels[0], 0, 0.2f);
            o.flatten = flat ? 0.0f : 1.0f;
            vec3 x = vec3_make(0.01f, 0, 0), n = vec3_make(0, 0, 1);
            float e = photon_irradiance(map, x, n, &o, &scratch, NULL)[0];
            /* About half the disc lies off the floor: E is 1/2 of N/2 photons on 2 m². */
            float half = 0.5f * (N / 2) / 2.0f;
            g_assert_true(flat ? e < 1.3f * half : e > 1.3f * half);
            g_assert_cmpfloat(e, >, 0.7f * half);
            o.nearest = 40;
            estimate_info info;
            photon_irradiance(map, x, n, &o, &scratch, &info);
            g_assert_cmpuint(info.n_photons, ==, 39);
        }
    }
    estimate_scratch_clear(&scratch);
    big_free(photons);
}

static void assert_black(spectrum s)
{
    for (int wavelength = 0; wavelength < N_WAVELENGTHS; wavelength++)
        g_assert_true(s[wavelength] >= 0.0f && s[wavelength] <= 0.0f);
}

static void test_nothing_there(void)
{
    photon photons[20];
    for (uint32_t i = 0; i < 20; i++) {
        photons[i] = cloud_photon(i);
        photons[i].p = vec3_make(0, 0, 0);
        photons[i].wi = vec3_make(0, 0, 1);
    }
    vec3 x = vec3_make(0, 0, 0), far = vec3_make(9, 9, 9), n = vec3_make(0, 0, 1);
    estimate_scratch scratch = {0};
    for (map_choice choice = MAP_LIST; choice <= MAP_GRID; choice++) {
        g_autoptr(photon_map) empty = build(choice, photons, 0, 0.1f);
        g_autoptr(photon_map) map = build(choice, photons, 20, 0.1f);
        for (size_t nearest = 0; nearest < 20; nearest += 10) {
            estimate_options none = options_make(kernels[0], nearest, 0.0f);
            estimate_options some = options_make(kernels[0], nearest, 0.1f);
            assert_black(photon_irradiance(empty, x, n, &some, &scratch, NULL));
            assert_black(photon_irradiance(map, x, n, &none, &scratch, NULL));
            assert_black(photon_irradiance(map, far, n, &some, &scratch, NULL));
        }
        /* All on one spot: no area, so no answer, but a finite one. */
        estimate_options spot = options_make(kernels[0], 10, INFINITY);
        assert_black(photon_irradiance(map, x, n, &spot, &scratch, NULL));
    }
    estimate_scratch_clear(&scratch);
}

/* Fewer than k within the radius: the radius counts. */
static void test_fewer_than_k(void)
{
    photon photons[20];
    float sum = 0.0f;
    for (uint32_t i = 0; i < 20; i++) {
        photons[i] = cloud_photon(i);
        photons[i].wi = vec3_make(0, 0, 1);
        sum += photons[i].flux[0];
    }
    vec3 x = vec3_make(0.5f, 0.5f, 0), n = vec3_make(0, 0, 1);
    estimate_scratch scratch = {0};
    for (map_choice choice = MAP_LIST; choice <= MAP_GRID; choice++) {
        g_autoptr(photon_map) map = build(choice, photons, 20, 0.1f);
        estimate_options o = options_make(kernels[0], 30, 3.0f);
        estimate_info info;
        spectrum e = photon_irradiance(map, x, n, &o, &scratch, &info);
        g_assert_cmpfloat(fabsf(e[0] - sum / (PI_F * 9.0f)), <, 1e-5f * sum);
        g_assert_cmpuint(info.n_photons, ==, 20);
        g_assert_cmpfloat(info.radius, ==, 3.0f);
        o.radius = INFINITY;
        e = photon_irradiance(map, x, n, &o, &scratch, &info);
        g_assert_cmpfloat(info.radius, <, 1.0f);
        g_assert_cmpuint(info.n_photons, ==, 19);
    }
    estimate_scratch_clear(&scratch);
}

static void test_memory_refused(void)
{
    photon photons[20];
    for (uint32_t i = 0; i < 20; i++)
        photons[i] = cloud_photon(i);
    vec3 x = vec3_make(0.5f, 0.5f, 0), n = vec3_make(0, 0, 1);
    for (map_choice choice = MAP_LIST; choice <= MAP_GRID; choice++) {
        g_autoptr(photon_map) map = build(choice, photons, 20, 0.1f);
        estimate_scratch scratch = {0};
        estimate_options o = options_make(kernels[0], 5, INFINITY);
        big_alloc_fail_at(1);
        assert_black(photon_irradiance(map, x, n, &o, &scratch, NULL));
        g_assert_true(scratch.failed);
        estimate_scratch_clear(&scratch);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/estimate/kernel/integrates-to-one", test_kernel_integrates_to_one);
    g_test_add_func("/estimate/kernel/lanes", test_kernel_lanes);
    g_test_add_func("/estimate/even-field-unbiased", test_even_field_unbiased);
    g_test_add_func("/estimate/nearest-unbiased", test_nearest_unbiased);
    g_test_add_func("/estimate/formula", test_formula);
    g_test_add_func("/estimate/irradiance", test_irradiance);
    g_test_add_func("/estimate/flatten", test_flatten);
    g_test_add_func("/estimate/nothing-there", test_nothing_there);
    g_test_add_func("/estimate/fewer-than-k", test_fewer_than_k);
    g_test_add_func("/estimate/memory-refused", test_memory_refused);
    return g_test_run();
}
