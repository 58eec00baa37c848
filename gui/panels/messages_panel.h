/*
 * What was said about the scene: a page with all of it, and a strip over the picture that
 * comes with warnings and stays until it is closed.
 */
#pragma once

#include "session/messages.h"

#include <gtk/gtk.h>

typedef struct messages_panel messages_panel;

messages_panel *messages_panel_new(void);
/** @brief When the widgets have gone. */
void messages_panel_free(messages_panel *p);
GtkWidget *messages_panel_widget(messages_panel *p);
GtkWidget *messages_panel_strip(messages_panel *p);

/** @brief Shows these in the place of all before; the strip comes if there are warnings
 * that were not there before. @param path of the scene, whose folder is left out of texts
 */
void messages_panel_show(messages_panel *p, const char *path, const GPtrArray *list);
/** @brief One more. */
void messages_panel_add(messages_panel *p, message_kind kind, const char *text);
/** @brief All that is shown. Borrowed. */
const GPtrArray *messages_panel_list(const messages_panel *p);
