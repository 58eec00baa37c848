/*
 * What all files of the window ask of it: a word to the user, another page, which actions
 * are of use now, another scene.
 */
#include "window/window_parts.h"

#include <stdarg.h>
#include <string.h>

enum { TOAST_MS = 4000 };

static gboolean hide_toast(void *data)
{
    window *w = data;
    w->toast_timer = 0;
    gtk_revealer_set_reveal_child(GTK_REVEALER(w->toast), FALSE);
    return G_SOURCE_REMOVE;
}

void window_toast(window *w, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    g_autofree char *text = g_strdup_vprintf(format, arguments);
    va_end(arguments);
    gtk_label_set_text(GTK_LABEL(gtk_revealer_get_child(GTK_REVEALER(w->toast))), text);
    gtk_revealer_set_reveal_child(GTK_REVEALER(w->toast), TRUE);
    g_clear_handle_id(&w->toast_timer, g_source_remove);
    w->toast_timer = g_timeout_add(TOAST_MS, hide_toast, w);
}

void window_show_content(window *w, const char *page)
{
    bool has_views = strcmp(page, "main") == 0;
    gtk_stack_set_visible_child_name(GTK_STACK(w->content), page);
    gtk_widget_set_visible(w->switcher, has_views);
    gtk_widget_set_visible(w->side_button, has_views);
}

static void enable(window *w, const char *name, bool enabled)
{
    GAction *action = g_action_map_lookup_action(G_ACTION_MAP(w->gtk), name);
    g_simple_action_set_enabled(G_SIMPLE_ACTION(action), enabled);
}

void window_update_actions(window *w)
{
    static const char *const of_scene[] = {
        "play",       "restart",         "zoom-fit",
        "zoom-one",   "zoom-in",         "zoom-out",
        "search",     "save-picture",    "reset-view",
        "frame-view", "save-picture-as", "trace-photons",
        "copy-view",  "save-view",       "save-view-as",
        "focus-tool", "save-checkpoint", "save-checkpoint-as",
        "resume",     "resume-from"};
    bool rendering = w->state == SESSION_RENDERING;
    for (size_t i = 0; i < G_N_ELEMENTS(of_scene); i++)
        enable(w, of_scene[i], w->scene != NULL);
    enable(w, "stop", rendering || w->state == SESSION_PAUSED);
    enable(w, "reload", document_path(w->document) != NULL);
    gtk_button_set_icon_name(GTK_BUTTON(w->play_button),
                             rendering ? "media-playback-pause-symbolic"
                                       : "media-playback-start-symbolic");
    gtk_accessible_update_property(GTK_ACCESSIBLE(w->play_button),
                                   GTK_ACCESSIBLE_PROPERTY_LABEL,
                                   rendering ? "Pause" : "Start", -1);
}

void window_open(window *w, const char *path)
{
    g_autofree char *whole = g_canonicalize_filename(path, NULL);
    w->reloading = g_strcmp0(document_path(w->document), whole) == 0;
    document_set_path(w->document, whole);
    session_load(w->session, whole);
    window_update_actions(w);
}
