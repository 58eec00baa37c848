/*
 * When a job that is given a time ends: what its last passes, joining their sums, taking
 * the noise out and writing will take is left of it. The root's.
 */
#pragma once

#include <nephroid/nephroid.h>

typedef struct job_clock {
    double start; /**< monotonic s, less what another job spent */
    double time;  /**< s asked for; 0: no end */
    double pass;  /**< s that one of a rank takes; 0: unknown */
    double join;  /**< s, with waiting for who comes last */
} job_clock;

/** @brief Monotonic s. */
double clock_now(void);
/** @brief A rank's pass took so long; the longest ones of late count. */
void clock_note_pass(job_clock *c, double seconds);
/** @brief s left for passes. */
double clock_left(const job_clock *c, const NephRender *render);
/** @brief Whether there is no time for another pass of a rank that has so many to render
 * before it. */
bool clock_is_over(const job_clock *c, const NephRender *render, int n_before);
/** @brief Whether a pass that is under way now is to be given up. */
bool clock_is_up(const job_clock *c, const NephRender *render);
/** @brief Whether not even one pass is sure to be whole in time: then a process alone has
 * more of a picture, since it shows parts of a pass. */
bool clock_is_short(const job_clock *c, const NephRender *render);
