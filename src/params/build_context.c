#include "params/build_context.h"

static void unref_bytes(void *data)
{
    g_bytes_unref(data);
}

static GHashTable *name_table(GDestroyNotify free_value)
{
    return g_hash_table_new_full(g_str_hash, g_str_equal, g_free, free_value);
}

void build_context_init(build_context *context, const log_sink *log,
                        GDestroyNotify free_picture)
{
    *context = (build_context){
        .float_textures = name_table(NULL),
        .spectrum_textures = name_table(NULL),
        .materials = name_table(NULL),
        .files = name_table(unref_bytes),
        .pictures = name_table(free_picture),
    };
    if (log)
        context->log = *log;
}

void build_context_clear(build_context *context)
{
    g_hash_table_unref(context->float_textures);
    g_hash_table_unref(context->spectrum_textures);
    g_hash_table_unref(context->materials);
    g_hash_table_unref(context->files);
    g_hash_table_unref(context->pictures);
    *context = (build_context){.lenient = false};
}

void build_context_add_file(build_context *context, const char *path, GBytes *bytes)
{
    g_hash_table_insert(context->files, g_strdup(path), g_bytes_ref(bytes));
}

image *build_context_read_image(const build_context *context, const char *path,
                                const image_read_options *options, GError **error)
{
    GBytes *bytes = context ? g_hash_table_lookup(context->files, path) : NULL;
    if (bytes)
        return image_read_bytes(path, bytes, options, error);
    if (context)
        scene_sources_add(context->sources, path);
    return image_read(path, options, error);
}

bool build_is_lenient(const build_context *context, source_place place,
                      const char *format, ...)
{
    if (!context->lenient)
        return false;
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    log_message(&context->log, LOG_WARNING, "%s:%d:%d: %s", place.file ? place.file : "",
                place.line, place.column, text);
    return true;
}
