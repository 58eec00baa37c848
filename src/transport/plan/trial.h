/*
 * Samples that trials compare: light that comes through a place of the film, as one
 * number.
 */
#pragma once

#include "transport/transport.h"

/** @brief How light is found: transport_kind.radiance, or a part of it. */
typedef void radiance_function(const void *pass, const ray *r, sampler *random,
                               transport_scratch *scratch, radiance_sample *out);

/** @brief A place of the film, anywhere. @return pixels from its corner */
vec2 trial_place(const transport_plan *plan, sampler *random);

/** @brief Light through a place, and what is seen there as light_guide has it: the first
 * surface that scatters. */
typedef struct trial_light {
    /** Means over wavelengths, W m⁻² sr⁻¹ nm⁻¹, 0 where they are not finite: of all
     * layers together, and of that of caustics. */
    double all, caustic;
    double albedo; /**< of the surface, mean over wavelengths */
    double area;   /**< of a pixel there, facing the camera, m²; 0: nothing is seen */
    vec3 p;        /**< on the camera's ray, as far away */
} trial_light;

/** @brief Light through that place. */
trial_light trial_sample(radiance_function *radiance, const void *pass,
                         const transport_plan *plan, vec2 raster, sampler random,
                         transport_scratch *scratch);
