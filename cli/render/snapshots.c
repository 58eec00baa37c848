#include "snapshots.h"

#include "arguments.h"

#include <string.h>

bool snapshots_init(snapshots *s, const char *text, GError **error)
{
    *s = (snapshots){.last_time = g_get_monotonic_time()};
    if (!text)
        return true;
    double seconds = 0.0;
    guint64 passes = 0;
    g_autofree char *number = g_strdup(text);
    size_t length = strlen(number);
    const bool by_time = length > 0 && number[length - 1] == 's';
    if (by_time) {
        number[length - 1] = '\0';
        if (argument_real("--every", number, &seconds, NULL) && seconds > 0.0 &&
            seconds <= 1e9) {
            s->interval = MAX(1, (int64_t)(seconds * G_USEC_PER_SEC));
            return true;
        }
    } else if (argument_count("--every", number, 1, G_MAXINT32, &passes, NULL)) {
        s->passes = (int64_t)passes;
        return true;
    }
    g_set_error(
        error, NEPH_ERROR_DOMAIN, NEPH_ERROR_USAGE,
        "--every: expected a number of passes, or of seconds as in 30s, found '%s'",
        text);
    return false;
}

bool snapshots_due(snapshots *s, int64_t passes_done)
{
    const int64_t now = g_get_monotonic_time();
    const bool is_new = passes_done != s->seen_passes;
    s->seen_passes = passes_done;
    if (!is_new || !((s->passes && passes_done >= s->last_passes + s->passes) ||
                     (s->interval && now >= s->last_time + s->interval)))
        return false;
    s->last_passes = passes_done;
    s->last_time = now;
    return true;
}
