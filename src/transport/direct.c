#include "transport/direct.h"

/* Shadow rays end this far short of the lamp, as a share of the way. */
#define SHADOW_SHORTENING 1e-4f

static bool visible(const direct_query *query, const light_sample *to_light)
{
    ray shadow = hit_ray(query->hit, to_light->wi);
    shadow.t_max = to_light->distance * (1.0f - SHADOW_SHORTENING);
    return !scene_occluded(query->scene, &shadow);
}

/* The density with which following would go toward the light. */
static float density_of_following(const direct_query *query, vec3 wi)
{
    unsigned lobes = query->followed;
    float p = 1.0f;
    if (query->by_side) {
        vec3 n = query->hit->n_geom;
        bool reflected = dot3(query->wo, n) * dot3(wi, n) > 0.0f;
        lobes &= ~(unsigned)LOBE_ANY_SIDE;
        lobes |= reflected ? LOBE_REFLECTION : LOBE_TRANSMISSION;
        p = query->p_side[reflected ? 0 : 1];
    }
    return p * bsdf_pdf(query->bsdf, query->wo, wi, lobes, TRANSPORT_RADIANCE);
}

/* The density with which the lights are sampled in a direction: following that meets the
   sky meets all of it. */
static float density_of_sampling(const direct_query *query, const light *l,
                                 const light_sample *to_light)
{
    if (!l->kind->is_environment)
        return to_light->pdf;
    return scene_light_pdf(query->scene, query->hit->p, to_light->wi, NULL);
}

/* f of one class of lobes, weighed against following where that is done too. */
static spectrum weighed_lobe(const direct_query *query, const light *l,
                             const light_sample *to_light, unsigned lobe)
{
    if (!(query->bsdf->lobes & lobe))
        return (spectrum){0};
    spectrum f = bsdf_eval(query->bsdf, query->wo, to_light->wi, lobe | LOBE_ANY_SIDE,
                           TRANSPORT_RADIANCE);
    bool shared = (query->followed & lobe) && !l->kind->is_delta && query->shadow_rays;
    if (!shared || spectrum_is_black(f))
        return f;
    float pdf = density_of_following(query, to_light->wi);
    return f * (1.0f - followed_weight(pdf, density_of_sampling(query, l, to_light)));
}

direct_radiance direct_light(const direct_query *query, sampler *random,
                             uint64_t *shadow_rays_traced)
{
    const direct_radiance none = {0};
    light_numbers u = sampler_light(random);
    int index;
    light_sample to_light;
    if (!scene_sample_light(query->scene, query->w, query->hit->p, u.light, u.primitive,
                            u.place, &index, &to_light))
        return none;
    const light *l = scene_light(query->scene, index);
    spectrum diffuse = weighed_lobe(query, l, &to_light, LOBE_DIFFUSE);
    spectrum glossy = weighed_lobe(query, l, &to_light, LOBE_GLOSSY);
    if (spectrum_is_black(diffuse + glossy))
        return none;
    if (query->shadow_rays) {
        ++*shadow_rays_traced;
        if (!visible(query, &to_light))
            return none;
    }
    float cosine = fabsf(dot3(to_light.wi, query->bsdf->shading.n));
    spectrum arriving =
        to_light.radiance * (cosine / to_light.pdf) *
        hit_transmittance_to(query->hit, to_light.wi, to_light.distance, query->w);
    return (direct_radiance){diffuse * arriving, glossy * arriving, index};
}
