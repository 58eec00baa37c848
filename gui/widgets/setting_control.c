#include "widgets/setting_control.h"

#include "widgets/widgets.h"

#include <math.h>
#include <string.h>

/* Up to this range a number is a slider. */
#define SLIDER_RANGE 1.0

struct setting_control {
    const NephSettingInfo *info;
    GtkWidget *row, *input, *reset;
    setting_changed changed;
    void *data;
    bool showing; /* the value comes from the program, not from the user */
    double value; /* of a number whose least value stands apart */
};

char *setting_title(const NephSettingInfo *info)
{
    char *title = g_strdup(info->name);
    g_strdelimit(title, "_", ' ');
    title[0] = g_ascii_toupper(title[0]);
    return title;
}

static char *number_text(double value)
{
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    return g_strdup(g_ascii_formatd(text, sizeof text, "%.15g", value));
}

/* What stands apart from the numbers may have a name. */
static char *written(const NephSettingInfo *info, double value)
{
    return info->words && value < info->low ? g_strdup(info->words[0])
                                            : number_text(value);
}

static char *default_text(const NephSettingInfo *info)
{
    if (info->type == NEPH_SETTING_CHOICE)
        return g_strdup(info->words[(int)info->initial]);
    if (info->type == NEPH_SETTING_BOOL)
        return g_strdup(info->initial > 0.5 ? "true" : "false");
    return written(info, info->initial);
}

/* The least value, which may stand apart from the others. */
static double least_of(const NephSettingInfo *info)
{
    return fmin(info->low, info->initial);
}

char *setting_special(const NephSettingInfo *info)
{
    bool number = info->type == NEPH_SETTING_COUNT || info->type == NEPH_SETTING_REAL;
    g_autofree char *low = number_text(least_of(info));
    g_autofree char *pattern = g_strdup_printf("(?:^|[ (])%s(?:: | is )([^;.,(:]+)", low);
    g_autoptr(GRegex) regex = g_regex_new(pattern, 0, 0, NULL);
    g_autoptr(GMatchInfo) match = NULL;
    if (!number || !g_regex_match(regex, info->doc, 0, &match))
        return NULL;
    g_autofree char *meaning = g_match_info_fetch(match, 1);
    return g_strdup_printf("%s: %s", low, g_strstrip(meaning));
}

/* "Radius (m)", "Photons (per pass)". */
static char *title_with_unit(const NephSettingInfo *info)
{
    g_autofree char *title = setting_title(info);
    const char *slash = strchr(info->unit, '/');
    g_autofree char *counted =
        slash ? g_strndup(info->unit, (gsize)(slash - info->unit)) : g_strdup(info->unit);
    if (!*info->unit)
        return g_steal_pointer(&title);
    if (slash && strstr(info->name, counted))
        return g_strdup_printf("%s (per %s)", title, slash + 1);
    return g_strdup_printf("%s (%s)", title, info->unit);
}

/* ---- The value ---- */

static char *value_text(const setting_control *c)
{
    switch (c->info->type) {
    case NEPH_SETTING_BOOL:
        return g_strdup(gtk_switch_get_active(GTK_SWITCH(c->input)) ? "true" : "false");
    case NEPH_SETTING_CHOICE:
        return g_strdup(
            c->info->words[gtk_drop_down_get_selected(GTK_DROP_DOWN(c->input))]);
    case NEPH_SETTING_COUNT:
    case NEPH_SETTING_REAL:
    default:
        break;
    }
    GtkAdjustment *at = GTK_IS_RANGE(c->input)
                            ? gtk_range_get_adjustment(GTK_RANGE(c->input))
                            : gtk_spin_button_get_adjustment(GTK_SPIN_BUTTON(c->input));
    double value = gtk_adjustment_get_value(at);
    return written(c->info, c->info->type == NEPH_SETTING_COUNT ? rint(value) : value);
}

static void show_reset(setting_control *c)
{
    g_autofree char *value = value_text(c), *initial = default_text(c->info);
    bool differs = strcmp(value, initial) != 0;
    gtk_widget_set_sensitive(c->reset, differs);
    gtk_widget_set_opacity(c->reset, differs ? 1.0 : 0.0);
}

/* Between the least value and the others there is nothing: on to the other side. */
static bool leaps_gap(setting_control *c)
{
    const NephSettingInfo *info = c->info;
    if (!(info->initial < info->low) || !GTK_IS_SPIN_BUTTON(c->input))
        return false;
    double before = c->value;
    c->value = gtk_spin_button_get_value(GTK_SPIN_BUTTON(c->input));
    if (!(c->value > info->initial && c->value < info->low))
        return false;
    double other = before < info->low ? info->low : info->initial;
    gtk_spin_button_set_value(GTK_SPIN_BUTTON(c->input), other);
    return true;
}

static void on_input(setting_control *c)
{
    if (leaps_gap(c))
        return; /* and came here again */
    show_reset(c);
    if (c->showing)
        return;
    g_autofree char *value = value_text(c);
    c->changed(c->info, value, c->data);
}

static unsigned word_index(const NephSettingInfo *info, const char *value)
{
    unsigned i = 0;
    while (info->words[i] && strcmp(info->words[i], value) != 0)
        i++;
    return info->words[i] ? i : 0;
}

static double number_of(const NephSettingInfo *info, const char *value)
{
    bool apart = info->words && strcmp(info->words[0], value) == 0;
    return apart ? info->initial : g_ascii_strtod(value, NULL);
}

static void put_value(setting_control *c, const char *value)
{
    if (c->info->type == NEPH_SETTING_BOOL)
        gtk_switch_set_active(GTK_SWITCH(c->input), strcmp(value, "true") == 0);
    else if (c->info->type == NEPH_SETTING_CHOICE)
        gtk_drop_down_set_selected(GTK_DROP_DOWN(c->input), word_index(c->info, value));
    else if (GTK_IS_RANGE(c->input))
        gtk_range_set_value(GTK_RANGE(c->input), number_of(c->info, value));
    else
        gtk_spin_button_set_value(GTK_SPIN_BUTTON(c->input), number_of(c->info, value));
}

void setting_control_show(setting_control *c, const char *value)
{
    c->showing = true;
    put_value(c, value);
    c->showing = false;
    show_reset(c);
}

static void on_reset(setting_control *c)
{
    g_autofree char *initial = default_text(c->info);
    put_value(c, initial);
}

/* ---- The widgets ---- */

/* A step that changes something: 1, or a tenth of the usual value as a power of ten. */
static double step_of(const NephSettingInfo *info)
{
    double usual = fmax(fabs(info->initial), 1.0);
    double step = pow(10.0, floor(log10(usual)) - 1.0);
    return info->type == NEPH_SETTING_COUNT ? fmax(step, 1.0) : fmax(step, 0.01);
}

static GtkWidget *number_make(const NephSettingInfo *info)
{
    bool whole = info->type == NEPH_SETTING_COUNT;
    if (!whole && info->high - info->low <= SLIDER_RANGE)
        return slider_make(info->low, info->high, 0.01, 3);
    GtkWidget *spin = spin_make(least_of(info), info->high, step_of(info), whole);
    if (info->words)
        spin_name_lowest(spin, info->words[0]);
    return spin;
}

/* Words behind that of `high` name presets and are no values. */
static GtkWidget *words_make(const NephSettingInfo *info)
{
    size_t n = (size_t)info->high + 1;
    g_autofree const char **words = g_new0(const char *, n + 1);
    for (size_t i = 0; i < n; i++)
        words[i] = info->words[i];
    return choice_make(words);
}

static GtkWidget *input_make(setting_control *c)
{
    GtkWidget *input;
    switch (c->info->type) {
    case NEPH_SETTING_BOOL:
        input = gtk_switch_new();
        g_signal_connect_swapped(input, "notify::active", G_CALLBACK(on_input), c);
        return input;
    case NEPH_SETTING_CHOICE:
        input = words_make(c->info);
        g_signal_connect_swapped(input, "notify::selected", G_CALLBACK(on_input), c);
        return input;
    case NEPH_SETTING_COUNT:
    case NEPH_SETTING_REAL:
    default:
        input = number_make(c->info);
        g_signal_connect_swapped(input, "value-changed", G_CALLBACK(on_input), c);
        return input;
    }
}

static char *tooltip_text(const NephSettingInfo *info)
{
    g_autofree char *initial = default_text(info);
    g_autofree char *low = number_text(info->low), *high = number_text(info->high);
    const char *none = info->initial < info->low ? initial : "";
    bool number = info->type == NEPH_SETTING_COUNT || info->type == NEPH_SETTING_REAL;
    const char *space = *info->unit ? " " : "";
    GString *out = g_string_new(info->doc);
    g_string_append_printf(out, "\n\nDefault: %s%s%s", initial, space, info->unit);
    if (number)
        g_string_append_printf(out, "\nRange: %s%s%s to %s%s%s", none,
                               *none ? ", or " : "", low, high, space, info->unit);
    g_string_append_printf(out, "\nName: %s", info->name);
    return g_string_free(out, FALSE);
}

static GtkWidget *content_make(setting_control *c, const char *title)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 4);
    c->input = input_make(c);
    gtk_widget_set_valign(c->input, GTK_ALIGN_CENTER);
    gtk_widget_set_name(c->input, c->info->name);
    gtk_accessible_update_property(GTK_ACCESSIBLE(c->input),
                                   GTK_ACCESSIBLE_PROPERTY_LABEL, title,
                                   GTK_ACCESSIBLE_PROPERTY_DESCRIPTION, c->info->doc, -1);
    gtk_box_append(GTK_BOX(box), c->input);
    g_autofree char *reset_name = g_strdup_printf("Reset %s", title);
    c->reset = icon_button_make("edit-undo-symbolic", reset_name, NULL);
    gtk_widget_add_css_class(c->reset, "flat");
    gtk_widget_add_css_class(c->reset, "reset");
    g_signal_connect_swapped(c->reset, "clicked", G_CALLBACK(on_reset), c);
    gtk_box_append(GTK_BOX(box), c->reset);
    return box;
}

setting_control *setting_control_new(GtkWidget *list, const NephSettingInfo *info,
                                     setting_changed changed, void *data)
{
    setting_control *c = g_new0(setting_control, 1);
    g_autofree char *title = title_with_unit(info), *tooltip = tooltip_text(info);
    g_autofree char *special = setting_special(info);
    *c = (setting_control){.info = info, .changed = changed, .data = data};
    c->row = row_add_captioned(list, title, special, content_make(c, title));
    gtk_widget_set_tooltip_text(c->row, tooltip);
    show_reset(c);
    return c;
}

void setting_control_free(setting_control *c)
{
    g_free(c);
}

const NephSettingInfo *setting_control_info(const setting_control *c)
{
    return c->info;
}

GtkWidget *setting_control_row(const setting_control *c)
{
    return c->row;
}

GtkWidget *setting_control_input(const setting_control *c)
{
    return c->input;
}

void setting_control_set_used(setting_control *c, bool used)
{
    gtk_widget_set_sensitive(c->row, used);
}
