#include "widgets/widgets.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

void widget_name(GtkWidget *widget, const char *name)
{
    gtk_accessible_update_property(GTK_ACCESSIBLE(widget), GTK_ACCESSIBLE_PROPERTY_LABEL,
                                   name, -1);
    if (!gtk_widget_get_tooltip_text(widget))
        gtk_widget_set_tooltip_text(widget, name);
}

GtkWidget *label_make(const char *text, const char *css_class)
{
    GtkWidget *label = gtk_label_new(text);
    gtk_label_set_xalign(GTK_LABEL(label), 0.0f);
    if (css_class)
        gtk_widget_add_css_class(label, css_class);
    return label;
}

/* Names and lists are broken anywhere rather than cut, and as they are written. */
void label_break_anywhere(GtkWidget *label)
{
    g_autoptr(PangoAttrList) attributes = pango_attr_list_new();
    pango_attr_list_insert(attributes, pango_attr_insert_hyphens_new(FALSE));
    gtk_label_set_attributes(GTK_LABEL(label), attributes);
    gtk_label_set_wrap(GTK_LABEL(label), TRUE);
    gtk_label_set_wrap_mode(GTK_LABEL(label), PANGO_WRAP_WORD_CHAR);
}

GtkWidget *text_make(const char *text, const char *css_class)
{
    GtkWidget *label = label_make(text, css_class);
    label_break_anywhere(label);
    gtk_label_set_max_width_chars(GTK_LABEL(label), 40);
    return label;
}

GtkWidget *icon_button_make(const char *icon, const char *tooltip, const char *action)
{
    GtkWidget *button = gtk_button_new_from_icon_name(icon);
    gtk_actionable_set_action_name(GTK_ACTIONABLE(button), action);
    widget_name(button, tooltip);
    return button;
}

GtkWidget *text_button_make(const char *text, const char *tooltip, const char *action)
{
    GtkWidget *button = gtk_button_new_with_label(text);
    gtk_actionable_set_action_name(GTK_ACTIONABLE(button), action);
    if (tooltip)
        gtk_widget_set_tooltip_text(button, tooltip);
    return button;
}

GtkWidget *box_make(GtkOrientation orientation, int spacing, int margin)
{
    GtkWidget *box = gtk_box_new(orientation, spacing);
    gtk_widget_set_margin_start(box, margin);
    gtk_widget_set_margin_end(box, margin);
    gtk_widget_set_margin_top(box, margin);
    gtk_widget_set_margin_bottom(box, margin);
    return box;
}

GtkWidget *group_make(const char *title, GtkWidget **list)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 6);
    GtkWidget *heading = label_make(title, "heading");
    *list = gtk_list_box_new();
    gtk_list_box_set_selection_mode(GTK_LIST_BOX(*list), GTK_SELECTION_NONE);
    gtk_list_box_set_show_separators(GTK_LIST_BOX(*list), TRUE);
    gtk_widget_add_css_class(*list, "frame");
    gtk_widget_add_css_class(*list, "group");
    widget_name(*list, title);
    gtk_widget_set_has_tooltip(*list, FALSE);
    gtk_box_append(GTK_BOX(box), heading);
    gtk_box_append(GTK_BOX(box), *list);
    return box;
}

static GtkWidget *append_row(GtkWidget *list, GtkWidget *content)
{
    GtkWidget *row = gtk_list_box_row_new();
    gtk_list_box_row_set_activatable(GTK_LIST_BOX_ROW(row), FALSE);
    gtk_widget_set_focusable(row, FALSE);
    gtk_list_box_row_set_child(GTK_LIST_BOX_ROW(row), content);
    gtk_list_box_append(GTK_LIST_BOX(list), row);
    return row;
}

static GtkWidget *title_make(const char *title, const char *css_class)
{
    GtkWidget *label = label_make(title, css_class);
    gtk_label_set_ellipsize(GTK_LABEL(label), PANGO_ELLIPSIZE_END);
    gtk_label_set_wrap(GTK_LABEL(label), TRUE);
    gtk_label_set_lines(GTK_LABEL(label), 2);
    return label;
}

GtkWidget *row_add_captioned(GtkWidget *list, const char *title, const char *caption,
                             GtkWidget *control)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 8);
    GtkWidget *words = title_make(title, NULL);
    if (caption) {
        GtkWidget *both = gtk_box_new(GTK_ORIENTATION_VERTICAL, 0);
        GtkWidget *small = title_make(caption, "caption");
        gtk_widget_add_css_class(small, "dim-label");
        gtk_box_append(GTK_BOX(both), words);
        gtk_box_append(GTK_BOX(both), small);
        words = both;
    }
    gtk_widget_set_hexpand(words, TRUE);
    gtk_widget_set_valign(words, GTK_ALIGN_CENTER);
    gtk_widget_set_valign(control, GTK_ALIGN_CENTER);
    gtk_accessible_update_property(GTK_ACCESSIBLE(control), GTK_ACCESSIBLE_PROPERTY_LABEL,
                                   title, -1);
    gtk_box_append(GTK_BOX(box), words);
    gtk_box_append(GTK_BOX(box), control);
    return append_row(list, box);
}

GtkWidget *row_add(GtkWidget *list, const char *title, GtkWidget *control)
{
    return row_add_captioned(list, title, NULL, control);
}

/* ---- Pages ---- */

GtkWidget *page_make(GtkWidget **content)
{
    GtkWidget *page = gtk_scrolled_window_new();
    gtk_scrolled_window_set_policy(GTK_SCROLLED_WINDOW(page), GTK_POLICY_NEVER,
                                   GTK_POLICY_AUTOMATIC);
    gtk_widget_set_vexpand(page, TRUE);
    *content = box_make(GTK_ORIENTATION_VERTICAL, 18, 12);
    gtk_scrolled_window_set_child(GTK_SCROLLED_WINDOW(page), *content);
    return page;
}

/* What is to be seen, and how many frames it has had to find its place. */
typedef struct scrolling {
    GtkWidget *group;
    int frames;
} scrolling;

enum { SETTLING_FRAMES = 3 };

static void free_scrolling(void *data)
{
    scrolling *s = data;
    g_object_unref(s->group);
    g_free(s);
}

static gboolean scroll(GtkWidget *page, GdkFrameClock *clock, void *data)
{
    (void)clock;
    scrolling *s = data;
    double x, y;
    GtkAdjustment *at = gtk_scrolled_window_get_vadjustment(GTK_SCROLLED_WINDOW(page));
    if (gtk_widget_translate_coordinates(s->group, page, 0.0, 0.0, &x, &y))
        gtk_adjustment_set_value(at, gtk_adjustment_get_value(at) + y);
    return ++s->frames < SETTLING_FRAMES ? G_SOURCE_CONTINUE : G_SOURCE_REMOVE;
}

void page_scroll_to(GtkWidget *page, GtkWidget *group)
{
    scrolling *s = g_new(scrolling, 1);
    *s = (scrolling){g_object_ref(group), 0};
    gtk_widget_add_tick_callback(page, scroll, s, free_scrolling);
}

GtkWidget *value_row_add(GtkWidget *list, const char *title)
{
    GtkWidget *value = gtk_label_new("–");
    gtk_label_set_selectable(GTK_LABEL(value), TRUE);
    gtk_label_set_xalign(GTK_LABEL(value), 1.0f);
    gtk_widget_add_css_class(value, "numeric");
    gtk_widget_set_can_focus(value, FALSE);
    gtk_label_set_ellipsize(GTK_LABEL(value), PANGO_ELLIPSIZE_MIDDLE);
    gtk_widget_add_css_class(row_add(list, title, value), "value");
    return value;
}

/* ---- Numbers, in any locale ---- */

/* The lowest value's name in spin_name_lowest. */
#define LOWEST "neph-lowest"

static double lowest_of(GtkSpinButton *spin)
{
    return gtk_adjustment_get_lower(gtk_spin_button_get_adjustment(spin));
}

static int read_number(GtkSpinButton *spin, double *value, void *data)
{
    (void)data;
    const char *text = gtk_editable_get_text(GTK_EDITABLE(spin));
    char *end = NULL;
    if (g_strcmp0(text, g_object_get_data(G_OBJECT(spin), LOWEST)) == 0) {
        *value = lowest_of(spin);
        return TRUE;
    }
    *value = g_ascii_strtod(text, &end);
    while (end && g_ascii_isspace(*end))
        end++;
    return end == text || *end || !isfinite(*value) ? GTK_INPUT_ERROR : TRUE;
}

static gboolean write_number(GtkSpinButton *spin, void *data)
{
    (void)data;
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    double value = gtk_spin_button_get_value(spin);
    bool whole = fabs(value - rint(value)) <= 0.0 && fabs(value) < 1e15;
    const char *lowest = g_object_get_data(G_OBJECT(spin), LOWEST);
    const char *shown = lowest && value <= lowest_of(spin) ? lowest : text;
    g_ascii_formatd(text, sizeof text, whole ? "%.0f" : "%.6g", value);
    if (g_strcmp0(shown, gtk_editable_get_text(GTK_EDITABLE(spin))) != 0)
        gtk_editable_set_text(GTK_EDITABLE(spin), shown);
    return TRUE;
}

/* ---- The wheel ---- */

static void set_wheel(GtkWidget *input, GtkPropagationPhase phase)
{
    g_autoptr(GListModel) all = gtk_widget_observe_controllers(input);
    for (guint i = 0; i < g_list_model_get_n_items(all); i++) {
        g_autoptr(GtkEventController) one = g_list_model_get_item(all, i);
        if (GTK_IS_EVENT_CONTROLLER_SCROLL(one))
            gtk_event_controller_set_propagation_phase(one, phase);
    }
}

static void take_wheel(GtkEventController *focus)
{
    set_wheel(gtk_event_controller_get_widget(focus), GTK_PHASE_BUBBLE);
}

static void leave_wheel(GtkEventController *focus)
{
    set_wheel(gtk_event_controller_get_widget(focus), GTK_PHASE_NONE);
}

/* The wheel is the page's, over whatever it comes to be: it turns a number only where the
   user has gone into it. */
static void wheel_needs_focus(GtkWidget *input)
{
    GtkEventController *focus = gtk_event_controller_focus_new();
    g_signal_connect(focus, "enter", G_CALLBACK(take_wheel), NULL);
    g_signal_connect(focus, "leave", G_CALLBACK(leave_wheel), NULL);
    gtk_widget_add_controller(input, focus);
    set_wheel(input, GTK_PHASE_NONE);
}

GtkWidget *spin_make(double low, double high, double step, bool whole)
{
    GtkWidget *spin = gtk_spin_button_new_with_range(low, high, step);
    gtk_spin_button_set_digits(GTK_SPIN_BUTTON(spin), whole ? 0 : 12);
    gtk_spin_button_set_numeric(GTK_SPIN_BUTTON(spin), FALSE);
    gtk_editable_set_width_chars(GTK_EDITABLE(spin), 8);
    gtk_editable_set_max_width_chars(GTK_EDITABLE(spin), 8);
    g_signal_connect(spin, "input", G_CALLBACK(read_number), NULL);
    g_signal_connect(spin, "output", G_CALLBACK(write_number), NULL);
    gtk_spin_button_update(GTK_SPIN_BUTTON(spin));
    wheel_needs_focus(spin);
    return spin;
}

void spin_name_lowest(GtkWidget *spin, const char *word)
{
    g_object_set_data(G_OBJECT(spin), LOWEST, (void *)word);
    gtk_spin_button_update(GTK_SPIN_BUTTON(spin));
}

GtkWidget *slider_make(double low, double high, double step, int digits)
{
    GtkWidget *scale =
        gtk_scale_new_with_range(GTK_ORIENTATION_HORIZONTAL, low, high, step);
    gtk_scale_set_digits(GTK_SCALE(scale), digits);
    gtk_scale_set_draw_value(GTK_SCALE(scale), TRUE);
    gtk_scale_set_value_pos(GTK_SCALE(scale), GTK_POS_LEFT);
    gtk_widget_set_size_request(scale, 170, -1);
    wheel_needs_focus(scale);
    return scale;
}

char *count_text(guint64 n)
{
    g_autofree char *digits = g_strdup_printf("%" G_GUINT64_FORMAT, n);
    GString *out = g_string_new(NULL);
    size_t length = strlen(digits);
    for (size_t i = 0; i < length; i++) {
        if (i > 0 && (length - i) % 3 == 0)
            g_string_append(out, "\u202f"); /* a narrow space where no line breaks */
        g_string_append_c(out, digits[i]);
    }
    return g_string_free(out, FALSE);
}

GtkWidget *drawing_make(const char *name, GtkDrawingAreaDrawFunc draw, void *data)
{
    GtkWidget *area = g_object_new(GTK_TYPE_DRAWING_AREA, "accessible-role",
                                   GTK_ACCESSIBLE_ROLE_IMG, NULL);
    gtk_drawing_area_set_draw_func(GTK_DRAWING_AREA(area), draw, data, NULL);
    widget_name(area, name);
    gtk_widget_set_has_tooltip(area, FALSE);
    return area;
}

GtkWidget *choice_make(const char *const *words)
{
    return gtk_drop_down_new_from_strings(words);
}
