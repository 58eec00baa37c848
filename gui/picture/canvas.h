/*
 * The picture on the screen: fitted or magnified to single pixels, alone or split against
 * a second one. Conversion to the screen's colours happens on a thread, the latest wins.
 */
#pragma once

#include "picture/display.h"
#include "session/held.h"

#include <gtk/gtk.h>

typedef struct canvas canvas;

/** @brief A place of the picture under the pointer, pixels of the image; inside false: it
 * has left. */
typedef void (*canvas_hover)(bool inside, int x, int y, void *data);
/** @brief The divider is being dragged to a place of the picture, 0..1. */
typedef void (*canvas_divided)(double at, void *data);

canvas *canvas_new(canvas_hover hover, canvas_divided divided, void *data);
/** @brief When the widget has gone. */
void canvas_free(canvas *c);
GtkWidget *canvas_widget(canvas *c);

/** @brief Shows a picture (held); NULL: none. */
void canvas_set_picture(canvas *c, held_picture *picture);
/** @brief What is on show. Borrowed, NULL: none. */
held_picture *canvas_picture(const canvas *c);
void canvas_set_options(canvas *c, const display_options *options);
const display_options *canvas_options(const canvas *c);

/** @brief Right of the divider another picture is shown (held): a reference, or the same
 * one with another layer. NULL ends the split. */
void canvas_set_other(canvas *c, held_picture *other, const display_options *options);
bool canvas_is_split(const canvas *c);
/** @brief Where the divider stands, 0..1 of the picture's width. */
void canvas_set_divider(canvas *c, double at);
double canvas_divider(const canvas *c);

/** @brief Screen pixels for one of the picture; 0: fitted to the window. */
void canvas_set_zoom(canvas *c, double zoom);
double canvas_zoom(const canvas *c); /**< the one in effect */
/** @brief Multiplies the zoom, the middle of the window stays. */
void canvas_zoom_by(canvas *c, double factor);

/** @brief Place in the widget to place in the picture, 0..1 each, y down. */
void canvas_to_picture(const canvas *c, double wx, double wy, double *x, double *y);
