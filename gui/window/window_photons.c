/*
 * The window's photon view: tracing on demand, and picking.
 */
#include "window/window_parts.h"

#include "photons/photon_job.h"

#include <math.h>
#include <string.h>

enum { MOST_NEIGHBOURS = 5000, MOST_EVENTS = 256, CIRCLE = 48 };

/* A click this near to a photon, in pixels, means it. */
#define REACH 7.0
/* How far a path goes on where the photon left the scene, as share of the extent. */
#define LEFT_SHARE 0.3f

/* ---- Tracing ---- */

void window_pick_when_traced(window *w, const char *place)
{
    g_free(w->pick_then);
    w->pick_then = g_strdup(place);
}

static void pick_then(window *w)
{
    g_autofree char *text = g_steal_pointer(&w->pick_then);
    g_auto(GStrv) words = g_strsplit(text ? text : "", ",", 2);
    if (g_strv_length(words) != 2)
        return;
    const double place[2] = {g_ascii_strtod(words[0], NULL),
                             g_ascii_strtod(words[1], NULL)};
    window_pick(w, place, REACH / fmax(photon_view_scale(w->photon_view), 1.0));
}

static void traced(GObject *source, GAsyncResult *result, void *data)
{
    (void)source;
    if (g_cancellable_is_cancelled(g_task_get_cancellable(G_TASK(result))))
        return;
    window *w = data;
    g_autoptr(GError) error = NULL;
    g_autoptr(photon_result) made = photon_job_finish(result, &error);
    g_clear_object(&w->tracing);
    photon_panel_show_tracing(w->photon_panel, false);
    if (!made) {
        window_toast(w, "%s", error->message);
        return;
    }
    NephStatistics statistics;
    held_photons_unref(w->photons);
    w->photons = held_photons_ref(made->photons);
    neph_photons_statistics(w->photons->photons, &statistics);
    photon_panel_show_numbers(w->photon_panel, &statistics);
    photon_panel_show_pick(w->photon_panel, NULL);
    photon_view_set_cloud(w->photon_view, g_steal_pointer(&made->cloud));
    w->has_pick = false;
    pick_then(w);
}

void window_stop_tracing(window *w)
{
    if (!w->tracing)
        return;
    g_cancellable_cancel(w->tracing);
    g_clear_object(&w->tracing);
}

void window_trace_photons(window *w)
{
    if (!w->scene)
        return;
    window_stop_tracing(w);
    w->tracing = g_cancellable_new();
    photon_panel_show_tracing(w->photon_panel, true);
    const photon_wish wish = {w->scene, settings_panel_values(w->settings),
                              &w->view.camera, w->size[0], w->size[1]};
    photon_job_start(&wish, w->tracing, traced, w);
}

static bool photons_in_view(window *w)
{
    if (gtk_widget_in_destruction(GTK_WIDGET(w->gtk)))
        return false;
    const char *name = gtk_stack_get_visible_child_name(GTK_STACK(w->views));
    return g_strcmp0(name, "photons") == 0;
}

void window_photons_settings_changed(window *w)
{
    if (photons_in_view(w) && photon_panel_follows(w->photon_panel))
        window_trace_photons(w);
}

void window_photons_new_scene(window *w)
{
    window_stop_tracing(w);
    g_clear_pointer(&w->photons, held_photons_unref);
    photon_view_set_scene(w->photon_view, w->scene);
    photon_panel_show_pick(w->photon_panel, NULL);
    w->has_pick = false;
    if (photons_in_view(w))
        window_trace_photons(w);
}

void window_view_switched(window *w)
{
    if (!photons_in_view(w))
        return;
    gtk_stack_set_visible_child_name(GTK_STACK(w->pages), "photons");
    gtk_widget_grab_focus(photon_view_widget(w->photon_view));
    if (!w->photons && !w->tracing)
        window_trace_photons(w);
}

void window_photons_drawn(const photon_frame *frame, void *data)
{
    window *w = data;
    photon_panel_show_frame(w->photon_panel, frame);
    numbers_panel_show(w->numbers, &w->statistics, frame);
}

void window_photon_style(const photon_style *style, void *data)
{
    photon_view_set_style(((window *)data)->photon_view, style);
}

/* ---- Marks ---- */

static void put_vertex(GArray *to, const float p[3], const uint8_t color[4])
{
    cloud_vertex v;
    memcpy(v.position, p, sizeof v.position);
    memcpy(v.color, color, sizeof v.color);
    g_array_append_val(to, v);
}

/* The rim of the disc that photons are gathered from. */
static void put_circle(GArray *lines, const NephSurfacePoint *at, double radius)
{
    static const uint8_t rim[4] = {120, 255, 190, 255};
    int least = 0;
    double u[3] = {0}, s[3], t[3], length;
    for (int i = 1; i < 3; i++)
        if (fabs(at->normal[i]) < fabs(at->normal[least]))
            least = i;
    u[least] = 1.0;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        s[i] = at->normal[j] * u[k] - at->normal[k] * u[j];
    }
    length = sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
    for (int i = 0; i < 3; i++)
        s[i] /= length;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        t[i] = at->normal[j] * s[k] - at->normal[k] * s[j];
    }
    for (int step = 0; step < 2 * CIRCLE; step++) {
        double angle = 2.0 * G_PI * ((step + 1) / 2) / CIRCLE;
        float p[3];
        for (int i = 0; i < 3; i++)
            p[i] = (float)(at->position[i] +
                           radius * (cos(angle) * s[i] + sin(angle) * t[i]));
        put_vertex(lines, p, rim);
    }
}

/* What a way through a medium leaves on it may lie behind where it turns off. Of all that
   only the photon `at` is shown. */
static void put_path(GArray *lines, const NephPhotonEvent *events, size_t n,
                     const float at[3], float beyond)
{
    static const uint8_t color[4] = {255, 255, 255, 255};
    const NephPhotonEvent *from = events;
    for (size_t i = 1; i < n; i++) {
        const NephPhotonEvent *e = &events[i];
        bool stored = e->kind == NEPH_PHOTON_STORED;
        if (stored && memcmp(e->position, at, sizeof e->position) != 0)
            continue;
        float end[3];
        bool left = e->kind == NEPH_PHOTON_LEFT;
        for (int k = 0; k < 3; k++)
            end[k] = e->position[k] + (left ? beyond * e->direction[k] : 0.0f);
        put_vertex(lines, from->position, color);
        put_vertex(lines, end, color);
        from = stored ? from : e;
    }
}

static void put_neighbours(window *w, GArray *points, const NephSurfacePoint *at)
{
    static const uint8_t color[4] = {120, 255, 190, 255};
    const NephPhotons *photons = w->photons->photons;
    g_autofree size_t *index = g_new(size_t, MOST_NEIGHBOURS);
    size_t n = neph_photons_near(photons, at->position, at->normal, w->pick_radius, index,
                                 MOST_NEIGHBOURS);
    for (size_t i = 0; i < MIN(n, MOST_NEIGHBOURS); i++) {
        NephPhoton p;
        neph_photons_get(photons, index[i], &p);
        put_vertex(points, p.position, color);
    }
}

static const char *medium_picked(const window *w)
{
    return w->picked_is_photon
               ? neph_photons_medium(w->photons->photons, w->picked_photon)
               : "";
}

/* The disc that a surface gathers from, and the photons in it. */
static void show_estimate(window *w, photon_pick *pick, GArray *lines, GArray *points)
{
    neph_photons_estimate(w->photons->photons, w->picked.position, w->picked.normal,
                          w->pick_radius, &pick->estimate);
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++)
        if (pick->estimate.n[c] > 0)
            put_circle(lines, &w->picked, pick->estimate.radius[c]);
    put_neighbours(w, points, &w->picked);
}

/* Only photons of maps on show are picked, so one picked on a surface is of the estimate.
 */
static void show_pick(window *w)
{
    NephPhotonEvent events[MOST_EVENTS];
    const NephPhotons *photons = w->photons->photons;
    photon_pick pick = {
        .is_photon = w->picked_is_photon, .medium = medium_picked(w), .at = w->picked};
    g_autoptr(GArray) lines = g_array_new(FALSE, FALSE, sizeof(cloud_vertex));
    g_autoptr(GArray) points = g_array_new(FALSE, FALSE, sizeof(cloud_vertex));
    if (!*pick.medium)
        show_estimate(w, &pick, lines, points);
    if (pick.is_photon) {
        neph_photons_get(photons, w->picked_photon, &pick.photon);
        pick.n_events =
            MIN(neph_photons_path(photons, w->picked_photon, events, MOST_EVENTS),
                MOST_EVENTS);
        pick.events = events;
        put_path(lines, events, pick.n_events, pick.photon.position,
                 LEFT_SHARE * (float)w->view.extent);
    }
    photon_panel_show_pick(w->photon_panel, &pick);
    photon_view_set_marks(w->photon_view, (const cloud_vertex *)(void *)lines->data,
                          lines->len, (const cloud_vertex *)(void *)points->data,
                          points->len);
}

/* ---- Picking ---- */

/* A photon that hangs in a medium is its place alone. */
static void place_in_medium(const NephPhoton *p, NephSurfacePoint *out)
{
    *out = (NephSurfacePoint){0};
    for (int i = 0; i < 3; i++)
        out->position[i] = (double)p->position[i];
}

/* The surface under a photon: a ray along its way meets it. */
static bool surface_under(window *w, const NephPhoton *p, NephSurfacePoint *out)
{
    double origin[3], direction[3], back = 1e-3 * w->view.extent;
    for (int i = 0; i < 3; i++) {
        direction[i] = -(double)p->direction[i];
        origin[i] = (double)p->position[i] - back * direction[i];
    }
    if (!neph_scene_pick(w->scene->scene, origin, direction, out))
        return false;
    for (int i = 0; i < 3; i++)
        out->position[i] = (double)p->position[i];
    return true;
}

bool window_pick(window *w, const double place[2], double reach)
{
    const photon_cloud *cloud = photon_view_cloud(w->photon_view);
    unsigned maps = photon_view_style(w->photon_view)->maps;
    double origin[3], direction[3];
    if (!cloud || !w->photons)
        return false;
    w->picked_is_photon =
        photon_cloud_pick(cloud, maps, &w->view.camera, place, reach, &w->picked_photon);
    if (w->picked_is_photon) {
        NephPhoton p;
        neph_photons_get(w->photons->photons, w->picked_photon, &p);
        if (*medium_picked(w))
            place_in_medium(&p, &w->picked);
        w->has_pick = *medium_picked(w) || surface_under(w, &p, &w->picked);
    } else {
        neph_camera_ray(&w->view.camera, place[0], place[1], origin, direction);
        w->has_pick = neph_scene_pick(w->scene->scene, origin, direction, &w->picked);
    }
    if (w->has_pick)
        show_pick(w);
    return w->has_pick;
}

void window_photon_clicked(double x, double y, int n, void *data)
{
    window *w = data;
    double place[2];
    photon_view_place(w->photon_view, x, y, place);
    if (window_pick(w, place, REACH / photon_view_scale(w->photon_view)) && n == 2)
        viewpoint_set_pivot(&w->view, w->picked.position);
}

void window_pick_radius(double radius, void *data)
{
    window *w = data;
    w->pick_radius = radius;
    if (w->has_pick && w->photons)
        show_pick(w);
}
