/*
 * A walk through the layers of a coat.
 *
 *      o                i       o: where light comes from, i: where it is looked for
 *       \              /        (or the other way round: nothing changes)
 *   -----\------------/-----    face   GGX facets or flat, index eta
 *         \    *     /          coat   particles, one on average per unit of depth
 *          \  / \   /
 *   ========\/===\=/========    base   GGX facets of metal, a mirror, or Lambert's law
 *
 * Light that enters from o is followed from event to event: particle, base or face. At
 * each particle and at the base it is joined to the way that light from i would take into
 * the coat; and where the face is rough, each new direction also to i itself. Which of
 * the two found a way is weighed by the balance heuristic (Veach 1997, chapter 9). The
 * mean over all walks is the reflectance of the layers, as pbrt-v4 has it: Guo, Hašan &
 * Zhao, "Position-Free Monte Carlo Simulation for Arbitrary Layered BSDFs", 2018.
 *
 * A walk's numbers are hashed from the two directions, rounded, so that they are as good
 * as always the same for directions that come from elsewhere. Way and joint are symmetric
 * in o and i on average; they are made so each time by always starting from the same one
 * of the two.
 */
#include "bsdf/bsdf_dielectric.h"
#include "bsdf/bsdf_layered.h"
#include "math/sampler.h"
#include "math/warp.h"

enum { ROULETTE_DEPTH = 3 };

/* Light dimmer than this share of what entered may be given up. */
#define ROULETTE_SHARE 0.25f

/* A way through the face into the coat. */
typedef struct passage {
    vec3 w; /* down */
    float weight, pdf;
} passage;

typedef struct walk {
    const coat_layers *l;
    uint64_t numbers;
    vec3 w;         /* where it goes, down < 0 */
    spectrum light; /* what is left of it */
    float depth;    /* below the face */
    bool cloudy;
    const vec3 *i;     /* where it is looked for; NULL: everywhere above */
    passage from_i;    /* if i is given */
    spectrum rounds;   /* between two mirrors, of light on that way: 1 + x + ... */
    spectrum mirrored; /* by the lower of them; 0: there are none */
    layered_light sum; /* of f, or of what comes out */
} walk;

static float draw(walk *k)
{
    k->numbers += 0x9e3779b97f4a7c15u;
    uint64_t x = k->numbers;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return (float)((x ^ (x >> 31)) >> 40) * 0x1p-24f;
}

static vec2 draw2(walk *k)
{
    float x = draw(k);
    return (vec2){x, draw(k)};
}

static vec3 facet(ggx g, vec3 w, vec2 u)
{
    return ggx_is_smooth(g) ? vec3_make(0, 0, 1) : ggx_sample_visible(g, w, u);
}

static float facet_weight(ggx g, vec3 wo, vec3 wi)
{
    return ggx_is_smooth(g) ? 1.0f : ggx_visible_weight(g, wo, wi);
}

static bool enter(const coat_layers *l, vec3 o, vec2 u, passage *out)
{
    vec3 m = facet(l->coat, o, u);
    if (!refract3(o, m, l->eta, &out->w) || !(out->w[2] < 0.0f))
        return false;
    out->weight = (1.0f - fresnel_dielectric(dot3(o, m), l->eta)) *
                  facet_weight(l->coat, o, out->w);
    out->pdf = 0.0f;
    if (!ggx_is_smooth(l->coat)) {
        float passes;
        dielectric_refraction(l->coat, o, out->w, l->eta, &passes, &out->pdf);
        return out->pdf > 0.0f;
    }
    return true;
}

static void add(walk *k, spectrum light)
{
    if (k->cloudy)
        k->sum.cloudy += light;
    else
        k->sum.clear += light;
}

static float attenuation(float depth, vec3 w)
{
    return expf(-depth / maxf(fabsf(w[2]), 1e-6f));
}

/* ---- Joining it to i ---- */

/* Along the way that light from i takes: f and pdf are those of the event there. */
static void join_passage(walk *k, spectrum f, float pdf)
{
    const coat_layers *l = k->l;
    float weight = k->from_i.weight * attenuation(k->depth, k->from_i.w) / square(l->eta);
    if (!ggx_is_smooth(l->coat))
        weight *= k->from_i.pdf / (k->from_i.pdf + pdf);
    add(k, k->light * f * weight);
}

/* From the direction it has, drawn with pdf (0: the only one there was). */
static void join_face(walk *k, float pdf)
{
    const coat_layers *l = k->l;
    if (!k->i || ggx_is_smooth(l->coat) || !(k->w[2] > 0.0f))
        return;
    float passes, pdf_face;
    float f = dielectric_refraction(l->coat, *k->i, -k->w, l->eta, &passes, &pdf_face);
    float weight = f * attenuation(k->depth, k->w) / square(l->eta);
    if (weight > 0.0f && pdf > 0.0f)
        weight *= pdf / (pdf + pdf_face);
    if (weight > 0.0f)
        add(k, k->light * weight);
}

/* ---- Events ---- */

/* Henyey & Greenstein, "Diffuse Radiation in the Galaxy", 1941. */
static float phase(float g, float cosine)
{
    float d = maxf(1.0f + g * g - 2.0f * g * cosine, 1e-6f);
    return 0.25f * INV_PI_F * (1.0f - g * g) / (d * sqrtf(d));
}

static vec3 draw_phase(float g, vec3 w, vec2 u)
{
    float cosine = 1.0f - 2.0f * u.x;
    if (fabsf(g) > 1e-3f) {
        float q = (1.0f - g * g) / (1.0f - g + 2.0f * g * u.x);
        cosine = clampf((1.0f + g * g - q * q) / (2.0f * g), -1.0f, 1.0f);
    }
    float sine = sqrtf(maxf(0.0f, 1.0f - cosine * cosine)), phi = 2.0f * PI_F * u.y;
    frame around = frame_from_normal(w);
    return normalize3(
        frame_to_world(&around, vec3_make(sine * cosf(phi), sine * sinf(phi), cosine)));
}

/* From a particle, straight and by way of a mirror below, which no walk comes from. */
static void join_particle(walk *k)
{
    const coat_layers *l = k->l;
    vec3 up = -k->from_i.w, down = vec3_make(up[0], up[1], -up[2]);
    float p = phase(l->g, dot3(k->w, up)), q = phase(l->g, dot3(k->w, down));
    spectrum by_mirror =
        k->mirrored * (q * attenuation(2.0f * (l->thickness - k->depth), up));
    join_passage(k, (p + by_mirror) * k->rounds / maxf(up[2], 1e-6f), p);
}

static bool meet_particle(walk *k)
{
    float g = k->l->g;
    k->light *= k->l->albedo;
    k->cloudy = true;
    if (k->i)
        join_particle(k);
    vec3 w = draw_phase(g, k->w, draw2(k));
    float p = phase(g, dot3(k->w, w));
    k->w = w;
    join_face(k, p);
    return true;
}

static bool meet_diffuse(walk *k)
{
    k->light *= k->l->rho;
    if (k->i)
        join_passage(k, spectrum_fill(INV_PI_F), -k->from_i.w[2] * INV_PI_F);
    k->w = warp_cosine_hemisphere(draw2(k));
    join_face(k, k->w[2] * INV_PI_F);
    return k->w[2] > 0.0f;
}

/* f and pdf of the metal's facets. */
static spectrum metal_value(const coat_layers *l, vec3 wo, vec3 wi, float *pdf)
{
    vec3 m = normalize3(wo + wi);
    float density = ggx_density(l->base, m);
    float so = ggx_stretched(l->base, wo), si = ggx_stretched(l->base, wi);
    *pdf = density / (2.0f * (wo[2] + so));
    return fresnel_conductor(dot3(wo, m), l->metal_eta, l->metal_k) *
           (density / (2.0f * (wo[2] * si + wi[2] * so)));
}

static bool meet_metal(walk *k)
{
    const coat_layers *l = k->l;
    bool rough = !ggx_is_smooth(l->base);
    vec3 back = -k->w;
    float pdf = 0.0f;
    if (k->i && rough) {
        spectrum f = metal_value(l, back, -k->from_i.w, &pdf);
        join_passage(k, f, pdf);
    }
    vec3 m = facet(l->base, back, draw2(k)), w = reflect3(back, m);
    if (!(w[2] > 0.0f))
        return false;
    k->light *= fresnel_conductor(dot3(back, m), l->metal_eta, l->metal_k) *
                facet_weight(l->base, back, w);
    if (rough)
        metal_value(l, back, w, &pdf);
    k->w = w;
    join_face(k, pdf);
    return true;
}

/* From below. Where all that comes out is wanted, its share leaves here. */
static bool meet_face(walk *k)
{
    const coat_layers *l = k->l;
    vec3 o = vec3_make(-k->w[0], -k->w[1], k->w[2]); /* turned upside down */
    vec3 m = facet(l->coat, o, draw2(k)), i = reflect3(o, m), t;
    float r = fresnel_dielectric(dot3(o, m), 1.0f / l->eta);
    if (!k->i && refract3(o, m, 1.0f / l->eta, &t) && t[2] < 0.0f)
        add(k, k->light * ((1.0f - r) * facet_weight(l->coat, o, t)));
    k->light *= r * facet_weight(l->coat, o, i);
    k->w = vec3_make(i[0], i[1], -i[2]);
    return i[2] > 0.0f;
}

/* On to the next event. @return false: its end */
static bool step(walk *k)
{
    const coat_layers *l = k->l;
    bool down = k->w[2] < 0.0f;
    if (!(fabsf(k->w[2]) > 1e-6f))
        return false;
    if (spectrum_is_black(l->albedo)) {
        k->light *= attenuation(l->thickness, k->w);
    } else {
        float segment = -logf(1.0f - draw(k)) * k->w[2], depth = k->depth - segment;
        if (depth > 0.0f && depth < l->thickness) {
            k->depth = depth;
            return meet_particle(k);
        }
    }
    k->depth = down ? l->thickness : 0.0f;
    if (!down)
        return meet_face(k);
    return l->is_metal ? meet_metal(k) : meet_diffuse(k);
}

static bool survives(walk *k, int depth)
{
    float p = spectrum_max(k->light);
    if (depth <= ROULETTE_DEPTH || p >= ROULETTE_SHARE)
        return p > 0.0f;
    if (!(draw(k) < p))
        return false;
    k->light /= p;
    return true;
}

static void find_rounds(walk *k)
{
    const coat_layers *l = k->l;
    float cosine = -k->from_i.w[2];
    k->rounds = spectrum_fill(1.0f);
    if (!l->is_metal || !ggx_is_smooth(l->coat) || !ggx_is_smooth(l->base))
        return;
    k->mirrored = fresnel_conductor(cosine, l->metal_eta, l->metal_k);
    float back = fresnel_dielectric(cosine, 1.0f / l->eta) *
                 attenuation(2.0f * l->thickness, k->from_i.w);
    k->rounds /= 1.0f - back * k->mirrored;
}

static layered_light follow(const coat_layers *l, vec3 o, const vec3 *i, uint64_t key)
{
    walk k = {.l = l, .numbers = key, .i = i, .cloudy = !l->is_metal};
    passage in;
    if (!enter(l, o, draw2(&k), &in) || (i && !enter(l, *i, draw2(&k), &k.from_i)))
        return k.sum;
    find_rounds(&k);
    k.w = in.w;
    k.light = spectrum_fill(in.weight);
    for (int depth = 0; depth < l->max_depth; depth++)
        if (!survives(&k, depth) || !step(&k))
            break;
    return k.sum;
}

/* ---- Means of walks ---- */

static uint64_t coarse(vec3 w)
{
    uint64_t key = 0;
    for (int i = 0; i < 3; i++)
        key = key << 10 | (uint64_t)(int)(256.0f * w[i] + 512.0f);
    return key;
}

static bool comes_first(vec3 a, vec3 b)
{
    for (int i = 2; i > 0; i--)
        if (a[i] < b[i] || b[i] < a[i])
            return a[i] < b[i];
    return a[0] < b[0];
}

static layered_light mean(const coat_layers *l, vec3 o, const vec3 *i, uint64_t key,
                          int n)
{
    layered_light sum = {0};
    for (int k = 0; k < n; k++) {
        layered_light one = follow(l, o, i, hash_mix(key, (uint64_t)k));
        sum.clear += one.clear / (float)n;
        sum.cloudy += one.cloudy / (float)n;
    }
    return sum;
}

layered_light layered_inside(const coat_layers *l, vec3 o, vec3 i)
{
    if (comes_first(i, o)) {
        vec3 swap = o;
        o = i;
        i = swap;
    }
    return mean(l, o, &i, hash_mix(coarse(o) << 30 | coarse(i), l->seed), l->n_walks);
}

layered_light layered_escaping(const coat_layers *l, vec3 o, int n)
{
    return mean(l, o, NULL, hash_mix(coarse(o), l->seed), n);
}
