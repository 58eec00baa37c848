#include "picture/navigation.h"

#include <math.h>

/* A drag over the widget's height turns by this, rad. */
#define TURN 3.0
/* A click may move so far, pixels. */
#define CLICK_SLACK 4.0
/* One step of the wheel. */
#define WHEEL 0.9
/* Share of the scene's extent that is flown in a second; with shift, faster. */
#define FLIGHT 0.25
#define FAST 4.0
/* What an arrow key does in a second: turn, rad, or with shift move, picture heights; and
   steps of the wheel for Page Up and Down. */
#define ARROW_TURN 1.0
#define ARROW_PAN 0.5
#define PAGE_STEPS 8.0
/* A frame that came later than this does not leap, s. */
#define LONGEST_STEP 0.2
/* A view that has not moved for so long stands still, ms. */
enum { STILL_MS = 150 };

/* Keys that act as long as they are held. */
enum {
    KEY_FORWARD,
    KEY_BACK,
    KEY_LEFT,
    KEY_RIGHT,
    KEY_RISE,
    KEY_SINK,
    KEY_TURN_LEFT,
    KEY_TURN_RIGHT,
    KEY_TURN_UP,
    KEY_TURN_DOWN,
    KEY_NEARER,
    KEY_FURTHER,
    N_HELD_KEYS
};

struct navigation {
    GtkWidget *widget;
    viewpoint *view;
    navigation_events events;
    GtkGesture *drag;
    GtkEventController *wheel, *keys;
    GtkGesture *click, *pinch;
    double last_x, last_y; /* of the drag under way */
    bool dragged;          /* it has gone further than a click does */
    double last_scale;     /* of the pinch under way */
    bool down[N_HELD_KEYS];
    bool shift;
    guint tick, still;
    gint64 last_tick; /* µs */
};

static gboolean stand_still(void *data)
{
    navigation *n = data;
    n->still = 0;
    n->events.moved(&n->view->camera, false, n->events.data);
    return G_SOURCE_REMOVE;
}

static void moved(navigation *n)
{
    g_clear_handle_id(&n->still, g_source_remove);
    n->still = g_timeout_add(STILL_MS, stand_still, n);
    n->events.moved(&n->view->camera, true, n->events.data);
}

/* ---- Drags ---- */

static void drag_begin(navigation *n)
{
    n->last_x = n->last_y = 0.0;
    n->dragged = false;
    gtk_widget_grab_focus(n->widget);
}

static void drag_update(GtkGestureDrag *drag, double x, double y, navigation *n)
{
    double size = fmax(gtk_widget_get_height(n->widget), 1.0);
    double dx = (x - n->last_x) / size, dy = (y - n->last_y) / size;
    guint button = gtk_gesture_single_get_current_button(GTK_GESTURE_SINGLE(drag));
    GdkModifierType state =
        gtk_event_controller_get_current_event_state(GTK_EVENT_CONTROLLER(drag));
    n->dragged |= hypot(x, y) > CLICK_SLACK;
    if (!n->dragged || (state & GDK_CONTROL_MASK))
        return;
    n->last_x = x;
    n->last_y = y;
    if (button == GDK_BUTTON_SECONDARY)
        viewpoint_look(n->view, TURN * dx, -TURN * dy);
    else if (button == GDK_BUTTON_MIDDLE || (state & GDK_SHIFT_MASK))
        viewpoint_pan(n->view, -dx, dy);
    else
        viewpoint_orbit(n->view, TURN * dx, -TURN * dy);
    moved(n);
}

static void clicked(GtkGestureClick *click, int times, double x, double y, navigation *n)
{
    (void)click;
    gtk_widget_grab_focus(n->widget);
    if (!n->dragged)
        n->events.clicked(x, y, times, n->events.data);
}

void navigation_dolly(navigation *n, double steps)
{
    viewpoint_dolly(n->view, pow(WHEEL, steps));
    moved(n);
}

static gboolean scrolled(GtkEventControllerScroll *wheel, double dx, double dy,
                         navigation *n)
{
    (void)dx;
    GdkModifierType state =
        gtk_event_controller_get_current_event_state(GTK_EVENT_CONTROLLER(wheel));
    if (state & GDK_CONTROL_MASK)
        return FALSE;
    navigation_dolly(n, -dy);
    return TRUE;
}

/* Two fingers apart: nearer. */
static void pinch_begin(navigation *n)
{
    n->last_scale = 1.0;
}

static void pinched(GtkGestureZoom *pinch, double scale, navigation *n)
{
    (void)pinch;
    if (!(scale > 0.0))
        return;
    viewpoint_dolly(n->view, n->last_scale / scale);
    n->last_scale = scale;
    moved(n);
}

/* ---- Keys ---- */

static int held_key(guint key)
{
    static const guint keys[N_HELD_KEYS] = {
        [KEY_FORWARD] = GDK_KEY_w,      [KEY_BACK] = GDK_KEY_s,
        [KEY_LEFT] = GDK_KEY_a,         [KEY_RIGHT] = GDK_KEY_d,
        [KEY_RISE] = GDK_KEY_e,         [KEY_SINK] = GDK_KEY_q,
        [KEY_TURN_LEFT] = GDK_KEY_Left, [KEY_TURN_RIGHT] = GDK_KEY_Right,
        [KEY_TURN_UP] = GDK_KEY_Up,     [KEY_TURN_DOWN] = GDK_KEY_Down,
        [KEY_NEARER] = GDK_KEY_Page_Up, [KEY_FURTHER] = GDK_KEY_Page_Down};
    for (int i = 0; i < N_HELD_KEYS; i++)
        if (gdk_keyval_to_lower(key) == keys[i])
            return i;
    return -1;
}

/* 1, -1 or 0: which of two opposite keys is held. */
static double pull(const navigation *n, int more, int less)
{
    return (double)n->down[more] - (double)n->down[less];
}

static void act(navigation *n, double seconds)
{
    double fly = seconds * FLIGHT * n->view->extent * (n->shift ? FAST : 1.0);
    double right = seconds * pull(n, KEY_TURN_RIGHT, KEY_TURN_LEFT);
    double up = seconds * pull(n, KEY_TURN_UP, KEY_TURN_DOWN);
    viewpoint_fly(n->view, fly * pull(n, KEY_RIGHT, KEY_LEFT),
                  fly * pull(n, KEY_RISE, KEY_SINK),
                  fly * pull(n, KEY_FORWARD, KEY_BACK));
    if (n->shift)
        viewpoint_pan(n->view, ARROW_PAN * right, ARROW_PAN * up);
    else
        viewpoint_orbit(n->view, ARROW_TURN * right, ARROW_TURN * up);
    viewpoint_dolly(n->view,
                    pow(WHEEL, PAGE_STEPS * seconds * pull(n, KEY_NEARER, KEY_FURTHER)));
}

static gboolean tick(GtkWidget *widget, GdkFrameClock *clock, void *data)
{
    (void)widget;
    navigation *n = data;
    gint64 now = gdk_frame_clock_get_frame_time(clock);
    double seconds = n->last_tick ? 1e-6 * (double)(now - n->last_tick) : 0.0;
    bool any = false;
    n->last_tick = now;
    for (int i = 0; i < N_HELD_KEYS; i++)
        any |= n->down[i];
    if (!any) {
        n->tick = 0;
        return G_SOURCE_REMOVE;
    }
    act(n, fmin(seconds, LONGEST_STEP));
    moved(n);
    return G_SOURCE_CONTINUE;
}

/* Enter is a click in the middle. */
static void click_middle(navigation *n)
{
    n->events.clicked(0.5 * gtk_widget_get_width(n->widget),
                      0.5 * gtk_widget_get_height(n->widget), 1, n->events.data);
}

static gboolean key_pressed(GtkEventControllerKey *keys, guint key, guint code,
                            GdkModifierType state, navigation *n)
{
    (void)keys, (void)code;
    int i = held_key(key);
    if (state & (GDK_CONTROL_MASK | GDK_ALT_MASK))
        return FALSE;
    if (key == GDK_KEY_Return || key == GDK_KEY_KP_Enter) {
        click_middle(n);
        return TRUE;
    }
    if (i < 0)
        return FALSE;
    n->down[i] = true;
    n->shift = (state & GDK_SHIFT_MASK) != 0;
    if (!n->tick) {
        n->last_tick = 0;
        n->tick = gtk_widget_add_tick_callback(n->widget, tick, n, NULL);
    }
    return TRUE;
}

static void key_released(GtkEventControllerKey *keys, guint key, guint code,
                         GdkModifierType state, navigation *n)
{
    (void)keys, (void)code, (void)state;
    int i = held_key(key);
    if (i >= 0)
        n->down[i] = false;
}

static void focus_left(navigation *n)
{
    for (int i = 0; i < N_HELD_KEYS; i++)
        n->down[i] = false;
}

/* ---- Building ---- */

static void listen(navigation *n)
{
    n->drag = gtk_gesture_drag_new();
    gtk_gesture_single_set_button(GTK_GESTURE_SINGLE(n->drag), 0);
    g_signal_connect_swapped(n->drag, "drag-begin", G_CALLBACK(drag_begin), n);
    g_signal_connect(n->drag, "drag-update", G_CALLBACK(drag_update), n);
    gtk_widget_add_controller(n->widget, GTK_EVENT_CONTROLLER(n->drag));
    n->click = gtk_gesture_click_new();
    g_signal_connect(n->click, "released", G_CALLBACK(clicked), n);
    gtk_widget_add_controller(n->widget, GTK_EVENT_CONTROLLER(n->click));
    n->pinch = gtk_gesture_zoom_new();
    g_signal_connect_swapped(n->pinch, "begin", G_CALLBACK(pinch_begin), n);
    g_signal_connect(n->pinch, "scale-changed", G_CALLBACK(pinched), n);
    gtk_widget_add_controller(n->widget, GTK_EVENT_CONTROLLER(n->pinch));
    n->wheel = gtk_event_controller_scroll_new(GTK_EVENT_CONTROLLER_SCROLL_VERTICAL);
    g_signal_connect(n->wheel, "scroll", G_CALLBACK(scrolled), n);
    gtk_widget_add_controller(n->widget, n->wheel);
    n->keys = gtk_event_controller_key_new();
    g_signal_connect(n->keys, "key-pressed", G_CALLBACK(key_pressed), n);
    g_signal_connect(n->keys, "key-released", G_CALLBACK(key_released), n);
    gtk_widget_add_controller(n->widget, n->keys);
    GtkEventController *focus = gtk_event_controller_focus_new();
    g_signal_connect_swapped(focus, "leave", G_CALLBACK(focus_left), n);
    gtk_widget_add_controller(n->widget, focus);
}

navigation *navigation_new(GtkWidget *widget, viewpoint *view,
                           const navigation_events *events)
{
    navigation *n = g_new0(navigation, 1);
    *n = (navigation){.widget = widget, .view = view, .events = *events};
    gtk_widget_set_focusable(widget, TRUE);
    listen(n);
    return n;
}

void navigation_free(navigation *n)
{
    if (!n)
        return;
    g_clear_handle_id(&n->still, g_source_remove);
    g_free(n);
}
