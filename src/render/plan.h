/*
 * What a render decides before its first pass, in numbers: a plain value to print and to
 * compare. It is one for the render, the viewer and `photons`.
 */
#pragma once

#include "transport/transport.h"

typedef struct render_plan {
    integrator_choice integrator;
    uint64_t photons[N_PHOTON_CLASSES]; /**< sent each pass */
    double radius[N_PHOTON_CLASSES];    /**< m, in pass 0: everywhere, or the median */
    bool radius_is_set;                 /**< by the settings; else measured */
    bool guided[N_PHOTON_CLASSES];      /**< they start where trials arrived from */
    double discs; /**< m²: caustics are shared by photons' discs π r² N over the samples
                     that see them (caustic_mis); 0: photons or paths have them all */
    double p_spots;   /**< of looking at bright spots from a surface */
    double p_blurred; /**< of a gather of caustics that is seen by way of a diffuse bounce
                       */
    int time_slices;
    double work;     /**< asked for, in rays: a first guess */
    double planning; /**< rays that trials cost */
    plan_trial trials[MOST_PLAN_TRIALS];
    int n_trials;
} render_plan;

/** @brief That of the first pass: with fewer samples by first_spp, and photons likewise.
 * It borrows from the plan. */
transport_plan render_first_plan(const transport_plan *plan);
/** @brief Of a plan that is prepared. */
render_plan render_plan_of(const transport_plan *plan);
/** @brief Its numbers in a line, the same of equal plans only; owned by the caller. */
char *render_plan_digest(const render_plan *plan);
