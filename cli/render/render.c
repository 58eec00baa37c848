/*
 * nephroid render: what can be refused is refused before the scene is loaded, what can be
 * checked before the render is checked before it, and what has been rendered is written.
 */
#include "arguments.h"
#include "checkpoints.h"
#include "command.h"
#include "exposure.h"
#include "frames.h"
#include "layers.h"
#include "loading.h"
#include "message.h"
#include "overrides.h"
#include "progress.h"
#include "snapshots.h"
#include "stop.h"

#include <math.h>
#include <string.h>

enum { USUAL_PASSES = 16 };

static struct {
    char **outputs, **layers;
    char *size, *exposure, *stats, *every, *checkpoint, *checkpoint_every, *resume,
        *photons, *frame, *fps, *camera, *grain;
    gboolean quiet, explain;
    overrides settings;
} given;

static const GOptionEntry entries[] = {
    {"output", 'o', 0, G_OPTION_ARG_FILENAME_ARRAY, &given.outputs,
     "Write the image there: .exr, .png, .jpg, .hdr or .pfm; may be given again", "FILE"},
    {"layer", 0, 0, G_OPTION_ARG_FILENAME_ARRAY, &given.layers,
     "Write a layer of it there, such as caustic=caustic.png; may be given again",
     "NAME=FILE"},
    {"set", 's', 0, G_OPTION_ARG_STRING_ARRAY, &given.settings.set,
     "Change a setting; may be given again", "NAME=VALUE"},
    {"preset", 0, 0, G_OPTION_ARG_STRING, &given.settings.preset,
     "Settings as a text on photon mapping describes them; settings --presets lists them",
     "NAME"},
    {"settings", 0, 0, G_OPTION_ARG_FILENAME, &given.settings.file,
     "Read settings from lines of name = value", "FILE"},
    {"size", 0, 0, G_OPTION_ARG_STRING, &given.size, "Size of the image, pixels", "WxH"},
    {"spp", 0, 0, G_OPTION_ARG_STRING, &given.settings.spp,
     "Camera samples a pixel in each pass", "N"},
    {"passes", 0, 0, G_OPTION_ARG_STRING, &given.settings.passes, "Number of passes",
     "N"},
    {"time", 0, 0, G_OPTION_ARG_STRING, &given.settings.time,
     "End after so many seconds (30s or 30), with a picture", "SECONDS"},
    {"noise", 0, 0, G_OPTION_ARG_STRING, &given.settings.noise,
     "Stop when the estimated relative error is below this", "X"},
    {"every", 0, 0, G_OPTION_ARG_STRING, &given.every,
     "Write the image every N passes, or as 30s every so many seconds", "N|Ns"},
    {"checkpoint", 0, 0, G_OPTION_ARG_FILENAME, &given.checkpoint,
     "Write there what another process needs to go on with the render", "FILE"},
    {"checkpoint-every", 0, 0, G_OPTION_ARG_STRING, &given.checkpoint_every,
     "Write it every so many seconds, after a pass (60)", "SECONDS"},
    {"resume", 0, 0, G_OPTION_ARG_FILENAME, &given.resume,
     "Go on from such a file, with its settings and size", "FILE"},
    {"photons", 0, 0, G_OPTION_ARG_FILENAME, &given.photons,
     "Use the photons that 'photons --save' has kept there, with their settings", "FILE"},
    {"frame", 0, 0, G_OPTION_ARG_STRING, &given.frame,
     "Render frames A to B of an animation, each to its own file", "A-B"},
    {"fps", 0, 0, G_OPTION_ARG_STRING, &given.fps, "Frames a second (24)", "N"},
    {"camera", 0, 0, G_OPTION_ARG_FILENAME, &given.camera,
     "Move the camera: line N of the file, LookAt and nine numbers, is of frame N",
     "FILE"},
    {"grain", 0, 0, G_OPTION_ARG_STRING, &given.grain,
     "Whether frames have the same pattern of grain; fixed if not given",
     "fixed|varying"},
    {"integrator", 0, 0, G_OPTION_ARG_STRING, &given.settings.integrator,
     "How light is followed; settings has them all", "NAME"},
    {"threads", 'j', 0, G_OPTION_ARG_STRING, &given.settings.threads,
     "Threads; 0: one per processor", "N"},
    {"seed", 0, 0, G_OPTION_ARG_STRING, &given.settings.seed, "Seed of random numbers",
     "N"},
    {"denoise", 0, 0, G_OPTION_ARG_STRING, &given.settings.denoise,
     "Whether the noise is taken out of what 8-bit images show; on if not given",
     "on|off"},
    {"exposure", 0, 0, G_OPTION_ARG_STRING, &given.exposure,
     "Brighten 8-bit images by so many stops", "STOPS"},
    {"stats", 0, 0, G_OPTION_ARG_FILENAME, &given.stats, "Write statistics as JSON",
     "FILE"},
    {"explain", 0, 0, G_OPTION_ARG_NONE, &given.explain,
     "Tell first what is decided before the first pass, and why", NULL},
    {"quiet", 'q', 0, G_OPTION_ARG_NONE, &given.quiet,
     "Only warnings and errors; no progress, no table", NULL},
    G_OPTION_ENTRY_NULL};

static const usage how = {
    .name = "render",
    .operands = "SCENE",
    .n_operands = 1,
    .summary = "Renders a scene (pbrt, glTF, OBJ, STL, PLY) by photon mapping.",
    .description =
        "Without -o the image goes to the name in the scene's Film, without its folders, "
        "else to\nthe scene's name with .exr; both in the current folder.\n\n"
        "Settings: the scene's are overridden by --preset, these by --settings, these by "
        "--set in the "
        "order given,\nthese by --spp, --passes, --time, --noise, --integrator, "
        "--threads, "
        "--denoise and --seed.\n'nephroid settings' lists them all. With --time or "
        "--noise the "
        "scene's own number of\npasses is no limit; --passes N is.\n\n"
        "Ctrl-C (SIGTERM, SIGHUP) writes the passes that are done and exits with 3; "
        "before the\nfirst is done it writes nothing. A second one ends at once.\n\n"
        "--resume takes the settings of the checkpoint in place of the scene's; only "
        "passes, time,\nnoise and threads may be changed. Time counts from the first "
        "start.\n\n"
        "--photons takes the settings that the photons were sent by in place of the "
        "scene's; only\npasses, time, noise, threads, denoise and kernels may be "
        "changed, and the camera and the size.\n\n"
        "With --frame or --camera a run of # in the name of -o becomes the frame's "
        "number, "
        "as in\na.####.png; frames whose files are there are skipped. Frame N is at N / "
        "fps seconds.\n",
    .entries = entries,
    .loads_scene = true};

/* What the options mean, checked. */
typedef struct job {
    const char *scene_file;
    char **outputs;    /* NULL-terminated */
    int width, height; /* 0: the scene's */
    exposure_wish exposure;
    unsigned threads;
    frames frames;
    int frame;         /* under way */
    NephCamera camera; /* as the scene was read with it */
    int64_t start;     /* monotonic µs of this picture's */
    snapshots snapshots;
    checkpoints checkpoints;
} job;

static bool check_outputs(char **outputs, GError **error)
{
    for (char **path = outputs; path && *path; path++)
        if (!neph_image_can_write(*path, error))
            return false;
    return true;
}

/* Of many pictures each has its own files, which are there when it is done. */
static bool check_frames(const job *j, GError **error)
{
    const struct {
        const char *option;
        bool is_given;
    } rest[] = {{"--every", given.every},
                {"--checkpoint", given.checkpoint},
                {"--resume", given.resume},
                {"--layer", given.layers},
                {"--stats", given.stats}};
    if (!j->frames.are_asked)
        return true;
    if (!j->outputs)
        g_set_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_USAGE,
                    "--frame and --camera: expected -o FILE too");
    for (size_t i = 0; i < G_N_ELEMENTS(rest) && !*error; i++)
        if (rest[i].is_given)
            g_set_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_USAGE,
                        "%s is of one picture: it does not go with --frame or --camera",
                        rest[i].option);
    return !*error;
}

static bool job_init(job *j, const char *scene_file, GError **error)
{
    double exposure = 0.0;
    *j = (job){.scene_file = scene_file,
               .outputs = g_strdupv(given.outputs),
               .start = program_start};
    bool good = (!given.size ||
                 argument_size("--size", given.size, &j->width, &j->height, error)) &&
                (!given.exposure ||
                 argument_real("--exposure", given.exposure, &exposure, error)) &&
                snapshots_init(&j->snapshots, given.every, error) &&
                checkpoints_init(&j->checkpoints, given.checkpoint,
                                 given.checkpoint_every, error) &&
                overrides_check(&given.settings, &j->threads, error) &&
                frames_init(&j->frames, given.frame, given.fps, given.camera, given.grain,
                            error) &&
                check_frames(j, error) && check_outputs(j->outputs, error) &&
                layers_check(given.layers, error) &&
                (!given.stats || neph_file_can_write(given.stats, error));
    j->exposure = (exposure_wish){.stops = (float)exposure, .no_notes = given.quiet};
    return good;
}

/* "dir/box.pbrt.gz" gives "box.exr". */
static char *default_output(const char *scene_file)
{
    g_autofree char *name = g_path_get_basename(scene_file);
    if (g_str_has_suffix(name, ".gz"))
        name[strlen(name) - 3] = '\0';
    char *dot = strrchr(name, '.');
    if (dot && dot != name)
        *dot = '\0';
    return g_strconcat(name, ".exr", NULL);
}

/* No file is written that was read, and none twice. */
static bool check_distinct(const job *j, const NephScene *scene, GError **error)
{
    g_autoptr(GStrvBuilder) builder = g_strv_builder_new();
    g_strv_builder_addv(builder, (const char **)neph_scene_files(scene));
    if (given.settings.file)
        g_strv_builder_add(builder, given.settings.file);
    if (given.photons)
        g_strv_builder_add(builder, given.photons);
    g_auto(GStrv) inputs = g_strv_builder_end(builder);
    const char *const *others = (const char *const *)inputs;
    for (char **path = j->outputs; *path; path++) {
        const char *const *rest = (const char *const *)path + 1;
        const char *const text[] = {given.stats ? given.stats : given.checkpoint,
                                    given.checkpoint, NULL};
        if (!neph_file_spares(*path, others, error) ||
            !neph_file_spares(*path, rest, error) ||
            !neph_file_spares(*path, text, error))
            return false;
    }
    for (char **word = given.layers; word && *word; word++)
        if (!neph_file_spares(layer_file(*word), others, error) ||
            !neph_file_spares(layer_file(*word), (const char *const *)j->outputs, error))
            return false;
    const char *const checkpoint[] = {given.checkpoint, NULL};
    return (!given.stats || (neph_file_spares(given.stats, others, error) &&
                             neph_file_spares(given.stats, checkpoint, error))) &&
           (!given.checkpoint || neph_file_spares(given.checkpoint, others, error));
}

static bool choose_outputs(job *j, const NephScene *scene, GError **error)
{
    if (j->outputs)
        return check_distinct(j, scene, error);
    const char *named = neph_scene_output(scene);
    j->outputs = g_new0(char *, 2);
    j->outputs[0] = named ? g_strdup(named) : default_output(j->scene_file);
    if (check_outputs(j->outputs, error) && check_distinct(j, scene, error))
        return true;
    g_prefix_error(error, "the scene's output, which -o would replace: ");
    return false;
}

/* The photons of a still scene are made once for all its frames. */
static bool makes_photons(const job *j)
{
    return given.photons && j->frames.are_asked &&
           !g_file_test(given.photons, G_FILE_TEST_EXISTS);
}

static bool make_photons(const job *j, const NephScene *scene,
                         const NephSettings *settings, GError **error)
{
    if (given.photons && j->frames.are_asked && neph_scene_is_animated(scene)) {
        g_set_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_USAGE,
                    "--photons: expected a still scene for many frames, this one moves");
        return false;
    }
    if (!makes_photons(j))
        return true;
    g_autofree char *passes = neph_settings_get(settings, "passes");
    const int64_t n = (int64_t)ceil(g_ascii_strtod(passes, NULL));
    const NephSaveOptions options = {.passes = n > 0 ? n : USUAL_PASSES};
    if (!neph_photons_save(scene, settings, given.photons, &options, error))
        return false;
    if (!given.quiet)
        print_result("wrote %s\n", given.photons);
    return true;
}

/* The scene's, or those of the render that goes on, with the size of its picture. */
static NephSettings *settings_before(job *j, const NephScene *scene, GError **error)
{
    int width, height;
    if (!given.resume)
        return given.photons && !makes_photons(j)
                   ? neph_photons_settings(given.photons, NULL, error)
                   : neph_scene_settings(scene);
    NephSettings *settings =
        neph_checkpoint_settings(given.resume, &width, &height, error);
    if (settings && !j->width) {
        j->width = width;
        j->height = height;
    }
    return settings;
}

static bool resume(job *j, NephRender *render, GError **error)
{
    NephStatistics s;
    if (!given.resume)
        return true;
    if (!neph_render_resume(render, given.resume, error))
        return false;
    neph_render_statistics(render, &s);
    if (!given.quiet)
        tell("note", "going on after %" G_GINT64_FORMAT " passes", s.passes);
    j->checkpoints.saved_passes = s.passes;
    return true;
}

static bool set_grain(const job *j, NephSettings *settings, GError **error)
{
    g_autofree char *number = g_strdup_printf("%d", j->frame);
    return !j->frames.varies || neph_settings_set(settings, "camera_seed", number, error);
}

static NephRender *prepare(job *j, NephScene *scene, GError **error)
{
    g_autoptr(NephSettings) settings = settings_before(j, scene, error);
    NephRender *render = NULL;
    if (settings && overrides_apply(&given.settings, settings, error) &&
        set_grain(j, settings, error) &&
        (!j->width || neph_scene_resize(scene, j->width, j->height, error)) &&
        make_photons(j, scene, settings, error) && choose_outputs(j, scene, error))
        render = neph_render_new(scene, settings, error);
    if (render &&
        ((given.photons && !neph_render_use_photons(render, given.photons, error)) ||
         !resume(j, render, error)))
        g_clear_pointer(&render, neph_render_free);
    if (render && !given.quiet)
        overrides_tell_unread(&given.settings, settings);
    return render;
}

static bool is_denoised(const NephImage *image)
{
    bool found = false;
    const char *name;
    for (int c = 0; (name = neph_image_channel_name(image, c)); c++)
        found |= strcmp(name, "denoised.R") == 0;
    return found;
}

/* What is written, and whether it shows the picture without noise. */
static void report_written(const NephImage *image, const char *path)
{
    bool shows = is_denoised(image) && has_eight_bits(path);
    print_result("wrote %s%s\n", path, shows ? ", denoised" : "");
}

static int write_images(const job *j, const NephRender *render, bool is_snapshot)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(NephImage) image = neph_render_image(render, &error);
    if (!image)
        return report_error(error);
    int result = EXIT_DONE;
    float stops = exposure_of(image, &j->exposure, is_snapshot);
    for (char **path = j->outputs; *path; path++) {
        g_autoptr(GError) refused = NULL;
        if (!neph_image_write(image, *path, stops, &refused))
            result = report_error(refused);
        else if (!is_snapshot && !given.quiet)
            report_written(image, *path);
    }
    if (!layers_write(given.layers, image, stops, &error))
        result = report_error(error);
    for (char **word = given.layers; !result && word && *word; word++)
        if (!is_snapshot && !given.quiet)
            print_result("wrote %s\n", layer_file(*word));
    return result;
}

/* Before anything is rendered. */
static bool check_layers(const NephRender *render, GError **error)
{
    g_autoptr(NephImage) image = given.layers ? neph_render_image(render, error) : NULL;
    return !given.layers || (image && layers_known(given.layers, image, error));
}

static void report_photons(const NephStatistics *s)
{
    uint64_t sent = 0;
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++)
        sent += s->emitted[c];
    if (s->photons_wanted > 0 && s->passes > 0)
        tell("note",
             "of photons = %" G_GINT64_FORMAT " a pass %" G_GUINT64_FORMAT
             " were sent: more would not be worth their time here",
             s->photons_wanted, sent / (uint64_t)s->passes);
}

static void report_noise(const NephStatistics *s)
{
    if (s->left_noisy)
        tell("note", "no time was left to take the noise out: pictures show it; a longer "
                     "--time or a smaller --size would do");
}

static int write_statistics(const NephRender *render)
{
    NephStatistics statistics;
    neph_render_statistics(render, &statistics);
    if (!given.quiet)
        report_photons(&statistics);
    if (!given.quiet)
        report_noise(&statistics);
    g_autofree char *table = neph_statistics_text(&statistics, false);
    g_autofree char *json = neph_statistics_text(&statistics, true);
    g_autoptr(GError) error = NULL;
    int result = given.quiet ? EXIT_DONE : print_result("%s", table);
    if (given.stats && !neph_file_write(given.stats, json, &error))
        return report_error(error);
    return result;
}

/* Passes that time or noise has ended can be had again by their number. */
static void report_time(const NephRender *render)
{
    NephStatistics s;
    neph_render_statistics(render, &s);
    g_auto(GStrv) repeat = neph_render_repeat(render);
    if (given.quiet || s.passes_wanted > 0)
        return;
    if (s.passes == 0)
        tell("note", "time was up in the first pass: %.0f %% of the pixels are rendered",
             100.0 * s.part);
    if (repeat) {
        g_autofree char *sets = g_strjoinv(" --set ", repeat);
        tell("note", "the same picture without a limit: --set %s", sets);
    }
}

/* Tells why the render ended early. @return whether there is something to write. */
static bool report_end(const NephRender *render, const GError *error, int *exit_code)
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

/* What is told of a render under way. */
typedef struct watch {
    job *job;
    NephRender *render;
    progress shown;
} watch;

static bool look_on(double fraction, const NephStatistics *statistics, void *data)
{
    watch *w = data;
    if (snapshots_due(&w->job->snapshots, statistics->passes))
        write_images(w->job, w->render, true);
    checkpoints_show(&w->job->checkpoints, w->render, statistics->passes);
    return progress_show(fraction, statistics, &w->shown);
}

static void report_done(const NephRender *render, const progress *shown)
{
    NephStatistics s;
    neph_render_statistics(render, &s);
    progress_done(shown, s.passes);
}

/* Passes that time is short for are planned by it: --explain takes of it too. */
static int explain(NephRender *render)
{
    NephPlan plan;
    g_autoptr(GError) error = NULL;
    if (!neph_render_plan(render, &plan, &error))
        return report_error(error);
    g_autofree char *text = neph_plan_text(&plan);
    return print_result("%s", text);
}

/* Of frames there are whole ones only: those that are there need not be rendered again.
 */
static int report_unfinished(const job *j, const GError *error)
{
    if (!g_error_matches(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_CANCELLED))
        return report_error(error);
    tell("note", "stopped by %s; frame %d is not written",
         stop_reason() ? stop_reason() : "request", j->frame);
    return EXIT_FAILED;
}

static int run(job *j, NephRender *render)
{
    g_autoptr(GError) error = NULL;
    int ended = EXIT_DONE;
    watch w = {j, render, progress_begin(given.quiet)};
    /* All counts that is done from the program's start, or the frame's, to its end. */
    double before = (double)(g_get_monotonic_time() - j->start) / G_USEC_PER_SEC;
    neph_render_set_time_around(render, before, (const char *const *)j->outputs);
    if (!check_layers(render, &error))
        return report_error(error);
    if (given.explain && (ended = explain(render)) != EXIT_DONE)
        return ended;
    bool done = neph_render_run(render, look_on, &w, &error);
    progress_end(&w.shown);
    if (!done && j->frames.are_asked)
        return report_unfinished(j, error);
    if (!done && !report_end(render, error, &ended))
        return ended;
    report_time(render);
    int images = write_images(j, render, false);
    if (!ended && !images)
        report_done(render, &w.shown);
    int statistics = write_statistics(render);
    int checkpoint = checkpoints_end(&j->checkpoints, render);
    return ended ? ended : images ? images : statistics ? statistics : checkpoint;
}

static NephScene *load(job *j, GError **error)
{
    NephLoadOptions options = loading_options(j->threads, given.quiet);
    options.at_time = j->frames.are_asked;
    options.time = j->frames.are_asked ? frame_time(&j->frames, j->frame) : 0.0;
    NephScene *scene = neph_scene_load_with(j->scene_file, &options, error);
    if (scene)
        j->exposure.is_free = !given.exposure && !neph_scene_says_exposure(scene);
    return scene;
}

static int render_scene(job *j, NephScene *scene)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(NephRender) render = prepare(j, scene, &error);
    if (!render)
        return report_error(error);
    stop_watch(render);
    int result = run(j, render);
    stop_unwatch();
    return result;
}

static int render_one(job *j)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(NephScene) scene = load(j, &error);
    return scene ? render_scene(j, scene) : report_error(error);
}

/* ---- Many pictures ---- */

static void name_outputs(job *j)
{
    g_strfreev(j->outputs);
    j->outputs = g_new0(char *, g_strv_length(given.outputs) + 1);
    for (int i = 0; given.outputs[i]; i++)
        j->outputs[i] = frame_name(given.outputs[i], j->frame);
}

static bool is_finished(const job *j)
{
    bool are_there = true;
    for (char **path = j->outputs; *path; path++)
        are_there &= g_file_test(*path, G_FILE_TEST_EXISTS);
    return are_there;
}

/* A scene in which nothing moves is read once. */
static int render_frame(job *j, NephScene **scene)
{
    g_autoptr(GError) error = NULL;
    j->start = g_get_monotonic_time();
    if (*scene && neph_scene_is_animated(*scene))
        g_clear_pointer(scene, neph_scene_free);
    if (!*scene && (*scene = load(j, &error)))
        neph_scene_camera(*scene, &j->camera);
    if (!*scene || !frame_place(&j->frames, j->frame, &j->camera, *scene, &error))
        return report_error(error);
    return render_scene(j, *scene);
}

static int render_frames(job *j)
{
    NephScene *scene = NULL;
    int result = EXIT_DONE;
    for (j->frame = j->frames.first; j->frame <= j->frames.last && !result; j->frame++) {
        name_outputs(j);
        if (!is_finished(j))
            result = render_frame(j, &scene);
        else if (!given.quiet)
            tell("note", "frame %d is skipped: %s is there", j->frame, j->outputs[0]);
    }
    neph_scene_free(scene);
    return result;
}

int command_render(int argc, char **argv)
{
    int exit_code;
    if (!arguments_parse(&how, &argc, &argv, &exit_code))
        return exit_code;
    g_autoptr(GError) error = NULL;
    job j;
    int result = !job_init(&j, argv[1], &error) ? report_error(error)
                 : j.frames.are_asked           ? render_frames(&j)
                                                : render_one(&j);
    frames_clear(&j.frames);
    g_strfreev(j.outputs);
    return result;
}
