/*
 * Learning where to emit: rounds of trial photons, before the first pass, teach the guide
 * which starts lead to caustics that the camera sees.
 */
#pragma once

#include "photon/trace/guide.h"
#include "transport/transport.h"

enum { AIM_SHARES = 5 };

/** @brief Of all photons of a pass: 1, 1/2, 1/4, ... */
static inline double aim_share(int i)
{
    return 1.0 / (double)(1 << i);
}

/** @brief What the last trials brought. */
typedef struct aim_result {
    double noise;  /**< square of the noise that a camera sample had if it had to find by
                      itself what photons bring: (W m⁻² sr⁻¹ nm⁻¹)² */
    double unseen; /**< share of what photons bring that lands out of the camera's sight:
                      it is in the picture by way of other surfaces only, and not in
                      noise */
    double left[AIM_SHARES]; /**< what is left of it where so many photons help */
    float *boost; /**< by light: how much denser than by the light's own emission useful
                     photons are sent; the caller frees it with g_free */
} aim_result;

/** @brief How much trials may cost. */
typedef struct aim_effort {
    double samples;     /**< the camera's in all passes: trials are few beside them */
    double least_noise; /**< what is below needs no guide, and trials end early */
} aim_effort;

/** @brief Makes plan->guide for the caustic photons, where the settings ask for it. false
 * when cancelled or out of memory. Deterministic: it depends on scene and settings only.
 * @param effort NULL: as much as it takes
 * @param result NULL: not asked for; unchanged where nothing is learned
 */
bool aim_caustics(transport_plan *plan, const aim_effort *effort, aim_result *result,
                  const cancel_flag *cancel, GError **error);
