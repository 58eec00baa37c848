/*
 * What the window's own files share: the window's fields.
 *
 *   window.c          builds, opens, closes
 *   window_news.c     what the worker tells ─► widgets
 *   window_view.c     hands on the picture ─► the worker
 *   window_photons.c  photons alone: traced, shown, picked
 *   window_actions.c  what menus, buttons and keys do
 *   window_shell.c    what these ask of the window; calls none of them
 */
#pragma once

#include "files/document.h"
#include "panels/camera_panel.h"
#include "panels/error_page.h"
#include "panels/inspector.h"
#include "panels/lobe_view.h"
#include "panels/messages_panel.h"
#include "panels/numbers_panel.h"
#include "panels/photon_panel.h"
#include "panels/settings_panel.h"
#include "panels/status.h"
#include "photons/photon_view.h"
#include "picture/canvas.h"
#include "picture/navigation.h"
#include "session/session.h"
#include "window/appearance.h"
#include "window/state.h"
#include "window/window.h"

struct window {
    GtkWindow *gtk;
    GtkWidget *content; /* stack: welcome, error, main */
    GtkWidget *views;   /* stack: picture, ... */
    GtkWidget *pages;   /* stack in the sidebar */
    GtkWidget *paned, *sidebar, *toast, *play_button;
    GtkWidget *switcher, *side_button; /* seen while there is a scene */
    GMenu *scenes;                     /* recent ones and examples */
    guint toast_timer;
    window_state remembered;

    appearance *appearance;
    GCancellable *files; /* cancelled when the window goes */

    session *session;
    document *document;
    error_page *errors;
    status *status;
    canvas *canvas;
    navigation *navigation;
    settings_panel *settings;
    camera_panel *camera_panel;
    inspector *inspector;
    numbers_panel *numbers;
    lobe_view *lobes;
    messages_panel *messages;
    photon_view *photon_view;
    photon_panel *photon_panel;
    navigation *photon_navigation;

    held_scene *scene;      /* NULL: none yet */
    NephSettings *of_scene; /* settings as the file has them */
    viewpoint view;
    int size[2]; /* of the picture, pixels */
    session_state state;
    NephStatistics statistics; /* of the render, as last told */
    double fraction;
    bool reloading; /* the next scene is the same file: keep what the user changed */
    bool judged;    /* whether the scene's picture shows anything has been said */
    double exposed; /* stops that the program chose for it; 0: none */
    bool focusing;  /* the next click chooses what is sharp */

    held_photons *photons; /* of the photon view; NULL: none yet */
    GCancellable *tracing; /* NULL: none are being traced */
    char *pick_then;       /* where to pick when they are traced; NULL: nowhere */
    bool has_pick, picked_is_photon;
    size_t picked_photon;
    NephSurfacePoint picked; /* strings are the scene's */
    double pick_radius;      /* m; 0: each map's own */
};

/* window_shell.c */
void window_toast(window *w, const char *format, ...) G_GNUC_PRINTF(2, 3);
void window_show_content(window *w, const char *page);
/** @brief Which actions make sense now. */
void window_update_actions(window *w);

/* window.c */

/** @brief Opens a scene; a picture becomes what the scene is compared with. */
void window_take_file(window *w, const char *path);

/* window_news.c */
void window_on_news(const session_news *news, void *data);

/* window_view.c */
void window_view_moved(const NephCamera *camera, bool moving, void *data);
void window_view_clicked(double x, double y, int n, void *data);
void window_divided(double at, void *data);
void window_hover(bool inside, int x, int y, void *data);
void window_camera_changed(const NephCamera *camera, void *data);
/** @brief Makes sharp what is at a place of the picture, 0..1; false: nothing is. */
bool window_focus_at(window *w, const double place[2]);
void window_ask_reference(void *data);
void window_set_reference(window *w, const char *path);
void window_add_view_actions(window *w);

/* window_photons.c */
void window_trace_photons(window *w);
void window_stop_tracing(window *w);
void window_photons_new_scene(window *w);
void window_photons_settings_changed(window *w);
void window_view_switched(window *w);
void window_photons_drawn(const photon_frame *frame, void *data);
void window_photon_style(const photon_style *style, void *data);
void window_photon_clicked(double x, double y, int n, void *data);
void window_pick_radius(double radius, void *data);
/** @brief Picks at a place of the picture, 0..1; reach: as share of its height. */
bool window_pick(window *w, const double place[2], double reach);

/* window_actions.c */
void window_add_actions(window *w);
GMenuModel *window_menu(void);
void window_fill_scenes_menu(GMenu *menu);
void window_apply_theme(window *w);
void window_scheme_changed(appearance_scheme scheme, void *data);
