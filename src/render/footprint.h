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

#include "scene/view.h"

/** @brief Most bytes that a process will have had which renders the view by these
 * settings now, as getrusage's ru_maxrss counts. Where no plan can be made, photons count
 * for nothing: nor will it render. Not for two threads at once. */
size_t footprint_of(const view *v, const settings *how);
