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

/** @brief Light through that place: the mean over wavelengths of its layers together,
 * W m⁻² sr⁻¹ nm⁻¹; 0 where it is not finite.
 *  @param without layers that are left out, bits 1 << layer */
double trial_sample(radiance_function *radiance, const void *pass,
                    const transport_plan *plan, vec2 raster, sampler random,
                    unsigned without, transport_scratch *scratch);
