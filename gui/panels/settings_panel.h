/*
 * The page of all settings, made from the library's table: those that the course
 * assignment names first, the rest in groups by what they are about.
 */
#pragma once

#include "widgets/setting_control.h"

typedef struct settings_panel settings_panel;

/** @brief Told a moment after the last change. settings are borrowed. */
typedef void (*settings_listener)(const NephSettings *settings, void *data);
typedef void (*size_listener)(int width, int height, void *data);

settings_panel *settings_panel_new(settings_listener changed, size_listener resized,
                                   void *data);
/** @brief When the widget has gone. */
void settings_panel_free(settings_panel *p);
GtkWidget *settings_panel_widget(settings_panel *p);
/** @brief Shows values (copied), without telling. scene: those that "As in the scene"
 * goes back to; NULL: keep. */
void settings_panel_show(settings_panel *p, const NephSettings *values,
                         const NephSettings *scene);
void settings_panel_show_size(settings_panel *p, int width, int height);
/** @brief The values shown. Borrowed. */
const NephSettings *settings_panel_values(const settings_panel *p);
/** @brief The control of a setting, or NULL. */
setting_control *settings_panel_find(settings_panel *p, const char *name);
/** @brief Puts the keyboard into the search field. */
void settings_panel_search(settings_panel *p);
