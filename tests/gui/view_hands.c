#include "view_hands.h"

#include <dlfcn.h>

/* false, and the test is skipped: no X server, or no libXtst. */
bool hands_find(hands *h)
{
    GdkDisplay *display = gdk_display_get_default();
    void *test = dlopen("libXtst.so.6", RTLD_NOW), *x = dlopen("libX11.so.6", RTLD_NOW);
    if (!GDK_IS_X11_DISPLAY(display) || !test || !x) {
        g_test_skip("no X server, or no libXtst");
        return false;
    }
    G_GNUC_BEGIN_IGNORE_DEPRECATIONS
    h->display = gdk_x11_display_get_xdisplay(display);
    G_GNUC_END_IGNORE_DEPRECATIONS
    *(void **)&h->move = dlsym(test, "XTestFakeMotionEvent");
    *(void **)&h->press = dlsym(test, "XTestFakeButtonEvent");
    *(void **)&h->key = dlsym(test, "XTestFakeKeyEvent");
    *(void **)&h->code = dlsym(x, "XKeysymToKeycode");
    *(void **)&h->sync = dlsym(x, "XSync");
    return h->move && h->press && h->key && h->code && h->sync;
}

/* Lets events arrive and frames pass: so long at least, and until nothing has happened
   for longer than a frame lasts, on a busy machine too. */
void hands_pause(int ms)
{
    const gint64 frame = 25000, patience = 150000; /* µs */
    gint64 now = g_get_monotonic_time(), until = now + 1000 * ms, busy = now;
    for (gint64 limit = until + patience;
         now < until || (now < busy + frame && now < limit);
         now = g_get_monotonic_time()) {
        if (g_main_context_iteration(NULL, FALSE))
            busy = g_get_monotonic_time();
        else
            g_usleep(500);
    }
}

static void move_pointer(const hands *h, GtkWidget *widget, double x, double y)
{
    GtkNative *native = gtk_widget_get_native(widget);
    double wx, wy, sx, sy;
    int scale = gtk_widget_get_scale_factor(widget);
    gtk_widget_translate_coordinates(widget, GTK_WIDGET(native),
                                     x * gtk_widget_get_width(widget),
                                     y * gtk_widget_get_height(widget), &wx, &wy);
    gtk_native_get_surface_transform(native, &sx, &sy);
    h->move(h->display, -1, (int)(scale * (wx + sx)), (int)(scale * (wy + sy)), 0);
    h->sync(h->display, 0);
    hands_pause(20);
}

/* The pointer at a place of a widget, 0..1 each. A window that was just opened may not be
   on the screen yet, or still move: GTK tells when the pointer is over the widget. */
void hands_point(const hands *h, GtkWidget *widget, double x, double y)
{
    const gint64 limit = g_get_monotonic_time() + 10 * G_USEC_PER_SEC;
    do {
        g_assert_cmpint(g_get_monotonic_time(), <, limit);
        move_pointer(h, widget, x, y);
    } while (!(gtk_widget_get_state_flags(widget) & GTK_STATE_FLAG_PRELIGHT));
}

void hands_press(const hands *h, unsigned button, bool down)
{
    h->press(h->display, button, down, 0);
    h->sync(h->display, 0);
    hands_pause(20);
}

void hands_key(const hands *h, unsigned keyval, bool down)
{
    h->key(h->display, h->code(h->display, keyval), down, 0);
    h->sync(h->display, 0);
    hands_pause(20);
}

void hands_drag(const hands *h, GtkWidget *widget, unsigned button)
{
    hands_point(h, widget, 0.5, 0.5);
    hands_press(h, button, true);
    for (int i = 1; i <= 4; i++)
        hands_point(h, widget, 0.5 + 0.03 * i, 0.5);
    hands_press(h, button, false);
}

void hands_hold(const hands *h, unsigned keyval)
{
    hands_key(h, keyval, true);
    hands_pause(250);
    hands_key(h, keyval, false);
    hands_pause(50);
}
