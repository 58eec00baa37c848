#include "session/session_parts.h"

/* The file that was asked for, now the caller's; NULL: none, or it is for what will be
   rendered next. */
static char *take_path(session *s)
{
    pthread_mutex_lock(&s->lock);
    bool is_wanted = s->wanted.version == s->order.version || s->wanted.keep;
    char *path = is_wanted ? g_steal_pointer(&s->wanted.checkpoint) : NULL;
    pthread_mutex_unlock(&s->lock);
    return path;
}

static void keep_in(session *s, const char *path)
{
    GError *error = NULL;
    if (neph_render_save_checkpoint(s->render, path, &error))
        session_tell_kept(s, path);
    else
        session_tell_error(s, error, false);
}

void session_keep(session *s, const NephStatistics *statistics)
{
    if (!statistics->can_look || statistics->passes == 0)
        return;
    g_autofree char *path = take_path(s);
    if (path)
        keep_in(s, path);
}

void session_keep_now(session *s)
{
    g_autofree char *path = take_path(s);
    if (path && s->render)
        keep_in(s, path);
    else if (path)
        session_tell_error(s,
                           g_error_new(NEPH_ERROR_DOMAIN, NEPH_ERROR_USAGE,
                                       "cannot write %s: nothing is rendered", path),
                           false);
}

/* ---- Going on ---- */

/* The scene from where it is looked at, in the size of the checkpoint, and the render
 * that goes on. Both the caller's. */
static NephRender *resumed(session *s, const char *path, const NephSettings *settings,
                           NephScene *seen, GError **error)
{
    neph_scene_set_camera(seen, &s->order.camera, NULL);
    NephRender *render = neph_render_new(seen, settings, error);
    if (render && !neph_render_resume_while(render, path, session_still_wants, s, error))
        g_clear_pointer(&render, neph_render_free);
    return render;
}

/* What the window wants is this from now on, unless it has thought of something else. */
static void take_over(session *s, const NephSettings *settings, const int size[2])
{
    pthread_mutex_lock(&s->lock);
    neph_settings_free(s->rendered);
    s->rendered = neph_settings_copy(settings);
    s->news.plan.integrator = NULL;
    if (s->wanted.version == s->order.version || s->wanted.keep) {
        neph_settings_free(s->wanted.settings);
        s->wanted.settings = neph_settings_copy(settings);
        s->wanted.width = size[0];
        s->wanted.height = size[1];
        s->wanted.playing = s->order.playing = true;
        session_tell_resumed(s, settings, size);
    }
    pthread_mutex_unlock(&s->lock);
    neph_settings_free(s->order.settings);
    s->order.settings = neph_settings_copy(settings);
    s->order.width = size[0];
    s->order.height = size[1];
}

bool session_go_on_from(session *s, const char *path)
{
    int size[2];
    g_autoptr(GError) error = NULL;
    g_autoptr(NephSettings) settings =
        neph_checkpoint_settings(path, &size[0], &size[1], &error);
    g_autoptr(NephScene) seen = neph_scene_share(s->scene->scene);
    NephRender *render = settings && neph_scene_resize(seen, size[0], size[1], &error)
                             ? resumed(s, path, settings, seen, &error)
                             : NULL;
    if (g_error_matches(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_CANCELLED))
        return false;
    if (!render) {
        session_tell_error(s, g_steal_pointer(&error), false);
        return false;
    }
    neph_render_free(s->render);
    neph_scene_free(s->seen);
    s->render = render;
    s->seen = g_steal_pointer(&seen);
    s->passes_shown = 0;
    s->last_snapshot = s->snapshot_cost = 0.0;
    take_over(s, settings, size);
    return true;
}
