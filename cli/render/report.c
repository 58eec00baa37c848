#include "report.h"

#include "command.h"
#include "message.h"
#include "stop.h"

static void report_photons(const NephStatistics *s)
{
    uint64_t sent = 0;
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++)
        sent += s->emitted[c];
    const char *why =
        s->short_of_memory ? "fit into memory (--memory)" : "be worth their time here";
    if (s->photons_wanted > 0 && s->passes > 0)
        tell("note",
             "of photons = %" G_GINT64_FORMAT " a pass %" G_GUINT64_FORMAT
             " were sent: more would not %s",
             s->photons_wanted, sent / (uint64_t)s->passes, why);
}

static void report_noise(const NephStatistics *s)
{
    if (s->left_noisy)
        tell("note", "no time was left to take the noise out: pictures show it; a longer "
                     "--time or a smaller --size would do");
}

int report_statistics(const NephRender *render, const char *stats, bool quiet)
{
    NephStatistics statistics;
    neph_render_statistics(render, &statistics);
    if (!quiet)
        report_photons(&statistics);
    if (!quiet)
        report_noise(&statistics);
    g_autofree char *table = neph_statistics_text(&statistics, false);
    g_autofree char *json = neph_statistics_text(&statistics, true);
    g_autoptr(GError) error = NULL;
    int result = quiet ? EXIT_DONE : print_result("%s", table);
    if (stats && !neph_file_write(stats, json, &error))
        return report_error(error);
    return result;
}

void report_time(const NephRender *render)
{
    NephStatistics s;
    neph_render_statistics(render, &s);
    g_auto(GStrv) repeat = neph_render_repeat(render);
    if (s.passes_wanted > 0)
        return;
    if (s.passes == 0)
        tell("note", "time was up in the first pass: %.0f %% of the pixels are rendered",
             100.0 * s.part);
    if (repeat) {
        g_autofree char *sets = g_strjoinv(" --set ", repeat);
        tell("note", "the same picture without a limit: --set %s", sets);
    }
}

bool report_end(const NephRender *render, const GError *error, int *exit_code)
{
    NephStatistics statistics;
    neph_render_statistics(render, &statistics);
    if (!g_error_matches(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_CANCELLED)) {
        *exit_code = report_error(error);
        return statistics.passes > 0;
    }
    *exit_code = EXIT_FAILED;
    const char *reason = stop_reason() ? stop_reason() : "request";
    if (statistics.passes == 0) {
        tell("note", "stopped by %s before the first pass was done; nothing is written",
             reason);
        return false;
    }
    g_autofree char *wanted =
        statistics.passes_wanted
            ? g_strdup_printf(" of %" G_GINT64_FORMAT, statistics.passes_wanted)
            : g_strdup("");
    tell("note",
         "stopped by %s after %" G_GINT64_FORMAT "%s passes; writing what there is",
         reason, statistics.passes, wanted);
    return true;
}

void report_done(const NephRender *render, const progress *shown)
{
    NephStatistics s;
    neph_render_statistics(render, &s);
    progress_done(shown, s.passes);
}

int report_plan(NephRender *render)
{
    NephPlan plan;
    g_autoptr(GError) error = NULL;
    if (!neph_render_plan(render, &plan, &error))
        return report_error(error);
    g_autofree char *text = neph_plan_text(&plan);
    return print_result("%s", text);
}

int report_unfinished(int frame, const GError *error)
{
    if (!g_error_matches(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_CANCELLED))
        return report_error(error);
    tell("note", "stopped by %s; frame %d is not written",
         stop_reason() ? stop_reason() : "request", frame);
    return EXIT_FAILED;
}
