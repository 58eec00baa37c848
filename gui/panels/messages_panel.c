#include "panels/messages_panel.h"

#include "widgets/widgets.h"

#include <stdbool.h>
#include <string.h>

struct messages_panel {
    GtkWidget *root, *list_box, *group, *empty;
    GtkWidget *strip, *strip_text;
    GPtrArray *list; /* message* */
};

static const char *const icons[] = {[MESSAGE_NOTE] = "dialog-information-symbolic",
                                    [MESSAGE_WARNING] = "dialog-warning-symbolic",
                                    [MESSAGE_ERROR] = "dialog-error-symbolic"};
static const char *const titles[] = {
    [MESSAGE_NOTE] = "Note", [MESSAGE_WARNING] = "Warning", [MESSAGE_ERROR] = "Error"};

/* ---- The page ---- */

static GtkWidget *words_make(const message *m)
{
    GtkWidget *words = box_make(GTK_ORIENTATION_VERTICAL, 2, 0);
    gtk_box_append(GTK_BOX(words), label_make(titles[m->kind], "heading"));
    GtkWidget *text = text_make(m->text, NULL);
    gtk_label_set_selectable(GTK_LABEL(text), TRUE);
    gtk_widget_set_can_focus(text, FALSE);
    gtk_box_append(GTK_BOX(words), text);
    gtk_widget_set_hexpand(words, TRUE);
    return words;
}

static void append_row(messages_panel *p, const message *m)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 10);
    GtkWidget *icon = gtk_image_new_from_icon_name(icons[m->kind]);
    gtk_widget_set_valign(icon, GTK_ALIGN_START);
    gtk_widget_set_margin_top(box, 6);
    gtk_widget_set_margin_bottom(box, 6);
    gtk_box_append(GTK_BOX(box), icon);
    gtk_box_append(GTK_BOX(box), words_make(m));
    GtkWidget *row = gtk_list_box_row_new();
    gtk_list_box_row_set_activatable(GTK_LIST_BOX_ROW(row), FALSE);
    gtk_list_box_row_set_child(GTK_LIST_BOX_ROW(row), box);
    gtk_list_box_append(GTK_LIST_BOX(p->list_box), row);
}

static void show_whether_empty(messages_panel *p)
{
    gtk_widget_set_visible(p->group, p->list->len > 0);
    gtk_widget_set_visible(p->empty, p->list->len == 0);
}

static void clear(messages_panel *p)
{
    GtkWidget *row;
    while ((row = gtk_widget_get_first_child(p->list_box)))
        gtk_list_box_remove(GTK_LIST_BOX(p->list_box), row);
    g_ptr_array_set_size(p->list, 0);
}

/* ---- The strip ---- */

/* The first warning, and how many more there are. */
static void show_strip(messages_panel *p)
{
    guint n = 0;
    const char *first = NULL;
    for (guint i = 0; i < p->list->len; i++) {
        const message *m = p->list->pdata[i];
        if (m->kind == MESSAGE_NOTE)
            continue;
        first = first ? first : m->text;
        n++;
    }
    g_autofree char *text =
        n > 1 ? g_strdup_printf("%s (and %u more)", first, n - 1) : g_strdup(first);
    gtk_label_set_text(GTK_LABEL(p->strip_text), text ? text : "");
    gtk_widget_set_visible(p->strip, n > 0);
}

static void close_strip(messages_panel *p)
{
    gtk_widget_set_visible(p->strip, FALSE);
}

static GtkWidget *strip_make(messages_panel *p)
{
    GtkWidget *strip = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 10);
    gtk_widget_add_css_class(strip, "strip");
    gtk_box_append(GTK_BOX(strip), gtk_image_new_from_icon_name(icons[MESSAGE_WARNING]));
    p->strip_text = text_make("", NULL);
    gtk_label_set_max_width_chars(GTK_LABEL(p->strip_text), -1);
    gtk_widget_set_hexpand(p->strip_text, TRUE);
    gtk_box_append(GTK_BOX(strip), p->strip_text);
    GtkWidget *all = text_button_make("Show all", "The page of messages (Alt+M)", NULL);
    gtk_actionable_set_detailed_action_name(GTK_ACTIONABLE(all), "win.page::messages");
    GtkWidget *close = icon_button_make("window-close-symbolic", "Close", NULL);
    gtk_widget_add_css_class(close, "flat");
    gtk_widget_set_valign(all, GTK_ALIGN_CENTER);
    gtk_widget_set_valign(close, GTK_ALIGN_CENTER);
    g_signal_connect_swapped(close, "clicked", G_CALLBACK(close_strip), p);
    gtk_box_append(GTK_BOX(strip), all);
    gtk_box_append(GTK_BOX(strip), close);
    gtk_widget_set_visible(strip, FALSE);
    return strip;
}

/* ---- All of it ---- */

messages_panel *messages_panel_new(void)
{
    messages_panel *p = g_new0(messages_panel, 1);
    GtkWidget *content;
    p->list = messages_new();
    p->root = page_make(&content);
    p->group = group_make("What was said about the scene", &p->list_box);
    p->empty = text_make("Nothing was said about the scene.", "dim-label");
    gtk_box_append(GTK_BOX(content), p->group);
    gtk_box_append(GTK_BOX(content), p->empty);
    p->strip = strip_make(p);
    show_whether_empty(p);
    return p;
}

void messages_panel_free(messages_panel *p)
{
    if (!p)
        return;
    g_ptr_array_unref(p->list);
    g_free(p);
}

GtkWidget *messages_panel_widget(messages_panel *p)
{
    return p->root;
}

GtkWidget *messages_panel_strip(messages_panel *p)
{
    return p->strip;
}

void messages_panel_add(messages_panel *p, message_kind kind, const char *text)
{
    messages_add(p->list, kind, text);
    append_row(p, p->list->pdata[p->list->len - 1]);
    show_whether_empty(p);
    if (kind != MESSAGE_NOTE)
        show_strip(p);
}

/* Warnings and errors, one a line. */
static char *what_is_wrong(const messages_panel *p)
{
    GString *out = g_string_new(NULL);
    for (guint i = 0; i < p->list->len; i++) {
        const message *m = p->list->pdata[i];
        if (m->kind != MESSAGE_NOTE)
            g_string_append_printf(out, "%s\n", m->text);
    }
    return g_string_free(out, FALSE);
}

void messages_panel_show(messages_panel *p, const char *path, const GPtrArray *list)
{
    g_autofree char *before = what_is_wrong(p);
    g_autofree char *folder = g_path_get_dirname(path);
    g_autofree char *prefix = g_strconcat(folder, G_DIR_SEPARATOR_S, NULL);
    bool was_shown = gtk_widget_get_visible(p->strip);
    clear(p);
    for (guint i = 0; i < list->len; i++) {
        const message *m = list->pdata[i];
        bool is_near = g_str_has_prefix(m->text, prefix);
        messages_add(p->list, m->kind, m->text + (is_near ? strlen(prefix) : 0));
        append_row(p, p->list->pdata[i]);
    }
    show_whether_empty(p);
    g_autofree char *now = what_is_wrong(p);
    if (strcmp(now, before) != 0 || was_shown)
        show_strip(p);
}

const GPtrArray *messages_panel_list(const messages_panel *p)
{
    return p->list;
}
