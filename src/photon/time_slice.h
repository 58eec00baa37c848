/*
 * Slices of the shutter's time: where something moves, photons are kept apart by when
 * they landed, so that what is seen at one time is lit by those of about that time.
 */
#pragma once

#include "scene/scene.h"

/** @brief How many there are: where nothing moves, one. With one for all /motion/board
 * and /knob-pictures/time-slices fail. With one of eight for all that a pass does, eye's
 * rays too, /motion/final-gather fails, for four passes see half of the time; and what
 * moves has holes till eight are done: a dull ball that rolls by its width has 3.0 and
 * 1.7 times the squared error after one and two passes of auto (.97 from eight on; a
 * glass one 1.04, 1.14, .97), 1.1 and .98 of sppm (.85 from eight on; glass .96, .91,
 * .85), 160 x 120, three seeds. */
static inline int time_slices_of(const scene *s, const settings *how)
{
    return s->moves ? (int)how->time_slices : 1;
}

/** @brief The slice that a time is in. */
static inline int time_slice(float time, int n_slices)
{
    int slice = (int)(time * (float)n_slices);
    return slice < n_slices ? slice : n_slices - 1;
}

/** @brief The middle of a slice: when what moves is where its photons are kept. */
static inline float time_of_slice(int slice, int n_slices)
{
    return ((float)slice + 0.5f) / (float)n_slices;
}
