/*
 * The photons in their scene: points or arrows over the wireframe, by OpenGL, from the
 * same place as the picture.
 */
#pragma once

#include "photons/photon_cloud.h"
#include "picture/viewpoint.h"

#include <gtk/gtk.h>

typedef struct photon_view photon_view;

/** @brief How photons are shown. */
typedef struct photon_style {
    unsigned maps; /**< bit c: map c is shown */
    cloud_coloring coloring;
    float point_size; /**< pixels */
    bool wireframe;
} photon_style;

/** @brief Fewer photons than this are arrows. */
enum { MOST_ARROWS = 1000 };

/** @brief What the last frame was. */
typedef struct photon_frame {
    guint64 number; /**< counted from 1; 0: none yet */
    double seconds; /**< that drawing what can be seen took; 0: none yet */
    size_t points;  /**< photons that can be seen, */
    size_t all;     /**< of so many: slow graphics draw them in several frames */
} photon_frame;

/** @brief viewpoint: borrowed, must outlive it. drawn is told a moment after a frame. */
photon_view *photon_view_new(const viewpoint *view,
                             void (*drawn)(const photon_frame *frame, void *data),
                             void *data);
/** @brief When the widget has gone. */
void photon_view_free(photon_view *v);
/** @brief The area, focusable. */
GtkWidget *photon_view_widget(photon_view *v);
/** @brief Another scene (held): its wireframe, which is made when it is first to be seen,
 * and no photons. */
void photon_view_set_scene(photon_view *v, held_scene *scene);
/** @brief Takes the cloud; NULL: none. */
void photon_view_set_cloud(photon_view *v, photon_cloud *cloud);
const photon_cloud *photon_view_cloud(const photon_view *v);
void photon_view_set_style(photon_view *v, const photon_style *style);
const photon_style *photon_view_style(const photon_view *v);
/** @brief The viewpoint has moved. */
void photon_view_redraw(photon_view *v);
/** @brief Drawn over everything: line ends, and points. Copied. */
void photon_view_set_marks(photon_view *v, const cloud_vertex *lines, size_t n_lines,
                           const cloud_vertex *points, size_t n_points);
/** @brief Place in the widget to place in the picture, which the camera's screen spans:
 * 0..1, y down, beyond it outside of that. */
void photon_view_place(const photon_view *v, double wx, double wy, double place[2]);
/** @brief Pixels of the widget for the picture's height. */
double photon_view_scale(const photon_view *v);
const photon_frame *photon_view_frame(const photon_view *v);
