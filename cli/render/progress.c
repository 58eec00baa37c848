#include "progress.h"

#include "message.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { BAR_WIDTH = 30 };
static const double most_shown = 0.99; /* until the files are written */
static const int64_t bar_interval = G_USEC_PER_SEC / 10;
static const int64_t line_interval = 10 * G_USEC_PER_SEC;

progress progress_begin(bool quiet)
{
    return (progress){.quiet = quiet,
                      .on_terminal = isatty(STDERR_FILENO),
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
static char *state_text(double fraction, const NephStatistics *so_far)
{
    GString *out = g_string_new("pass ");
    const int64_t passes = so_far->passes, wanted = so_far->passes_wanted;
    if (wanted)
        g_string_append_printf(out, "%" G_GINT64_FORMAT " of %" G_GINT64_FORMAT,
                               MIN(passes + 1, wanted), wanted);
    else
        g_string_append_printf(out, "%" G_GINT64_FORMAT, passes + 1);
    double elapsed = so_far->time_total;
    if (fraction > 0.01 || (fraction > 0.0 && elapsed > 2.0)) {
        g_autofree char *left = clock_text(elapsed * (1.0 - fraction) / fraction);
        g_string_append_printf(out, ", %s left", left);
    }
    return g_string_free(out, FALSE);
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
    const double done = CLAMP(fraction, 0.0, most_shown);
    const int tenths = (int)(10.0 * done + 1e-9);
    const bool due = p->on_terminal
                         ? quiet_for >= bar_interval
                         : tenths > p->shown_tenths || quiet_for >= line_interval;
    if (p->quiet || !due)
        return true;
    g_autofree char *state = state_text(done, statistics);
    if (p->on_terminal)
        draw_bar(done, state);
    else
        say("%3d %%, %s", (int)(100.0 * done + 1e-9), state);
    p->shown_at = now;
    p->shown_tenths = tenths;
    return true;
}

void progress_done(const progress *p, int64_t passes)
{
    if (!p->quiet && !p->on_terminal)
        say("100 %%, passes: %" G_GINT64_FORMAT, passes);
}

void progress_end(progress *p)
{
    if (p->on_terminal && p->shown_at)
        fputs("\r\033[K", stderr);
    p->shown_at = 0;
}
