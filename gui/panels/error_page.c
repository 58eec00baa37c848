#include "panels/error_page.h"

#include "widgets/widgets.h"

#include <stdlib.h>
#include <string.h>

struct error_page {
    GtkWidget *root, *title, *list, *back;
};

/* ---- Messages ---- */

static void clear_place(void *data)
{
    error_place *place = data;
    g_free(place->file);
    g_free(place->message);
    g_free(place->source);
}

static char *source_line(const char *file, int line)
{
    g_autofree char *text = NULL;
    if (!g_file_get_contents(file, &text, NULL, NULL))
        return NULL;
    const char *at = text;
    for (int i = 1; i < line && at; i++) {
        at = strchr(at, '\n');
        at = at ? at + 1 : NULL;
    }
    if (!at)
        return NULL;
    g_autofree char *found = g_strndup(at, strcspn(at, "\r\n"));
    return g_utf8_make_valid(found, -1);
}

static error_place parse_line(const char *line)
{
    static GRegex *pattern;
    if (!pattern)
        pattern = g_regex_new("^(.+?):(\\d+)(?::(\\d+))?: (.*)$", 0, 0, NULL);
    g_autoptr(GMatchInfo) match = NULL;
    error_place place = {0};
    if (!g_regex_match(pattern, line, 0, &match)) {
        place.message = g_utf8_make_valid(line, -1);
        return place;
    }
    g_autofree char *row = g_match_info_fetch(match, 2);
    g_autofree char *column = g_match_info_fetch(match, 3);
    place.file = g_match_info_fetch(match, 1);
    place.message = g_match_info_fetch(match, 4);
    place.line = atoi(row);
    place.column = atoi(column);
    place.source = source_line(place.file, place.line);
    return place;
}

GArray *error_places(const char *message)
{
    GArray *places = g_array_new(FALSE, TRUE, sizeof(error_place));
    g_array_set_clear_func(places, clear_place);
    g_auto(GStrv) lines = g_strsplit(message, "\n", -1);
    for (size_t i = 0; lines[i]; i++) {
        if (!*lines[i])
            continue;
        error_place place = parse_line(lines[i]);
        g_array_append_val(places, place);
    }
    return places;
}

/* ---- The page ---- */

static GtkWidget *source_view(const error_place *place)
{
    g_autofree char *numbered = g_strdup_printf("%5d │ %s", place->line, place->source);
    GString *text = g_string_new(numbered);
    if (place->column > 0) {
        g_string_append_printf(text, "\n      │ ");
        for (int i = 1; i < place->column; i++)
            g_string_append_c(text, i <= (int)strlen(place->source) &&
                                            place->source[i - 1] == '\t'
                                        ? '\t'
                                        : ' ');
        g_string_append(text, "▲");
    }
    GtkWidget *label = label_make(text->str, "source");
    gtk_label_set_selectable(GTK_LABEL(label), TRUE);
    gtk_widget_set_can_focus(label, FALSE);
    g_string_free(text, TRUE);
    GtkWidget *scroller = gtk_scrolled_window_new();
    gtk_scrolled_window_set_policy(GTK_SCROLLED_WINDOW(scroller), GTK_POLICY_AUTOMATIC,
                                   GTK_POLICY_NEVER);
    gtk_scrolled_window_set_child(GTK_SCROLLED_WINDOW(scroller), label);
    return scroller;
}

static void add_place(error_page *p, const error_place *place)
{
    GtkWidget *box = box_make(GTK_ORIENTATION_VERTICAL, 6, 12);
    if (place->file) {
        g_autofree char *where =
            place->column > 0
                ? g_strdup_printf("%s:%d:%d", place->file, place->line, place->column)
                : g_strdup_printf("%s:%d", place->file, place->line);
        GtkWidget *label = label_make(where, "dim-label");
        gtk_label_set_ellipsize(GTK_LABEL(label), PANGO_ELLIPSIZE_START);
        gtk_widget_set_tooltip_text(label, where);
        gtk_box_append(GTK_BOX(box), label);
    }
    GtkWidget *message = label_make(place->message, NULL);
    label_break_anywhere(message);
    gtk_label_set_selectable(GTK_LABEL(message), TRUE);
    gtk_widget_set_can_focus(message, FALSE);
    gtk_box_append(GTK_BOX(box), message);
    if (place->source)
        gtk_box_append(GTK_BOX(box), source_view(place));
    GtkWidget *row = gtk_list_box_row_new();
    gtk_list_box_row_set_activatable(GTK_LIST_BOX_ROW(row), FALSE);
    gtk_list_box_row_set_child(GTK_LIST_BOX_ROW(row), box);
    gtk_list_box_append(GTK_LIST_BOX(p->list), row);
}

static void clear_list(error_page *p)
{
    GtkWidget *row;
    while ((row = gtk_widget_get_first_child(p->list)))
        gtk_list_box_remove(GTK_LIST_BOX(p->list), row);
}

void error_page_show(error_page *p, const char *file, const char *message,
                     bool can_go_back)
{
    g_autoptr(GArray) places = error_places(message);
    g_autofree char *name = g_path_get_basename(file);
    g_autofree char *shown = g_utf8_make_valid(name, -1);
    g_autofree char *title =
        places->len == 1 ? g_strdup_printf("%s cannot be read", shown)
                         : g_strdup_printf("%s has %u errors", shown, places->len);
    gtk_label_set_text(GTK_LABEL(p->title), title);
    clear_list(p);
    for (guint i = 0; i < places->len; i++)
        add_place(p, &g_array_index(places, error_place, i));
    gtk_widget_set_visible(p->back, can_go_back);
}

static GtkWidget *buttons_make(error_page *p)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6);
    gtk_widget_set_halign(box, GTK_ALIGN_CENTER);
    GtkWidget *reload =
        text_button_make("Try again", "Reads the file again", "win.reload");
    gtk_widget_add_css_class(reload, "suggested-action");
    gtk_box_append(GTK_BOX(box), reload);
    gtk_box_append(GTK_BOX(box), text_button_make("Open another…", NULL, "win.open"));
    p->back = text_button_make("Back to the picture", NULL, "win.dismiss-error");
    gtk_box_append(GTK_BOX(box), p->back);
    return box;
}

error_page *error_page_new(void)
{
    error_page *p = g_new0(error_page, 1);
    p->root = gtk_scrolled_window_new();
    GtkWidget *box = box_make(GTK_ORIENTATION_VERTICAL, 18, 24);
    GtkWidget *icon = gtk_image_new_from_icon_name("dialog-warning-symbolic");
    gtk_image_set_pixel_size(GTK_IMAGE(icon), 48);
    gtk_widget_add_css_class(icon, "dim-label");
    p->title = gtk_label_new(NULL);
    gtk_widget_add_css_class(p->title, "title-2");
    label_break_anywhere(p->title);
    p->list = gtk_list_box_new();
    gtk_list_box_set_selection_mode(GTK_LIST_BOX(p->list), GTK_SELECTION_NONE);
    gtk_list_box_set_show_separators(GTK_LIST_BOX(p->list), TRUE);
    gtk_widget_add_css_class(p->list, "frame");
    widget_name(p->list, "Errors in the scene");
    gtk_widget_set_has_tooltip(p->list, FALSE);
    gtk_box_append(GTK_BOX(box), icon);
    gtk_box_append(GTK_BOX(box), p->title);
    gtk_box_append(GTK_BOX(box), p->list);
    gtk_box_append(GTK_BOX(box), buttons_make(p));
    GtkWidget *hint =
        gtk_label_new("It is read again as soon as one of its files is saved.");
    gtk_widget_add_css_class(hint, "dim-label");
    gtk_label_set_wrap(GTK_LABEL(hint), TRUE);
    gtk_box_append(GTK_BOX(box), hint);
    gtk_widget_set_valign(box, GTK_ALIGN_CENTER);
    gtk_widget_add_css_class(p->list, "group");
    gtk_scrolled_window_set_child(GTK_SCROLLED_WINDOW(p->root), box);
    return p;
}

void error_page_free(error_page *p)
{
    g_free(p);
}

GtkWidget *error_page_widget(error_page *p)
{
    return p->root;
}
