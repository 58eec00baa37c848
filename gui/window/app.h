/*
 * The program around its windows: command line, keys, style, about.
 */
#pragma once

#include <gtk/gtk.h>

/** @brief The application, ready for g_application_run. */
GtkApplication *app_new(void);
