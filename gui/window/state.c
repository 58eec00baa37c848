#include "window/state.h"

#include <glib/gstdio.h>
#include <string.h>

#define GROUP "window"

const char *const theme_words[] = {"system", "light", "dark", NULL};

static char *state_file(void)
{
    return g_build_filename(g_get_user_config_dir(), "nephroid", "view.ini", NULL);
}

static int read_size(GKeyFile *file, const char *key, int usual)
{
    int value = g_key_file_get_integer(file, GROUP, key, NULL);
    return value >= 100 && value <= 32767 ? value : usual;
}

static bool read_flag(GKeyFile *file, const char *key, bool usual)
{
    g_autoptr(GError) error = NULL;
    bool value = g_key_file_get_boolean(file, GROUP, key, &error);
    return error ? usual : value;
}

window_state window_state_load(void)
{
    g_autofree char *path = state_file();
    g_autoptr(GKeyFile) file = g_key_file_new();
    g_key_file_load_from_file(file, path, G_KEY_FILE_NONE, NULL);
    g_autofree char *theme = g_key_file_get_string(file, GROUP, "theme", NULL);
    window_state state = {.width = read_size(file, "width", 1280),
                          .height = read_size(file, "height", 800),
                          .sidebar_width = read_size(file, "sidebar-width", 400),
                          .maximized = read_flag(file, "maximized", false),
                          .sidebar = read_flag(file, "sidebar", true)};
    for (int i = 0; i < N_THEMES && theme; i++)
        if (strcmp(theme, theme_words[i]) == 0)
            state.theme = (window_theme)i;
    return state;
}

void window_state_save(const window_state *state)
{
    g_autofree char *path = state_file();
    g_autofree char *folder = g_path_get_dirname(path);
    g_autoptr(GKeyFile) file = g_key_file_new();
    g_key_file_set_integer(file, GROUP, "width", state->width);
    g_key_file_set_integer(file, GROUP, "height", state->height);
    g_key_file_set_integer(file, GROUP, "sidebar-width", state->sidebar_width);
    g_key_file_set_boolean(file, GROUP, "maximized", state->maximized);
    g_key_file_set_boolean(file, GROUP, "sidebar", state->sidebar);
    g_key_file_set_string(file, GROUP, "theme", theme_words[state->theme]);
    g_mkdir_with_parents(folder, 0700);
    g_key_file_save_to_file(file, path, NULL);
}
