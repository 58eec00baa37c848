/*
 * The wheel over the panels: it scrolls them and leaves what they set alone, unless one
 * of their controls has been clicked into.
 */
#include "view_hands.h"

#include <string.h>

static window *open_scene(const char *name)
{
    g_autofree char *path = view_write(name, view_scene);
    window *w = view_window();
    window_open(w, path);
    view_wait(view_is_done, w);
    return w;
}

static void turn(const hands *h, unsigned button, int notches)
{
    for (int i = 0; i < notches; i++) {
        hands_press(h, button, true);
        hands_press(h, button, false);
    }
}

/* What can be scrolled over it, or NULL. */
static GtkAdjustment *page_of(GtkWidget *widget)
{
    GtkWidget *page = gtk_widget_get_ancestor(widget, GTK_TYPE_SCROLLED_WINDOW);
    return page ? gtk_scrolled_window_get_vadjustment(GTK_SCROLLED_WINDOW(page)) : NULL;
}

static bool is_in_sight(GtkWidget *widget)
{
    GtkWidget *page = gtk_widget_get_ancestor(widget, GTK_TYPE_SCROLLED_WINDOW);
    double x, y;
    return page && gtk_widget_get_mapped(widget) &&
           gtk_widget_translate_coordinates(
               widget, page, 0.5 * gtk_widget_get_width(widget),
               0.5 * gtk_widget_get_height(widget), &x, &y) &&
           y > 0.0 && y < gtk_widget_get_height(page);
}

/* Controls that hold a number or a choice, from a widget on. */
static void collect(GtkWidget *from, GPtrArray *out)
{
    if (GTK_IS_SPIN_BUTTON(from) || GTK_IS_SCALE(from) || GTK_IS_DROP_DOWN(from) ||
        GTK_IS_SWITCH(from))
        g_ptr_array_add(out, from);
    else
        for (GtkWidget *child = gtk_widget_get_first_child(from); child;
             child = gtk_widget_get_next_sibling(child))
            collect(child, out);
}

static double number_of(GtkWidget *input)
{
    if (GTK_IS_SPIN_BUTTON(input))
        return gtk_spin_button_get_value(GTK_SPIN_BUTTON(input));
    if (GTK_IS_SCALE(input))
        return gtk_range_get_value(GTK_RANGE(input));
    if (GTK_IS_DROP_DOWN(input))
        return gtk_drop_down_get_selected(GTK_DROP_DOWN(input));
    return gtk_switch_get_active(GTK_SWITCH(input));
}

/* Over each control that is in sight of a page, down and up. */
static guint turn_over_page(const hands *h, window *w, const char *page)
{
    g_autoptr(GPtrArray) inputs = g_ptr_array_new();
    guint n = 0;
    gtk_widget_activate_action(GTK_WIDGET(w->gtk), "win.page", "s", page);
    gtk_widget_grab_focus(canvas_widget(w->canvas));
    hands_pause(100);
    collect(gtk_stack_get_visible_child(GTK_STACK(w->pages)), inputs);
    for (guint i = 0; i < inputs->len; i++) {
        GtkWidget *input = inputs->pdata[i];
        if (!is_in_sight(input) || !gtk_widget_is_sensitive(input))
            continue;
        double before = number_of(input);
        hands_point(h, input, 0.4, 0.5);
        turn(h, 5, 1);
        turn(h, 4, 2);
        g_test_message("%s: %s", page, gtk_widget_get_name(input));
        g_assert_cmpfloat_with_epsilon(number_of(input), before, 1e-12);
        n++;
    }
    return n;
}

static void test_alone(void)
{
    static const char *const pages[] = {"settings", "camera", "inspect", "photons"};
    hands h;
    if (!hands_find(&h))
        return;
    window *w = open_scene("wheel.pbrt");
    int64_t passes = w->statistics.passes;
    guint n = 0;
    for (size_t i = 0; i < G_N_ELEMENTS(pages); i++)
        n += turn_over_page(&h, w, pages[i]);
    g_assert_cmpuint(n, >, 15);
    g_assert_true(view_is_done(w)); /* nothing was begun anew */
    g_assert_cmpint(w->statistics.passes, ==, passes);
    view_close(w);
}

/* It scrolls the page, over a number as beside one. */
static void test_scrolls(void)
{
    hands h;
    if (!hands_find(&h))
        return;
    window *w = open_scene("wheel-scrolls.pbrt");
    GtkWidget *input = setting_control_input(settings_panel_find(w->settings, "photons"));
    GtkAdjustment *page = page_of(input);
    hands_point(&h, input, 0.3, 0.5);
    g_assert_cmpfloat(gtk_adjustment_get_value(page), <=, 0.0);
    turn(&h, 5, 3);
    hands_pause(300);
    g_assert_cmpfloat(gtk_adjustment_get_value(page), >, 20.0);
    view_close(w);
}

/* Who has clicked into a number may turn it. */
static void test_with_focus(void)
{
    hands h;
    if (!hands_find(&h))
        return;
    window *w = open_scene("wheel-focus.pbrt");
    GtkWidget *input = setting_control_input(settings_panel_find(w->settings, "photons"));
    double before = number_of(input);
    hands_point(&h, input, 0.3, 0.5);
    hands_press(&h, 1, true);
    hands_press(&h, 1, false);
    turn(&h, 4, 1);
    g_assert_cmpfloat(number_of(input), >, before);
    before = number_of(input);
    gtk_widget_grab_focus(canvas_widget(w->canvas));
    turn(&h, 4, 1);
    g_assert_cmpfloat_with_epsilon(number_of(input), before, 1e-12);
    view_wait(view_is_done, w);
    view_close(w);
}

int main(int argc, char **argv)
{
    view_init(&argc, &argv);
    view_add_test("/view-wheel/alone", test_alone);
    view_add_test("/view-wheel/scrolls", test_scrolls);
    view_add_test("/view-wheel/with-focus", test_with_focus);
    return view_run();
}
