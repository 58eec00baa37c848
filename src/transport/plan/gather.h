/*
 * Whether indirect light is gathered from photons where the eye's path first meets a
 * surface that scatters it, in place of following the path on.
 *
 * Photons are smooth and blurred, paths sharp and noisy. Both are tried on the same
 * places of the film. Pairs of paths tell the variance of one. Pairs of maps, of few
 * photons each, tell how much of a gather is noise and, by what discs of twice the radius
 * change in both alike, how much is blur. Discs that hold as many of the few photons as
 * the plan's hold of all would reach from wall to wall, those of the plan would be empty:
 * so these have the mean of both, in powers of the radius, and what they find is brought
 * to the plan's by area. By that noise falls; and blur's square rises, for it goes with
 * the radius at an edge, with its square at the rim of a medium, with its fourth power
 * where light is smooth.
 *
 * From these follows the squared error of a picture of all the passes that are planned:
 * the paths' falls as 1 / passes, the photons' more slowly, since radii shrink (Knaus &
 * Zwicker 2011). So a quick picture is the photons' and one that is given its time the
 * paths', and either goes to the truth. Where noise is taken out it is paths' own grain
 * that goes: all other error, also what both have of lamps' light, weighs more. Where not
 * even half a pass by maps fits, out of which noise could be taken, they must be clearly
 * better.
 */
#pragma once

#include "transport/path/path.h"

/** @brief Compares; where gathering has less error for its rays, the plan becomes one of
 * photons of both classes: plan->gathers.
 *  @param paths a pass as the plan has it now, its caustic photons if there are any
 *  @return false when cancelled or out of memory */
bool gather_decide(transport_plan *plan, const path_pass *paths,
                   const cancel_flag *cancel, GError **error);
