/*
 * What all parts of the reader ask of the file: elements by their index, extensions, and
 * where to tell what is wrong.
 */
#include "format/gltf/gltf.h"

#include "base/intern.h"

#include <string.h>

params *gltf_params(const gltf *g)
{
    return params_new((source_place){intern(g->path), 0, 0}, g->directory,
                      color_space_srgb());
}

void gltf_note(gltf *g, log_level level, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    char *text = g_strdup_vprintf(format, args);
    va_end(args);
    if (!g_hash_table_contains(g->notes, text))
        log_message(&g->builder->build.log, level, "%s: %s", g->path, text);
    g_hash_table_add(g->notes, text);
}

void gltf_take_error(gltf *g, const json_value *at, GError *error)
{
    if (!error)
        return;
    if (g->json.error) {
        g_error_free(error);
        return;
    }
    g_autofree char *path = json_path(at);
    g_autofree char *before = g_strdup_printf("%s: ", g->path);
    const char *text = error->message;
    text += g_str_has_prefix(text, before) ? strlen(before) : 0;
    error_set(&g->json.error, (error_code)error->code, "%s%s: %s", before, path, text);
    g_error_free(error);
}

json_value gltf_refer(gltf *g, const json_value *of, const char *key, const char *name,
                      json_value *array, gint64 *index)
{
    *index = json_whole(of, key, GLTF_MOST);
    *array = json_member(&g->root, name);
    if (*index < 0)
        return (json_value){.reader = &g->json, .parent = array};
    if ((guint64)*index < json_length(array))
        return json_element(array, (guint)*index);
    json_fail(of, "\"%s\" %d: there are only %u %s", key, (int)*index, json_length(array),
              name);
    return (json_value){.reader = &g->json, .parent = array};
}

json_value gltf_extension(const json_value *v, const char *name, json_value *extensions)
{
    *extensions = json_member(v, "extensions");
    return json_member(extensions, name);
}
