/*
 * "gltf": the surface that glTF 2.0 files describe, by metalness and roughness, with the
 * extensions transmission, volume, ior, specular, clearcoat, dispersion, anisotropy and
 * diffuse_transmission.
 *
 * Thin, it is one BSDF (bsdf_gltf.c). Solid, the part that transmits is glass: at each
 * point either that or the rest is chosen, by a number made from where the point lies, so
 * that on average they mix as they should, and next to always only one has a share.
 */
#include "bsdf/bsdf_gltf.h"
#include "bsdf/bsdf_models.h"
#include "material/material_inputs.h"
#include "material/material_kinds.h"
#include "math/sampler.h"
#include "medium/medium.h"

#include <string.h>

/* No matter reflects less than 2 % straight on: what is said to (Blender writes a colour
 * of black for "no specular") is dimmed at grazing angles too (Lagarde & de Rousiers,
 * "Moving Frostbite to Physically Based Rendering", 2014). */
#define GRAZING_PER_F0 50.0f

typedef struct gltf_material {
    spectrum_input base_color, specular_color, leaf_color;
    float_input metallic, roughness, specular, coat, coat_roughness, transmission, leaf;
    float_input anisotropy;       /* its strength */
    float_input along_u, along_v; /* where it goes: 0..1 stand for -1..1 */
    float turn;                   /* from there, rad */
    curve *eta;
    bool thin;
    medium *interior; /* NULL: clear, or thin */
} gltf_material;

/* The inputs at a point. */
typedef struct gltf_point {
    spectrum base, eta;
    float metallic, transmission;
    ggx roughness;
} gltf_point;

static void gltf_free(void *self)
{
    gltf_material *m = self;
    spectrum_input_clear(&m->base_color);
    spectrum_input_clear(&m->specular_color);
    spectrum_input_clear(&m->leaf_color);
    curve_unref(m->eta);
    medium_free(m->interior);
    g_free(m);
}

/* A share: in 0..1 if it is a constant; textures are cut to it where they are read. */
static bool read_share(float_input *in, const build_context *context, const params *p,
                       const char *name, float fallback, GError **error)
{
    if (!float_input_init(in, context, p, name, fallback, error))
        return false;
    if (in->texture || (in->constant >= 0.0f && in->constant <= 1.0f))
        return true;
    error_at(error, params_find(p, name)->place,
             "parameter '%s': expected a number in 0..1, found %g", name,
             (double)in->constant);
    return false;
}

static bool read_layers(gltf_material *m, const build_context *context, const params *p,
                        GError **error)
{
    return spectrum_input_init(&m->base_color, context, p, "basecolor", CURVE_ALBEDO,
                               curve_constant(1.0f), error) &&
           spectrum_input_init(&m->specular_color, context, p, "specularcolor",
                               CURVE_UNBOUNDED, curve_constant(1.0f), error) &&
           read_share(&m->metallic, context, p, "metallic", 1.0f, error) &&
           read_share(&m->roughness, context, p, "roughness", 1.0f, error) &&
           read_share(&m->specular, context, p, "specular", 1.0f, error) &&
           read_share(&m->coat, context, p, "clearcoat", 0.0f, error) &&
           read_share(&m->coat_roughness, context, p, "clearcoatroughness", 0.0f,
                      error) &&
           read_share(&m->transmission, context, p, "transmission", 0.0f, error) &&
           read_share(&m->leaf, context, p, "diffusetransmission", 0.0f, error) &&
           spectrum_input_init(&m->leaf_color, context, p, "diffusetransmissioncolor",
                               CURVE_ALBEDO, curve_constant(1.0f), error);
}

static bool read_anisotropy(gltf_material *m, const build_context *context,
                            const params *p, GError **error)
{
    return read_share(&m->anisotropy, context, p, "anisotropy", 0.0f, error) &&
           read_share(&m->along_u, context, p, "anisotropyu", 1.0f, error) &&
           read_share(&m->along_v, context, p, "anisotropyv", 0.5f, error) &&
           params_float(p, "anisotropyrotation", &m->turn, error);
}

static bool read_inside(gltf_material *m, const params *p, GError **error)
{
    m->thin = true;
    m->eta = eta_input(p, "eta", error);
    return m->eta && params_bool(p, "thin", &m->thin, error) &&
           (m->thin || medium_read(p, &m->interior, error));
}

static void *gltf_create(const build_context *context, const params *p, GError **error)
{
    gltf_material *m = g_new0(gltf_material, 1);
    if (read_layers(m, context, p, error) && read_anisotropy(m, context, p, error) &&
        read_inside(m, p, error))
        return m;
    gltf_free(m);
    return NULL;
}

static float share_of(const float_input *in, const surface_hit *hit)
{
    return clampf(float_input_eval(in, hit), 0.0f, 1.0f);
}

/* alpha = roughness². */
static ggx facets_of(const float_input *roughness, const surface_hit *hit)
{
    float alpha = square(share_of(roughness, hit));
    return ggx_make(alpha, alpha);
}

/* Brushed facets are rougher along one axis, up to 1 (KHR_materials_anisotropy). */
static ggx brushed(const gltf_material *m, const surface_hit *hit)
{
    float strength = square(share_of(&m->anisotropy, hit));
    float alpha = square(share_of(&m->roughness, hit));
    return ggx_make(lerpf(alpha, 1.0f, strength), alpha);
}

/* From the tangent to that axis. Where the texture is mirrored, so is the turn. */
static float turn_of(const gltf_material *m, const surface_hit *hit)
{
    float x = 2.0f * share_of(&m->along_u, hit) - 1.0f;
    float y = 2.0f * share_of(&m->along_v, hit) - 1.0f;
    bool mirrored = dot3(cross3(hit->n, hit->dpdu), hit->dpdv) < 0.0f;
    float turn = m->turn + atan2f(y, x);
    return mirrored ? -turn : turn;
}

static gltf_point point_of(const gltf_material *m, const surface_hit *hit,
                           const wavelengths *w)
{
    gltf_point at = {
        .base = spectrum_clamp(spectrum_input_eval(&m->base_color, hit, w), 0.0f, 1.0f),
        .eta = curve_eval(m->eta, w),
        .metallic = share_of(&m->metallic, hit),
        .roughness = brushed(m, hit),
    };
    at.transmission = share_of(&m->transmission, hit) * (1.0f - at.metallic);
    return at;
}

static gltf_surface surface_of(const gltf_material *m, const surface_hit *hit,
                               const wavelengths *w, const gltf_point *at)
{
    float specular = share_of(&m->specular, hit), metal = at->metallic;
    spectrum r = (at->eta - 1.0f) / (at->eta + 1.0f);
    spectrum plain = r * r * spectrum_input_eval(&m->specular_color, hit, w);
    plain = spectrum_clamp(plain, 0.0f, 1.0f) * specular;
    float grazing = specular * minf(1.0f, GRAZING_PER_F0 * spectrum_max(plain));
    float through = m->thin ? at->transmission : 0.0f;
    float matt = m->thin || at->transmission >= 1.0f
                     ? 1.0f - metal - at->transmission
                     : (1.0f - metal - at->transmission) / (1.0f - at->transmission);
    float leaf = share_of(&m->leaf, hit);
    spectrum leaf_color =
        leaf > 0.0f ? spectrum_input_eval(&m->leaf_color, hit, w) : spectrum_fill(0.0f);
    matt = maxf(0.0f, matt);
    return (gltf_surface){
        .f0 = plain * (1.0f - metal) + at->base * metal,
        .f90 = grazing * (1.0f - metal) + metal,
        .plain_f0 = spectrum_max(plain),
        .plain_f90 = grazing,
        .diffuse = at->base * (matt * (1.0f - leaf)),
        .leaf = spectrum_clamp(leaf_color, 0.0f, 1.0f) * (matt * leaf),
        .through = at->base * through,
        .coat = share_of(&m->coat, hit),
        .roughness = at->roughness,
        .turn = ggx_is_round(at->roughness) ? 0.0f : turn_of(m, hit),
        .coat_roughness = facets_of(&m->coat_roughness, hit),
    };
}

/* Nothing but the base: Lambert's law. */
static bool is_matt(const gltf_surface *s)
{
    return !(s->coat > 0.0f) && !(s->f90 > 0.0f) && spectrum_is_black(s->f0) &&
           spectrum_is_black(s->through) && spectrum_is_black(s->leaf);
}

static bool is_mostly_metal(float metallic)
{
    return metallic > 0.5f;
}

/* One deterministic path: the mirror of a metal, through glass, or the matt part. */
static void make_plainest(const gltf_material *m, const gltf_point *at, bsdf *out)
{
    if (at->transmission > 0.5f && m->thin)
        bsdf_make_clear(out);
    else if (at->transmission > 0.5f)
        bsdf_make_refractor(out, at->eta, !curve_is_constant(m->eta));
    else if (is_mostly_metal(at->metallic))
        bsdf_make_gltf(out, &(gltf_surface){.f0 = at->base, .f90 = 1.0f});
    else
        bsdf_make_diffuse(out, at->base);
}

/* A number in [0, 1) that belongs to the point. */
static float point_number(vec3 p)
{
    uint32_t bits[3];
    float xyz[3] = {p[0], p[1], p[2]};
    memcpy(bits, xyz, sizeof bits);
    uint64_t key = hash_mix(hash_mix(bits[0], bits[1]), bits[2]);
    return (float)(key >> 40) * 0x1p-24f;
}

static void gltf_bsdf(const void *self, const surface_hit *hit, const wavelengths *w,
                      const bsdf_options *options, bsdf *out)
{
    const gltf_material *m = self;
    gltf_point at = point_of(m, hit, w);
    if (options->deterministic) {
        make_plainest(m, &at, out);
        return;
    }
    bool glass = !m->thin && at.transmission > 0.0f &&
                 (at.transmission >= 1.0f || point_number(hit->p) < at.transmission);
    if (glass) {
        bsdf_make_tinted_dielectric(out, at.eta, !curve_is_constant(m->eta), at.roughness,
                                    at.base);
        return;
    }
    gltf_surface surface = surface_of(m, hit, w, &at);
    surface.is_followed = options->metal_is_followed && is_mostly_metal(at.metallic);
    if (is_matt(&surface))
        bsdf_make_diffuse(out, surface.diffuse);
    else
        bsdf_make_gltf(out, &surface);
}

static bool may_be_above_0(const float_input *in)
{
    return in->texture || in->constant > 0.0f;
}

static bool may_be_below_1(const float_input *in)
{
    return in->texture || in->constant < 1.0f;
}

static unsigned classes_of(const float_input *roughness)
{
    if (roughness->texture)
        return LOBE_SPECULAR | LOBE_GLOSSY | LOBE_DIFFUSE;
    return ggx_class(facets_of(roughness, NULL));
}

/* Of what passes light on. */
static unsigned glass_classes(const float_input *roughness)
{
    if (roughness->texture)
        return LOBE_SPECULAR | LOBE_GLOSSY;
    return ggx_glass_class(facets_of(roughness, NULL));
}

static unsigned facet_classes(const gltf_material *m)
{
    unsigned round = classes_of(&m->roughness);
    if (!may_be_above_0(&m->anisotropy))
        return round;
    if (m->roughness.texture || m->anisotropy.texture)
        return LOBE_SPECULAR | LOBE_GLOSSY | LOBE_DIFFUSE;
    return round | ggx_class(brushed(m, NULL));
}

static unsigned gltf_lobes(const void *self)
{
    const gltf_material *m = self;
    unsigned lobes = facet_classes(m) | LOBE_REFLECTION;
    if (may_be_below_1(&m->metallic) && may_be_above_0(&m->leaf))
        lobes |= LOBE_DIFFUSE | LOBE_TRANSMISSION;
    if (may_be_below_1(&m->metallic) && may_be_below_1(&m->transmission))
        lobes |= LOBE_DIFFUSE;
    if (may_be_below_1(&m->metallic) && may_be_above_0(&m->transmission))
        lobes |= LOBE_TRANSMISSION | glass_classes(&m->roughness);
    if (may_be_above_0(&m->coat))
        lobes |= classes_of(&m->coat_roughness);
    return lobes;
}

static bool gltf_is_metal(const void *self)
{
    const gltf_material *m = self;
    return m->metallic.texture || is_mostly_metal(m->metallic.constant);
}

static const medium *gltf_interior(const void *self)
{
    const gltf_material *m = self;
    return m->interior;
}

static bool gltf_encloses(const void *self)
{
    const gltf_material *m = self;
    return !m->thin && may_be_above_0(&m->transmission);
}

static bool gltf_is_pane(const void *self)
{
    const gltf_material *m = self;
    return m->thin && may_be_above_0(&m->transmission) &&
           (glass_classes(&m->roughness) & LOBE_SPECULAR);
}

const material_kind material_gltf = {
    .name = "gltf",
    .parameters = "basecolor metallic roughness eta specular specularcolor clearcoat "
                  "clearcoatroughness transmission thin anisotropy anisotropyu "
                  "anisotropyv anisotropyrotation diffusetransmission "
                  "diffusetransmissioncolor " MEDIUM_PARAMETERS,
    .create = gltf_create,
    .free = gltf_free,
    .make_bsdf = gltf_bsdf,
    .possible_lobes = gltf_lobes,
    .is_metal = gltf_is_metal,
    .interior = gltf_interior,
    .encloses = gltf_encloses,
    .is_pane = gltf_is_pane,
};
