/*
 * The main window: one scene, its picture, and the panels around it.
 */
#pragma once

#include <gtk/gtk.h>

typedef struct window window;

/** @brief A window without a scene. Freed when the GTK window is destroyed. */
window *window_new(GtkApplication *app);
GtkWindow *window_gtk(window *w);
/** @brief As a click at a place "X,Y" of the picture, 0..1 each from the upper left, once
 * photons are traced. */
void window_pick_when_traced(window *w, const char *place);
/** @brief Reads a scene and renders it. */
void window_open(window *w, const char *path);
