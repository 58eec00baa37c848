/*
 * The window as a PNG file: for the manual's pictures.
 */
#pragma once

#include <gtk/gtk.h>
#include <stdbool.h>

/** @brief Draws the window once more, into a file, at the pixels of its screen. false
 * with *error; G_IO_ERROR_BUSY: it is just being drawn, try again. */
bool screenshot_take(GtkWindow *window, const char *path, GError **error);
