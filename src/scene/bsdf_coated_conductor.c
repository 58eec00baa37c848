/*
 * A metal under a dielectric coat that may absorb, in closed form.
 *
 *   o     i     o, i  above; o', i' their refractions at the flat coat (η)
 *    \   /      coat(o, i)     facets of the coat, or a mirror
 *   --+-+--     C(o), C(i)     what crosses the coat, absorbed on its way
 * (material_coat.h) v        metal(o', i')  facets of the metal
 *   ======
 *
 *   f = coat + C(o) C(i) / η² metal(o', i') / (1 - x) + rest
 *
 * x = R F is one round between metal and coat along the mirror's way: between two smooth
 * layers the sum is exact,
 *
 *   F + (1 - F)² a² R / (1 - a² F R),    a the absorption of one crossing.
 *
 * A rough coat bends light at random on its way in and out, which widens the metal's
 * facets: α² = α_metal² + (1 - 1/η)² α_coat² / 2 in slopes of half vectors. Light that
 * rough metal throws beyond the critical angle comes back to it and leaves by Lambert's
 * law at last (rest), with the shares that the coat's tables know. pbrt-v4 walks at
 * random between the layers instead; this is symmetric and has no noise. Weidlich &
 * Wilkie, "Arbitrarily Layered Micro-Facet Surfaces", 2007, and the series of
 * bsdf_coated.c.
 *
 * Directions are bent by the mean index of the lanes.
 */
#include "math/warp.h"
#include "scene/bsdf_models.h"
#include "scene/fresnel.h"

enum { REST = LOBE_DIFFUSE | LOBE_REFLECTION };

typedef struct lacquer {
    spectrum metal_eta, metal_k; /* over the coat's index */
    spectrum rest;               /* f of the rest, without C(o) C(i) */
    float eta, thickness;
    ggx coat, metal; /* metal: widened by the coat */
    const coat_table *table;
} lacquer;

_Static_assert(sizeof(lacquer) <= BSDF_DATA_SIZE, "a lacquered metal must fit");

static const lacquer *data_of(const bsdf *b)
{
    return (const void *)b->data;
}

static unsigned coat_lobe(const lacquer *c)
{
    return ggx_class(c->coat) | LOBE_REFLECTION;
}

static unsigned metal_lobe(const lacquer *c)
{
    return ggx_class(c->metal) | LOBE_REFLECTION;
}

static vec3 bent_in(const lacquer *c, vec3 w)
{
    float x = w[0] / c->eta, y = w[1] / c->eta;
    return vec3_make(x, y, sqrtf(maxf(0.0f, 1.0f - x * x - y * y)));
}

static bool bent_out(const lacquer *c, vec3 w, vec3 *out)
{
    float x = w[0] * c->eta, y = w[1] * c->eta, z2 = 1.0f - x * x - y * y;
    *out = vec3_make(x, y, sqrtf(maxf(0.0f, z2)));
    return z2 > 0.0f;
}

static float crossing(const lacquer *c, vec3 w)
{
    float alpha = sqrtf(c->coat.alpha_x * c->coat.alpha_y);
    return coat_crossing(c->table, alpha, c->eta, w[2]);
}

/* R / (1 - R F a²) for light at this cosine to the metal's facets. */
static spectrum rounds(const lacquer *c, float cosine)
{
    spectrum r = fresnel_conductor(cosine, c->metal_eta, c->metal_k);
    float inside = fresnel_dielectric(cosine, 1.0f / c->eta);
    if (!(inside < 1.0f))
        return r; /* beyond the critical angle: that is in the rest */
    float there = expf(-c->thickness / maxf(cosine, 1e-3f));
    return r / (1.0f - r * (inside * there * there));
}

/* ---- The lobes, for directions above ---- */

static spectrum coat_eval(const lacquer *c, vec3 o, vec3 i)
{
    vec3 m = normalize3(o + i);
    float so = ggx_stretched(c->coat, o), si = ggx_stretched(c->coat, i);
    return spectrum_fill(fresnel_dielectric(dot3(o, m), c->eta) *
                         ggx_density(c->coat, m) / (2.0f * (o[2] * si + i[2] * so)));
}

static float facets_pdf(ggx g, vec3 o, vec3 m)
{
    return ggx_density(g, m) / (2.0f * (o[2] + ggx_stretched(g, o)));
}

static spectrum metal_eval(const lacquer *c, vec3 o, vec3 i)
{
    vec3 p = bent_in(c, o), q = bent_in(c, i), m = normalize3(p + q);
    float masked =
        2.0f * (p[2] * ggx_stretched(c->metal, q) + q[2] * ggx_stretched(c->metal, p));
    float share = crossing(c, o) * crossing(c, i) / square(c->eta);
    return rounds(c, dot3(p, m)) * (share * ggx_density(c->metal, m) / masked);
}

static float metal_pdf(const lacquer *c, vec3 o, vec3 i)
{
    vec3 p = bent_in(c, o), q = bent_in(c, i);
    return facets_pdf(c->metal, p, normalize3(p + q)) * i[2] /
           (square(c->eta) * maxf(q[2], 1e-6f));
}

/* What the lobes of a mask send, roughly; [0] coat, [1] metal, [2] rest. */
typedef struct shares {
    bool wanted[3];
    float p[3];
} shares;

static shares choose(const bsdf *b, vec3 o, unsigned lobes)
{
    const lacquer *c = data_of(b);
    shares s = {.wanted = {lobe_wanted(lobes, coat_lobe(c)),
                           lobe_wanted(lobes, metal_lobe(c)), lobe_wanted(lobes, REST)}};
    float cross = crossing(c, o);
    s.p[0] = fresnel_dielectric(o[2], c->eta);
    s.p[1] = lane_mean(b, rounds(c, bent_in(c, o)[2])) * cross * cross;
    s.p[2] = lane_mean(b, c->rest) * cross * PI_F;
    float sum = 0.0f;
    for (int k = 0; k < 3; k++)
        sum += s.p[k] = s.wanted[k] ? s.p[k] : 0.0f;
    for (int k = 0; k < 3; k++)
        s.p[k] = sum > 0.0f ? s.p[k] / sum : 0.0f;
    return s;
}

static spectrum eval_above(const lacquer *c, const shares *s, vec3 o, vec3 i)
{
    spectrum f = {0};
    if (s->wanted[0] && !ggx_is_smooth(c->coat))
        f += coat_eval(c, o, i);
    if (s->wanted[1] && !ggx_is_smooth(c->metal))
        f += metal_eval(c, o, i);
    if (s->wanted[2])
        f += c->rest * (crossing(c, o) * crossing(c, i));
    return f;
}

static float pdf_above(const lacquer *c, const shares *s, vec3 o, vec3 i)
{
    float pdf = s->p[2] * i[2] * INV_PI_F;
    if (s->p[0] > 0.0f && !ggx_is_smooth(c->coat))
        pdf += s->p[0] * facets_pdf(c->coat, o, normalize3(o + i));
    if (s->p[1] > 0.0f && !ggx_is_smooth(c->metal))
        pdf += s->p[1] * metal_pdf(c, o, i);
    return pdf;
}

static spectrum lacquer_eval(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                             transport_mode mode)
{
    (void)mode;
    if (!(wo[2] * wi[2] > 0.0f))
        return (spectrum){0};
    bool flip = wo[2] < 0.0f;
    vec3 o = flip_z(wo, flip);
    shares s = choose(b, o, lobes);
    return eval_above(data_of(b), &s, o, flip_z(wi, flip));
}

static float lacquer_pdf(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                         transport_mode mode)
{
    (void)mode;
    if (!(wo[2] * wi[2] > 0.0f))
        return 0.0f;
    bool flip = wo[2] < 0.0f;
    vec3 o = flip_z(wo, flip);
    shares s = choose(b, o, lobes);
    return pdf_above(data_of(b), &s, o, flip_z(wi, flip));
}

/* A mirror's direction: what of coat and metal is smooth goes there together. */
static bool mirror(const lacquer *c, const shares *s, vec3 o, bsdf_sample *out)
{
    float cross = crossing(c, o);
    out->wi = vec3_make(-o[0], -o[1], o[2]);
    out->pdf = 0.0f;
    out->weight = (spectrum){0};
    if (s->wanted[0] && ggx_is_smooth(c->coat)) {
        out->weight += fresnel_dielectric(o[2], c->eta);
        out->pdf += s->p[0];
    }
    if (s->wanted[1] && ggx_is_smooth(c->metal)) {
        out->weight += rounds(c, bent_in(c, o)[2]) * (cross * cross);
        out->pdf += s->p[1];
    }
    out->weight /= out->pdf;
    out->lobe = LOBE_SPECULAR | LOBE_REFLECTION;
    return true;
}

/* The lobe that u picks; u becomes uniform again. */
static int pick(const shares *s, float u)
{
    int k = 0;
    while (k < 2 && u >= s->p[k])
        u -= s->p[k++];
    while (k > 0 && !(s->p[k] > 0.0f))
        k--;
    return k;
}

static bool draw(const lacquer *c, int k, vec3 o, vec2 u, vec3 *i)
{
    vec3 p = bent_in(c, o);
    if (k == 0)
        *i = reflect3(o, ggx_sample_visible(c->coat, o, u));
    else if (k == 2)
        *i = warp_cosine_hemisphere(u);
    else {
        vec3 q = reflect3(p, ggx_sample_visible(c->metal, p, u));
        if (!(q[2] > 0.0f) || !bent_out(c, q, i))
            return false;
    }
    return (*i)[2] > 0.0f;
}

static bool lacquer_sample(const bsdf *b, vec3 wo, float u_lobe, vec2 u, unsigned lobes,
                           transport_mode mode, bsdf_sample *out)
{
    (void)mode;
    const lacquer *c = data_of(b);
    bool flip = wo[2] < 0.0f;
    vec3 o = flip_z(wo, flip), i;
    shares s = choose(b, o, lobes);
    int k = pick(&s, u_lobe);
    if (!(s.p[k] > 0.0f))
        return false;
    if ((k == 0 && ggx_is_smooth(c->coat)) || (k == 1 && ggx_is_smooth(c->metal))) {
        mirror(c, &s, o, out);
    } else {
        if (!draw(c, k, o, u, &i))
            return false;
        out->wi = i;
        out->pdf = pdf_above(c, &s, o, i);
        out->weight = eval_above(c, &s, o, i) * (i[2] / out->pdf);
        out->lobe = k == 0 ? coat_lobe(c) : k == 1 ? metal_lobe(c) : (unsigned)REST;
    }
    out->wi = flip_z(out->wi, flip);
    return out->pdf > 0.0f;
}

static spectrum lacquer_albedo(const bsdf *b, vec3 wo, unsigned lobes)
{
    enum { N = 6 };
    const lacquer *c = data_of(b);
    vec3 o = flip_z(wo, wo[2] < 0.0f), i;
    shares s = choose(b, o, lobes);
    spectrum sum = {0};
    if (s.wanted[0])
        sum += coat_reflected(c->table, sqrtf(c->coat.alpha_x * c->coat.alpha_y), c->eta,
                              o[2]);
    if (s.wanted[1] && ggx_is_smooth(c->metal))
        sum += rounds(c, bent_in(c, o)[2]) * square(crossing(c, o));
    const shares metal = {.wanted = {false, true, false}, .p = {0.0f, 1.0f, 0.0f}};
    for (int k = 0; k < N * N && s.wanted[1] && !ggx_is_smooth(c->metal); k++) {
        vec2 u = {((float)(k / N) + 0.5f) / N, ((float)(k % N) + 0.5f) / N};
        if (draw(c, 1, o, u, &i))
            sum += eval_above(c, &metal, o, i) *
                   (i[2] / (N * N * maxf(pdf_above(c, &metal, o, i), 1e-9f)));
    }
    if (s.wanted[2])
        sum += c->rest *
               (crossing(c, o) * square(c->eta) * PI_F *
                coat_escape(c->table, sqrtf(c->coat.alpha_x * c->coat.alpha_y), c->eta));
    return spectrum_clamp(sum, 0.0f, 1.0f);
}

/* Of light that the rough metal throws, what meets the coat beyond the critical angle. */
static float thrown_back(const lacquer *c)
{
    enum { N = 6 };
    float sum = 0.0f;
    if (ggx_is_smooth(c->metal))
        return 0.0f;
    for (int k = 0; k < N * N; k++) {
        vec2 u = {((float)(k / N) + 0.5f) / N, ((float)(k % N) + 0.5f) / N};
        vec3 o = bent_in(c, normalize3(vec3_make(1.0f, 0.0f, 1.0f))), out;
        vec3 q = reflect3(o, ggx_sample_visible(c->metal, o, u));
        if (q[2] > 0.0f && !bent_out(c, q, &out))
            sum += ggx_visible_weight(c->metal, o, q) / (N * N);
    }
    return sum;
}

void bsdf_make_coated_conductor(bsdf *b, const coated_metal *from)
{
    static const bsdf_ops ops = {
        .name = "coated conductor",
        .eval = lacquer_eval,
        .pdf = lacquer_pdf,
        .sample = lacquer_sample,
        .albedo = lacquer_albedo,
    };
    lacquer *c = (void *)b->data;
    float widen = 0.5f * square(1.0f - 1.0f / from->coat_eta);
    *c = (lacquer){.metal_eta = from->eta / from->coat_eta,
                   .metal_k = from->k / from->coat_eta,
                   .eta = from->coat_eta,
                   .thickness = from->thickness,
                   .coat = from->coat,
                   .table = from->table};
    c->metal =
        ggx_make(sqrtf(square(from->metal.alpha_x) + widen * square(from->coat.alpha_x)),
                 sqrtf(square(from->metal.alpha_y) + widen * square(from->coat.alpha_y)));
    float back = thrown_back(c);
    if (back > 1e-3f) {
        float alpha = sqrtf(c->coat.alpha_x * c->coat.alpha_y);
        spectrum r = fresnel_conductor(0.7f, c->metal_eta, c->metal_k);
        float internal = coat_internal(c->table, alpha, c->eta);
        c->rest = r * r * back / (1.0f - r * internal) * INV_PI_F / square(c->eta);
    }
    b->ops = &ops;
    b->lobes = coat_lobe(c) | metal_lobe(c) | (back > 1e-3f ? (unsigned)REST : 0u);
    b->lambertian = false;
}
