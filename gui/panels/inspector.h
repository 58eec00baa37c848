/*
 * The page that inspects the picture: layers, exposure, curves, values under the pointer,
 * histogram, and a second picture to compare with.
 */
#pragma once

#include "picture/canvas.h"

typedef struct inspector inspector;

/** @brief Tells its window that a reference picture is wanted. */
typedef void (*inspector_wants_reference)(void *data);

/** @brief Works on the canvas, which is borrowed. */
inspector *inspector_new(canvas *shown, inspector_wants_reference wants, void *data);
/** @brief When the widget has gone. */
void inspector_free(inspector *n);
GtkWidget *inspector_widget(inspector *n);
/** @brief The canvas shows a newer picture. */
void inspector_picture_changed(inspector *n);
/** @brief The pointer is over a pixel of it. */
void inspector_hover(inspector *n, bool inside, int x, int y);
/** @brief Compares with a picture (held) that was read from a file; NULL: none could be,
 * and where one is compared with already it stays. */
void inspector_set_reference(inspector *n, held_picture *picture, const char *path);
/** @brief Exposure in stops, as if the slider had been moved. */
void inspector_set_exposure(inspector *n, double stops);
double inspector_exposure(const inspector *n);
/** @brief Where the picture is split, 0..1, as if the slider had been moved. */
void inspector_set_divider(inspector *n, double at);
/** @brief Shows a layer: "" for the picture. false: there is no such layer. */
bool inspector_show_layer(inspector *n, const char *layer);

/** @brief The values of a pixel for people, one a line: layer's numbers, and for colours
 * XYZ and luminance. Owned by the caller. */
char *inspector_pixel_text(const NephImage *image, const char *layer, int x, int y);
/** @brief The same in one short line. */
char *inspector_pixel_line(const NephImage *image, const char *layer, int x, int y);
