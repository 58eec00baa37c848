/*
 * What looks at bright spots bring, noted by the paths of a trial.
 */
#pragma once

#include "transport/transport.h"

/** @brief What looks at bright spots were seen to bring, while each surface looked. */
typedef struct spot_trial {
    double weight;         /**< of squares at the place of the film that is tried */
    double rays;           /**< that looks cost, by their importance, and all that is
                                weighed beside them */
    double without;        /**< sum of squares of what paths bring without looking ... */
    double with[N_SHARES]; /**< ... and where each surface looks, or one in two */
} spot_trial;

/** @brief What one look found. */
typedef struct spot_look {
    double importance;       /**< how likely it is where the probability is 1 */
    double pdf, pdf_scatter; /**< of looking there and of scattering there */
    double value; /**< that it brings, were there no other way, mean over wavelengths */
} spot_look;

/** @brief Adds what a look found. */
void spot_trial_note(spot_trial *trial, const spot_look *look);

/** @brief Adds what another trial found. */
void spot_trial_add(spot_trial *trial, const spot_trial *other);
