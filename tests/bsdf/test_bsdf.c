/*
 * bsdf: every model draws with the density it claims, whatever lobes are asked for; its
 * weights are f cos / pdf; it is reciprocal, loses no more than it should, and its two
 * modes are adjoint, also where shading and geometric normal differ (Veach 1997, §5.3).
 *
 * Statistical checks: each χ² must have p > 1e-8, so that a run of all of them fails by
 * chance with p < 1e-6; means are compared within 5.5 standard errors. Seeds are fixed.
 */
#include "bsdf/fresnel.h"
#include "bsdf_zoo.h"
#include "chi2.h"

#define TINY_P 1e-8

static const unsigned MASKS[] = {
    LOBE_ALL,
    LOBE_FOLLOWED,
    LOBE_GATHERED,
    LOBE_GLOSSY | LOBE_ANY_SIDE,
    LOBE_GLOSSY | LOBE_DIFFUSE | LOBE_ANY_SIDE,
    LOBE_ALL & ~(unsigned)LOBE_TRANSMISSION,
    LOBE_ALL & ~(unsigned)LOBE_REFLECTION,
};

/* The model in a skew frame; tilt: angle between shading and geometric normal. */
static bsdf make(const model *m, float tilt, int wavelength)
{
    bsdf b = {.wavelength = wavelength};
    vec3 n = normalize3(vec3_make(0.3f, -0.5f, 0.8f));
    b.shading = frame_from_tangent(n, vec3_make(1.0f, 0.4f, 0.2f));
    vec3 side = normalize3(b.shading.s + 0.5f * b.shading.t);
    b.n_geom = n * cosf(tilt) + side * sinf(tilt);
    m->make(&b);
    return b;
}

static vec3 world(const bsdf *b, float degrees, float phi)
{
    float theta = degrees * PI_F / 180.0f;
    return frame_to_world(&b->shading, vec3_make(sinf(theta) * cosf(phi),
                                                 sinf(theta) * sinf(phi), cosf(theta)));
}

/* What a draw needs. */
typedef struct drawing {
    bsdf b;
    vec3 wo;
    unsigned mask;
    transport_mode mode;
} drawing;

/* χ² counts in the local frame, where lobes do not straddle the poles' seams. */
static bool draw(void *data, float u_lobe, vec2 u, vec3 *w)
{
    drawing *d = data;
    bsdf_sample s;
    if (!bsdf_sample_direction(&d->b, d->wo, u_lobe, u, d->mask, d->mode, &s) ||
        (s.lobe & LOBE_SPECULAR))
        return false;
    *w = frame_to_local(&d->b.shading, s.wi);
    return true;
}

static float density(void *data, vec3 w)
{
    drawing *d = data;
    vec3 wi = frame_to_world(&d->b.shading, w);
    return bsdf_pdf(&d->b, d->wo, wi, d->mask, d->mode);
}

static bool has_density(const bsdf *b, unsigned mask)
{
    unsigned classes = LOBE_GLOSSY | LOBE_DIFFUSE;
    return (b->lobes & mask & classes) && (b->lobes & mask & LOBE_ANY_SIDE);
}

static void check_chi2(const model *m, float degrees, unsigned mask, float tilt)
{
    drawing d = {.b = make(m, tilt, ALL_WAVELENGTHS), .mask = mask};
    if (!has_density(&d.b, mask))
        return;
    d.wo = world(&d.b, degrees, 0.7f);
    double p = chi2_directions(draw, density, &d, 20000, 17 + mask);
    if (p < TINY_P)
        g_error("%s at %g degrees, mask %u, tilt %g: p = %g", m->name, (double)degrees,
                mask, (double)tilt, p);
}

/* Whether an earlier mask asks this model for the same lobes. */
static bool asked_already(const model *m, size_t k)
{
    bsdf b = make(m, 0.0f, ALL_WAVELENGTHS);
    for (size_t i = 0; i < k; i++)
        if ((MASKS[i] & b.lobes) == (MASKS[k] & b.lobes))
            return true;
    return false;
}

static void test_density(void)
{
    static const float DEGREES[] = {5.0f, 30.0f, 80.0f, 135.0f, 165.0f};
    for (size_t m = 0; m < G_N_ELEMENTS(MODELS); m++) {
        for (size_t k = 0; k < G_N_ELEMENTS(MASKS); k++)
            if (!asked_already(&MODELS[m], k))
                check_chi2(&MODELS[m], 45.0f, MASKS[k], 0.0f);
        for (size_t a = 0; a < G_N_ELEMENTS(DEGREES); a++)
            check_chi2(&MODELS[m], DEGREES[a], LOBE_ALL, a & 1 ? 0.3f : 0.0f);
    }
}

/* Weight, pdf and f of one draw belong together. */
static bool check_draw(const drawing *d, const bsdf_sample *s, const char *name)
{
    g_assert_true(d->mask & s->lobe & LOBE_ANY_SIDE);
    g_assert_true(d->mask & s->lobe & ~(unsigned)LOBE_ANY_SIDE);
    g_assert_cmpfloat(fabsf(length3(s->wi) - 1.0f), <, 1e-5f);
    g_assert_true(spectrum_is_finite(s->weight));
    bool same_side = dot3(s->wi, d->b.n_geom) * dot3(d->wo, d->b.n_geom) > 0.0f;
    g_assert_cmpint(same_side, ==, (s->lobe & LOBE_REFLECTION) != 0);
    if (s->lobe & LOBE_SPECULAR)
        return true;
    float pdf = bsdf_pdf(&d->b, d->wo, s->wi, d->mask, d->mode);
    spectrum f = bsdf_eval(&d->b, d->wo, s->wi, d->mask, d->mode);
    spectrum weight = f * (fabsf(dot3(s->wi, d->b.shading.n)) / pdf);
    float error = fabsf(pdf / s->pdf - 1.0f);
    for (int i = 0; i < N_WAVELENGTHS; i++)
        error = fmaxf(error,
                      fabsf(weight[i] - s->weight[i]) / (spectrum_max(s->weight) + 0.1f));
    /* Near grazing the directions themselves are rounded. */
    float grazing =
        fminf(fabsf(dot3(s->wi, d->b.shading.n)), fabsf(dot3(s->wi, d->b.n_geom)));
    if (!(error > 2e-3f + 1e-5f / grazing))
        return true;
    /* Rounding leads a walk between layers elsewhere now and then. */
    if (strcmp(d->b.ops->name, "layered") != 0)
        g_error("%s: pdf %g, drawn with %g; error %g", name, (double)pdf, (double)s->pdf,
                (double)error);
    return false;
}

static void check_draws(const model *m, int wavelength, unsigned mask,
                        transport_mode mode)
{
    int n_apart = 0;
    for (uint64_t i = 0; i < 400; i++) {
        sampler s = sampler_make(hash_mix(5, mask), i);
        drawing d = {
            .b = make(m, i % 3 ? 0.0f : 0.4f, wavelength), .mask = mask, .mode = mode};
        float degrees = 180.0f * sampler_1d(&s);
        d.wo = world(&d.b, degrees, 6.0f * sampler_1d(&s));
        bsdf_sample out;
        float u_lobe = sampler_1d(&s);
        vec2 u = sampler_2d(&s);
        if (bsdf_sample_direction(&d.b, d.wo, u_lobe, u, mask, mode, &out))
            n_apart += !check_draw(&d, &out, m->name);
    }
    g_assert_cmpint(n_apart, <=, 10);
}

static void test_weights(void)
{
    for (size_t m = 0; m < G_N_ELEMENTS(MODELS); m++)
        for (size_t k = 0; k < G_N_ELEMENTS(MASKS); k++) {
            check_draws(&MODELS[m], ALL_WAVELENGTHS, MASKS[k], TRANSPORT_RADIANCE);
            check_draws(&MODELS[m], 3, MASKS[k], TRANSPORT_IMPORTANCE);
        }
}

static vec3 random_direction(sampler *s)
{
    vec2 u = sampler_2d(s);
    float z = 2.0f * u.x - 1.0f, r = sqrtf(1.0f - z * z), phi = 2.0f * PI_F * u.y;
    return vec3_make(r * cosf(phi), r * sinf(phi), z);
}

static void assert_near(spectrum a, spectrum b, float relative, const char *name)
{
    for (int i = 0; i < N_WAVELENGTHS; i++)
        if (!(fabsf(a[i] - b[i]) <= relative * (fabsf(a[i]) + fabsf(b[i])) + 5e-6f))
            g_error("%s: lane %d: %g against %g", name, i, (double)a[i], (double)b[i]);
}

/* A photon from a to b and an importon from b to a meet the same factor:
 *   f*(a -> b) |b·n| |a·ng| = f(b <- a) |a·n| |b·ng| */
static void test_adjoint(void)
{
    for (size_t m = 0; m < G_N_ELEMENTS(MODELS); m++)
        for (uint64_t i = 0; i < 2000; i++) {
            sampler s = sampler_make(77, i);
            bsdf b = make(&MODELS[m], i & 1 ? 0.5f : 0.0f, ALL_WAVELENGTHS);
            vec3 from = random_direction(&s), to = random_direction(&s), n = b.shading.n;
            if (fabsf(dot3(from, b.n_geom)) < 2e-3f)
                continue;
            spectrum photon = bsdf_eval(&b, from, to, LOBE_ALL, TRANSPORT_IMPORTANCE);
            spectrum eye = bsdf_eval(&b, to, from, LOBE_ALL, TRANSPORT_RADIANCE);
            assert_near(photon * fabsf(dot3(to, n) * dot3(from, b.n_geom)),
                        eye * fabsf(dot3(from, n) * dot3(to, b.n_geom)), 1e-3f,
                        MODELS[m].name);
        }
}

/* f(wo, wi) / η_o² = f(wi, wo) / η_i² in radiance mode, without tilt. */
static void test_reciprocity(void)
{
    for (size_t m = 0; m < G_N_ELEMENTS(MODELS); m++)
        for (uint64_t i = 0; i < 2000; i++) {
            sampler s = sampler_make(78, i);
            bsdf b = make(&MODELS[m], 0.0f, ALL_WAVELENGTHS);
            vec3 x = random_direction(&s), y = random_direction(&s);
            spectrum there = bsdf_eval(&b, x, y, LOBE_ALL, TRANSPORT_RADIANCE);
            spectrum back = bsdf_eval(&b, y, x, LOBE_ALL, TRANSPORT_RADIANCE);
            spectrum eta = spectrum_fill(1.0f);
            if ((b.lobes & LOBE_TRANSMISSION) &&
                !g_str_has_prefix(MODELS[m].name, "glTF") &&
                strcmp(MODELS[m].name, "leaf") != 0 &&
                dot3(x, b.shading.n) * dot3(y, b.shading.n) < 0.0f)
                memcpy(&eta, b.data, sizeof eta); /* all that refract begin with it */
            if (dot3(x, b.shading.n) < 0.0f)
                eta = 1.0f / eta;
            assert_near(there * eta * eta, back, 1e-3f, MODELS[m].name);
        }
}

/* Mean weight of n draws, and the largest standard error over lanes. */
static spectrum mean_weight(const drawing *d, int n, float *error)
{
    spectrum sum = {0}, squares = {0};
    for (int i = 0; i < n; i++) {
        sampler s = sampler_make(11, (uint64_t)i);
        bsdf_sample out;
        float u_lobe = sampler_1d(&s);
        vec2 u = sampler_2d(&s);
        if (!bsdf_sample_direction(&d->b, d->wo, u_lobe, u, d->mask, d->mode, &out))
            continue;
        sum += out.weight;
        squares += out.weight * out.weight;
    }
    spectrum mean = sum / (float)n;
    *error =
        sqrtf(fmaxf(0.0f, spectrum_max(squares / (float)n - mean * mean)) / (float)n);
    return mean;
}

enum { N_ALBEDOS = 256 };

/* 5.5 standard errors of 32 walks, which send back 0.3 on average with a deviation of no
   more; directions that hardly differ have the same walks. */
#define WALKS_SLACK (5.5f * 0.3f / sqrtf(32.0f))

/* The quick albedo of rough facets has few points, others for every direction: the mean
   over directions that hardly differ. */
static spectrum mean_albedo(const drawing *d)
{
    spectrum sum = {0};
    for (int k = 0; k < N_ALBEDOS; k++) {
        vec3 off = vec3_make(1e-5f * (float)k, 2e-5f * (float)(k % 7), 0.0f);
        sum += bsdf_albedo(&d->b, normalize3(d->wo + off), LOBE_ALL);
    }
    return sum / N_ALBEDOS;
}

static void test_energy(void)
{
    for (size_t m = 0; m < G_N_ELEMENTS(MODELS); m++)
        for (int k = 0; k < 8; k++) {
            drawing d = {.b = make(&MODELS[m], 0.0f, ALL_WAVELENGTHS),
                         .mask = LOBE_ALL,
                         .mode = TRANSPORT_IMPORTANCE};
            d.wo = world(&d.b, (float[]){2, 30, 45, 70, 85, 100, 140, 170}[k], 0.2f);
            float error;
            spectrum mean = mean_weight(&d, 20000, &error);
            float slack = 5.5f * error + 1e-4f;
            g_assert_cmpfloat(spectrum_max(mean), <, 1.0f + slack);
            if (k == 2)
                g_assert_cmpfloat(spectrum_max(mean) + slack, >, MODELS[m].least_albedo);
            if (MODELS[m].least_albedo > 0.999)
                assert_near(mean, spectrum_fill(1.0f), slack, MODELS[m].name);
            const char *name = d.b.ops->name;
            float off = strcmp(name, "layered") == 0      ? WALKS_SLACK
                        : g_str_has_prefix(name, "rough") ? 0.01f
                                                          : 0.06f;
            spectrum albedo = mean_albedo(&d);
            for (int i = 0; i < N_WAVELENGTHS; i++)
                g_assert_cmpfloat(fabsf(albedo[i] - mean[i]), <, slack + off);
        }
}

/* Sides asked for one by one sum up to both together, and each is certain. */
static void test_sides_apart(void)
{
    for (size_t m = 0; m < G_N_ELEMENTS(MODELS); m++)
        for (int k = 0; k < 4; k++) {
            drawing d = {.b = make(&MODELS[m], 0.0f, ALL_WAVELENGTHS)};
            d.wo = world(&d.b, (float[]){20, 60, 110, 165}[k], 0.2f);
            float errors[3];
            spectrum sum = {0};
            for (int side = 0; side < 2; side++) {
                d.mask =
                    LOBE_ALL & ~(unsigned)(side ? LOBE_REFLECTION : LOBE_TRANSMISSION);
                sum += mean_weight(&d, 10000, &errors[side]);
            }
            d.mask = LOBE_ALL;
            spectrum all = mean_weight(&d, 10000, &errors[2]);
            float slack = 5.5f * (errors[0] + errors[1] + errors[2]) + 1e-4f;
            for (int i = 0; i < N_WAVELENGTHS; i++)
                g_assert_cmpfloat(fabsf(sum[i] - all[i]), <, slack);
        }
}

/* Mean weight by class of draws of all lobes, once their class is settled. */
static void mean_by_class(const drawing *d, int n, spectrum mean[2], float error[2])
{
    spectrum squares[2] = {{0}, {0}};
    mean[0] = mean[1] = (spectrum){0};
    for (int i = 0; i < n; i++) {
        sampler s = sampler_make(12, (uint64_t)i);
        bsdf_sample out;
        float u_lobe = sampler_1d(&s);
        vec2 u = sampler_2d(&s);
        if (!bsdf_sample_direction(&d->b, d->wo, u_lobe, u, LOBE_ALL, d->mode, &out))
            continue;
        bsdf_settle_class(&d->b, d->wo, d->mode, sampler_1d(&s), &out);
        if (out.lobe & LOBE_SPECULAR)
            continue;
        int class = (out.lobe & LOBE_DIFFUSE) ? 0 : 1;
        mean[class] += out.weight / (float)n;
        squares[class] += out.weight * out.weight / (float)n;
    }
    for (int k = 0; k < 2; k++)
        error[k] = sqrtf(spectrum_max(squares[k] - mean[k] * mean[k]) / (float)n);
}

/* Of both classes, light that is said to go by one is what that one alone sends. */
static void test_classes_apart(void)
{
    static const unsigned classes[2] = {LOBE_DIFFUSE, LOBE_GLOSSY};
    for (size_t m = 0; m < G_N_ELEMENTS(MODELS); m++)
        for (int k = 0; k < 4; k++) {
            drawing d = {.b = make(&MODELS[m], k & 1 ? 0.3f : 0.0f, ALL_WAVELENGTHS),
                         .mode = k & 2 ? TRANSPORT_IMPORTANCE : TRANSPORT_RADIANCE};
            if (!bsdf_has_both(&d.b))
                continue;
            spectrum by_class[2];
            float errors[2], error;
            d.wo = world(&d.b, (float[]){20, 55, 60, 40}[k], 0.2f);
            mean_by_class(&d, 20000, by_class, errors);
            for (int c = 0; c < 2; c++) {
                d.mask = classes[c] | LOBE_ANY_SIDE;
                spectrum alone = mean_weight(&d, 20000, &error);
                float slack = 5.5f * (errors[c] + error) + 1e-4f;
                for (int i = 0; i < N_WAVELENGTHS; i++)
                    g_assert_cmpfloat(fabsf(by_class[c][i] - alone[i]), <, slack);
            }
        }
}

/* The mean over dispersed samples of (weight, direction) is each lane's own truth. */
static void test_dispersion(void)
{
    model flint = {"flint", make_flint, 1.0};
    for (int side = 0; side < 2; side++) {
        bsdf b = make(&flint, 0.0f, ALL_WAVELENGTHS);
        vec3 wo = world(&b, side ? 150.0f : 40.0f, 0.1f);
        spectrum refracted = {0}, tangent = {0};
        enum { N = 1 << 14 };
        for (uint64_t i = 0; i < N; i++) {
            sampler s = sampler_make(3, i);
            bsdf_sample out;
            float u_lobe = sampler_1d(&s);
            g_assert_true(bsdf_sample_direction(&b, wo, u_lobe, sampler_2d(&s), LOBE_ALL,
                                                TRANSPORT_IMPORTANCE, &out));
            if (out.lobe & LOBE_REFLECTION) {
                g_assert_cmpint(out.wavelength, ==, ALL_WAVELENGTHS);
                continue;
            }
            g_assert_cmpint(out.wavelength, >=, 0);
            g_assert_cmpfloat(spectrum_sum(out.weight), ==, out.weight[out.wavelength]);
            refracted += out.weight / N;
            tangent += out.weight * length3(cross3(out.wi, b.shading.n)) / N;
        }
        for (int i = 0; i < N_WAVELENGTHS; i++) {
            float eta = side ? 1.0f / FLINT[i] : FLINT[i];
            float cos_o = fabsf(dot3(wo, b.shading.n));
            float t = 1.0f - fresnel_dielectric(cos_o, eta);
            float sine = sqrtf(1.0f - cos_o * cos_o) / eta;
            g_assert_cmpfloat(fabsf(refracted[i] / t - 1.0f), <, 0.01f);
            g_assert_cmpfloat(fabsf(tangent[i] / refracted[i] / sine - 1.0f), <, 1e-4f);
        }
    }
}

/* The rough one's lanes agree with single-lane bsdfs. */
static void test_rough_dispersion(void)
{
    model flint = {"rough flint", make_rough_flint, 1.0};
    bsdf all = make(&flint, 0.0f, ALL_WAVELENGTHS);
    vec3 wo = world(&all, 50.0f, 0.3f);
    for (uint64_t i = 0; i < 500; i++) {
        sampler s = sampler_make(19, i);
        bsdf_sample out;
        float u_lobe = sampler_1d(&s);
        if (!bsdf_sample_direction(&all, wo, u_lobe, sampler_2d(&s), LOBE_ALL,
                                   TRANSPORT_RADIANCE, &out))
            continue;
        spectrum f = bsdf_eval(&all, wo, out.wi, LOBE_ALL, TRANSPORT_RADIANCE);
        float pdf = 0.0f;
        for (int wavelength = 0; wavelength < N_WAVELENGTHS; wavelength++) {
            bsdf one = make(&flint, 0.0f, wavelength);
            spectrum g = bsdf_eval(&one, wo, out.wi, LOBE_ALL, TRANSPORT_RADIANCE);
            g_assert_cmpfloat(fabsf(g[wavelength] - f[wavelength]), <=,
                              1e-5f * g[wavelength]);
            pdf +=
                bsdf_pdf(&one, wo, out.wi, LOBE_ALL, TRANSPORT_RADIANCE) / N_WAVELENGTHS;
        }
        g_assert_cmpfloat(fabsf(pdf / out.pdf - 1.0f), <, 1e-3f);
    }
}

/* Radiance is squeezed by 1/η² on the way in; photons are not. */
static void test_modes(void)
{
    model glass = {"glass", make_glass, 1.0};
    bsdf b = make(&glass, 0.0f, ALL_WAVELENGTHS);
    for (int side = 0; side < 2; side++) {
        vec3 wo = world(&b, side ? 160.0f : 20.0f, 0.0f);
        float eta = side ? 1.0f / 1.5f : 1.5f;
        unsigned mask = LOBE_SPECULAR | LOBE_TRANSMISSION;
        bsdf_sample photon, eye;
        g_assert_true(bsdf_sample_direction(&b, wo, 0.9f, (vec2){0.5f, 0.5f}, mask,
                                            TRANSPORT_IMPORTANCE, &photon));
        g_assert_true(bsdf_sample_direction(&b, wo, 0.9f, (vec2){0.5f, 0.5f}, mask,
                                            TRANSPORT_RADIANCE, &eye));
        float t = 1.0f - fresnel_dielectric(fabsf(dot3(wo, b.shading.n)), eta);
        g_assert_cmpfloat(fabsf(photon.weight[0] - t), <, 1e-5f);
        g_assert_cmpfloat(fabsf(eye.weight[0] - t / (eta * eta)), <, 1e-5f);
        g_assert_cmpfloat(fabsf(eye.eta - eta), <, 1e-6f);
        g_assert_cmpfloat(eye.pdf, ==, 1.0f);
        float sine = length3(cross3(wo, b.shading.n));
        g_assert_cmpfloat(fabsf(length3(cross3(eye.wi, b.shading.n)) * eta - sine), <,
                          1e-5f);
    }
}

/* Where the normals disagree about the side the geometric one tells it, and wide lobes
 * are not lit. */
static void test_disagreeing_normals(void)
{
    for (size_t m = 0; m < G_N_ELEMENTS(MODELS); m++)
        for (uint64_t i = 0; i < 3000; i++) {
            sampler s = sampler_make(99, i);
            bsdf b = make(&MODELS[m], 0.6f, ALL_WAVELENGTHS);
            vec3 wo = random_direction(&s), wi = random_direction(&s);
            bool lit = dot3(wi, b.n_geom) * dot3(wi, b.shading.n) > 0.0f;
            unsigned wide = LOBE_DIFFUSE | LOBE_ANY_SIDE;
            spectrum f = bsdf_eval(&b, wo, wi, wide, TRANSPORT_RADIANCE);
            if (!lit)
                g_assert_true(spectrum_is_black(f));
            bool reflection = dot3(wo, b.n_geom) * dot3(wi, b.n_geom) > 0.0f;
            unsigned other = reflection ? LOBE_REFLECTION : LOBE_TRANSMISSION;
            f = bsdf_eval(&b, wo, wi, LOBE_ALL & ~other, TRANSPORT_RADIANCE);
            g_assert_true(spectrum_is_black(f));
        }
}

/* Seen from between the planes a bent model reflects what an upright one does: all of it
 * by narrow lobes, what the lit part of the sky gives by wide ones. */
static void test_folded_energy(void)
{
    for (size_t m = 0; m < G_N_ELEMENTS(MODELS); m++)
        for (uint64_t i = 0; i < 40; i++) {
            sampler s = sampler_make(98, i);
            drawing d = {.b = make(&MODELS[m], 0.5f, ALL_WAVELENGTHS),
                         .mask = LOBE_ALL,
                         .mode = TRANSPORT_RADIANCE};
            d.wo = random_direction(&s);
            float error, upright_error;
            float found = spectrum_mean(mean_weight(&d, 2000, &error));
            vec3 bisector = normalize3(d.b.shading.n - d.b.n_geom);
            if (dot3(d.wo, d.b.n_geom) * dot3(d.wo, d.b.shading.n) < 0.0f)
                d.wo -= 2.0f * dot3(d.wo, bisector) * bisector;
            d.b.n_geom = d.b.shading.n;
            float upright = spectrum_mean(mean_weight(&d, 2000, &upright_error));
            float slack = 6.0f * (error + upright_error) + 1e-3f;
            g_assert_cmpfloat(found, <, upright + slack);
            if (!(d.b.lobes & LOBE_DIFFUSE))
                g_assert_cmpfloat(found, >, upright - slack);
            else
                g_assert_cmpfloat(found, >, 0.3f * upright - slack);
        }
}

static void test_refractor(void)
{
    model refractor = {"refractor", make_refractor, 1.0};
    bsdf b = make(&refractor, 0.0f, 2);
    bsdf_sample s;
    vec2 u = {0.1f, 0.2f};
    vec3 outside = world(&b, 80.0f, 0.0f), inside = world(&b, 120.0f, 0.0f);
    g_assert_true(
        bsdf_sample_direction(&b, outside, 0.0f, u, LOBE_ALL, TRANSPORT_IMPORTANCE, &s));
    g_assert_cmpuint(s.lobe, ==, LOBE_SPECULAR | LOBE_TRANSMISSION);
    g_assert_cmpfloat(s.weight[2], ==, 1.0f);
    g_assert_false(bsdf_sample_direction(
        &b, outside, 0.0f, u, LOBE_SPECULAR | LOBE_REFLECTION, TRANSPORT_IMPORTANCE, &s));
    g_assert_true(
        bsdf_sample_direction(&b, inside, 0.9f, u, LOBE_ALL, TRANSPORT_IMPORTANCE, &s));
    g_assert_cmpuint(s.lobe, ==, LOBE_SPECULAR | LOBE_REFLECTION);
    g_assert_cmpfloat(s.weight[2], ==, 1.0f);
}

/* The highlight reflects its share at normal incidence and never more. */
static void test_phong_energy(void)
{
    frame up = frame_from_normal(vec3_make(0, 0, 1));
    for (int k = 0; k < 5; k++) {
        float n = (float[]){0, 3, 20, 300, 10000}[k];
        bsdf b = {.wavelength = ALL_WAVELENGTHS, .shading = up, .n_geom = up.n};
        bsdf_make_phong(&b, spectrum_fill(0.5f), spectrum_fill(1.0f), n);
        for (int i = 0; i < 10; i++) {
            float z = 1.0f - (float)i / 10.0f;
            drawing d = {
                .b = b, .wo = vec3_make(sqrtf(1.0f - z * z), 0, z), .mask = LOBE_ALL};
            float error;
            float all = mean_weight(&d, 20000, &error)[0];
            g_assert_cmpfloat(all, <, 1.0f + 5.5f * error + 1e-3f);
            if (i == 0)
                g_assert_cmpfloat(fabsf(all - 1.0f), <, 5.5f * error + 1e-3f);
        }
    }
}

/* Fresnel at normal incidence, at Brewster's angle and of a metal against the formulas
 * for these cases. */
static void test_fresnel(void)
{
    g_assert_cmpfloat(fabsf(fresnel_dielectric(1.0f, 1.5f) - 0.04f), <, 1e-6f);
    float brewster = cosf(atanf(1.5f)), turned = (1.0f - 2.25f) / (1.0f + 2.25f);
    float r = fresnel_dielectric(brewster, 1.5f);
    g_assert_cmpfloat(fabsf(r - 0.5f * turned * turned), <, 1e-6f);
    g_assert_cmpfloat(fresnel_dielectric(0.5f, 1.0f / 1.5f), ==, 1.0f);
    spectrum n = gold_eta(), k = gold_k();
    spectrum normal =
        ((n - 1.0f) * (n - 1.0f) + k * k) / ((n + 1.0f) * (n + 1.0f) + k * k);
    assert_near(fresnel_conductor(1.0f, n, k), normal, 1e-5f, "gold");
    for (int i = 1; i < 10; i++) {
        float c = 0.1f * (float)i;
        spectrum metal = fresnel_conductor(c, spectrum_fill(1.5f), (spectrum){0});
        g_assert_cmpfloat(fabsf(metal[0] - fresnel_dielectric(c, 1.5f)), <, 1e-5f);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/bsdf/fresnel", test_fresnel);
    g_test_add_func("/bsdf/density", test_density);
    g_test_add_func("/bsdf/weights", test_weights);
    g_test_add_func("/bsdf/adjoint", test_adjoint);
    g_test_add_func("/bsdf/reciprocity", test_reciprocity);
    g_test_add_func("/bsdf/energy", test_energy);
    g_test_add_func("/bsdf/sides-apart", test_sides_apart);
    g_test_add_func("/bsdf/dispersion", test_dispersion);
    g_test_add_func("/bsdf/rough-dispersion", test_rough_dispersion);
    g_test_add_func("/bsdf/modes", test_modes);
    g_test_add_func("/bsdf/disagreeing-normals", test_disagreeing_normals);
    g_test_add_func("/bsdf/folded-energy", test_folded_energy);
    g_test_add_func("/bsdf/refractor", test_refractor);
    g_test_add_func("/bsdf/classes-apart", test_classes_apart);
    g_test_add_func("/bsdf/phong-energy", test_phong_energy);
    zoo_open();
    int failed = g_test_run();
    zoo_close();
    return failed;
}
