#include "render/stop.h"

#include <math.h>

/* A pass is begun if it is expected to end within this share of the time asked for. */
#define LATEST_END 1.1

/* Fewer passes do not tell their scatter well enough to trust it. */
enum { LEAST_PASSES_FOR_NOISE = 4 };

static bool time_is_up(const settings *how, const stop_state *now)
{
    return now->elapsed >= how->time ||
           now->elapsed + now->last_pass > LATEST_END * how->time;
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
        fraction = fmax(fraction, now->elapsed / how->time);
    /* The error falls as 1 / √passes, so done is (wanted / error)² of the work. */
    if (how->noise > 0.0 && isfinite(now->noise) && now->noise > 0.0) {
        double ratio = how->noise / now->noise;
        fraction = fmax(fraction, ratio * ratio);
    }
    return fmin(fraction, 1.0);
}
