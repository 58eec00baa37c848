/*
 * The window in people's hands: files dropped and chosen in dialogs, drags, wheel and
 * keys as the X server sends them, and what the screen shows of it, at any scale
 * (GDK_SCALE).
 */
#include "view_hands.h"

#include "photons/projection.h"
#include "window/screenshot.h"

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

/* The n-th controller of a type that a widget has. */
static void *controller_of(GtkWidget *widget, GType type)
{
    g_autoptr(GListModel) all = gtk_widget_observe_controllers(widget);
    for (guint i = 0; i < g_list_model_get_n_items(all); i++) {
        g_autoptr(GObject) one = g_list_model_get_item(all, i);
        if (G_TYPE_CHECK_INSTANCE_TYPE(one, type))
            return one; /* the widget holds it */
    }
    return NULL;
}

/* ---- Drops ---- */

static bool drop(window *w, const GValue *value)
{
    gboolean taken = FALSE;
    void *target = controller_of(w->content, GTK_TYPE_DROP_TARGET);
    g_assert_nonnull(target);
    g_signal_emit_by_name(target, "drop", value, 5.0, 5.0, &taken);
    return taken;
}

static bool drop_file(window *w, const char *path)
{
    g_auto(GValue) value = G_VALUE_INIT;
    g_autoptr(GFile) file = g_file_new_for_path(path);
    g_value_init(&value, G_TYPE_FILE);
    g_value_set_object(&value, file);
    return drop(w, &value);
}

static bool is_compared(window *w)
{
    return canvas_is_split(w->canvas);
}

static void test_drop(void)
{
    g_autofree char *path = view_write("dropped.pbrt", view_scene);
    g_autofree char *picture = g_build_filename(view_folder(), "dropped.PFM", NULL);
    g_autofree char *broken = view_write("no-picture.png", "nonsense");
    window *w = view_window();
    g_assert_true(drop_file(w, picture));
    view_wait_for_word(w, "Open a scene first");
    g_assert_true(drop_file(w, path));
    view_wait(view_is_done, w);
    g_assert_cmpstr(document_path(w->document), ==, path);
    g_assert_true(drop_file(w, broken));
    view_wait_for_word(w, "no-picture.png");
    g_assert_false(canvas_is_split(w->canvas));
    g_assert_true(
        neph_image_write(canvas_picture(w->canvas)->image, picture, 0.0f, NULL));
    g_autoptr(GFile) file = g_file_new_for_path(picture);
    g_auto(GValue) value = G_VALUE_INIT;
    g_value_init(&value, GDK_TYPE_FILE_LIST);
    GdkFileList *list = gdk_file_list_new_from_array(&file, 1);
    g_value_take_boxed(&value, list);
    g_assert_true(drop(w, &value));
    view_wait(is_compared, w);
    view_close(w);
}

/* ---- Dialogs ---- */

static GtkWidget *dialog_on_show(void)
{
    GListModel *all = gtk_window_get_toplevels();
    for (guint i = 0; i < g_list_model_get_n_items(all); i++) {
        g_autoptr(GtkWidget) one = g_list_model_get_item(all, i);
        if (GTK_IS_FILE_CHOOSER(one) && gtk_widget_get_visible(one))
            return one;
    }
    return NULL;
}

static bool asks(window *w)
{
    (void)w;
    return dialog_on_show() != NULL;
}

static bool is_answered(window *w)
{
    return !asks(w);
}

static const char *wanted_path;

static bool has_choice(window *w)
{
    (void)w;
    g_autoptr(GFile) file = gtk_file_chooser_get_file(GTK_FILE_CHOOSER(dialog_on_show()));
    g_autofree char *path = file ? g_file_get_path(file) : NULL;
    return g_strcmp0(path, wanted_path) == 0;
}

/* Answers the dialog that an action opens. NULL: cancels it. A name to save under has to
   be what is suggested. */
static void answer(window *w, const char *action, const char *path)
{
    view_activate(w, action);
    view_wait(asks, w);
    GtkWidget *dialog = dialog_on_show();
    g_assert_true(gtk_window_get_modal(GTK_WINDOW(dialog)));
    if (path) {
        g_autoptr(GFile) file = g_file_new_for_path(path);
        GtkFileChooser *chooser = GTK_FILE_CHOOSER(dialog);
        if (gtk_file_chooser_get_action(chooser) == GTK_FILE_CHOOSER_ACTION_OPEN)
            gtk_file_chooser_set_file(chooser, file, NULL);
        wanted_path = path;
        view_wait(has_choice, w);
    }
    gtk_dialog_response(GTK_DIALOG(dialog),
                        path ? GTK_RESPONSE_ACCEPT : GTK_RESPONSE_CANCEL);
    view_wait(is_answered, w);
}

static void test_dialogs(void)
{
    g_autofree char *path = view_write("chosen.pbrt", view_scene);
    g_autofree char *picture = g_build_filename(view_folder(), "chosen.png", NULL);
    window *w = view_window();
    answer(w, "win.open", NULL);
    g_assert_null(document_path(w->document));
    answer(w, "win.open", path);
    view_wait(view_is_done, w);
    g_assert_cmpstr(document_path(w->document), ==, path);
    answer(w, "win.save-picture", picture);
    view_wait_for_word(w, "Saved");
    g_autoptr(NephImage) saved = neph_image_read(picture, NULL);
    g_assert_nonnull(saved);
    view_close(w);
}

static bool is_recent(window *w)
{
    g_auto(GStrv) recent = document_recent();
    return g_strv_contains((const char *const *)recent, document_path(w->document));
}

static void test_recent(void)
{
    window *w = open_scene("recent.pbrt");
    view_wait(is_recent, w);
    view_close(w);
}

/* ---- Drags and keys ---- */

static double moved_by(const double a[3], const double b[3])
{
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

/* The whole picture follows the quick looks. */
static bool stands_still(window *w)
{
    return view_is_done(w) && !canvas_picture(w->canvas)->coarse;
}

static NephCamera old;

static double turned(const window *w)
{
    return moved_by(old.direction, w->view.camera.direction);
}

static double went(const window *w)
{
    return moved_by(old.position, w->view.camera.position);
}

static double far_from_pivot(const window *w, const NephCamera *camera)
{
    return moved_by(camera->position, w->view.pivot);
}

static bool went_round(window *w)
{
    return went(w) > 0.05;
}

static bool looks_elsewhere(window *w)
{
    return turned(w) > 0.02;
}

static bool went_across(window *w)
{
    return went(w) > 0.01;
}

static bool came_nearer(window *w)
{
    return far_from_pivot(w, &w->view.camera) < far_from_pivot(w, &old) - 1e-3;
}

static void test_drags(void)
{
    hands h;
    if (!hands_find(&h))
        return;
    window *w = open_scene("drags.pbrt");
    GtkWidget *area = canvas_widget(w->canvas);
    old = w->view.camera;
    hands_drag(&h, area, 1); /* around: as far away as before, from elsewhere */
    view_wait(went_round, w);
    g_assert_cmpfloat_with_epsilon(far_from_pivot(w, &w->view.camera),
                                   far_from_pivot(w, &old), 1e-6);
    old = w->view.camera;
    hands_drag(&h, area, 3); /* looks around on the spot */
    view_wait(looks_elsewhere, w);
    g_assert_cmpfloat(went(w), <, 1e-9);
    old = w->view.camera;
    hands_key(&h, GDK_KEY_Shift_L, true);
    hands_drag(&h, area, 1); /* across */
    hands_key(&h, GDK_KEY_Shift_L, false);
    view_wait(went_across, w);
    g_assert_cmpfloat(turned(w), <, 1e-9);
    old = w->view.camera;
    hands_press(&h, 4, true); /* the wheel */
    hands_press(&h, 4, false);
    view_wait(came_nearer, w);
    view_wait(stands_still, w);
    view_close(w);
}

static void test_keys(void)
{
    hands h;
    if (!hands_find(&h))
        return;
    window *w = open_scene("keys.pbrt");
    const NephCamera *camera = &w->view.camera;
    hands_point(&h, canvas_widget(w->canvas), 0.5, 0.5);
    static const unsigned keys[] = {GDK_KEY_w,    GDK_KEY_d,      GDK_KEY_e,
                                    GDK_KEY_Left, GDK_KEY_Right,  GDK_KEY_Up,
                                    GDK_KEY_Down, GDK_KEY_Page_Up};
    for (size_t i = 0; i < G_N_ELEMENTS(keys); i++) {
        old = *camera;
        hands_hold(&h, keys[i]);
        g_assert_cmpfloat(went(w), >, 1e-3);
    }
    hands_hold(&h, GDK_KEY_Home);
    g_assert_cmpfloat(moved_by(w->scene->camera.position, camera->position), <, 1e-9);
    view_wait(view_is_done, w);
    hands_hold(&h, GDK_KEY_F9);
    g_assert_false(gtk_widget_get_visible(w->sidebar));
    hands_hold(&h, GDK_KEY_F9);
    view_close(w);
}

/* Enter picks what is in the middle, as a click there does. */
static void test_pick(void)
{
    hands h;
    if (!hands_find(&h))
        return;
    window *w = open_scene("hand-pick.pbrt");
    view_activate(w, "win.trace-photons");
    view_settle();
    while (!w->photons || w->tracing)
        g_main_context_iteration(NULL, TRUE);
    GtkWidget *area = photon_view_widget(w->photon_view);
    hands_drag(&h, area, 1);
    g_assert_false(w->has_pick);
    hands_point(&h, area, 0.5, 0.5);
    hands_press(&h, 1, true);
    hands_press(&h, 1, false);
    g_assert_true(w->has_pick);
    w->has_pick = false;
    hands_hold(&h, GDK_KEY_Return);
    g_assert_true(w->has_pick);
    view_close(w);
}

static bool grips_divider(window *w)
{
    GdkCursor *cursor = gtk_widget_get_cursor(canvas_widget(w->canvas));
    return cursor && g_strcmp0(gdk_cursor_get_name(cursor), "col-resize") == 0;
}

static bool is_divided_elsewhere(window *w)
{
    return canvas_divider(w->canvas) > 0.55;
}

/* The divider of a split picture is dragged; the view stays where it is. What stands
   around the picture may still move when it is split: the pointer shows when it is
   there. */
static void test_divider(void)
{
    hands h;
    if (!hands_find(&h))
        return;
    window *w = open_scene("divider.pbrt");
    g_autofree char *saved = g_build_filename(view_folder(), "divider.exr", NULL);
    g_assert_true(neph_image_write(canvas_picture(w->canvas)->image, saved, 0.0f, NULL));
    window_set_reference(w, saved);
    view_wait(is_compared, w);
    old = w->view.camera;
    g_assert_cmpfloat(fabs(canvas_divider(w->canvas) - 0.5), <, 1e-12);
    for (int i = 0; i < 100 && !grips_divider(w); i++) {
        hands_point(&h, canvas_widget(w->canvas), 0.4, 0.5);
        hands_point(&h, canvas_widget(w->canvas), 0.5, 0.5);
    }
    g_assert_true(grips_divider(w));
    hands_drag(&h, canvas_widget(w->canvas), 1);
    view_wait(is_divided_elsewhere, w);
    g_assert_cmpfloat(went(w), <, 1e-12);
    view_close(w);
}

/* Two fingers apart: nearer. */
static void test_pinch(void)
{
    window *w = open_scene("pinch.pbrt");
    void *pinch = controller_of(canvas_widget(w->canvas), GTK_TYPE_GESTURE_ZOOM);
    double far = moved_by(w->view.camera.position, w->view.pivot);
    g_signal_emit_by_name(pinch, "begin", NULL);
    g_signal_emit_by_name(pinch, "scale-changed", 1.25);
    g_signal_emit_by_name(pinch, "scale-changed", 2.0);
    g_assert_cmpfloat_with_epsilon(moved_by(w->view.camera.position, w->view.pivot),
                                   0.5 * far, 1e-6);
    view_wait(view_is_done, w);
    view_close(w);
}

/* ---- What the screen shows ---- */

static cairo_surface_t *take_picture(window *w)
{
    g_autofree char *path = g_build_filename(view_folder(), "shown.png", NULL);
    while (!screenshot_take(w->gtk, path, NULL))
        g_main_context_iteration(NULL, TRUE);
    cairo_surface_t *shown = cairo_image_surface_create_from_png(path);
    g_assert_cmpint(cairo_surface_status(shown), ==, CAIRO_STATUS_SUCCESS);
    return shown;
}

/* The brightest component around a place of a widget, pixels of the widget. */
static int brightness(cairo_surface_t *shown, GtkWidget *widget, double x, double y)
{
    double wx, wy, sx, sy;
    int scale = gtk_widget_get_scale_factor(widget), most = 0;
    GtkNative *native = gtk_widget_get_native(widget);
    gtk_widget_translate_coordinates(widget, GTK_WIDGET(native), x, y, &wx, &wy);
    gtk_native_get_surface_transform(native, &sx, &sy);
    const unsigned char *pixels = cairo_image_surface_get_data(shown);
    int stride = cairo_image_surface_get_stride(shown);
    for (int dy = -1; dy <= 0; dy++)
        for (int dx = -1; dx <= 0; dx++) {
            int px = (int)(scale * (wx + sx)) + dx, py = (int)(scale * (wy + sy)) + dy;
            if (px < 0 || py < 0 || px >= cairo_image_surface_get_width(shown) ||
                py >= cairo_image_surface_get_height(shown))
                continue;
            for (int k = 0; k < 3; k++)
                most = MAX(most, pixels[py * stride + 4 * px + k]);
        }
    return most;
}

static bool is_drawn(window *w)
{
    const photon_frame *frame = photon_view_frame(w->photon_view);
    return frame->points > 0 && frame->points == frame->all;
}

/* Photons of the view that are within the widget, and how many of those are bright on the
   screen exactly where a click would look for them. */
static int count_bright(window *w, int *n)
{
    GtkWidget *area = photon_view_widget(w->photon_view);
    const photon_cloud *cloud = photon_view_cloud(w->photon_view);
    const projection seen = {&w->view, gtk_widget_get_width(area),
                             gtk_widget_get_height(area)};
    cairo_surface_t *shown = take_picture(w);
    int scale = gtk_widget_get_scale_factor(area), bright = 0;
    g_assert_cmpint(
        cairo_image_surface_get_width(shown), ==,
        scale * gdk_surface_get_width(gtk_native_get_surface(GTK_NATIVE(w->gtk))));
    *n = 0;
    for (size_t i = 0; i < cloud->n; i++) {
        double p[3], place[2], x, y;
        for (int k = 0; k < 3; k++)
            p[k] = (double)cloud->vertices[i].position[k];
        if (!neph_camera_project(&w->view.camera, p, &place[0], &place[1]))
            continue;
        projection_widget(&seen, place, &x, &y);
        if (x < 2.0 || y < 2.0 || x > seen.width - 2.0 || y > seen.height - 2.0)
            continue;
        ++*n;
        bright += brightness(shown, area, x, y) > 100;
    }
    cairo_surface_destroy(shown);
    return bright;
}

/* All of them are, within some frames. */
static void expect_all_bright(window *w)
{
    photon_style style = *photon_view_style(w->photon_view);
    style.wireframe = false;
    photon_view_set_style(w->photon_view, &style);
    int n = 0, bright = -1;
    for (int i = 0; i < 20 && bright != n; i++) {
        hands_pause(100);
        bright = count_bright(w, &n);
    }
    g_assert_cmpint(n, >, 100);
    g_assert_cmpint(bright, ==, n);
}

static void test_photons_on_screen(void)
{
    window *w = open_scene("screen.pbrt");
    view_activate(w, "win.trace-photons");
    view_wait(is_drawn, w);
    expect_all_bright(w);
    view_close(w);
}

static bool has_many(window *w)
{
    const photon_cloud *cloud = photon_view_cloud(w->photon_view);
    return cloud && cloud->n > 100000 && !w->tracing;
}

/* Many photons come in several frames, and none is left out; a frame more from the same
   place begins nothing anew. */
static void test_parts(void)
{
    window *w = open_scene("parts.pbrt");
    setting_control *photons = settings_panel_find(w->settings, "photons");
    gtk_spin_button_set_value(GTK_SPIN_BUTTON(setting_control_input(photons)), 150000);
    view_activate(w, "win.trace-photons");
    view_wait(has_many, w);
    guint64 before = photon_view_frame(w->photon_view)->number;
    view_wait(is_drawn, w);
    const photon_frame *frame = photon_view_frame(w->photon_view);
    g_assert_cmpuint(frame->number, >, before + 1);
    before = frame->number;
    photon_view_redraw(w->photon_view);
    while (frame->number == before)
        g_main_context_iteration(NULL, TRUE);
    g_assert_cmpuint(frame->points, ==, frame->all);
    expect_all_bright(w);
    view_close(w);
}

/* Pixel by pixel means the screen's pixels. */
static void test_pixel_by_pixel(void)
{
    window *w = open_scene("pixels.pbrt");
    view_activate(w, "win.zoom-one");
    int scale = gtk_widget_get_scale_factor(canvas_widget(w->canvas));
    const char *expected = g_getenv("GDK_SCALE");
    g_assert_cmpint(scale, ==, expected ? atoi(expected) : 1);
    g_assert_cmpfloat_with_epsilon(scale * canvas_zoom(w->canvas), 1.0, 1e-9);
    view_close(w);
}

/* A label on show that is cut, or NULL. */
static GtkWidget *find_cut(GtkWidget *widget, int *n)
{
    GtkWidget *cut = NULL, *child = gtk_widget_get_first_child(widget);
    if (!gtk_widget_get_mapped(widget))
        return NULL;
    if (GTK_IS_LABEL(widget) && !gtk_widget_has_css_class(widget, "caption")) {
        ++*n;
        if (pango_layout_is_ellipsized(gtk_label_get_layout(GTK_LABEL(widget))))
            return widget;
    }
    for (; child && !cut; child = gtk_widget_get_next_sibling(child))
        cut = find_cut(child, n);
    return cut;
}

/* A text that has just changed has its room only with the next frame. */
static void assert_whole(GtkWidget *widget, int *n)
{
    GtkWidget *cut = find_cut(widget, n);
    for (int i = 0; i < 40 && cut; i++) {
        hands_pause(50);
        cut = find_cut(widget, n);
    }
    if (cut)
        g_error("\"%s\" is cut", gtk_label_get_text(GTK_LABEL(cut)));
}

static void test_nothing_cut(void)
{
    static const char *const pages[] = {"settings", "camera",  "inspect",
                                        "photons",  "numbers", "messages"};
    static const char *const views[] = {"picture", "photons", "materials"};
    window *w = open_scene("whole.pbrt");
    int least[2], n = 0;
    gtk_widget_measure(GTK_WIDGET(w->gtk), GTK_ORIENTATION_HORIZONTAL, -1, &least[0],
                       NULL, NULL, NULL);
    gtk_widget_measure(GTK_WIDGET(w->gtk), GTK_ORIENTATION_VERTICAL, -1, &least[1], NULL,
                       NULL, NULL);
    g_assert_cmpint(least[0], <=, 900);
    g_assert_cmpint(least[1], <=, 600);
    for (size_t i = 0; i < G_N_ELEMENTS(pages) + G_N_ELEMENTS(views); i++) {
        bool page = i < G_N_ELEMENTS(pages);
        gtk_widget_activate_action(GTK_WIDGET(w->gtk), page ? "win.page" : "win.view",
                                   "s", page ? pages[i] : views[i - G_N_ELEMENTS(pages)]);
        hands_pause(100);
        assert_whole(w->sidebar, &n);
        assert_whole(w->views, &n);
    }
    g_assert_cmpint(n, >, 100);
    view_close(w);
}

int main(int argc, char **argv)
{
    view_init(&argc, &argv);
    view_add_test("/view-hands/drop", test_drop);
    view_add_test("/view-hands/dialogs", test_dialogs);
    view_add_test("/view-hands/recent", test_recent);
    view_add_test("/view-hands/screen/drags", test_drags);
    view_add_test("/view-hands/keys", test_keys);
    view_add_test("/view-hands/pick", test_pick);
    view_add_test("/view-hands/divider", test_divider);
    view_add_test("/view-hands/pinch", test_pinch);
    view_add_test("/view-hands/screen/photons", test_photons_on_screen);
    view_add_test("/view-hands/screen/parts", test_parts);
    view_add_test("/view-hands/screen/pixels", test_pixel_by_pixel);
    view_add_test("/view-hands/screen/whole", test_nothing_cut);
    return view_run();
}
