/*
 * Direct light by sampling the lights (next-event estimation), and the weights with which
 * it shares its work with rays that hit lights by themselves (Veach 1997, §9.2: power
 * heuristic).
 */
#pragma once

#include "math/sampler.h"
#include "medium/medium_sample.h"
#include "photon/trace/caustic_mis.h"
#include "scene/advance.h"

/** @brief What to evaluate at a surface, and how its lobes find light otherwise. */
typedef struct direct_query {
    const scene *scene;
    const wavelengths *w;
    const surface_hit *hit;
    const bsdf *bsdf;
    vec3 wo;
    bool every_light; /**< sample each light, where they are few, instead of one: where
                         grain shows */
    bool shadow_rays; /**< false: light passes through everything */
    const bsdf_options *options; /**< for panes that light comes through */
    int64_t most_panes;          /**< so many at most; negative: any number */
    unsigned followed; /**< the mask that the path goes on with: those classes share the
                          work with light sampling, for the others it is the only way */
    unsigned looked;   /**< likewise, classes that direct_environments is asked with */
    bool by_side;      /**< the path takes each side apart ... */
    float p_side[2];   /**< ... with this probability: reflection, transmission */
    /** What glossy lobes send photons bring too, by this MIS weight; NULL: never. */
    const caustic_mis *mis;
    const bsdf *all_wavelengths; /**< for that weight: the bsdf, whatever wavelength the
                                    path keeps */
} direct_query;

/** @brief Up to so many lights are few: each more costs a shadow ray at all that is seen.
 * With one, so never, relMSE x time is 1.2 to 1.3 times as much in scenes/ring, which has
 * a lamp and a sky, and 0.93 in a hall with four lamps; with any number it is 1.2 times
 * as much in that hall with eight (128 x 128, 8 passes, three seeds). */
enum { FEW_LIGHTS = 4 };

/** @brief Radiance sent to wo from one light, by the class of lobe that sends it. */
typedef struct direct_radiance {
    spectrum diffuse, glossy;
    int light; /**< that it came from */
} direct_radiance;

/** @brief Light that comes straight from lights, by a sample of one or of each.
 *  @param shadow_rays_traced is increased
 *  @return how many lights gave something; found holds that many */
int direct_light(const direct_query *query, sampler *random,
                 direct_radiance found[FEW_LIGHTS], uint64_t *shadow_rays_traced);

/** @brief A place on a light that may light a ray through a medium: one to draw points
 * near (medium_sample.h). @param length m: how far the medium reaches
 *  @return false: there is none, or it is beyond the scene */
bool direct_pivot(const scene *s, const wavelengths *w, const ray *r, float length,
                  sampler *random, medium_pivot *out);

/** @brief A light that a path from the eye ran into. */
typedef struct met_light {
    int light;
    spectrum radiance;      /**< that it sends back along the path */
    const surface_hit *hit; /**< on it; NULL: it is an environment */
} met_light;

/** @brief Tells of each light that a ray ran into: the one on the surface at its end, or
 * all environments. @param hit NULL: the ray left the scene */
void direct_meet(const scene *s, const wavelengths *w, const ray *r,
                 const surface_hit *hit, void (*tell)(void *path, const met_light *met),
                 void *path);

/** @brief Environments' light again, along a direction drawn from the lobes looked, which
 * finds what is wide where sampling lights finds what is bright; each is told of with its
 * whole weight, as a share of what the lobes send to wo. Nothing is drawn in a scene
 * without environments.
 *  @param shadow_rays_traced is increased */
void direct_environments(const direct_query *query, sampler *random,
                         void (*tell)(void *path, const met_light *met), void *path,
                         uint64_t *shadow_rays_traced);

/** @brief Where a path scattered last. */
typedef struct scattered_from {
    vec3 p;
    float pdf; /**< solid angle, of the direction that was drawn; 0: specular, or the eye,
                  where lights are not sampled */
    bool every_light; /**< as direct_query had it there */
} scattered_from;

/** @brief Weight of a light that a path ran into, beside sampling it from where the path
 * scattered last. */
float direct_met_weight(const scene *s, const settings *how, const scattered_from *from,
                        vec3 direction, const met_light *met);

/** @brief Weight of a followed direction of density pdf_bsdf that hit a light which light
 * sampling would have found with density pdf_light. */
static inline float followed_weight(float pdf_bsdf, float pdf_light)
{
    float a = pdf_bsdf * pdf_bsdf, b = pdf_light * pdf_light;
    return isinf(a) ? 1.0f : a / (a + b);
}
