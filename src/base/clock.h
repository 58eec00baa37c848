/*
 * The clock that durations are measured with.
 */
#pragma once

#include <glib.h>

/** @brief Microseconds since some moment, never going back. Thread-safe. Whole numbers:
    parts of a span never add up to more than it, which rounded seconds may. */
static inline int64_t clock_microseconds(void)
{
    return g_get_monotonic_time();
}

/** @brief Seconds since some moment, never going back. Thread-safe. */
static inline double clock_seconds(void)
{
    return (double)g_get_monotonic_time() * 1e-6;
}
