#include "window/window_parts.h"

#include "files/file_dialog.h"
#include "files/file_job.h"

#include <string.h>

/* ---- Files ---- */

static void scene_chosen(const char *path, void *data)
{
    window_open(data, path);
}

static void open_scene(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    window *w = data;
    g_auto(GStrv) scenes = file_patterns(neph_scene_extensions());
    g_autofree char *folder = document_folder(w->document);
    const file_question question = {
        "Open a scene", false, NULL, folder, "Scenes", (const char *const *)scenes};
    file_dialog_ask(w->gtk, &question, scene_chosen, w);
}

static void open_path(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action;
    window_open(data, g_variant_get_string(parameter, NULL));
}

static void reload(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    window *w = data;
    if (document_path(w->document))
        window_open(w, document_path(w->document));
}

static void dismiss_error(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    window *w = data;
    window_show_content(w, w->scene ? "main" : "welcome");
}

static void saved(GObject *source, GAsyncResult *result, void *data)
{
    (void)source;
    window *w = data;
    g_autoptr(GError) error = NULL;
    bool ok = file_job_write_finish(result, &error);
    g_application_release(g_application_get_default());
    if (file_job_is_orphan(result))
        return;
    if (ok)
        window_toast(w, "Saved %s", file_job_path(result));
    else
        window_toast(w, "%s", error->message);
}

/* The program stays until the file is whole, also without a window. */
static void save(window *w, const char *path, const file_content *content)
{
    g_application_hold(g_application_get_default());
    file_job_write(path, content, w->files, saved, w);
}

static void save_to(const char *path, void *data)
{
    window *w = data;
    const file_content content = {.picture = canvas_picture(w->canvas),
                                  .shown = *canvas_options(w->canvas)};
    if (content.picture)
        save(w, path, &content);
}

/* The scene's name with another ending; owned by the caller. */
static char *name_with(window *w, const char *ending)
{
    g_autofree char *base = g_path_get_basename(document_path(w->document));
    char *dot = strrchr(base, '.');
    if (dot)
        *dot = '\0';
    return g_strconcat(base, ending, NULL);
}

static void save_picture(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    window *w = data;
    g_auto(GStrv) images = file_patterns(neph_image_written_extensions());
    g_autofree char *name = name_with(w, ".png");
    g_autofree char *folder = document_folder(w->document);
    const file_question question = {
        "Save the picture", true, name, folder, "Pictures", (const char *const *)images};
    file_dialog_ask(w->gtk, &question, save_to, w);
}

static void save_diagram_to(const char *path, void *data)
{
    window *w = data;
    g_autofree char *svg = lobe_view_svg(w->lobes);
    const file_content content = {.text = svg};
    if (svg)
        save(w, path, &content);
}

static void save_diagram(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    static const char *const diagrams[] = {"*.svg", NULL};
    window *w = data;
    g_autofree char *name = name_with(w, "-material.svg");
    g_autofree char *folder = document_folder(w->document);
    const file_question question = {"Save the diagram", true,    name, folder,
                                    "Drawings (svg)",   diagrams};
    file_dialog_ask(w->gtk, &question, save_diagram_to, w);
}

static void save_picture_as(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action;
    save_to(g_variant_get_string(parameter, NULL), data);
}

/* ---- Checkpoints ---- */

static const char *const checkpoints[] = {"*.checkpoint", NULL};

static void keep_in(const char *path, void *data)
{
    window *w = data;
    g_autoptr(GError) error = NULL;
    const char *const *files = neph_scene_files(w->scene->scene);
    if (neph_file_spares(path, files, &error))
        session_keep_in(w->session, path);
    else
        window_toast(w, "%s", error->message);
}

static void save_checkpoint(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    window *w = data;
    g_autofree char *name = name_with(w, ".checkpoint");
    g_autofree char *folder = document_folder(w->document);
    const file_question question = {"Save a checkpoint", true,       name, folder,
                                    "Checkpoints",       checkpoints};
    file_dialog_ask(w->gtk, &question, keep_in, w);
}

static void save_checkpoint_as(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action;
    keep_in(g_variant_get_string(parameter, NULL), data);
}

static void go_on_from(const char *path, void *data)
{
    session_resume(((window *)data)->session, path);
}

static void resume(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    window *w = data;
    g_autofree char *folder = document_folder(w->document);
    const file_question question = {
        "Go on from a checkpoint", false, NULL, folder, "Checkpoints", checkpoints};
    file_dialog_ask(w->gtk, &question, go_on_from, w);
}

static void resume_from(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action;
    go_on_from(g_variant_get_string(parameter, NULL), data);
}

/* ---- Rendering ---- */

static void play(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    window *w = data;
    if (w->state == SESSION_RENDERING)
        session_pause(w->session);
    else if (w->state == SESSION_DONE)
        session_restart(w->session);
    else
        session_play(w->session);
}

static void stop(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    session_stop(((window *)data)->session);
}

static void restart(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    session_restart(((window *)data)->session);
}

static void trace_photons(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    window *w = data;
    gtk_stack_set_visible_child_name(GTK_STACK(w->views), "photons");
    window_trace_photons(w);
}

/* ---- The view ---- */

static void zoom(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)parameter;
    window *w = data;
    const char *name = g_action_get_name(G_ACTION(action));
    if (strcmp(name, "zoom-fit") == 0)
        canvas_set_zoom(w->canvas, 0.0);
    else if (strcmp(name, "zoom-one") == 0)
        canvas_set_zoom(w->canvas,
                        1.0 / gtk_widget_get_scale_factor(canvas_widget(w->canvas)));
    else
        canvas_zoom_by(w->canvas, strcmp(name, "zoom-in") == 0 ? 1.5 : 1.0 / 1.5);
}

static void show_view(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action;
    window *w = data;
    gtk_stack_set_visible_child_name(GTK_STACK(w->views),
                                     g_variant_get_string(parameter, NULL));
}

static void show_sidebar(window *w, bool shown)
{
    GAction *action = g_action_map_lookup_action(G_ACTION_MAP(w->gtk), "sidebar");
    gtk_widget_set_visible(w->sidebar, shown);
    g_simple_action_set_state(G_SIMPLE_ACTION(action), g_variant_new_boolean(shown));
}

static void show_page(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action;
    window *w = data;
    show_sidebar(w, true);
    gtk_stack_set_visible_child_name(GTK_STACK(w->pages),
                                     g_variant_get_string(parameter, NULL));
}

static void toggle_sidebar(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    window *w = data;
    show_sidebar(w, !gtk_widget_get_visible(w->sidebar));
}

static void search(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    window *w = data;
    show_sidebar(w, true);
    gtk_stack_set_visible_child_name(GTK_STACK(w->pages), "settings");
    settings_panel_search(w->settings);
}

static void fullscreen(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    window *w = data;
    if (gtk_window_is_fullscreen(w->gtk))
        gtk_window_unfullscreen(w->gtk);
    else
        gtk_window_fullscreen(w->gtk);
}

/* ---- Light and dark ---- */

/* What GTK was set up with, which holds where the desktop says nothing: found before the
   program sets it itself. */
static bool gtk_is_dark(void)
{
    static int dark = -1;
    if (dark < 0) {
        gboolean prefers = FALSE;
        g_object_get(gtk_settings_get_default(), "gtk-application-prefer-dark-theme",
                     &prefers, NULL);
        dark = prefers;
    }
    return dark > 0;
}

void window_apply_theme(window *w)
{
    bool by_gtk = gtk_is_dark();
    appearance_scheme scheme = appearance_get(w->appearance);
    bool by_system = scheme == SCHEME_DARK || (scheme == SCHEME_UNKNOWN && by_gtk);
    window_theme theme = w->remembered.theme;
    bool dark = theme == THEME_DARK || (theme == THEME_SYSTEM && by_system);
    g_object_set(gtk_settings_get_default(), "gtk-application-prefer-dark-theme", dark,
                 NULL);
    GAction *action = g_action_map_lookup_action(G_ACTION_MAP(w->gtk), "theme");
    g_simple_action_set_state(G_SIMPLE_ACTION(action),
                              g_variant_new_string(theme_words[theme]));
}

void window_scheme_changed(appearance_scheme scheme, void *data)
{
    (void)scheme;
    window_apply_theme(data);
}

static void choose_theme(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action;
    window *w = data;
    for (int i = 0; i < N_THEMES; i++)
        if (strcmp(g_variant_get_string(parameter, NULL), theme_words[i]) == 0)
            w->remembered.theme = (window_theme)i;
    window_apply_theme(w);
}

/* ---- The table ---- */

static const GActionEntry entries[] = {
    {.name = "open", .activate = open_scene},
    {.name = "open-path", .activate = open_path, .parameter_type = "s"},
    {.name = "reload", .activate = reload},
    {.name = "dismiss-error", .activate = dismiss_error},
    {.name = "save-picture", .activate = save_picture},
    {.name = "save-picture-as", .activate = save_picture_as, .parameter_type = "s"},
    {.name = "save-diagram", .activate = save_diagram},
    {.name = "save-checkpoint", .activate = save_checkpoint},
    {.name = "save-checkpoint-as", .activate = save_checkpoint_as, .parameter_type = "s"},
    {.name = "resume", .activate = resume},
    {.name = "resume-from", .activate = resume_from, .parameter_type = "s"},
    {.name = "play", .activate = play},
    {.name = "stop", .activate = stop},
    {.name = "restart", .activate = restart},
    {.name = "trace-photons", .activate = trace_photons},
    {.name = "zoom-fit", .activate = zoom},
    {.name = "zoom-one", .activate = zoom},
    {.name = "zoom-in", .activate = zoom},
    {.name = "zoom-out", .activate = zoom},
    {.name = "view", .activate = show_view, .parameter_type = "s"},
    {.name = "page", .activate = show_page, .parameter_type = "s"},
    {.name = "sidebar", .activate = toggle_sidebar, .state = "true"},
    {.name = "search", .activate = search},
    {.name = "fullscreen", .activate = fullscreen},
    {.name = "theme",
     .activate = choose_theme,
     .parameter_type = "s",
     .state = "'system'"},
};

void window_add_actions(window *w)
{
    g_action_map_add_action_entries(G_ACTION_MAP(w->gtk), entries, G_N_ELEMENTS(entries),
                                    w);
}

/* ---- Menus ---- */

static void append_section(GMenu *menu, const char *title, const char *const items[][2],
                           size_t n)
{
    g_autoptr(GMenu) section = g_menu_new();
    for (size_t i = 0; i < n; i++)
        g_menu_append(section, items[i][0], items[i][1]);
    g_menu_append_section(menu, title, G_MENU_MODEL(section));
}

GMenuModel *window_menu(void)
{
    static const char *const file[][2] = {{"Save the picture…", "win.save-picture"},
                                          {"Save a checkpoint…", "win.save-checkpoint"},
                                          {"Go on from a checkpoint…", "win.resume"},
                                          {"Read the scene again", "win.reload"}};
    static const char *const view[][2] = {{"Fit to the window", "win.zoom-fit"},
                                          {"Pixel by pixel", "win.zoom-one"},
                                          {"Full screen", "win.fullscreen"}};
    static const char *const theme[][2] = {{"As the system", "win.theme::system"},
                                           {"Light", "win.theme::light"},
                                           {"Dark", "win.theme::dark"}};
    static const char *const help[][2] = {{"Keys and mouse", "win.show-help-overlay"},
                                          {"About Nephroid", "app.about"}};
    GMenu *menu = g_menu_new();
    append_section(menu, NULL, file, G_N_ELEMENTS(file));
    append_section(menu, NULL, view, G_N_ELEMENTS(view));
    append_section(menu, "Appearance", theme, G_N_ELEMENTS(theme));
    append_section(menu, NULL, help, G_N_ELEMENTS(help));
    return G_MENU_MODEL(menu);
}

/* The file's name, and its folder's where another has the same name. Owned by the caller.
 */
static char *scene_label(char **paths, size_t i)
{
    g_autofree char *base = g_path_get_basename(paths[i]);
    g_autofree char *folder = g_path_get_dirname(paths[i]);
    bool alone = true;
    for (size_t k = 0; paths[k]; k++) {
        g_autofree char *other = g_path_get_basename(paths[k]);
        alone &= k == i || strcmp(base, other) != 0;
    }
    g_autofree char *label =
        alone ? g_strdup(base) : g_strdup_printf("%s – %s", base, folder);
    return g_utf8_make_valid(label, -1);
}

static void append_scenes(GMenu *menu, const char *title, char **paths)
{
    g_autoptr(GMenu) section = g_menu_new();
    for (size_t i = 0; paths[i]; i++) {
        g_autofree char *label = scene_label(paths, i);
        g_autoptr(GMenuItem) item = g_menu_item_new(label, NULL);
        g_menu_item_set_action_and_target(item, "win.open-path", "s", paths[i]);
        g_menu_append_item(section, item);
    }
    if (paths[0])
        g_menu_append_section(menu, title, G_MENU_MODEL(section));
}

void window_fill_scenes_menu(GMenu *menu)
{
    g_auto(GStrv) recent = document_recent();
    g_auto(GStrv) examples = document_examples();
    g_menu_remove_all(menu);
    append_scenes(menu, "Recent", recent);
    append_scenes(menu, "Examples", examples);
}
