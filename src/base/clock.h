/*
 * The clock that durations are measured with.
 */
#pragma once

#include <glib.h>

/** @brief Seconds since some moment, never going back. Thread-safe. */
static inline double clock_seconds(void)
{
    return (double)g_get_monotonic_time() * 1e-6;
}
