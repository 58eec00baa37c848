#include "window/window_parts.h"

#include <math.h>
#include <string.h>

static bool same_values(const double *a, const double *b, int n)
{
    bool same = true;
    for (int i = 0; i < n; i++)
        same &= !(fabs(a[i] - b[i]) > 1e-9 * (1.0 + fabs(a[i])));
    return same;
}

static bool same_camera(const NephCamera *a, const NephCamera *b)
{
    return same_values(a->position, b->position, 3) &&
           same_values(a->direction, b->direction, 3) && same_values(a->up, b->up, 3) &&
           same_values(&a->fov, &b->fov, 1) &&
           same_values(&a->lens_radius, &b->lens_radius, 1) &&
           same_values(&a->focal_distance, &b->focal_distance, 1);
}

/* The file has changed: where the file says what it said, the user's word stands. True if
   anything of the user's was kept. */
static bool keep_settings(window *w, NephSettings *fresh)
{
    size_t n;
    bool kept = false;
    const NephSettingInfo *rows = neph_settings_table(&n);
    for (size_t i = 0; i < n; i++) {
        const char *name = rows[i].name;
        g_autofree char *before = neph_settings_get(w->of_scene, name);
        g_autofree char *now = neph_settings_get(fresh, name);
        g_autofree char *chosen =
            neph_settings_get(settings_panel_values(w->settings), name);
        if (strcmp(before, now) == 0 && strcmp(chosen, now) != 0)
            kept |= neph_settings_set(fresh, name, chosen, NULL);
    }
    return kept;
}

static void show_name(window *w)
{
    g_autofree char *base = g_path_get_basename(document_path(w->document));
    g_autofree char *name = g_utf8_make_valid(base, -1);
    g_autofree char *title = g_strdup_printf("%s – Nephroid", name);
    gtk_window_set_title(w->gtk, title);
    status_show_name(w->status, name, document_path(w->document));
}

static void take_view(window *w, const held_scene *scene)
{
    double low[3], high[3];
    bool bounded = neph_scene_bounds(scene->scene, low, high);
    bool keep =
        w->reloading && w->scene && same_camera(&w->scene->camera, &scene->camera);
    if (!keep) {
        viewpoint_init(&w->view, &scene->camera, bounded ? low : NULL, high);
        return;
    }
    if (!same_camera(&w->view.camera, &scene->camera))
        session_set_camera(w->session, &w->view.camera, false);
}

/* The material in the middle of the picture comes first. */
static void show_materials(window *w, held_scene *scene)
{
    NephSurfacePoint at;
    double origin[3], direction[3];
    lobe_view_set_scene(w->lobes, scene);
    neph_camera_ray(&scene->camera, 0.5, 0.5, origin, direction);
    if (neph_scene_pick(scene->scene, origin, direction, &at) && at.material >= 0)
        lobe_view_choose_number(w->lobes, (unsigned)at.material);
}

/* A new scene begins at no exposure, unless the user has chosen one. */
static void forget_exposure(window *w)
{
    if (fabs(w->exposed) > 0.0 &&
        !(fabs(w->exposed - inspector_exposure(w->inspector)) > 1e-6))
        inspector_set_exposure(w->inspector, 0.0);
    w->exposed = 0.0;
    w->judged = false;
}

static void scene_loaded(window *w, held_scene *scene)
{
    g_autoptr(NephSettings) fresh = neph_scene_settings(scene->scene);
    NephSettings *of_scene = neph_settings_copy(fresh);
    if (w->reloading && w->of_scene && keep_settings(w, fresh))
        session_set_settings(w->session, fresh);
    settings_panel_show(w->settings, fresh, of_scene);
    settings_panel_show_size(w->settings, scene->width, scene->height);
    w->size[0] = scene->width;
    w->size[1] = scene->height;
    neph_settings_free(w->of_scene);
    w->of_scene = of_scene;
    take_view(w, scene);
    held_scene_unref(w->scene);
    w->scene = held_scene_ref(scene);
    forget_exposure(w);
    window_photons_new_scene(w);
    show_materials(w, scene);
    camera_panel_show(w->camera_panel, &w->view.camera);
    document_remember(w->document);
    window_fill_scenes_menu(w->scenes);
    show_name(w);
    window_show_content(w, "main");
    if (!w->reloading)
        gtk_widget_grab_focus(canvas_widget(w->canvas));
    if (w->reloading)
        window_toast(w, "The scene has been read again");
    w->reloading = false;
}

static void show_message_count(window *w)
{
    g_autofree char *summary = messages_summary(messages_panel_list(w->messages));
    status_show_messages(w->status, summary);
}

static void show_messages(window *w, const GPtrArray *messages)
{
    messages_panel_show(w->messages, document_path(w->document), messages);
    show_message_count(w);
}

static void failed(window *w, const session_news *news)
{
    messages_panel_add(w->messages, MESSAGE_ERROR, news->error->message);
    show_message_count(w);
    if (news->error_of_load) {
        error_page_show(w->errors, document_path(w->document), news->error->message,
                        w->scene != NULL);
        window_show_content(w, "error");
    } else {
        window_toast(w, "%s", news->error->message);
    }
}

static char *exposure_text(NephExposure is, double better, bool exposes)
{
    const char *looks = is == NEPH_EXPOSURE_DARK ? "black" : "white";
    if (is == NEPH_EXPOSURE_BLACK)
        return g_strdup("The picture is black: no light reaches what the camera sees");
    return g_strdup_printf(exposes ? "The picture would be nearly %s and is exposed by "
                                     "%+g stops (page Inspect)"
                                   : "The picture is nearly %s: an exposure of %+g stops "
                                     "shows it (page Inspect)",
                           looks, better);
}

/* Once a scene: a picture that shows nothing is told, and exposed where its file has no
   words for that. A quick look may miss what light there is. */
static void judge_exposure(window *w, const held_picture *picture)
{
    float better;
    NephExposure is = neph_image_exposure(
        picture->image, (float)inspector_exposure(w->inspector), &better);
    if (w->judged || (is == NEPH_EXPOSURE_BLACK && picture->coarse))
        return;
    w->judged = true;
    if (is == NEPH_EXPOSURE_GOOD)
        return;
    bool exposes =
        is != NEPH_EXPOSURE_BLACK && !neph_scene_says_exposure(w->scene->scene);
    g_autofree char *text = exposure_text(is, (double)better, exposes);
    messages_panel_add(w->messages, exposes ? MESSAGE_NOTE : MESSAGE_WARNING, text);
    show_message_count(w);
    if (exposes) {
        inspector_set_exposure(w->inspector, (double)better);
        w->exposed = inspector_exposure(w->inspector);
    }
}

static void show_picture(window *w, held_picture *picture)
{
    canvas_set_picture(w->canvas, picture);
    inspector_picture_changed(w->inspector);
    judge_exposure(w, picture);
}

/* It goes on by the settings of a checkpoint. */
static void resumed(window *w, const session_news *news)
{
    settings_panel_show(w->settings, news->resumed, w->of_scene);
    settings_panel_show_size(w->settings, news->resumed_size[0], news->resumed_size[1]);
    w->size[0] = news->resumed_size[0];
    w->size[1] = news->resumed_size[1];
    window_photons_settings_changed(w);
    window_toast(w, "Going on from the checkpoint");
}

void window_on_news(const session_news *news, void *data)
{
    window *w = data;
    bool state_changed = w->state != news->state;
    w->state = news->state;
    w->statistics = news->statistics;
    w->fraction = news->fraction;
    if (news->files)
        document_watch(w->document, (const char *const *)news->files);
    if (news->loaded)
        scene_loaded(w, news->loaded);
    if (news->messages)
        show_messages(w, news->messages);
    if (news->error)
        failed(w, news);
    if (news->kept)
        window_toast(w, "Saved %s", news->kept);
    if (news->resumed)
        resumed(w, news);
    if (news->picture)
        show_picture(w, news->picture);
    status_show(w->status, news);
    numbers_panel_show(w->numbers, &news->statistics, photon_view_frame(w->photon_view));
    numbers_panel_show_plan(w->numbers, &news->plan);
    if (state_changed || news->loaded)
        window_update_actions(w);
}
