/*
 * How far a render is: a bar with the time left on a terminal, else a line every tenth or
 * every ten seconds. All on stderr.
 */
#pragma once

#include <nephroid/nephroid.h>

typedef struct progress {
    bool quiet;       /**< says nothing */
    bool on_terminal; /**< stderr is one */
    int64_t start;    /**< monotonic µs */
    int64_t shown_at; /**< monotonic µs of the last word, 0: none yet */
    int shown_tenths; /**< of the last line */
} progress;

progress progress_begin(bool quiet);
/** @brief A NephProgressFunc; data: progress. Never stops the render. */
bool progress_show(double fraction, const NephStatistics *statistics, void *data);
/** @brief Removes the bar: other things are told now. */
void progress_end(progress *p);
/** @brief All is done and written; on a terminal that is told by what was written. */
void progress_done(const progress *p, int64_t passes);
