/*
 * Driving the window in a test: a display or a skip, an application without a bus, and
 * waiting for what the worker does.
 */
#pragma once

#include "window/window_parts.h"

/** @brief Prepares folders, GTK and the test API. false: there is no display, and every
 * test added is skipped. */
bool view_init(int *argc, char ***argv);
void view_add_test(const char *path, void (*test)(void));
int view_run(void);
/** @brief A folder of the test's own. */
const char *view_folder(void);
/** @brief Writes a file there; its path, owned by the caller. */
char *view_write(const char *name, const char *text);
/** @brief A room with a glass ball, 24 x 16 pixels; one pass takes some milliseconds. */
extern const char view_scene[];

/** @brief A window on the display. */
window *view_window(void);
/** @brief Destroys it and lets all that hangs on it go. */
void view_close(window *w);
/** @brief Runs the main loop until done says so; fails after half a minute. */
void view_wait(bool (*done)(window *w), window *w);
bool view_is_done(window *w);      /**< the render is over */
bool view_is_rendering(window *w); /**< a scene is there and being rendered */
/** @brief Waits until what was just asked for is rendered: the render is over, and its
 * picture another than is shown now. A state on the way there may be over before the
 * window is told of it. */
void view_wait_for_other(window *w);
void view_activate(window *w, const char *action);
/** @brief What the window says in passing, as last said. Borrowed. */
const char *view_said(window *w);
/** @brief Waits until it says something with this in it, and lets it be forgotten. */
void view_wait_for_word(window *w, const char *word);
/** @brief Runs what the main loop has to do now. */
void view_settle(void);
