/*
 * Trials with paths: how noisy is what they find, how many rays it takes, and what
 * looking aside at bright spots is worth to them.
 */
#pragma once

#include "transport/path/path.h"

/** @brief Light that paths find, per camera sample. */
typedef struct path_effort {
    double noise; /**< variance of a sample, caustics apart: (W m⁻² sr⁻¹ nm⁻¹)² */
    double rays;     /**< traced, shadow rays too */
    double surfaces; /**< met */
} path_effort;

/** @brief Measures with a few paths. Deterministic.
 *  @param lit gets the places that are lit and light others, as far as room has been
 *  reserved; NULL: not asked for */
path_effort path_effort_measure(transport_plan *plan, photon_store *lit);

enum { SPOT_SHARES = 4 };

/** @brief What looks at bright spots were seen to bring, while each surface looked. */
typedef struct spot_trial {
    double rays;    /**< that looks cost, by their importance */
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

/** @brief Whether a trial of looks fits into the work; if not, nobody looks. */
bool spots_fit(const transport_plan *plan);

/** @brief Measures how often surfaces should look at the spots of a pass: sets
 * plan->p_spots. Deterministic. */
void spots_decide(transport_plan *plan, const path_pass *pass);
