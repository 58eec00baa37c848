/*
 * Small helpers for building the window: what GTK 4.8 needs three lines for.
 */
#pragma once

#include <gtk/gtk.h>

/** @brief What assistive technology calls the widget, and its tooltip if it has none. */
void widget_name(GtkWidget *widget, const char *name);
/** @brief A label, left-aligned, with a CSS class (NULL: none). */
GtkWidget *label_make(const char *text, const char *css_class);
/** @brief Lets a label have several lines, broken within a word where they must be. */
void label_break_anywhere(GtkWidget *label);
/** @brief The same as label_make, of several lines. */
GtkWidget *text_make(const char *text, const char *css_class);
/** @brief A button with an icon, named by its tooltip; action as in "win.play", or NULL.
 */
GtkWidget *icon_button_make(const char *icon, const char *tooltip, const char *action);
/** @brief A button with a text; action or NULL. */
GtkWidget *text_button_make(const char *text, const char *tooltip, const char *action);
/** @brief A box with margins of so many pixels around and between. */
GtkWidget *box_make(GtkOrientation orientation, int spacing, int margin);
/** @brief A title over a list with a frame; rows go to *list. */
GtkWidget *group_make(const char *title, GtkWidget **list);
/** @brief A page of groups that scrolls: the widget for the stack; groups go to
 * *content. */
GtkWidget *page_make(GtkWidget **content);
/** @brief Scrolls a page so that a group of it is seen, once it has its place. */
void page_scroll_to(GtkWidget *page, GtkWidget *group);
/** @brief A row of a group: title left, control right, which is named by the title. */
GtkWidget *row_add(GtkWidget *list, const char *title, GtkWidget *control);
/** @brief The same with a smaller line below the title; NULL: none. */
GtkWidget *row_add_captioned(GtkWidget *list, const char *title, const char *caption,
                             GtkWidget *control);
/** @brief A row whose right side is a text to be set. */
GtkWidget *value_row_add(GtkWidget *list, const char *title);
/** @brief A spin button whose numbers are written with a point and without trailing
 * zeros, in any locale. The wheel is left to the page while it has not the focus. */
GtkWidget *spin_make(double low, double high, double step, bool whole);
/** @brief Shows the lowest value of a spin button as a static word, which may be typed.
 */
void spin_name_lowest(GtkWidget *spin, const char *word);
/** @brief A horizontal slider that shows its value with so many digits; the wheel as
 * above. */
GtkWidget *slider_make(double low, double high, double step, int digits);
/** @brief A whole number with its thousands apart; owned by the caller. */
char *count_text(guint64 n);
/** @brief A picture drawn by the program, as assistive technology has to know. */
GtkWidget *drawing_make(const char *name, GtkDrawingAreaDrawFunc draw, void *data);
/** @brief A drop-down of NULL-terminated words. */
GtkWidget *choice_make(const char *const *words);
