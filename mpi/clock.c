#include "clock.h"

#include <math.h>

/* Of the time so much is left for what is not foreseen: a share, and s. */
static const double share_kept = 0.02, seconds_kept = 0.1;

/* A pass may take so much longer than its trial says. */
static const double sure = 1.5;

/* The longest pass is forgotten by so much with each that is shorter. */
static const double remembered = 0.9;

double clock_now(void)
{
    return (double)g_get_monotonic_time() * 1e-6;
}

void clock_note_pass(job_clock *c, double seconds)
{
    c->pass = fmax(seconds, remembered * c->pass);
}

double clock_left(const job_clock *c, const NephRender *render)
{
    double after = neph_render_seconds_after(render) + c->join;
    return (1.0 - share_kept) * c->time - seconds_kept - after - (clock_now() - c->start);
}

bool clock_is_over(const job_clock *c, const NephRender *render, int n_before)
{
    return c->time > 0.0 && clock_left(c, render) < (n_before + 1) * c->pass;
}

bool clock_is_up(const job_clock *c, const NephRender *render)
{
    double kept = share_kept * c->time + seconds_kept;
    return c->time > 0.0 && clock_left(c, render) < -kept;
}

bool clock_is_short(const job_clock *c, const NephRender *render)
{
    return c->time > 0.0 && clock_left(c, render) < sure * c->pass;
}
