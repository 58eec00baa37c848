#include "panels/camera_panel.h"

#include "widgets/widgets.h"

#include <math.h>

struct camera_panel {
    GtkWidget *root, *fov, *lens, *focus, *place[3], *direction;
    NephCamera camera;
    bool showing;
    camera_listener changed;
    void *data;
};

static double value_of(GtkWidget *spin)
{
    return gtk_spin_button_get_value(GTK_SPIN_BUTTON(spin));
}

static void on_input(camera_panel *p)
{
    if (p->showing)
        return;
    NephCamera *c = &p->camera;
    neph_camera_set_fov(c, gtk_range_get_value(GTK_RANGE(p->fov)));
    c->lens_radius = value_of(p->lens);
    c->focal_distance = fmax(value_of(p->focus), 1e-6);
    for (int i = 0; i < 3; i++)
        c->position[i] = value_of(p->place[i]);
    p->changed(c, p->data);
}

void camera_panel_show(camera_panel *p, const NephCamera *camera)
{
    p->camera = *camera;
    p->showing = true;
    gtk_range_set_value(GTK_RANGE(p->fov), camera->fov);
    gtk_spin_button_set_value(GTK_SPIN_BUTTON(p->lens), camera->lens_radius);
    gtk_spin_button_set_value(GTK_SPIN_BUTTON(p->focus), camera->focal_distance);
    for (int i = 0; i < 3; i++)
        gtk_spin_button_set_value(GTK_SPIN_BUTTON(p->place[i]), camera->position[i]);
    p->showing = false;
    g_autofree char *toward = g_strdup_printf("%.3f  %.3f  %.3f", camera->direction[0],
                                              camera->direction[1], camera->direction[2]);
    gtk_label_set_text(GTK_LABEL(p->direction), toward);
}

static GtkWidget *add_spin(camera_panel *p, GtkWidget *list, const char *title,
                           const char *caption, double low, double step)
{
    GtkWidget *spin = spin_make(low, 1e9, step, false);
    row_add_captioned(list, title, caption, spin);
    g_signal_connect_swapped(spin, "value-changed", G_CALLBACK(on_input), p);
    return spin;
}

static void add_lens(camera_panel *p, GtkWidget *content)
{
    GtkWidget *list, *group = group_make("Lens", &list);
    p->fov = slider_make(1.0, 170.0, 0.5, 1);
    gtk_widget_set_name(p->fov, "field-of-view");
    row_add_captioned(list, "Field of view (°)", "across the shorter side", p->fov);
    g_signal_connect_swapped(p->fov, "value-changed", G_CALLBACK(on_input), p);
    p->lens =
        add_spin(p, list, "Lens radius (m)", "0: a pinhole, all is sharp", 0.0, 0.005);
    p->focus = add_spin(p, list, "Sharp at (m)", "distance along the view", 0.0, 0.05);
    GtkWidget *tool = gtk_toggle_button_new_with_label("Click what is to be sharp");
    gtk_actionable_set_action_name(GTK_ACTIONABLE(tool), "win.focus-tool");
    gtk_widget_set_tooltip_text(tool, "Then click in the picture (Ctrl+D)");
    gtk_box_append(GTK_BOX(group), tool);
    gtk_box_append(GTK_BOX(content), group);
}

static void add_place(camera_panel *p, GtkWidget *content)
{
    static const char *const names[] = {"x (m)", "y (m)", "z (m)"};
    GtkWidget *list, *group = group_make("Camera at", &list);
    for (int i = 0; i < 3; i++)
        p->place[i] = add_spin(p, list, names[i], NULL, -1e9, 0.05);
    p->direction = value_row_add(list, "Looks toward");
    gtk_box_append(GTK_BOX(content), group);
}

static void add_buttons(GtkWidget *content)
{
    GtkWidget *grid = gtk_grid_new();
    static const char *const buttons[][3] = {
        {"As in the scene", "Back to the view of the file (Home)", "win.reset-view"},
        {"Whole scene", "Goes so far back that all is seen (End)", "win.frame-view"},
        {"Copy LookAt", "The view as pbrt LookAt and Camera (Ctrl+Shift+C)",
         "win.copy-view"},
        {"Save in the scene",
         "Writes the view into the scene file; another format is kept as a pbrt scene "
         "beside it (Ctrl+Shift+S)",
         "win.save-view"}};
    gtk_grid_set_row_spacing(GTK_GRID(grid), 6);
    gtk_grid_set_column_spacing(GTK_GRID(grid), 6);
    gtk_grid_set_column_homogeneous(GTK_GRID(grid), TRUE);
    for (int i = 0; i < (int)G_N_ELEMENTS(buttons); i++)
        gtk_grid_attach(GTK_GRID(grid),
                        text_button_make(buttons[i][0], buttons[i][1], buttons[i][2]),
                        i % 2, i / 2, 1, 1);
    gtk_box_append(GTK_BOX(content), grid);
    GtkWidget *help = text_make(
        "Drag to go around, with shift to move across, with the right button to look "
        "around; the wheel goes nearer. Arrow keys go around too, with shift across; "
        "Page Up and Down go nearer and further. W A S D fly, E and Q rise and sink, "
        "shift is faster. A double click chooses what to go around.",
        "dim-label");
    gtk_box_append(GTK_BOX(content), help);
}

camera_panel *camera_panel_new(camera_listener changed, void *data)
{
    camera_panel *p = g_new0(camera_panel, 1);
    *p = (camera_panel){.changed = changed, .data = data, .camera.fov = 90.0};
    p->showing = true;
    GtkWidget *content;
    p->root = page_make(&content);
    add_lens(p, content);
    add_place(p, content);
    add_buttons(content);
    p->showing = false;
    return p;
}

void camera_panel_free(camera_panel *p)
{
    g_free(p);
}

GtkWidget *camera_panel_widget(camera_panel *p)
{
    return p->root;
}
