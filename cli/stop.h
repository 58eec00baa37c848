/*
 * Ctrl-C and SIGTERM while rendering: the first asks the render to stop, so that what
 * there is can be written; the second ends the program as ever.
 */
#pragma once

#include <nephroid/nephroid.h>

/** @brief From here on signals stop the render. One render at a time. */
void stop_watch(NephRender *render);
/** @brief The render is over; a signal caught meanwhile keeps the second one deadly. */
void stop_unwatch(void);
/** @brief The name of the signal that came, or NULL. */
const char *stop_reason(void);
