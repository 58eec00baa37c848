/*
 * The window's view of the scene: moved by hands and numbers, focused, kept.
 */
#include "window/window_parts.h"

#include "files/file_dialog.h"
#include "files/file_job.h"

#include <string.h>

void window_view_moved(const NephCamera *camera, bool moving, void *data)
{
    window *w = data;
    if (!w->scene)
        return;
    session_set_camera(w->session, camera, moving);
    photon_view_redraw(w->photon_view);
    camera_panel_show(w->camera_panel, camera);
}

static void set_camera(window *w, const NephCamera *camera)
{
    w->view.camera = *camera;
    window_view_moved(camera, false, w);
}

void window_camera_changed(const NephCamera *camera, void *data)
{
    set_camera(data, camera);
}

/* ---- Pointing ---- */

bool window_focus_at(window *w, const double place[2])
{
    NephCamera camera = w->view.camera;
    NephSurfacePoint at;
    double origin[3], direction[3], distance = 0.0;
    neph_camera_ray(&camera, place[0], place[1], origin, direction);
    if (!w->scene || !neph_scene_pick(w->scene->scene, origin, direction, &at))
        return false;
    for (int i = 0; i < 3; i++)
        distance += (at.position[i] - camera.position[i]) * camera.direction[i];
    camera.focal_distance = distance;
    set_camera(w, &camera);
    if (camera.lens_radius > 0.0)
        window_toast(w, "Sharp at %.4g m", distance);
    else
        window_toast(w, "Sharp at %.4g m, once the lens radius is not 0", distance);
    return true;
}

static void set_focusing(window *w, bool focusing)
{
    GAction *action = g_action_map_lookup_action(G_ACTION_MAP(w->gtk), "focus-tool");
    w->focusing = focusing;
    g_simple_action_set_state(G_SIMPLE_ACTION(action), g_variant_new_boolean(focusing));
    gtk_widget_set_cursor_from_name(canvas_widget(w->canvas),
                                    focusing ? "crosshair" : NULL);
}

static void set_pivot_at(window *w, const double place[2])
{
    NephSurfacePoint at;
    double origin[3], direction[3];
    neph_camera_ray(&w->view.camera, place[0], place[1], origin, direction);
    if (!neph_scene_pick(w->scene->scene, origin, direction, &at))
        return;
    viewpoint_set_pivot(&w->view, at.position);
    window_toast(w, "Going around %s now",
                 *at.material_name ? at.material_name : at.shape_kind);
}

void window_view_clicked(double x, double y, int n, void *data)
{
    window *w = data;
    double place[2];
    if (!w->scene)
        return;
    canvas_to_picture(w->canvas, x, y, &place[0], &place[1]);
    if (w->focusing) {
        set_focusing(w, false);
        window_focus_at(w, place);
    } else if (n == 2) {
        set_pivot_at(w, place);
    }
}

void window_divided(double at, void *data)
{
    inspector_set_divider(((window *)data)->inspector, at);
}

void window_hover(bool inside, int x, int y, void *data)
{
    window *w = data;
    const held_picture *picture = canvas_picture(w->canvas);
    g_autofree char *text = NULL;
    if (inside && picture)
        text =
            inspector_pixel_line(picture->image, canvas_options(w->canvas)->layer, x, y);
    status_show_pointer(w->status, text);
    inspector_hover(w->inspector, inside, x, y);
}

/* ---- Keeping ---- */

static void reset_view(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    window *w = data;
    double low[3], high[3];
    bool bounded = neph_scene_bounds(w->scene->scene, low, high);
    viewpoint_init(&w->view, &w->scene->camera, bounded ? low : NULL, high);
    set_camera(w, &w->scene->camera);
}

static void frame_view(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    window *w = data;
    double low[3], high[3];
    if (!neph_scene_bounds(w->scene->scene, low, high))
        return;
    viewpoint_frame(&w->view, low, high);
    window_view_moved(&w->view.camera, false, w);
}

static void copy_view(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    window *w = data;
    g_autofree char *text = neph_camera_text(&w->view.camera);
    gdk_clipboard_set_text(gtk_widget_get_clipboard(GTK_WIDGET(w->gtk)), text);
    window_toast(w, "The view is on the clipboard");
}

static void kept_as_pbrt(GObject *source, GAsyncResult *result, void *data)
{
    (void)source;
    window *w = data;
    g_autoptr(GError) error = NULL;
    bool ok = file_job_write_finish(result, &error);
    g_application_release(g_application_get_default());
    if (file_job_is_orphan(result))
        return;
    if (ok)
        window_open(w, file_job_path(result));
    else
        window_toast(w, "%s", error->message);
}

static void keep_as_pbrt(const char *path, void *data)
{
    window *w = data;
    const file_content content = {.scene = document_path(w->document),
                                  .camera = w->view.camera};
    g_application_hold(g_application_get_default());
    file_job_write(path, &content, w->files, kept_as_pbrt, w);
}

/* Other formats have no LookAt: the scene goes on as a pbrt one. */
static void ask_for_pbrt(window *w)
{
    static const char *const scenes[] = {"*.pbrt", NULL};
    g_autofree char *folder = document_folder(w->document);
    g_autofree char *base = g_path_get_basename(document_path(w->document));
    char *dot = strrchr(base, '.');
    if (dot)
        *dot = '\0';
    g_autofree char *name = g_strconcat(base, ".pbrt", NULL);
    const file_question question = {
        "Save the scene with this view", true, name, folder, "pbrt scenes", scenes};
    file_dialog_ask(w->gtk, &question, keep_as_pbrt, w);
}

static void save_view(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    window *w = data;
    g_autoptr(GError) error = NULL;
    if (!g_str_has_suffix(document_path(w->document), ".pbrt")) {
        ask_for_pbrt(w);
        return;
    }
    if (neph_camera_save(&w->view.camera, document_path(w->document), &error))
        window_toast(w, "The scene begins with this view now");
    else
        window_toast(w, "%s", error->message);
}

static void focus_tool(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action, (void)parameter;
    window *w = data;
    set_focusing(w, !w->focusing);
}

/* ---- References ---- */

static void reference_read(GObject *source, GAsyncResult *result, void *data)
{
    (void)source;
    window *w = data;
    g_autoptr(GError) error = NULL;
    g_autoptr(held_picture) picture = file_job_read_finish(result, &error);
    if (file_job_is_orphan(result))
        return;
    if (!picture) {
        window_toast(w, "%s", error->message);
        inspector_set_reference(w->inspector, NULL, NULL);
        return;
    }
    inspector_set_reference(w->inspector, picture, file_job_path(result));
    gtk_stack_set_visible_child_name(GTK_STACK(w->views), "picture");
}

void window_set_reference(window *w, const char *path)
{
    file_job_read(path, w->files, reference_read, w);
}

static void reference_chosen(const char *path, void *data)
{
    window_set_reference(data, path);
}

void window_ask_reference(void *data)
{
    window *w = data;
    g_auto(GStrv) pictures = file_patterns(neph_image_extensions());
    g_autofree char *folder = document_folder(w->document);
    const file_question question = {
        "A reference to compare with", false, NULL, folder, "Pictures",
        (const char *const *)pictures};
    file_dialog_ask(w->gtk, &question, reference_chosen, w);
}

static void save_view_as(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action;
    keep_as_pbrt(g_variant_get_string(parameter, NULL), data);
}

static void load_reference(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)action;
    reference_chosen(g_variant_get_string(parameter, NULL), data);
}

/* ---- Exposure ---- */

static void expose(GSimpleAction *action, GVariant *parameter, void *data)
{
    (void)parameter;
    window *w = data;
    bool brighter = strcmp(g_action_get_name(G_ACTION(action)), "brighter") == 0;
    inspector_set_exposure(w->inspector,
                           inspector_exposure(w->inspector) + (brighter ? 0.5 : -0.5));
}

static const GActionEntry entries[] = {
    {.name = "reset-view", .activate = reset_view},
    {.name = "frame-view", .activate = frame_view},
    {.name = "copy-view", .activate = copy_view},
    {.name = "save-view", .activate = save_view},
    {.name = "save-view-as", .activate = save_view_as, .parameter_type = "s"},
    {.name = "focus-tool", .activate = focus_tool, .state = "false"},
    {.name = "reference", .activate = load_reference, .parameter_type = "s"},
    {.name = "brighter", .activate = expose},
    {.name = "darker", .activate = expose},
};

void window_add_view_actions(window *w)
{
    g_action_map_add_action_entries(G_ACTION_MAP(w->gtk), entries, G_N_ELEMENTS(entries),
                                    w);
}
