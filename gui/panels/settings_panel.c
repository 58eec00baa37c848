#include "panels/settings_panel.h"

#include "widgets/widgets.h"

#include <string.h>

/* Typing and dragging settle before a new render begins, ms. */
enum { SETTLE_MS = 200 };

/* Named by the course assignment, §2 item 2 (a)-(f), (h), (i), in its order. */
static const char *const assigned[] = {"max_backward_bounces",
                                       "max_forward_bounces",
                                       "final_gather",
                                       "gather_rays",
                                       "direct_illumination",
                                       "shadow_rays",
                                       "radius",
                                       "photons",
                                       NULL};

typedef struct panel_group {
    char *title;
    GtkWidget *box, *list;
} panel_group;

struct settings_panel {
    GtkWidget *root, *search, *content, *empty;
    GtkWidget *switch_over;              /* shown when another integrator is at work */
    GtkWidget *width, *height, *threads; /* of the picture */
    GPtrArray *controls;                 /* setting_control */
    GArray *groups;                      /* panel_group */
    NephSettings *values, *scene;
    guint settle; /* source, 0: nothing changed */
    guint settle_size;
    bool showing;
    settings_listener changed;
    size_listener resized;
    void *data;
};

/* ---- Groups ---- */

static const char *group_title(const NephSettingInfo *info)
{
    static const char *const prefixes[][2] = {{"direct_", "Direct photons"},
                                              {"indirect_", "Indirect photons"},
                                              {"caustic_", "Caustic photons"}};
    if (g_strv_contains(assigned, info->name))
        return "Photon mapping";
    for (size_t i = 0; i < G_N_ELEMENTS(prefixes); i++)
        if (g_str_has_prefix(info->name, prefixes[i][0]))
            return prefixes[i][1];
    if (strcmp(info->users, "all") == 0)
        return "Rendering";
    return strstr(info->users, "photonmap") ? "Finer points of photon mapping"
                                            : "Other integrators";
}

static panel_group *find_group(settings_panel *p, const char *title)
{
    for (guint i = 0; i < p->groups->len; i++) {
        panel_group *g = &g_array_index(p->groups, panel_group, i);
        if (strcmp(g->title, title) == 0)
            return g;
    }
    panel_group made = {.title = g_strdup(title)};
    made.box = group_make(title, &made.list);
    gtk_box_append(GTK_BOX(p->content), made.box);
    g_array_append_val(p->groups, made);
    return &g_array_index(p->groups, panel_group, p->groups->len - 1);
}

/* ---- Changes ---- */

static gboolean settle(void *data)
{
    settings_panel *p = data;
    p->settle = 0;
    p->changed(p->values, p->data);
    return G_SOURCE_REMOVE;
}

static void show_used(settings_panel *p)
{
    g_autofree char *integrator = neph_settings_get(p->values, "integrator");
    for (guint i = 0; i < p->controls->len; i++) {
        setting_control *c = p->controls->pdata[i];
        const NephSettingInfo *info = setting_control_info(c);
        setting_control_set_used(c, neph_settings_reads(p->values, info->name));
    }
    gtk_widget_set_visible(p->switch_over, strcmp(integrator, "photonmap") != 0);
}

static void show_threads(settings_panel *p)
{
    g_autofree char *threads = neph_settings_get(p->values, "threads");
    gtk_switch_set_active(GTK_SWITCH(p->threads), strcmp(threads, "1") != 0);
}

static void on_changed(const NephSettingInfo *info, const char *value, void *data)
{
    settings_panel *p = data;
    neph_settings_set(p->values, info->name, value, NULL);
    p->showing = true;
    show_used(p);
    show_threads(p);
    p->showing = false;
    if (p->settle)
        g_source_remove(p->settle);
    p->settle = g_timeout_add(SETTLE_MS, settle, p);
}

static void on_threads(settings_panel *p)
{
    if (p->showing)
        return;
    setting_control *c = settings_panel_find(p, "threads");
    const char *value = gtk_switch_get_active(GTK_SWITCH(p->threads)) ? "0" : "1";
    setting_control_show(c, value);
    on_changed(setting_control_info(c), value, p);
}

static gboolean settle_size(void *data)
{
    settings_panel *p = data;
    p->settle_size = 0;
    p->resized(gtk_spin_button_get_value_as_int(GTK_SPIN_BUTTON(p->width)),
               gtk_spin_button_get_value_as_int(GTK_SPIN_BUTTON(p->height)), p->data);
    return G_SOURCE_REMOVE;
}

static void on_size(settings_panel *p)
{
    if (p->showing)
        return;
    if (p->settle_size)
        g_source_remove(p->settle_size);
    p->settle_size = g_timeout_add(SETTLE_MS, settle_size, p);
}

static void reset_to(settings_panel *p, const NephSettings *values)
{
    settings_panel_show(p, values, NULL);
    p->changed(p->values, p->data);
}

static void on_as_scene(settings_panel *p)
{
    reset_to(p, p->scene);
}

static void on_defaults(settings_panel *p)
{
    g_autoptr(NephSettings) defaults = neph_settings_new();
    reset_to(p, defaults);
}

/* ---- Search ---- */

static bool matches(const NephSettingInfo *info, const char *words)
{
    g_autofree char *title = setting_title(info);
    g_autofree char *all =
        g_strjoin(" ", title, info->name, info->doc, info->aliases, info->users, NULL);
    g_autofree char *text = g_utf8_casefold(all, -1);
    g_auto(GStrv) wanted = g_strsplit(words, " ", -1);
    for (size_t i = 0; wanted[i]; i++)
        if (!strstr(text, wanted[i]))
            return false;
    return true;
}

static void on_search(settings_panel *p)
{
    g_autofree char *words =
        g_utf8_casefold(gtk_editable_get_text(GTK_EDITABLE(p->search)), -1);
    bool any = false;
    for (guint i = 0; i < p->groups->len; i++)
        gtk_widget_set_visible(g_array_index(p->groups, panel_group, i).box, FALSE);
    for (guint i = 0; i < p->controls->len; i++) {
        setting_control *c = p->controls->pdata[i];
        bool found = matches(setting_control_info(c), words);
        gtk_widget_set_visible(setting_control_row(c), found);
        panel_group *g = find_group(p, group_title(setting_control_info(c)));
        if (found)
            gtk_widget_set_visible(g->box, TRUE);
        any |= found;
    }
    gtk_widget_set_visible(find_group(p, "Picture")->box, !*words);
    gtk_widget_set_visible(p->empty, !any);
}

/* ---- Building ---- */

static void add_setting(settings_panel *p, const NephSettingInfo *info)
{
    panel_group *g = find_group(p, group_title(info));
    g_ptr_array_add(p->controls, setting_control_new(g->list, info, on_changed, p));
}

static void add_picture(settings_panel *p)
{
    panel_group *g = find_group(p, "Picture");
    p->width = spin_make(1, 16384, 16, true);
    p->height = spin_make(1, 16384, 16, true);
    p->threads = gtk_switch_new();
    gtk_widget_set_name(p->width, "width");
    gtk_widget_set_name(p->height, "height");
    gtk_widget_set_name(p->threads, "multithreading");
    gtk_widget_set_margin_end(p->width, 34);
    gtk_widget_set_margin_end(p->height, 34);
    gtk_widget_set_margin_end(p->threads, 34);
    row_add(g->list, "Width (pixels)", p->width);
    row_add(g->list, "Height (pixels)", p->height);
    gtk_widget_set_tooltip_text(row_add(g->list, "Multithreading", p->threads),
                                "Off: one thread. Their number is the setting Threads.");
    g_signal_connect_swapped(p->width, "value-changed", G_CALLBACK(on_size), p);
    g_signal_connect_swapped(p->height, "value-changed", G_CALLBACK(on_size), p);
    g_signal_connect_swapped(p->threads, "notify::active", G_CALLBACK(on_threads), p);
}

static void add_settings(settings_panel *p)
{
    size_t n;
    const NephSettingInfo *rows = neph_settings_table(&n);
    for (size_t k = 0; assigned[k]; k++)
        for (size_t i = 0; i < n; i++)
            if (strcmp(rows[i].name, assigned[k]) == 0)
                add_setting(p, &rows[i]);
    add_picture(p);
    for (size_t i = 0; i < n; i++)
        if (!settings_panel_find(p, rows[i].name))
            add_setting(p, &rows[i]);
}

/* ---- Presets ---- */

static void on_preset(GSimpleAction *action, GVariant *name, void *data)
{
    (void)action;
    settings_panel *p = data;
    g_autoptr(NephSettings) values = neph_settings_copy(p->scene);
    if (neph_settings_load_preset(values, g_variant_get_string(name, NULL), NULL))
        reset_to(p, values);
}

/* "002: Abruña, Photon Mapping": the first line is "# TEXT: what it says". */
static char *preset_title(const char *name)
{
    g_autofree char *text = neph_settings_preset_text(name, NULL);
    const char *follows = text ? text + strspn(text, "# ") : "";
    return g_strdup_printf("%s: %.*s", name, (int)strcspn(follows, ":\n"), follows);
}

/* Over what the scene asks for. */
static GtkWidget *presets_make(settings_panel *p)
{
    GtkWidget *button = gtk_menu_button_new();
    g_auto(GStrv) names = neph_settings_presets();
    g_autoptr(GMenu) menu = g_menu_new();
    g_autoptr(GSimpleActionGroup) actions = g_simple_action_group_new();
    g_autoptr(GSimpleAction) action =
        g_simple_action_new("preset", G_VARIANT_TYPE_STRING);
    g_signal_connect(action, "activate", G_CALLBACK(on_preset), p);
    g_action_map_add_action(G_ACTION_MAP(actions), G_ACTION(action));
    gtk_widget_insert_action_group(p->root, "settings", G_ACTION_GROUP(actions));
    for (char **name = names; *name; name++) {
        g_autofree char *title = preset_title(*name);
        g_autoptr(GMenuItem) item = g_menu_item_new(title, NULL);
        g_menu_item_set_action_and_target(item, "settings.preset", "s", *name);
        g_menu_append_item(menu, item);
    }
    gtk_menu_button_set_label(GTK_MENU_BUTTON(button), "Preset");
    gtk_menu_button_set_menu_model(GTK_MENU_BUTTON(button), G_MENU_MODEL(menu));
    gtk_widget_set_name(button, "presets");
    gtk_widget_set_tooltip_text(button, "The scene's settings, and over them what a text "
                                        "on photon mapping describes");
    widget_name(button, "Presets of settings");
    return button;
}

static GtkWidget *buttons_make(settings_panel *p)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6);
    GtkWidget *scene =
        text_button_make("As in the scene", "Back to what the scene file asks for", NULL);
    GtkWidget *defaults =
        text_button_make("All defaults", "Every setting as the program has it", NULL);
    g_signal_connect_swapped(scene, "clicked", G_CALLBACK(on_as_scene), p);
    g_signal_connect_swapped(defaults, "clicked", G_CALLBACK(on_defaults), p);
    gtk_box_append(GTK_BOX(box), scene);
    gtk_box_append(GTK_BOX(box), defaults);
    gtk_box_append(GTK_BOX(box), presets_make(p));
    gtk_box_set_homogeneous(GTK_BOX(box), TRUE);
    return box;
}

static void change(settings_panel *p, const char *name, const char *value)
{
    setting_control *c = settings_panel_find(p, name);
    setting_control_show(c, value);
    on_changed(setting_control_info(c), value, p);
}

static void on_switch_over(settings_panel *p)
{
    change(p, "integrator", "photonmap");
}

static void on_gather_too(settings_panel *p)
{
    change(p, "integrator", "photonmap");
    change(p, "final_gather", "true");
}

static GtkWidget *switch_over_make(settings_panel *p)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 6);
    GtkWidget *button =
        text_button_make("Use photon mapping", "Sets the integrator to photonmap", NULL);
    gtk_box_append(GTK_BOX(box), text_make("The integrator of this scene leaves some "
                                           "settings unused; those are dimmed.",
                                           "dim-label"));
    gtk_box_append(GTK_BOX(box), button);
    GtkWidget *gather =
        text_button_make("Use it with final gathering",
                         "Sets the integrator to photonmap and turns final gathering on, "
                         "by as many rays as are set below",
                         NULL);
    gtk_widget_set_name(gather, "use-final-gathering");
    gtk_box_append(GTK_BOX(box), gather);
    g_signal_connect_swapped(button, "clicked", G_CALLBACK(on_switch_over), p);
    g_signal_connect_swapped(gather, "clicked", G_CALLBACK(on_gather_too), p);
    return box;
}

static void build(settings_panel *p)
{
    p->root = gtk_box_new(GTK_ORIENTATION_VERTICAL, 0);
    GtkWidget *top = box_make(GTK_ORIENTATION_VERTICAL, 6, 12);
    p->search = gtk_search_entry_new();
    g_object_set(p->search, "placeholder-text", "Search settings", NULL);
    widget_name(p->search, "Search settings");
    g_signal_connect_swapped(p->search, "search-changed", G_CALLBACK(on_search), p);
    gtk_box_append(GTK_BOX(top), p->search);
    gtk_box_append(GTK_BOX(top), buttons_make(p));
    p->switch_over = switch_over_make(p);
    gtk_box_append(GTK_BOX(top), p->switch_over);
    gtk_box_append(GTK_BOX(p->root), top);
    GtkWidget *scroller = gtk_scrolled_window_new();
    gtk_scrolled_window_set_policy(GTK_SCROLLED_WINDOW(scroller), GTK_POLICY_NEVER,
                                   GTK_POLICY_AUTOMATIC);
    gtk_widget_set_vexpand(scroller, TRUE);
    p->content = box_make(GTK_ORIENTATION_VERTICAL, 18, 12);
    p->empty = gtk_label_new("No setting has these words.");
    gtk_widget_add_css_class(p->empty, "dim-label");
    gtk_widget_set_visible(p->empty, FALSE);
    gtk_box_append(GTK_BOX(p->content), p->empty);
    gtk_scrolled_window_set_child(GTK_SCROLLED_WINDOW(scroller), p->content);
    gtk_box_append(GTK_BOX(p->root), scroller);
}

static void clear_group(void *data)
{
    g_free(((panel_group *)data)->title);
}

settings_panel *settings_panel_new(settings_listener changed, size_listener resized,
                                   void *data)
{
    settings_panel *p = g_new0(settings_panel, 1);
    *p = (settings_panel){.changed = changed, .resized = resized, .data = data};
    p->controls = g_ptr_array_new_with_free_func((GDestroyNotify)setting_control_free);
    p->groups = g_array_new(FALSE, FALSE, sizeof(panel_group));
    g_array_set_clear_func(p->groups, clear_group);
    p->values = neph_settings_new();
    p->scene = neph_settings_new();
    build(p);
    add_settings(p);
    settings_panel_show(p, p->values, NULL);
    return p;
}

void settings_panel_free(settings_panel *p)
{
    if (!p)
        return;
    g_clear_handle_id(&p->settle, g_source_remove);
    g_clear_handle_id(&p->settle_size, g_source_remove);
    g_ptr_array_unref(p->controls);
    g_array_unref(p->groups);
    neph_settings_free(p->values);
    neph_settings_free(p->scene);
    g_free(p);
}

GtkWidget *settings_panel_widget(settings_panel *p)
{
    return p->root;
}

setting_control *settings_panel_find(settings_panel *p, const char *name)
{
    for (guint i = 0; i < p->controls->len; i++)
        if (strcmp(setting_control_info(p->controls->pdata[i])->name, name) == 0)
            return p->controls->pdata[i];
    return NULL;
}

void settings_panel_show(settings_panel *p, const NephSettings *values,
                         const NephSettings *scene)
{
    NephSettings *copy = neph_settings_copy(values);
    neph_settings_free(p->values);
    p->values = copy;
    if (scene) {
        neph_settings_free(p->scene);
        p->scene = neph_settings_copy(scene);
    }
    for (guint i = 0; i < p->controls->len; i++) {
        setting_control *c = p->controls->pdata[i];
        g_autofree char *value =
            neph_settings_get(p->values, setting_control_info(c)->name);
        setting_control_show(c, value);
    }
    g_clear_handle_id(&p->settle, g_source_remove);
    p->showing = true;
    show_used(p);
    show_threads(p);
    p->showing = false;
}

void settings_panel_show_size(settings_panel *p, int width, int height)
{
    p->showing = true;
    gtk_spin_button_set_value(GTK_SPIN_BUTTON(p->width), width);
    gtk_spin_button_set_value(GTK_SPIN_BUTTON(p->height), height);
    p->showing = false;
}

const NephSettings *settings_panel_values(const settings_panel *p)
{
    return p->values;
}

void settings_panel_search(settings_panel *p)
{
    gtk_widget_grab_focus(p->search);
}
