#include "panels/photon_panel.h"

#include "widgets/widgets.h"

#include <string.h>

static const char *const map_names[NEPH_N_PHOTON_CLASSES] = {"Direct", "Indirect",
                                                             "Caustic"};

struct photon_panel {
    GtkWidget *root, *content, *trace, *spinner, *follows;
    GtkWidget *time, *rays, *emitted, *stored, *memory, *of_map[NEPH_N_PHOTON_CLASSES];
    GtkWidget *unsent, *frame, *legend;
    GtkWidget *maps[NEPH_N_PHOTON_CLASSES], *coloring, *point_size, *wireframe, *radius;
    GtkWidget *hint, *picked, *picked_list, *path;
    photon_panel_events events;
};

/* ---- What the user changes ---- */

static void put_dot(GString *out, const uint8_t color[4], const char *text)
{
    g_autofree char *dot = g_markup_printf_escaped(
        "%s<span foreground=\"#%02x%02x%02x\">●</span> %s", out->len > 0 ? "   " : "",
        color[0], color[1], color[2], text);
    g_string_append(out, dot);
}

/* What the colours mean. */
static void show_legend(photon_panel *p, cloud_coloring coloring)
{
    g_autoptr(GString) text = g_string_new(NULL);
    uint8_t color[4];
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES && coloring == COLOR_MAP; c++) {
        photon_cloud_map_color(c, color);
        put_dot(text, color, map_names[c]);
    }
    for (unsigned i = 0; i < N_BOUNCE_COLORS && coloring == COLOR_BOUNCE; i++) {
        g_autofree char *number =
            g_strdup_printf(i + 1 < N_BOUNCE_COLORS ? "%u" : "%u and more", i);
        photon_cloud_bounce_color(i, color);
        put_dot(text, color, number);
    }
    if (coloring == COLOR_FLUX)
        g_string_append(text, "Flux over its largest component");
    if (coloring == COLOR_POWER)
        g_string_append(text, "Flux over the largest of all photons");
    gtk_label_set_markup(GTK_LABEL(p->legend), text->str);
}

static void style_changed(photon_panel *p)
{
    photon_style style = {
        .coloring =
            (cloud_coloring)gtk_drop_down_get_selected(GTK_DROP_DOWN(p->coloring)),
        .point_size = (float)gtk_range_get_value(GTK_RANGE(p->point_size)),
        .wireframe = gtk_switch_get_active(GTK_SWITCH(p->wireframe))};
    for (unsigned c = 0; c < NEPH_N_PHOTON_CLASSES; c++)
        if (gtk_toggle_button_get_active(GTK_TOGGLE_BUTTON(p->maps[c])))
            style.maps |= 1u << c;
    show_legend(p, style.coloring);
    p->events.style_changed(&style, p->events.data);
}

static void radius_changed(photon_panel *p)
{
    p->events.radius_changed(gtk_spin_button_get_value(GTK_SPIN_BUTTON(p->radius)),
                             p->events.data);
}

bool photon_panel_follows(const photon_panel *p)
{
    return gtk_switch_get_active(GTK_SWITCH(p->follows));
}

/* ---- Building ---- */

static GtkWidget *on_switch(const char *name)
{
    GtkWidget *made = gtk_switch_new();
    gtk_switch_set_active(GTK_SWITCH(made), TRUE);
    gtk_widget_set_name(made, name);
    return made;
}

static void add_tracing(photon_panel *p, GtkAdjustment *number)
{
    GtkWidget *list, *group = group_make("Trace", &list);
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 8);
    GtkWidget *photons = spin_make(1, 1e12, 1000, true);
    gtk_spin_button_set_adjustment(GTK_SPIN_BUTTON(photons), number);
    gtk_widget_set_name(photons, "photons-emitted");
    row_add(list, "Photons emitted", photons);
    p->follows = on_switch("follow-changes");
    gtk_widget_set_tooltip_text(row_add(list, "Again on every change", p->follows),
                                "Traces anew whenever a setting changes while the "
                                "photons are in view");
    p->trace = text_button_make("Trace photons", "Without rendering a picture (Ctrl+T)",
                                "win.trace-photons");
    gtk_widget_add_css_class(p->trace, "suggested-action");
    gtk_widget_set_hexpand(p->trace, TRUE);
    p->spinner = gtk_spinner_new();
    gtk_widget_set_visible(p->spinner, FALSE);
    widget_name(p->spinner, "Photons are being traced");
    gtk_box_append(GTK_BOX(box), p->trace);
    gtk_box_append(GTK_BOX(box), p->spinner);
    gtk_box_append(GTK_BOX(group), box);
    p->unsent = text_make("A render with these settings sends no photons. The integrator "
                          "photonmap, on the page Settings, sends all that there are.",
                          "dim-label");
    gtk_widget_set_visible(p->unsent, FALSE);
    gtk_box_append(GTK_BOX(group), p->unsent);
    gtk_box_append(GTK_BOX(p->content), group);
}

static void add_numbers(photon_panel *p)
{
    GtkWidget *list, *group = group_make("Traced", &list);
    p->time = value_row_add(list, "Photon trace time");
    p->rays = value_row_add(list, "Photon rays traced");
    p->emitted = value_row_add(list, "Photons emitted");
    p->stored = value_row_add(list, "Photons stored");
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++) {
        p->of_map[c] = value_row_add(list, map_names[c]);
        gtk_widget_set_tooltip_text(gtk_widget_get_parent(p->of_map[c]),
                                    "Stored, of those emitted for this map, and the "
                                    "radius within which a render gathers them");
    }
    p->memory = value_row_add(list, "Memory");
    p->frame = value_row_add(list, "One frame");
    gtk_widget_set_tooltip_text(gtk_widget_get_parent(p->frame),
                                "Time to draw the photons; while the view moves slow "
                                "graphics draw only some of them");
    gtk_box_append(GTK_BOX(p->content), group);
}

static GtkWidget *maps_make(photon_panel *p)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 0);
    gtk_widget_add_css_class(box, "linked");
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++) {
        g_autofree char *title = g_strconcat("Show ", map_names[c], " photons", NULL);
        p->maps[c] = gtk_toggle_button_new_with_label(map_names[c]);
        gtk_toggle_button_set_active(GTK_TOGGLE_BUTTON(p->maps[c]), TRUE);
        gtk_widget_set_name(p->maps[c], map_names[c]);
        gtk_widget_set_tooltip_text(p->maps[c], title);
        g_signal_connect_swapped(p->maps[c], "toggled", G_CALLBACK(style_changed), p);
        gtk_box_append(GTK_BOX(box), p->maps[c]);
    }
    return box;
}

static void add_style(photon_panel *p)
{
    GtkWidget *list, *group = group_make("Show", &list);
    row_add(list, "Maps", maps_make(p));
    p->coloring = choice_make(cloud_coloring_names);
    gtk_widget_set_name(p->coloring, "coloring");
    p->point_size = slider_make(1.0, 8.0, 0.5, 1);
    gtk_range_set_value(GTK_RANGE(p->point_size), 5.0);
    p->wireframe = on_switch("wireframe");
    row_add(list, "Colour by", p->coloring);
    row_add(list, "Point size", p->point_size);
    row_add(list, "Wireframe", p->wireframe);
    p->legend = text_make("", "caption");
    gtk_widget_add_css_class(p->legend, "dim-label");
    g_signal_connect_swapped(p->coloring, "notify::selected", G_CALLBACK(style_changed),
                             p);
    g_signal_connect_swapped(p->point_size, "value-changed", G_CALLBACK(style_changed),
                             p);
    g_signal_connect_swapped(p->wireframe, "notify::active", G_CALLBACK(style_changed),
                             p);
    show_legend(p, COLOR_FLUX);
    gtk_box_append(GTK_BOX(group), p->legend);
    gtk_box_append(GTK_BOX(p->content), group);
}

static void add_pick(photon_panel *p)
{
    p->picked = group_make("Picked", &p->picked_list);
    p->hint = text_make("Click a photon, or a place on a surface: its neighbours within "
                        "the gather radius, their estimate, and the photon's path from "
                        "the light are shown.",
                        "dim-label");
    gtk_widget_set_visible(p->picked_list, FALSE);
    p->radius = spin_make(0.0, 1e6, 0.01, false);
    gtk_widget_set_tooltip_text(p->radius, "0: each map's own, as a render would gather");
    GtkWidget *list, *group = group_make("Gather", &list);
    row_add_captioned(list, "Radius (m)", "0: each map's own", p->radius);
    g_signal_connect_swapped(p->radius, "value-changed", G_CALLBACK(radius_changed), p);
    p->path = text_make("", "source");
    gtk_label_set_selectable(GTK_LABEL(p->path), TRUE);
    gtk_widget_set_can_focus(p->path, FALSE);
    gtk_widget_set_visible(p->path, FALSE);
    gtk_box_append(GTK_BOX(p->picked), p->hint);
    gtk_box_append(GTK_BOX(p->picked), p->path);
    gtk_box_append(GTK_BOX(p->content), p->picked);
    gtk_box_append(GTK_BOX(p->content), group);
}

photon_panel *photon_panel_new(GtkAdjustment *number, const photon_panel_events *events)
{
    photon_panel *p = g_new0(photon_panel, 1);
    p->events = *events;
    p->root = page_make(&p->content);
    add_tracing(p, number);
    add_numbers(p);
    add_style(p);
    add_pick(p);
    return p;
}

void photon_panel_free(photon_panel *p)
{
    g_free(p);
}

GtkWidget *photon_panel_widget(photon_panel *p)
{
    return p->root;
}

/* ---- What it shows ---- */

static void set_value(GtkWidget *label, const char *format, ...) G_GNUC_PRINTF(2, 3);

static void set_value(GtkWidget *label, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    g_autofree char *text = g_strdup_vprintf(format, arguments);
    va_end(arguments);
    gtk_label_set_text(GTK_LABEL(label), text);
}

static void set_count(GtkWidget *label, guint64 n)
{
    g_autofree char *text = count_text(n);
    gtk_label_set_text(GTK_LABEL(label), text);
}

void photon_panel_show_tracing(photon_panel *p, bool tracing)
{
    gtk_spinner_set_spinning(GTK_SPINNER(p->spinner), tracing);
    gtk_widget_set_visible(p->spinner, tracing);
}

char *photon_share_text(const NephStatistics *s, int c)
{
    g_autofree char *stored = count_text(s->stored[c]);
    g_autofree char *emitted = count_text(s->emitted[c]);
    if (s->emitted[c] == 0)
        return g_strdup("not sent by this render");
    return g_strdup_printf("%s of %s · r %.3g m", stored, emitted, s->radius[c]);
}

char *photon_frame_text(const photon_frame *frame)
{
    g_autofree char *points = count_text(frame->points);
    g_autofree char *all = count_text(frame->all);
    if (!(frame->seconds > 0.0))
        return g_strdup("–");
    if (frame->points < frame->all)
        return g_strdup_printf("%.1f ms · %s of %s", 1e3 * frame->seconds, points, all);
    return g_strdup_printf("%.1f ms · %s photons", 1e3 * frame->seconds, points);
}

void photon_panel_show_frame(photon_panel *p, const photon_frame *frame)
{
    g_autofree char *text = photon_frame_text(frame);
    gtk_label_set_text(GTK_LABEL(p->frame), text);
}

void photon_panel_show_numbers(photon_panel *p, const NephStatistics *s)
{
    guint64 emitted = 0, stored = 0;
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++) {
        emitted += s->emitted[c];
        stored += s->stored[c];
        g_autofree char *share = photon_share_text(s, c);
        set_value(p->of_map[c], "%s", share);
        gtk_widget_set_sensitive(p->maps[c], s->emitted[c] > 0);
    }
    gtk_widget_set_visible(p->unsent, emitted == 0);
    g_autofree char *memory =
        g_format_size_full(s->memory_photons, G_FORMAT_SIZE_IEC_UNITS);
    set_value(p->time, "%.3f s", s->time_trace);
    set_count(p->rays, s->photon_rays);
    set_count(p->emitted, emitted);
    set_count(p->stored, stored);
    set_value(p->memory, "%s", memory);
}

static void add_triple(GtkWidget *list, const char *title, const double v[3])
{
    set_value(value_row_add(list, title), "%.4g  %.4g  %.4g", v[0], v[1], v[2]);
}

static void add_photon(photon_panel *p, const NephPhoton *photon)
{
    double position[3], direction[3], rgb[3];
    for (int i = 0; i < 3; i++) {
        position[i] = (double)photon->position[i];
        direction[i] = -(double)photon->direction[i];
        rgb[i] = (double)photon->rgb[i];
    }
    set_value(value_row_add(p->picked_list, "Photon"), "%s, after %u %s",
              map_names[photon->photon_class], photon->bounces,
              photon->bounces == 1 ? "bounce" : "bounces");
    add_triple(p->picked_list, "At (m)", position);
    add_triple(p->picked_list, "Travels", direction);
    add_triple(p->picked_list, "Flux, R G B (W)", rgb);
}

static void add_estimate(photon_panel *p, const NephEstimate *e)
{
    double sum[3] = {0};
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++) {
        g_autofree char *title = g_strconcat(map_names[c], " neighbours", NULL);
        if (e->radius[c] > 0.0)
            set_value(value_row_add(p->picked_list, title), "%zu within %.3g m", e->n[c],
                      e->radius[c]);
        for (int k = 0; k < 3; k++)
            sum[k] += e->irradiance[c][k];
    }
    add_triple(p->picked_list, "Irradiance (W/m²)", sum);
}

static void show_path(photon_panel *p, const photon_pick *pick)
{
    g_autoptr(GString) text = g_string_new(NULL);
    for (size_t i = 0; i < pick->n_events; i++) {
        const NephPhotonEvent *e = &pick->events[i];
        g_string_append_printf(text, "%s%s%s%s", i ? "\n" : "", e->what,
                               *e->material ? " · " : "", e->material);
    }
    gtk_label_set_text(GTK_LABEL(p->path), text->str);
    gtk_widget_set_visible(p->path, pick->n_events > 0);
}

void photon_panel_show_pick(photon_panel *p, const photon_pick *pick)
{
    GtkWidget *row;
    while ((row = gtk_widget_get_first_child(p->picked_list)))
        gtk_list_box_remove(GTK_LIST_BOX(p->picked_list), row);
    gtk_widget_set_visible(p->picked_list, pick != NULL);
    gtk_widget_set_visible(p->hint, pick == NULL);
    gtk_widget_set_visible(p->path, FALSE);
    if (!pick)
        return;
    if (pick->is_photon)
        add_photon(p, &pick->photon);
    else
        add_triple(p->picked_list, "At (m)", pick->at.position);
    if (*pick->medium) {
        set_value(value_row_add(p->picked_list, "Medium"), "%s", pick->medium);
    } else {
        set_value(value_row_add(p->picked_list, "Surface"), "%s, %s", pick->at.shape_kind,
                  *pick->at.material_name ? pick->at.material_name : "no material");
        add_estimate(p, &pick->estimate);
    }
    show_path(p, pick);
    page_scroll_to(p->root, p->picked);
}
