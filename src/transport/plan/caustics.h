/*
 * How many photons a pass of auto is worth, from what trial photons were seen to bring.
 *
 * Photons are there to take away the noise that paths from the eye would have if they had
 * to find caustics by themselves. That noise is known from trial photons, since each
 * knows how likely a path was to find what it brings; so is what fewer photons would
 * leave of it, and how much of that would be alike in neighbouring pixels. The noise of
 * all other light, and how many rays it takes, is measured with paths. Of several numbers
 * of photons, and none, the one is taken with which variance times work is least, but
 * none where blotches outweigh the gain in the picture that is shown. Without photons a
 * pass is one of path tracing, and costs as much.
 */
#pragma once

#include "transport/photonmap/aim.h"
#include "transport/plan/path_trial.h"

/** @brief Before anything is known: `caustic_photons` if it is set, else at most
 * `photons` and not many more than the camera's samples; 0 without casters. */
uint64_t caustics_most(const transport_plan *plan);

/** @brief Sets plan->n_photons of caustics, and p_blurred. */
void caustics_decide(transport_plan *plan, const aim_result *found,
                     const path_effort *paths);

/** @brief The same where no trial fits into the work: photons of lights that no path
 * finds alone. */
void caustics_settle(transport_plan *plan);
