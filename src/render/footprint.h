/*
 * What a render will take, told before it: what the process has already, the film, and
 * the largest of what comes one after another:
 *
 *   photons of a pass ─► camera paths │ taking the noise out │ the image, and its writing
 *
 * Photons are not guessed: the plan is made as the render would make it, and a pass of a
 * few of them is begun, which says what one takes while maps are built and after.
 */
#pragma once

#include "transport/transport.h"

/** @brief Most bytes that a process will have had which renders the view by these
 * settings now, as getrusage's ru_maxrss counts. Where no plan can be made, photons count
 * for nothing: nor will it render. Not for two threads at once. */
size_t footprint_of(const view *v, const settings *how);

/** @brief Bytes that are taken and not in use: each thread's slab that it fills lies on
 * two huge pages, and the next arrays will lie on one more. */
size_t footprint_begun(const settings *how);

/** @brief Whether a process that has so many bytes leaves room for anything more.
 * ERROR_FAILED saying how much it is and what the limit is. */
bool footprint_check(size_t beside, GError **error);

/** @brief Makes the photons of a plan that is prepared fit into the memory limit: where
 * they do not, plans again by settings that ask for fewer (plan->how). That they fit is
 * measured where it is not beyond doubt.
 * @param beside bytes that the process has when all but photons is there
 * @param may_choose false: it is this plan or none
 * @return false with ERROR_FAILED: the fewest do not fit; or planning failed */
bool footprint_fit(transport_plan *plan, size_t beside, bool may_choose,
                   const cancel_flag *cancel, GError **error);
