/*
 * Hands for a test of the window: pointer, buttons, wheel and keys by the X server's own
 * test extension, so that events take the way they take from a person.
 */
#pragma once

#include "view_run.h"

#include <gdk/x11/gdkx.h>

typedef struct hands {
    Display *display;
    int (*move)(Display *, int, int, int, unsigned long);
    int (*press)(Display *, unsigned, int, unsigned long);
    int (*key)(Display *, unsigned, int, unsigned long);
    KeyCode (*code)(Display *, KeySym);
    int (*sync)(Display *, int);
} hands;

/** @brief false, and the test is skipped: there is no X server, or no libXtst. */
bool hands_find(hands *h);
/** @brief Lets events arrive and frames pass: so long at least, and until nothing has
 * happened for longer than a frame lasts, on a busy machine too. */
void hands_pause(int ms);
/** @brief The pointer at a place of a widget, 0..1 each, once GTK sees it there. */
void hands_point(const hands *h, GtkWidget *widget, double x, double y);
/** @brief A button goes down or up; 4 and 5 are the wheel, up and down. */
void hands_press(const hands *h, unsigned button, bool down);
void hands_key(const hands *h, unsigned keyval, bool down);
/** @brief From the middle of a widget to the right. */
void hands_drag(const hands *h, GtkWidget *widget, unsigned button);
/** @brief A key held for a quarter of a second. */
void hands_hold(const hands *h, unsigned keyval);
