/*
 * The lights of a committed scene, asked as one: emission at a hit, and a light chosen by
 * what it sends to a point, with a direction to it.
 */
#include "scene/scene.h"

spectrum scene_emitted(const scene *s, const surface_hit *hit, vec3 wo,
                       const wavelengths *w)
{
    if (hit->light == NO_INDEX)
        return spectrum_fill(0.0f);
    const light *l = scene_light(s, hit->light);
    return l->kind->radiance(l->self, hit, wo, w);
}

static bool has_lights(const scene *s, bool delta)
{
    for (unsigned i = 0; i < s->lights->len; i++)
        if (scene_light(s, (int)i)->is_delta == delta)
            return true;
    return false;
}

bool scene_has_delta_lights(const scene *s)
{
    return has_lights(s, true);
}

bool scene_has_lights_to_see(const scene *s)
{
    return has_lights(s, false);
}

bool scene_sample_one_light(const scene *s, int i, const wavelengths *w, vec3 ref,
                            float u_primitive, vec2 u, light_sample *out)
{
    const light *l = scene_light(s, i);
    return l->kind->sample(l->self, w, ref, u_primitive, u, out) && out->pdf > 0.0f;
}

bool scene_sample_light(const scene *s, const wavelengths *w, vec3 ref, float u_light,
                        float u_primitive, vec2 u, int *index, light_sample *out)
{
    float p;
    *index = light_tree_sample(s->light_tree, ref, u_light, &p);
    if (*index < 0 || !scene_sample_one_light(s, *index, w, ref, u_primitive, u, out))
        return false;
    out->pdf *= p;
    return out->pdf > 0.0f;
}

float scene_one_light_pdf(const scene *s, int i, vec3 ref, vec3 wi,
                          const surface_hit *hit)
{
    const light *l = scene_light(s, i);
    return l->kind->pdf(l->self, ref, wi, hit);
}

float scene_light_pdf(const scene *s, int i, vec3 ref, vec3 wi, const surface_hit *hit)
{
    return light_tree_probability(s->light_tree, ref, i) *
           scene_one_light_pdf(s, i, ref, wi, hit);
}
