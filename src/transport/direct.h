/*
 * Direct light by sampling the lights (next-event estimation), and the weights with which
 * it shares its work with rays that hit lights by themselves (Veach 1997, §9.2: power
 * heuristic).
 */
#pragma once

#include "math/sampler.h"
#include "medium/medium_sample.h"
#include "photon/share.h"
#include "scene/scene.h"

/** @brief What to evaluate at a surface, and how its lobes find light otherwise. */
typedef struct direct_query {
    const scene *scene;
    const wavelengths *w;
    const surface_hit *hit;
    const bsdf *bsdf;
    vec3 wo;
    bool every_light;  /**< sample each light, where they are few, instead of one: where
                          grain shows */
    bool shadow_rays;  /**< false: light passes through everything */
    unsigned followed; /**< the mask that the path goes on with: those classes share the
                          work with light sampling, for the others it is the only way */
    bool by_side;      /**< the path takes each side apart ... */
    float p_side[2];   /**< ... with this probability: reflection, transmission */
    /** Of what glossy lobes send, photons carry this share; NULL: none of it. */
    const caustic_share *share;
    const bsdf *all_lanes; /**< for the share: the bsdf, whatever lane the path keeps */
} direct_query;

/** @brief Up to so many lights are few. */
enum { FEW_LIGHTS = 4 };

/** @brief Radiance sent to wo from one light, by the class of lobe that sends it. */
typedef struct direct_radiance {
    spectrum diffuse, glossy;
    int light; /**< that it came from */
} direct_radiance;

/** @brief Light that comes straight from lamps, by a sample of one or of each.
 *  @param shadow_rays_traced is increased
 *  @return how many lights gave something; found holds that many */
int direct_light(const direct_query *query, sampler *random,
                 direct_radiance found[FEW_LIGHTS], uint64_t *shadow_rays_traced);

/** @brief A place on a lamp that may light a ray through a medium: one to draw points
 * near (medium_sample.h). @param length m: how far the medium reaches
 *  @return false: there is none, or it is beyond the scene */
bool direct_pivot(const scene *s, const wavelengths *w, const ray *r, float length,
                  sampler *random, medium_pivot *out);

/** @brief pdf_solid_angle with which direct_light at point `from` samples a light in
 *  direction wi.
 *  @param every_light as in the query
 *  @param hit on the light; NULL for environments */
float direct_light_pdf(const scene *s, bool every_light, int lamp, vec3 from, vec3 wi,
                       const surface_hit *hit);

/** @brief Weight of a followed direction of density pdf_bsdf that hit a light which light
 * sampling would have found with density pdf_light. */
static inline float followed_weight(float pdf_bsdf, float pdf_light)
{
    float a = pdf_bsdf * pdf_bsdf, b = pdf_light * pdf_light;
    return isinf(a) ? 1.0f : a / (a + b);
}
