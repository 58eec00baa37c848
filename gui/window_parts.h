/*
 * What the window's own files share: the window's fields.
 *
 *   window.c          builds, opens, closes
 *   window_news.c     what the worker tells ─► widgets
 *   window_view.c     hands on the picture ─► the worker
 *   window_actions.c  what menus, buttons and keys do
 */
#pragma once

#include "canvas.h"
#include "document.h"
#include "error_page.h"
#include "navigation.h"
#include "session.h"
#include "settings_panel.h"
#include "state.h"
#include "status.h"
#include "window.h"

struct window {
    GtkWindow *gtk;
    GtkWidget *content; /* stack: welcome, error, main */
    GtkWidget *views;   /* stack: picture, ... */
    GtkWidget *pages;   /* stack in the sidebar */
    GtkWidget *paned, *sidebar, *toast, *play_button, *name;
    guint toast_timer;
    window_state remembered;

    session *session;
    document *document;
    error_page *errors;
    status *status;
    canvas *canvas;
    navigation *navigation;
    settings_panel *settings;

    held_scene *scene;      /* NULL: none yet */
    NephSettings *of_scene; /* settings as the file has them */
    viewpoint view;
    session_state state;
    NephStatistics statistics; /* of the render, as last told */
    double fraction;
    bool reloading; /* the next scene is the same file: keep what the user changed */
    bool focusing;  /* the next click chooses what is sharp */
};

/* window.c */
void window_toast(window *w, const char *format, ...) G_GNUC_PRINTF(2, 3);
void window_show_content(window *w, const char *page);

/* window_news.c */
void window_on_news(const session_news *news, void *data);

/* window_view.c */
void window_view_moved(const NephCamera *camera, bool moving, void *data);
void window_view_clicked(double x, double y, int n, void *data);
void window_hover(bool inside, int x, int y, void *data);
void window_set_camera(window *w, const NephCamera *camera);

/* window_actions.c */
void window_add_actions(window *w);
/** @brief Which actions make sense now. */
void window_update_actions(window *w);
GMenuModel *window_menu(void);
void window_fill_scenes_menu(GMenu *menu);
void window_apply_theme(window *w);
