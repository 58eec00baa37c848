/*
 * How many photons a pass of auto is worth, from what trial photons were seen to bring.
 *
 * Photons are there to take away the noise that paths from the eye would have if they had
 * to find caustics by themselves. That noise is known from trial photons, since each
 * knows how likely a path was to find what it brings; so is what fewer photons would
 * leave of it. The noise of all other light, and how many rays it takes, is measured with
 * paths. Of several numbers of photons, and none, the one is taken with which variance
 * times work is least. Without photons a pass is one of path tracing, and costs as much.
 */
#pragma once

#include "transport/auto/aim.h"
#include "transport/path/path.h"

/** @brief Light that paths find, per camera sample. */
typedef struct path_effort {
    double noise; /**< variance of a sample, caustics apart: (W m⁻² sr⁻¹ nm⁻¹)² */
    double rays;     /**< traced, shadow rays too */
    double surfaces; /**< met */
} path_effort;

/** @brief Camera samples of all passes that are planned. */
double caustic_planned_samples(const transport_plan *plan);

/** @brief Before anything is known: `caustic_photons` if it is set, else at most
 * `photons` and not many more than the camera's samples; 0 without casters. */
uint64_t caustic_budget(const transport_plan *plan);

/** @brief Measures with a few paths. Deterministic.
 *  @param lit gets the places that are lit and light others, as far as room has been
 *  reserved; NULL: not asked for */
path_effort path_effort_measure(const transport_plan *plan, photon_store *lit);

/** @brief The noise by caustics, as aim_result has it, below which no number of photons
 * pays; 0 where photons are wanted whatever they bring. */
double caustic_least_noise(const transport_plan *plan, const path_effort *paths);

/** @brief Sets plan->n_photons of caustics, and p_blurred. */
void caustic_budget_decide(transport_plan *plan, const aim_result *found,
                           const path_effort *paths);

enum { SPOT_SHARES = 4 };

/** @brief What looks at bright spots were seen to bring, while each surface looked. */
typedef struct spot_trial {
    double looks;   /**< by their importance */
    double without; /**< sum of squares of what paths bring without looking ... */
    double with[SPOT_SHARES]; /**< ... and where one surface in 1, 2, 4, ... looks */
} spot_trial;

/** @brief What one look found. */
typedef struct spot_look {
    double importance;       /**< how likely it is where the probability is 1 */
    double pdf, pdf_scatter; /**< of looking there and of scattering there */
    double value; /**< that it brings, were there no other way, mean over wavelengths */
} spot_look;

void spot_trial_note(spot_trial *trial, const spot_look *look);

/** @brief Measures with a few paths how often surfaces should look at the pass' spots.
 *  Deterministic.
 *  @param index of the pass
 *  @return 0..1 */
float spots_decide(const path_pass *pass, uint32_t index);
