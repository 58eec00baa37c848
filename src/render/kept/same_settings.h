/*
 * Whether a file that a render is to use was made by the same settings.
 */
#pragma once

#include "settings/settings.h"

#include <stdbool.h>

typedef struct settings_question {
    const settings *now, *then;   /**< of the render, and of the file */
    const char *const *free_rows; /**< that may differ; NULL-terminated */
    const char *path;             /**< of the file */
} settings_question;

/** @brief ERROR_INPUT with the first row that differs: "PATH: WHAT with NAME = THEN, not
 * NOW". @param what the file is, such as "the checkpoint is of a render" */
bool same_settings(const settings_question *question, const char *what, GError **error);

/** @brief Sets some rows as they are in another's. @param rows NULL-terminated */
void take_settings_of(settings *to, const settings *from, const char *const *rows);
