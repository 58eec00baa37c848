/*
 * The materials of the scene as polar diagrams: light of some angle, and where it goes.
 */
#pragma once

#include "session/held.h"

#include <gtk/gtk.h>

typedef struct lobe_view lobe_view;

lobe_view *lobe_view_new(void);
/** @brief When the widget has gone. */
void lobe_view_free(lobe_view *v);
GtkWidget *lobe_view_widget(lobe_view *v);
void lobe_view_set_scene(lobe_view *v, held_scene *scene);
/** @brief Chooses a material; false: there is none of that name. */
bool lobe_view_choose(lobe_view *v, const char *material);
/** @brief Chooses a material by its number in the scene. */
void lobe_view_choose_number(lobe_view *v, unsigned i);
/** @brief The diagram on show as SVG; NULL: there is none. Owned by the caller. */
char *lobe_view_svg(const lobe_view *v);
