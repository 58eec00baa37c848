/*
 * nephroid photons: the photons of one pass, counted, written or told of, without a
 * picture.
 */
#include "arguments.h"
#include "command.h"
#include "loading.h"
#include "message.h"
#include "overrides.h"
#include "photon_picture.h"

#include <stdio.h>
#include <string.h>

static struct {
    char *output, *trace, *size, *save, *passes, **classes;
    gboolean quiet;
    overrides settings;
} given;

static const GOptionEntry entries[] = {
    {"output", 'o', 0, G_OPTION_ARG_FILENAME, &given.output,
     "Write the photons as binary PLY (position, direction, RGB flux, class), or a "
     "picture "
     "of them over the wireframe (FORMATS)",
     "FILE"},
    {"size", 0, 0, G_OPTION_ARG_STRING, &given.size,
     "Size of that picture, or of those that --save is planned for, pixels", "WxH"},
    {"class", 0, 0, G_OPTION_ARG_STRING_ARRAY, &given.classes,
     "Only direct, indirect or caustic photons in it; may be given again", "NAME"},
    {"save", 0, 0, G_OPTION_ARG_FILENAME, &given.save,
     "Keep them there for render --photons, with the plan that they are sent by", "FILE"},
    {"passes", 0, 0, G_OPTION_ARG_STRING, &given.passes,
     "With --save: those of the first N passes (1)", "N"},
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

static const char *const names[] = {"direct", "indirect", "caustic", NULL};

/* What the options mean, checked. */
typedef struct job {
    int width, height; /* 0: the scene's */
    unsigned classes;  /* bit c: of that class */
    bool draws;        /* a picture */
    guint64 n_logged, n_passes;
    unsigned threads;
} job;

static int print_counts(const NephStatistics *s, const char *integrator)
{
    GString *out = g_string_new(NULL);
    g_string_append_printf(out, "trace time  %14.3f s\n", s->time_trace);
    g_string_append_printf(out, "photon rays %14" G_GUINT64_FORMAT, s->photon_rays);
    if (s->time_trace > 0.0)
        g_string_append_printf(out, "   %.3f M/s",
                               1e-6 * (double)s->photon_rays / s->time_trace);
    g_string_append_printf(out, "\n%-11s %14s %14s\n", "", "emitted", "stored");
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++) {
        if (s->emitted[c] > 0)
            g_string_append_printf(
                out, "%-11s %14" G_GUINT64_FORMAT " %14" G_GUINT64_FORMAT "\n", names[c],
                s->emitted[c], s->stored[c]);
        else
            g_string_append_printf(out, "%-11s not sent by integrator %s here\n",
                                   names[c], integrator);
    }
    g_autofree char *text = g_string_free(out, FALSE);
    return print_result("%s", text);
}

/* Files have full floats of directions, which following the paths once more finds. */
static bool write_output(const job *j, const NephScene *scene, NephPhotons *photons,
                         GError **error)
{
    if (!j->draws)
        return neph_photons_follow(photons, NULL, NULL, error) &&
               neph_photons_write_ply(photons, given.output, error);
    g_autoptr(NephImage) image = photon_picture(scene, photons, j->classes, error);
    return image && neph_image_write(image, given.output, 0.0f, error);
}

static int trace(const job *j, const NephScene *scene, const NephSettings *settings)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(NephPhotons) photons = neph_photons_trace(scene, settings, &error);
    if (!photons)
        return report_error(error);
    g_autofree char *integrator = neph_settings_get(settings, "integrator");
    NephStatistics s;
    neph_photons_statistics(photons, &s);
    int result = given.quiet ? EXIT_DONE : print_counts(&s, integrator);
    if (given.output && !write_output(j, scene, photons, &error))
        result = report_error(error);
    else if (given.output && !given.quiet)
        result = print_result("wrote %s\n", given.output);
    return result;
}

static int save(const job *j, const NephScene *scene, const NephSettings *settings)
{
    g_autoptr(GError) error = NULL;
    NephStatistics s;
    const NephSaveOptions options = {.passes = (int64_t)j->n_passes, .statistics = &s};
    g_autofree char *integrator = neph_settings_get(settings, "integrator");
    if (!neph_photons_save(scene, settings, given.save, &options, &error))
        return report_error(error);
    int result = given.quiet ? EXIT_DONE : print_counts(&s, integrator);
    if (!result && !given.quiet)
        result = print_result("wrote %s\n", given.save);
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

static int work_on(const char *file, const job *j)
{
    g_autoptr(GError) error = NULL;
    const NephLoadOptions options = loading_options(j->threads, given.quiet);
    g_autoptr(NephScene) scene = neph_scene_load_with(file, &options, &error);
    if (!scene)
        return report_error(error);
    g_autoptr(NephSettings) settings = neph_scene_settings(scene);
    int result = EXIT_DONE;
    if ((given.output &&
         !neph_file_spares(given.output, neph_scene_files(scene), &error)) ||
        (given.save && !neph_file_spares(given.save, neph_scene_files(scene), &error)) ||
        (j->width && !neph_scene_resize(scene, j->width, j->height, &error)) ||
        !overrides_apply(&given.settings, settings, &error))
        result = report_error(error);
    if (!result && j->n_logged)
        result = print_event_log(scene, settings, (size_t)j->n_logged);
    if (!result && given.save)
        result = save(j, scene, settings);
    if (!result && ((!j->n_logged && !given.save) || given.output))
        result = trace(j, scene, settings);
    return result;
}

static bool choose_classes(job *j, GError **error)
{
    j->classes = given.classes ? 0 : ~0u;
    for (char **word = given.classes; word && *word; word++) {
        int c = 0;
        while (names[c] && strcmp(names[c], *word) != 0)
            c++;
        if (!names[c]) {
            g_set_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_USAGE,
                        "--class: expected direct, indirect or caustic, found '%s'",
                        *word);
            return false;
        }
        j->classes |= 1u << c;
    }
    return true;
}

/* By its ending; all else is a PLY file. */
static bool is_picture(const char *path)
{
    return path && neph_image_is_written(path, NULL);
}

static bool job_init(job *j, GError **error)
{
    *j = (job){.draws = is_picture(given.output)};
    if (!j->draws && ((given.size && !given.save) || given.classes)) {
        g_set_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_USAGE,
                    "--size and --class are of a picture: -o FILE.png");
        return false;
    }
    if (given.passes && !given.save) {
        g_set_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_USAGE,
                    "--passes: expected --save FILE too");
        return false;
    }
    j->n_passes = 1;
    return (!given.passes || argument_count("--passes", given.passes, 1, G_MAXINT32,
                                            &j->n_passes, error)) &&
           (!given.save || neph_file_can_write(given.save, error)) &&
           (!given.trace ||
            argument_count("--trace", given.trace, 1, 1000000, &j->n_logged, error)) &&
           (!given.size ||
            argument_size("--size", given.size, &j->width, &j->height, error)) &&
           choose_classes(j, error) &&
           overrides_check(&given.settings, &j->threads, error) &&
           (!given.output || (j->draws ? neph_image_can_write(given.output, error)
                                       : neph_file_can_write(given.output, error)));
}

int command_photons(int argc, char **argv)
{
    int exit_code;
    job j;
    g_autoptr(GError) error = NULL;
    if (!arguments_parse(&how, &argc, &argv, &exit_code))
        return exit_code;
    return job_init(&j, &error) ? work_on(argv[1], &j) : report_error(error);
}
