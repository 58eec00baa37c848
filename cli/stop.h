/*
 * Ctrl-C, SIGTERM and a terminal that hangs up. While a render is watched the first one
 * asks it to stop, so that what there is can be written; else, and the second time, the
 * program ends as ever, but leaves no temporary file. What was ignored when the program
 * began (nohup) stays ignored.
 */
#pragma once

#include <nephroid/nephroid.h>

/** @brief From here on; once, first of all. */
void stop_init(void);
/** @brief From here on the first signal stops the render, and a reader of our output that
 * goes away does not end us. One render at a time. */
void stop_watch(NephRender *render);
/** @brief The render is over and written. */
void stop_unwatch(void);
/** @brief The name of the signal that came while a render was watched, or NULL. */
const char *stop_reason(void);
