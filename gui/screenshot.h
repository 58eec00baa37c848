/*
 * The window as a PNG file: for the manual's pictures.
 */
#pragma once

#include <gtk/gtk.h>
#include <stdbool.h>

/** @brief Draws the window once more, into a file. false with *error. */
bool screenshot_take(GtkWindow *window, const char *path, GError **error);
