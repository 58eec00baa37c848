#include "api/objects.h"

#include "api/asking.h"
#include "base/wanted.h"
#include "format/convert/convert.h"
#include "format/format.h"

#include <string.h>

/* Beyond it the film alone would not fit into any machine. */
enum { LARGEST_SIDE = 65536 };

static void forward_log(log_level level, const char *text, void *data)
{
    const NephScene *s = data;
    if (s->log)
        s->log(level == LOG_WARNING ? NEPH_LOG_WARNING : NEPH_LOG_NOTE, text,
               s->log_data);
}

const char *const *neph_scene_extensions(void)
{
    return format_extensions();
}

NephScene *neph_scene_load_with(const char *path, const NephLoadOptions *options,
                                GError **error)
{
    NephScene *s = g_new(NephScene, 1);
    *s = (NephScene){.lenient = options->lenient,
                     .thin_glass = options->thin_glass,
                     .at_time = options->at_time,
                     .time = options->at_time ? options->time : 0.0,
                     .log = options->log,
                     .log_data = options->log_data};
    const log_sink sink = {forward_log, s};
    asking a;
    s->sources = scene_sources_new(options->file, options->file_data);
    const load_options how = {.threads = options->threads,
                              .lenient = options->lenient,
                              .thin_glass = options->thin_glass,
                              .at_time = s->at_time,
                              .time = s->time,
                              .log = &sink,
                              .sources = s->sources,
                              .cancel =
                                  asking_begin(&a, options->go_on, options->go_on_data)};
    const cancel_flag *before = wanted_by(how.cancel);
    s->view = format_load_view(path, &how, error);
    wanted_by(before);
    if (s->view)
        s->scene = s->view->scene;
    else
        g_clear_pointer(&s, neph_scene_free);
    return s;
}

NephScene *neph_scene_load(const char *path, unsigned threads, NephLogFunc log,
                           void *log_data, GError **error)
{
    const NephLoadOptions options = {
        .threads = threads, .log = log, .log_data = log_data};
    return neph_scene_load_with(path, &options, error);
}

bool neph_scene_convert_with(const char *in, const char *out,
                             const NephLoadOptions *options, GError **error)
{
    NephScene to = {.log = options->log, .log_data = options->log_data};
    const log_sink sink = {forward_log, &to};
    scene_sources *sources = scene_sources_new(options->file, options->file_data);
    asking a;
    const load_options how = {.lenient = options->lenient,
                              .thin_glass = options->thin_glass,
                              .log = &sink,
                              .sources = sources,
                              .cancel =
                                  asking_begin(&a, options->go_on, options->go_on_data)};
    const cancel_flag *before = wanted_by(how.cancel);
    bool done = format_convert(in, out, &how, error);
    wanted_by(before);
    scene_sources_free(sources);
    return done;
}

bool neph_scene_convert(const char *in, const char *out, NephLogFunc log, void *log_data,
                        GError **error)
{
    const NephLoadOptions options = {.log = log, .log_data = log_data};
    return neph_scene_convert_with(in, out, &options, error);
}

void neph_scene_free(NephScene *s)
{
    if (!s)
        return;
    if (!s->shares)
        scene_sources_free(s->sources);
    view_free(s->view);
    g_free(s);
}

NephScene *neph_scene_share(const NephScene *s)
{
    NephScene *other = g_new(NephScene, 1);
    *other = (NephScene){.view = view_share(s->view),
                         .scene = s->scene,
                         .sources = s->sources,
                         .shares = true,
                         .lenient = s->lenient,
                         .thin_glass = s->thin_glass,
                         .at_time = s->at_time,
                         .time = s->time,
                         .log = s->log,
                         .log_data = s->log_data};
    return other;
}

NephSettings *neph_scene_settings(const NephScene *s)
{
    NephSettings *copy = g_new(NephSettings, 1);
    copy->values = s->scene->settings;
    return copy;
}

bool neph_scene_is_animated(const NephScene *s)
{
    return s->scene->is_animated;
}

void neph_scene_size(const NephScene *s, int *width, int *height)
{
    *width = s->view->film.width;
    *height = s->view->film.height;
}

bool neph_scene_resize(NephScene *s, int width, int height, GError **error)
{
    if (width < 1 || height < 1 || width > LARGEST_SIDE || height > LARGEST_SIDE) {
        error_set(error, ERROR_USAGE, "size %dx%d: expected 1 to %d pixels a side", width,
                  height, LARGEST_SIDE);
        return false;
    }
    view_resize(s->view, width, height);
    return true;
}

const char *const *neph_scene_files(const NephScene *s)
{
    return scene_sources_paths(s->sources);
}

bool neph_scene_says_exposure(const NephScene *s)
{
    return !s->view->film.is_unexposed;
}

const char *neph_scene_output(const NephScene *s)
{
    const char *name = s->view->film.filename;
    const char *slash = name ? strrchr(name, '/') : NULL;
    return slash ? slash + 1 : name;
}
