/*
 * The system's dialogs for files, with what becomes of the choice.
 */
#pragma once

#include <gtk/gtk.h>
#include <stdbool.h>

/** @brief What to ask for. Plain value, strings borrowed during the call. */
typedef struct file_question {
    const char *title;
    bool save;
    const char *suggested;       /**< a name to save under, or NULL */
    const char *folder;          /**< where to begin, or NULL */
    const char *filter;          /**< name of the files wanted */
    const char *const *patterns; /**< theirs, NULL-terminated */
} file_question;

/** @brief "*.exr" of ".exr" and so on. Owned by the caller. */
char **file_patterns(const char *const *extensions);

/** @brief Asks, and calls chosen with a path if there is one. data must live as long as
 * the window. */
void file_dialog_ask(GtkWindow *parent, const file_question *question,
                     void (*chosen)(const char *path, void *data), void *data);
