/*
 * Where the photon view draws a point of the scene: the picture's own projection, widened
 * to the shape of the widget, as a matrix and for the pointer. Pure geometry.
 */
#pragma once

#include "picture/viewpoint.h"

/** @brief A camera in a widget of so many pixels, of whichever size: only their ratio
 * counts but in projection_scale. */
typedef struct projection {
    const viewpoint *view; /**< borrowed */
    double width, height;
} projection;

/** @brief World to OpenGL's clip space, column by column. */
void projection_matrix(const projection *p, float out[16]);
/** @brief Place in the widget to place in the picture, which the camera's screen spans:
 * 0..1, y down, beyond it outside of that. */
void projection_place(const projection *p, double wx, double wy, double place[2]);
/** @brief And back. */
void projection_widget(const projection *p, const double place[2], double *wx,
                       double *wy);
/** @brief Pixels of the widget for the picture's height. */
double projection_scale(const projection *p);
