#include "format/convert_files.h"

#include "scene/scene.h"

#include <errno.h>
#include <glib/gstdio.h>
#include <string.h>

void converted_files_init(converted_files *f, const char *out)
{
    const char *dot = strrchr(out, '.');
    g_autofree char *stem = g_strndup(out, dot ? (size_t)(dot - out) : strlen(out));
    *f = (converted_files){
        .directory = g_strconcat(stem, "-files", NULL),
        .names = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free)};
    f->folder = g_path_get_basename(f->directory);
}

void converted_files_clear(converted_files *f)
{
    g_free(f->directory);
    g_free(f->folder);
    g_hash_table_unref(f->names);
    g_clear_error(&f->error);
}

bool converted_files_folder(converted_files *f)
{
    if (f->error || g_mkdir_with_parents(f->directory, 0777) == 0)
        return !f->error;
    error_set(&f->error, ERROR_INPUT, "%s: cannot make this folder: %s", f->directory,
              g_strerror(errno));
    return false;
}

/* A name that no other file here has. */
static char *free_name(converted_files *f, const char *path)
{
    g_autofree char *base = g_path_get_basename(path);
    char *name = g_strdup_printf("%s/%s", f->folder, base);
    GHashTableIter iter;
    gpointer value;
    g_hash_table_iter_init(&iter, f->names);
    while (g_hash_table_iter_next(&iter, NULL, &value))
        if (strcmp(value, name) == 0) {
            g_free(name);
            return g_strdup_printf("%s/%u-%s", f->folder, g_hash_table_size(f->names),
                                   base);
        }
    return name;
}

static GBytes *bytes_of(converted_files *f, const char *path)
{
    char *data;
    gsize size;
    GBytes *inside = g_hash_table_lookup(f->scene->files, path);
    if (inside)
        return g_bytes_ref(inside);
    return g_file_get_contents(path, &data, &size, NULL) ? g_bytes_new_take(data, size)
                                                         : NULL;
}

const char *converted_files_copy(converted_files *f, const char *path)
{
    const char *known = g_hash_table_lookup(f->names, path);
    g_autoptr(GBytes) bytes = known ? NULL : bytes_of(f, path);
    if (!bytes || !converted_files_folder(f))
        return known;
    char *name = free_name(f, path);
    g_autofree char *base = g_path_get_basename(name);
    g_autofree char *to = g_build_filename(f->directory, base, NULL);
    g_autoptr(GError) inner = NULL;
    if (!g_file_set_contents_full(to, g_bytes_get_data(bytes, NULL),
                                  (gssize)g_bytes_get_size(bytes),
                                  G_FILE_SET_CONTENTS_CONSISTENT, 0666, &inner))
        error_set(&f->error, ERROR_FAILED, "%s", inner->message);
    g_hash_table_insert(f->names, g_strdup(path), name);
    return name;
}
