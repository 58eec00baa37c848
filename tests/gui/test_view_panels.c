/*
 * The window's panels, driven by their controls: photons traced, shown and picked; the
 * camera focused, moved and kept; the picture inspected and compared; materials drawn.
 */
#include "view_run.h"

#include <math.h>
#include <string.h>

static window *open_scene(const char *name)
{
    g_autofree char *path = view_write(name, view_scene);
    window *w = view_window();
    window_open(w, path);
    view_wait(view_is_done, w);
    return w;
}

/* The widget of that name below another, or NULL. */
static GtkWidget *find_widget(GtkWidget *from, const char *name)
{
    if (strcmp(gtk_widget_get_name(from), name) == 0)
        return from;
    GtkWidget *child = gtk_widget_get_first_child(from), *found = NULL;
    for (; child && !found; child = gtk_widget_get_next_sibling(child))
        found = find_widget(child, name);
    return found;
}

/* Whether a row of that title shows a text. */
static const char *row_value(GtkWidget *from, const char *title)
{
    if (GTK_IS_LABEL(from) && strcmp(gtk_label_get_text(GTK_LABEL(from)), title) == 0) {
        GtkWidget *value = gtk_widget_get_next_sibling(from);
        return value && GTK_IS_LABEL(value) ? gtk_label_get_text(GTK_LABEL(value)) : NULL;
    }
    const char *found = NULL;
    GtkWidget *child = gtk_widget_get_first_child(from);
    for (; child && !found; child = gtk_widget_get_next_sibling(child))
        found = row_value(child, title);
    return found;
}

/* The number that a row shows, whatever stands between its digits. */
static guint64 row_count(GtkWidget *from, const char *title)
{
    guint64 n = 0;
    for (const char *at = row_value(from, title); *at; at++)
        if (g_ascii_isdigit(*at))
            n = 10 * n + (guint64)g_ascii_digit_value(*at);
    return n;
}

/* ---- Photons ---- */

static bool has_photons(window *w)
{
    return w->photons && !w->tracing;
}

static window *trace_photons(const char *name)
{
    window *w = open_scene(name);
    view_activate(w, "win.trace-photons");
    view_wait(has_photons, w);
    return w;
}

static void test_trace(void)
{
    window *w = trace_photons("trace.pbrt");
    GtkWidget *panel = photon_panel_widget(w->photon_panel);
    const photon_cloud *cloud = photon_view_cloud(w->photon_view);
    NephStatistics s;
    neph_photons_statistics(w->photons->photons, &s);
    g_assert_cmpuint(cloud->n, ==, s.stored[0] + s.stored[1] + s.stored[2]);
    g_assert_cmpuint(cloud->n, >, 500);
    g_assert_cmpuint(row_count(panel, "Photons stored"), ==, cloud->n);
    g_assert_cmpuint(row_count(panel, "Photon rays traced"), ==, s.photon_rays);
    g_assert_cmpuint(row_count(panel, "Photons emitted"), ==,
                     s.emitted[0] + s.emitted[1] + s.emitted[2]);
    g_assert_cmpfloat(g_ascii_strtod(row_value(panel, "Photon trace time"), NULL), >,
                      0.0);
    view_close(w);
}

/* The number beside the button is the setting itself, and photons follow it. */
/* What photons are traced for is the picture's size and view, whatever coarse look the
   render is at. */
static void test_same_photons(void)
{
    window *w = trace_photons("same.pbrt");
    double radius[3] = {0.0};
    for (int i = 0; i < 4; i++) {
        NephStatistics statistics;
        view_activate(w, i % 2 ? "win.stop" : "win.restart");
        view_activate(w, "win.trace-photons");
        while (w->tracing)
            g_main_context_iteration(NULL, TRUE);
        neph_photons_statistics(w->photons->photons, &statistics);
        for (int c = 0; c < 3; c++)
            g_assert_true(i == 0 || !(fabs(radius[c] - statistics.radius[c]) > 0.0));
        memcpy(radius, statistics.radius, sizeof radius);
    }
    view_close(w);
}

static void test_number(void)
{
    window *w = trace_photons("number.pbrt");
    GtkWidget *spin =
        find_widget(photon_panel_widget(w->photon_panel), "photons-emitted");
    held_photons *old = held_photons_ref(w->photons);
    gtk_spin_button_set_value(GTK_SPIN_BUTTON(spin), 300);
    g_autofree char *value =
        neph_settings_get(settings_panel_values(w->settings), "photons");
    g_assert_cmpstr(value, ==, "300");
    while (w->photons == old || w->tracing)
        g_main_context_iteration(NULL, TRUE);
    held_photons_unref(old);
    g_assert_cmpuint(photon_view_cloud(w->photon_view)->n, <, MOST_ARROWS);
    view_close(w);
}

static void test_style(void)
{
    window *w = trace_photons("style.pbrt");
    GtkWidget *panel = photon_panel_widget(w->photon_panel);
    GtkWidget *indirect = find_widget(panel, "Indirect");
    gtk_toggle_button_set_active(GTK_TOGGLE_BUTTON(indirect), FALSE);
    gtk_switch_set_active(GTK_SWITCH(find_widget(panel, "wireframe")), FALSE);
    const photon_style *style = photon_view_style(w->photon_view);
    g_assert_cmpuint(style->maps, ==, 5);
    g_assert_false(style->wireframe);
    view_close(w);
}

/* A photon picked where it is seen has itself among its neighbours, and a way that begins
   at the lamp. */
static void test_pick(void)
{
    window *w = trace_photons("pick.pbrt");
    GtkWidget *panel = photon_panel_widget(w->photon_panel);
    const photon_cloud *cloud = photon_view_cloud(w->photon_view);
    double place[2] = {-1.0, -1.0}, p[3];
    for (size_t i = 0; i < cloud->n && !(place[0] > 0.1 && place[0] < 0.9); i++) {
        for (int k = 0; k < 3; k++)
            p[k] = (double)cloud->vertices[i].position[k];
        neph_camera_project(&w->view.camera, p, &place[0], &place[1]);
    }
    g_assert_true(window_pick(w, place, 0.002));
    g_assert_true(w->picked_is_photon);
    g_assert_nonnull(row_value(panel, "Flux, R G B (W)"));
    g_assert_nonnull(row_value(panel, "Irradiance (W/m²)"));
    g_assert_true(window_pick(w, (const double[]){0.5, 0.5}, 0.0));
    g_assert_false(w->picked_is_photon);
    g_assert_cmpstr(w->picked.material_name, ==, "glass");
    window_pick_radius(0.5, w);
    g_assert_nonnull(strstr(row_value(panel, "Direct neighbours"), "0.5 m"));
    view_close(w);
}

static bool is_before_camera(window *w, const float at[3], double place[2])
{
    const double p[3] = {(double)at[0], (double)at[1], (double)at[2]};
    return neph_camera_project(&w->view.camera, p, &place[0], &place[1]) &&
           place[0] > 0.1 && place[0] < 0.9 && place[1] > 0.1 && place[1] < 0.9;
}

/* Photons that fog scattered are drawn; one that is picked tells of the fog and its way,
   and there is no disc around it. */
static void test_pick_in_fog(void)
{
    g_autofree char *text = g_strconcat(
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n"
        "    \"spectrum sigma_a\" [300 0 900 0] \"spectrum sigma_s\" [300 0.5 900 0.5]\n"
        "MediumInterface \"fog\" \"fog\"\n",
        view_scene, NULL);
    g_autofree char *path = view_write("fog.pbrt", text);
    window *w = view_window();
    window_open(w, path);
    view_wait(view_is_done, w);
    view_activate(w, "win.trace-photons");
    view_wait(has_photons, w);
    GtkWidget *panel = photon_panel_widget(w->photon_panel);
    const photon_cloud *cloud = photon_view_cloud(w->photon_view);
    double place[2];
    size_t i = 0;
    g_assert_cmpuint(row_count(panel, "Photons stored"), ==, cloud->n);
    while (i < cloud->n && !(*neph_photons_medium(w->photons->photons, i) &&
                             is_before_camera(w, cloud->vertices[i].position, place)))
        i++;
    g_assert_cmpuint(i, <, cloud->n);
    g_assert_true(window_pick(w, place, 1e-6));
    g_assert_true(w->picked_is_photon);
    g_assert_cmpuint(w->picked_photon, ==, i);
    g_assert_cmpstr(row_value(panel, "Medium"), ==, "fog");
    g_assert_nonnull(row_value(panel, "Flux, R G B (W)"));
    g_assert_null(row_value(panel, "Irradiance (W/m²)"));
    g_assert_null(row_value(panel, "Surface"));
    window_pick_radius(0.5, w);
    g_assert_null(row_value(panel, "Direct neighbours"));
    view_close(w);
}

/* ---- The camera ---- */

static void test_focus(void)
{
    window *w = open_scene("focus.pbrt");
    g_assert_true(window_focus_at(w, (const double[]){0.5, 0.5}));
    g_assert_cmpfloat_with_epsilon(w->view.camera.focal_distance, 1.6, 1e-4);
    view_wait_for_other(w);
    view_close(w);
}

static void test_field_of_view(void)
{
    window *w = open_scene("fov.pbrt");
    GtkWidget *slider =
        find_widget(camera_panel_widget(w->camera_panel), "field-of-view");
    gtk_range_set_value(GTK_RANGE(slider), 30.0);
    g_assert_cmpfloat_with_epsilon(w->view.camera.fov, 30.0, 1e-9);
    view_wait_for_other(w);
    view_activate(w, "win.reset-view");
    g_assert_cmpfloat_with_epsilon(w->view.camera.fov, 50.0, 1e-4);
    view_activate(w, "win.frame-view");
    g_assert_cmpfloat(w->view.camera.position[2], <, -3.0);
    view_close(w);
}

/* A ball of fog that takes most of the light, with the eye in it or without. */
static window *open_fog_ball(const char *name, const char *eye)
{
    const char *rest = strstr(view_scene, "Camera ");
    const char *world = strstr(view_scene, "WorldBegin\n") + strlen("WorldBegin\n");
    g_autofree char *head = g_strndup(rest, (gsize)(world - rest));
    g_autofree char *text = g_strconcat(
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n"
        "    \"spectrum sigma_a\" [300 2 900 2] \"spectrum sigma_s\" [300 0.1 900 0.1]\n",
        eye, head, "MediumInterface \"\" \"\"\n", world,
        "MediumInterface \"fog\" \"\"\nMaterial \"interface\"\n"
        "Shape \"sphere\" \"float radius\" 1\n",
        NULL);
    g_autofree char *path = view_write(name, text);
    window *w = view_window();
    window_open(w, path);
    view_wait(view_is_done, w);
    return w;
}

static double mean_of_picture(window *w)
{
    const NephImage *image = canvas_picture(w->canvas)->image;
    NephImageDifference d;
    g_assert_true(neph_image_compare(image, image, &d, NULL));
    return d.mean_a;
}

static double mean_seen_from(window *w, double z)
{
    NephCamera camera = w->view.camera;
    camera.position[2] = z;
    window_camera_changed(&camera, w);
    view_wait_for_other(w);
    return mean_of_picture(w);
}

/* The eye that flies into fog sees what one does that was put there, and flown out again
   what it saw before. */
static void test_fly_into_fog(void)
{
    window *w = open_fog_ball("out.pbrt", "LookAt 0 0 -2  0 0 0  0 1 0\n");
    double outside = mean_of_picture(w);
    double flown_in = mean_seen_from(w, -0.8), flown_out = mean_seen_from(w, -2.0);
    view_close(w);
    w = open_fog_ball("in.pbrt", "MediumInterface \"\" \"fog\"\n"
                                 "LookAt 0 0 -0.8  0 0 0  0 1 0\n");
    double inside = mean_of_picture(w);
    view_close(w);
    g_assert_cmpfloat_with_epsilon(flown_in / inside, 1.0, 1e-3);
    g_assert_cmpfloat_with_epsilon(flown_out / outside, 1.0, 1e-3);
    g_assert_cmpfloat(fabs(inside / outside - 1.0), >, 0.2);
}

static bool is_read_again(window *w)
{
    return view_is_done(w) && fabs(w->scene->camera.fov - 33.0) < 1e-4;
}

/* The saved view is in the file, which is read again, and a moved view survives that. */
static void test_save_view(void)
{
    window *w = open_scene("keep.pbrt");
    NephCamera camera = w->view.camera;
    neph_camera_set_fov(&camera, 33.0);
    window_camera_changed(&camera, w);
    view_activate(w, "win.save-view");
    g_autofree char *text = NULL;
    g_assert_true(g_file_get_contents(document_path(w->document), &text, NULL, NULL));
    g_assert_nonnull(strstr(text, "LookAt 0 0 -2"));
    g_assert_nonnull(strstr(text, "\"float fov\" 33"));
    view_wait(is_read_again, w);
    view_close(w);
}

static bool has_scene(window *w)
{
    return w->scene != NULL;
}

/* A scene of another format is kept as pbrt with the view, and goes on as that. */
static void test_save_view_of_obj(void)
{
    g_autofree char *path = view_write("tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    g_autofree char *kept = g_build_filename(view_folder(), "tri.pbrt", NULL);
    window *w = view_window();
    window_open(w, path);
    view_wait(has_scene, w);
    view_activate(w, "win.stop");
    NephCamera camera = w->view.camera;
    neph_camera_set_fov(&camera, 21.0);
    camera.position[0] += 1.0;
    window_camera_changed(&camera, w);
    gtk_widget_activate_action(GTK_WIDGET(w->gtk), "win.save-view-as", "s", kept);
    while (!g_str_has_suffix(document_path(w->document), ".pbrt") ||
           fabs(w->scene->camera.fov - 21.0) > 1e-3)
        g_main_context_iteration(NULL, TRUE);
    g_assert_cmpfloat_with_epsilon(w->scene->camera.position[0], camera.position[0],
                                   1e-4);
    view_close(w);
}

/* ---- Inspecting ---- */

static void test_inspect(void)
{
    window *w = open_scene("inspect.pbrt");
    static const char *const layers[] = {"direct", "indirect", "caustic",
                                         "albedo", "normal",   "depth"};
    for (size_t i = 0; i < G_N_ELEMENTS(layers); i++) {
        g_assert_true(inspector_show_layer(w->inspector, layers[i]));
        g_assert_cmpstr(canvas_options(w->canvas)->layer, ==, layers[i]);
    }
    g_assert_false(inspector_show_layer(w->inspector, "nonsense"));
    view_activate(w, "win.brighter");
    g_assert_cmpfloat_with_epsilon(canvas_options(w->canvas)->exposure, 0.5f, 1e-6f);
    const NephImage *image = canvas_picture(w->canvas)->image;
    g_autofree char *light = inspector_pixel_text(image, "", 12, 8);
    g_autofree char *depth = inspector_pixel_text(image, "depth", 12, 8);
    g_assert_nonnull(strstr(light, "luminance"));
    g_assert_nonnull(strstr(depth, "12, 8\ndepth      1."));
    g_assert_null(inspector_pixel_text(image, "", 24, 8));
    view_close(w);
}

static bool is_compared(window *w)
{
    const char *rmse = row_value(inspector_widget(w->inspector), "RMSE");
    return rmse && strcmp(rmse, "–") != 0;
}

/* A picture does not differ from itself. */
static void test_compare(void)
{
    window *w = open_scene("compare.pbrt");
    g_autofree char *saved = g_build_filename(view_folder(), "reference.exr", NULL);
    GtkWidget *gtk = GTK_WIDGET(w->gtk);
    gtk_widget_activate_action(gtk, "win.reference", "s", document_path(w->document));
    view_wait_for_word(w, "compare.pbrt");
    gtk_widget_activate_action(gtk, "win.save-picture-as", "s", saved);
    view_wait_for_word(w, "Saved");
    gtk_widget_activate_action(gtk, "win.reference", "s", saved);
    view_wait(is_compared, w);
    double rmse = g_ascii_strtod(row_value(inspector_widget(w->inspector), "RMSE"), NULL);
    g_assert_cmpfloat(rmse, <, 1e-3);
    view_close(w);
}

static bool has_its_place(window *w)
{
    return gtk_widget_get_width(canvas_widget(w->canvas)) > 0;
}

static void test_zoom(void)
{
    window *w = open_scene("zoom.pbrt");
    view_wait(has_its_place, w);
    view_activate(w, "win.zoom-one");
    g_assert_cmpfloat_with_epsilon(canvas_zoom(w->canvas), 1.0, 1e-9);
    view_activate(w, "win.zoom-in");
    g_assert_cmpfloat_with_epsilon(canvas_zoom(w->canvas), 1.5, 1e-9);
    double x, y;
    canvas_to_picture(w->canvas, 0.5 * gtk_widget_get_width(canvas_widget(w->canvas)),
                      0.5 * gtk_widget_get_height(canvas_widget(w->canvas)), &x, &y);
    g_assert_cmpfloat_with_epsilon(x, 0.5, 1e-9);
    view_activate(w, "win.zoom-fit");
    g_assert_cmpfloat(canvas_zoom(w->canvas), >, 2.0);
    view_close(w);
}

/* ---- The rest ---- */

static void test_materials(void)
{
    window *w = open_scene("materials.pbrt");
    gtk_widget_activate_action(GTK_WIDGET(w->gtk), "win.view", "s", "materials");
    g_assert_true(lobe_view_choose(w->lobes, "glass"));
    g_autofree char *svg = lobe_view_svg(w->lobes);
    g_assert_nonnull(strstr(svg, ">glass<"));
    g_assert_false(lobe_view_choose(w->lobes, "nonsense"));
    view_close(w);
}

static void test_numbers(void)
{
    window *w = open_scene("numbers.pbrt");
    GtkWidget *panel = numbers_panel_widget(w->numbers);
    static const char *const titles[] = {"Photon trace time", "Photon rays traced",
                                         "Map build time",    "of that, gather time",
                                         "Emitted",           "Stored",
                                         "Photons a pass",    "Planning"};
    for (size_t i = 0; i < G_N_ELEMENTS(titles); i++)
        g_assert_cmpstr(row_value(panel, titles[i]), !=, "–");
    g_assert_cmpstr(row_value(panel, "Passes"), ==, "2");
    view_close(w);
}

/* The window is found again as it was left. */
static void test_remembered(void)
{
    window *w = open_scene("state.pbrt");
    gtk_widget_activate_action(GTK_WIDGET(w->gtk), "win.theme", "s", "dark");
    view_activate(w, "win.sidebar");
    gtk_window_close(w->gtk);
    view_settle();
    window_state state = window_state_load();
    g_assert_cmpint(state.theme, ==, THEME_DARK);
    g_assert_false(state.sidebar);
    state = (window_state){
        .width = 1000, .height = 700, .sidebar_width = 400, .sidebar = true};
    window_state_save(&state);
}

/* A preset lies over what the scene asks for, and one click makes final gathering act. */
static void test_presets(void)
{
    window *w = open_scene("presets.pbrt");
    GtkWidget *page = settings_panel_widget(w->settings);
    const NephSettings *values = settings_panel_values(w->settings);
    g_assert_nonnull(find_widget(page, "presets"));
    g_assert_true(gtk_widget_activate_action(page, "settings.preset", "s", "003"));
    values = settings_panel_values(w->settings);
    g_autofree char *photons = neph_settings_get(values, "photons");
    g_autofree char *survivors = neph_settings_get(values, "photon_survivors");
    g_assert_cmpstr(photons, ==, "10000");
    g_assert_cmpstr(survivors, ==, "true");
    view_wait(view_is_done, w);
    window_trace_photons(w);
    view_wait(has_photons, w);
    NephStatistics traced;
    neph_photons_statistics(w->photons->photons, &traced);
    g_assert_cmpuint(traced.emitted[NEPH_PHOTON_INDIRECT], ==, 10000);
    g_assert_cmpuint(traced.emitted[NEPH_PHOTON_DIRECT], ==, 0);
    g_assert_true(gtk_widget_activate_action(page, "settings.preset", "s", "000"));
    GtkWidget *gather = find_widget(page, "use-final-gathering");
    g_signal_emit_by_name(gather, "clicked");
    values = settings_panel_values(w->settings);
    g_autofree char *on = neph_settings_get(values, "final_gather");
    g_assert_cmpstr(on, ==, "true");
    g_assert_true(neph_settings_reads(values, "gather_rays"));
    view_wait(view_is_done, w);
    view_close(w);
}

static void test_help(void)
{
    window *w = open_scene("help.pbrt");
    view_activate(w, "win.show-help-overlay");
    view_settle();
    GtkShortcutsWindow *help =
        gtk_application_window_get_help_overlay(GTK_APPLICATION_WINDOW(w->gtk));
    g_assert_true(gtk_widget_get_visible(GTK_WIDGET(help)));
    gtk_window_close(GTK_WINDOW(help));
    view_close(w);
}

int main(int argc, char **argv)
{
    view_init(&argc, &argv);
    view_add_test("/view-panels/trace", test_trace);
    view_add_test("/view-panels/same-photons", test_same_photons);
    view_add_test("/view-panels/number", test_number);
    view_add_test("/view-panels/style", test_style);
    view_add_test("/view-panels/pick", test_pick);
    view_add_test("/view-panels/pick-in-fog", test_pick_in_fog);
    view_add_test("/view-panels/focus", test_focus);
    view_add_test("/view-panels/field-of-view", test_field_of_view);
    view_add_test("/view-panels/fly-into-fog", test_fly_into_fog);
    view_add_test("/view-panels/save-view", test_save_view);
    view_add_test("/view-panels/save-view-of-obj", test_save_view_of_obj);
    view_add_test("/view-panels/inspect", test_inspect);
    view_add_test("/view-panels/compare", test_compare);
    view_add_test("/view-panels/zoom", test_zoom);
    view_add_test("/view-panels/materials", test_materials);
    view_add_test("/view-panels/numbers", test_numbers);
    view_add_test("/view-panels/remembered", test_remembered);
    view_add_test("/view-panels/presets", test_presets);
    view_add_test("/view-panels/help", test_help);
    return view_run();
}
