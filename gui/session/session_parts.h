/*
 * What the session's own files share: its fields.
 *
 *   session.c             takes orders; the worker renders and loads
 *   session_checkpoint.c  the worker keeps what is rendered, and goes on from there
 *   session_news.c        what is told the window; calls none of them
 */
#pragma once

#include "session/preview.h"
#include "session/session.h"

#include <pthread.h>
#include <stdatomic.h>

/* What the window wants. `version` grows with each change of what is to be rendered. */
typedef struct session_order {
    guint version;
    char *path; /* to be loaded; NULL: done */
    NephSettings *settings;
    NephCamera camera;
    int width, height;
    bool playing, moving;
    bool keep; /* the changes not yet taken up leave what is rendered as it is */
    bool quit;
    char *checkpoint; /* what is rendered is to be kept there; NULL: done */
    char *resume;     /* to go on from there; NULL: done */
} session_order;

struct session {
    atomic_int holders;
    pthread_t thread;
    bool has_thread;
    GMainContext *context;
    session_listener listener; /* NULL once closed; main thread only */
    void *listener_data;

    /* POSIX's own, which the thread sanitizer sees. */
    pthread_mutex_t lock; /* guards what follows, up to the next comment */
    pthread_cond_t wake;
    session_order wanted;
    NephRender *running;    /* to be cancelled */
    NephSettings *rendered; /* what the render was given; NULL: none yet */
    session_news news;      /* owned fields; files: those of new_files, when told */
    GPtrArray *new_files;   /* char* */
    GError *news_error;
    bool news_pending; /* an idle source is on its way */

    /* The worker's own. */
    session_order order; /* its copy of wanted */
    held_scene *scene;
    NephScene *seen;    /* it, in the size and from where it is rendered */
    NephRender *render; /* of order.version; NULL: to be made */
    double extent;      /* of the scene, m */
    preview_pace pace;
    bool look_was_whole; /* the last quick look had as many pixels as the picture */
    int64_t passes_shown;
    double last_snapshot, snapshot_cost; /* s */
    bool complete, failed;
};

/* ---- session_news.c: on any thread ---- */

/** @brief Until another scene is asked for, or none. A NephGoOnFunc; data: session. */
bool session_still_wants(void *data);
/** @brief Lets go; whoever is last frees. */
void session_unref(session *s);
/** @brief With the lock held: what s->news says will be told. */
void session_send_news(session *s);
/** @brief That it is done is not told of what nobody wants any more. */
void session_tell_state(session *s, session_state state);
/** @brief At once, so that a file is watched while those after it are read. */
void session_tell_file(const char *path, void *data);
/** @brief Takes the error. */
void session_tell_error(session *s, GError *error, bool of_load);
/** @brief Takes the list. */
void session_tell_messages(session *s, GPtrArray *messages);
/** @brief Takes the image. */
void session_tell_picture(session *s, NephImage *image, bool coarse);
/** @brief On the thread that renders, once it plans no more. */
void session_tell_plan(session *s);
void session_tell_progress(session *s, double fraction, const NephStatistics *statistics);
/** @brief What is rendered has been kept in a file. */
void session_tell_kept(session *s, const char *path);
/** @brief With the lock held: it goes on from a checkpoint, by settings that are copied.
 */
void session_tell_resumed(session *s, const NephSettings *settings, const int size[2]);

/* ---- session_checkpoint.c: on the worker ---- */

/** @brief Keeps what there is, if that was asked for and a pass is done. */
void session_keep(session *s, const NephStatistics *statistics);
/** @brief The same where nothing is rendered just now: what can not be kept is told. */
void session_keep_now(session *s);
/** @brief Makes the render that goes on from a checkpoint; else all is as it was, and why
 * is told. @return whether it does */
bool session_go_on_from(session *s, const char *path);
