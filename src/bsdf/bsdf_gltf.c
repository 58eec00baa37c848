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
#include "bsdf/bsdf_gltf.h"
#include "bsdf/bsdf_models.h"
#include "bsdf/fresnel.h"
#include "math/warp.h"

#include <glib.h>
#include <pthread.h>

enum { N_MU = 32, N_ALPHA = 16, N_SIDE = 24, SMOOTH_ROW = -1 };
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

/* Where a roughness stands between two rows of the tables. */
typedef struct table_row {
    int i; /* SMOOTH_ROW: not in them */
    float share;
} table_row;

typedef struct gltf_data {
    gltf_surface s;
    table_row facets, coat;
    float mean_e; /* E̅ of what is not metal */
    float escape; /* share of matt light that the coat lets out */
    float mean_f0, mean_diffuse, mean_through,
        mean_leaf; /* over the wavelengths in use */
    float turn_cos, turn_sin;
} gltf_data;

_Static_assert(sizeof(gltf_data) <= BSDF_DATA_SIZE, "a glTF surface must fit");

/* What facets and coat do to light of one cosine. */
typedef struct facing {
    facet_shares e; /* of the facets */
    float taken;    /* E(μ) of what is not metal */
    float coat;     /* share that passes the coat */
} facing;

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

static facet_tables *the_tables;

static void make_tables(void)
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
    the_tables = t;
}

/* Made on first use, kept for good. */
static const facet_tables *tables(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, make_tables);
    return the_tables;
}

static facet_shares blend(facet_shares x, facet_shares y, float share)
{
    return (facet_shares){lerpf(x.a, y.a, share), lerpf(x.b, y.b, share)};
}

static table_row row_of(ggx g)
{
    if (ggx_is_smooth(g))
        return (table_row){SMOOTH_ROW, 0.0f};
    float alpha = sqrtf(g.alpha_x * g.alpha_y);
    float y = sqrtf(clampf(alpha, 0.0f, 1.0f)) * (N_ALPHA - 1);
    int i = MIN((int)y, N_ALPHA - 2);
    return (table_row){i, y - (float)i};
}

static facet_shares shares(table_row row, float mu)
{
    if (row.i == SMOOTH_ROW)
        return (facet_shares){1.0f - power5(1.0f - mu), power5(1.0f - mu)};
    float x = clampf(mu * N_MU - 0.5f, 0.0f, N_MU - 1.0f);
    int j = MIN((int)x, N_MU - 2);
    const facet_shares(*at)[N_MU] = tables()->at + row.i;
    float dx = x - (float)j;
    return blend(blend(at[0][j], at[0][j + 1], dx), blend(at[1][j], at[1][j + 1], dx),
                 row.share);
}

static facet_shares mean_shares(table_row row)
{
    if (row.i == SMOOTH_ROW) /* ∫ 2μ(1-μ)⁵ dμ = 1/21 */
        return (facet_shares){20.0f / 21.0f, 1.0f / 21.0f};
    return blend(tables()->mean[row.i], tables()->mean[row.i + 1], row.share);
}

/* ---- The layers ---- */

static const gltf_data *data_of(const bsdf *b)
{
    return (const void *)b->data;
}

static facing facing_of(const gltf_data *d, float mu)
{
    const gltf_surface *s = &d->s;
    facing f = {.e = shares(d->facets, mu), .coat = 1.0f};
    f.taken = minf(s->plain_f0 * f.e.a + s->plain_f90 * f.e.b, 1.0f);
    if (s->coat > 0.0f) {
        facet_shares e = shares(d->coat, mu);
        f.coat = 1.0f - s->coat * minf(COAT_F0 * e.a + e.b, 1.0f);
    }
    return f;
}

static unsigned facet_lobe(const gltf_surface *s, ggx roughness)
{
    unsigned lobe = ggx_class(roughness) | LOBE_REFLECTION;
    return s->is_followed ? lobe_followed(lobe) : lobe;
}

static unsigned layer_lobe(const gltf_surface *s, int layer)
{
    switch (layer) {
    case LAYER_COAT:
        return facet_lobe(s, s->coat_roughness);
    case LAYER_FACETS:
        return facet_lobe(s, s->roughness);
    case LAYER_PANE:
        return ggx_glass_class(s->roughness) | LOBE_TRANSMISSION;
    case LAYER_LEAF:
        return LOBE_DIFFUSE | LOBE_TRANSMISSION;
    default:
        return LOBE_DIFFUSE | LOBE_REFLECTION;
    }
}

/* Albedo of each layer; what leaves through the coat is taken to leave as it came, or
 * from the base, in the mean. */
static void layer_albedos(const gltf_data *d, const facing *f, spectrum out[N_LAYERS])
{
    const gltf_surface *s = &d->s;
    float matt = (1.0f - f->taken) * f->coat * d->escape, coat2 = square(f->coat);
    out[LAYER_COAT] = spectrum_fill(1.0f - f->coat);
    out[LAYER_FACETS] = (s->f0 * f->e.a + s->f90 * f->e.b) * coat2;
    out[LAYER_PANE] = s->through * (maxf(0.0f, f->e.a + f->e.b - f->taken) * coat2);
    out[LAYER_BASE] = s->diffuse * matt;
    out[LAYER_LEAF] = s->leaf * matt;
}

static choice choose(const gltf_data *d, unsigned lobes)
{
    choice out = {0};
    for (int i = 0; i < N_LAYERS; i++)
        out.wanted[i] = lobe_wanted(lobes, layer_lobe(&d->s, i));
    return out;
}

/* Layers are sampled by their albedo, in the mean over the wavelengths in use. */
static void weigh(const gltf_data *d, const facing *f, choice *c)
{
    float matt = (1.0f - f->taken) * f->coat * d->escape, coat2 = square(f->coat);
    float passed = maxf(0.0f, f->e.a + f->e.b - f->taken), sum = 0.0f;
    const float albedo[N_LAYERS] = {
        [LAYER_COAT] = 1.0f - f->coat,
        [LAYER_FACETS] = (d->mean_f0 * f->e.a + d->s.f90 * f->e.b) * coat2,
        [LAYER_PANE] = d->mean_through * (passed * coat2),
        [LAYER_BASE] = d->mean_diffuse * matt,
        [LAYER_LEAF] = d->mean_leaf * matt,
    };
    for (int i = 0; i < N_LAYERS; i++) {
        c->p[i] = c->wanted[i] ? maxf(0.0f, albedo[i]) : 0.0f;
        sum += c->p[i];
    }
    for (int i = 0; i < N_LAYERS && sum > 0.0f; i++)
        c->p[i] /= sum;
}

/* D G2 / (4 oz iz) */
static float facets(ggx g, vec3 o, vec3 i, float *cos_m)
{
    vec3 m = normalize3(o + i);
    float so = ggx_stretched(g, o), si = ggx_stretched(g, i);
    *cos_m = dot3(o, m);
    return ggx_density(g, m) / (2.0f * (o[2] * si + i[2] * so));
}

/* Of mirroring at visible normals. */
static float facets_pdf(ggx g, vec3 o, vec3 i)
{
    vec3 m = normalize3(o + i);
    return ggx_density(g, m) / (2.0f * (o[2] + ggx_stretched(g, o)));
}

static spectrum facets_fresnel(const gltf_surface *s, float cos_m)
{
    float edge = power5(clampf(1.0f - cos_m, 0.0f, 1.0f));
    return s->f0 * (1.0f - edge) + s->f90 * edge;
}

static bool has_rough_facets(const gltf_data *d, const choice *c, bool above)
{
    return d->facets.i != SMOOTH_ROW && c->wanted[above ? LAYER_FACETS : LAYER_PANE];
}

static bool has_rough_coat(const gltf_data *d, const choice *c, bool above)
{
    return above && c->wanted[LAYER_COAT] && d->s.coat > 0.0f && d->coat.i != SMOOTH_ROW;
}

/* Of the rough layers for o above and i above, or below. fo: facing of o. */
static spectrum layers_eval(const gltf_data *d, const choice *c, const facing *fo, vec3 o,
                            vec3 i)
{
    const gltf_surface *s = &d->s;
    bool above = i[2] > 0.0f;
    vec3 j = flip_z(i, !above);
    spectrum f = {0};
    float cos_m;
    if (has_rough_facets(d, c, above)) {
        float g = facets(s->roughness, o, j, &cos_m);
        if (above)
            f += facets_fresnel(s, cos_m) * g;
        else
            f += s->through * (1.0f - schlick(s->plain_f0, s->plain_f90, cos_m)) * g;
    }
    bool matt = c->wanted[above ? LAYER_BASE : LAYER_LEAF];
    if (!matt && !(s->coat > 0.0f))
        return f;
    facing fi = facing_of(d, j[2]);
    float left = (1.0f - fo->taken) * (1.0f - fi.taken);
    if (matt)
        f += (above ? s->diffuse : s->leaf) * (INV_PI_F * left / (1.0f - d->mean_e));
    f *= fo->coat * fi.coat;
    if (has_rough_coat(d, c, above)) {
        float g = facets(s->coat_roughness, o, j, &cos_m);
        f += spectrum_fill(s->coat * schlick(COAT_F0, 1.0f, cos_m) * g);
    }
    return f;
}

static float layers_pdf(const gltf_data *d, const choice *c, vec3 o, vec3 i)
{
    bool above = i[2] > 0.0f;
    vec3 j = flip_z(i, !above);
    float pdf = c->p[above ? LAYER_BASE : LAYER_LEAF] * j[2] * INV_PI_F;
    if (has_rough_facets(d, c, above))
        pdf += c->p[above ? LAYER_FACETS : LAYER_PANE] * facets_pdf(d->s.roughness, o, j);
    if (has_rough_coat(d, c, above))
        pdf += c->p[LAYER_COAT] * facets_pdf(d->s.coat_roughness, o, j);
    return pdf;
}

/* To the axes of the facets, above or below; turned = -1: back. */
static vec3 turned(const gltf_data *d, vec3 w, bool flip, float sign)
{
    float c = d->turn_cos, s = sign * d->turn_sin;
    return flip_z(vec3_make(c * w[0] + s * w[1], c * w[1] - s * w[0], w[2]), flip);
}

static spectrum gltf_eval(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                          transport_mode mode)
{
    (void)mode;
    const gltf_data *d = data_of(b);
    bool flip = wo[2] < 0.0f; /* turned so that wo is above */
    vec3 o = turned(d, wo, flip, 1.0f);
    choice c = choose(d, lobes);
    facing f = facing_of(d, o[2]);
    return layers_eval(d, &c, &f, o, turned(d, wi, flip, 1.0f));
}

static float gltf_pdf(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                      transport_mode mode)
{
    (void)mode;
    const gltf_data *d = data_of(b);
    bool flip = wo[2] < 0.0f;
    vec3 o = turned(d, wo, flip, 1.0f);
    choice c = choose(d, lobes);
    facing f = facing_of(d, o[2]);
    weigh(d, &f, &c);
    return layers_pdf(d, &c, o, turned(d, wi, flip, 1.0f));
}

/* What a smooth pane lets through. */
static spectrum pane_share(const gltf_surface *s, const facing *f, float mu)
{
    float passed = 1.0f - schlick(s->plain_f0, s->plain_f90, mu);
    return s->through * (passed * square(f->coat));
}

/* A smooth layer's one direction. */
static void follow_smooth(const gltf_surface *s, int layer, const facing *f, vec3 o,
                          bsdf_sample *out)
{
    float under = square(f->coat), mu = o[2];
    bool through = layer == LAYER_PANE;
    out->wi = vec3_make(-o[0], -o[1], through ? -mu : mu);
    if (layer == LAYER_COAT)
        out->weight = spectrum_fill(s->coat * schlick(COAT_F0, 1.0f, mu));
    else if (layer == LAYER_FACETS)
        out->weight = facets_fresnel(s, mu) * under;
    else
        out->weight = pane_share(s, f, mu);
    out->straight = through;
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
    choice c = choose(d, lobes);
    facing f = facing_of(d, o[2]);
    weigh(d, &f, &c);
    int layer = pick_layer(&c, u_lobe);
    if (layer < 0)
        return false;
    out->lobe = layer_lobe(&d->s, layer);
    out->pdf = c.p[layer];
    if (out->lobe & LOBE_SPECULAR) {
        follow_smooth(&d->s, layer, &f, o, out);
    } else {
        vec3 i = sample_layer(&d->s, layer, o, u);
        if (!(i[2] > 0.0f))
            return false;
        out->wi = flip_z(i, layer == LAYER_PANE || layer == LAYER_LEAF);
        out->pdf = layers_pdf(d, &c, o, out->wi);
        out->weight = layers_eval(d, &c, &f, o, out->wi) * (i[2] / out->pdf);
    }
    out->wi = turned(d, out->wi, flip, -1.0f);
    return out->pdf > 0.0f;
}

static spectrum gltf_albedo(const bsdf *b, vec3 wo, unsigned lobes)
{
    const gltf_data *d = data_of(b);
    spectrum albedo[N_LAYERS], sum = {0};
    facing f = facing_of(d, fabsf(wo[2]));
    layer_albedos(d, &f, albedo);
    for (int i = 0; i < N_LAYERS; i++)
        if (lobe_wanted(lobes, layer_lobe(&d->s, i)))
            sum += albedo[i];
    return sum;
}

static spectrum gltf_straight(const bsdf *b, vec3 wo)
{
    const gltf_data *d = data_of(b);
    float mu = fabsf(wo[2]);
    facing f = facing_of(d, mu);
    return d->facets.i == SMOOTH_ROW ? pane_share(&d->s, &f, mu) : (spectrum){0};
}

void bsdf_make_gltf(bsdf *b, const gltf_surface *surface)
{
    static const bsdf_ops ops = {
        .name = "glTF surface",
        .eval = gltf_eval,
        .pdf = gltf_pdf,
        .sample = gltf_sample,
        .albedo = gltf_albedo,
        .straight = gltf_straight,
    };
    gltf_data *d = (void *)b->data;
    *d = (gltf_data){.s = *surface,
                     .facets = row_of(surface->roughness),
                     .coat = row_of(surface->coat_roughness),
                     .mean_f0 = wavelength_mean(b, surface->f0),
                     .mean_diffuse = wavelength_mean(b, surface->diffuse),
                     .mean_through = wavelength_mean(b, surface->through),
                     .mean_leaf = wavelength_mean(b, surface->leaf),
                     .escape = 1.0f,
                     .turn_cos = 1.0f};
    facet_shares e = mean_shares(d->facets);
    d->mean_e = minf(surface->plain_f0 * e.a + surface->plain_f90 * e.b, 0.999f);
    if (surface->coat > 0.0f) {
        e = mean_shares(d->coat);
        d->escape = 1.0f - surface->coat * (COAT_F0 * e.a + e.b);
    }
    if (surface->turn < 0.0f || surface->turn > 0.0f) {
        d->turn_cos = cosf(surface->turn);
        d->turn_sin = sinf(surface->turn);
    }
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
