/*
 * Blinn-Phong, normalised: a Lambertian part and a highlight
 *
 *   f = ρ/π + s (n+2)(n+4) / (8π (n + 2^(-n/2))) (h·n)^n
 *
 * whose factor makes the highlight reflect exactly s at normal incidence, where it is
 * brightest, so that energy is kept at all angles. Blinn 1977; the factor: Giesen,
 * "Phong and Blinn-Phong Normalization Factors", 2009. Reciprocal as h is symmetric.
 * Where ρ + s would exceed one, ρ gives way. The exponent acts like a roughness
 * alpha = sqrt(2/(n+2)), which decides about the lobe's class.
 */
#include "bsdf/bsdf_models.h"
#include "bsdf/fresnel.h"
#include "math/warp.h"

enum { MATT = LOBE_DIFFUSE | LOBE_REFLECTION };

typedef struct phong {
    spectrum diffuse, specular;
    float exponent, factor;
} phong;

_Static_assert(sizeof(phong) <= BSDF_DATA_SIZE, "phong must fit");

static const phong *data_of(const bsdf *b)
{
    return (const void *)b->data;
}

static unsigned shine_lobe(const phong *p)
{
    float alpha = sqrtf(2.0f / (p->exponent + 2.0f));
    return (alpha < GLOSSY_ALPHA ? LOBE_GLOSSY : LOBE_DIFFUSE) | LOBE_REFLECTION;
}

/* Chance of the highlight; negative if nothing is wanted. */
static float highlight_chance(const bsdf *b, unsigned lobes)
{
    const phong *p = data_of(b);
    bool shine = lobe_wanted(lobes, shine_lobe(p)), matt = lobe_wanted(lobes, MATT);
    if (!shine || !matt)
        return shine ? 1.0f : matt ? 0.0f : -1.0f;
    float s = wavelength_mean(b, p->specular), d = wavelength_mean(b, p->diffuse);
    return s + d > 0.0f ? s / (s + d) : 0.0f;
}

/* cosⁿ of unit h by its sine, which keeps the digits that a high n needs near the top. */
static float cosine_power(vec3 h, float n)
{
    float sine2 = h[0] * h[0] + h[1] * h[1];
    return sine2 < 1.0f ? expf(0.5f * n * log1pf(-sine2)) : powf(fabsf(h[2]), n);
}

static spectrum phong_eval(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                           transport_mode mode)
{
    (void)mode;
    const phong *p = data_of(b);
    spectrum f = {0};
    if (!(wo[2] * wi[2] > 0.0f))
        return f;
    if (lobe_wanted(lobes, MATT))
        f += p->diffuse * INV_PI_F;
    if (lobe_wanted(lobes, shine_lobe(p))) {
        vec3 h = normalize3(wo + wi);
        f += p->specular * (p->factor * cosine_power(h, p->exponent));
    }
    return f;
}

static float phong_pdf(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                       transport_mode mode)
{
    (void)mode;
    float chance = highlight_chance(b, lobes), pdf = 0.0f;
    if (!(wo[2] * wi[2] > 0.0f) || chance < 0.0f)
        return 0.0f;
    if (chance > 0.0f) {
        float n = data_of(b)->exponent;
        vec3 h = normalize3(wo + wi);
        float of_h = (n + 1.0f) * 0.5f * INV_PI_F * cosine_power(h, n);
        pdf += chance * of_h / (4.0f * fabsf(dot3(wo, h)));
    }
    return pdf + (1.0f - chance) * fabsf(wi[2]) * INV_PI_F;
}

/* Normals with density (n+1)/(2π) cosⁿ. */
static vec3 sample_half(float n, vec2 u)
{
    float sine2 = -expm1f(2.0f / (n + 1.0f) * log1pf(-u.x)), phi = 2.0f * PI_F * u.y;
    float r = sqrtf(sine2);
    return vec3_make(r * cosf(phi), r * sinf(phi), sqrtf(1.0f - sine2));
}

static bool phong_sample(const bsdf *b, vec3 wo, float u_lobe, vec2 u, unsigned lobes,
                         transport_mode mode, bsdf_sample *out)
{
    const phong *p = data_of(b);
    float chance = highlight_chance(b, lobes);
    if (chance < 0.0f)
        return false;
    bool flip = wo[2] < 0.0f, shine = u_lobe < chance;
    vec3 o = flip_z(wo, flip);
    vec3 i = shine ? reflect3(o, sample_half(p->exponent, u)) : warp_cosine_hemisphere(u);
    if (!(i[2] > 0.0f))
        return false;
    out->wi = flip_z(i, flip);
    out->pdf = phong_pdf(b, wo, out->wi, lobes, mode);
    out->weight = phong_eval(b, wo, out->wi, lobes, mode) * (i[2] / out->pdf);
    out->lobe = shine ? shine_lobe(p) : (unsigned)MATT;
    return out->pdf > 0.0f;
}

/* ∫ of the highlight, by the midpoints of its own sampling: normals of some elevations,
   each turned around by odd eighths of a half circle. */
static float highlight_albedo(const phong *p, vec3 o)
{
    enum { N = 8 };
    const float c = 0.92387953f, s = 0.38268343f; /* of π/8 */
    const float x[N] = {c, s, -s, -c, -c, -s, s, c}, y[N] = {s, c, c, s, -s, -c, -c, -s};
    float sum = 0.0f, n = p->exponent;
    for (int i = 0; i < N; i++) {
        vec3 at = sample_half(n, (vec2){((float)i + 0.5f) / N, 0.0f});
        for (int k = 0; k < N; k++) {
            vec3 h = vec3_make(at[0] * x[k], at[0] * y[k], at[2]);
            float out = reflect3(o, h)[2], up = dot3(o, h);
            sum += out > 0.0f && up > 0.0f ? out * up : 0.0f;
        }
    }
    return sum * p->factor * 8.0f * PI_F / ((n + 1.0f) * N * N);
}

static spectrum phong_albedo(const bsdf *b, vec3 wo, unsigned lobes)
{
    const phong *p = data_of(b);
    spectrum sum = {0};
    if (lobe_wanted(lobes, MATT))
        sum += p->diffuse;
    if (lobe_wanted(lobes, shine_lobe(p)))
        sum += p->specular * highlight_albedo(p, flip_z(wo, wo[2] < 0.0f));
    return sum;
}

void bsdf_make_phong(bsdf *b, spectrum reflectance, spectrum specular, float exponent)
{
    static const bsdf_ops ops = {
        .name = "phong",
        .eval = phong_eval,
        .pdf = phong_pdf,
        .sample = phong_sample,
        .albedo = phong_albedo,
    };
    phong *p = (void *)b->data;
    float n = exponent;
    *p = (phong){.specular = specular, .exponent = n};
    p->factor = (n + 2.0f) * (n + 4.0f) / (8.0f * PI_F * (n + exp2f(-0.5f * n)));
    for (int i = 0; i < N_WAVELENGTHS; i++)
        p->diffuse[i] = minf(reflectance[i], 1.0f - specular[i]);
    b->ops = &ops;
    b->lobes = shine_lobe(p) | MATT;
    b->lambertian = !(shine_lobe(p) & LOBE_DIFFUSE);
    b->rho = p->diffuse;
}
