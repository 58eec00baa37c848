/*
 * What is said about a scene, and where the window shows it: notes and warnings on a page
 * of their own and in the line below the picture, warnings over the picture too; errors
 * whole, however long.
 */
#include "view_run.h"

#include <string.h>

/* What is replaced with a warning, and a picture that gives a note. */
static const char hair[] = "Material \"hair\"\nShape \"sphere\" \"float radius\" 0.2\n";

/* One triangle, by strips of bytes in base64: three corners of three floats. */
static const char triangle[] =
    "{\"asset\":{\"version\":\"2.0\"},%s\"meshes\":[{\"primitives\":[{\"attributes\":{"
    "\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}],"
    "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,%s\"}"
    "],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{"
    "\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}]}";

static char *write_triangle(const char *name, const char *more)
{
    const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    g_autofree char *code = g_base64_encode((const guchar *)corners, sizeof corners);
    GString *text = g_string_new(triangle);
    g_string_replace(text, "%s", more, 1);
    g_string_replace(text, "%s", code, 1);
    char *path = view_write(name, text->str);
    g_string_free(text, TRUE);
    return path;
}

static window *open_file(const char *path)
{
    window *w = view_window();
    window_open(w, path);
    return w;
}

/* A label on show below a widget that has this in it, or NULL. */
static GtkWidget *find_text(GtkWidget *from, const char *text)
{
    GtkWidget *found = NULL, *child = gtk_widget_get_first_child(from);
    if (!gtk_widget_get_mapped(from))
        return NULL;
    if (GTK_IS_LABEL(from) && strstr(gtk_label_get_text(GTK_LABEL(from)), text))
        return from;
    for (; child && !found; child = gtk_widget_get_next_sibling(child))
        found = find_text(child, text);
    return found;
}

static bool is_loaded(window *w)
{
    return w->scene && gtk_widget_get_mapped(w->paned);
}

static void test_notes(void)
{
    g_autofree char *path = write_triangle("notes.gltf", "");
    window *w = open_file(path);
    view_wait(is_loaded, w);
    GtkWidget *all = GTK_WIDGET(w->gtk);
    /* No light and no camera: two notes, which hide nothing. */
    g_assert_nonnull(find_text(all, "2 notes"));
    g_assert_null(find_text(messages_panel_strip(w->messages), "environment"));
    g_assert_null(find_text(all, "a soft environment is added"));
    gtk_widget_activate_action(all, "win.page", "s", "messages");
    view_settle();
    g_assert_nonnull(
        find_text(all, "notes.gltf: no light in it; a soft environment is added"));
    g_assert_null(find_text(all, path)); /* the folder says nothing */
    view_close(w);
}

static bool has_no_warnings(window *w)
{
    return messages_count(messages_panel_list(w->messages), MESSAGE_WARNING) == 0;
}

static void test_warnings(void)
{
    g_autofree char *path = write_triangle(
        "warned.gltf", "\"extensionsUsed\":[\"KHR_materials_sheen\",\"XYZ_not_known\"],");
    g_autofree char *plain = view_write("plain.pbrt", view_scene);
    window *w = open_file(path);
    view_wait(is_loaded, w);
    GtkWidget *strip = messages_panel_strip(w->messages);
    g_assert_nonnull(find_text(strip, "KHR_materials_sheen is left out (and 1 more)"));
    g_assert_nonnull(find_text(GTK_WIDGET(w->gtk), "2 warnings, 2 notes"));
    gtk_widget_set_visible(strip, FALSE);
    held_scene *old = held_scene_ref(w->scene);
    view_activate(w, "win.reload");
    while (w->scene == old)
        g_main_context_iteration(NULL, TRUE);
    held_scene_unref(old);
    g_assert_false(gtk_widget_get_visible(strip)); /* it was closed, and is not new */
    window_open(w, plain);
    view_wait(has_no_warnings, w);
    view_wait(view_is_done, w);
    g_assert_false(gtk_widget_get_visible(strip));
    g_assert_null(find_text(GTK_WIDGET(w->gtk), "warning"));
    view_close(w);
}

static bool shows_error(window *w)
{
    return strcmp(gtk_stack_get_visible_child_name(GTK_STACK(w->content)), "error") == 0;
}

/* An error is kept on the page too, after what was said before it. */
static void test_errors(void)
{
    g_autofree char *text = g_strconcat(view_scene, hair, NULL);
    g_autofree char *path = view_write("hair.pbrt", text);
    window *w = open_file(path);
    view_wait(shows_error, w);
    const GPtrArray *list = messages_panel_list(w->messages);
    g_assert_cmpuint(messages_count(list, MESSAGE_ERROR), ==, 1);
    const message *last = list->pdata[list->len - 1];
    g_assert_nonnull(strstr(last->text, "hair"));
    view_close(w);
}

/* ---- Pictures that show nothing ---- */

static const char dark_scene[] =
    "LookAt 0 0 -2  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 50\n"
    "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 16\n"
    "Integrator \"photonmap\" \"integer passes\" 1 \"integer spp\" 1\nWorldBegin\n"
    "LightSource \"point\" \"rgb I\" [0.001 0.001 0.001]\nShape \"sphere\" \"float "
    "radius\" 3\n";

static char *write_sun(const char *name, const char *lux)
{
    g_autofree char *more = g_strdup_printf(
        "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"directional\","
        "\"intensity\":%s}]}},",
        lux);
    char *path = write_triangle(name, more);
    g_autofree char *text = NULL;
    g_assert_true(g_file_get_contents(path, &text, NULL, NULL));
    GString *with_lamp = g_string_new(text);
    g_string_replace(
        with_lamp, "{\"mesh\":0}",
        "{\"mesh\":0,\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}", 1);
    g_assert_true(g_file_set_contents(path, with_lamp->str, -1, NULL));
    g_string_free(with_lamp, TRUE);
    return path;
}

static bool is_plain(window *w)
{
    return w->scene && w->scene->width == 24 && w->exposed < 1.0;
}

static bool is_judged(window *w)
{
    return w->judged;
}

/* A pbrt scene is shown as it says, with a warning; a glTF file, which cannot say, is
   exposed, with a note, and what comes after it is not. */
static void test_exposure(void)
{
    g_autofree char *dark = view_write("dark.pbrt", dark_scene);
    g_autofree char *plain = view_write("bright.pbrt", view_scene);
    g_autofree char *sun = write_sun("sun.gltf", "0.002");
    window *w = open_file(dark);
    view_wait(is_judged, w);
    g_assert_nonnull(find_text(messages_panel_strip(w->messages), "nearly black"));
    g_assert_cmpfloat_with_epsilon(inspector_exposure(w->inspector), 0.0, 1e-9);
    window_open(w, sun);
    while (w->exposed < 1.0)
        g_main_context_iteration(NULL, TRUE);
    g_assert_cmpfloat(inspector_exposure(w->inspector), >, 8.0);
    g_assert_cmpfloat((double)canvas_options(w->canvas)->exposure, >, 8.0);
    const GPtrArray *list = messages_panel_list(w->messages);
    const message *last = list->pdata[list->len - 1];
    g_assert_cmpint(last->kind, ==, MESSAGE_NOTE);
    g_assert_nonnull(strstr(last->text, "is exposed by +"));
    window_open(w, plain);
    view_wait(is_plain, w);
    view_wait(is_judged, w);
    g_assert_cmpfloat_with_epsilon(inspector_exposure(w->inspector), 0.0, 1e-9);
    g_assert_null(find_text(messages_panel_strip(w->messages), "nearly"));
    view_close(w);
}

/* ---- Long errors ---- */

static void assert_within(GtkWidget *from, GtkWidget *page, int *n)
{
    double x, y;
    if (!gtk_widget_get_mapped(from))
        return;
    if (GTK_IS_LABEL(from)) {
        g_assert_true(gtk_widget_translate_coordinates(
            from, page, gtk_widget_get_width(from), 0.0, &x, &y));
        g_assert_cmpfloat(x, <=, gtk_widget_get_width(page));
        ++*n;
    }
    for (GtkWidget *child = gtk_widget_get_first_child(from); child;
         child = gtk_widget_get_next_sibling(child))
        assert_within(child, page, n);
}

static bool has_room(window *w)
{
    return shows_error(w) && gtk_widget_get_width(error_page_widget(w->errors)) > 0;
}

/* Nothing of it is beyond the edge of the page: neither a list of formats, nor a name
   without a blank. */
static void test_long_errors(void)
{
    g_autofree char *word = g_strnfill(180, 'w');
    g_autofree char *name = g_strconcat(word, ".xyz", NULL);
    char *paths[] = {view_write("unknown.xyz", "nothing"), view_write(name, "nothing")};
    for (size_t i = 0; i < G_N_ELEMENTS(paths); i++) {
        int n = 0;
        window *w = open_file(paths[i]);
        view_wait(has_room, w);
        for (int k = 0; k < 40; k++) {
            g_main_context_iteration(NULL, FALSE);
            g_usleep(5000);
        }
        assert_within(error_page_widget(w->errors), error_page_widget(w->errors), &n);
        g_assert_cmpint(n, >=, 3);
        g_assert_nonnull(find_text(error_page_widget(w->errors), "found .xyz"));
        g_free(paths[i]);
        view_close(w);
    }
}

int main(int argc, char **argv)
{
    view_init(&argc, &argv);
    view_add_test("/view-messages/notes", test_notes);
    view_add_test("/view-messages/warnings", test_warnings);
    view_add_test("/view-messages/errors", test_errors);
    view_add_test("/view-messages/exposure", test_exposure);
    view_add_test("/view-messages/long-errors", test_long_errors);
    return view_run();
}
