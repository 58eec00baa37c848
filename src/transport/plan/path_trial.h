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
                        has it; 0 until it is weighed ... */
    double bounced;  /**< ... and what caustics add that are seen by way of a bounce */
    double rays;     /**< traced, shadow rays too */
    double surfaces; /**< met */
    struct sample_pair *pairs; /**< owned, n of them */
    uint32_t n;
} path_effort;
void path_effort_clear(path_effort *effort);
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(path_effort, path_effort_clear)

/** @brief Measures with a few paths, the same on any number of threads.
 * Where bright spots are asked for, plan->lit gets the places that are lit and light
 * others; plan->sketch is made, without caustics in sight. @param out is empty
 * @return false with ERROR_CANCELLED if it was cancelled */
bool path_effort_measure(transport_plan *plan, const cancel_flag *cancel,
                         path_effort *out, GError **error);

/** @brief Sets effort->noise and bounced, when plan->sketch has all light.
 * @return false when out of memory */
bool path_effort_weigh(const transport_plan *plan, path_effort *effort, GError **error);

/** @brief Sets plan->path_noise by paths of a pass that has photons of caustics: they
 * meet them after a bounce, too. @return false with ERROR_CANCELLED if it was cancelled
 */
bool path_noise_measure(transport_plan *plan, const path_pass *pass,
                        const cancel_flag *cancel, GError **error);

/** @brief Whether a trial of looks fits into the work; if not, nobody looks. */
bool spots_fit(const transport_plan *plan);

/** @brief Sets plan->p_spots to the share of surfaces that had best look, by so many
 * pairs of paths that all looked. @param noise of a sample of theirs, relative */
void spots_choose_share(transport_plan *plan, const spot_trial *trial, double noise,
                        uint32_t n_pairs);

/** @brief Measures how often surfaces should look at the spots of a pass: sets
 * plan->p_spots; the same on any number of threads.
 * @return false with ERROR_CANCELLED if it was cancelled */
bool spots_decide(transport_plan *plan, const path_pass *pass, const cancel_flag *cancel,
                  GError **error);
