#include "window/window_parts.h"

#include "widgets/widgets.h"
#include "window/help.h"

#include <string.h>

enum { SIDEBAR_LEAST = 340 };

GtkWindow *window_gtk(window *w)
{
    return w->gtk;
}

/* ---- Opening ---- */

static void file_changed(void *data)
{
    window *w = data;
    window_open(w, document_path(w->document));
}

void window_take_file(window *w, const char *path)
{
    g_autofree char *lower = g_ascii_strdown(path, -1);
    bool is_picture = false;
    for (const char *const *e = neph_image_extensions(); *e; e++)
        is_picture |= g_str_has_suffix(lower, *e);
    if (is_picture && w->scene)
        window_set_reference(w, path);
    else if (is_picture)
        window_toast(w, "Open a scene first: a picture is what it is compared with");
    else
        window_open(w, path);
}

/* File managers give one file or a list of them; the first counts. */
static gboolean dropped(GtkDropTarget *target, const GValue *value, double x, double y,
                        window *w)
{
    (void)target, (void)x, (void)y;
    GFile *file = NULL;
    if (G_VALUE_HOLDS(value, G_TYPE_FILE)) {
        file = g_object_ref(g_value_get_object(value));
    } else if (G_VALUE_HOLDS(value, GDK_TYPE_FILE_LIST)) {
        GSList *files = gdk_file_list_get_files(g_value_get_boxed(value));
        file = files ? g_object_ref(files->data) : NULL;
        g_slist_free(files);
    }
    g_autofree char *path = file ? g_file_get_path(file) : NULL;
    g_clear_object(&file);
    if (path)
        window_take_file(w, path);
    return path != NULL;
}

static void accept_drops(window *w)
{
    GType types[] = {GDK_TYPE_FILE_LIST, G_TYPE_FILE};
    GtkDropTarget *drop = gtk_drop_target_new(G_TYPE_INVALID, GDK_ACTION_COPY);
    gtk_drop_target_set_gtypes(drop, types, G_N_ELEMENTS(types));
    g_signal_connect(drop, "drop", G_CALLBACK(dropped), w);
    gtk_widget_add_css_class(w->content, "drop-area");
    gtk_widget_add_controller(w->content, GTK_EVENT_CONTROLLER(drop));
}

/* ---- Settings ---- */

static void settings_changed(const NephSettings *settings, void *data)
{
    window *w = data;
    session_set_settings(w->session, settings);
    window_photons_settings_changed(w);
}

static void size_changed(int width, int height, void *data)
{
    window *w = data;
    w->size[0] = width;
    w->size[1] = height;
    session_set_size(w->session, width, height);
    window_photons_settings_changed(w);
}

/* ---- Building ---- */

static GtkWidget *open_buttons(window *w)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 0);
    GtkWidget *open = text_button_make("Open", "Open a scene (Ctrl+O)", "win.open");
    GtkWidget *more = gtk_menu_button_new();
    w->scenes = g_menu_new();
    window_fill_scenes_menu(w->scenes);
    gtk_menu_button_set_menu_model(GTK_MENU_BUTTON(more), G_MENU_MODEL(w->scenes));
    widget_name(more, "Recent scenes and examples");
    gtk_widget_add_css_class(box, "linked");
    gtk_box_append(GTK_BOX(box), open);
    gtk_box_append(GTK_BOX(box), more);
    return box;
}

static GtkWidget *header_make(window *w)
{
    GtkWidget *header = gtk_header_bar_new();
    GtkHeaderBar *bar = GTK_HEADER_BAR(header);
    w->play_button = icon_button_make("media-playback-start-symbolic",
                                      "Start or pause (Space)", "win.play");
    gtk_header_bar_pack_start(bar, open_buttons(w));
    gtk_header_bar_pack_start(bar, w->play_button);
    gtk_header_bar_pack_start(bar, icon_button_make("media-playback-stop-symbolic",
                                                    "Stop (Ctrl+.)", "win.stop"));
    gtk_header_bar_pack_start(bar, icon_button_make("view-refresh-symbolic",
                                                    "Render anew (F5)", "win.restart"));
    w->switcher = gtk_stack_switcher_new();
    gtk_stack_switcher_set_stack(GTK_STACK_SWITCHER(w->switcher), GTK_STACK(w->views));
    gtk_widget_add_css_class(w->switcher, "views");
    gtk_header_bar_set_title_widget(bar, w->switcher);
    GtkWidget *menu = gtk_menu_button_new();
    g_autoptr(GMenuModel) model = window_menu();
    gtk_menu_button_set_icon_name(GTK_MENU_BUTTON(menu), "open-menu-symbolic");
    gtk_menu_button_set_menu_model(GTK_MENU_BUTTON(menu), model);
    gtk_menu_button_set_primary(GTK_MENU_BUTTON(menu), TRUE);
    widget_name(menu, "Menu (F10)");
    gtk_header_bar_pack_end(bar, menu);
    GtkWidget *side = gtk_toggle_button_new();
    gtk_button_set_icon_name(GTK_BUTTON(side), "sidebar-show-right-symbolic");
    gtk_actionable_set_action_name(GTK_ACTIONABLE(side), "win.sidebar");
    widget_name(side, "Show the panels (F9)");
    gtk_header_bar_pack_end(bar, side);
    w->side_button = side;
    return header;
}

static GtkWidget *example_make(const char *path)
{
    g_autofree char *name = g_path_get_basename(path);
    *strrchr(name, '.') = '\0';
    g_strdelimit(name, "-", ' ');
    name[0] = g_ascii_toupper(name[0]);
    GtkWidget *button = text_button_make(name, path, "win.open-path");
    gtk_actionable_set_action_target(GTK_ACTIONABLE(button), "s", path);
    gtk_widget_add_css_class(button, "flat");
    return button;
}

/* The scenes that came with the program, in columns. */
static GtkWidget *examples_make(char **paths)
{
    enum { COLUMNS = 3 };
    GtkWidget *grid = gtk_grid_new();
    gtk_grid_set_column_homogeneous(GTK_GRID(grid), TRUE);
    for (int i = 0; paths[i]; i++)
        gtk_grid_attach(GTK_GRID(grid), example_make(paths[i]), i % COLUMNS, i / COLUMNS,
                        1, 1);
    return grid;
}

static GtkWidget *welcome_make(void)
{
    GtkWidget *box = box_make(GTK_ORIENTATION_VERTICAL, 18, 24);
    gtk_widget_set_valign(box, GTK_ALIGN_CENTER);
    gtk_widget_set_halign(box, GTK_ALIGN_CENTER);
    GtkWidget *title = gtk_label_new("Nephroid");
    gtk_widget_add_css_class(title, "title-1");
    GtkWidget *text = gtk_label_new("Open a scene, or drop one here.");
    gtk_widget_add_css_class(text, "dim-label");
    GtkWidget *open = text_button_make("Open a scene…", NULL, "win.open");
    gtk_widget_add_css_class(open, "suggested-action");
    gtk_widget_add_css_class(open, "pill");
    gtk_widget_set_halign(open, GTK_ALIGN_CENTER);
    gtk_box_append(GTK_BOX(box), title);
    gtk_box_append(GTK_BOX(box), text);
    gtk_box_append(GTK_BOX(box), open);
    g_auto(GStrv) examples = document_examples();
    if (examples[0]) {
        gtk_box_append(GTK_BOX(box), gtk_label_new("Or begin with an example:"));
        gtk_box_append(GTK_BOX(box), examples_make(examples));
    }
    GtkWidget *scroller = gtk_scrolled_window_new();
    gtk_scrolled_window_set_policy(GTK_SCROLLED_WINDOW(scroller), GTK_POLICY_NEVER,
                                   GTK_POLICY_AUTOMATIC);
    gtk_scrolled_window_set_min_content_height(GTK_SCROLLED_WINDOW(scroller), 400);
    gtk_scrolled_window_set_child(GTK_SCROLLED_WINDOW(scroller), box);
    return scroller;
}

static void make_photon_panel(window *w)
{
    const photon_panel_events events = {window_photon_style, window_pick_radius, w};
    GtkWidget *photons =
        setting_control_input(settings_panel_find(w->settings, "photons"));
    w->photon_panel = photon_panel_new(
        gtk_spin_button_get_adjustment(GTK_SPIN_BUTTON(photons)), &events);
}

static GtkWidget *sidebar_make(window *w)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 0);
    GtkWidget *switcher = gtk_stack_switcher_new();
    w->pages = gtk_stack_new();
    gtk_stack_switcher_set_stack(GTK_STACK_SWITCHER(switcher), GTK_STACK(w->pages));
    gtk_widget_set_margin_top(switcher, 12);
    gtk_widget_set_margin_start(switcher, 12);
    gtk_widget_set_margin_end(switcher, 12);
    gtk_widget_add_css_class(switcher, "pages");
    gtk_widget_set_halign(switcher, GTK_ALIGN_FILL);
    gtk_stack_add_titled(GTK_STACK(w->pages), settings_panel_widget(w->settings),
                         "settings", "Settings");
    const struct {
        GtkWidget *widget;
        const char *name, *title;
    } pages[] = {{camera_panel_widget(w->camera_panel), "camera", "Camera"},
                 {inspector_widget(w->inspector), "inspect", "Inspect"},
                 {photon_panel_widget(w->photon_panel), "photons", "Photons"},
                 {numbers_panel_widget(w->numbers), "numbers", "Numbers"}};
    for (size_t i = 0; i < G_N_ELEMENTS(pages); i++)
        gtk_stack_add_titled(GTK_STACK(w->pages), pages[i].widget, pages[i].name,
                             pages[i].title);
    GtkStackPage *messages = gtk_stack_add_titled(
        GTK_STACK(w->pages), messages_panel_widget(w->messages), "messages", "Messages");
    gtk_stack_page_set_icon_name(messages, "dialog-information-symbolic");
    gtk_box_append(GTK_BOX(box), switcher);
    gtk_box_append(GTK_BOX(box), w->pages);
    gtk_widget_set_size_request(box, SIDEBAR_LEAST, -1);
    return box;
}

static GtkWidget *views_make(window *w)
{
    const navigation_events events = {window_view_moved, window_view_clicked, w};
    w->views = gtk_stack_new();
    w->canvas = canvas_new(window_hover, window_divided, w);
    w->navigation = navigation_new(canvas_widget(w->canvas), &w->view, &events);
    gtk_stack_add_titled(GTK_STACK(w->views), canvas_widget(w->canvas), "picture",
                         "Picture");
    const navigation_events photon_events = {window_view_moved, window_photon_clicked, w};
    w->photon_view = photon_view_new(&w->view, window_photons_drawn, w);
    w->photon_navigation =
        navigation_new(photon_view_widget(w->photon_view), &w->view, &photon_events);
    gtk_stack_add_titled(GTK_STACK(w->views), photon_view_widget(w->photon_view),
                         "photons", "Photons");
    w->lobes = lobe_view_new();
    gtk_stack_add_titled(GTK_STACK(w->views), lobe_view_widget(w->lobes), "materials",
                         "Materials");
    g_signal_connect_swapped(w->views, "notify::visible-child",
                             G_CALLBACK(window_view_switched), w);
    return w->views;
}

/* What is said in passing stands over whatever is shown. */
static GtkWidget *with_toast(window *w, GtkWidget *below)
{
    GtkWidget *overlay = gtk_overlay_new();
    w->toast = gtk_revealer_new();
    GtkWidget *label = gtk_label_new("");
    gtk_widget_add_css_class(label, "toast");
    gtk_label_set_wrap(GTK_LABEL(label), TRUE);
    gtk_revealer_set_child(GTK_REVEALER(w->toast), label);
    gtk_revealer_set_transition_type(GTK_REVEALER(w->toast),
                                     GTK_REVEALER_TRANSITION_TYPE_SLIDE_UP);
    gtk_widget_set_halign(w->toast, GTK_ALIGN_CENTER);
    gtk_widget_set_valign(w->toast, GTK_ALIGN_END);
    gtk_widget_set_can_target(w->toast, FALSE);
    gtk_overlay_set_child(GTK_OVERLAY(overlay), below);
    gtk_overlay_add_overlay(GTK_OVERLAY(overlay), w->toast);
    return overlay;
}

/* The sidebar gets its remembered width once the whole has one. */
static gboolean place_divider(GtkWidget *paned, GdkFrameClock *clock, void *data)
{
    (void)clock;
    const window *w = data;
    int width = gtk_widget_get_width(paned);
    if (width <= 0)
        return G_SOURCE_CONTINUE;
    gtk_paned_set_position(GTK_PANED(paned), width - w->remembered.sidebar_width);
    return G_SOURCE_REMOVE;
}

static GtkWidget *main_make(window *w)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 0);
    w->paned = gtk_paned_new(GTK_ORIENTATION_HORIZONTAL);
    w->settings = settings_panel_new(settings_changed, size_changed, w);
    GtkWidget *views = views_make(w);
    make_photon_panel(w);
    w->camera_panel = camera_panel_new(window_camera_changed, w);
    w->inspector = inspector_new(w->canvas, window_ask_reference, w);
    w->numbers = numbers_panel_new();
    w->messages = messages_panel_new();
    w->status = status_new();
    GtkPaned *paned = GTK_PANED(w->paned);
    gtk_paned_set_start_child(paned, views);
    w->sidebar = sidebar_make(w);
    gtk_paned_set_end_child(paned, w->sidebar);
    gtk_paned_set_resize_end_child(paned, FALSE);
    gtk_paned_set_shrink_end_child(paned, FALSE);
    gtk_paned_set_shrink_start_child(paned, FALSE);
    gtk_widget_set_vexpand(w->paned, TRUE);
    widget_name(w->paned, "Width of the panels");
    gtk_widget_set_has_tooltip(w->paned, FALSE);
    gtk_widget_add_tick_callback(w->paned, place_divider, w, NULL);
    gtk_widget_set_visible(w->sidebar, w->remembered.sidebar);
    gtk_box_append(GTK_BOX(box), messages_panel_strip(w->messages));
    gtk_box_append(GTK_BOX(box), w->paned);
    gtk_box_append(GTK_BOX(box), status_widget(w->status));
    return box;
}

static void build(window *w)
{
    GtkWidget *main_view = main_make(w);
    w->errors = error_page_new();
    w->content = gtk_stack_new();
    GtkStack *content = GTK_STACK(w->content);
    gtk_stack_add_named(content, welcome_make(), "welcome");
    gtk_stack_add_named(content, error_page_widget(w->errors), "error");
    gtk_stack_add_named(content, main_view, "main");
    gtk_window_set_titlebar(w->gtk, header_make(w));
    gtk_window_set_child(w->gtk, with_toast(w, w->content));
    accept_drops(w);
    window_show_content(w, "welcome");
}

/* ---- Closing ---- */

static void remember(window *w)
{
    window_state *state = &w->remembered;
    gtk_window_get_default_size(w->gtk, &state->width, &state->height);
    state->maximized = gtk_window_is_maximized(w->gtk);
    state->sidebar = gtk_widget_get_visible(w->sidebar);
    int width = gtk_widget_get_width(w->sidebar);
    if (state->sidebar && width > 0)
        state->sidebar_width = width;
    window_state_save(state);
}

static gboolean close_request(window *w)
{
    remember(w);
    return FALSE;
}

static void destroyed(window *w)
{
    session_close(w->session);
    appearance_free(w->appearance);
    g_cancellable_cancel(w->files);
    g_object_unref(w->files);
    document_free(w->document);
    g_clear_handle_id(&w->toast_timer, g_source_remove);
    navigation_free(w->navigation);
    navigation_free(w->photon_navigation);
    window_stop_tracing(w);
    held_photons_unref(w->photons);
    photon_view_free(w->photon_view);
    photon_panel_free(w->photon_panel);
    camera_panel_free(w->camera_panel);
    inspector_free(w->inspector);
    numbers_panel_free(w->numbers);
    messages_panel_free(w->messages);
    lobe_view_free(w->lobes);
    canvas_free(w->canvas);
    settings_panel_free(w->settings);
    error_page_free(w->errors);
    status_free(w->status);
    g_object_unref(w->scenes);
    held_scene_unref(w->scene);
    neph_settings_free(w->of_scene);
    g_free(w->pick_then);
    g_free(w);
}

/* Keys that mean something else where text is typed or a button has the focus: they come
   last. */
static void add_plain_keys(window *w)
{
    static const char *const keys[][2] = {
        {"space", "win.play"}, {"Home", "win.reset-view"}, {"End", "win.frame-view"}};
    GtkEventController *controller = gtk_shortcut_controller_new();
    for (size_t i = 0; i < G_N_ELEMENTS(keys); i++)
        gtk_shortcut_controller_add_shortcut(
            GTK_SHORTCUT_CONTROLLER(controller),
            gtk_shortcut_new(gtk_shortcut_trigger_parse_string(keys[i][0]),
                             gtk_named_action_new(keys[i][1])));
    gtk_widget_add_controller(GTK_WIDGET(w->gtk), controller);
}

static void set_help(window *w)
{
    g_autoptr(GtkShortcutsWindow) help = help_make();
    gtk_application_window_set_help_overlay(GTK_APPLICATION_WINDOW(w->gtk), help);
}

window *window_new(GtkApplication *app)
{
    window *w = g_new0(window, 1);
    w->gtk = GTK_WINDOW(gtk_application_window_new(app));
    w->remembered = window_state_load();
    gtk_window_set_title(w->gtk, "Nephroid");
    gtk_window_set_default_size(w->gtk, w->remembered.width, w->remembered.height);
    if (w->remembered.maximized)
        gtk_window_maximize(w->gtk);
    w->document = document_new(file_changed, w);
    w->session = session_new(window_on_news, w);
    w->files = g_cancellable_new();
    window_add_actions(w);
    set_help(w);
    add_plain_keys(w);
    window_add_view_actions(w);
    build(w);
    w->appearance = appearance_new(window_scheme_changed, w);
    window_apply_theme(w);
    window_update_actions(w);
    g_signal_connect_swapped(w->gtk, "close-request", G_CALLBACK(close_request), w);
    g_signal_connect_swapped(w->gtk, "destroy", G_CALLBACK(destroyed), w);
    g_object_set_data(G_OBJECT(w->gtk), "window", w);
    return w;
}
