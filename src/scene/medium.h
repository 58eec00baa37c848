/*
 * What fills a solid: coloured glass, which absorbs light along its way and scatters none
 * (Beer-Lambert's law).
 *
 * A ray knows the solids it travels in (media.h). It enters and leaves one where it
 * crosses a surface whose material bounds a solid; all other surfaces leave it where it
 * is.
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

/** @brief Share of light left after t metres in these solids. */
static inline spectrum media_transmittance(const media *in, float t, const wavelengths *w)
{
    const interior *first = in->of[0];
    return first && first->medium ? medium_transmittance(first->medium, t, w)
                                  : spectrum_fill(1.0f);
}

/** @brief Share of light left on the way from the ray's origin to the hit. */
static inline spectrum hit_transmittance(const surface_hit *hit, const wavelengths *w)
{
    return media_transmittance(&hit->media, hit->t, w);
}

/** @brief The same on the straight way from a hit to a point that nothing hides. */
static inline spectrum hit_transmittance_to(const surface_hit *hit, vec3 direction,
                                            float distance, const wavelengths *w)
{
    const media in = hit_media(hit, direction);
    return media_transmittance(&in, distance, w);
}
