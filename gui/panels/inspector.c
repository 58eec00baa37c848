#include "panels/inspector.h"

#include "picture/histogram.h"
#include "widgets/widgets.h"

#include <math.h>
#include <string.h>

/* What the right side of the divider shows. */
enum { COMPARE_NONE, COMPARE_LAYER, COMPARE_REFERENCE };

static const char *const compare_words[] = {"Nothing", "A layer", "A reference", NULL};

struct inspector {
    canvas *canvas;
    GtkWidget *root, *content;
    GtkWidget *layer, *exposure, *curve, *gamma, *false_colour, *mark_bad;
    GtkWidget *pixel, *bad;
    GtkWidget *compare, *other_layer, *divider, *reference_name, *errors[4];
    GtkWidget *problem; /* why there is no error to show */
    histogram *histogram;
    char **layers;
    held_picture *reference;
    GCancellable *comparing; /* NULL: nothing under way */
    bool showing, inside;
    int x, y; /* under the pointer */
    inspector_wants_reference wants;
    void *data;
};

/* ---- Values ---- */

static const float *pixel_at(const NephImage *image, int x, int y)
{
    int width, height, n;
    neph_image_size(image, &width, &height, &n);
    if (x < 0 || y < 0 || x >= width || y >= height)
        return NULL;
    return neph_image_pixels(image) + ((size_t)y * (size_t)width + (size_t)x) * (size_t)n;
}

/* Linear sRGB to XYZ (IEC 61966-2-1). */
static void to_xyz(const float rgb[3], double xyz[3])
{
    static const double m[3][3] = {
        {0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};
    for (int i = 0; i < 3; i++)
        xyz[i] = m[i][0] * (double)rgb[0] + m[i][1] * (double)rgb[1] +
                 m[i][2] * (double)rgb[2];
}

char *inspector_pixel_text(const NephImage *image, const char *layer, int x, int y)
{
    int channel[3];
    double xyz[3];
    const float *pixel = pixel_at(image, x, y);
    if (!pixel || !display_channels(image, layer, channel))
        return NULL;
    const float v[3] = {pixel[channel[0]], pixel[channel[1]], pixel[channel[2]]};
    if (channel[0] == channel[1])
        return g_strdup_printf("pixel      %d, %d\n%-10s %.6g", x, y, layer,
                               (double)v[0]);
    if (strcmp(layer, "normal") == 0)
        return g_strdup_printf("pixel      %d, %d\nx y z      %-8.4f %-8.4f %-8.4f", x, y,
                               (double)v[0], (double)v[1], (double)v[2]);
    to_xyz(v, xyz);
    return g_strdup_printf("pixel      %d, %d\nR G B      %-9.4g %-9.4g %-9.4g\n"
                           "X Y Z      %-9.4g %-9.4g %-9.4g\nluminance  %.6g",
                           x, y, (double)v[0], (double)v[1], (double)v[2], xyz[0], xyz[1],
                           xyz[2], xyz[1]);
}

char *inspector_pixel_line(const NephImage *image, const char *layer, int x, int y)
{
    int channel[3];
    const float *pixel = pixel_at(image, x, y);
    if (!pixel || !display_channels(image, layer, channel))
        return NULL;
    if (channel[0] == channel[1])
        return g_strdup_printf("(%d, %d)  %.5g", x, y, (double)pixel[channel[0]]);
    return g_strdup_printf("(%d, %d)  %.4g  %.4g  %.4g", x, y, (double)pixel[channel[0]],
                           (double)pixel[channel[1]], (double)pixel[channel[2]]);
}

static void show_pixel(inspector *n)
{
    const held_picture *picture = canvas_picture(n->canvas);
    g_autofree char *text = NULL;
    if (n->inside && picture)
        text = inspector_pixel_text(picture->image, canvas_options(n->canvas)->layer,
                                    n->x, n->y);
    gtk_label_set_text(GTK_LABEL(n->pixel), text ? text : "Point at the picture.\n\n\n");
}

void inspector_hover(inspector *n, bool inside, int x, int y)
{
    n->inside = inside;
    n->x = x;
    n->y = y;
    show_pixel(n);
}

static size_t count_bad(const NephImage *image)
{
    int width, height, n;
    size_t bad = 0;
    neph_image_size(image, &width, &height, &n);
    const float *pixel = neph_image_pixels(image);
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++, pixel += n)
        bad += !isfinite(pixel[0] + pixel[1] + pixel[2]);
    return bad;
}

/* ---- How it is shown ---- */

static const char *chosen_layer(const inspector *n, GtkWidget *choice)
{
    guint i = gtk_drop_down_get_selected(GTK_DROP_DOWN(choice));
    return n->layers && i < g_strv_length(n->layers) ? n->layers[i] : "";
}

static display_options options_of(const inspector *n, GtkWidget *layer)
{
    display_options o = {
        .exposure = (float)gtk_range_get_value(GTK_RANGE(n->exposure)),
        .curve = (tone_curve)gtk_drop_down_get_selected(GTK_DROP_DOWN(n->curve)),
        .gamma = (float)gtk_range_get_value(GTK_RANGE(n->gamma)),
        .false_colour = gtk_switch_get_active(GTK_SWITCH(n->false_colour)),
        .mark_bad = gtk_switch_get_active(GTK_SWITCH(n->mark_bad))};
    g_strlcpy(o.layer, chosen_layer(n, layer), sizeof o.layer);
    return o;
}

static void show_other(inspector *n)
{
    guint what = gtk_drop_down_get_selected(GTK_DROP_DOWN(n->compare));
    display_options o = options_of(n, n->other_layer);
    gtk_widget_set_sensitive(gtk_widget_get_parent(n->other_layer),
                             what == COMPARE_LAYER);
    if (what == COMPARE_REFERENCE)
        o.layer[0] = '\0';
    held_picture *other = what == COMPARE_LAYER       ? canvas_picture(n->canvas)
                          : what == COMPARE_REFERENCE ? n->reference
                                                      : NULL;
    canvas_set_other(n->canvas, other, &o);
}

static void show_histogram(inspector *n)
{
    const held_picture *picture = canvas_picture(n->canvas);
    if (picture && gtk_widget_get_mapped(n->root))
        histogram_show(n->histogram, picture->image, canvas_options(n->canvas)->layer,
                       canvas_options(n->canvas)->exposure);
}

static void on_options(inspector *n)
{
    if (n->showing)
        return;
    display_options o = options_of(n, n->layer);
    canvas_set_options(n->canvas, &o);
    gtk_widget_set_sensitive(gtk_widget_get_parent(n->gamma), o.curve == TONE_GAMMA);
    show_other(n);
    show_histogram(n);
    show_pixel(n);
}

void inspector_set_exposure(inspector *n, double stops)
{
    gtk_range_set_value(GTK_RANGE(n->exposure), stops);
}

double inspector_exposure(const inspector *n)
{
    return gtk_range_get_value(GTK_RANGE(n->exposure));
}

bool inspector_show_layer(inspector *n, const char *layer)
{
    for (guint i = 0; n->layers && n->layers[i]; i++)
        if (strcmp(n->layers[i], layer) == 0) {
            gtk_drop_down_set_selected(GTK_DROP_DOWN(n->layer), i);
            return true;
        }
    return false;
}

/* ---- Comparing ---- */

typedef struct comparison {
    held_picture *picture, *reference;
    NephImageDifference result;
} comparison;

static void free_comparison(void *data)
{
    comparison *c = data;
    held_picture_unref(c->picture);
    held_picture_unref(c->reference);
    g_free(c);
}

static void compare(GTask *task, void *source, void *data, GCancellable *cancellable)
{
    (void)source, (void)cancellable;
    comparison *c = data;
    GError *error = NULL;
    if (neph_image_compare(c->picture->image, c->reference->image, &c->result, &error))
        g_task_return_boolean(task, TRUE);
    else
        g_task_return_error(task, error);
}

static void compared(GObject *source, GAsyncResult *result, void *data)
{
    (void)source;
    if (g_cancellable_is_cancelled(g_task_get_cancellable(G_TASK(result))))
        return;
    inspector *n = data;
    g_autoptr(GError) error = NULL;
    const comparison *c = g_task_get_task_data(G_TASK(result));
    const double values[] = {c->result.rmse, c->result.relmse, c->result.psnr,
                             c->result.flip};
    bool ok = g_task_propagate_boolean(G_TASK(result), &error);
    g_clear_object(&n->comparing);
    for (size_t i = 0; i < G_N_ELEMENTS(values); i++) {
        g_autofree char *text = ok ? g_strdup_printf("%.5g", values[i]) : g_strdup("–");
        gtk_label_set_text(GTK_LABEL(n->errors[i]), text);
    }
    gtk_label_set_text(GTK_LABEL(n->problem), ok ? "" : error->message);
    gtk_widget_set_visible(n->problem, !ok);
}

static void begin_comparison(inspector *n)
{
    held_picture *picture = canvas_picture(n->canvas);
    if (!n->reference || !picture || picture->coarse || n->comparing)
        return;
    comparison *c = g_new0(comparison, 1);
    c->picture = held_picture_ref(picture);
    c->reference = held_picture_ref(n->reference);
    n->comparing = g_cancellable_new();
    g_autoptr(GTask) task = g_task_new(NULL, n->comparing, compared, n);
    g_task_set_task_data(task, c, free_comparison);
    g_task_set_check_cancellable(task, FALSE);
    g_task_run_in_thread(task, compare);
}

void inspector_set_reference(inspector *n, held_picture *picture, const char *path)
{
    if (!picture) {
        if (!n->reference)
            gtk_drop_down_set_selected(GTK_DROP_DOWN(n->compare), COMPARE_NONE);
        return;
    }
    held_picture *held = held_picture_ref(picture);
    held_picture_unref(n->reference);
    n->reference = held;
    g_autofree char *base = g_path_get_basename(path);
    g_autofree char *name = g_utf8_make_valid(base, -1);
    gtk_label_set_text(GTK_LABEL(n->reference_name), name);
    gtk_drop_down_set_selected(GTK_DROP_DOWN(n->compare), COMPARE_REFERENCE);
    show_other(n);
    begin_comparison(n);
}

static void on_compare(inspector *n)
{
    guint what = gtk_drop_down_get_selected(GTK_DROP_DOWN(n->compare));
    if (what == COMPARE_REFERENCE && !n->reference)
        n->wants(n->data);
    show_other(n);
}

static void on_reference_button(inspector *n)
{
    n->wants(n->data);
}

void inspector_set_divider(inspector *n, double at)
{
    gtk_range_set_value(GTK_RANGE(n->divider), at);
}

static void on_divider(inspector *n)
{
    canvas_set_divider(n->canvas, gtk_range_get_value(GTK_RANGE(n->divider)));
}

/* ---- A newer picture ---- */

static void fill_layers(GtkWidget *choice, char **layers)
{
    GtkStringList *words = gtk_string_list_new(NULL);
    for (size_t i = 0; layers[i]; i++) {
        g_autofree char *title = g_strdup(*layers[i] ? layers[i] : "picture");
        title[0] = g_ascii_toupper(title[0]);
        gtk_string_list_append(words, title);
    }
    guint chosen = gtk_drop_down_get_selected(GTK_DROP_DOWN(choice));
    gtk_drop_down_set_model(GTK_DROP_DOWN(choice), G_LIST_MODEL(words));
    if (chosen < g_strv_length(layers))
        gtk_drop_down_set_selected(GTK_DROP_DOWN(choice), chosen);
    g_object_unref(words);
}

static void take_layers(inspector *n, const NephImage *image)
{
    char **layers = display_layers(image);
    if (n->layers &&
        g_strv_equal((const char *const *)layers, (const char *const *)n->layers)) {
        g_strfreev(layers);
        return;
    }
    n->showing = true;
    fill_layers(n->layer, layers);
    fill_layers(n->other_layer, layers);
    n->showing = false;
    g_strfreev(n->layers);
    n->layers = layers;
}

void inspector_picture_changed(inspector *n)
{
    const held_picture *picture = canvas_picture(n->canvas);
    if (!picture)
        return;
    if (!picture->coarse)
        take_layers(n, picture->image);
    g_autofree char *bad = g_strdup_printf("%zu", count_bad(picture->image));
    gtk_label_set_text(GTK_LABEL(n->bad), bad);
    show_other(n);
    show_histogram(n);
    show_pixel(n);
    begin_comparison(n);
}

/* ---- Building ---- */

static void listen(inspector *n, GtkWidget *widget, const char *signal,
                   GCallback callback)
{
    g_signal_connect_swapped(widget, signal, callback, n);
}

static void add_display(inspector *n)
{
    GtkWidget *list, *group = group_make("Show", &list);
    static const char *const first[] = {"Picture", NULL};
    n->layer = choice_make(first);
    n->exposure = slider_make(-20.0, 20.0, 0.25, 2);
    n->curve = choice_make(tone_curve_names);
    n->gamma = slider_make(1.0, 4.0, 0.05, 2);
    n->false_colour = gtk_switch_new();
    n->mark_bad = gtk_switch_new();
    gtk_range_set_value(GTK_RANGE(n->exposure), 0.0);
    gtk_range_set_value(GTK_RANGE(n->gamma), 2.2);
    gtk_scale_set_has_origin(GTK_SCALE(n->exposure), FALSE);
    gtk_switch_set_active(GTK_SWITCH(n->mark_bad), TRUE);
    row_add(list, "Layer", n->layer);
    row_add(list, "Exposure (stops)", n->exposure);
    row_add(list, "Tone curve", n->curve);
    row_add(list, "Gamma", n->gamma);
    row_add(list, "False colour", n->false_colour);
    row_add_captioned(list, "Mark NaN and infinite", "magenta and yellow", n->mark_bad);
    gtk_widget_set_sensitive(gtk_widget_get_parent(n->gamma), FALSE);
    listen(n, n->layer, "notify::selected", G_CALLBACK(on_options));
    listen(n, n->exposure, "value-changed", G_CALLBACK(on_options));
    listen(n, n->curve, "notify::selected", G_CALLBACK(on_options));
    listen(n, n->gamma, "value-changed", G_CALLBACK(on_options));
    listen(n, n->false_colour, "notify::active", G_CALLBACK(on_options));
    listen(n, n->mark_bad, "notify::active", G_CALLBACK(on_options));
    gtk_box_append(GTK_BOX(n->content), group);
}

static void add_values(inspector *n)
{
    GtkWidget *list, *group = group_make("Under the pointer", &list);
    n->pixel = label_make("Point at the picture.\n\n\n", "source");
    GtkWidget *row = gtk_list_box_row_new();
    gtk_list_box_row_set_activatable(GTK_LIST_BOX_ROW(row), FALSE);
    gtk_list_box_row_set_child(GTK_LIST_BOX_ROW(row), n->pixel);
    gtk_list_box_append(GTK_LIST_BOX(list), row);
    n->bad = value_row_add(list, "Pixels not finite");
    gtk_box_append(GTK_BOX(n->content), group);
    n->histogram = histogram_new();
    gtk_box_append(GTK_BOX(group), histogram_widget(n->histogram));
}

static void add_compare(inspector *n)
{
    static const char *const names[] = {"RMSE", "Relative MSE", "PSNR (dB)", "FLIP"};
    static const char *const first[] = {"Picture", NULL};
    GtkWidget *list, *group = group_make("Compare with", &list);
    n->compare = choice_make(compare_words);
    n->other_layer = choice_make(first);
    n->divider = slider_make(0.0, 1.0, 0.01, 2);
    gtk_range_set_value(GTK_RANGE(n->divider), 0.5);
    row_add(list, "On the right", n->compare);
    row_add(list, "Layer there", n->other_layer);
    row_add(list, "Divider", n->divider);
    n->reference_name = value_row_add(list, "Reference");
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++)
        n->errors[i] = value_row_add(list, names[i]);
    n->problem = text_make("", "error");
    gtk_widget_set_visible(n->problem, FALSE);
    gtk_box_append(GTK_BOX(group), n->problem);
    GtkWidget *button =
        text_button_make("Choose a reference…", "A picture of the same size", NULL);
    listen(n, button, "clicked", G_CALLBACK(on_reference_button));
    listen(n, n->compare, "notify::selected", G_CALLBACK(on_compare));
    listen(n, n->other_layer, "notify::selected", G_CALLBACK(on_options));
    listen(n, n->divider, "value-changed", G_CALLBACK(on_divider));
    gtk_box_append(GTK_BOX(group), button);
    gtk_box_append(GTK_BOX(n->content), group);
}

inspector *inspector_new(canvas *shown, inspector_wants_reference wants, void *data)
{
    inspector *n = g_new0(inspector, 1);
    *n = (inspector){.canvas = shown, .wants = wants, .data = data};
    n->root = page_make(&n->content);
    add_display(n);
    add_values(n);
    add_compare(n);
    listen(n, n->root, "map", G_CALLBACK(show_histogram));
    return n;
}

void inspector_free(inspector *n)
{
    if (!n)
        return;
    if (n->comparing)
        g_cancellable_cancel(n->comparing);
    g_clear_object(&n->comparing);
    histogram_free(n->histogram);
    held_picture_unref(n->reference);
    g_strfreev(n->layers);
    g_free(n);
}

GtkWidget *inspector_widget(inspector *n)
{
    return n->root;
}
