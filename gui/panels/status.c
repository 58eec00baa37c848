#include "panels/status.h"

#include "widgets/widgets.h"

#include <math.h>

struct status {
    GtkWidget *root, *bar, *name, *text, *messages, *pointer;
};

char *status_duration(double seconds)
{
    long whole = lrint(fmin(seconds, 1e9));
    if (seconds < 10.0)
        return g_strdup_printf("%.1f s", seconds);
    if (whole < 60)
        return g_strdup_printf("%ld s", whole);
    if (whole < 3600)
        return g_strdup_printf("%ld min %ld s", whole / 60, whole % 60);
    return g_strdup_printf("%ld h %ld min", whole / 3600, whole / 60 % 60);
}

static void put_state(GString *out, const session_news *news)
{
    static const char *const words[] = {
        [SESSION_EMPTY] = "No scene",      [SESSION_LOADING] = "Reading the scene…",
        [SESSION_RENDERING] = "Rendering", [SESSION_PAUSED] = "Paused",
        [SESSION_STOPPED] = "Stopped",     [SESSION_DONE] = "Done"};
    g_string_append(out, words[news->state]);
}

char *status_text(const session_news *news)
{
    const NephStatistics *s = &news->statistics;
    GString *out = g_string_new(NULL);
    put_state(out, news);
    if (news->state == SESSION_EMPTY || news->state == SESSION_LOADING)
        return g_string_free(out, FALSE);
    if (s->passes_wanted > 0)
        g_string_append_printf(out, " · pass %" G_GINT64_FORMAT " of %" G_GINT64_FORMAT,
                               s->passes, s->passes_wanted);
    else
        g_string_append_printf(out, " · pass %" G_GINT64_FORMAT, s->passes);
    g_autofree char *elapsed = status_duration(s->time_total);
    g_string_append_printf(out, " · %s", elapsed);
    if (isfinite(s->noise))
        g_string_append_printf(out, " · noise %.2g %%", 100.0 * s->noise);
    if (news->state == SESSION_RENDERING && news->fraction > 0.02) {
        g_autofree char *left =
            status_duration(s->time_total * (1.0 / news->fraction - 1.0));
        g_string_append_printf(out, " · %s left", left);
    }
    return g_string_free(out, FALSE);
}

status *status_new(void)
{
    status *s = g_new0(status, 1);
    s->root = gtk_box_new(GTK_ORIENTATION_VERTICAL, 0);
    s->bar = gtk_progress_bar_new();
    widget_name(s->bar, "Progress of the render");
    GtkWidget *line = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 12);
    gtk_widget_add_css_class(line, "statusbar-line");
    s->name = label_make("", "heading");
    gtk_label_set_ellipsize(GTK_LABEL(s->name), PANGO_ELLIPSIZE_MIDDLE);
    gtk_label_set_max_width_chars(GTK_LABEL(s->name), 28);
    gtk_box_append(GTK_BOX(line), s->name);
    s->text = label_make("", "numeric");
    gtk_label_set_ellipsize(GTK_LABEL(s->text), PANGO_ELLIPSIZE_END);
    gtk_widget_set_hexpand(s->text, TRUE);
    s->messages = text_button_make("", "The page of messages (Alt+M)", NULL);
    gtk_actionable_set_detailed_action_name(GTK_ACTIONABLE(s->messages),
                                            "win.page::messages");
    gtk_widget_add_css_class(s->messages, "flat");
    gtk_widget_add_css_class(s->messages, "summary");
    gtk_widget_set_visible(s->messages, FALSE);
    s->pointer = gtk_label_new("");
    gtk_widget_add_css_class(s->pointer, "numeric");
    gtk_widget_add_css_class(s->pointer, "dim-label");
    gtk_label_set_ellipsize(GTK_LABEL(s->pointer), PANGO_ELLIPSIZE_START);
    gtk_box_append(GTK_BOX(line), s->text);
    gtk_box_append(GTK_BOX(line), s->messages);
    gtk_box_append(GTK_BOX(line), s->pointer);
    gtk_box_append(GTK_BOX(s->root), s->bar);
    gtk_box_append(GTK_BOX(s->root), line);
    return s;
}

void status_free(status *s)
{
    g_free(s);
}

GtkWidget *status_widget(status *s)
{
    return s->root;
}

void status_show(status *s, const session_news *news)
{
    g_autofree char *text = status_text(news);
    gtk_label_set_text(GTK_LABEL(s->text), text);
    if (news->state == SESSION_LOADING)
        gtk_progress_bar_pulse(GTK_PROGRESS_BAR(s->bar));
    else
        gtk_progress_bar_set_fraction(GTK_PROGRESS_BAR(s->bar),
                                      CLAMP(news->fraction, 0.0, 1.0));
}

void status_show_messages(status *s, const char *summary)
{
    gtk_button_set_label(GTK_BUTTON(s->messages), summary ? summary : "");
    gtk_widget_set_visible(s->messages, summary != NULL);
}

void status_show_name(status *s, const char *name, const char *path)
{
    gtk_label_set_text(GTK_LABEL(s->name), name);
    gtk_widget_set_tooltip_text(s->name, path);
}

void status_show_pointer(status *s, const char *text)
{
    gtk_label_set_text(GTK_LABEL(s->pointer), text ? text : "");
}
