#include "picture/histogram.h"

#include "picture/display.h"
#include "widgets/widgets.h"

#include <math.h>

enum { BINS = 96, HEIGHT = 90 };

/* Stops shown, around white at 0. */
#define LOW (-12.0f)
#define HIGH 6.0f

struct histogram {
    GtkWidget *area;
    size_t counts[3][256], largest;
    float exposure;
};

static void draw_channel(const histogram *h, cairo_t *cr, int k, double width,
                         double height)
{
    static const double colors[3][3] = {
        {0.88, 0.25, 0.22}, {0.2, 0.7, 0.3}, {0.25, 0.48, 0.95}};
    double top = sqrt((double)MAX(h->largest, 1));
    cairo_move_to(cr, 0, height);
    for (int i = 0; i < BINS; i++)
        cairo_line_to(cr, (i + 0.5) * width / BINS,
                      height * (1.0 - 0.95 * sqrt((double)h->counts[k][i]) / top));
    cairo_line_to(cr, width, height);
    cairo_close_path(cr);
    cairo_set_source_rgba(cr, colors[k][0], colors[k][1], colors[k][2], 0.28);
    cairo_fill_preserve(cr);
    cairo_set_source_rgba(cr, colors[k][0], colors[k][1], colors[k][2], 0.9);
    cairo_set_line_width(cr, 1.2);
    cairo_stroke(cr);
}

static void draw(GtkDrawingArea *area, cairo_t *cr, int width, int height, void *data)
{
    const histogram *h = data;
    GdkRGBA color;
    gtk_style_context_get_color(gtk_widget_get_style_context(GTK_WIDGET(area)), &color);
    for (int k = 0; k < 3; k++)
        draw_channel(h, cr, k, width, height);
    double white = (double)((-h->exposure - LOW) / (HIGH - LOW)) * width;
    color.alpha = 0.6f;
    gdk_cairo_set_source_rgba(cr, &color);
    cairo_set_line_width(cr, 1.0);
    cairo_move_to(cr, white, 0);
    cairo_line_to(cr, white, height);
    cairo_move_to(cr, 0, height - 0.5);
    cairo_line_to(cr, width, height - 0.5);
    cairo_stroke(cr);
    cairo_move_to(cr, white + 4, 12);
    cairo_set_font_size(cr, 11);
    cairo_show_text(cr, "white");
}

histogram *histogram_new(void)
{
    histogram *h = g_new0(histogram, 1);
    h->area = drawing_make("Histogram of red, green and blue over stops", draw, h);
    gtk_drawing_area_set_content_height(GTK_DRAWING_AREA(h->area), HEIGHT);
    return h;
}

void histogram_free(histogram *h)
{
    g_free(h);
}

GtkWidget *histogram_widget(histogram *h)
{
    return h->area;
}

void histogram_show(histogram *h, const NephImage *image, const char *layer,
                    float exposure)
{
    h->largest = display_histogram(image, layer, LOW, HIGH, BINS, h->counts);
    h->exposure = exposure;
    gtk_widget_queue_draw(h->area);
}
