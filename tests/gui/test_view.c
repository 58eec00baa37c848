/*
 * The window, driven by its actions and controls: scenes open and fail to, every setting
 * reaches the library, rendering starts, pauses, stops and dies with the window.
 */
#include "view_run.h"

#include <math.h>
#include <string.h>

/* Far more passes than any test waits for. */
static char *long_scene(void)
{
    g_auto(GStrv) parts = g_strsplit(view_scene, "\"integer passes\" 2", 2);
    g_autofree char *text = g_strjoinv("\"integer passes\" 100000", parts);
    return view_write("long.pbrt", text);
}

static window *open_scene(const char *path)
{
    window *w = view_window();
    window_open(w, path);
    return w;
}

static const char *page_of(window *w)
{
    return gtk_stack_get_visible_child_name(GTK_STACK(w->content));
}

/* ---- Opening ---- */

static void test_open(void)
{
    g_autofree char *path = view_write("box.pbrt", view_scene);
    window *w = view_window();
    g_assert_cmpstr(page_of(w), ==, "welcome");
    window_open(w, path);
    view_wait(view_is_done, w);
    g_assert_cmpstr(page_of(w), ==, "main");
    const held_picture *picture = canvas_picture(w->canvas);
    g_assert_nonnull(picture);
    g_assert_false(picture->coarse);
    g_assert_cmpint(picture->width, ==, 24);
    g_assert_cmpint(w->statistics.passes, ==, 2);
    g_assert_true(isfinite(w->statistics.noise));
    g_assert_nonnull(strstr(gtk_window_get_title(w->gtk), "box.pbrt"));
    view_close(w);
}

static bool shows_error(window *w)
{
    return strcmp(page_of(w), "error") == 0;
}

static bool shows_main(window *w)
{
    return strcmp(page_of(w), "main") == 0;
}

/* A label somewhere below the widget that holds the text. */
static bool has_text(GtkWidget *widget, const char *text)
{
    if (GTK_IS_LABEL(widget) && strstr(gtk_label_get_text(GTK_LABEL(widget)), text))
        return true;
    GtkWidget *child = gtk_widget_get_first_child(widget);
    for (; child; child = gtk_widget_get_next_sibling(child))
        if (has_text(child, text))
            return true;
    return false;
}

static void test_broken(void)
{
    g_autofree char *broken = view_write(
        "broken.pbrt", "WorldBegin\nLightSource \"point\"\n  Shape \"spere\"\n");
    window *w = open_scene(broken);
    GtkWidget *page = error_page_widget(w->errors);
    view_wait(shows_error, w);
    g_assert_true(has_text(page, "broken.pbrt:3"));
    g_assert_true(g_action_group_get_action_enabled(G_ACTION_GROUP(w->gtk), "reload"));
    g_assert_true(has_text(page, "Shape \"spere\""));
    g_assert_true(g_file_set_contents(broken, view_scene, -1, NULL));
    view_activate(w, "win.reload");
    view_wait(view_is_done, w);
    g_assert_cmpstr(page_of(w), ==, "main");
    view_close(w);
}

/* The old scene goes on when the new one is broken, and a saved file is read by itself.
 */
static void test_reload(void)
{
    g_autofree char *path = view_write("watched.pbrt", view_scene);
    window *w = open_scene(path);
    view_wait(view_is_done, w);
    g_assert_true(g_file_set_contents(path, "Nonsense\n", -1, NULL));
    view_wait(shows_error, w);
    view_activate(w, "win.dismiss-error");
    g_assert_cmpstr(page_of(w), ==, "main");
    g_assert_true(g_file_set_contents(path, view_scene, -1, NULL));
    held_scene *old = held_scene_ref(w->scene);
    while (w->scene == old)
        g_main_context_iteration(NULL, TRUE);
    held_scene_unref(old);
    view_wait(shows_main, w);
    view_close(w);
}

/* So is one that the scene is made of, also one that was not there. */
static void test_reload_included(void)
{
    g_autofree char *text = g_strconcat(view_scene, "Include \"part.pbrt\"\n", NULL);
    g_autofree char *path = view_write("whole.pbrt", text);
    window *w = open_scene(path);
    view_wait(shows_error, w);
    g_autofree char *part = view_write("part.pbrt", "Shape \"spere\"\n");
    while (!has_text(error_page_widget(w->errors), "part.pbrt:1"))
        g_main_context_iteration(NULL, TRUE);
    g_assert_true(g_file_set_contents(part, "# nothing yet\n", -1, NULL));
    view_wait(view_is_done, w);
    view_wait(shows_main, w);
    g_assert_null(neph_scene_files(w->scene->scene)[2]);
    g_assert_true(g_file_set_contents(part, "Shape \"plymesh\"\n", -1, NULL));
    view_wait(shows_error, w);
    view_close(w);
}

/* ---- Settings ---- */

/* Another value that is quick to render with. */
static char *other_value(const NephSettingInfo *info)
{
    switch (info->type) {
    case NEPH_SETTING_BOOL:
        return g_strdup(info->initial > 0.5 ? "false" : "true");
    case NEPH_SETTING_CHOICE:
        return g_strdup(info->words[info->initial > 0.5 ? 0 : 1]);
    case NEPH_SETTING_COUNT:
        if (info->initial > 100.0)
            return g_strdup("150");
        return g_strdup_printf("%d", info->initial < 2.0 ? 3 : (int)info->initial - 1);
    case NEPH_SETTING_REAL:
    default:
        return g_strdup(info->low > 0.5 ? "1.5" : "0.25");
    }
}

/* Moves the control as a user would. */
static void turn(GtkWidget *input, const NephSettingInfo *info, const char *value)
{
    double number = g_ascii_strtod(value, NULL);
    unsigned word = 0;
    if (GTK_IS_SWITCH(input)) {
        gtk_switch_set_active(GTK_SWITCH(input), strcmp(value, "true") == 0);
    } else if (GTK_IS_DROP_DOWN(input)) {
        while (strcmp(info->words[word], value) != 0)
            word++;
        gtk_drop_down_set_selected(GTK_DROP_DOWN(input), word);
    } else if (GTK_IS_RANGE(input)) {
        gtk_range_set_value(GTK_RANGE(input), number);
    } else {
        gtk_editable_set_text(GTK_EDITABLE(input), value);
        gtk_spin_button_update(GTK_SPIN_BUTTON(input));
    }
}

/* The arrow behind a control takes back what was changed, and is not there before. */
static void take_back(setting_control *c)
{
    GtkWidget *input = setting_control_input(c);
    GtkWidget *reset = gtk_widget_get_next_sibling(input);
    const NephSettingInfo *info = setting_control_info(c);
    g_assert_true(GTK_IS_BUTTON(reset));
    g_assert_true(gtk_widget_get_sensitive(reset));
    g_signal_emit_by_name(reset, "clicked");
    g_assert_false(gtk_widget_get_sensitive(reset));
    if (GTK_IS_SWITCH(input))
        g_assert_cmpint(gtk_switch_get_active(GTK_SWITCH(input)), ==,
                        info->initial > 0.5);
    else if (GTK_IS_SPIN_BUTTON(input))
        g_assert_cmpfloat_with_epsilon(gtk_spin_button_get_value(GTK_SPIN_BUTTON(input)),
                                       info->initial, 1e-9);
}

static void assert_setting(const NephSettings *s, const char *name, const char *value)
{
    g_autofree char *found = neph_settings_get(s, name);
    if (g_strcmp0(found, value) != 0)
        g_test_message("%s is %s, expected %s", name, found, value);
    g_assert_cmpfloat_with_epsilon(g_ascii_strtod(found, NULL),
                                   g_ascii_strtod(value, NULL), 1e-9);
    if (!g_ascii_isdigit(value[0]))
        g_assert_cmpstr(found, ==, value);
}

static void test_each_setting(void)
{
    size_t n;
    const NephSettingInfo *rows = neph_settings_table(&n);
    g_autofree char *path = view_write("settings.pbrt", view_scene);
    window *w = open_scene(path);
    view_wait(view_is_done, w);
    for (size_t i = 0; i < n; i++) {
        setting_control *c = settings_panel_find(w->settings, rows[i].name);
        g_assert_nonnull(c);
        g_autofree char *value = other_value(&rows[i]);
        turn(setting_control_input(c), &rows[i], value);
        take_back(c);
        turn(setting_control_input(c), &rows[i], value);
        assert_setting(settings_panel_values(w->settings), rows[i].name, value);
        g_assert_nonnull(
            strstr(gtk_widget_get_tooltip_text(setting_control_row(c)), rows[i].doc));
        gtk_test_accessible_assert_property(GTK_ACCESSIBLE(setting_control_input(c)),
                                            GTK_ACCESSIBLE_PROPERTY_DESCRIPTION,
                                            rows[i].doc);
    }
    view_wait_for_other(w);
    g_autoptr(NephSettings) rendered = session_rendered_settings(w->session);
    for (size_t i = 0; i < n; i++) {
        g_autofree char *value = other_value(&rows[i]);
        assert_setting(rendered, rows[i].name, value);
    }
    view_close(w);
}

/* What has a name below all numbers shows it, and it may be typed. */
static void test_unlimited(void)
{
    g_autofree char *path = view_write("unlimited.pbrt", view_scene);
    window *w = open_scene(path);
    view_wait(view_is_done, w);
    setting_control *c = settings_panel_find(w->settings, "max_backward_bounces");
    GtkWidget *input = setting_control_input(c);
    g_assert_cmpstr(gtk_editable_get_text(GTK_EDITABLE(input)), ==, "unlimited");
    turn(input, setting_control_info(c), "3");
    assert_setting(settings_panel_values(w->settings), "max_backward_bounces", "3");
    turn(input, setting_control_info(c), "unlimited");
    assert_setting(settings_panel_values(w->settings), "max_backward_bounces",
                   "unlimited");
    turn(input, setting_control_info(c), "4");
    turn(input, setting_control_info(c), "-1");
    g_assert_cmpstr(gtk_editable_get_text(GTK_EDITABLE(input)), ==, "unlimited");
    view_close(w);
}

/* Settings that the integrator does not read are dimmed. */
static void test_unused_settings(void)
{
    g_autofree char *path = view_write("unused.pbrt", view_scene);
    window *w = open_scene(path);
    view_wait(view_is_done, w);
    setting_control *kind = settings_panel_find(w->settings, "integrator");
    GtkWidget *rays =
        setting_control_row(settings_panel_find(w->settings, "gather_rays"));
    g_assert_true(gtk_widget_get_sensitive(rays));
    turn(setting_control_input(kind), setting_control_info(kind), "path");
    g_assert_false(gtk_widget_get_sensitive(rays));
    turn(setting_control_input(kind), setting_control_info(kind), "photonmap");
    g_assert_true(gtk_widget_get_sensitive(rays));
    view_close(w);
}

static void test_search(void)
{
    g_autofree char *path = view_write("search.pbrt", view_scene);
    window *w = open_scene(path);
    view_wait(view_is_done, w);
    settings_panel_search(w->settings);
    GtkWidget *entry = gtk_root_get_focus(GTK_ROOT(w->gtk));
    entry = gtk_widget_get_ancestor(entry, GTK_TYPE_SEARCH_ENTRY);
    g_assert_nonnull(entry);
    gtk_editable_set_text(GTK_EDITABLE(entry), "Gather ray");
    g_signal_emit_by_name(entry, "search-changed");
    setting_control *rays = settings_panel_find(w->settings, "gather_rays");
    setting_control *seed = settings_panel_find(w->settings, "seed");
    g_assert_true(gtk_widget_get_visible(setting_control_row(rays)));
    g_assert_false(gtk_widget_get_visible(setting_control_row(seed)));
    view_close(w);
}

/* ---- Rendering ---- */

static bool is_paused(window *w)
{
    return w->state == SESSION_PAUSED;
}

static bool is_stopped(window *w)
{
    return w->state == SESSION_STOPPED;
}

static bool has_passes(window *w)
{
    return w->statistics.passes > 2;
}

static void test_pause_and_stop(void)
{
    g_autofree char *path = long_scene();
    window *w = open_scene(path);
    view_wait(has_passes, w);
    view_activate(w, "win.play");
    view_wait(is_paused, w);
    int64_t passes = w->statistics.passes;
    view_activate(w, "win.play");
    view_wait(view_is_rendering, w);
    g_assert_cmpint(w->statistics.passes, >=, passes);
    view_activate(w, "win.stop");
    view_wait(is_stopped, w);
    g_assert_nonnull(canvas_picture(w->canvas));
    view_activate(w, "win.restart");
    view_wait(view_is_rendering, w);
    view_close(w);
}

static void test_save(void)
{
    g_autofree char *path = view_write("save.pbrt", view_scene);
    g_autofree char *picture = g_build_filename(view_folder(), "saved.exr", NULL);
    window *w = open_scene(path);
    view_wait(view_is_done, w);
    gtk_widget_activate_action(GTK_WIDGET(w->gtk), "win.save-picture-as", "s", picture);
    view_wait_for_word(w, "saved.exr");
    g_autoptr(NephImage) saved = neph_image_read(picture, NULL);
    g_assert_nonnull(saved);
    int width, height, n;
    neph_image_size(saved, &width, &height, &n);
    g_assert_cmpint(width, ==, 24);
    gtk_widget_activate_action(GTK_WIDGET(w->gtk), "win.save-picture-as", "s",
                               "/nowhere/at/all.exr");
    view_wait_for_word(w, "/nowhere/at/all.exr");
    view_close(w);
}

/* Kept, other settings tried, and gone on from with those of the file. What can not be is
   said, and the scene's own files are safe. */
static void test_checkpoint(void)
{
    g_autofree char *path = view_write("kept.pbrt", view_scene);
    g_autofree char *kept = g_build_filename(view_folder(), "kept.checkpoint", NULL);
    window *w = open_scene(path);
    GtkWidget *gtk = GTK_WIDGET(w->gtk);
    view_wait(view_is_done, w);
    gtk_widget_activate_action(gtk, "win.save-checkpoint-as", "s", kept);
    view_wait_for_word(w, "kept.checkpoint");
    int64_t passes = w->statistics.passes;
    g_autofree char *seed = neph_settings_get(settings_panel_values(w->settings), "seed");
    g_autoptr(NephSettings) other =
        neph_settings_copy(settings_panel_values(w->settings));
    neph_settings_set(other, "seed", "77", NULL);
    settings_panel_show(w->settings, other, w->of_scene);
    session_set_settings(w->session, other);
    view_wait_for_other(w);
    gtk_widget_activate_action(gtk, "win.resume-from", "s", kept);
    view_wait_for_word(w, "Going on from the checkpoint");
    view_wait(view_is_done, w);
    g_autofree char *back = neph_settings_get(settings_panel_values(w->settings), "seed");
    g_assert_cmpstr(back, ==, seed);
    g_assert_cmpint(w->statistics.passes, ==, passes);
    gtk_widget_activate_action(gtk, "win.resume-from", "s", path);
    view_wait_for_word(w, "found another file");
    gtk_widget_activate_action(gtk, "win.save-checkpoint-as", "s", "/nowhere/at/all");
    view_wait_for_word(w, "/nowhere/at/all");
    gtk_widget_activate_action(gtk, "win.save-checkpoint-as", "s", path);
    view_wait_for_word(w, "kept.pbrt");
    g_autofree char *text = NULL;
    g_assert_true(g_file_get_contents(path, &text, NULL, NULL));
    g_assert_cmpstr(text, ==, view_scene);
    view_close(w);
}

/* A file of eight bits is what the window shows: its exposure, its curve, its layer, its
   false colours; one of floats is the light itself. */
static void test_save_as_shown(void)
{
    static const display_options ways[] = {
        {.gamma = 2.2f, .mark_bad = true},
        {.exposure = -1.5f, .curve = TONE_FILMIC},
        {.exposure = 1.0f, .curve = TONE_REINHARD},
        {.curve = TONE_GAMMA, .gamma = 1.4f},
        {.curve = TONE_LINEAR},
        {.false_colour = true},
        {.layer = "normal"},
        {.layer = "depth", .exposure = -2.0f},
    };
    g_autofree char *path = view_write("shown.pbrt", view_scene);
    g_autofree char *png = g_build_filename(view_folder(), "shown.PNG", NULL);
    g_autofree char *pfm = g_build_filename(view_folder(), "shown.pfm", NULL);
    window *w = open_scene(path);
    view_wait(view_is_done, w);
    const NephImage *light = canvas_picture(w->canvas)->image;
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        canvas_set_options(w->canvas, &ways[i]);
        gtk_widget_activate_action(GTK_WIDGET(w->gtk), "win.save-picture-as", "s", png);
        view_wait_for_word(w, "Saved");
        cairo_surface_t *shown = display_surface(light, &ways[i]);
        GdkPixbuf *saved = gdk_pixbuf_new_from_file(png, NULL);
        g_assert_cmpint(gdk_pixbuf_get_width(saved), ==, 24);
        for (int y = 0; y < 16; y++)
            for (int x = 0; x < 24; x++) {
                const guint8 *at = gdk_pixbuf_read_pixels(saved) +
                                   y * gdk_pixbuf_get_rowstride(saved) +
                                   x * gdk_pixbuf_get_n_channels(saved);
                uint32_t seen;
                memcpy(&seen,
                       cairo_image_surface_get_data(shown) +
                           y * cairo_image_surface_get_stride(shown) + 4 * x,
                       sizeof seen);
                g_assert_cmphex((uint32_t)at[0] << 16 | (uint32_t)at[1] << 8 | at[2], ==,
                                seen & 0xffffff);
            }
        cairo_surface_destroy(shown);
        g_object_unref(saved);
    }
    canvas_set_options(w->canvas, &ways[1]);
    gtk_widget_activate_action(GTK_WIDGET(w->gtk), "win.save-picture-as", "s", pfm);
    view_wait_for_word(w, "Saved");
    g_autoptr(NephImage) raw = neph_image_read(pfm, NULL);
    NephImageDifference d;
    g_assert_true(neph_image_compare(raw, light, &d, NULL));
    g_assert_cmpfloat(d.rmse, <, 1e-9);
    view_close(w);
}

/* A window that closes while its picture is written leaves a whole file. */
static void test_save_and_close(void)
{
    g_autofree char *path = view_write("last.pbrt", view_scene);
    g_autofree char *picture = g_build_filename(view_folder(), "last.exr", NULL);
    window *w = open_scene(path);
    view_wait(view_is_done, w);
    gtk_widget_activate_action(GTK_WIDGET(w->gtk), "win.save-picture-as", "s", picture);
    view_close(w);
    while (!g_file_test(picture, G_FILE_TEST_EXISTS))
        g_main_context_iteration(NULL, FALSE);
    g_autoptr(NephImage) saved = neph_image_read(picture, NULL);
    g_assert_nonnull(saved);
    view_settle();
}

#if defined(__SANITIZE_ADDRESS__)
#define CYCLES 20
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define CYCLES 20
#endif
#endif
#ifndef CYCLES
#define CYCLES 5
#endif

static bool has_picture(window *w)
{
    return view_is_rendering(w) && canvas_picture(w->canvas);
}

static bool has_photons_and_passes(window *w)
{
    return has_passes(w) && w->photons;
}

/* Closes the window: who holds its scene besides has let it go soon, so nobody renders it
   any more. */
static void close_and_check(window *w)
{
    held_scene *held = held_scene_ref(w->scene);
    g_assert_cmpint(w->state, ==, SESSION_RENDERING);
    g_assert_cmpint(atomic_load(&held->holders), >, 2);
    view_close(w);
    gint64 limit = g_get_monotonic_time() + 60 * G_USEC_PER_SEC;
    while (atomic_load(&held->holders) > 1 && g_get_monotonic_time() < limit) {
        g_main_context_iteration(NULL, FALSE);
        g_usleep(1000);
    }
    g_assert_cmpint(atomic_load(&held->holders), ==, 1);
    held_scene_unref(held);
}

/* Each window dies while its worker is busy, at another moment each time: twenty for the
   address sanitizer, which then finds no leak. */
static void test_close_while_rendering(void)
{
    static bool (*const moments[])(window * w) = {view_is_rendering, has_picture,
                                                  has_passes, has_photons_and_passes};
    g_autofree char *path = long_scene();
    for (int i = 0; i < CYCLES; i++) {
        window *w = open_scene(path);
        if (i % 5 == 4) { /* it may not be read yet */
            view_close(w);
            continue;
        }
        if (i % 5 == 3) {
            view_wait(view_is_rendering, w);
            view_activate(w, "win.trace-photons");
        }
        view_wait(moments[i % 5], w);
        g_usleep((gulong)(1000 * i));
        close_and_check(w);
    }
}

/* ---- Size and names ---- */

static bool is_small(window *w)
{
    const held_picture *picture = canvas_picture(w->canvas);
    return picture && picture->width == 10 && view_is_done(w);
}

static void test_size(void)
{
    g_autofree char *path = view_write("size.pbrt", view_scene);
    window *w = open_scene(path);
    view_wait(view_is_done, w);
    session_set_size(w->session, 10, 8);
    view_wait(is_small, w);
    view_close(w);
}

/* What is inside these is theirs: they are one control to the keyboard's user. */
static bool is_control(GtkWidget *widget)
{
    return GTK_IS_BUTTON(widget) || GTK_IS_SWITCH(widget) || GTK_IS_SPIN_BUTTON(widget) ||
           GTK_IS_DROP_DOWN(widget) || GTK_IS_SCALE(widget) ||
           GTK_IS_SEARCH_ENTRY(widget) || GTK_IS_MENU_BUTTON(widget);
}

static bool is_picture(GtkWidget *widget)
{
    return GTK_IS_DRAWING_AREA(widget) || GTK_IS_GL_AREA(widget) ||
           GTK_IS_PROGRESS_BAR(widget) || GTK_IS_SPINNER(widget);
}

static bool says_itself(GtkWidget *widget)
{
    return (GTK_IS_BUTTON(widget) && gtk_button_get_label(GTK_BUTTON(widget))) ||
           GTK_IS_LABEL(widget) || GTK_IS_TEXT(widget);
}

/* Every control, every picture and whatever else takes the keyboard says what it is. */
static void assert_named(GtkWidget *widget, int *n)
{
    bool wants_name = is_control(widget) || is_picture(widget) ||
                      (gtk_widget_get_focusable(widget) && !GTK_IS_LIST_BOX_ROW(widget) &&
                       !GTK_IS_WINDOW(widget) && !GTK_IS_SCROLLED_WINDOW(widget));
    if (wants_name && !says_itself(widget) &&
        !gtk_test_accessible_has_property(GTK_ACCESSIBLE(widget),
                                          GTK_ACCESSIBLE_PROPERTY_LABEL))
        g_error("a %s has no accessible name", G_OBJECT_TYPE_NAME(widget));
    *n += wants_name;
    if (is_control(widget) || GTK_IS_WINDOW_CONTROLS(widget))
        return;
    GtkWidget *child = gtk_widget_get_first_child(widget);
    for (; child; child = gtk_widget_get_next_sibling(child))
        assert_named(child, n);
}

static void test_accessible_names(void)
{
    g_autofree char *path = view_write("names.pbrt", view_scene);
    window *w = open_scene(path);
    view_wait(view_is_done, w);
    int n = 0;
    assert_named(GTK_WIDGET(w->gtk), &n);
    g_assert_cmpint(n, >, 100);
    view_close(w);
}

int main(int argc, char **argv)
{
    view_init(&argc, &argv);
    view_add_test("/view/open", test_open);
    view_add_test("/view/broken", test_broken);
    view_add_test("/view/reload", test_reload);
    view_add_test("/view/reload-included", test_reload_included);
    view_add_test("/view/each-setting", test_each_setting);
    view_add_test("/view/unlimited", test_unlimited);
    view_add_test("/view/unused-settings", test_unused_settings);
    view_add_test("/view/search", test_search);
    view_add_test("/view/pause-and-stop", test_pause_and_stop);
    view_add_test("/view/save", test_save);
    view_add_test("/view/save-as-shown", test_save_as_shown);
    view_add_test("/view/save-and-close", test_save_and_close);
    view_add_test("/view/checkpoint", test_checkpoint);
    view_add_test("/view/close-while-rendering", test_close_while_rendering);
    view_add_test("/view/size", test_size);
    view_add_test("/view/accessible-names", test_accessible_names);
    return view_run();
}
