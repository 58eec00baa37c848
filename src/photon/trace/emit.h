/*
 * Photon emission: which light, from where, whither.
 *
 * uniform: the light's own density. guided: the numbers that choose light, place and
 * direction are drawn from what was learned (photon/trace/guide.h). specular-area: aimed
 * at a point chosen by area on the surfaces that cast caustics, for caustic photons only.
 * Several such surfaces can lie on one ray, so the density of a direction is the sum over
 * all of them,
 *
 *     p(ω) = Σ_i p_A(y_i) d_i² / |cosθ_i|,    p_A = 1 / Σ_j A_j,
 *
 * and a photon whose first hit is not such a surface carries nothing.
 */
#pragma once

#include "photon/trace/casters.h"
#include "photon/trace/guide.h"
#include "scene/scene.h"

/** @brief A photon at its light. */
typedef struct photon_start {
    ray ray;       /**< its time is given by the caller, before */
    spectrum flux; /**< its mean over emissions is the flux of all lights (uniform), or of
                      their light that first meets a caustic caster (specular-area) */
    bool light_is_given; /**< by the caller, before: light and p_light; not of what a
                            guide learned */
    int light;           /**< index in scene->lights */
    float p_light;       /**< probability with which that light was chosen */
    vec3 n;              /**< as light_emission has it */
    uint32_t primitive;
} photon_start;

/** @brief Emits one photon by its light's own density and the guide's numbers.
 *  @param guide NULL: uniform ones
 *  @return false: nothing is carried (it still counts as emitted) */
bool photon_emit(const scene *s, const wavelengths *w, const emission_guide *guide,
                 sampler *random, photon_start *out);

/** @brief Emits one caustic photon by the guide's numbers, only into the sphere around
 * what casts caustics. As above. */
bool photon_emit_caustic(const caustic_casters *c, const wavelengths *w,
                         const emission_guide *guide, sampler *random, photon_start *out);

/** @brief Density per solid angle of a caustic photon's direction, where a light that
 * stands apart (casters.is_apart) sends it from p, guide apart. */
float photon_cone_pdf(const caustic_casters *c, vec3 p);

/** @brief Emits one caustic photon toward the surfaces that cast caustics
 * (specular-area). */
bool photon_emit_aimed(const caustic_casters *c, const wavelengths *w, sampler *random,
                       photon_start *out);
