/*
 * Hands on a view: drags, wheel and keys over a widget move a viewpoint.
 *
 *   drag             around the pivot        shift or middle drag   across
 *   right drag       looks around            wheel                  nearer, further
 *   W A S D, E Q     flies                   double click           pivot there
 */
#pragma once

#include "picture/viewpoint.h"

#include <gtk/gtk.h>

typedef struct navigation navigation;

typedef struct navigation_events {
    /** The view has changed; moving: more is to come soon. */
    void (*moved)(const NephCamera *camera, bool moving, void *data);
    /** A click at a place of the widget, n times in a row. */
    void (*clicked)(double x, double y, int n, void *data);
    void *data;
} navigation_events;

/** @brief Listens to the widget, which must be focusable, and moves *view, which must
 * outlive it. */
navigation *navigation_new(GtkWidget *widget, viewpoint *view,
                           const navigation_events *events);
/** @brief When the widget has gone. */
void navigation_free(navigation *n);
/** @brief As if by wheel: steps > 0 go nearer. */
void navigation_dolly(navigation *n, double steps);
