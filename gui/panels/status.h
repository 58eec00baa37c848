/*
 * The line below the picture: how far the render is, and what is under the pointer.
 */
#pragma once

#include "session/session.h"

#include <gtk/gtk.h>

typedef struct status status;

status *status_new(void);
void status_free(status *s);
GtkWidget *status_widget(status *s);
void status_show(status *s, const session_news *news);
/** @brief How many messages there are; NULL: none. */
void status_show_messages(status *s, const char *summary);
/** @brief What is being rendered, and where it lies. */
void status_show_name(status *s, const char *name, const char *path);
/** @brief What the pointer is over; NULL: nothing. */
void status_show_pointer(status *s, const char *text);

/** @brief "Pass 5 of 20 · 12 s · noise 2.1 % · 34 s left"; owned by the caller. */
char *status_text(const session_news *news);
/** @brief A time for people: "4.2 s", "3 min 5 s", "2 h 10 min". Owned by the caller. */
char *status_duration(double seconds);
