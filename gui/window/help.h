/*
 * The overlay of keys and mouse.
 */
#pragma once

#include <gtk/gtk.h>

/** @brief A new one; the application window takes it
 * (gtk_application_window_set_help_overlay). */
GtkShortcutsWindow *help_make(void);
