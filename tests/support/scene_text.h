/*
 * For tests that read scenes: a folder of small files that goes away with the test.
 */
#pragma once

#include "format/format.h"

#include <glib/gstdio.h>
#include <string.h>

typedef struct scene_folder {
    char *path;       /**< of the folder */
    char *main;       /**< of scene.pbrt in it */
    GPtrArray *files; /**< char*, absolute */
} scene_folder;

static inline void folder_write(scene_folder *f, const char *name, const char *data,
                                gssize size)
{
    char *path = g_build_filename(f->path, name, NULL);
    g_assert_true(
        g_file_set_contents_full(path, data, size, G_FILE_SET_CONTENTS_NONE, 0600, NULL));
    g_ptr_array_add(f->files, path);
}

static inline scene_folder folder_new(const char *text)
{
    scene_folder f = {.files = g_ptr_array_new_with_free_func(g_free)};
    f.path = g_dir_make_tmp("nephroid-scene-XXXXXX", NULL);
    f.main = g_build_filename(f.path, "scene.pbrt", NULL);
    folder_write(&f, "scene.pbrt", text, -1);
    return f;
}

static inline void folder_remove(scene_folder *f)
{
    for (guint i = 0; i < f->files->len; i++)
        g_unlink(f->files->pdata[i]);
    g_rmdir(f->path);
    g_ptr_array_unref(f->files);
    g_free(f->path);
    g_free(f->main);
}

/** Radiance of all environments arriving from direction d. */
static inline spectrum sky_at(const scene *s, vec3 d, const wavelengths *w)
{
    spectrum sum = {0};
    for (int i = 0; i < s->n_environments; i++) {
        const light *l = scene_light(s, s->environments[i]);
        sum += l->kind->environment(l->self, s->center, d, w);
    }
    return sum;
}

/** The view that a file describes; NULL with its error. */
static inline view *load_view(const char *path, const log_sink *log, GError **error)
{
    const load_options options = {.threads = 1, .log = log};
    return format_load_view(path, &options, error);
}

/** The view that a text, which must be right, describes of its scene. */
static inline view *view_of(const char *text)
{
    scene_folder f = folder_new(text);
    g_autoptr(GError) error = NULL;
    view *v = load_view(f.main, NULL, &error);
    if (!v)
        g_error("%s\nof\n%s", error->message, text);
    folder_remove(&f);
    return v;
}

/** The scene of a text that must be right. */
static inline scene *scene_of(const char *text)
{
    scene_folder f = folder_new(text);
    g_autoptr(GError) error = NULL;
    scene *s = format_load(f.main, 1, NULL, &error);
    if (!s)
        g_error("%s\nof\n%s", error->message, text);
    folder_remove(&f);
    return s;
}
