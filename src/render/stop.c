#include "render/stop.h"

#include "render/film/film.h"

#include <math.h>

/* A pass that takes longer than the last one did is given up so much later than asked
   for: a share of that, and s. */
#define LATE_SHARE 0.02
#define LATE_SECONDS 0.1

/* A pass is rendered in parts, unless there is so much more time than it will take. */
#define EASY_MARGIN 1.5

/* Fewer passes do not tell their scatter well enough to trust it. */
enum { LEAST_PASSES_FOR_NOISE = 4 };

static double time_limit(const settings *how, const stop_state *now)
{
    return how->time - now->after;
}

double stop_grace(double time)
{
    return LATE_SHARE * time + LATE_SECONDS;
}

/* A pass that is expected to end too late is begun if some of its pixels will be done. */
static bool time_is_up(const settings *how, const stop_state *now)
{
    double left = time_limit(how, now) - now->elapsed;
    double cell = (now->last_pass - now->last_photons) / FILM_CELLS;
    return left <= 0.0 || left < now->last_photons + cell;
}

bool stop_at_once(const settings *how, const stop_state *now)
{
    return how->time > 0.0 && now->elapsed > time_limit(how, now) + stop_grace(how->time);
}

render_stop stop_decide(const settings *how, const stop_state *now)
{
    if (now->passes >= settings_most_passes(how) - 0.5 / FILM_CELLS)
        return RENDER_PASSES_DONE;
    if (now->passes < 1.0)
        return RENDER_GOES_ON;
    if (how->noise > 0.0 && now->passes >= LEAST_PASSES_FOR_NOISE &&
        now->noise <= how->noise)
        return RENDER_NOISE_REACHED;
    return how->time > 0.0 && time_is_up(how, now) ? RENDER_TIME_UP : RENDER_GOES_ON;
}

/* After which the picture can be seen as a whole. */
static int next_level(int done)
{
    int level = 1;
    while (level <= done)
        level *= 4;
    return level;
}

/* How many cells are expected to end in time: all, or half of what fits, so that a guess
   that is wrong can still be mended. */
static int cells_in_time(const settings *how, const stop_state *now,
                         const stop_part *part)
{
    int left = part->wanted - part->done;
    double fit = (time_limit(how, now) - now->elapsed) / fmax(part->cell, 1e-9);
    if (fit >= EASY_MARGIN * (double)left)
        return left;
    return fit < 1.0 ? 0 : MIN((int)fmax(0.5 * fit, 1.0), left);
}

int stop_next_cells(const settings *how, const stop_state *now, const stop_part *part)
{
    int n = part->wanted - part->done;
    if (part->is_first)
        n = MIN(n, next_level(part->done) - part->done);
    if (!(how->time > 0.0))
        return n;
    int missing = part->least - part->done;
    return MIN(n, missing > 0 ? missing : cells_in_time(how, now, part));
}

double stop_fraction(const settings *how, const stop_state *now)
{
    double fraction = now->passes / settings_most_passes(how);
    if (how->time > 0.0)
        fraction = fmax(fraction, now->elapsed / how->time);
    /* The error falls as 1 / √passes, so done is (wanted / error)² of the work. */
    if (how->noise > 0.0 && isfinite(now->noise) && now->noise > 0.0) {
        double ratio = how->noise / now->noise;
        fraction = fmax(fraction, ratio * ratio);
    }
    return fmin(fraction, 1.0);
}
