#include "render/stop.h"

#include <math.h>

/* A pass that takes longer than the last one did is given up so much later than asked
   for: a share of that, and s. */
#define LATE_SHARE 0.02
#define LATE_SECONDS 0.1

/* Fewer passes do not tell their scatter well enough to trust it. */
enum { LEAST_PASSES_FOR_NOISE = 4 };

static double time_limit(const settings *how, const stop_state *now)
{
    return fmax(how->time - now->after, 0.0);
}

/* No pass is begun that is expected to end later. */
static bool time_is_up(const settings *how, const stop_state *now)
{
    double limit = time_limit(how, now);
    return now->elapsed >= limit || now->elapsed + now->last_pass > limit;
}

bool stop_at_once(const settings *how, const stop_state *now)
{
    return how->time > 0.0 &&
           now->elapsed > time_limit(how, now) + LATE_SHARE * how->time + LATE_SECONDS;
}

render_stop stop_decide(const settings *how, const stop_state *now)
{
    if (now->passes < 1.0)
        return RENDER_GOES_ON;
    if (now->passes >= (double)settings_most_passes(how))
        return RENDER_PASSES_DONE;
    if (how->noise > 0.0 && now->passes >= LEAST_PASSES_FOR_NOISE &&
        now->noise <= how->noise)
        return RENDER_NOISE_REACHED;
    return how->time > 0.0 && time_is_up(how, now) ? RENDER_TIME_UP : RENDER_GOES_ON;
}

double stop_fraction(const settings *how, const stop_state *now)
{
    double fraction = now->passes / (double)settings_most_passes(how);
    if (how->time > 0.0)
        fraction = fmax(fraction, now->elapsed / fmax(time_limit(how, now), 1e-9));
    /* The error falls as 1 / √passes, so done is (wanted / error)² of the work. */
    if (how->noise > 0.0 && isfinite(now->noise) && now->noise > 0.0) {
        double ratio = how->noise / now->noise;
        fraction = fmax(fraction, ratio * ratio);
    }
    return fmin(fraction, 1.0);
}
