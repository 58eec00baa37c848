/*
 * Whether indirect light is gathered from photons where the eye's path first meets a
 * surface that scatters it, in place of following the path on.
 *
 * Photons are smooth and blurred, paths sharp and noisy. Both are tried on the same
 * places of the film: pairs of paths tell the variance of one; pairs of maps with photons
 * of their own tell how much of a gather is noise; and what a wider radius changes, in
 * both maps alike, tells the bias that is left (of second order in the radius, so that
 * what r -> sqrt(2) r adds is about what r itself has). From these follows the squared
 * error of a picture of all the passes that are planned: the paths' falls as 1 / passes,
 * the photons' more slowly, since radii shrink (Knaus & Zwicker 2011). So a quick picture
 * is the photons' and one that is given its time the paths', and either goes to the
 * truth.
 */
#pragma once

#include "transport/path/path.h"

/** @brief Compares; where gathering has less error for its rays, the plan becomes one of
 * photons of both classes: plan->gathers.
 *  @param paths a pass as the plan has it now, its caustic photons if there are any
 *  @return false when cancelled or out of memory */
bool gather_decide(transport_plan *plan, const path_pass *paths,
                   const cancel_flag *cancel, GError **error);
