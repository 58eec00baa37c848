#include "settings/presets.h"

#include "settings/presets_places.h"

#include <string.h>

#define ENDING ".settings"

/* Where they are installed, or else where the program was built from. */
static const char *folder(void)
{
    bool installed = g_file_test(PRESETS_INSTALLED, G_FILE_TEST_IS_DIR);
    return installed ? PRESETS_INSTALLED : PRESETS_SOURCE;
}

static int by_name(gconstpointer a, gconstpointer b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

GStrv settings_presets(void)
{
    g_autoptr(GDir) dir = g_dir_open(folder(), 0, NULL);
    GPtrArray *names = g_ptr_array_new();
    for (const char *file; dir && (file = g_dir_read_name(dir));)
        if (g_str_has_suffix(file, ENDING) && *file != '.')
            g_ptr_array_add(names, g_strndup(file, strlen(file) - strlen(ENDING)));
    g_ptr_array_sort(names, by_name);
    g_ptr_array_add(names, NULL);
    return (GStrv)g_ptr_array_free(names, FALSE);
}

/* Owned by the caller; NULL with an error if there is no such preset. */
static char *path_of(const char *name, GError **error)
{
    g_auto(GStrv) names = settings_presets();
    if (g_strv_contains((const char *const *)names, name)) {
        g_autofree char *file = g_strconcat(name, ENDING, NULL);
        return g_build_filename(folder(), file, NULL);
    }
    g_autofree char *list = g_strjoinv(", ", names);
    if (*list)
        error_set(error, ERROR_USAGE, "expected a preset's name (%s), found '%s'", list,
                  name);
    else
        error_set(error, ERROR_USAGE, "there are no presets in %s", folder());
    return NULL;
}

char *settings_preset_text(const char *name, GError **error)
{
    g_autofree char *path = path_of(name, error);
    g_autoptr(GError) inner = NULL;
    char *text = NULL;
    if (!path)
        return NULL;
    if (!g_file_get_contents(path, &text, NULL, &inner))
        error_set(error, ERROR_INPUT, "cannot read preset %s: %s", name, inner->message);
    return text;
}

bool settings_load_preset(settings *s, const char *name, GError **error)
{
    g_autofree char *path = path_of(name, error);
    return path && settings_load(s, path, error);
}
