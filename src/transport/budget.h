/*
 * How many photons a pass of auto is worth, from what trial photons were seen to bring.
 *
 * A caustic that gives the picture a thousandth of its light deserves as many photons as
 * any; from there on down their number falls with the root of what they give, and where
 * that is next to nothing and paths can find it, there are none at all: the pass is then
 * one of path tracing, and costs as much.
 */
#pragma once

#include "transport/transport.h"

/** @brief Before anything is known: `caustic_photons` if it is set, else at most
 * `photons` and not many more than the camera's samples; 0 without casters. */
uint64_t caustic_budget(const transport_plan *plan);

/** @brief Sets plan->n_photons of caustics, and p_blurred, by what they bring: `flux` of
 * one pass on what the camera sees, mean over wavelengths, W per nm; INFINITY where that
 * is not known. */
void caustic_budget_decide(transport_plan *plan, double flux);
