/*
 * The rough boundary between two dielectrics: GGX facets, each a smooth boundary.
 * Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007.
 *
 * Where the index differs between wavelengths, a sampled direction is one that any
 * wavelength may have led to; its density is the mean of the eight wavelengths'
 * densities, and all wavelengths keep their value there (the balance heuristic over
 * wavelengths: Wilkie et al., "Hero Wavelength Spectral Sampling", 2014). A wide lobe so
 * keeps its colours together, a narrow one comes to one wavelength with weight eight by
 * itself.
 */
#include "bsdf/bsdf_dielectric.h"

/* A pair of directions and what it is looked at with, turned so that wo[2] > 0. */
typedef struct rough_pair {
    const dielectric *d;
    vec3 wo, wi;
    spectrum eta;                         /* far over near */
    int first_wavelength, end_wavelength; /* to be looked at */
    bool reflects, transmits;             /* wanted */
    bool radiance;
} rough_pair;

typedef struct scattering {
    spectrum f;
    float pdf;
} scattering;

/* f and density of facets that mirror wo to wi, without Fresnel's factor. */
static float facet_reflection(const rough_pair *p, vec3 m, float *pdf)
{
    ggx g = p->d->roughness;
    float density = ggx_density(g, m), so = ggx_stretched(g, p->wo);
    *pdf = density / (2.0f * (p->wo[2] + so));
    return density / (2.0f * (p->wo[2] * ggx_stretched(g, p->wi) + p->wi[2] * so));
}

static scattering reflection(const rough_pair *p)
{
    scattering out = {0};
    float chosen = 0.0f, pdf;
    vec3 m = normalize3(p->wo + p->wi);
    float f = facet_reflection(p, m, &pdf), cos_m = dot3(p->wo, m);
    for (int i = p->first_wavelength; i < p->end_wavelength; i++) {
        float r = fresnel_dielectric(cos_m, p->eta[i]);
        out.f[i] = r * f;
        chosen += r;
    }
    chosen /= (float)(p->end_wavelength - p->first_wavelength);
    out.pdf = p->transmits ? pdf * chosen : pdf;
    return out;
}

float dielectric_refraction(ggx g, vec3 wo, vec3 wi, float eta, float *passes, float *pdf)
{
    *pdf = *passes = 0.0f;
    vec3 m = normalize3(wi * eta + wo);
    m = m[2] < 0.0f ? -m : m;
    float om = dot3(wo, m), im = dot3(wi, m);
    if (!(om > 0.0f) || !(im < 0.0f))
        return 0.0f;
    float so = ggx_stretched(g, wo), si = ggx_stretched(g, wi);
    float spread = 2.0f * ggx_density(g, m) * om * -im / square(im + om / eta);
    *passes = 1.0f - fresnel_dielectric(om, eta);
    *pdf = spread / (wo[2] + so);
    return *passes * spread / (-wi[2] * so + wo[2] * si);
}

static scattering transmission(const rough_pair *p)
{
    scattering out = {0};
    for (int i = p->first_wavelength; i < p->end_wavelength; i++) {
        float pdf, passes;
        out.f[i] = dielectric_refraction(p->d->roughness, p->wo, p->wi, p->eta[i],
                                         &passes, &pdf);
        if (p->radiance)
            out.f[i] /= square(p->eta[i]);
        out.pdf += p->reflects ? pdf * passes : pdf;
    }
    out.pdf /= (float)(p->end_wavelength - p->first_wavelength);
    return out;
}

/* What all wavelengths share stands in the first looked at; the tint is each wavelength's
 * own. */
static scattering scatter(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                          transport_mode mode)
{
    unsigned kind = b->lobes & ~(unsigned)LOBE_ANY_SIDE;
    bool flip = wo[2] < 0.0f;
    const dielectric *d = (const void *)b->data;
    bool per_wavelength = b->wavelength == ALL_WAVELENGTHS && d->disperses;
    int wavelength = b->wavelength == ALL_WAVELENGTHS ? 0 : b->wavelength;
    rough_pair p = {
        .d = d,
        .wo = flip_z(wo, flip),
        .wi = flip_z(wi, flip),
        .eta = dielectric_eta(b, wo),
        .first_wavelength = wavelength,
        .end_wavelength = per_wavelength ? N_WAVELENGTHS : wavelength + 1,
        .reflects = lobe_wanted(lobes, kind | LOBE_REFLECTION),
        .transmits = lobe_wanted(lobes, kind | LOBE_TRANSMISSION),
        .radiance = mode == TRANSPORT_RADIANCE,
    };
    bool same_side = p.wi[2] > 0.0f;
    if (same_side ? !p.reflects : !p.transmits)
        return (scattering){0};
    scattering s = same_side ? reflection(&p) : transmission(&p);
    if (!per_wavelength)
        s.f = spectrum_fill(s.f[wavelength]);
    if (!same_side)
        s.f *= d->tint;
    return s;
}

static spectrum rough_eval(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                           transport_mode mode)
{
    return scatter(b, wo, wi, lobes, mode).f;
}

static float rough_pdf(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                       transport_mode mode)
{
    return scatter(b, wo, wi, lobes, mode).pdf;
}

/* Through a facet's normal, on the side of +z; false if it ends on the wrong side. */
static bool refract_below(vec3 o, vec3 m, float eta, vec3 *i)
{
    return refract3(o, m, eta, i) && (*i)[2] < 0.0f;
}

static bool rough_sample(const bsdf *b, vec3 wo, float u_lobe, vec2 u, unsigned lobes,
                         transport_mode mode, bsdf_sample *out)
{
    unsigned kind = b->lobes & ~(unsigned)LOBE_ANY_SIDE;
    bool reflects = lobe_wanted(lobes, kind | LOBE_REFLECTION);
    bool transmits = lobe_wanted(lobes, kind | LOBE_TRANSMISSION);
    if (!reflects && !transmits)
        return false;
    const dielectric *d = (const void *)b->data;
    int wavelength = dielectric_pick_wavelength(b, &u_lobe);
    float eta = dielectric_eta(b, wo)[wavelength];
    vec3 o = flip_z(wo, wo[2] < 0.0f), m = ggx_sample_visible(d->roughness, o, u), i;
    bool mirror =
        reflects && (!transmits || u_lobe < fresnel_dielectric(dot3(o, m), eta));
    if (mirror) {
        i = reflect3(o, m);
        if (!(i[2] > 0.0f))
            return false;
    } else if (!refract_below(o, m, eta, &i))
        return false;
    out->wi = flip_z(i, wo[2] < 0.0f);
    scattering s = scatter(b, wo, out->wi, lobes, mode);
    out->pdf = s.pdf;
    out->weight = s.f * (fabsf(i[2]) / s.pdf);
    out->lobe = kind | (mirror ? LOBE_REFLECTION : LOBE_TRANSMISSION);
    out->eta = mirror ? 1.0f : eta;
    return s.pdf > 0.0f;
}

/* Share of light from o (above) that is reflected and transmitted, by few points. */
static void facet_shares(ggx g, vec3 wo, float eta, float *reflected, float *transmitted)
{
    vec2 u[GGX_FEW];
    *reflected = *transmitted = 0.0f;
    ggx_few_points(wo, u);
    for (int k = 0; k < GGX_FEW; k++) {
        vec3 m = ggx_sample_visible(g, wo, u[k]), i = reflect3(wo, m);
        float r = fresnel_dielectric(dot3(wo, m), eta);
        if (i[2] > 0.0f)
            *reflected += r * ggx_visible_weight(g, wo, i) / GGX_FEW;
        if (refract_below(wo, m, eta, &i))
            *transmitted += (1.0f - r) * ggx_visible_weight(g, wo, i) / GGX_FEW;
    }
}

static spectrum rough_albedo(const bsdf *b, vec3 wo, unsigned lobes)
{
    unsigned kind = b->lobes & ~(unsigned)LOBE_ANY_SIDE;
    const dielectric *d = (const void *)b->data;
    spectrum eta = dielectric_eta(b, wo), reflected = {0}, passed = {0};
    vec3 o = flip_z(wo, wo[2] < 0.0f);
    int n = d->disperses ? N_WAVELENGTHS : 1;
    for (int i = 0; i < n; i++) {
        float r, t;
        facet_shares(d->roughness, o, eta[i], &r, &t);
        reflected[i] = lobe_wanted(lobes, kind | LOBE_REFLECTION) ? r : 0.0f;
        passed[i] = lobe_wanted(lobes, kind | LOBE_TRANSMISSION) ? t : 0.0f;
    }
    if (d->disperses)
        return reflected + passed * d->tint;
    return spectrum_fill(reflected[0]) + passed[0] * d->tint;
}

const bsdf_ops dielectric_rough_ops = {
    .name = "rough dielectric",
    .eval = rough_eval,
    .pdf = rough_pdf,
    .sample = rough_sample,
    .albedo = rough_albedo,
};
