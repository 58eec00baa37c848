/*
 * A diffuse base under a dielectric coat, in closed form.
 *
 * Light from wi reaches the base with share C(wi), leaves it by Lambert's law, and is
 * thrown back and forth between base and coat, a geometric series in x = ρ r of albedo
 * and internal reflectance:
 *
 *   f(wo, wi) = coat(wo, wi) + ρ/(π η²) C(wi) C(wo) (1 + x + x² + ... + x^(n-1))
 *
 * which is what a random walk between the two layers (pbrt-v4's LayeredBxDF without a
 * medium) has as its mean: n is half its maxdepth, rounded up, and its default thickness
 * of 0.01 absorbs a little on every crossing. The closed form is symmetric, has no noise,
 * and with a smooth coat, no thickness and n = ∞ reflects all light if ρ = 1.
 * Series: Wolff, Nayar & Oren, "Improved Diffuse Reflection Models", 1998.
 *
 * The coat is as rough along s as along t: what brushed ones do depends on too much for a
 * table (bsdf_layered.h).
 */
#include "math/warp.h"
#include "scene/bsdf_models.h"
#include "scene/fresnel.h"

enum { BASE = LOBE_DIFFUSE | LOBE_REFLECTION };

typedef struct coated {
    spectrum base; /* ρ/(π η²) times the series */
    spectrum
        albedo; /* of the base for light that reached it: ρ times series and escape */
    spectrum eta;
    ggx roughness;
    bool grey_eta; /* eta is the same in all lanes */
    const coat_table *table;
} coated;

_Static_assert(sizeof(coated) <= BSDF_DATA_SIZE, "a coated base must fit");

/* What is wanted of a query, and the chance that sampling takes the coat. */
typedef struct choice {
    bool coat, base;
    float p_coat;
} choice;

static const coated *data_of(const bsdf *b)
{
    return (const void *)b->data;
}

static unsigned coat_lobe(const coated *c)
{
    return ggx_class(c->roughness) | LOBE_REFLECTION;
}

typedef float (*coat_function)(const coat_table *table, float alpha, float eta, float mu);

static spectrum over_lanes(const coated *c, coat_function f, vec3 w)
{
    float alpha = c->roughness.alpha_x;
    if (c->grey_eta)
        return spectrum_fill(f(c->table, alpha, c->eta[0], w[2]));
    spectrum out;
    for (int i = 0; i < N_LANES; i++)
        out[i] = f(c->table, alpha, c->eta[i], w[2]);
    return out;
}

static choice choose(const bsdf *b, vec3 wo, unsigned lobes)
{
    const coated *c = data_of(b);
    choice out = {.coat = lobe_wanted(lobes, coat_lobe(c)),
                  .base = lobe_wanted(lobes, BASE),
                  .p_coat = 1.0f};
    if (!out.base)
        return out;
    if (!out.coat) {
        out.p_coat = 0.0f;
        return out;
    }
    float coat = lane_mean(b, over_lanes(c, coat_reflected, wo));
    float base = lane_mean(b, c->albedo * over_lanes(c, coat_crossing, wo));
    if (base > 0.0f)
        out.p_coat = coat / (coat + base);
    return out;
}

static bool has_facets(const coated *c, const choice *wanted)
{
    return wanted->coat && !ggx_is_smooth(c->roughness);
}

static spectrum facets_eval(const coated *c, vec3 o, vec3 i)
{
    vec3 m = normalize3(o + i);
    float so = ggx_stretched(c->roughness, o), si = ggx_stretched(c->roughness, i);
    return fresnel_dielectric_lanes(dot3(o, m), c->eta) *
           (ggx_density(c->roughness, m) / (2.0f * (o[2] * si + i[2] * so)));
}

static float facets_pdf(const coated *c, vec3 o, vec3 i)
{
    vec3 m = normalize3(o + i);
    return ggx_density(c->roughness, m) /
           (2.0f * (o[2] + ggx_stretched(c->roughness, o)));
}

/* For o and i above. */
static spectrum eval_above(const coated *c, const choice *wanted, vec3 o, vec3 i)
{
    spectrum f = {0};
    if (has_facets(c, wanted))
        f += facets_eval(c, o, i);
    if (wanted->base)
        f += c->base * over_lanes(c, coat_crossing, o) * over_lanes(c, coat_crossing, i);
    return f;
}

static float pdf_above(const coated *c, const choice *wanted, vec3 o, vec3 i)
{
    float pdf = 0.0f;
    if (has_facets(c, wanted))
        pdf += wanted->p_coat * facets_pdf(c, o, i);
    if (wanted->base)
        pdf += (1.0f - wanted->p_coat) * i[2] * INV_PI_F;
    return pdf;
}

static spectrum coated_eval(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                            transport_mode mode)
{
    (void)mode;
    if (!(wo[2] * wi[2] > 0.0f))
        return (spectrum){0};
    const coated *c = data_of(b);
    bool flip = wo[2] < 0.0f;
    choice wanted = {.coat = lobe_wanted(lobes, coat_lobe(c)),
                     .base = lobe_wanted(lobes, BASE)};
    return eval_above(c, &wanted, flip_z(wo, flip), flip_z(wi, flip));
}

static float coated_pdf(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                        transport_mode mode)
{
    (void)mode;
    if (!(wo[2] * wi[2] > 0.0f))
        return 0.0f;
    bool flip = wo[2] < 0.0f;
    vec3 o = flip_z(wo, flip);
    choice wanted = choose(b, o, lobes);
    return pdf_above(data_of(b), &wanted, o, flip_z(wi, flip));
}

static void mirror(const coated *c, const choice *wanted, vec3 o, bsdf_sample *out)
{
    out->wi = vec3_make(-o[0], -o[1], o[2]);
    out->pdf = wanted->p_coat;
    out->weight = fresnel_dielectric_lanes(o[2], c->eta) / out->pdf;
    out->lobe = LOBE_SPECULAR | LOBE_REFLECTION;
}

static bool coated_sample(const bsdf *b, vec3 wo, float u_lobe, vec2 u, unsigned lobes,
                          transport_mode mode, bsdf_sample *out)
{
    (void)mode;
    const coated *c = data_of(b);
    bool flip = wo[2] < 0.0f;
    vec3 o = flip_z(wo, flip);
    choice wanted = choose(b, o, lobes);
    if (!wanted.coat && !wanted.base)
        return false;
    bool coat = u_lobe < wanted.p_coat;
    if (coat && ggx_is_smooth(c->roughness)) {
        mirror(c, &wanted, o, out);
    } else {
        vec3 i = coat ? reflect3(o, ggx_sample_visible(c->roughness, o, u))
                      : warp_cosine_hemisphere(u);
        if (!(i[2] > 0.0f))
            return false;
        out->wi = i;
        out->pdf = pdf_above(c, &wanted, o, i);
        out->weight = eval_above(c, &wanted, o, i) * (i[2] / out->pdf);
        out->lobe = coat ? coat_lobe(c) : (unsigned)BASE;
    }
    out->wi = flip_z(out->wi, flip);
    return out->pdf > 0.0f;
}

static spectrum coated_albedo(const bsdf *b, vec3 wo, unsigned lobes)
{
    const coated *c = data_of(b);
    vec3 o = flip_z(wo, wo[2] < 0.0f);
    spectrum sum = {0};
    if (lobe_wanted(lobes, coat_lobe(c)))
        sum += over_lanes(c, coat_reflected, o);
    if (lobe_wanted(lobes, BASE))
        sum += c->albedo * over_lanes(c, coat_crossing, o);
    return sum;
}

/* 1 + x + ... + x^(n-1) for 0 <= x < 1. */
static float series(float x, int n)
{
    return x < 0.999f ? (1.0f - powf(x, (float)n)) / (1.0f - x)
                      : minf((float)n, 1.0f / maxf(1.0f - x, 1e-6f));
}

static bool same_in_all_lanes(spectrum s)
{
    for (int i = 1; i < N_LANES; i++)
        if (fabsf(s[i] - s[0]) > 1e-6f * s[0])
            return false;
    return true;
}

void bsdf_make_coated(bsdf *b, spectrum rho, spectrum eta, float alpha,
                      const coat_table *table, int bounces)
{
    static const bsdf_ops ops = {
        .name = "coated diffuse",
        .eval = coated_eval,
        .pdf = coated_pdf,
        .sample = coated_sample,
        .albedo = coated_albedo,
    };
    coated *c = (void *)b->data;
    *c = (coated){.eta = eta,
                  .roughness = ggx_make(alpha, alpha),
                  .grey_eta = same_in_all_lanes(eta),
                  .table = table};
    spectrum internal, escape, sum;
    for (int i = 0; i < N_LANES; i++) {
        bool known = i && c->grey_eta;
        internal[i] = known ? internal[0] : coat_internal(table, alpha, eta[i]);
        escape[i] = known ? escape[0] : coat_escape(table, alpha, eta[i]);
        sum[i] = series(rho[i] * internal[i], bounces);
    }
    c->base = rho * sum * INV_PI_F / (eta * eta);
    c->albedo = rho * sum * escape;
    b->ops = &ops;
    b->lobes = coat_lobe(c) | BASE;
    b->lambertian = false;
}
