#include "session/session_parts.h"

#include <math.h>
#include <sys/resource.h>

/* A quick look while the view moves takes about this long, s; those that follow when it
   stands still, until the first pass is done. */
#define LOOK_MOVING 0.05
static const double looks_still[] = {0.25};

/* Shares of its time that a render may spend on handing pictures over: those of twice as
   many passes as the last one, which look better, and others. */
#define BETTER_SHARE 0.33
#define SNAPSHOT_SHARE 0.1

static double seconds(void)
{
    return (double)g_get_monotonic_time() * 1e-6;
}

/* ---- Rendering, on the worker ---- */

/* True if the window has thought of something else. With the lock held. A quick look on
   the way is worth its end: the next view will be the latest then. */
static bool outdated(const session *s)
{
    const session_order *wanted = &s->wanted;
    bool on_the_way = s->order.moving && wanted->moving && !wanted->quit && !wanted->path;
    return wanted->version != s->order.version && !on_the_way;
}

static void set_running(session *s, NephRender *render)
{
    pthread_mutex_lock(&s->lock);
    s->running = render;
    if (render && outdated(s))
        neph_render_cancel(render);
    pthread_mutex_unlock(&s->lock);
}

static bool is_outdated(session *s)
{
    pthread_mutex_lock(&s->lock);
    bool is = outdated(s);
    pthread_mutex_unlock(&s->lock);
    return is;
}

static bool go_on(double fraction, const NephStatistics *statistics, void *data)
{
    (void)fraction, (void)statistics;
    return !is_outdated(data);
}

/* A small picture with few photons. @return false if it failed or was cancelled. */
static bool quick_look(session *s, double allowed)
{
    const int whole[2] = {s->order.width, s->order.height};
    int size[2];
    double start = seconds();
    preview_size(&s->pace, allowed, whole, size);
    s->look_was_whole = size[0] == whole[0] && size[1] == whole[1];
    g_autoptr(NephSettings) settings = preview_settings(s->order.settings, s->extent);
    neph_scene_resize(s->seen, size[0], size[1], NULL);
    g_autoptr(NephRender) render = neph_render_new(s->seen, settings, NULL);
    NephImage *image = NULL;
    if (render) {
        set_running(s, render);
        if (neph_render_run(render, go_on, s, NULL))
            image = neph_render_image(render, NULL);
        set_running(s, NULL);
    }
    if (image) {
        preview_note(&s->pace, size, seconds() - start);
        session_tell_picture(s, image, true);
    }
    return image != NULL;
}

/* A render that pauses is still to be seen. */
static bool still_wanted_picture(void *data)
{
    session *s = data;
    pthread_mutex_lock(&s->lock);
    const session_order *w = &s->wanted;
    bool same = w->version == s->order.version || w->keep;
    bool wanted = same && !w->quit && !w->path;
    pthread_mutex_unlock(&s->lock);
    return wanted;
}

/* Of what nobody wants any more no noise is taken out. */
static void show_picture(session *s)
{
    double start = seconds();
    NephImage *image = neph_render_image_while(s->render, still_wanted_picture, s, NULL);
    if (image)
        session_tell_picture(s, image, false);
    s->last_snapshot = seconds();
    s->snapshot_cost = s->last_snapshot - start;
}

/* Pictures are handed over as often as they are cheap beside the passes. */
static bool is_time_to_show(const session *s, const NephStatistics *now)
{
    bool first = now->passes == 0 && now->can_look;
    bool better = now->passes >= 2 * s->passes_shown;
    double budget = better ? BETTER_SHARE : SNAPSHOT_SHARE;
    bool cheap = budget * (seconds() - s->last_snapshot) > s->snapshot_cost;
    return (first || now->passes > s->passes_shown) && (cheap || s->passes_shown == 0);
}

static bool on_progress(double fraction, const NephStatistics *statistics, void *data)
{
    session *s = data;
    NephStatistics now = *statistics;
    if (is_time_to_show(s, statistics)) {
        s->passes_shown = statistics->passes;
        show_picture(s);
    }
    session_keep(s, statistics);
    now.noise = statistics->passes > 1 ? neph_render_noise(s->render) : (double)INFINITY;
    if (!s->news.plan.integrator)
        session_tell_plan(s);
    session_tell_progress(s, fraction, &now);
    return !is_outdated(s);
}

static bool begin_render(session *s, GError **error)
{
    s->passes_shown = 0;
    s->last_snapshot = s->snapshot_cost = 0.0;
    s->complete = false;
    bool going = quick_look(s, LOOK_MOVING);
    for (size_t i = 0; i < G_N_ELEMENTS(looks_still) && going; i++)
        going = !s->look_was_whole && quick_look(s, looks_still[i]);
    neph_scene_resize(s->seen, s->order.width, s->order.height, NULL);
    s->render = neph_render_new(s->seen, s->order.settings, error);
    pthread_mutex_lock(&s->lock);
    s->news.plan.integrator = NULL;
    neph_settings_free(s->rendered);
    s->rendered = neph_settings_copy(s->order.settings);
    pthread_mutex_unlock(&s->lock);
    return s->render != NULL;
}

static void run(session *s)
{
    g_autoptr(GError) error = NULL;
    NephStatistics statistics;
    session_tell_state(s, SESSION_RENDERING);
    bool ok = s->render || begin_render(s, &error);
    if (ok) {
        set_running(s, s->render);
        ok = neph_render_run(s->render, on_progress, s, &error);
        set_running(s, NULL);
        neph_render_statistics(s->render, &statistics);
        if (ok || statistics.passes > s->passes_shown)
            show_picture(s);
        session_tell_progress(s, ok ? 1.0 : s->news.fraction, &statistics);
    }
    s->complete = ok;
    s->failed = error && !g_error_matches(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_CANCELLED);
    if (s->failed)
        session_tell_error(s, g_steal_pointer(&error), false);
    if (s->complete || s->failed)
        session_tell_state(s, SESSION_DONE);
}

/* ---- Loading ---- */

static void measure(session *s)
{
    double low[3], high[3], sum = 0.0;
    s->extent = 0.0;
    if (!neph_scene_bounds(s->scene->scene, low, high))
        return;
    for (int i = 0; i < 3; i++)
        sum += (high[i] - low[i]) * (high[i] - low[i]);
    s->extent = sqrt(sum);
}

/* The order's settings, view and size become those of the scene, unless the window has
   asked for another scene meanwhile. */
static void take_over(session *s)
{
    NephScene *scene = s->scene->scene;
    pthread_mutex_lock(&s->lock);
    neph_settings_free(s->wanted.settings);
    s->wanted.settings = neph_scene_settings(scene);
    s->wanted.width = s->scene->width;
    s->wanted.height = s->scene->height;
    s->wanted.camera = s->scene->camera;
    s->wanted.version++;
    held_scene_unref(s->news.loaded);
    s->news.loaded = held_scene_ref(s->scene);
    session_send_news(s);
    pthread_mutex_unlock(&s->lock);
}

static void load(session *s, const char *path)
{
    g_autoptr(GError) error = NULL;
    scene_log *log = scene_log_new();
    const NephLoadOptions options = {.file = session_tell_file,
                                     .file_data = s,
                                     .go_on = session_still_wants,
                                     .go_on_data = s,
                                     .log = scene_log_write,
                                     .log_data = log};
    session_tell_state(s, SESSION_LOADING);
    NephScene *scene = neph_scene_load_with(path, &options, &error);
    if (g_error_matches(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_CANCELLED)) {
        scene_log_free(log);
        return;
    }
    session_tell_messages(s, scene_log_close(log));
    if (!scene) {
        scene_log_free(log);
        session_tell_state(s, s->scene ? SESSION_STOPPED : SESSION_EMPTY);
        session_tell_error(s, g_steal_pointer(&error), true);
        return;
    }
    g_clear_pointer(&s->render, neph_render_free);
    g_clear_pointer(&s->seen, neph_scene_free);
    held_scene_unref(s->scene);
    s->scene = held_scene_new(scene, log);
    s->seen = neph_scene_share(scene);
    s->complete = s->failed = false;
    s->pace = (preview_pace){0};
    measure(s);
    take_over(s);
}

/* ---- The worker ---- */

static bool has_work(const session *s)
{
    const session_order *w = &s->wanted;
    if (w->quit || w->path || w->checkpoint || w->resume ||
        w->version != s->order.version)
        return true;
    return s->scene && s->wanted.playing && !s->wanted.moving && !s->complete &&
           !s->failed;
}

/* Waits for work; the order is then the worker's own copy. Returns the path to load, or
   NULL. */
static char *next_order(session *s, bool *changed)
{
    pthread_mutex_lock(&s->lock);
    while (!has_work(s))
        pthread_cond_wait(&s->wake, &s->lock);
    char *path = g_steal_pointer(&s->wanted.path);
    *changed = s->wanted.version != s->order.version;
    bool keep = *changed && s->wanted.keep;
    neph_settings_free(s->order.settings);
    g_free(s->order.resume);
    s->order = s->wanted;
    s->order.settings =
        s->wanted.settings ? neph_settings_copy(s->wanted.settings) : NULL;
    s->wanted.resume = NULL;
    s->wanted.keep = true;
    pthread_mutex_unlock(&s->lock);
    *changed = *changed && !keep;
    return path;
}

static void renew(session *s)
{
    g_clear_pointer(&s->render, neph_render_free);
    s->complete = s->failed = false;
    neph_scene_set_camera(s->seen, &s->order.camera, NULL);
}

static void *work(void *data)
{
    session *s = data;
    setpriority(PRIO_PROCESS, 0, 5); /* the window comes first */
    for (;;) {
        bool changed;
        g_autofree char *path = next_order(s, &changed);
        if (s->order.quit)
            break;
        if (path)
            load(s, path);
        if (!s->scene)
            session_keep_now(s);
        if (!s->scene || path)
            continue;
        if (changed)
            renew(s);
        g_autofree char *resume = g_steal_pointer(&s->order.resume);
        if (resume && session_go_on_from(s, resume))
            s->complete = s->failed = false;
        if (s->order.moving)
            quick_look(s, LOOK_MOVING);
        else if (s->order.playing && !s->complete && !s->failed)
            run(s);
        else if (!s->complete && !s->failed)
            session_tell_state(s, s->render ? SESSION_PAUSED : SESSION_STOPPED);
        session_keep_now(s);
    }
    g_clear_pointer(&s->render, neph_render_free);
    return NULL;
}

/* ---- Orders ---- */

session *session_new(session_listener listener, void *data)
{
    session *s = g_new0(session, 1);
    atomic_init(&s->holders, 1);
    s->listener = listener;
    s->listener_data = data;
    s->context = g_main_context_ref_thread_default();
    s->wanted.playing = true;
    s->wanted.keep = true;
    s->news.statistics.noise = (double)INFINITY;
    s->new_files = g_ptr_array_new_with_free_func(g_free);
    pthread_mutex_init(&s->lock, NULL);
    pthread_cond_init(&s->wake, NULL);
    s->has_thread = pthread_create(&s->thread, NULL, work, s) == 0;
    return s;
}

/* Between lock and unlock, `wanted` is changed. */
static void order_begin(session *s)
{
    pthread_mutex_lock(&s->lock);
}

/* anew: what is rendered changes, not only whether. */
static void order_end(session *s, bool anew)
{
    s->wanted.version++;
    if (anew)
        s->wanted.keep = false;
    if (anew && s->news.state == SESSION_DONE) /* that was of something else */
        s->news.state = s->wanted.playing ? SESSION_RENDERING : SESSION_STOPPED;
    if (s->running && outdated(s))
        neph_render_cancel(s->running);
    pthread_cond_signal(&s->wake);
    pthread_mutex_unlock(&s->lock);
}

void session_close(session *s)
{
    if (!s)
        return;
    s->listener = NULL;
    order_begin(s);
    s->wanted.quit = true;
    order_end(s, true);
    if (s->has_thread)
        pthread_join(s->thread, NULL);
    session_unref(s);
}

void session_load(session *s, const char *path)
{
    order_begin(s);
    g_free(s->wanted.path);
    s->wanted.path = g_strdup(path);
    s->wanted.playing = true;
    s->wanted.moving = false;
    order_end(s, false);
}

void session_set_settings(session *s, const NephSettings *settings)
{
    order_begin(s);
    neph_settings_free(s->wanted.settings);
    s->wanted.settings = neph_settings_copy(settings);
    order_end(s, true);
}

NephSettings *session_rendered_settings(session *s)
{
    pthread_mutex_lock(&s->lock);
    NephSettings *copy = s->rendered ? neph_settings_copy(s->rendered) : NULL;
    pthread_mutex_unlock(&s->lock);
    return copy;
}

void session_set_camera(session *s, const NephCamera *camera, bool moving)
{
    order_begin(s);
    s->wanted.camera = *camera;
    s->wanted.moving = moving;
    order_end(s, true);
}

void session_set_size(session *s, int width, int height)
{
    order_begin(s);
    s->wanted.width = width;
    s->wanted.height = height;
    order_end(s, true);
}

static void set_playing(session *s, bool playing, bool anew)
{
    order_begin(s);
    s->wanted.playing = playing;
    order_end(s, anew);
}

void session_play(session *s)
{
    set_playing(s, true, false);
}

void session_pause(session *s)
{
    set_playing(s, false, false);
}

void session_stop(session *s)
{
    set_playing(s, false, true);
}

void session_restart(session *s)
{
    set_playing(s, true, true);
}

void session_keep_in(session *s, const char *path)
{
    order_begin(s);
    g_free(s->wanted.checkpoint);
    s->wanted.checkpoint = g_strdup(path);
    pthread_cond_signal(&s->wake);
    pthread_mutex_unlock(&s->lock);
}

void session_resume(session *s, const char *path)
{
    order_begin(s);
    g_free(s->wanted.resume);
    s->wanted.resume = g_strdup(path);
    order_end(s, false);
}
