/*
 * How often which brightness occurs, for red, green and blue, over stops.
 */
#pragma once

#include <gtk/gtk.h>
#include <nephroid/nephroid.h>

typedef struct histogram histogram;

histogram *histogram_new(void);
/** @brief When the widget has gone. */
void histogram_free(histogram *h);
GtkWidget *histogram_widget(histogram *h);
/** @brief exposure: stops, shifts the line of white. */
void histogram_show(histogram *h, const NephImage *image, const char *layer,
                    float exposure);
