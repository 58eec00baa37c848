/*
 * The page of the camera: lens and place as numbers, and ways to keep a view.
 */
#pragma once

#include <gtk/gtk.h>
#include <nephroid/nephroid.h>

typedef struct camera_panel camera_panel;
typedef void (*camera_listener)(const NephCamera *camera, void *data);

camera_panel *camera_panel_new(camera_listener changed, void *data);
/** @brief When the widget has gone. */
void camera_panel_free(camera_panel *p);
GtkWidget *camera_panel_widget(camera_panel *p);
/** @brief Shows a view, without telling. */
void camera_panel_show(camera_panel *p, const NephCamera *camera);
