/*
 * What GTK draws the window with.
 */
#pragma once

#include <gdk/gdk.h>

/** @brief Before the first window: where OpenGL is drawn by the processor (or is not
 * there), GTK draws by cairo, which takes a fraction of the time for the same window.
 * Somebody's GSK_RENDERER stands. */
void renderer_choose(GdkDisplay *display);
