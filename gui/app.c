#include "app.h"

#include "window.h"

#include <nephroid/nephroid.h>

#define APP_ID "org.nephroid.View"

static const char style[] =
    ".canvas { background-color: #1a1a1c; }\n"
    ".canvas:focus-visible { outline: 2px solid alpha(@accent_color, 0.7);"
    " outline-offset: -2px; }\n"
    ".statusbar-line { padding: 5px 12px; }\n"
    ".numeric { font-feature-settings: \"tnum\"; }\n"
    ".group > row { padding: 4px 4px 4px 12px; min-height: 38px; }\n"
    ".group { border-radius: 10px; }\n"
    ".group > row:first-child { border-radius: 10px 10px 0 0; }\n"
    ".group > row:last-child { border-radius: 0 0 10px 10px; }\n"
    ".reset { min-width: 24px; min-height: 24px; padding: 2px; }\n"
    ".heading { font-weight: bold; }\n"
    ".title-1 { font-weight: 800; font-size: 20pt; }\n"
    ".title-2 { font-weight: 800; font-size: 15pt; }\n"
    ".pill { border-radius: 9999px; padding: 8px 28px; }\n"
    ".source { font-family: monospace; padding: 8px; }\n"
    ".toast { background-color: #303030; color: #ffffff; border-radius: 9999px;"
    " padding: 8px 20px; margin: 24px; }\n";

static void load_style(void)
{
    g_autoptr(GtkCssProvider) provider = gtk_css_provider_new();
    gtk_css_provider_load_from_data(provider, style, -1);
    gtk_style_context_add_provider_for_display(gdk_display_get_default(),
                                               GTK_STYLE_PROVIDER(provider),
                                               GTK_STYLE_PROVIDER_PRIORITY_APPLICATION);
}

static void about(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    gtk_show_about_dialog(gtk_application_get_active_window(data), "program-name",
                          "Nephroid", "version", neph_version(), "comments",
                          "Renders scenes by photon mapping, and shows the photons.",
                          "logo-icon-name", APP_ID, "license-type", GTK_LICENSE_MIT_X11,
                          NULL);
}

static void quit(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    GList *windows = g_list_copy(gtk_application_get_windows(data));
    for (GList *w = windows; w; w = w->next)
        gtk_window_close(w->data);
    g_list_free(windows);
}

static const GActionEntry entries[] = {{.name = "about", .activate = about},
                                       {.name = "quit", .activate = quit}};

static void add_keys(GtkApplication *app)
{
    static const char *const keys[][3] = {
        {"app.quit", "<Control>q", NULL},
        {"win.open", "<Control>o", NULL},
        {"win.reload", "<Control>r", NULL},
        {"win.save-picture", "<Control>s", NULL},
        {"win.play", "space", NULL},
        {"win.stop", "<Control>period", NULL},
        {"win.restart", "F5", NULL},
        {"win.zoom-fit", "<Control>0", NULL},
        {"win.zoom-one", "<Control>1", NULL},
        {"win.zoom-in", "<Control>plus", "<Control>equal"},
        {"win.zoom-out", "<Control>minus", NULL},
        {"win.sidebar", "F9", NULL},
        {"win.search", "<Control>f", NULL},
        {"win.fullscreen", "F11", NULL},
        {"window.close", "<Control>w", NULL},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(keys); i++) {
        const char *accels[] = {keys[i][1], keys[i][2], NULL};
        gtk_application_set_accels_for_action(app, keys[i][0], accels);
    }
}

static void startup(GtkApplication *app)
{
    gtk_window_set_default_icon_name(APP_ID);
    g_action_map_add_action_entries(G_ACTION_MAP(app), entries, G_N_ELEMENTS(entries),
                                    app);
    add_keys(app);
    load_style();
}

static void activate(GtkApplication *app)
{
    gtk_window_present(window_gtk(window_new(app)));
}

static void open_files(GtkApplication *app, GFile **files, int n)
{
    for (int i = 0; i < n; i++) {
        g_autofree char *path = g_file_get_path(files[i]);
        window *w = window_new(app);
        gtk_window_present(window_gtk(w));
        if (path)
            window_open(w, path);
    }
}

GtkApplication *app_new(void)
{
    GtkApplication *app = gtk_application_new(APP_ID, G_APPLICATION_HANDLES_OPEN |
                                                          G_APPLICATION_NON_UNIQUE);
    g_signal_connect(app, "startup", G_CALLBACK(startup), NULL);
    g_signal_connect(app, "activate", G_CALLBACK(activate), NULL);
    g_signal_connect(app, "open", G_CALLBACK(open_files), NULL);
    return app;
}
