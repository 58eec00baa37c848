/*
 * What an OBJ file names and what its MTL files define are read side by side, line by
 * line; all else in them is the importer's. A name is the rest of its line. Where a file
 * of materials is missing the one named like the OBJ file is taken.
 */
#include "format/model/obj_materials.h"

#include "base/input.h"
#include "format/model/importer.h"

#include <string.h>

enum { MOST_NAMED = 10 }; /* missing materials that are told one by one */

typedef struct obj_names {
    scene_builder *builder;
    const char *path;
    char *directory;
    GHashTable *files, *defined, *used; /* char* */
    GPtrArray *in_order;                /* those used; borrowed */
    GArray *found;                      /* import_file */
} obj_names;

/* ---- Lines ---- */

typedef void (*line_func)(obj_names *names, const char *line, size_t length);

/* What follows a word at the start of a line, without blanks around it; NULL if the line
 * begins otherwise, or nothing follows. */
static char *after(const char *word, const char *line, size_t length)
{
    size_t n = strlen(word);
    if (length <= n || memcmp(line, word, n) != 0 || !g_ascii_isspace(line[n]))
        return NULL;
    char *rest = g_strstrip(g_strndup(line + n, length - n));
    if (!*rest)
        g_clear_pointer(&rest, g_free);
    return rest;
}

static bool each_line(obj_names *names, const char *path, line_func told)
{
    input in;
    if (!input_read(&in, path, NULL))
        return false;
    const char *at = in.data, *end = in.data + in.size;
    while (at < end) {
        const char *stop = memchr(at, '\n', (size_t)(end - at));
        stop = stop ? stop : end;
        while (at < stop && (*at == ' ' || *at == '\t'))
            at++;
        told(names, at, (size_t)(stop - at));
        at = stop + 1;
    }
    input_close(&in);
    return true;
}

/* ---- Names ---- */

static void note_definition(obj_names *names, const char *line, size_t length)
{
    char *name = after("newmtl", line, length);
    if (name)
        g_hash_table_add(names->defined, name);
}

static char *own_library(const obj_names *names)
{
    g_autofree char *base = g_path_get_basename(names->path);
    char *dot = strrchr(base, '.');
    if (dot)
        *dot = '\0';
    g_autofree char *name = g_strconcat(base, ".mtl", NULL);
    return g_build_filename(names->directory, name, NULL);
}

static void read_library(obj_names *names, const char *name)
{
    if (g_hash_table_contains(names->files, name))
        return;
    g_hash_table_add(names->files, g_strdup(name));
    if (names->found->len == MOST_IMPORT_FILES) {
        log_message(&names->builder->build.log, LOG_WARNING,
                    "%s: it names more than %d files of materials: '%s' is left out",
                    names->path, MOST_IMPORT_FILES, name);
        return;
    }
    g_autofree char *path = g_canonicalize_filename(name, names->directory);
    g_autofree char *own = own_library(names);
    scene_sources_add(names->builder->build.sources, path);
    bool found = each_line(names, path, note_definition);
    bool has_own = !found && each_line(names, own, note_definition);
    if (found || has_own) {
        const import_file file = {g_strdup(name), g_strdup(found ? path : own)};
        g_array_append_val(names->found, file);
    }
    if (found)
        return;
    g_autofree char *instead =
        has_own ? g_path_get_basename(own) : g_strdup("grey materials");
    log_message(&names->builder->build.log, LOG_WARNING,
                "%s: its file of materials '%s' (mtllib) can not be read: %s instead",
                names->path, name, instead);
}

static void note_line(obj_names *names, const char *line, size_t length)
{
    g_autofree char *library = after("mtllib", line, length);
    char *used = after("usemtl", line, length);
    if (library)
        read_library(names, library);
    if (used && !g_hash_table_contains(names->used, used)) {
        g_hash_table_add(names->used, used);
        g_ptr_array_add(names->in_order, used);
        used = NULL;
    }
    g_free(used);
}

static void tell_missing(const obj_names *names)
{
    const log_sink *log = &names->builder->build.log;
    guint n_missing = 0;
    if (g_hash_table_size(names->files) == 0 && names->in_order->len > 0)
        log_message(log, LOG_WARNING,
                    "%s: it names materials (usemtl) and no file of them (mtllib): they "
                    "are grey",
                    names->path);
    for (guint i = 0; i < names->in_order->len && names->found->len > 0; i++) {
        const char *name = names->in_order->pdata[i];
        if (g_hash_table_contains(names->defined, name) || ++n_missing > MOST_NAMED)
            continue;
        log_message(log, LOG_WARNING,
                    "%s: material '%s' (usemtl) is in none of its files of materials: "
                    "it is grey",
                    names->path, name);
    }
    if (n_missing > MOST_NAMED)
        log_message(log, LOG_WARNING, "%s: %u more materials are missing", names->path,
                    n_missing - MOST_NAMED);
}

static GHashTable *names_new(void)
{
    return g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
}

static void clear_file(void *data)
{
    const import_file *file = data;
    g_free((char *)file->name);
    g_free((char *)file->path);
}

GArray *obj_material_files(scene_builder *to, const char *path)
{
    g_autofree char *absolute = g_canonicalize_filename(path, NULL);
    g_autofree char *directory = g_path_get_dirname(absolute);
    obj_names names = {.builder = to,
                       .path = path,
                       .directory = directory,
                       .files = names_new(),
                       .defined = names_new(),
                       .used = names_new(),
                       .in_order = g_ptr_array_new(),
                       .found = g_array_new(FALSE, FALSE, sizeof(import_file))};
    g_array_set_clear_func(names.found, clear_file);
    each_line(&names, path, note_line);
    tell_missing(&names);
    g_hash_table_unref(names.files);
    g_hash_table_unref(names.defined);
    g_hash_table_unref(names.used);
    g_ptr_array_unref(names.in_order);
    return names.found;
}
