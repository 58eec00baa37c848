#include "files/document.h"

#include <string.h>

/* Editors write in steps; what is read after this pause is whole, ms. */
enum { SETTLE_MS = 300, MOST_RECENT = 8 };

struct document {
    char *path;
    GHashTable *monitors; /* path -> GFileMonitor* */
    guint settle;
    void (*changed)(void *data);
    void *data;
};

static gboolean settled(void *data)
{
    document *d = data;
    d->settle = 0;
    d->changed(d->data);
    return G_SOURCE_REMOVE;
}

static void file_changed(document *d, GFile *file, GFile *other, GFileMonitorEvent event)
{
    (void)file, (void)other;
    if (event == G_FILE_MONITOR_EVENT_DELETED ||
        event == G_FILE_MONITOR_EVENT_ATTRIBUTE_CHANGED)
        return;
    if (d->settle)
        g_source_remove(d->settle);
    d->settle = g_timeout_add(SETTLE_MS, settled, d);
}

static void stop_monitor(void *monitor)
{
    g_file_monitor_cancel(monitor);
    g_object_unref(monitor);
}

/* A monitor that was cancelled tells nothing any more. */
static void stop_watching(document *d)
{
    g_hash_table_remove_all(d->monitors);
    g_clear_handle_id(&d->settle, g_source_remove);
}

static void watch(document *d, const char *path)
{
    if (g_hash_table_contains(d->monitors, path))
        return;
    g_autoptr(GFile) file = g_file_new_for_path(path);
    GFileMonitor *monitor = g_file_monitor_file(file, G_FILE_MONITOR_NONE, NULL, NULL);
    if (!monitor)
        return;
    g_signal_connect_swapped(monitor, "changed", G_CALLBACK(file_changed), d);
    g_hash_table_insert(d->monitors, g_strdup(path), monitor);
}

document *document_new(void (*changed)(void *data), void *data)
{
    document *d = g_new0(document, 1);
    d->changed = changed;
    d->data = data;
    d->monitors = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, stop_monitor);
    return d;
}

void document_free(document *d)
{
    if (!d)
        return;
    stop_watching(d);
    g_hash_table_unref(d->monitors);
    g_free(d->path);
    g_free(d);
}

void document_set_path(document *d, const char *path)
{
    g_autofree char *own = g_strdup(path);
    stop_watching(d);
    g_free(d->path);
    d->path = g_steal_pointer(&own);
    watch(d, d->path);
}

void document_watch(document *d, const char *const *paths)
{
    for (; *paths; paths++)
        watch(d, *paths);
}

const char *document_path(const document *d)
{
    return d->path;
}

/* ---- Lists of scenes ---- */

void document_remember(document *d)
{
    g_autoptr(GFile) file = g_file_new_for_path(d->path);
    g_autofree char *uri = g_file_get_uri(file);
    char name[] = "Nephroid", command[] = "nephroid-view %f", mime[] = "text/plain";
    char *groups[] = {name, NULL};
    GtkRecentData entry = {
        .mime_type = mime, .app_name = name, .app_exec = command, .groups = groups};
    gtk_recent_manager_add_full(gtk_recent_manager_get_default(), uri, &entry);
}

static int newer_first(gconstpointer a, gconstpointer b)
{
    GDateTime *x = gtk_recent_info_get_modified((GtkRecentInfo *)a);
    GDateTime *y = gtk_recent_info_get_modified((GtkRecentInfo *)b);
    return g_date_time_compare(y, x);
}

char **document_recent(void)
{
    g_autoptr(GStrvBuilder) paths = g_strv_builder_new();
    GList *items = gtk_recent_manager_get_items(gtk_recent_manager_get_default());
    int n = 0;
    items = g_list_sort(items, newer_first);
    for (GList *item = items; item && n < MOST_RECENT; item = item->next) {
        if (!gtk_recent_info_has_group(item->data, "Nephroid"))
            continue;
        g_autofree char *path =
            g_filename_from_uri(gtk_recent_info_get_uri(item->data), NULL, NULL);
        if (path && g_file_test(path, G_FILE_TEST_EXISTS)) {
            g_strv_builder_add(paths, path);
            n++;
        }
    }
    g_list_free_full(items, (GDestroyNotify)gtk_recent_info_unref);
    return g_strv_builder_end(paths);
}

static char *examples_folder(void)
{
    static const char *const folders[] = {INSTALLED_SCENES, SOURCE_SCENES};
    for (size_t i = 0; i < G_N_ELEMENTS(folders); i++)
        if (g_file_test(folders[i], G_FILE_TEST_IS_DIR))
            return g_strdup(folders[i]);
    return NULL;
}

static int by_name(gconstpointer a, gconstpointer b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Adds FOLDER/NAME/NAME.pbrt. */
static void add_example(GPtrArray *paths, const char *folder, const char *name)
{
    g_autofree char *base = g_strconcat(name, ".pbrt", NULL);
    g_autofree char *path = g_build_filename(folder, name, base, NULL);
    if (g_file_test(path, G_FILE_TEST_EXISTS))
        g_ptr_array_add(paths, g_steal_pointer(&path));
}

char **document_examples(void)
{
    g_autofree char *folder = examples_folder();
    g_autoptr(GDir) dir = folder ? g_dir_open(folder, 0, NULL) : NULL;
    GPtrArray *paths = g_ptr_array_new();
    for (const char *name; dir && (name = g_dir_read_name(dir));)
        add_example(paths, folder, name);
    g_ptr_array_sort(paths, by_name);
    g_ptr_array_add(paths, NULL);
    return (char **)g_ptr_array_free(paths, FALSE);
}

char *document_folder(const document *d)
{
    return d->path ? g_path_get_dirname(d->path) : NULL;
}
