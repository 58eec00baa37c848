/*
 * How many photons a pass of auto is worth, from what trial photons were seen to bring.
 *
 * Photons are there to take away the noise that paths from the eye would have if they had
 * to find caustics by themselves. That noise is known from trial photons, since each
 * knows how likely a path was to find what it brings; the noise of all other light is
 * measured with paths. If the former is as large as the latter, a pass has all photons;
 * below, their number falls as its root; where it is next to nothing there are none: the
 * pass is then one of path tracing, and costs as much.
 */
#pragma once

#include "transport/transport.h"

/** @brief Before anything is known: `caustic_photons` if it is set, else at most
 * `photons` and not many more than the camera's samples; 0 without casters. */
uint64_t caustic_budget(const transport_plan *plan);

/** @brief Sets plan->n_photons of caustics, and p_blurred, by the noise of a camera
 * sample without photons, squared (aim_result.noise); INFINITY where that is not known.
 */
void caustic_budget_decide(transport_plan *plan, double noise);
