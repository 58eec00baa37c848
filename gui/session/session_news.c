#include "session/session_parts.h"

static void clear_news(session_news *news)
{
    g_clear_pointer(&news->files, g_strfreev);
    g_clear_pointer(&news->loaded, held_scene_unref);
    g_clear_pointer(&news->picture, held_picture_unref);
    g_clear_pointer(&news->messages, g_ptr_array_unref);
    g_clear_pointer(&news->kept, g_free);
    g_clear_pointer(&news->resumed, neph_settings_free);
}

static gboolean tell_news(void *data)
{
    session *s = data;
    pthread_mutex_lock(&s->lock);
    session_news news = s->news;
    if (s->new_files->len > 0) {
        g_ptr_array_add(s->new_files, NULL);
        news.files = (char **)g_ptr_array_steal(s->new_files, NULL);
    }
    GError *error = g_steal_pointer(&s->news_error);
    s->news.loaded = NULL;
    s->news.picture = NULL;
    s->news.messages = NULL;
    s->news.kept = NULL;
    s->news.resumed = NULL;
    s->news_pending = false;
    pthread_mutex_unlock(&s->lock);
    news.error = error;
    if (s->listener)
        s->listener(&news, s->listener_data);
    clear_news(&news);
    g_clear_error(&error);
    return G_SOURCE_REMOVE;
}

static void free_session(session *s)
{
    clear_news(&s->news);
    g_ptr_array_unref(s->new_files);
    g_clear_error(&s->news_error);
    g_free(s->wanted.path);
    g_free(s->wanted.checkpoint);
    g_free(s->wanted.resume);
    g_free(s->order.resume);
    neph_settings_free(s->wanted.settings);
    neph_settings_free(s->order.settings);
    neph_settings_free(s->rendered);
    neph_scene_free(s->seen);
    held_scene_unref(s->scene);
    pthread_mutex_destroy(&s->lock);
    pthread_cond_destroy(&s->wake);
    g_main_context_unref(s->context);
    g_free(s);
}

void session_unref(session *s)
{
    if (atomic_fetch_sub(&s->holders, 1) == 1)
        free_session(s);
}

void session_send_news(session *s)
{
    if (s->news_pending)
        return;
    s->news_pending = true;
    g_autoptr(GSource) idle = g_idle_source_new();
    g_source_set_priority(idle, G_PRIORITY_DEFAULT);
    atomic_fetch_add(&s->holders, 1);
    g_source_set_callback(idle, tell_news, s, (GDestroyNotify)session_unref);
    g_source_attach(idle, s->context);
}

bool session_still_wants(void *data)
{
    session *s = data;
    pthread_mutex_lock(&s->lock);
    bool still = !s->wanted.quit && !s->wanted.path;
    pthread_mutex_unlock(&s->lock);
    return still;
}

void session_tell_state(session *s, session_state state)
{
    pthread_mutex_lock(&s->lock);
    bool is_wanted = s->wanted.version == s->order.version || s->wanted.keep;
    if (state != SESSION_DONE || is_wanted)
        s->news.state = state;
    session_send_news(s);
    pthread_mutex_unlock(&s->lock);
}

void session_tell_file(const char *path, void *data)
{
    session *s = data;
    pthread_mutex_lock(&s->lock);
    g_ptr_array_add(s->new_files, g_strdup(path));
    session_send_news(s);
    pthread_mutex_unlock(&s->lock);
}

void session_tell_error(session *s, GError *error, bool of_load)
{
    pthread_mutex_lock(&s->lock);
    g_clear_error(&s->news_error);
    s->news_error = error;
    s->news.error_of_load = of_load;
    session_send_news(s);
    pthread_mutex_unlock(&s->lock);
}

void session_tell_messages(session *s, GPtrArray *messages)
{
    pthread_mutex_lock(&s->lock);
    g_clear_pointer(&s->news.messages, g_ptr_array_unref);
    s->news.messages = messages;
    session_send_news(s);
    pthread_mutex_unlock(&s->lock);
}

void session_tell_picture(session *s, NephImage *image, bool coarse)
{
    held_picture *picture =
        held_picture_new(image, s->order.width, s->order.height, coarse);
    pthread_mutex_lock(&s->lock);
    held_picture_unref(s->news.picture);
    s->news.picture = picture;
    session_send_news(s);
    pthread_mutex_unlock(&s->lock);
}

void session_tell_plan(session *s)
{
    NephPlan plan;
    if (!neph_render_plan(s->render, &plan, NULL))
        return;
    pthread_mutex_lock(&s->lock);
    s->news.plan = plan;
    pthread_mutex_unlock(&s->lock);
}

void session_tell_progress(session *s, double fraction, const NephStatistics *statistics)
{
    pthread_mutex_lock(&s->lock);
    s->news.fraction = fraction;
    s->news.statistics = *statistics;
    session_send_news(s);
    pthread_mutex_unlock(&s->lock);
}

void session_tell_kept(session *s, const char *path)
{
    pthread_mutex_lock(&s->lock);
    g_free(s->news.kept);
    s->news.kept = g_strdup(path);
    session_send_news(s);
    pthread_mutex_unlock(&s->lock);
}

void session_tell_resumed(session *s, const NephSettings *settings, const int size[2])
{
    neph_settings_free(s->news.resumed);
    s->news.resumed = neph_settings_copy(settings);
    s->news.resumed_size[0] = size[0];
    s->news.resumed_size[1] = size[1];
    session_send_news(s);
}
