/*
 * nephroid photons: the photons of one pass, counted, written or told of, without a
 * picture.
 */
#include "arguments.h"
#include "command.h"
#include "loading.h"
#include "message.h"
#include "overrides.h"

#include <stdio.h>

static struct {
    char *output, *trace;
    gboolean quiet;
    overrides settings;
} given;

static const GOptionEntry entries[] = {
    {"output", 'o', 0, G_OPTION_ARG_FILENAME, &given.output,
     "Write the photons as binary PLY: position, direction, RGB flux, class", "FILE.ply"},
    {"trace", 0, 0, G_OPTION_ARG_STRING, &given.trace,
     "Print every event of the first N photons of each class instead", "N"},
    {"set", 's', 0, G_OPTION_ARG_STRING_ARRAY, &given.settings.set,
     "Change a setting; may be given again", "NAME=VALUE"},
    {"preset", 0, 0, G_OPTION_ARG_STRING, &given.settings.preset,
     "Settings as a text on photon mapping describes them; settings --presets lists them",
     "NAME"},
    {"settings", 0, 0, G_OPTION_ARG_FILENAME, &given.settings.file,
     "Read settings from lines of name = value", "FILE"},
    {"threads", 'j', 0, G_OPTION_ARG_STRING, &given.settings.threads,
     "Threads; 0: one per processor", "N"},
    {"seed", 0, 0, G_OPTION_ARG_STRING, &given.settings.seed, "Seed of random numbers",
     "N"},
    {"quiet", 'q', 0, G_OPTION_ARG_NONE, &given.quiet, "Only warnings and errors", NULL},
    G_OPTION_ENTRY_NULL};

static const usage how = {
    .name = "photons",
    .operands = "SCENE",
    .n_operands = 1,
    .summary = "Traces the photons of one pass without rendering, and says how long that "
               "took and what\nwas emitted and stored: those that a render with these "
               "settings sends.",
    .entries = entries,
    .loads_scene = true};

static int print_counts(const NephPhotons *photons, const char *integrator)
{
    static const char *const names[] = {"direct", "indirect", "caustic"};
    NephStatistics s;
    neph_photons_statistics(photons, &s);
    GString *out = g_string_new(NULL);
    g_string_append_printf(out, "trace time  %14.3f s\n", s.time_trace);
    g_string_append_printf(out, "photon rays %14" G_GUINT64_FORMAT, s.photon_rays);
    if (s.time_trace > 0.0)
        g_string_append_printf(out, "   %.3f M/s",
                               1e-6 * (double)s.photon_rays / s.time_trace);
    g_string_append_printf(out, "\n%-11s %14s %14s\n", "", "emitted", "stored");
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++) {
        if (s.emitted[c] > 0)
            g_string_append_printf(
                out, "%-11s %14" G_GUINT64_FORMAT " %14" G_GUINT64_FORMAT "\n", names[c],
                s.emitted[c], s.stored[c]);
        else
            g_string_append_printf(out, "%-11s not sent by integrator %s here\n",
                                   names[c], integrator);
    }
    g_autofree char *text = g_string_free(out, FALSE);
    return print_result("%s", text);
}

static int trace(const NephScene *scene, const NephSettings *settings)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(NephPhotons) photons = neph_photons_trace(scene, settings, &error);
    if (!photons)
        return report_error(error);
    g_autofree char *integrator = neph_settings_get(settings, "integrator");
    int result = given.quiet ? EXIT_DONE : print_counts(photons, integrator);
    if (given.output && !neph_photons_write_ply(photons, given.output, &error))
        result = report_error(error);
    else if (given.output && !given.quiet)
        result = print_result("wrote %s\n", given.output);
    return result;
}

static void print_line(const char *line, void *data)
{
    fprintf(data, "%s\n", line);
}

static int print_event_log(const NephScene *scene, const NephSettings *settings, size_t n)
{
    g_autoptr(GError) error = NULL;
    if (!neph_photons_event_log(scene, settings, n, print_line, stdout, &error))
        return report_error(error);
    return print_result("%s", "");
}

static int work_on(const char *file, unsigned threads, size_t n_logged)
{
    g_autoptr(GError) error = NULL;
    const NephLoadOptions options = loading_options(threads, given.quiet);
    g_autoptr(NephScene) scene = neph_scene_load_with(file, &options, &error);
    if (!scene)
        return report_error(error);
    g_autoptr(NephSettings) settings = neph_scene_settings(scene);
    int result = EXIT_DONE;
    if ((given.output &&
         !neph_file_spares(given.output, neph_scene_files(scene), &error)) ||
        !overrides_apply(&given.settings, settings, &error))
        result = report_error(error);
    if (!result && n_logged)
        result = print_event_log(scene, settings, n_logged);
    if (!result && (!n_logged || given.output))
        result = trace(scene, settings);
    return result;
}

int command_photons(int argc, char **argv)
{
    int exit_code;
    if (!arguments_parse(&how, &argc, &argv, &exit_code))
        return exit_code;
    g_autoptr(GError) error = NULL;
    unsigned threads;
    guint64 n_logged = 0;
    if ((given.trace &&
         !argument_count("--trace", given.trace, 1, 1000000, &n_logged, &error)) ||
        !overrides_check(&given.settings, &threads, &error) ||
        (given.output && !neph_file_can_write(given.output, &error)))
        return report_error(error);
    return work_on(argv[1], threads, (size_t)n_logged);
}
