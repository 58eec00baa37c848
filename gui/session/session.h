/*
 * One scene being rendered: a worker thread, and the hand-over between it and the window.
 *
 *   window ── orders (scene, settings, view, play or pause) ──► worker
 *          ◄─ news   (scene loaded, error, picture, progress) ──
 *
 * Both directions are one slot each under one lock, and the latest wins: a window that is
 * busy misses pictures, never falls behind. An order that changes what is rendered
 * cancels the pass under way. News are told on the main context of the thread that made
 * the session. Needs no display.
 */
#pragma once

#include "session/held.h"

typedef struct session session;

typedef enum session_state {
    SESSION_EMPTY,     /**< no scene */
    SESSION_LOADING,   /**< reading a scene */
    SESSION_RENDERING, /**< at work */
    SESSION_PAUSED,    /**< goes on where it was */
    SESSION_STOPPED,   /**< begins anew when started */
    SESSION_DONE       /**< by its settings; rendering again begins anew */
} session_state;

/** @brief What has happened since the last news. Borrowed; ref what is to be kept. */
typedef struct session_news {
    session_state state;
    char **files;          /**< that reading has come to, NULL-terminated; else NULL */
    held_scene *loaded;    /**< a scene has been read; else NULL */
    held_picture *picture; /**< a newer one; else NULL */
    const GError *error;   /**< reading or rendering failed; else NULL */
    GPtrArray *messages;   /**< message*: what was said while a scene was read, whether it
                              could be or not; else NULL */
    bool error_of_load; /**< the error is about the scene file; the old scene goes on */
    double fraction;    /**< 0..1 of the render */
    NephStatistics statistics;
    char *kept;            /**< what is rendered is kept in this file; else NULL */
    NephSettings *resumed; /**< it goes on from a checkpoint, by these settings ... */
    int resumed_size[2];   /**< ... in this size; else NULL */
    NephPlan plan;         /**< of the render, once it is made: integrator NULL before */
} session_news;

typedef void (*session_listener)(const session_news *news, void *data);

/** @brief Starts the worker. listener is called until session_close. */
session *session_new(session_listener listener, void *data);
/** @brief Cancels, joins the worker, tells no news any more and frees. */
void session_close(session *s);

/** @brief Reads a scene and renders it, with the settings of the file. */
void session_load(session *s, const char *path);
/** @brief Renders anew with other settings (copied). */
void session_set_settings(session *s, const NephSettings *settings);
/** @brief The settings that the render under way, or the last one, was given; NULL before
 * there was one. Owned by the caller. */
NephSettings *session_rendered_settings(session *s);
/** @brief Renders anew from elsewhere. moving: quick looks only, more will come. */
void session_set_camera(session *s, const NephCamera *camera, bool moving);
/** @brief Renders anew in another size. */
void session_set_size(session *s, int width, int height);
/** @brief Starts, or goes on after a pause. */
void session_play(session *s);
/** @brief The passes done are kept, the one under way is given up. */
void session_pause(session *s);
/** @brief The picture stays, its passes are forgotten. */
void session_stop(session *s);
/** @brief Begins the render anew. */
void session_restart(session *s);
/** @brief Keeps what is rendered in a checkpoint, as soon as a pass is done; the render
 * goes on. News say that it is kept, or why not. */
void session_keep_in(session *s, const char *path);
/** @brief Goes on from a checkpoint of the scene, as it is seen now, with the settings
 * and size of it. Where that can not be, the error is told, and all goes on as it was. */
void session_resume(session *s, const char *path);
