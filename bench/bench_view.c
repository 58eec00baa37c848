/*
 * The window on the Cornell box: how soon the first picture comes, how many come in a
 * second while the view moves, and what a frame of a million photons costs; without
 * photons it is what is left where a GPU draws, to which they are given once.
 *
 * Software OpenGL draws where there is no GPU; `GL` says which.
 */
#include "window/window_parts.h"

#include "window/app.h"

#include <epoxy/gl.h>
#include <math.h>
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

static const photon_frame *next_frame(window *w)
{
    guint64 before = photon_view_frame(w->photon_view)->number;
    while (photon_view_frame(w->photon_view)->number == before)
        g_main_context_iteration(NULL, TRUE);
    return photon_view_frame(w->photon_view);
}

/* From elsewhere: a new picture begins. */
static const photon_frame *turn_photons(window *w)
{
    viewpoint_orbit(&w->view, 0.01, 0.0);
    photon_view_redraw(w->photon_view);
    return next_frame(w);
}

/* Called between whatever else the main loop does. */
typedef struct watch {
    double last, longest; /* s */
} watch;

static gboolean look_at_clock(void *data)
{
    watch *of = data;
    of->longest = fmax(of->longest, seconds() - of->last);
    of->last = seconds();
    return G_SOURCE_CONTINUE;
}

/* The picture that comes when the view stands still, until every photon is in it: how
   long the main loop is kept from anything else. */
static void bench_standing(window *w)
{
    double start = seconds(), cpu = cpu_seconds();
    const photon_frame *frame = turn_photons(w);
    watch busy = {seconds(), 0.0};
    guint source = g_timeout_add_full(G_PRIORITY_HIGH, 1, look_at_clock, &busy, NULL);
    int shown = 1;
    for (; frame->points < frame->all; shown++)
        frame = next_frame(w);
    g_source_remove(source);
    printf(
        "standing still  %7.2f s for %zu photons, %.0f ms of processor; shown %d times, "
        "busy for %.0f ms at most\n",
        seconds() - start, frame->points, 1e3 * (cpu_seconds() - cpu), shown,
        1e3 * busy.longest);
}

static void bench_moving_photons(window *w, const char *what)
{
    double drawing = 0.0, start = seconds(), cpu = cpu_seconds();
    size_t points = 0;
    for (int i = 0; i < FRAMES; i++) {
        const photon_frame *frame = turn_photons(w);
        drawing += frame->seconds;
        points += frame->points;
    }
    printf("%-15s %7.1f frames a second of %zu photons; a frame %.2f ms, its window "
           "%.1f ms of processor\n",
           what, FRAMES / (seconds() - start), points / FRAMES, 1e3 * drawing / FRAMES,
           1e3 * (cpu_seconds() - cpu) / FRAMES);
}

/* What the main loop does when a million photons are there: they are coloured and given
   to the graphics. */
static void bench_colors(window *w)
{
    photon_style style = *photon_view_style(w->photon_view);
    double start = seconds(), cpu = cpu_seconds();
    style.coloring = COLOR_MAP;
    photon_view_set_style(w->photon_view, &style);
    const photon_frame *frame = next_frame(w);
    printf("new colours     %7.0f ms and a frame of %.1f, %.0f ms of processor\n",
           1e3 * (seconds() - start - frame->seconds), 1e3 * frame->seconds,
           1e3 * (cpu_seconds() - cpu));
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
    next_frame(w);
    bench_standing(w);
    bench_moving_photons(w, "moving");
    bench_colors(w);
    photon_style none = *photon_view_style(w->photon_view);
    none.maps = 0;
    photon_view_set_style(w->photon_view, &none);
    bench_moving_photons(w, "no photons");
    gtk_window_destroy(w->gtk);
    while (g_main_context_iteration(NULL, FALSE))
        ;
    return 0;
}
