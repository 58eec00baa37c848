/*
 * Media: what light meets on its way between surfaces.
 *
 * Two kinds of things are filled with one. A solid of coloured glass absorbs light and
 * scatters none (Beer-Lambert's law); a ray knows those it travels in (medium_stack.h).
 * It enters and leaves one where it crosses a surface whose material bounds a solid; all
 * other surfaces leave it where it is. Participating media, as fog or milk, scatter too,
 * and fill what surfaces with a medium_interface (hit.h) bound.
 *
 *   σa absorption, σs scattering, σt = σa + σs extinction, m⁻¹ (Jensen 2001, chapter 10)
 */
#pragma once

/** @brief The parameters that medium_read reads. */
#define MEDIUM_PARAMETERS "attenuationcolor attenuationdistance absorption"

#include "color/curve.h"
#include "math/lanes.h"
#include "medium/hit.h"
#include "params/params.h"

#include <float.h>

/** @brief Transmittance over t metres: color^(t / distance) exp(-σt t). */
typedef struct medium {
    char *name;        /**< of a participating one, owned */
    int index;         /**< of a participating one, in scene->media */
    curve *color;      /**< in 0..1, owned; NULL: 1 */
    float distance;    /**< m, > 0: over which light takes on the colour */
    curve *absorption; /**< σa over scale, owned; NULL: 0 */
    curve *scattering; /**< σs over scale, owned; NULL: 0 */
    float scale;
    float g; /**< mean cosine of the angle by which light is scattered, -1 < g < 1 */
} medium;

/** @brief Reads what fills a solid: "attenuationcolor", "attenuationdistance" and
 * "absorption". *out is NULL if there is none of them, else owned by the caller.
 * ERROR_INPUT for a colour without a distance, or numbers out of range. */
bool medium_read(const params *p, medium **out, GError **error);
/** @brief A participating medium of pbrt's kinds: "homogeneous". NULL with ERROR_INPUT.
 */
medium *medium_new(const char *name, const char *kind, const params *p, GError **error);
/** @brief Name of kind number i; NULL behind the last. */
const char *medium_kind_name(size_t i);
/** @brief What it may be given, blank-separated; NULL as above. */
const char *medium_kind_parameters(size_t i);
void medium_free(medium *m);

/** @brief Its number in a medium_stack, and the home of photons in it; of none 0. */
static inline uint32_t medium_home(const medium *m)
{
    return m ? (uint32_t)m->index + 1 : 0;
}

/** @brief σs by wavelength. */
spectrum medium_scattering(const medium *m, const wavelengths *w);
/** @brief σt by wavelength. */
spectrum medium_extinction(const medium *m, const wavelengths *w);

/** @brief e^(-σt t). Over an endless segment what is extinguished at all is gone: t is
 * taken as FLT_MAX, of which none is 0. */
static inline spectrum transmittance_after(spectrum sigma_t, float t)
{
    return spectrum_exp(sigma_t * -minf(t, FLT_MAX));
}

/** @brief Henyey and Greenstein's phase function ("Diffuse radiation in the Galaxy",
 * 1941), sr⁻¹. @param cosine between the ways back and on, both away from the point: -1
 * where light goes straight on */
static inline float phase_henyey_greenstein(float g, float cosine)
{
    float d = 1.0f + g * g + 2.0f * g * cosine;
    return (1.0f - g * g) / (4.0f * (float)G_PI * d * sqrtf(d));
}

/** @brief The same of a lane each. */
static inline lane_floats phase_henyey_greenstein_lanes(float g, lane_floats cosine)
{
    lane_floats d = 1.0f + g * g + 2.0f * g * cosine;
    return (1.0f - g * g) / (4.0f * (float)G_PI * d * sqrt_lanes(d));
}

/** @brief Transmittance of t metres; INFINITY is allowed. One where m is NULL. */
spectrum medium_transmittance(const medium *m, float t, const wavelengths *w);

/** @brief True if it scatters. */
static inline bool medium_scatters(const medium *m)
{
    return m->scattering != NULL;
}
