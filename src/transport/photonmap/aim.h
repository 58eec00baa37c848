/*
 * Learning where to emit: rounds of trial photons, before the first pass, teach a guide
 * which starts lead where the photons of a class are wanted: caustics in sight of the
 * camera, other light on any surface of the scene, for the next bounce brings it in
 * sight.
 */
#pragma once

#include "photon/trace/guide.h"
#include "transport/transport.h"

/** @brief What the last trials brought. */
typedef struct aim_result {
    double
        noise;     /**< variance that a camera sample had if it had to find by itself what
                      photons bring, relative as sketch_weight has it; 0 without a sketch */
    double unseen; /**< share of what photons bring that lands out of the camera's sight:
                      it is in the picture by way of other surfaces only, and not in
                      noise */
    double alone;  /**< flux of them that no path finds, W nm⁻¹ */
    double left[N_SHARES];  /**< what paths keep of it where so many photons help */
    double alike[N_SHARES]; /**< and what those bring, alike in neighbouring pixels */
    double rays;            /**< of a photon */
    float *boost; /**< by light: how much denser than by the light's own emission useful
                     photons are sent; the caller frees it with g_free */
} aim_result;

/** @brief Sends trial photons of the class, which tell plan->brought and plan->price.
 * Where the settings ask for it, makes plan->guide if photons with it are clearly less
 * noisy for their rays than those without; of caustics, if they are less noisy at all.
 * false when cancelled or out of memory. Deterministic: it depends on scene and settings
 * only. */
bool aim_photons(transport_plan *plan, photon_class c, const cancel_flag *cancel,
                 GError **error);

/** @brief The same of caustics, also where no guide is asked for, and what paths have of
 * them. @param result unchanged where no photons are sent */
bool aim_caustics(transport_plan *plan, aim_result *result, const cancel_flag *cancel,
                  GError **error);
