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
#include "options.h"
#include "progress.h"
#include "report.h"
#include "snapshots.h"
#include "stop.h"

#include <math.h>
#include <string.h>

enum { USUAL_PASSES = 16 };

/* What the options mean, checked. */
typedef struct job {
    const render_options *given;
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
    } rest[] = {{"--every", j->given->every},
                {"--checkpoint", j->given->checkpoint},
                {"--resume", j->given->resume},
                {"--layer", j->given->layers},
                {"--stats", j->given->stats}};
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

static bool job_init(job *j, const render_options *given, const char *scene_file,
                     GError **error)
{
    double exposure = 0.0;
    *j = (job){.given = given,
               .scene_file = scene_file,
               .outputs = g_strdupv(given->outputs),
               .start = program_start};
    bool good = (!given->size ||
                 argument_size("--size", given->size, &j->width, &j->height, error)) &&
                (!given->exposure ||
                 argument_real("--exposure", given->exposure, &exposure, error)) &&
                snapshots_init(&j->snapshots, given->every, error) &&
                checkpoints_init(&j->checkpoints, given->checkpoint,
                                 given->checkpoint_every, error) &&
                overrides_check(&given->settings, &j->threads, error) &&
                frames_init(&j->frames, given->frame, given->fps, given->camera,
                            given->grain, error) &&
                check_frames(j, error) && check_outputs(j->outputs, error) &&
                layers_check(given->layers, error) &&
                (!given->stats || neph_file_can_write(given->stats, error));
    j->exposure = (exposure_wish){.stops = (float)exposure, .no_notes = given->quiet};
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
    if (j->given->settings.file)
        g_strv_builder_add(builder, j->given->settings.file);
    if (j->given->photons)
        g_strv_builder_add(builder, j->given->photons);
    g_auto(GStrv) inputs = g_strv_builder_end(builder);
    const char *const *others = (const char *const *)inputs;
    for (char **path = j->outputs; *path; path++) {
        const char *const *rest = (const char *const *)path + 1;
        const char *const text[] = {j->given->stats ? j->given->stats
                                                    : j->given->checkpoint,
                                    j->given->checkpoint, NULL};
        if (!neph_file_spares(*path, others, error) ||
            !neph_file_spares(*path, rest, error) ||
            !neph_file_spares(*path, text, error))
            return false;
    }
    for (char **word = j->given->layers; word && *word; word++)
        if (!neph_file_spares(layer_file(*word), others, error) ||
            !neph_file_spares(layer_file(*word), (const char *const *)j->outputs, error))
            return false;
    const char *const checkpoint[] = {j->given->checkpoint, NULL};
    return (!j->given->stats || (neph_file_spares(j->given->stats, others, error) &&
                                 neph_file_spares(j->given->stats, checkpoint, error))) &&
           (!j->given->checkpoint ||
            neph_file_spares(j->given->checkpoint, others, error));
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
    return j->given->photons && j->frames.are_asked &&
           !g_file_test(j->given->photons, G_FILE_TEST_EXISTS);
}

static bool make_photons(const job *j, const NephScene *scene,
                         const NephSettings *settings, GError **error)
{
    if (j->given->photons && j->frames.are_asked && neph_scene_is_animated(scene)) {
        g_set_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_USAGE,
                    "--photons: expected a still scene for many frames, this one moves");
        return false;
    }
    if (!makes_photons(j))
        return true;
    g_autofree char *passes = neph_settings_get(settings, "passes");
    const int64_t n = (int64_t)ceil(g_ascii_strtod(passes, NULL));
    const NephSaveOptions options = {.passes = n > 0 ? n : USUAL_PASSES};
    if (!neph_photons_save(scene, settings, j->given->photons, &options, error))
        return false;
    if (!j->given->quiet)
        print_result("wrote %s\n", j->given->photons);
    return true;
}

/* The scene's, or those of the render that goes on, with the size of its picture. */
static NephSettings *settings_before(job *j, const NephScene *scene, GError **error)
{
    int width, height;
    if (!j->given->resume)
        return j->given->photons && !makes_photons(j)
                   ? neph_photons_settings(j->given->photons, NULL, error)
                   : neph_scene_settings(scene);
    NephSettings *settings =
        neph_checkpoint_settings(j->given->resume, &width, &height, error);
    if (settings && !j->width) {
        j->width = width;
        j->height = height;
    }
    return settings;
}

static bool resume(job *j, NephRender *render, GError **error)
{
    NephStatistics s;
    if (!j->given->resume)
        return true;
    if (!neph_render_resume(render, j->given->resume, error))
        return false;
    neph_render_statistics(render, &s);
    if (!j->given->quiet)
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
    if (settings && overrides_apply(&j->given->settings, settings, error) &&
        set_grain(j, settings, error) &&
        (!j->width || neph_scene_resize(scene, j->width, j->height, error)) &&
        make_photons(j, scene, settings, error) && choose_outputs(j, scene, error))
        render = neph_render_new(scene, settings, error);
    if (render && ((j->given->photons &&
                    !neph_render_use_photons(render, j->given->photons, error)) ||
                   !resume(j, render, error)))
        g_clear_pointer(&render, neph_render_free);
    if (render && !j->given->quiet)
        overrides_tell_unread(&j->given->settings, settings);
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
        else if (!is_snapshot && !j->given->quiet)
            report_written(image, *path);
    }
    if (!layers_write(j->given->layers, image, stops, &error))
        result = report_error(error);
    for (char **word = j->given->layers; !result && word && *word; word++)
        if (!is_snapshot && !j->given->quiet)
            print_result("wrote %s\n", layer_file(*word));
    return result;
}

/* Before anything is rendered. */
static bool check_layers(const job *j, const NephRender *render, GError **error)
{
    g_autoptr(NephImage) image =
        j->given->layers ? neph_render_image(render, error) : NULL;
    return !j->given->layers || (image && layers_known(j->given->layers, image, error));
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

static int run(job *j, NephRender *render)
{
    g_autoptr(GError) error = NULL;
    int ended = EXIT_DONE;
    watch w = {j, render, progress_begin(j->given->quiet)};
    /* All counts that is done from the program's start, or the frame's, to its end. */
    double before = (double)(g_get_monotonic_time() - j->start) / G_USEC_PER_SEC;
    neph_render_set_time_around(render, before, (const char *const *)j->outputs);
    if (!check_layers(j, render, &error))
        return report_error(error);
    if (j->given->explain && (ended = report_plan(render)) != EXIT_DONE)
        return ended;
    bool done = neph_render_run(render, look_on, &w, &error);
    progress_end(&w.shown);
    if (!done && j->frames.are_asked)
        return report_unfinished(j->frame, error);
    if (!done && !report_end(render, error, &ended))
        return ended;
    if (!j->given->quiet)
        report_time(render);
    int images = write_images(j, render, false);
    if (!ended && !images)
        report_done(render, &w.shown);
    int statistics = report_statistics(render, j->given->stats, j->given->quiet);
    int checkpoint = checkpoints_end(&j->checkpoints, render);
    return ended ? ended : images ? images : statistics ? statistics : checkpoint;
}

static NephScene *load(job *j, GError **error)
{
    NephLoadOptions options = loading_options(j->threads, j->given->quiet);
    options.at_time = j->frames.are_asked;
    options.time = j->frames.are_asked ? frame_time(&j->frames, j->frame) : 0.0;
    NephScene *scene = neph_scene_load_with(j->scene_file, &options, error);
    if (scene)
        j->exposure.is_free = !j->given->exposure && !neph_scene_says_exposure(scene);
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
    j->outputs = g_new0(char *, g_strv_length(j->given->outputs) + 1);
    for (int i = 0; j->given->outputs[i]; i++)
        j->outputs[i] = frame_name(j->given->outputs[i], j->frame);
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
        else if (!j->given->quiet)
            tell("note", "frame %d is skipped: %s is there", j->frame, j->outputs[0]);
    }
    neph_scene_free(scene);
    return result;
}

int command_render(int argc, char **argv)
{
    int exit_code;
    const render_options *given = render_options_parse(&argc, &argv, &exit_code);
    if (!given)
        return exit_code;
    g_autoptr(GError) error = NULL;
    job j;
    int result = !job_init(&j, given, argv[1], &error) ? report_error(error)
                 : j.frames.are_asked                  ? render_frames(&j)
                                                       : render_one(&j);
    frames_clear(&j.frames);
    g_strfreev(j.outputs);
    return result;
}
