#include "format/convert/convert_files.h"

#include "base/input.h"
#include "scene/builder.h"

#include <errno.h>
#include <glib/gstdio.h>
#include <string.h>

void converted_files_init(converted_files *f, const char *out)
{
    const char *dot = strrchr(out, '.');
    g_autofree char *stem = g_strndup(out, dot ? (size_t)(dot - out) : strlen(out));
    *f = (converted_files){
        .directory = g_strconcat(stem, "-files", NULL),
        .names = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free),
        .outputs = g_ptr_array_new_with_free_func((GDestroyNotify)output_discard),
        .paths = g_ptr_array_new_with_free_func(g_free)};
    f->folder = g_path_get_basename(f->directory);
}

void converted_files_clear(converted_files *f)
{
    g_ptr_array_unref(f->outputs);
    g_ptr_array_unref(f->paths);
    if (f->made_folder)
        g_rmdir(f->directory); /* stays if anything is in it */
    g_free(f->directory);
    g_free(f->folder);
    g_hash_table_unref(f->names);
    g_clear_error(&f->error);
}

static bool make_folder(converted_files *f)
{
    if (g_file_test(f->directory, G_FILE_TEST_IS_DIR))
        return true;
    f->made_folder = g_mkdir_with_parents(f->directory, 0777) == 0;
    if (!f->made_folder)
        error_set(&f->error, ERROR_INPUT, "%s: cannot make this folder: %s", f->directory,
                  g_strerror(errno));
    return f->made_folder;
}

output *converted_files_open(converted_files *f, const char *name)
{
    if (f->error || !make_folder(f))
        return NULL;
    g_autofree char *path = g_build_filename(f->directory, name, NULL);
    return output_open(path, &f->error);
}

void converted_files_close(converted_files *f, const char *name, output *out)
{
    output_close(out, f->error ? NULL : &f->error);
    g_ptr_array_add(f->outputs, out);
    g_ptr_array_add(f->paths, g_build_filename(f->directory, name, NULL));
}

bool converted_files_commit(converted_files *f, GError **error)
{
    const char *const *sources = scene_sources_paths(f->builder->build.sources);
    bool done = true;
    for (guint i = 0; i < f->paths->len && done; i++)
        done = output_spares(f->paths->pdata[i], sources, error);
    while (done && f->outputs->len > 0)
        done = output_commit(g_ptr_array_steal_index_fast(f->outputs, 0), error);
    return done;
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
    GBytes *inside = g_hash_table_lookup(f->builder->build.files, path);
    if (inside)
        return g_bytes_ref(inside);
    return input_bytes(path, NULL);
}

const char *converted_files_copy(converted_files *f, const char *path)
{
    const char *known = g_hash_table_lookup(f->names, path);
    g_autoptr(GBytes) bytes = known ? NULL : bytes_of(f, path);
    if (!bytes)
        return known;
    char *name = free_name(f, path);
    g_autofree char *base = g_path_get_basename(name);
    output *out = converted_files_open(f, base);
    if (out) {
        fwrite(g_bytes_get_data(bytes, NULL), 1, g_bytes_get_size(bytes),
               output_stream(out));
        converted_files_close(f, base, out);
    }
    g_hash_table_insert(f->names, g_strdup(path), name);
    return name;
}
