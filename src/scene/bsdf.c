/*
 * From the world to the local frame and back, and what depends on both normals: side
 * tests and the adjoint of shading normals.
 */
#include "scene/bsdf_models.h"

/* The largest |wo·n| / |wo·n_geom| that a photon is weighed with. Photons arrive in
 * proportion to |wo·n_geom|, so without a limit the variance would not be finite; the
 * light cut off is below 1/2000 where the normals disagree most. */
#define MAX_GRAZING_RATIO 1000.0f

/* A direction in the frame of the shading normal. */
typedef struct local_direction {
    vec3 w;
    float cos_geom;
} local_direction;

/* False if the two normals disagree about the side that the direction is on. */
static bool to_local(const bsdf *b, vec3 world, local_direction *out)
{
    out->w = frame_to_local(&b->shading, world);
    out->cos_geom = dot3(world, b->n_geom);
    return out->w[2] * out->cos_geom > 0.0f;
}

/* Veach 1997, eq. 5.19, without the cosine |wi·n| that callers multiply with. */
static float adjoint_factor(const local_direction *wo, const local_direction *wi)
{
    float from = minf(fabsf(wo->w[2] / wo->cos_geom), MAX_GRAZING_RATIO);
    return from * fabsf(wi->cos_geom / wi->w[2]);
}

spectrum bsdf_eval(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes, transport_mode mode)
{
    local_direction o, i;
    if (!to_local(b, wo, &o) || !to_local(b, wi, &i))
        return (spectrum){0};
    spectrum f = b->ops->eval(b, o.w, i.w, lobes, mode);
    return mode == TRANSPORT_IMPORTANCE ? f * adjoint_factor(&o, &i) : f;
}

float bsdf_pdf(const bsdf *b, vec3 wo, vec3 wi, unsigned lobes, transport_mode mode)
{
    local_direction o, i;
    if (!to_local(b, wo, &o) || !to_local(b, wi, &i))
        return 0.0f;
    return b->ops->pdf(b, o.w, i.w, lobes, mode);
}

bool bsdf_sample_direction(const bsdf *b, vec3 wo, float u_lobe, vec2 u, unsigned lobes,
                           transport_mode mode, bsdf_sample *out)
{
    local_direction o, i;
    if (!to_local(b, wo, &o))
        return false;
    out->lane = b->lane; /* a model sets the rest, these only if it changes them */
    out->eta = 1.0f;
    if (!b->ops->sample(b, o.w, u_lobe, u, lobes, mode, out))
        return false;
    out->wi = normalize3(frame_to_world(&b->shading, out->wi));
    if (!to_local(b, out->wi, &i) || spectrum_is_black(out->weight))
        return false;
    if (mode == TRANSPORT_IMPORTANCE)
        out->weight *= adjoint_factor(&o, &i);
    return true;
}

spectrum bsdf_albedo(const bsdf *b, vec3 wo, unsigned lobes)
{
    local_direction o;
    if (!to_local(b, wo, &o))
        return (spectrum){0};
    return b->ops->albedo(b, o.w, lobes);
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
