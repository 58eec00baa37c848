/*
 * Learning where to emit: rounds of trial photons, before the first pass, teach the guide
 * which starts lead to caustics that the camera sees.
 */
#pragma once

#include "photon/guide.h"
#include "transport/transport.h"

/** @brief What the last trials brought. */
typedef struct aim_result {
    double noise; /**< square of the noise that a camera sample had if it had to find by
                     itself what photons bring: (W m⁻² sr⁻¹ nm⁻¹)² */
    float *boost; /**< by light: how much denser than by the light's own emission useful
                     photons are sent; the caller frees it with g_free */
} aim_result;

/** @brief Makes plan->guide for the caustic photons, where the settings ask for it. false
 * when cancelled or out of memory. Deterministic: it depends on scene and settings only.
 * @param result NULL: not asked for; unchanged where nothing is learned
 */
bool aim_caustics(transport_plan *plan, aim_result *result, const cancel_flag *cancel,
                  GError **error);
