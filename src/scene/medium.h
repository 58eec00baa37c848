/*
 * What fills a solid: coloured glass, which absorbs light along its way and scatters none
 * (Beer-Lambert's law).
 *
 * A ray knows the medium it travels in. It enters and leaves one where it crosses a
 * surface whose material has an interior; all other surfaces, clear glass among them,
 * leave it where it is. Media do not nest: behind the boundary of one is either it or
 * nothing.
 */
#pragma once

/** @brief The parameters that medium_read reads. */
#define MEDIUM_PARAMETERS "attenuationcolor attenuationdistance absorption"

#include "color/curve.h"
#include "scene/hit.h"
#include "scene/params.h"

/** @brief Transmittance over t metres: color^(t / distance) exp(-absorption t). */
typedef struct medium {
    curve *color;      /**< in 0..1, owned; NULL: 1 */
    float distance;    /**< m, > 0: over which light takes on the colour */
    curve *absorption; /**< m⁻¹, owned; NULL: 0 */
} medium;

/** @brief Reads "attenuationcolor", "attenuationdistance" and "absorption". *out is NULL
 * if there is none of them, else owned by the caller. ERROR_INPUT for a colour without a
 * distance, or numbers out of range. */
bool medium_read(const params *p, medium **out, GError **error);
void medium_free(medium *m);

/** @brief Share of light left after t metres. */
spectrum medium_transmittance(const medium *m, float t, const wavelengths *w);

/** @brief The medium that a ray leaving the hit travels in; NULL: none. */
static inline const medium *hit_medium(const surface_hit *hit, vec3 direction)
{
    if (!hit->interior)
        return hit->medium;
    return dot3(direction, hit->n_geom) < 0.0f ? hit->interior : NULL;
}

/** @brief Share of light left on the way from the ray's origin to the hit. */
static inline spectrum hit_transmittance(const surface_hit *hit, const wavelengths *w)
{
    return hit->medium ? medium_transmittance(hit->medium, hit->t, w)
                       : spectrum_fill(1.0f);
}

/** @brief The same on the straight way from a hit to a point that nothing hides. */
static inline spectrum hit_transmittance_to(const surface_hit *hit, vec3 direction,
                                            float distance, const wavelengths *w)
{
    const medium *m = hit_medium(hit, direction);
    return m ? medium_transmittance(m, distance, w) : spectrum_fill(1.0f);
}
