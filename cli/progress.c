#include "progress.h"

#include "message.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { BAR_WIDTH = 30 };
static const int64_t bar_interval = G_USEC_PER_SEC / 10;
static const int64_t line_interval = 10 * G_USEC_PER_SEC;

progress progress_begin(bool quiet, int64_t n_passes)
{
    return (progress){.quiet = quiet,
                      .on_terminal = isatty(STDERR_FILENO),
                      .n_passes = n_passes,
                      .start = g_get_monotonic_time()};
}

/* "2:07", "1:02:07". */
static char *clock_text(double seconds)
{
    int64_t whole = (int64_t)(seconds + 0.5);
    int hours = (int)(whole / 3600), minutes = (int)(whole / 60 % 60);
    if (hours)
        return g_strdup_printf("%d:%02d:%02d", hours, minutes, (int)(whole % 60));
    return g_strdup_printf("%d:%02d", minutes, (int)(whole % 60));
}

/* "pass 3 of 16, 0:12 left"; too early no time is told. */
static char *state_text(const progress *p, double fraction, int64_t passes, int64_t now)
{
    double elapsed = (double)(now - p->start) / G_USEC_PER_SEC;
    g_autofree char *left = clock_text(elapsed * (1.0 - fraction) / MAX(fraction, 1e-9));
    const bool known = fraction > 0.01 || (fraction > 0.0 && elapsed > 2.0);
    return g_strdup_printf("pass %" G_GINT64_FORMAT " of %" G_GINT64_FORMAT "%s%s%s",
                           MIN(passes + 1, p->n_passes), p->n_passes, known ? ", " : "",
                           known ? left : "", known ? " left" : "");
}

static void draw_bar(double fraction, const char *state)
{
    static const char full[] = "==============================";
    int filled = (int)(fraction * BAR_WIDTH);
    fprintf(stderr, "\r[%.*s%*s] %3d %%  %s\033[K", filled, full, BAR_WIDTH - filled, "",
            (int)(100.0 * fraction), state);
    fflush(stderr);
}

bool progress_show(double fraction, const NephStatistics *statistics, void *data)
{
    progress *p = data;
    const int64_t now = g_get_monotonic_time();
    const int64_t quiet_for = now - (p->shown_at ? p->shown_at : p->start);
    const double done = CLAMP(fraction, 0.0, 1.0);
    const int tenths = (int)(10.0 * done + 1e-9);
    const bool due = p->on_terminal
                         ? quiet_for >= bar_interval
                         : tenths > p->shown_tenths || quiet_for >= line_interval;
    if (p->quiet || !due)
        return true;
    g_autofree char *state = state_text(p, done, statistics->passes, now);
    if (p->on_terminal)
        draw_bar(done, state);
    else
        say("%3d %%, %s", (int)(100.0 * done + 1e-9), state);
    p->shown_at = now;
    p->shown_tenths = tenths;
    return true;
}

void progress_end(progress *p)
{
    if (p->on_terminal && p->shown_at)
        fputs("\r\033[K", stderr);
    p->shown_at = 0;
}
