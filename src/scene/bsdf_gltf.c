/*
 * glTF 2.0's metallic-roughness surface with its extensions: facets over a matt base or
 * over a thin pane that lets light through, and a clear coat over all of it.
 *
 *   coat      c · Schlick(0.04), GGX
 *   facets    Schlick(F0, F90), GGX          metal: F0 = base colour; else that of the
 * ior base      ρ/π · (1-E(o)) (1-E(i)) / (1-E̅)    what the facets leave, the same both
 * ways leaf      τ/π, as the base, to the other side
 *   pane      through · (1-F) · GGX mirrored below
 *
 * E(μ) is the albedo of the facets of what is not metal; with Schlick's Fresnel term it
 * is F0 a(μ, α) + F90 b(μ, α), two tables made once, for brushed facets at the geometric
 * mean of their two α. A coat dims what is under it by 1 -
 * c E(μ) on the way in and out. No more light goes out than came in: E + ρ(1-E) <= 1.
 *
 * Khronos, "glTF 2.0 Specification", appendix B, and KHR_materials_*; the form of the
 * base is of Kelemen & Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF
 * Model", 2001; Schlick, "An Inexpensive BRDF Model for Physically-based Rendering",
 * 1994.
 */
#include "scene/bsdf_gltf.h"
#include "math/warp.h"
#include "scene/bsdf_models.h"
#include "scene/fresnel.h"

#include <glib.h>

enum { N_MU = 32, N_ALPHA = 16, N_SIDE = 24 };
enum { LAYER_COAT, LAYER_FACETS, LAYER_PANE, LAYER_BASE, LAYER_LEAF, N_LAYERS };

#define COAT_F0 0.04f

/* Shares of light mirrored by facets: a times F0, b times F90. */
typedef struct facet_shares {
    float a, b;
} facet_shares;

/* [alpha][mu], and the means over a cosine-weighted hemisphere. */
typedef struct facet_tables {
    facet_shares at[N_ALPHA][N_MU];
    facet_shares mean[N_ALPHA];
} facet_tables;

typedef struct gltf_data {
    gltf_surface s;
    float mean_e; /* E̅ of what is not metal */
    float turn_cos, turn_sin;
} gltf_data;

_Static_assert(sizeof(gltf_data) <= BSDF_DATA_SIZE, "a glTF surface must fit");

/* What is wanted of a query and how likely each layer is to be sampled. */
typedef struct choice {
    bool wanted[N_LAYERS];
    float p[N_LAYERS];
} choice;

/* ---- Tables ---- */

static float power5(float x)
{
    float x2 = x * x;
    return x2 * x2 * x;
}

static float schlick(float f0, float f90, float cosine)
{
    return f0 + (f90 - f0) * power5(clampf(1.0f - cosine, 0.0f, 1.0f));
}

/* Smooth facets in closed form, others by a grid of visible normals. */
static facet_shares measure(float alpha, float mu)
{
    facet_shares sum = {0};
    vec3 wo = vec3_make(sqrtf(maxf(0.0f, 1.0f - mu * mu)), 0.0f, mu);
    ggx g = ggx_make(alpha, alpha);
    if (ggx_is_smooth(g))
        return (facet_shares){1.0f - power5(1.0f - mu), power5(1.0f - mu)};
    for (int k = 0; k < N_SIDE * N_SIDE; k++) {
        vec2 u = {((float)(k / N_SIDE) + 0.5f) / N_SIDE,
                  ((float)(k % N_SIDE) + 0.5f) / N_SIDE};
        vec3 m = ggx_sample_visible(g, wo, u), wi = reflect3(wo, m);
        if (!(wi[2] > 0.0f))
            continue;
        float weight = ggx_visible_weight(g, wo, wi) / (N_SIDE * N_SIDE);
        float edge = power5(clampf(1.0f - dot3(wo, m), 0.0f, 1.0f));
        sum.a += weight * (1.0f - edge);
        sum.b += weight * edge;
    }
    return sum;
}

/* Rows stand at alpha = (i / (n-1))², which has more of them where more happens. */
static float alpha_of_row(int i)
{
    return square((float)i / (N_ALPHA - 1));
}

static float mu_of_column(int j)
{
    return ((float)j + 0.5f) / N_MU;
}

static facet_tables *make_tables(void)
{
    facet_tables *t = g_new0(facet_tables, 1);
    for (int i = 0; i < N_ALPHA; i++)
        for (int j = 0; j < N_MU; j++) {
            float mu = mu_of_column(j);
            facet_shares s = measure(alpha_of_row(i), mu);
            t->at[i][j] = s;
            t->mean[i].a += 2.0f * mu / N_MU * s.a;
            t->mean[i].b += 2.0f * mu / N_MU * s.b;
        }
    return t;
}

/* Made on first use, kept for good. */
static const facet_tables *tables(void)
{
    static facet_tables *made;
    if (g_once_init_enter(&made))
        g_once_init_leave(&made, make_tables());
    return made;
}

static facet_shares blend(facet_shares x, facet_shares y, float share)
{
    return (facet_shares){lerpf(x.a, y.a, share), lerpf(x.b, y.b, share)};
}

static int row_of(ggx g, float *share)
{
    float alpha = sqrtf(g.alpha_x * g.alpha_y);
    float y = sqrtf(clampf(alpha, 0.0f, 1.0f)) * (N_ALPHA - 1);
    int i = MIN((int)y, N_ALPHA - 2);
    *share = y - (float)i;
    return i;
}

static facet_shares shares(ggx g, float mu)
{
    if (ggx_is_smooth(g))
        return (facet_shares){1.0f - power5(1.0f - mu), power5(1.0f - mu)};
    float dy, x = clampf(mu * N_MU - 0.5f, 0.0f, N_MU - 1.0f);
    int i = row_of(g, &dy), j = MIN((int)x, N_MU - 2);
    const facet_shares(*at)[N_MU] = tables()->at;
    float dx = x - (float)j;
    return blend(blend(at[i][j], at[i][j + 1], dx),
                 blend(at[i + 1][j], at[i + 1][j + 1], dx), dy);
}

static facet_shares mean_shares(ggx g)
{
    float dy;
    if (ggx_is_smooth(g)) /* ∫ 2μ(1-μ)⁵ dμ = 1/21 */
        return (facet_shares){20.0f / 21.0f, 1.0f / 21.0f};
    int i = row_of(g, &dy);
    return blend(tables()->mean[i], tables()->mean[i + 1], dy);
}

/* ---- The layers ---- */

static const gltf_data *data_of(const bsdf *b)
{
    return (const void *)b->data;
}

/* E(μ) of what is not metal. */
static float taken_by_facets(const gltf_surface *s, float mu)
{
    facet_shares e = shares(s->roughness, mu);
    return minf(s->plain_f0 * e.a + s->plain_f90 * e.b, 1.0f);
}

static float left_by_coat(const gltf_surface *s, float mu)
{
    if (!(s->coat > 0.0f))
        return 1.0f;
    facet_shares e = shares(s->coat_roughness, mu);
    return 1.0f - s->coat * minf(COAT_F0 * e.a + e.b, 1.0f);
}

static unsigned layer_lobe(const gltf_surface *s, int layer)
{
    switch (layer) {
    case LAYER_COAT:
        return ggx_class(s->coat_roughness) | LOBE_REFLECTION;
    case LAYER_FACETS:
        return ggx_class(s->roughness) | LOBE_REFLECTION;
    case LAYER_PANE:
        return ggx_glass_class(s->roughness) | LOBE_TRANSMISSION;
    case LAYER_LEAF:
        return LOBE_DIFFUSE | LOBE_TRANSMISSION;
    default:
        return LOBE_DIFFUSE | LOBE_REFLECTION;
    }
}

/* Albedo of each layer for light from cosine mu; what leaves through the coat is taken to
 * leave as it came, or from the base, in the mean. */
static void layer_albedos(const gltf_data *d, float mu, spectrum out[N_LAYERS])
{
    const gltf_surface *s = &d->s;
    facet_shares e = shares(s->roughness, mu), c = mean_shares(s->coat_roughness);
    float coat = left_by_coat(s, mu), taken = taken_by_facets(s, mu);
    float escape = 1.0f - s->coat * (COAT_F0 * c.a + c.b);
    out[LAYER_COAT] = spectrum_fill(1.0f - coat);
    out[LAYER_FACETS] = (s->f0 * e.a + s->f90 * e.b) * square(coat);
    out[LAYER_PANE] = s->through * (maxf(0.0f, e.a + e.b - taken) * square(coat));
    out[LAYER_BASE] = s->diffuse * ((1.0f - taken) * coat * escape);
    out[LAYER_LEAF] = s->leaf * ((1.0f - taken) * coat * escape);
}

static choice choose(const bsdf *b, vec3 o, unsigned lobes)
{
    const gltf_data *d = data_of(b);
    spectrum albedo[N_LAYERS];
    choice out = {0};
    float sum = 0.0f;
    layer_albedos(d, o[2], albedo);
    for (int i = 0; i < N_LAYERS; i++) {
        out.wanted[i] = lobe_wanted(lobes, layer_lobe(&d->s, i));
        out.p[i] = out.wanted[i] ? maxf(0.0f, lane_mean(b, albedo[i])) : 0.0f;
        sum += out.p[i];
    }
    for (int i = 0; i < N_LAYERS && sum > 0.0f; i++)
        out.p[i] /= sum;
    return out;
}

/* D G2 / (4 oz iz) and the density of mirroring at visible normals. */
static float facets(ggx g, vec3 o, vec3 i, float *cos_m, float *pdf)
{
    vec3 m = normalize3(o + i);
    float so = ggx_stretched(g, o), si = ggx_stretched(g, i), d = ggx_density(g, m);
    *cos_m = dot3(o, m);
    *pdf = d / (2.0f * (o[2] + so));
    return d / (2.0f * (o[2] * si + i[2] * so));
}

static spectrum facets_fresnel(const gltf_surface *s, float cos_m)
{
    float edge = power5(clampf(1.0f - cos_m, 0.0f, 1.0f));
    return s->f0 * (1.0f - edge) + s->f90 * edge;
}

/* Value and density of the rough layers for o above and i above, or below. */
static spectrum layers_eval(const gltf_data *d, const choice *c, vec3 o, vec3 i,
                            float *pdf)
{
    const gltf_surface *s = &d->s;
    bool above = i[2] > 0.0f, rough = !ggx_is_smooth(s->roughness);
    vec3 j = flip_z(i, !above);
    spectrum f = {0};
    float cos_m, p;
    *pdf = 0.0f;
    if (rough && (above ? c->wanted[LAYER_FACETS] : c->wanted[LAYER_PANE])) {
        float g = facets(s->roughness, o, j, &cos_m, &p);
        *pdf += c->p[above ? LAYER_FACETS : LAYER_PANE] * p;
        if (above)
            f += facets_fresnel(s, cos_m) * g;
        else
            f += s->through * (1.0f - schlick(s->plain_f0, s->plain_f90, cos_m)) * g;
    }
    int matt = above ? LAYER_BASE : LAYER_LEAF;
    if (c->wanted[matt]) {
        float left =
            (1.0f - taken_by_facets(s, o[2])) * (1.0f - taken_by_facets(s, j[2]));
        f += (above ? s->diffuse : s->leaf) * (INV_PI_F * left / (1.0f - d->mean_e));
        *pdf += c->p[matt] * j[2] * INV_PI_F;
    }
    if (s->coat > 0.0f)
        f *= left_by_coat(s, o[2]) * left_by_coat(s, j[2]);
    if (above && c->wanted[LAYER_COAT] && !ggx_is_smooth(s->coat_roughness)) {
        float g = facets(s->coat_roughness, o, j, &cos_m, &p);
        f += spectrum_fill(s->coat * schlick(COAT_F0, 1.0f, cos_m) * g);
        *pdf += c->p[LAYER_COAT] * p;
    }
    return f;
}

/* To the axes of the facets, above or below; turned = -1: back. */
static vec3 turned(const gltf_data *d, vec3 w, bool flip, float sign)
{
    float c = d->turn_cos, s = sign * d->turn_sin;
    return flip_z(vec3_make(c * w[0] + s * w[1], c * w[1] - s * w[0], w[2]), flip);
}

/* The directions turned so that wo is above. */
static spectrum gltf_scatter(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes, float *pdf)
{
    const gltf_data *d = data_of(b);
    bool flip = wo[2] < 0.0f;
    vec3 o = turned(d, wo, flip, 1.0f);
    choice c = choose(b, o, lobes);
    return layers_eval(d, &c, o, turned(d, wi, flip, 1.0f), pdf);
}

static spectrum gltf_eval(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                          transport_mode mode)
{
    (void)mode;
    float pdf;
    return gltf_scatter(b, wo, wi, lobes, &pdf);
}

static float gltf_pdf(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                      transport_mode mode)
{
    (void)mode;
    float pdf;
    gltf_scatter(b, wo, wi, lobes, &pdf);
    return pdf;
}

/* A smooth layer's one direction. */
static void follow_smooth(const gltf_surface *s, int layer, vec3 o, bsdf_sample *out)
{
    float under = square(left_by_coat(s, o[2])), mu = o[2];
    bool through = layer == LAYER_PANE;
    out->wi = vec3_make(-o[0], -o[1], through ? -mu : mu);
    if (layer == LAYER_COAT)
        out->weight = spectrum_fill(s->coat * schlick(COAT_F0, 1.0f, mu));
    else if (layer == LAYER_FACETS)
        out->weight = facets_fresnel(s, mu) * under;
    else
        out->weight =
            s->through * ((1.0f - schlick(s->plain_f0, s->plain_f90, mu)) * under);
    out->weight /= out->pdf;
}

static vec3 sample_layer(const gltf_surface *s, int layer, vec3 o, vec2 u)
{
    if (layer == LAYER_BASE || layer == LAYER_LEAF)
        return warp_cosine_hemisphere(u);
    ggx g = layer == LAYER_COAT ? s->coat_roughness : s->roughness;
    return reflect3(o, ggx_sample_visible(g, o, u));
}

static int pick_layer(const choice *c, float u)
{
    int layer = -1;
    for (int i = 0; i < N_LAYERS; i++) {
        if (!(c->p[i] > 0.0f))
            continue;
        layer = i;
        if (u < c->p[i])
            break;
        u -= c->p[i];
    }
    return layer;
}

static bool gltf_sample(const bsdf *b, vec3 wo, float u_lobe, vec2 u, unsigned lobes,
                        transport_mode mode, bsdf_sample *out)
{
    (void)mode;
    const gltf_data *d = data_of(b);
    bool flip = wo[2] < 0.0f;
    vec3 o = turned(d, wo, flip, 1.0f);
    choice c = choose(b, o, lobes);
    int layer = pick_layer(&c, u_lobe);
    if (layer < 0)
        return false;
    out->lobe = layer_lobe(&d->s, layer);
    out->pdf = c.p[layer];
    if (out->lobe & LOBE_SPECULAR) {
        follow_smooth(&d->s, layer, o, out);
    } else {
        vec3 i = sample_layer(&d->s, layer, o, u);
        if (!(i[2] > 0.0f))
            return false;
        out->wi = flip_z(i, layer == LAYER_PANE || layer == LAYER_LEAF);
        out->weight = layers_eval(d, &c, o, out->wi, &out->pdf) * (i[2] / out->pdf);
    }
    out->wi = turned(d, out->wi, flip, -1.0f);
    return out->pdf > 0.0f;
}

static spectrum gltf_albedo(const bsdf *b, vec3 wo, unsigned lobes)
{
    const gltf_data *d = data_of(b);
    spectrum albedo[N_LAYERS], sum = {0};
    layer_albedos(d, fabsf(wo[2]), albedo);
    for (int i = 0; i < N_LAYERS; i++)
        if (lobe_wanted(lobes, layer_lobe(&d->s, i)))
            sum += albedo[i];
    return sum;
}

void bsdf_make_gltf(bsdf *b, const gltf_surface *surface)
{
    static const bsdf_ops ops = {
        .name = "glTF surface",
        .eval = gltf_eval,
        .pdf = gltf_pdf,
        .sample = gltf_sample,
        .albedo = gltf_albedo,
    };
    gltf_data *d = (void *)b->data;
    facet_shares e = mean_shares(surface->roughness);
    *d = (gltf_data){
        .s = *surface, .turn_cos = cosf(surface->turn), .turn_sin = sinf(surface->turn)};
    d->mean_e = minf(surface->plain_f0 * e.a + surface->plain_f90 * e.b, 0.999f);
    b->ops = &ops;
    b->lambertian = false;
    b->lobes = layer_lobe(surface, LAYER_FACETS);
    if (surface->coat > 0.0f)
        b->lobes |= layer_lobe(surface, LAYER_COAT);
    if (!spectrum_is_black(surface->diffuse))
        b->lobes |= layer_lobe(surface, LAYER_BASE);
    if (!spectrum_is_black(surface->leaf))
        b->lobes |= layer_lobe(surface, LAYER_LEAF);
    if (!spectrum_is_black(surface->through))
        b->lobes |= layer_lobe(surface, LAYER_PANE);
}
