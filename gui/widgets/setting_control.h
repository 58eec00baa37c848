/*
 * One setting as a row: title, the control its type asks for, unit and a way back to the
 * default; all of it made from the setting's row in the library's table.
 */
#pragma once

#include <gtk/gtk.h>
#include <nephroid/nephroid.h>

typedef struct setting_control setting_control;

/** @brief value: as neph_settings_set reads it. */
typedef void (*setting_changed)(const NephSettingInfo *info, const char *value,
                                void *data);

/** @brief Adds the row to a list. The control is freed by setting_control_free, the
 * widgets with the list. */
setting_control *setting_control_new(GtkWidget *list, const NephSettingInfo *info,
                                     setting_changed changed, void *data);
void setting_control_free(setting_control *c);
const NephSettingInfo *setting_control_info(const setting_control *c);
/** @brief The list's row, to be shown or hidden. */
GtkWidget *setting_control_row(const setting_control *c);
/** @brief The switch, spin button, slider or drop-down. */
GtkWidget *setting_control_input(const setting_control *c);
/** @brief Shows a value, without telling. */
void setting_control_show(setting_control *c, const char *value);
/** @brief Whether the integrator reads it: others are dimmed. */
void setting_control_set_used(setting_control *c, bool used);
/** @brief The title for people: "max_backward_bounces" as "Max backward bounces". Owned
 * by the caller. */
char *setting_title(const NephSettingInfo *info);
/** @brief What the lowest value stands for where the setting's doc says so, as "-1:
 * unlimited"; NULL: nothing. Owned by the caller. */
char *setting_special(const NephSettingInfo *info);
