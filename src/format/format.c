/*
 * The table of scene formats.
 */
#include "format/format.h"

#include "base/input.h"
#include "base/intern.h"
#include "base/wanted.h"
#include "format/reader.h"

#include <pthread.h>
#include <string.h>

static const format_reader *const readers[] = {
#define FORMAT(name) &name##_reader,
#include "format/format.def"
#undef FORMAT
};

/* A format that knows its files by what is in them; what may keep us waiting for bytes is
 * not asked. */
static const format_reader *recognise(const char *path)
{
    char bytes[512];
    const format_reader *found = NULL;
    size_t size = input_peek(path, bytes, sizeof bytes);
    for (size_t i = 0; i < G_N_ELEMENTS(readers) && !found; i++)
        if (readers[i]->recognises && readers[i]->recognises(bytes, size))
            found = readers[i];
    return found;
}

static const format_reader *find_reader(const char *path)
{
    const format_reader *by_content = recognise(path);
    if (by_content)
        return by_content;
    g_autofree char *name = g_ascii_strdown(path, -1);
    for (size_t i = 0; i < G_N_ELEMENTS(readers); i++)
        for (const char *const *e = readers[i]->extensions; *e; e++)
            if (g_str_has_suffix(name, *e))
                return readers[i];
    return NULL;
}

static const char *all_extensions[32];

static void list_extensions(void)
{
    size_t n = 0;
    for (size_t i = 0; i < G_N_ELEMENTS(readers); i++)
        for (const char *const *e = readers[i]->extensions; *e; e++) {
            g_assert(n + 1 < G_N_ELEMENTS(all_extensions));
            all_extensions[n++] = *e;
        }
}

const char *const *format_extensions(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, list_extensions);
    return all_extensions;
}

static void refuse(const char *path, GError **error)
{
    g_autoptr(GString) known = g_string_new(NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(readers); i++) {
        g_autofree char *extensions = g_strjoinv(", ", (char **)readers[i]->extensions);
        g_string_append_printf(known, "%s%s (%s)", i ? ", " : "", readers[i]->name,
                               extensions);
    }
    const char *dot = strrchr(path, '.');
    bool has_extension = dot && !strchr(dot, '/');
    error_at(error, (source_place){intern(path), 0, 0},
             "expected a scene file: %s, found %s; Blender, for one, makes glTF of most "
             "others",
             known->str, has_extension ? dot : "no extension");
}

/** In the dark a scene can be looked at all the same. */
static void warn_of_darkness(const scene *s, const char *path, const log_sink *log)
{
    if (!scene_is_lit(s))
        log_message(log, LOG_WARNING,
                    "%s: the scene has no light%s: its picture is black", path,
                    s->lights->len ? " but what is black" : "");
}

bool format_read(scene_builder *to, const char *path, GError **error)
{
    const format_reader *reader = find_reader(path);
    scene_sources_add(to->build.sources, path);
    if (reader)
        return reader->read(to, path, error);
    refuse(path, error);
    return false;
}

/** What is wrong in a file is told with its place. What only the whole scene can tell has
 * no line, and want of memory no file: the scene's is named. */
static scene *load(scene_builder *b, const char *path, unsigned threads, GError **error)
{
    GError *inner = NULL;
    bool read = format_read(b, path, &inner);
    scene *made = read ? scene_builder_commit(b, threads, &inner) : NULL;
    if (!still_wanted(NULL)) { /* whatever came of it */
        g_clear_pointer(&made, scene_free);
        g_clear_error(&inner);
        error_set(error, ERROR_CANCELLED, "%s: cancelled", path);
        return NULL;
    }
    if (made) {
        warn_of_darkness(made, path, &b->build.log);
        return made;
    }
    bool has_place = !read && g_error_matches(inner, NEPH_ERROR, ERROR_INPUT);
    if (!has_place && !strstr(inner->message, path))
        g_prefix_error(&inner, "%s: ", path);
    g_propagate_error(error, inner);
    return NULL;
}

scene_builder *format_builder(const load_options *options)
{
    scene_builder *b = scene_builder_new(options->log);
    b->build.lenient = options->lenient;
    b->build.sources = options->sources;
    b->build.cancel = options->cancel;
    b->thin_glass = options->thin_glass;
    b->at_time = options->at_time;
    b->time = options->time;
    return b;
}

scene *format_load_with(const char *path, const load_options *options, GError **error)
{
    g_autoptr(scene_builder) b = format_builder(options);
    return load(b, path, options->threads, error);
}

view *format_load_view(const char *path, const load_options *options, GError **error)
{
    g_autoptr(scene_builder) b = format_builder(options);
    scene *s = load(b, path, options->threads, error);
    return s ? scene_builder_view(b, s) : NULL;
}

scene *format_load(const char *path, unsigned threads, const log_sink *log,
                   GError **error)
{
    const load_options options = {.threads = threads, .log = log};
    return format_load_with(path, &options, error);
}
