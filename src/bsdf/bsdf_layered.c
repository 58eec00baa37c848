/*
 * A base under a coat: lacquered metal, or anything under a coat with particles in it.
 *
 *   lobe     what                                            class
 *   face     facets of the coat, or a mirror                 by the coat's roughness
 *   clear    by way of the metal, without particles          by both roughnesses
 *   cloudy   by way of particles, or of a diffuse base       DIFFUSE
 *
 * Between a flat coat and flat metal the clear lobe is a mirror, in closed form (Wolff,
 * Nayar & Oren, "Improved Diffuse Reflection Models", 1998, for the series):
 *
 *   (1 - F)² a² R (1 + x + x² + ... ),   x = R F a²,   a = exp(-thickness / cos)
 *
 * All else is the mean of random walks (bsdf_layered.h), which is what pbrt-v4's layers
 * are. Directions are drawn from what the lobes look like, roughly: the metal's facets
 * seen through the coat, widened by its roughness, α² = α_metal² + (1 - 1/η)² α_coat² / 2
 * in slopes of half vectors, and the cosine. Densities are exact, and it is only weights
 * that the walks make noisy.
 *
 * Directions are bent by the mean index of the wavelengths.
 */
#include "bsdf/bsdf_layered.h"
#include "bsdf/fresnel.h"
#include "math/warp.h"

enum { FACE, CLEAR, CLOUDY, N_LOBES };
enum { WALKS_FOR_ALBEDO = 32 };

/* The share of clear light's samples that goes anywhere, for what was thrown about. */
#define ANYWHERE 0.2f

typedef struct layered {
    coat_layers l;
    ggx metal; /* the metal's facets as the coat shows them */
    unsigned lobes[N_LOBES];
} layered;

_Static_assert(sizeof(layered) <= BSDF_DATA_SIZE, "layers must fit");

static const layered *data_of(const bsdf *b)
{
    return (const void *)b->data;
}

static bool is_mirror(const layered *c, int k)
{
    return (c->lobes[k] & LOBE_SPECULAR) != 0;
}

static vec3 bent_in(const layered *c, vec3 w)
{
    float x = w[0] / c->l.eta, y = w[1] / c->l.eta;
    return vec3_make(x, y, sqrtf(maxf(0.0f, 1.0f - x * x - y * y)));
}

static bool bent_out(const layered *c, vec3 w, vec3 *out)
{
    float x = w[0] * c->l.eta, y = w[1] * c->l.eta, z2 = 1.0f - x * x - y * y;
    *out = vec3_make(x, y, sqrtf(maxf(0.0f, z2)));
    return z2 > 0.0f;
}

/* Of light from o, what crosses a flat coat without meeting a particle, and its cosine
 * there. */
static float crossing(const layered *c, vec3 o, float *cosine)
{
    *cosine = maxf(bent_in(c, o)[2], 1e-3f);
    return (1.0f - fresnel_dielectric(o[2], c->l.eta)) * expf(-c->l.thickness / *cosine);
}

/* 1 + x + ... of so many terms as a walk has bounces off the base. */
static spectrum series(const layered *c, spectrum x)
{
    int n = (c->l.max_depth + 1) / 2;
    spectrum sum = {0}, term = spectrum_fill(1.0f);
    for (int i = 0; i < n && spectrum_max(term) > 1e-6f; i++) {
        sum += term;
        term *= x;
    }
    return sum;
}

/* The share that flat layers send back by way of the metal. */
static spectrum by_way_of_metal(const layered *c, vec3 o)
{
    float cosine, in = crossing(c, o, &cosine);
    float a = expf(-c->l.thickness / cosine);
    spectrum r = fresnel_conductor(cosine, c->l.metal_eta, c->l.metal_k);
    float face = fresnel_dielectric(cosine, 1.0f / c->l.eta);
    return r * (in * a * (1.0f - face)) * series(c, r * (face * a * a));
}

/* ---- What is wanted, and how likely each lobe is drawn ---- */

typedef struct shares {
    bool wanted[N_LOBES];
    float p[N_LOBES];
} shares;

static shares wanted_of(const layered *c, unsigned lobes)
{
    shares s = {0};
    for (int k = 0; k < N_LOBES; k++)
        s.wanted[k] = c->lobes[k] && lobe_wanted(lobes, c->lobes[k]);
    return s;
}

static shares choose(const bsdf *b, vec3 o, unsigned lobes)
{
    const layered *c = data_of(b);
    shares s = wanted_of(c, lobes);
    float cosine, in = crossing(c, o, &cosine);
    float face = fresnel_dielectric(o[2], c->l.eta), lost = 1.0f - face - in;
    s.p[FACE] = face;
    s.p[CLEAR] = wavelength_mean(b, by_way_of_metal(c, o)) + 0.02f;
    s.p[CLOUDY] = 0.02f + lost * 0.5f * wavelength_mean(b, c->l.albedo);
    if (!c->l.is_metal)
        s.p[CLOUDY] += 0.5f * in * wavelength_mean(b, c->l.rho);
    float sum = 0.0f;
    for (int k = 0; k < N_LOBES; k++)
        sum += s.p[k] = s.wanted[k] ? s.p[k] : 0.0f;
    for (int k = 0; k < N_LOBES; k++)
        s.p[k] = sum > 0.0f ? s.p[k] / sum : 0.0f;
    return s;
}

/* The lobe that u picks; u becomes uniform again. */
static int pick(const shares *s, float *u)
{
    int k = 0;
    while (k < N_LOBES - 1 && *u >= s->p[k])
        *u -= s->p[k++];
    while (k > 0 && !(s->p[k] > 0.0f))
        k--;
    *u = s->p[k] > 0.0f ? minf(*u / s->p[k], 1.0f - 0x1p-24f) : 0.0f;
    return k;
}

/* ---- Values and densities, for directions above ---- */

static float facets_pdf(ggx g, vec3 o, vec3 m)
{
    return ggx_density(g, m) / (2.0f * (o[2] + ggx_stretched(g, o)));
}

static float face_eval(const layered *c, vec3 o, vec3 i)
{
    ggx g = c->l.coat;
    vec3 m = normalize3(o + i);
    float so = ggx_stretched(g, o), si = ggx_stretched(g, i);
    return fresnel_dielectric(dot3(o, m), c->l.eta) * ggx_density(g, m) /
           (2.0f * (o[2] * si + i[2] * so));
}

static spectrum eval_above(const layered *c, const shares *s, vec3 o, vec3 i)
{
    spectrum f = {0};
    bool clear = s->wanted[CLEAR] && !is_mirror(c, CLEAR);
    if (s->wanted[FACE] && !is_mirror(c, FACE))
        f += face_eval(c, o, i);
    if (!clear && !s->wanted[CLOUDY])
        return f;
    layered_light inside = layered_inside(&c->l, o, i);
    if (clear)
        f += inside.clear;
    if (s->wanted[CLOUDY])
        f += inside.cloudy;
    return f;
}

static float clear_pdf(const layered *c, vec3 o, vec3 i)
{
    vec3 p = bent_in(c, o), q = bent_in(c, i);
    float facets = facets_pdf(c->metal, p, normalize3(p + q)) * i[2] /
                   (square(c->l.eta) * maxf(q[2], 1e-6f));
    return lerpf(facets, i[2] * INV_PI_F, ANYWHERE);
}

static float pdf_above(const layered *c, const shares *s, vec3 o, vec3 i)
{
    float pdf = s->p[CLOUDY] * i[2] * INV_PI_F;
    if (s->p[FACE] > 0.0f && !is_mirror(c, FACE))
        pdf += s->p[FACE] * facets_pdf(c->l.coat, o, normalize3(o + i));
    if (s->p[CLEAR] > 0.0f && !is_mirror(c, CLEAR))
        pdf += s->p[CLEAR] * clear_pdf(c, o, i);
    return pdf;
}

/* ---- The operations ---- */

static spectrum layered_eval(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                             transport_mode mode)
{
    (void)mode;
    if (!(wo[2] * wi[2] > 0.0f))
        return (spectrum){0};
    const layered *c = data_of(b);
    bool flip = wo[2] < 0.0f;
    shares s = wanted_of(c, lobes);
    return eval_above(c, &s, flip_z(wo, flip), flip_z(wi, flip));
}

static float layered_pdf(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
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

/* What of face and metal is flat sends light to one direction together. */
static void mirror(const layered *c, const shares *s, vec3 o, bsdf_sample *out)
{
    out->wi = vec3_make(-o[0], -o[1], o[2]);
    out->pdf = 0.0f;
    out->weight = (spectrum){0};
    for (int k = FACE; k <= CLEAR; k++)
        if (s->wanted[k] && is_mirror(c, k)) {
            out->weight += k == FACE ? spectrum_fill(fresnel_dielectric(o[2], c->l.eta))
                                     : by_way_of_metal(c, o);
            out->pdf += s->p[k];
        }
    out->weight /= out->pdf;
    out->lobe = LOBE_SPECULAR | LOBE_REFLECTION;
}

static bool draw(const layered *c, int k, vec3 o, float u_lobe, vec2 u, vec3 *i)
{
    if (k == FACE) {
        *i = reflect3(o, ggx_sample_visible(c->l.coat, o, u));
    } else if (k == CLOUDY || u_lobe < ANYWHERE) {
        *i = warp_cosine_hemisphere(u);
    } else {
        vec3 p = bent_in(c, o), q = reflect3(p, ggx_sample_visible(c->metal, p, u));
        if (!(q[2] > 0.0f) || !bent_out(c, q, i))
            return false;
    }
    return (*i)[2] > 0.0f;
}

static bool layered_sample(const bsdf *b, vec3 wo, float u_lobe, vec2 u, unsigned lobes,
                           transport_mode mode, bsdf_sample *out)
{
    (void)mode;
    const layered *c = data_of(b);
    bool flip = wo[2] < 0.0f;
    vec3 o = flip_z(wo, flip), i;
    shares s = choose(b, o, lobes);
    int k = pick(&s, &u_lobe);
    if (!(s.p[k] > 0.0f))
        return false;
    if (is_mirror(c, k)) {
        mirror(c, &s, o, out);
    } else {
        if (!draw(c, k, o, u_lobe, u, &i))
            return false;
        out->wi = i;
        out->pdf = pdf_above(c, &s, o, i);
        /* A walk may find nothing where there is something. The direction was drawn all
         * the same, and black would be taken for absorbed. */
        out->weight = eval_above(c, &s, o, i) * (i[2] / out->pdf) + 1e-20f;
        out->lobe = c->lobes[k];
    }
    out->wi = flip_z(out->wi, flip);
    return out->pdf > 0.0f;
}

/* Of light from o, what rough facets reflect. */
static float facets_albedo(const layered *c, vec3 o)
{
    float sum = 0.0f;
    vec2 u[GGX_FEW];
    ggx_few_points(o, u);
    for (int k = 0; k < GGX_FEW; k++) {
        vec3 m = ggx_sample_visible(c->l.coat, o, u[k]), i = reflect3(o, m);
        if (i[2] > 0.0f)
            sum += fresnel_dielectric(dot3(o, m), c->l.eta) *
                   ggx_visible_weight(c->l.coat, o, i) / GGX_FEW;
    }
    return sum;
}

static spectrum layered_albedo(const bsdf *b, vec3 wo, unsigned lobes)
{
    const layered *c = data_of(b);
    vec3 o = flip_z(wo, wo[2] < 0.0f);
    shares s = wanted_of(c, lobes);
    spectrum sum = {0};
    if (s.wanted[FACE])
        sum +=
            is_mirror(c, FACE) ? fresnel_dielectric(o[2], c->l.eta) : facets_albedo(c, o);
    layered_light inside = {0};
    if (s.wanted[CLOUDY] || (s.wanted[CLEAR] && !is_mirror(c, CLEAR)))
        inside = layered_escaping(&c->l, o, WALKS_FOR_ALBEDO);
    if (s.wanted[CLEAR])
        sum += is_mirror(c, CLEAR) ? by_way_of_metal(c, o) : inside.clear;
    if (s.wanted[CLOUDY])
        sum += inside.cloudy;
    return spectrum_clamp(sum, 0.0f, 1.0f);
}

/* The metal's facets as they look from outside. */
static ggx widened(const coat_layers *l)
{
    float widen = 0.5f * square(1.0f - 1.0f / l->eta);
    return ggx_make(sqrtf(square(l->base.alpha_x) + widen * square(l->coat.alpha_x)),
                    sqrtf(square(l->base.alpha_y) + widen * square(l->coat.alpha_y)));
}

void bsdf_make_layered(bsdf *b, const coat_layers *from)
{
    static const bsdf_ops ops = {
        .name = "layered",
        .eval = layered_eval,
        .pdf = layered_pdf,
        .sample = layered_sample,
        .albedo = layered_albedo,
    };
    layered *c = (void *)b->data;
    *c = (layered){.l = *from, .metal = widened(from)};
    c->l.metal_eta /= from->eta;
    c->l.metal_k /= from->eta;
    c->lobes[FACE] = ggx_class(from->coat) | LOBE_REFLECTION;
    if (from->is_metal)
        c->lobes[CLEAR] = ggx_class(c->metal) | LOBE_REFLECTION;
    for (int k = FACE; k <= CLEAR && from->is_followed; k++)
        c->lobes[k] = lobe_followed(c->lobes[k]);
    if (!from->is_metal || !spectrum_is_black(from->albedo))
        c->lobes[CLOUDY] = LOBE_DIFFUSE | LOBE_REFLECTION;
    b->ops = &ops;
    b->lobes = c->lobes[FACE] | c->lobes[CLEAR] | c->lobes[CLOUDY];
    b->lambertian = false;
}
