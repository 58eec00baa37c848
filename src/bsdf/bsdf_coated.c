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
#include "bsdf/bsdf_models.h"
#include "bsdf/fresnel.h"
#include "math/warp.h"

enum { BASE = LOBE_DIFFUSE | LOBE_REFLECTION };

typedef struct coated {
    spectrum base; /* ρ/(π η²) times the series */
    spectrum
        albedo; /* of the base for light that reached it: ρ times series and escape */
    spectrum eta;
    ggx roughness;
    bool grey_eta; /* eta is the same in all wavelengths */
    const coat_table *table;
    coat_response coat; /* in wavelength 0 */
} coated;

_Static_assert(sizeof(coated) <= BSDF_DATA_SIZE, "a coated base must fit");

/* What is wanted of a query, and the chance that sampling takes the coat. */
typedef struct choice {
    bool coat, base;
    float p_coat;
    spectrum in; /* share of light from wo that reaches the base, if that is wanted */
} choice;

static const coated *data_of(const bsdf *b)
{
    return (const void *)b->data;
}

static unsigned coat_lobe(const coated *c)
{
    return ggx_class(c->roughness) | LOBE_REFLECTION;
}

typedef float (*coat_function)(const coat_response *c, float mu);

static spectrum over_wavelengths(const coated *c, coat_function f, vec3 w)
{
    if (c->grey_eta)
        return spectrum_fill(f(&c->coat, w[2]));
    spectrum out;
    for (int i = 0; i < N_WAVELENGTHS; i++) {
        const coat_response at = coat_find(c->table, c->roughness.alpha_x, c->eta[i]);
        out[i] = f(&at, w[2]);
    }
    return out;
}

static choice wanted_of(const coated *c, vec3 o, unsigned lobes)
{
    choice out = {.coat = lobe_wanted(lobes, coat_lobe(c)),
                  .base = lobe_wanted(lobes, BASE)};
    if (out.base)
        out.in = over_wavelengths(c, coat_crossing, o);
    return out;
}

static choice choose(const bsdf *b, vec3 o, unsigned lobes)
{
    const coated *c = data_of(b);
    choice out = wanted_of(c, o, lobes);
    out.p_coat = out.coat ? 1.0f : 0.0f;
    if (!out.coat || !out.base)
        return out;
    float coat = wavelength_mean(b, over_wavelengths(c, coat_reflected, o));
    float base = wavelength_mean(b, c->albedo * out.in);
    if (base > 0.0f)
        out.p_coat = coat / (coat + base);
    return out;
}

static bool has_facets(const coated *c, const choice *wanted)
{
    return wanted->coat && !ggx_is_smooth(c->roughness);
}

/* Facets that send light from i to o, up to Fresnel's share: by G2 and by G1. */
typedef struct facets {
    float cosine; /* of o at them */
    float density, pdf;
} facets;

static facets facets_between(const coated *c, vec3 o, vec3 i)
{
    vec3 m = normalize3(o + i);
    float so = ggx_stretched(c->roughness, o), si = ggx_stretched(c->roughness, i);
    float half = 0.5f * ggx_density(c->roughness, m);
    return (facets){.cosine = dot3(o, m),
                    .density = half / (o[2] * si + i[2] * so),
                    .pdf = half / (o[2] + so)};
}

/* For o and i above; met is only looked at where there are facets. */
static spectrum eval_above(const coated *c, const choice *wanted, const facets *met,
                           vec3 i)
{
    spectrum f = {0};
    if (has_facets(c, wanted))
        f += fresnel_dielectric_wavelengths(met->cosine, c->eta) * met->density;
    if (wanted->base)
        f += c->base * wanted->in * over_wavelengths(c, coat_crossing, i);
    return f;
}

static float pdf_above(const coated *c, const choice *wanted, const facets *met, vec3 i)
{
    float pdf = 0.0f;
    if (has_facets(c, wanted))
        pdf += wanted->p_coat * met->pdf;
    if (wanted->base)
        pdf += (1.0f - wanted->p_coat) * i[2] * INV_PI_F;
    return pdf;
}

static facets facets_if(const coated *c, const choice *wanted, vec3 o, vec3 i)
{
    return has_facets(c, wanted) ? facets_between(c, o, i) : (facets){0};
}

static spectrum coated_eval(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                            transport_mode mode)
{
    (void)mode;
    if (!(wo[2] * wi[2] > 0.0f))
        return (spectrum){0};
    const coated *c = data_of(b);
    bool flip = wo[2] < 0.0f;
    vec3 o = flip_z(wo, flip), i = flip_z(wi, flip);
    choice wanted = wanted_of(c, o, lobes);
    facets met = facets_if(c, &wanted, o, i);
    return eval_above(c, &wanted, &met, i);
}

static float coated_pdf(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                        transport_mode mode)
{
    (void)mode;
    if (!(wo[2] * wi[2] > 0.0f))
        return 0.0f;
    const coated *c = data_of(b);
    bool flip = wo[2] < 0.0f;
    vec3 o = flip_z(wo, flip), i = flip_z(wi, flip);
    choice wanted = choose(b, o, lobes);
    facets met = facets_if(c, &wanted, o, i);
    return pdf_above(c, &wanted, &met, i);
}

static void mirror(const coated *c, const choice *wanted, vec3 o, bsdf_sample *out)
{
    out->wi = vec3_make(-o[0], -o[1], o[2]);
    out->pdf = wanted->p_coat;
    out->weight = fresnel_dielectric_wavelengths(o[2], c->eta) / out->pdf;
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
        facets met = facets_if(c, &wanted, o, i);
        out->wi = i;
        out->pdf = pdf_above(c, &wanted, &met, i);
        out->weight = eval_above(c, &wanted, &met, i) * (i[2] / out->pdf);
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
        sum += over_wavelengths(c, coat_reflected, o);
    if (lobe_wanted(lobes, BASE))
        sum += c->albedo * over_wavelengths(c, coat_crossing, o);
    return sum;
}

/* 1 + x + ... + x^(n-1), by halves: the sum of 2n terms is that of n times 1 + x^n. */
static spectrum series(spectrum x, int n)
{
    spectrum sum = {0}, power = spectrum_fill(1.0f); /* of the top bits of n */
    for (int bit = 31 - __builtin_clz((unsigned)n | 1u); bit >= 0; bit--) {
        sum += sum * power;
        power *= power;
        if (n >> bit & 1) {
            sum += power;
            power *= x;
        }
    }
    return sum;
}

static bool same_in_all_wavelengths(spectrum s)
{
    for (int i = 1; i < N_WAVELENGTHS; i++)
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
                  .grey_eta = same_in_all_wavelengths(eta),
                  .table = table,
                  .coat = coat_find(table, alpha, eta[0])};
    spectrum internal = spectrum_fill(coat_internal(&c->coat));
    spectrum escape = spectrum_fill(coat_escape(&c->coat));
    for (int i = 1; i < N_WAVELENGTHS && !c->grey_eta; i++) {
        const coat_response at = coat_find(table, alpha, eta[i]);
        internal[i] = coat_internal(&at);
        escape[i] = coat_escape(&at);
    }
    spectrum sum = series(rho * internal, bounces);
    c->base = rho * sum * INV_PI_F / (eta * eta);
    c->albedo = rho * sum * escape;
    b->ops = &ops;
    b->lobes = coat_lobe(c) | BASE;
    b->lambertian = false;
}
