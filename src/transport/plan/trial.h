/*
 * Samples that trials compare: light that comes through a place of the film, as one
 * number.
 */
#pragma once

#include "transport/transport.h"

/** @brief How light is found: transport_kind.radiance, or a part of it. */
typedef void radiance_function(const void *pass, const ray *r, sampler *random,
                               transport_scratch *scratch, radiance_sample *out);

/** @brief A sum of squares, and the two largest of them. Zero to begin. */
typedef struct square_sum {
    double sum, loudest, second;
} square_sum;

void square_add(square_sum *to, double square);

/** @brief With the loudest no louder than the next: one path that met a lamp by a rare
 * way may be louder than all others, and tells nothing of them (a coffee maker: 2.1 with
 * it, 0.02 without, of 17 places). */
double square_total(const square_sum *of);

/** @brief A place of the film, anywhere. @return pixels from its corner */
vec2 trial_place(const transport_plan *plan, sampler *random);

/** @brief Light through a place, and what is seen there as light_guide has it: the first
 * surface that scatters. */
typedef struct trial_light {
    /** Means over wavelengths, W m⁻² sr⁻¹ nm⁻¹, 0 where they are not finite: of all but
     * lights in sight, of caustics, and of radiance_sample's scattered. At the edges of
     * lights in sight, and in mirrors and glass, noise is as bright as they are, and
     * nothing that is tried takes it away. */
    double all, caustic, scattered;
    double albedo; /**< of the surface, mean over wavelengths */
    double area;   /**< of a pixel there, facing the camera, m²; 0: nothing is seen */
    vec3 p;        /**< on the camera's ray, as far away */
} trial_light;

/** @brief Light through that place. */
trial_light trial_sample(radiance_function *radiance, const void *pass,
                         const transport_plan *plan, vec2 raster, sampler random,
                         transport_scratch *scratch);
