/*
 * Metals: a mirror with the Fresnel reflectance of a complex index, or GGX facets of it.
 * Torrance & Sparrow 1967; facets as in microfacet.h.
 */
#include "bsdf/bsdf_models.h"
#include "bsdf/fresnel.h"

typedef struct conductor {
    spectrum eta, k;
    ggx roughness;
} conductor;

_Static_assert(sizeof(conductor) <= BSDF_DATA_SIZE, "a conductor must fit");

static const conductor *data_of(const bsdf *b)
{
    return (const void *)b->data;
}

static spectrum mirror_albedo(const bsdf *b, vec3 wo, unsigned lobes)
{
    if (!lobe_wanted(lobes, b->lobes))
        return (spectrum){0};
    const conductor *c = data_of(b);
    return fresnel_conductor(wo[2], c->eta, c->k);
}

static bool mirror_sample(const bsdf *b, vec3 wo, float u_lobe, vec2 u, unsigned lobes,
                          transport_mode mode, bsdf_sample *out)
{
    (void)u_lobe, (void)u, (void)mode;
    if (!lobe_wanted(lobes, b->lobes))
        return false;
    out->wi = vec3_make(-wo[0], -wo[1], wo[2]);
    out->weight = mirror_albedo(b, wo, lobes);
    out->pdf = 1.0f;
    out->lobe = b->lobes;
    return true;
}

static bool rough_reflects(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes)
{
    return lobe_wanted(lobes, b->lobes) && wo[2] * wi[2] > 0.0f;
}

static spectrum rough_eval(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                           transport_mode mode)
{
    (void)mode;
    if (!rough_reflects(b, wo, wi, lobes))
        return (spectrum){0};
    const conductor *c = data_of(b);
    bool flip = wo[2] < 0.0f;
    vec3 o = flip_z(wo, flip), i = flip_z(wi, flip), m = normalize3(o + i);
    float masked = 2.0f * (o[2] * ggx_stretched(c->roughness, i) +
                           i[2] * ggx_stretched(c->roughness, o));
    return fresnel_conductor(dot3(o, m), c->eta, c->k) *
           (ggx_density(c->roughness, m) / masked);
}

static float rough_pdf(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                       transport_mode mode)
{
    (void)mode;
    if (!rough_reflects(b, wo, wi, lobes))
        return 0.0f;
    const conductor *c = data_of(b);
    bool flip = wo[2] < 0.0f;
    vec3 o = flip_z(wo, flip), i = flip_z(wi, flip), m = normalize3(o + i);
    return ggx_density(c->roughness, m) /
           (2.0f * (o[2] + ggx_stretched(c->roughness, o)));
}

static bool rough_sample(const bsdf *b, vec3 wo, float u_lobe, vec2 u, unsigned lobes,
                         transport_mode mode, bsdf_sample *out)
{
    (void)u_lobe;
    if (!lobe_wanted(lobes, b->lobes))
        return false;
    const conductor *c = data_of(b);
    bool flip = wo[2] < 0.0f;
    vec3 o = flip_z(wo, flip);
    vec3 m = ggx_sample_visible(c->roughness, o, u);
    vec3 i = reflect3(o, m);
    if (!(i[2] > 0.0f))
        return false;
    out->wi = flip_z(i, flip);
    out->weight = fresnel_conductor(dot3(o, m), c->eta, c->k) *
                  ggx_visible_weight(c->roughness, o, i);
    out->pdf = rough_pdf(b, wo, out->wi, lobes, mode);
    out->lobe = b->lobes;
    return out->pdf > 0.0f;
}

static spectrum rough_albedo(const bsdf *b, vec3 wo, unsigned lobes)
{
    if (!lobe_wanted(lobes, b->lobes))
        return (spectrum){0};
    const conductor *c = data_of(b);
    vec3 o = flip_z(wo, wo[2] < 0.0f);
    spectrum sum = {0};
    vec2 u[GGX_FEW];
    ggx_few_points(o, u);
    for (int k = 0; k < GGX_FEW; k++) {
        vec3 m = ggx_sample_visible(c->roughness, o, u[k]), i = reflect3(o, m);
        if (i[2] > 0.0f)
            sum += fresnel_conductor(dot3(o, m), c->eta, c->k) *
                   ggx_visible_weight(c->roughness, o, i);
    }
    return sum / GGX_FEW;
}

void bsdf_make_conductor(bsdf *b, spectrum eta, spectrum k, ggx roughness)
{
    static const bsdf_ops mirror = {
        .name = "smooth conductor",
        .eval = bsdf_delta_eval,
        .pdf = bsdf_delta_pdf,
        .sample = mirror_sample,
        .albedo = mirror_albedo,
    };
    static const bsdf_ops rough = {
        .name = "rough conductor",
        .eval = rough_eval,
        .pdf = rough_pdf,
        .sample = rough_sample,
        .albedo = rough_albedo,
    };
    *(conductor *)(void *)b->data = (conductor){eta, k, roughness};
    b->ops = ggx_is_smooth(roughness) ? &mirror : &rough;
    b->lobes = ggx_class(roughness) | LOBE_REFLECTION;
    b->lambertian = false;
}
