/*
 * From the world to the local frame and back, and what depends on both normals: sides,
 * and the adjoint of shading normals.
 *
 *   n_geom    n
 *      |     /          w is on one side of the surface and on the other of n: so it is
 *      |    /           at the rims of a smooth mesh and on slopes of a normal map. Taken
 *      |   /    w       as it stands it would scatter nothing, and rims turn black. It is
 *      |  /  .          folded instead, by the mirror that swaps the two normals:
 *      | /.
 *   ---+---------  surface            w' = T(w)
 *
 * T takes each side of the surface to that side of n, one to one and keeping solid
 * angles, and is its own inverse. So no light is lost and none gained: the albedo for the
 * eye's direction e is the model's own for T(e). From where light comes only narrow lobes
 * are folded. Wide ones fade to nothing at the plane of n, and to light them again behind
 * it would show each facet. With l the way to the light and callers that multiply by
 * |wi·n|:
 *
 *   radiance    wi = l, f = f_model(T e, T l) |T l·n| / |l·n|
 *   importance  wi = e, f = f_model(T l, T e) |T l·n| / |l·n_geom| |e·n_geom| / |e·n|
 *
 * Other cures bend the normal to suit the eye (Keller et al., "The Iray Light Transport
 * Simulation and Rendering System", 2017), which has no adjoint for mirrors, or add a
 * second facet (Schüssler et al., "Microfacet-Based Normal Mapping", 2017), which needs
 * every model written anew.
 */
#include "bsdf/bsdf_models.h"

/* The largest |wo·n| / |wo·n_geom| that a photon is weighed with. Photons arrive in
 * proportion to |wo·n_geom|, so without a limit the variance would not be finite; the
 * light cut off is below 1/2000 where the normals disagree most. */
#define MAX_GRAZING_RATIO 1000.0f

/* A direction in the frame of the shading normal, on the side where it really is. */
typedef struct local_direction {
    vec3 w;
    float cos_geom;
    bool folded;
} local_direction;

static bool is_between(const bsdf *b, vec3 world)
{
    return dot3(world, b->shading.n) * dot3(world, b->n_geom) < 0.0f;
}

/* The mirror that swaps the two normals. */
static vec3 swap_normals(const bsdf *b, vec3 world)
{
    vec3 h = b->shading.n - b->n_geom;
    float h2 = length3_2(h);
    if (!(h2 > 1e-10f)) /* then the direction is in both planes, but for rounding */
        return world - 2.0f * dot3(world, b->shading.n) * b->shading.n;
    return world - (2.0f * dot3(world, h) / h2) * h;
}

/* False for directions in one of the two planes. */
static bool to_local(const bsdf *b, vec3 world, local_direction *out)
{
    out->folded = is_between(b, world);
    out->cos_geom = dot3(world, b->n_geom);
    out->w = frame_to_local(&b->shading, out->folded ? swap_normals(b, world) : world);
    return out->w[2] * out->cos_geom > 0.0f;
}

/* The lobes that light from between the planes takes part in. */
static unsigned lobes_lit(const local_direction *light, unsigned lobes)
{
    return light->folded ? lobes & ~(unsigned)LOBE_DIFFUSE : lobes;
}

/* The cosine at the shading normal over that at the surface, of the light's direction. */
static float light_ratio(const local_direction *light)
{
    return minf(fabsf(light->w[2] / light->cos_geom), MAX_GRAZING_RATIO);
}

/* What callers multiply with is |wi·n|, folded or not. */
static float per_cosine(const bsdf *b, vec3 wi, float cosine)
{
    float given = fabsf(dot3(wi, b->shading.n));
    return given > 1e-7f ? cosine / given : 0.0f;
}

spectrum bsdf_eval(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes, transport_mode mode)
{
    local_direction o, i;
    if (b->is_phase)
        return b->ops->eval(b, wo, wi, lobes, mode);
    if (!to_local(b, wo, &o) || !to_local(b, wi, &i))
        return (spectrum){0};
    bool photon = mode == TRANSPORT_IMPORTANCE;
    spectrum f = b->ops->eval(b, o.w, i.w, lobes_lit(photon ? &o : &i, lobes), mode);
    if (photon) /* Veach 1997, eq. 5.19 */
        return f * (light_ratio(&o) * per_cosine(b, wi, fabsf(i.cos_geom)));
    return i.folded ? f * per_cosine(b, wi, fabsf(i.w[2])) : f;
}

float bsdf_pdf(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes, transport_mode mode)
{
    local_direction o, i;
    if (b->is_phase)
        return b->ops->pdf(b, wo, wi, lobes, mode);
    if (!to_local(b, wo, &o) || !to_local(b, wi, &i))
        return 0.0f;
    if (mode == TRANSPORT_IMPORTANCE)
        lobes = lobes_lit(&o, lobes);
    else if (i.folded &&
             spectrum_is_black(b->ops->eval(b, o.w, i.w, lobes_lit(&i, lobes), mode)))
        return 0.0f; /* nothing is lit: sampling rejects it */
    return b->ops->pdf(b, o.w, i.w, lobes, mode);
}

/* What of a sample the lobes that are lit carry: its density stays that of all that were
 * asked for. */
static void keep_lit(const bsdf *b, const local_direction *o, const local_direction *i,
                     unsigned lobes, bsdf_sample *out)
{
    unsigned lit = lobes_lit(i, lobes);
    if (lit == lobes || (out->lobe & LOBE_SPECULAR))
        return;
    out->weight = b->ops->eval(b, o->w, i->w, lit, TRANSPORT_RADIANCE) *
                  (fabsf(i->w[2]) / out->pdf);
}

bool bsdf_sample_direction(const bsdf *b, vec3 wo, float u_lobe, vec2 u, unsigned lobes,
                           transport_mode mode, bsdf_sample *out)
{
    local_direction o, i;
    bool photon = mode == TRANSPORT_IMPORTANCE;
    out->wavelength =
        b->wavelength; /* a model sets the rest, these only if it changes them */
    out->eta = 1.0f;
    out->straight = false;
    if (b->is_phase)
        return b->ops->sample(b, wo, u_lobe, u, lobes, mode, out);
    if (!to_local(b, wo, &o))
        return false;
    if (photon)
        lobes = lobes_lit(&o, lobes);
    if (!b->ops->sample(b, o.w, u_lobe, u, lobes, mode, out))
        return false;
    vec3 world = normalize3(frame_to_world(&b->shading, out->wi));
    out->wi = is_between(b, world) ? normalize3(swap_normals(b, world)) : world;
    if (!to_local(b, out->wi, &i))
        return false;
    if (photon)
        out->weight *= light_ratio(&o) * fabsf(i.cos_geom / i.w[2]);
    else
        keep_lit(b, &o, &i, lobes, out);
    return !spectrum_is_black(out->weight);
}

unsigned bsdf_choose_class(const bsdf *b, vec3 wo, vec3 wi, transport_mode mode, float u,
                           spectrum *f)
{
    spectrum diffuse = bsdf_eval(b, wo, wi, LOBE_DIFFUSE | LOBE_ANY_SIDE, mode);
    spectrum glossy = bsdf_eval(b, wo, wi, LOBE_GLOSSY | LOBE_ANY_SIDE, mode);
    float d = spectrum_mean(diffuse), g = spectrum_mean(glossy);
    *f = (spectrum){0};
    if (!(d + g > 0.0f))
        return 0;
    bool first = u * (d + g) < d;
    *f = first ? diffuse * ((d + g) / d) : glossy * ((d + g) / g);
    return first ? LOBE_DIFFUSE : LOBE_GLOSSY;
}

void bsdf_settle_class(const bsdf *b, vec3 wo, transport_mode mode, float u,
                       bsdf_sample *drawn)
{
    bool is_dispersed =
        drawn->wavelength != b->wavelength; /* the weight has one wavelength of f */
    spectrum f;
    if (!bsdf_has_both(b) || (drawn->lobe & LOBE_SPECULAR) || is_dispersed)
        return;
    unsigned class = bsdf_choose_class(b, wo, drawn->wi, mode, u, &f);
    if (!class)
        return;
    drawn->weight = f * (bsdf_cosine(b, drawn->wi) / drawn->pdf);
    drawn->lobe = class | (drawn->lobe & LOBE_ANY_SIDE);
}

spectrum bsdf_albedo(const bsdf *b, vec3 wo, unsigned lobes)
{
    local_direction o;
    if (b->is_phase)
        return b->ops->albedo(b, wo, lobes);
    if (!to_local(b, wo, &o))
        return (spectrum){0};
    return b->ops->albedo(b, o.w, lobes);
}

spectrum bsdf_straight(const bsdf *b, vec3 wo)
{
    local_direction o;
    if (b->is_phase || !b->ops->straight || !to_local(b, wo, &o))
        return (spectrum){0};
    return b->ops->straight(b, o.w);
}

spectrum bsdf_delta_eval(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes,
                         transport_mode mode)
{
    (void)b, (void)wo, (void)wi, (void)lobes, (void)mode;
    return (spectrum){0};
}

float bsdf_delta_pdf(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes, transport_mode mode)
{
    (void)b, (void)wo, (void)wi, (void)lobes, (void)mode;
    return 0.0f;
}
