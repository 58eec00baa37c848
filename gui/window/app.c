#include "window/app.h"

#include "window/renderer.h"
#include "window/screenshot.h"
#include "window/window.h"

#include <nephroid/nephroid.h>

#define APP_ID "org.nephroid.View"

static const char style[] =
    ".canvas { background-color: #1a1a1c; }\n"
    ".canvas:focus-visible { outline: 2px solid @theme_selected_bg_color;"
    " outline-offset: -2px; }\n"
    ".drop-area:drop(active) { box-shadow: inset 0 0 0 4px @theme_selected_bg_color; }\n"
    ".views > button { min-width: 76px; }\n"
    ".caption { font-size: 85%; }\n"
    ".error { color: @error_color; }\n"
    ".pages > button { min-width: 40px; padding: 5px 6px; }\n"
    ".statusbar-line { padding: 5px 12px; }\n"
    ".numeric { font-feature-settings: \"tnum\"; }\n"
    ".group > row { padding: 2px 10px 2px 12px; min-height: 36px; }\n"
    ".group > row.value { min-height: 28px; }\n"
    ".group { border-radius: 10px; }\n"
    ".group > row:first-child { border-radius: 10px 10px 0 0; }\n"
    ".group > row:last-child { border-radius: 0 0 10px 10px; }\n"
    ".reset { min-width: 24px; min-height: 24px; padding: 2px; }\n"
    ".heading { font-weight: bold; }\n"
    ".title-1 { font-weight: 800; font-size: 20pt; }\n"
    ".title-2 { font-weight: 800; font-size: 15pt; }\n"
    ".pill { border-radius: 9999px; padding: 8px 28px; }\n"
    ".source { font-family: monospace; padding: 8px; }\n"
    ".strip { background-color: alpha(@warning_color, 0.25); padding: 6px 12px; }\n"
    ".summary { padding: 0 6px; min-height: 20px; }\n"
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
        {"win.show-help-overlay", "<Control>question", "F1"},
        {"win.open", "<Control>o", NULL},
        {"win.reload", "<Control>r", NULL},
        {"win.save-picture", "<Control>s", NULL},
        {"win.stop", "<Control>period", NULL},
        {"win.restart", "F5", NULL},
        {"win.trace-photons", "<Control>t", NULL},
        {"win.copy-view", "<Control><Shift>c", NULL},
        {"win.save-view", "<Control><Shift>s", NULL},
        {"win.focus-tool", "<Control>d", NULL},
        {"win.brighter", "<Control>Up", NULL},
        {"win.darker", "<Control>Down", NULL},
        {"win.view::picture", "<Alt>1", NULL},
        {"win.view::photons", "<Alt>2", NULL},
        {"win.view::materials", "<Alt>3", NULL},
        {"win.page::settings", "<Alt>s", NULL},
        {"win.page::camera", "<Alt>c", NULL},
        {"win.page::inspect", "<Alt>i", NULL},
        {"win.page::photons", "<Alt>p", NULL},
        {"win.page::numbers", "<Alt>n", NULL},
        {"win.page::messages", "<Alt>m", NULL},
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
    renderer_choose(gdk_display_get_default());
}

/* ---- Command line ---- */

/* What the options ask for; one program, one command line. */
static struct {
    char *screenshot, *view, *page, *theme, *pick, *memory;
    double after; /* s */
    gboolean version;
} given = {.after = 4.0};

static const GOptionEntry options[] = {
    {"view", 0, 0, G_OPTION_ARG_STRING, &given.view,
     "Begin with this view: picture, photons or materials", "NAME"},
    {"page", 0, 0, G_OPTION_ARG_STRING, &given.page,
     "Begin with this page beside it, e.g. settings", "NAME"},
    {"theme", 0, 0, G_OPTION_ARG_STRING, &given.theme, "system, light or dark", "NAME"},
    {"pick", 0, 0, G_OPTION_ARG_STRING, &given.pick,
     "Pick what is seen there in the photon view, as soon as photons are traced", "X,Y"},
    {"memory", 0, 0, G_OPTION_ARG_STRING, &given.memory,
     "Take at most so much memory, as 2G or 500M", "SIZE"},
    {"screenshot", 0, 0, G_OPTION_ARG_FILENAME, &given.screenshot,
     "Take a picture of the window and end", "FILE.png"},
    {"after", 0, 0, G_OPTION_ARG_DOUBLE, &given.after,
     "Seconds after which the picture is taken", "SECONDS"},
    {"version", 'V', 0, G_OPTION_ARG_NONE, &given.version, "Show the version", NULL},
    G_OPTION_ENTRY_NULL};

static int local_options(void)
{
    g_autoptr(GError) error = NULL;
    if (given.memory && !neph_memory_set_limit(given.memory, &error)) {
        g_printerr("nephroid-view: --%s\n", error->message);
        return 2;
    }
    if (!given.version)
        return -1;
    g_print("nephroid-view %s\n", neph_version());
    return 0;
}

/* The window is being drawn: once more in a moment, ms. */
enum { RETRY_MS = 150 };

static gboolean take_screenshot(void *data)
{
    GtkWindow *shown = data;
    g_autoptr(GError) error = NULL;
    bool taken = screenshot_take(shown, given.screenshot, &error);
    if (!taken && g_error_matches(error, G_IO_ERROR, G_IO_ERROR_BUSY)) {
        g_timeout_add(RETRY_MS, take_screenshot, shown);
        return G_SOURCE_REMOVE;
    }
    if (!taken)
        g_printerr("nephroid-view: %s\n", error->message);
    gtk_window_destroy(shown);
    return G_SOURCE_REMOVE;
}

static window *show_window(GtkApplication *app)
{
    window *w = window_new(app);
    GtkWidget *gtk = GTK_WIDGET(window_gtk(w));
    const char *const wishes[][2] = {
        {"win.theme", given.theme}, {"win.view", given.view}, {"win.page", given.page}};
    for (size_t i = 0; i < G_N_ELEMENTS(wishes); i++)
        if (wishes[i][1])
            gtk_widget_activate_action(gtk, wishes[i][0], "s", wishes[i][1]);
    if (given.pick)
        window_pick_when_traced(w, given.pick);
    gtk_window_present(GTK_WINDOW(gtk));
    if (given.screenshot)
        g_timeout_add((guint)(1000.0 * given.after), take_screenshot, gtk);
    return w;
}

static void activate(GtkApplication *app)
{
    show_window(app);
}

static void open_files(GtkApplication *app, GFile **files, int n)
{
    for (int i = 0; i < n; i++) {
        g_autofree char *path = g_file_get_path(files[i]);
        window *w = show_window(app);
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
    g_application_add_main_option_entries(G_APPLICATION(app), options);
    g_signal_connect_swapped(app, "handle-local-options", G_CALLBACK(local_options),
                             NULL);
    return app;
}
