/*
 * Whether what a thread is at is wanted any more: for work that is done deep below a call
 * which its caller may stop, such as reading a scene, and that is no parallel loop. The
 * call says by which flag, and all that it does on its thread asks.
 *
 *   wanted_by(flag) ─► ... for (...) if (!still_wanted_at(i, error)) return false; ...
 *
 * Where it is not, work may end in any state that can be freed: the call ends with
 * ERROR_CANCELLED, whatever was made.
 */
#pragma once

#include "base/parallel.h"

/** @brief From here on this thread's work is wanted until the flag is set; its progress
 * is told. @param flag borrowed; NULL: until it is done @return the flag before, for who
 * sets it back */
const cancel_flag *wanted_by(const cancel_flag *flag);

/** @brief That flag; NULL: none. */
const cancel_flag *wanted_flag(void);

/** @brief Cheap enough to be asked every 10 µs. @return false with ERROR_CANCELLED */
bool still_wanted(GError **error);

/** @brief The same for loops whose steps are shorter than that: asks at some of them. */
static inline bool still_wanted_at(size_t i, GError **error)
{
    const size_t every = 1 << 12;
    return i % every != 0 || still_wanted(error);
}
