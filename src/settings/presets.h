/*
 * Presets: files of settings that come with the program, each what a text on photon
 * mapping describes.
 */
#pragma once

#include "settings/settings.h"

/** @brief Their names in order, NULL-terminated; owned by the caller. */
GStrv settings_presets(void);
/** @brief The text of a preset's file, whose first line is a comment that says what it
 * follows; owned by the caller. ERROR_USAGE with the list of those that there are. */
char *settings_preset_text(const char *name, GError **error);
/** @brief Sets what a preset does; all else stays as it is. */
bool settings_load_preset(settings *s, const char *name, GError **error);
