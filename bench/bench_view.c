/*
 * The window on the Cornell box: how soon the first picture comes, how many come in a
 * second while the view moves, and what a frame of a million photons costs; without
 * photons it is what is left where a GPU draws, to which they are given once.
 *
 * Software OpenGL draws where there is no GPU; `GL` says which.
 */
#include "window_parts.h"

#include "app.h"

#include <epoxy/gl.h>
#include <stdio.h>
#include <time.h>

/* s; frames */
#define MOVING_FOR 4.0
enum { FRAMES = 30, PHOTONS = 1250000 };

static double seconds(void)
{
    return 1e-6 * (double)g_get_monotonic_time();
}

/* Of all threads: what remains to be said on a machine that others use too. */
static double cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* ---- The picture ---- */

static void bench_first(window *w)
{
    double start = seconds(), cpu = cpu_seconds();
    window_open(w, BENCH_SCENE);
    while (!canvas_picture(w->canvas))
        g_main_context_iteration(NULL, TRUE);
    printf("first picture   %7.0f ms after opening, %.0f ms of processor\n",
           1e3 * (seconds() - start), 1e3 * (cpu_seconds() - cpu));
    session_set_size(w->session, 640, 480);
    start = seconds();
    cpu = cpu_seconds();
    while (canvas_picture(w->canvas)->width != 640)
        g_main_context_iteration(NULL, TRUE);
    printf("640 x 480       %7.0f ms after asking, %.0f ms of processor\n",
           1e3 * (seconds() - start), 1e3 * (cpu_seconds() - cpu));
}

static void turn(window *w, double by)
{
    viewpoint_orbit(&w->view, by, 0.0);
    window_view_moved(&w->view.camera, true, w);
}

static void bench_moving(window *w)
{
    int pictures = 0;
    const held_picture *last = canvas_picture(w->canvas);
    double start = seconds(), cpu = cpu_seconds();
    while (seconds() - start < MOVING_FOR) {
        turn(w, 0.002);
        g_main_context_iteration(NULL, FALSE);
        g_usleep(2000);
        if (canvas_picture(w->canvas) == last)
            continue;
        last = canvas_picture(w->canvas);
        pictures++;
    }
    printf("while moving    %7.1f pictures a second, each %.0f ms of processor\n",
           pictures / MOVING_FOR, 1e3 * (cpu_seconds() - cpu) / MAX(pictures, 1));
}

/* ---- Photons ---- */

static void trace(window *w)
{
    setting_control *photons = settings_panel_find(w->settings, "photons");
    session_stop(w->session);
    gtk_spin_button_set_value(GTK_SPIN_BUTTON(setting_control_input(photons)), PHOTONS);
    session_pause(w->session);
    gtk_widget_activate_action(GTK_WIDGET(w->gtk), "win.trace-photons", NULL);
    while (!w->photons || w->tracing)
        g_main_context_iteration(NULL, TRUE);
    session_stop(w->session);
    gtk_gl_area_make_current(GTK_GL_AREA(photon_view_widget(w->photon_view)));
    printf("GL              %s\n", (const char *)glGetString(GL_RENDERER));
}

/* Draws one frame and waits until it is on the screen. */
static void draw(window *w, bool moving)
{
    const photon_frame before = *photon_view_frame(w->photon_view);
    viewpoint_orbit(&w->view, 0.01, 0.0);
    photon_view_redraw(w->photon_view, moving);
    while (photon_view_frame(w->photon_view)->number == before.number)
        g_main_context_iteration(NULL, TRUE);
}

static void bench_photons(window *w, const char *what, bool moving, int frames)
{
    double drawing = 0.0, start, cpu;
    size_t points = 0;
    draw(w, false); /* what is new goes to the graphics */
    draw(w, moving);
    start = seconds();
    cpu = cpu_seconds();
    for (int i = 0; i < frames; i++) {
        draw(w, moving);
        const photon_frame *frame = photon_view_frame(w->photon_view);
        drawing += frame->seconds;
        points += frame->points;
    }
    printf("%-15s %7.1f frames a second of %zu photons; a frame %.2f ms, its window "
           "%.1f ms of processor\n",
           what, frames / (seconds() - start), points / (size_t)frames,
           1e3 * drawing / frames, 1e3 * (cpu_seconds() - cpu) / frames);
}

int main(void)
{
    setvbuf(stdout, NULL, _IOLBF, 0);
    if (!gtk_init_check()) {
        printf("no display\n");
        return 77;
    }
    g_autoptr(GtkApplication) app = app_new();
    g_application_register(G_APPLICATION(app), NULL, NULL);
    window *w = window_new(app);
    gtk_window_set_default_size(w->gtk, 1280, 800);
    gtk_window_present(w->gtk);
    bench_first(w);
    bench_moving(w);
    trace(w);
    bench_photons(w, "standing still", false, 8);
    bench_photons(w, "moving", true, FRAMES);
    photon_style none = *photon_view_style(w->photon_view);
    none.maps = 0;
    photon_view_set_style(w->photon_view, &none);
    bench_photons(w, "no photons", false, FRAMES);
    gtk_window_destroy(w->gtk);
    while (g_main_context_iteration(NULL, FALSE))
        ;
    return 0;
}
