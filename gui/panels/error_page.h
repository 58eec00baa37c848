/*
 * What is wrong with a scene, place by place: file, line, message, and the line itself
 * with a mark under the column.
 */
#pragma once

#include <gtk/gtk.h>
#include <stdbool.h>

/** @brief One message. */
typedef struct error_place {
    char *file;       /**< NULL: the message names no place */
    int line, column; /**< from 1; 0: unknown */
    char *message;
    char *source; /**< the offending line, NULL if it cannot be read */
} error_place;

/** @brief Takes a library's message apart: one line a place. Owned by the caller, an
 * array of error_place (g_array_unref). */
GArray *error_places(const char *message);

typedef struct error_page error_page;

error_page *error_page_new(void);
void error_page_free(error_page *p);
GtkWidget *error_page_widget(error_page *p);
/** @brief Shows what went wrong with a file. can_go_back: there is a scene behind. */
void error_page_show(error_page *p, const char *file, const char *message,
                     bool can_go_back);
