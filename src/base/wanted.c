#include "base/wanted.h"

#include <glib.h>

/* The caller is asked no more often than that. */
enum { PAUSE = 10000 }; /* µs */

static _Thread_local const cancel_flag *current;
static _Thread_local gint64 asked_at; /* monotonic µs */

const cancel_flag *wanted_by(const cancel_flag *flag)
{
    const cancel_flag *before = current;
    current = flag;
    return before;
}

const cancel_flag *wanted_flag(void)
{
    return current;
}

bool still_wanted(GError **error)
{
    gint64 now = current ? g_get_monotonic_time() : 0;
    if (!current)
        return true;
    if (now - asked_at >= PAUSE) {
        asked_at = now;
        cancel_tell_progress(current);
    }
    if (!cancelled(current))
        return true;
    if (!error || !*error)
        error_set(error, ERROR_CANCELLED, "cancelled");
    return false;
}
