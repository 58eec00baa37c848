/*
 * What caustic photons are sent to: the surfaces of a committed scene that cast caustics,
 * and the lights by the power that may meet them.
 *
 *   scene ─► casters (by area) ─► sphere around them ─► power of each light that may meet
 *                                                      it, lights that stand apart from
 * it
 *
 * Made once for all who send photons through a scene, and const: every query is
 * thread-safe. Instances count by their area at the opening of the shutter.
 */
#pragma once

#include "scene/scene.h"

/** @brief A surface that casts caustics. */
typedef struct caustic_caster {
    int shape;
    int instance; /**< or NO_INDEX */
} caustic_caster;

typedef struct caustic_casters {
    const scene *scene;
    bool metals; /**< all conductors are among them, however rough */
    caustic_caster *all;
    int n;
    distribution area;  /**< over all, by area */
    vec3 center;        /**< of a sphere around them, on all of their way */
    float radius;       /**< of that sphere; 0 if there are none */
    distribution power; /**< over lights, by the power that may meet that sphere: which
                           one a caustic photon starts from */
    bool *is_apart; /**< of each light: it stands outside the sphere, which from there is
                       a cone */
} caustic_casters;

/** @brief Finds them in a committed scene, which must outlive them.
 * @return owned; NULL with ERROR_FAILED: memory */
caustic_casters *caustic_casters_new(const scene *s, GError **error);
/** @brief The same, and all conductors, however rough. */
caustic_casters *caustic_casters_new_with_metals(const scene *s, GError **error);
void caustic_casters_free(caustic_casters *c);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(caustic_casters, caustic_casters_free)

/** @brief True if light may meet one. */
static inline bool caustic_casters_are_lit(const caustic_casters *c)
{
    return c->n > 0 && distribution_total(&c->power) > 0.0;
}

/** @brief True if the surface at the hit is one. */
bool caustic_casters_include(const caustic_casters *c, const surface_hit *hit);
/** @brief A point on them, uniform by area but for instances that are stretched. */
vec3 caustic_casters_sample(const caustic_casters *c, float u_shape, vec2 u, float time);
/** @brief Its density, m⁻², at a hit on one of them. */
double caustic_casters_density(const caustic_casters *c, const surface_hit *hit);
