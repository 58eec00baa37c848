/*
 * When a render is done: after so many passes, so many seconds, or when its error is
 * small. Asked between passes only, so that what a pass is never depends on when the
 * render stops.
 */
#pragma once

#include "render/render.h"

/** @brief What the rules look at. */
typedef struct stop_state {
    double passes;    /**< done; with a fraction while one is under way */
    double elapsed;   /**< s */
    double last_pass; /**< s that the last pass took */
    double noise;     /**< film_noise, INFINITY if unknown */
    double after;     /**< s of the time asked for that are kept for what comes later */
    double last_photons; /**< s of it, before the camera looked */
} stop_state;

/** Denoising that a picture counted on may end so much later than asked for, s; and once
 * its passes are rendered, so much later than other work. */
#define LATE_DENOISING 0.3

/** @brief Why to stop now, or RENDER_GOES_ON. One pass is always rendered. */
render_stop stop_decide(const settings *how, const stop_state *now);

/** @brief Where a pass is that is rendered cell by cell (film_cell). */
typedef struct stop_part {
    int done, wanted; /**< cells */
    int least;        /**< that are rendered whatever the time */
    double cell;      /**< s that one will take, 0: unknown */
    bool is_first;    /**< pass: the whole picture is to be seen soon */
} stop_part;

/** @brief How many cells come next. 0: all wanted are done, or the time is over. */
int stop_next_cells(const settings *how, const stop_state *now, const stop_part *part);
/** @brief Whether the time is over, so that a pass under way is to be given up. */
bool stop_at_once(const settings *how, const stop_state *now);
/** @brief How much later than asked for work under way may end, s. */
double stop_grace(double time);
/** @brief How much is done, 0..1, by the rule that will stop first. */
double stop_fraction(const settings *how, const stop_state *now);
