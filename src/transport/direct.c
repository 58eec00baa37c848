#include "transport/direct.h"

/* What arrives of the light. @return false: something stands before it */
static bool visible(const direct_query *query, vec3 wi, float distance,
                    spectrum *transmittance, uint64_t *shadow_rays_traced)
{
    const scene_look look = {query->scene, query->w, query->options, query->most_panes};
    *shadow_rays_traced += query->shadow_rays;
    if (query->shadow_rays)
        return scene_sees_from(&look, query->hit, wi, distance, transmittance);
    const ray r = hit_ray_to(query->hit, wi, distance);
    *transmittance = scene_transmittance(query->scene, &r, query->w);
    return true;
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

/* The density with which looking for environments would. */
static float density_of_looking(const direct_query *query, vec3 wi)
{
    return bsdf_pdf(query->bsdf, query->wo, wi, query->looked | LOBE_ANY_SIDE,
                    TRANSPORT_RADIANCE);
}

/* f of one class of lobes, weighed against following or looking where that is done too.
 * *pdf: of following, the same for all classes; negative until one has asked for it. */
static spectrum weighed_lobe(const direct_query *query, const light_sample *to_light,
                             const light *from, unsigned lobe, float *pdf)
{
    if (!(query->bsdf->lobes & lobe))
        return (spectrum){0};
    spectrum f = bsdf_eval(query->bsdf, query->wo, to_light->wi, lobe | LOBE_ANY_SIDE,
                           TRANSPORT_RADIANCE);
    bool looked = (query->looked & lobe) && from->kind->is_environment;
    bool followed = (query->followed & lobe) && !from->is_delta;
    if (!(looked || followed) || !query->shadow_rays || spectrum_is_black(f))
        return f;
    if (looked)
        return f * (1.0f - followed_weight(density_of_looking(query, to_light->wi),
                                           to_light->pdf));
    if (*pdf < 0.0f)
        *pdf = density_of_following(query, to_light->wi);
    return f * (1.0f - followed_weight(*pdf, to_light->pdf));
}

/* What photons leave of the light that a glossy lobe sends. */
static float glossy_mis_weight(const direct_query *query, const light_sample *to_light,
                               int source, bool each)
{
    const scene *s = query->scene;
    const bool far = isinf(to_light->distance);
    const vec3 here = query->hit->p, wi = to_light->wi;
    caustic_end end = {
        .light = source,
        .p = far ? here : here + wi * to_light->distance,
        .n = to_light->n,
        .direction = -wi,
        .distance = to_light->distance,
        .pdf_lights = to_light->pdf,
        .pdf_scatter =
            bsdf_pdf(query->all_wavelengths, query->wo, wi, LOBE_ALL, TRANSPORT_RADIANCE),
    };
    if (each)
        end.pdf_lights *= light_tree_probability(s->light_tree, here, source);
    return 1.0f - caustic_mis_weight(query->mis, &end);
}

/* What a light sample gives. @return false if that is nothing. */
static bool radiance_of(const direct_query *query, const light_sample *to_light,
                        bool each, direct_radiance *found, uint64_t *shadow_rays_traced)
{
    const light *from = scene_light(query->scene, found->light);
    float pdf = -1.0f;
    spectrum diffuse = weighed_lobe(query, to_light, from, LOBE_DIFFUSE, &pdf);
    spectrum glossy = weighed_lobe(query, to_light, from, LOBE_GLOSSY, &pdf);
    if (query->mis && !spectrum_is_black(glossy))
        glossy *= glossy_mis_weight(query, to_light, found->light, each);
    if (spectrum_is_black(diffuse + glossy))
        return false;
    spectrum transmittance;
    if (!visible(query, to_light->wi, to_light->distance, &transmittance,
                 shadow_rays_traced))
        return false;
    float cosine = bsdf_cosine(query->bsdf, to_light->wi);
    spectrum arriving = to_light->radiance * (cosine / to_light->pdf) * transmittance;
    found->diffuse = diffuse * arriving;
    found->glossy = glossy * arriving;
    return true;
}

static bool samples_each(const scene *s, bool every_light)
{
    return every_light && s->lights->len <= FEW_LIGHTS;
}

int direct_light(const direct_query *query, sampler *random,
                 direct_radiance found[FEW_LIGHTS], uint64_t *shadow_rays_traced)
{
    const scene *s = query->scene;
    bool each = samples_each(s, query->every_light);
    int n_samples = each ? (int)s->lights->len : 1, n_found = 0;
    for (int i = 0; i < n_samples; i++) {
        light_numbers u = sampler_light(random);
        light_sample to_light;
        int index = i;
        bool reached = each ? scene_sample_one_light(s, i, query->w, query->hit->p,
                                                     u.primitive, u.place, &to_light)
                            : scene_sample_light(s, query->w, query->hit->p, u.light,
                                                 u.primitive, u.place, &index, &to_light);
        if (!reached)
            continue;
        found[n_found].light = index;
        n_found +=
            radiance_of(query, &to_light, each, &found[n_found], shadow_rays_traced);
    }
    return n_found;
}

/* Where all of a light starts from one point. */
static bool pivot_of_beam(const light *l, const ray *r, float length, medium_pivot *out)
{
    const cone3 beam = l->kind->beam(l->self);
    const line_span lit = cone3_clip(&beam, r->origin, r->direction, length);
    *out = medium_pivot_at(r, beam.apex, lit);
    return lit.end > lit.begin;
}

bool direct_pivot(const scene *s, const wavelengths *w, const ray *r, float length,
                  sampler *random, medium_pivot *out)
{
    light_sample to_light;
    float p;
    const light_numbers u = sampler_light(random);
    float u_segment = sampler_1d(random);
    medium_sample any = medium_sample_within(scene_medium(s, r->media.participating), w,
                                             spectrum_fill(1.0f), length, u_segment);
    vec3 from = r->origin + any.t * r->direction;
    int source = any.scatters ? light_tree_sample(s->light_tree, from, u.light, &p) : -1;
    if (source < 0)
        return false;
    if (scene_light(s, source)->kind->beam)
        return pivot_of_beam(scene_light(s, source), r, length, out);
    if (!scene_sample_one_light(s, source, w, from, u.primitive, u.place, &to_light) ||
        !isfinite(to_light.distance))
        return false;
    *out = medium_pivot_at(r, from + to_light.distance * to_light.wi,
                           (line_span){0.0f, length});
    return true;
}

void direct_meet(const scene *s, const wavelengths *w, const ray *r,
                 const surface_hit *hit, void (*tell)(void *path, const met_light *met),
                 void *path)
{
    if (hit && hit->light != NO_INDEX) {
        const met_light met = {hit->light, scene_emitted(s, hit, -r->direction, w), hit};
        if (!spectrum_is_black(met.radiance))
            tell(path, &met);
    }
    for (int i = 0; i < s->n_environments && !hit; i++) {
        const light *l = scene_light(s, s->environments[i]);
        const met_light met = {s->environments[i],
                               l->kind->environment(l->self, r->origin, r->direction, w),
                               NULL};
        tell(path, &met);
    }
}

/* Of a path that ran into a light which is sampled from where it scattered last. */
static float met_weight(const scene *s, const scattered_from *from, vec3 direction,
                        const met_light *met)
{
    float pdf = samples_each(s, from->every_light)
                    ? scene_one_light_pdf(s, met->light, from->p, direction, met->hit)
                    : scene_light_pdf(s, met->light, from->p, direction, met->hit);
    return followed_weight(from->pdf, pdf);
}

float direct_met_weight(const scene *s, const settings *how, const scattered_from *from,
                        vec3 direction, const met_light *met)
{
    if (!(from->pdf > 0.0f) || !how->direct_illumination)
        return 1.0f;
    if (!how->shadow_rays)
        return 0.0f;
    return met_weight(s, from, direction, met);
}

/* ---- Looking for environments ---- */

/* A direction in which nothing stands before them. */
typedef struct environment_look {
    const direct_query *query;
    const bsdf_sample *drawn;
    spectrum arriving; /* of 1 from there, what goes to wo */
    void (*tell)(void *path, const met_light *met);
    void *path;
} environment_look;

static void weigh_environment(void *data, const met_light *met)
{
    const environment_look *look = data;
    const direct_query *query = look->query;
    const scattered_from here = {query->hit->p, look->drawn->pdf, query->every_light};
    float weight = met_weight(query->scene, &here, look->drawn->wi, met);
    const met_light weighed = {met->light, weight * met->radiance * look->arriving, NULL};
    look->tell(look->path, &weighed);
}

void direct_environments(const direct_query *query, sampler *random,
                         void (*tell)(void *path, const met_light *met), void *path,
                         uint64_t *shadow_rays_traced)
{
    const scene *s = query->scene;
    if (s->n_environments == 0 || !query->looked || !query->shadow_rays)
        return;
    float u_lobe = sampler_1d(random);
    vec2 u = sampler_2d(random);
    bsdf_sample drawn;
    if (!bsdf_sample_direction(query->bsdf, query->wo, u_lobe, u,
                               query->looked | LOBE_ANY_SIDE, TRANSPORT_RADIANCE, &drawn))
        return;
    environment_look look = {query, &drawn, drawn.weight, tell, path};
    spectrum transmittance;
    if (!visible(query, drawn.wi, INFINITY, &transmittance, shadow_rays_traced))
        return;
    const ray away = hit_ray_to(query->hit, drawn.wi, INFINITY);
    look.arriving *= transmittance;
    direct_meet(s, query->w, &away, NULL, weigh_environment, &look);
}
