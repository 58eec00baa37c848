#include "picture/canvas.h"

#include "widgets/widgets.h"

#include <math.h>

/* Beyond this zoom pixels are seen as squares. */
#define SQUARES 2.0
#define MOST_ZOOM 64.0
/* So near to the divider it is meant, pixels. */
#define GRIP 6.0

/* One side of the divider. */
typedef struct side {
    canvas *owner;
    held_picture *picture;
    display_options options;
    cairo_surface_t *surface; /* as last converted */
    GCancellable *under_way;  /* NULL: nothing */
    bool again;               /* something has changed meanwhile */
} side;

struct canvas {
    GtkWidget *area;
    side main, other;
    bool split;
    double divider;
    double zoom;                    /* 0: fitted */
    double offset[2], drag_from[2]; /* of the picture's middle from the window's */
    double pointer[2];
    bool inside;   /* the pointer is over the widget */
    bool gripping; /* the pointer is over the divider */
    bool dividing; /* the drag under way holds the divider */
    canvas_hover hover;
    canvas_divided divided;
    void *data;
};

/* ---- Conversion ---- */

typedef struct conversion {
    held_picture *picture;
    display_options options;
} conversion;

static void free_conversion(void *data)
{
    conversion *job = data;
    held_picture_unref(job->picture);
    g_free(job);
}

static void convert(GTask *task, void *source, void *data, GCancellable *cancellable)
{
    (void)source, (void)cancellable;
    const conversion *job = data;
    cairo_surface_t *surface = display_surface(job->picture->image, &job->options);
    g_task_return_pointer(task, surface, (GDestroyNotify)cairo_surface_destroy);
}

static void begin_conversion(side *s);

static void converted(GObject *source, GAsyncResult *result, void *data)
{
    (void)source;
    if (g_cancellable_is_cancelled(g_task_get_cancellable(G_TASK(result))))
        return; /* the canvas is gone */
    side *s = data;
    cairo_surface_t *surface = g_task_propagate_pointer(G_TASK(result), NULL);
    if (surface) {
        g_clear_pointer(&s->surface, cairo_surface_destroy);
        s->surface = surface;
        gtk_widget_queue_draw(s->owner->area);
    }
    g_clear_object(&s->under_way);
    if (s->again)
        begin_conversion(s);
}

static void begin_conversion(side *s)
{
    if (!s->picture)
        return;
    s->again = s->under_way != NULL;
    if (s->under_way)
        return;
    conversion *job = g_new(conversion, 1);
    *job = (conversion){held_picture_ref(s->picture), s->options};
    s->under_way = g_cancellable_new();
    g_autoptr(GTask) task = g_task_new(NULL, s->under_way, converted, s);
    g_task_set_task_data(task, job, free_conversion);
    g_task_set_check_cancellable(task, FALSE);
    g_task_run_in_thread(task, convert);
}

static void clear_side(side *s)
{
    if (s->under_way)
        g_cancellable_cancel(s->under_way);
    g_clear_object(&s->under_way);
    g_clear_pointer(&s->picture, held_picture_unref);
    g_clear_pointer(&s->surface, cairo_surface_destroy);
    s->again = false;
}

static void side_set(side *s, held_picture *picture)
{
    held_picture *held = held_picture_ref(picture);
    held_picture_unref(s->picture);
    s->picture = held;
    begin_conversion(s);
}

/* ---- Places ---- */

static void whole_size(const canvas *c, double size[2])
{
    const held_picture *p = c->main.picture;
    size[0] = p ? MAX(p->width, 1) : 1.0;
    size[1] = p ? MAX(p->height, 1) : 1.0;
}

double canvas_zoom(const canvas *c)
{
    double size[2];
    if (c->zoom > 0.0)
        return c->zoom;
    whole_size(c, size);
    return fmax(fmin(gtk_widget_get_width(c->area) / size[0],
                     gtk_widget_get_height(c->area) / size[1]),
                1e-3);
}

/* The upper left corner of the picture in the widget. */
static void corner(const canvas *c, double zoom, double at[2])
{
    double size[2];
    bool fitted = !(c->zoom > 0.0);
    whole_size(c, size);
    at[0] = 0.5 * (gtk_widget_get_width(c->area) - zoom * size[0]);
    at[1] = 0.5 * (gtk_widget_get_height(c->area) - zoom * size[1]);
    for (int i = 0; i < 2 && !fitted; i++)
        at[i] += c->offset[i];
}

void canvas_to_picture(const canvas *c, double wx, double wy, double *x, double *y)
{
    double at[2], size[2], zoom = canvas_zoom(c);
    corner(c, zoom, at);
    whole_size(c, size);
    *x = (wx - at[0]) / (zoom * size[0]);
    *y = (wy - at[1]) / (zoom * size[1]);
}

/* Zooms so that the place of the picture under (wx, wy) stays there. */
static void zoom_at(canvas *c, double zoom, double wx, double wy)
{
    double x, y, size[2], at[2];
    canvas_to_picture(c, wx, wy, &x, &y);
    whole_size(c, size);
    c->zoom = fmin(fmax(zoom, 0.05), MOST_ZOOM);
    c->offset[0] = c->offset[1] = 0.0;
    corner(c, c->zoom, at);
    c->offset[0] = wx - at[0] - x * size[0] * c->zoom;
    c->offset[1] = wy - at[1] - y * size[1] * c->zoom;
    gtk_widget_queue_draw(c->area);
}

void canvas_zoom_by(canvas *c, double factor)
{
    zoom_at(c, factor * canvas_zoom(c), 0.5 * gtk_widget_get_width(c->area),
            0.5 * gtk_widget_get_height(c->area));
}

void canvas_set_zoom(canvas *c, double zoom)
{
    c->zoom = zoom;
    c->offset[0] = c->offset[1] = 0.0;
    gtk_widget_queue_draw(c->area);
}

/* ---- Drawing ---- */

static void draw_side(const canvas *c, const side *s, cairo_t *cr, double zoom)
{
    double size[2];
    if (!s->surface)
        return;
    whole_size(c, size);
    double sx = zoom * size[0] / cairo_image_surface_get_width(s->surface);
    double sy = zoom * size[1] / cairo_image_surface_get_height(s->surface);
    bool coarse = s->picture && s->picture->coarse;
    cairo_save(cr);
    cairo_scale(cr, sx, sy);
    cairo_set_source_surface(cr, s->surface, 0, 0);
    cairo_pattern_set_filter(cairo_get_source(cr), zoom >= SQUARES && !coarse
                                                       ? CAIRO_FILTER_NEAREST
                                                       : CAIRO_FILTER_BILINEAR);
    cairo_pattern_set_extend(cairo_get_source(cr), CAIRO_EXTEND_PAD);
    cairo_rectangle(cr, 0, 0, size[0] * zoom / sx, size[1] * zoom / sy);
    cairo_fill(cr);
    cairo_restore(cr);
}

static void draw_divider(const canvas *c, cairo_t *cr, double zoom)
{
    double size[2];
    whole_size(c, size);
    double x = rint(c->divider * size[0] * zoom) + 0.5, height = size[1] * zoom;
    cairo_save(cr);
    cairo_rectangle(cr, x, 0, size[0] * zoom - x, height);
    cairo_clip(cr);
    draw_side(c, &c->other, cr, zoom);
    cairo_restore(cr);
    cairo_set_line_width(cr, 3.0);
    cairo_set_source_rgba(cr, 0, 0, 0, 0.5);
    cairo_move_to(cr, x, 0);
    cairo_line_to(cr, x, height);
    cairo_stroke_preserve(cr);
    cairo_set_line_width(cr, 1.0);
    cairo_set_source_rgb(cr, 1, 1, 1);
    cairo_stroke(cr);
}

static void draw(GtkDrawingArea *area, cairo_t *cr, int width, int height, void *data)
{
    (void)area, (void)width, (void)height;
    const canvas *c = data;
    double at[2], zoom = canvas_zoom(c);
    if (!c->main.surface)
        return;
    corner(c, zoom, at);
    cairo_translate(cr, rint(at[0]), rint(at[1]));
    draw_side(c, &c->main, cr, zoom);
    if (c->split)
        draw_divider(c, cr, zoom);
}

/* ---- Hands ---- */

static bool on_divider(const canvas *c, double wx)
{
    double at[2], size[2], zoom = canvas_zoom(c);
    corner(c, zoom, at);
    whole_size(c, size);
    return c->split && fabs(at[0] + c->divider * size[0] * zoom - wx) <= GRIP;
}

static void show_grip(canvas *c, double wx)
{
    bool grips = on_divider(c, wx);
    if (grips != c->gripping)
        gtk_widget_set_cursor_from_name(c->area, grips ? "col-resize" : NULL);
    c->gripping = grips;
}

static void tell_hover(canvas *c)
{
    double x, y;
    bool inside = c->inside;
    const held_picture *p = c->main.picture;
    if (!p)
        return;
    int width, height, n;
    neph_image_size(p->image, &width, &height, &n);
    canvas_to_picture(c, c->pointer[0], c->pointer[1], &x, &y);
    inside = inside && x >= 0.0 && x < 1.0 && y >= 0.0 && y < 1.0;
    c->hover(inside, (int)(x * width), (int)(y * height), c->data);
}

static void pointer_moved(GtkEventController *motion, double x, double y, canvas *c)
{
    (void)motion;
    c->pointer[0] = x;
    c->pointer[1] = y;
    c->inside = true;
    show_grip(c, x);
    tell_hover(c);
}

static void pointer_left(canvas *c)
{
    c->inside = false;
    tell_hover(c);
}

static bool has_control(GtkEventController *controller)
{
    return gtk_event_controller_get_current_event_state(controller) & GDK_CONTROL_MASK;
}

static gboolean scrolled(GtkEventController *wheel, double dx, double dy, canvas *c)
{
    (void)dx;
    if (!has_control(wheel))
        return FALSE;
    zoom_at(c, canvas_zoom(c) * pow(1.2, -dy), c->pointer[0], c->pointer[1]);
    return TRUE;
}

static void drag_begin(GtkGestureDrag *drag, double x, double y, canvas *c)
{
    (void)y;
    c->dividing = on_divider(c, x);
    if (c->dividing)
        gtk_gesture_set_state(GTK_GESTURE(drag), GTK_EVENT_SEQUENCE_CLAIMED);
    c->drag_from[0] = c->offset[0];
    c->drag_from[1] = c->offset[1];
}

static void drag_update(GtkGestureDrag *drag, double x, double y, canvas *c)
{
    if (c->dividing) {
        double start_x = 0.0, start_y = 0.0, at[2];
        gtk_gesture_drag_get_start_point(drag, &start_x, &start_y);
        canvas_to_picture(c, start_x + x, start_y + y, &at[0], &at[1]);
        c->divided(fmin(fmax(at[0], 0.0), 1.0), c->data);
        return;
    }
    if (!has_control(GTK_EVENT_CONTROLLER(drag)))
        return;
    c->zoom = canvas_zoom(c);
    c->offset[0] = c->drag_from[0] + x;
    c->offset[1] = c->drag_from[1] + y;
    gtk_widget_queue_draw(c->area);
}

static void listen(canvas *c)
{
    GtkEventController *motion = gtk_event_controller_motion_new();
    g_signal_connect(motion, "motion", G_CALLBACK(pointer_moved), c);
    g_signal_connect_swapped(motion, "leave", G_CALLBACK(pointer_left), c);
    gtk_widget_add_controller(c->area, motion);
    GtkEventController *wheel =
        gtk_event_controller_scroll_new(GTK_EVENT_CONTROLLER_SCROLL_VERTICAL);
    g_signal_connect(wheel, "scroll", G_CALLBACK(scrolled), c);
    gtk_widget_add_controller(c->area, wheel);
    GtkGesture *drag = gtk_gesture_drag_new();
    gtk_event_controller_set_propagation_phase(GTK_EVENT_CONTROLLER(drag),
                                               GTK_PHASE_CAPTURE);
    g_signal_connect(drag, "drag-begin", G_CALLBACK(drag_begin), c);
    g_signal_connect(drag, "drag-update", G_CALLBACK(drag_update), c);
    gtk_widget_add_controller(c->area, GTK_EVENT_CONTROLLER(drag));
}

/* ---- The canvas ---- */

canvas *canvas_new(canvas_hover hover, canvas_divided divided, void *data)
{
    canvas *c = g_new0(canvas, 1);
    *c = (canvas){.hover = hover, .divided = divided, .data = data, .divider = 0.5};
    c->main = (side){.owner = c, .options = display_defaults()};
    c->other = c->main;
    c->area = drawing_make("Rendered picture", draw, c);
    gtk_widget_set_hexpand(c->area, TRUE);
    gtk_widget_set_vexpand(c->area, TRUE);
    gtk_widget_add_css_class(c->area, "canvas");
    listen(c);
    return c;
}

void canvas_free(canvas *c)
{
    if (!c)
        return;
    clear_side(&c->main);
    clear_side(&c->other);
    g_free(c);
}

GtkWidget *canvas_widget(canvas *c)
{
    return c->area;
}

void canvas_set_picture(canvas *c, held_picture *picture)
{
    if (!picture) {
        clear_side(&c->main);
        gtk_widget_queue_draw(c->area);
        return;
    }
    side_set(&c->main, picture);
    tell_hover(c);
}

held_picture *canvas_picture(const canvas *c)
{
    return c->main.picture;
}

void canvas_set_options(canvas *c, const display_options *options)
{
    c->main.options = *options;
    begin_conversion(&c->main);
}

const display_options *canvas_options(const canvas *c)
{
    return &c->main.options;
}

void canvas_set_other(canvas *c, held_picture *other, const display_options *options)
{
    c->split = other != NULL;
    if (other) {
        c->other.options = *options;
        side_set(&c->other, other);
    } else {
        clear_side(&c->other);
    }
    gtk_widget_queue_draw(c->area);
}

void canvas_set_divider(canvas *c, double at)
{
    c->divider = at;
    gtk_widget_queue_draw(c->area);
}

bool canvas_is_split(const canvas *c)
{
    return c->split;
}

double canvas_divider(const canvas *c)
{
    return c->divider;
}
