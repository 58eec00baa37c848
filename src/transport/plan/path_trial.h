/*
 * Trials with paths: how noisy is what they find, how many rays it takes, and what
 * looking aside at bright spots is worth to them.
 */
#pragma once

#include "transport/path/path.h"
#include "transport/path/spot_trial.h"

/** @brief Light that paths find, per camera sample. */
typedef struct path_effort {
    double noise;    /**< variance of a sample, caustics apart, relative as sketch_weight
                        has it */
    double rays;     /**< traced, shadow rays too */
    double surfaces; /**< met */
} path_effort;

/** @brief Measures with a few paths, the same on any number of threads.
 * Where bright spots are asked for, plan->lit gets the places that are lit and light
 * others; plan->sketch is made. @return false with ERROR_CANCELLED if it was cancelled */
bool path_effort_measure(transport_plan *plan, const cancel_flag *cancel,
                         path_effort *out, GError **error);

/** @brief Whether a trial of looks fits into the work; if not, nobody looks. */
bool spots_fit(const transport_plan *plan);

/** @brief Measures how often surfaces should look at the spots of a pass: sets
 * plan->p_spots; the same on any number of threads.
 * @return false with ERROR_CANCELLED if it was cancelled */
bool spots_decide(transport_plan *plan, const path_pass *pass, const cancel_flag *cancel,
                  GError **error);
