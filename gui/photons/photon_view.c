#include "photons/photon_view.h"

#include "photons/gl_keep.h"
#include "photons/gl_layer.h"
#include "photons/projection.h"
#include "widgets/widgets.h"

#include <epoxy/gl.h>
#include <math.h>
#include <string.h>

/* Line segments of a wireframe, at most; points that a frame draws even where that is
   slow. */
enum { MOST_EDGES = 200000, LEAST_POINTS = 20000 };

/* Numbers that change faster are not read, ms. */
enum { TELL_MS = 200 };

/* How long the main loop may wait, s: software draws a part of the points in it, then the
   next part. */
#define PART_GOAL 0.025

/* Width of a path, and of a wireframe's line, pixels. */
enum { PATH_WIDTH = 3, WIRE_WIDTH = 1 };
/* Points where photons with arrows landed, and marked ones, pixels. */
#define ARROW_FOOT 4.0f
#define MARK_SIZE 4.0f
/* What is left of the photons' colours behind a picked one's path. */
#define BEHIND_PICK 0.45f

/* Length of an arrow, as share of the scene's extent. */
#define ARROW_SHARE 0.05f

struct photon_view {
    GtkWidget *area;
    const viewpoint *view;
    photon_style style;
    held_scene *scene;
    photon_cloud *cloud;
    cloud_vertex *wire, *mark_lines, *mark_points;
    size_t n_wire, n_mark_lines, n_mark_points;
    gl_painter painter;
    gl_layer wire_layer, photon_layer, arrow_layer, line_layer, point_layer;
    bool wire_changed, photons_changed, arrows_changed, marks_changed;
    gl_keep kept;                       /* what has been drawn from here */
    float drawn_from[16];               /* the matrix that was */
    bool stale;                         /* something else than the view has changed */
    size_t done[NEPH_N_PHOTON_CLASSES]; /* points of each map that are in it */
    double points_a_second;             /* as last measured; 0: not yet */
    double spent;                       /* on drawing it, s */
    guint drawing; /* the source that draws the next part; 0: all is drawn */
    photon_frame frame;
    guint telling; /* source, 0: nothing to tell */
    void (*drawn)(const photon_frame *frame, void *data);
    void *data;
    GCancellable *wiring; /* NULL: no wireframe is being made */
};

static double seconds_since(gint64 start)
{
    return 1e-6 * (double)(g_get_monotonic_time() - start);
}

static projection projection_of(const photon_view *v)
{
    return (projection){v->view, gtk_widget_get_width(v->area),
                        gtk_widget_get_height(v->area)};
}

void photon_view_place(const photon_view *v, double wx, double wy, double place[2])
{
    const projection p = projection_of(v);
    projection_place(&p, wx, wy, place);
}

double photon_view_scale(const photon_view *v)
{
    const projection p = projection_of(v);
    return projection_scale(&p);
}

/* ---- The wireframe ---- */

typedef struct wire {
    held_scene *scene;
    cloud_vertex *ends;
    size_t n;
} wire;

static void free_wire(void *data)
{
    wire *w = data;
    held_scene_unref(w->scene);
    g_free(w->ends);
    g_free(w);
}

static void make_wire(GTask *task, void *source, void *data, GCancellable *cancellable)
{
    (void)source, (void)cancellable;
    wire *w = data;
    g_autofree float *ends = neph_scene_wireframe(w->scene->scene, MOST_EDGES, &w->n);
    w->n *= 2;
    w->ends = g_new(cloud_vertex, w->n);
    for (size_t i = 0; i < w->n; i++) {
        memcpy(w->ends[i].position, ends + 3 * i, sizeof w->ends[i].position);
        memset(w->ends[i].color, 200, sizeof w->ends[i].color);
    }
    g_task_return_boolean(task, TRUE);
}

static void wire_made(GObject *source, GAsyncResult *result, void *data)
{
    (void)source;
    if (g_cancellable_is_cancelled(g_task_get_cancellable(G_TASK(result))))
        return;
    photon_view *v = data;
    wire *w = g_task_get_task_data(G_TASK(result));
    g_clear_object(&v->wiring);
    g_free(v->wire);
    v->wire = g_steal_pointer(&w->ends);
    v->n_wire = w->n;
    v->wire_changed = true;
    gtk_gl_area_queue_render(GTK_GL_AREA(v->area));
}

static void stop_wiring(photon_view *v)
{
    if (v->wiring)
        g_cancellable_cancel(v->wiring);
    g_clear_object(&v->wiring);
}

/* A large scene has many edges to look for: once they are wanted, and on a thread. */
static void want_wire(photon_view *v)
{
    if (!v->scene || v->wire || v->wiring)
        return;
    wire *w = g_new0(wire, 1);
    w->scene = held_scene_ref(v->scene);
    v->wiring = g_cancellable_new();
    g_autoptr(GTask) task = g_task_new(NULL, v->wiring, wire_made, v);
    g_task_set_task_data(task, w, free_wire);
    g_task_set_check_cancellable(task, FALSE);
    g_task_run_in_thread(task, make_wire);
}

/* ---- Drawing ---- */

static bool shows_arrows(const photon_view *v)
{
    return v->cloud && photon_cloud_count(v->cloud, v->style.maps) < MOST_ARROWS;
}

/* A picked photon's path stands out. */
static float fade_of(const photon_view *v)
{
    return v->n_mark_lines > 0 ? BEHIND_PICK : 1.0f;
}

static void upload_arrows(photon_view *v)
{
    size_t n = 0;
    g_autofree cloud_vertex *arrows = NULL;
    if (shows_arrows(v))
        arrows = photon_cloud_arrows(v->cloud, v->style.maps,
                                     ARROW_SHARE * (float)v->view->extent, &n);
    gl_layer_set(&v->arrow_layer, arrows, n);
}

static void upload_photons(photon_view *v)
{
    g_autofree cloud_vertex *mixed = v->cloud ? photon_cloud_mixed(v->cloud) : NULL;
    gl_layer_set(&v->photon_layer, mixed, v->cloud ? v->cloud->n : 0);
}

/* True if the picture is another now. */
static bool upload(photon_view *v)
{
    bool another = v->wire_changed || v->photons_changed || v->arrows_changed;
    if (v->wire_changed)
        gl_layer_set(&v->wire_layer, v->wire, v->n_wire);
    if (v->photons_changed)
        upload_photons(v);
    if (v->arrows_changed || v->photons_changed)
        upload_arrows(v);
    if (v->marks_changed) {
        gl_layer_set(&v->line_layer, v->mark_lines, v->n_mark_lines);
        gl_layer_set(&v->point_layer, v->mark_points, v->n_mark_points);
    }
    v->wire_changed = v->photons_changed = v->arrows_changed = v->marks_changed = false;
    return another;
}

/* ---- Drawing, part by part ---- */

static size_t count_drawn(const photon_view *v)
{
    size_t n = 0;
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++)
        n += v->done[c];
    return n;
}

static size_t count_all(const photon_view *v)
{
    return v->cloud ? photon_cloud_count(v->cloud, v->style.maps) : 0;
}

/* What the picture begins with: the wireframe, and arrows. */
static void draw_first(photon_view *v, const float matrix[16], int scale)
{
    static const float background[3] = {0.10f, 0.10f, 0.11f};
    memset(v->done, 0, sizeof v->done);
    memcpy(v->drawn_from, matrix, sizeof v->drawn_from);
    v->stale = false;
    gl_painter_clear_picture(background);
    if (v->style.wireframe)
        gl_layer_lines(&v->painter, &v->wire_layer, 0.55f, WIRE_WIDTH * scale);
    if (shows_arrows(v))
        gl_layer_lines(&v->painter, &v->arrow_layer, fade_of(v), scale);
}

/* The next points of a map: any run of them is spread over the whole, for they were
   mixed. */
static void draw_run(photon_view *v, int c, size_t n, int scale)
{
    float size = v->style.point_size * (float)scale;
    const gl_points points = {v->cloud->first[c] + v->done[c], n,
                              shows_arrows(v) ? ARROW_FOOT : size, fade_of(v)};
    gl_layer_points(&v->painter, &v->photon_layer, &points);
    v->done[c] += n;
}

/* As many more points as there is time for, of each map its share. */
static void draw_more(photon_view *v, double allowed, int scale)
{
    size_t all = count_all(v), before = count_drawn(v);
    double n = fmax(allowed * v->points_a_second, LEAST_POINTS);
    double share = fmin(n / (double)MAX(all - before, 1), 1.0);
    gint64 start = g_get_monotonic_time();
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES && before < all; c++) {
        size_t left = v->cloud->first[c + 1] - v->cloud->first[c] - v->done[c];
        if (v->style.maps & (1u << c))
            draw_run(v, c, MIN((size_t)ceil(share * (double)left), left), scale);
    }
    glFinish();
    double took = seconds_since(start);
    size_t drawn = count_drawn(v) - before;
    if (drawn >= LEAST_POINTS) /* of fewer, the time says little */
        v->points_a_second = (double)drawn / fmax(took, 1e-6);
}

/* Over the picture: what is marked. */
static void draw_marks(photon_view *v, int scale)
{
    glDisable(GL_DEPTH_TEST);
    gl_layer_points(&v->painter, &v->point_layer,
                    &(gl_points){0, v->point_layer.n, MARK_SIZE * (float)scale, 1.0f});
    gl_layer_lines(&v->painter, &v->line_layer, 1.0f, PATH_WIDTH * scale);
}

static gboolean tell_drawn(void *data)
{
    photon_view *v = data;
    v->telling = 0;
    v->drawn(&v->frame, v->data);
    return G_SOURCE_REMOVE;
}

/* When the main loop has nothing else to do. To put a frame on the screen takes long,
   too: it is shown when it has twice the points. */
static gboolean next_part(void *data)
{
    photon_view *v = data;
    GtkGLArea *area = GTK_GL_AREA(v->area);
    gint64 start = g_get_monotonic_time();
    gtk_gl_area_make_current(area);
    gl_keep_begin(&v->kept, v->kept.width, v->kept.height);
    const int pixels[2] = {v->kept.width, v->kept.height};
    gl_painter_begin(&v->painter, v->drawn_from, pixels);
    draw_more(v, PART_GOAL, gtk_widget_get_scale_factor(v->area));
    v->spent += seconds_since(start);
    bool all = count_drawn(v) == count_all(v);
    if (all || count_drawn(v) >= 2 * v->frame.points)
        gtk_gl_area_queue_render(area);
    if (all)
        v->drawing = 0;
    return all ? G_SOURCE_REMOVE : G_SOURCE_CONTINUE;
}

static void note_frame(photon_view *v)
{
    v->frame = (photon_frame){.number = v->frame.number + 1,
                              .seconds = v->spent,
                              .points = count_drawn(v),
                              .all = count_all(v)};
    if (v->frame.points < v->frame.all && !v->drawing)
        v->drawing = g_idle_add(next_part, v);
    if (!v->telling)
        v->telling = g_timeout_add(TELL_MS, tell_drawn, v);
}

/* The first frame with something new is not like those after it: drivers make ready for
   it. What a frame takes is told of another, if that is quick. */
static void draw_again(photon_view *v)
{
    v->stale = true;
    if (!v->drawing)
        v->drawing = g_idle_add(next_part, v);
}

/* A picture begins with what there is time for; one that is still right is shown as far
   as it has come. */
static gboolean render(GtkGLArea *area, GdkGLContext *context, photon_view *v)
{
    (void)context;
    const projection p = projection_of(v);
    int scale = gtk_widget_get_scale_factor(v->area), given = 0;
    const int pixels[2] = {(int)p.width * scale, (int)p.height * scale};
    float matrix[16];
    if (gtk_gl_area_get_error(area) || !v->painter.program)
        return FALSE;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &given);
    want_wire(v);
    bool uploaded = upload(v);
    v->stale |= uploaded;
    projection_matrix(&p, matrix);
    bool is_right = gl_keep_begin(&v->kept, pixels[0], pixels[1]) && !v->stale &&
                    memcmp(matrix, v->drawn_from, sizeof matrix) == 0;
    gl_painter_begin(&v->painter, matrix, pixels);
    if (!is_right) {
        gint64 start = g_get_monotonic_time();
        draw_first(v, matrix, scale);
        glFinish();
        draw_more(v, PART_GOAL - seconds_since(start), scale);
        v->spent = seconds_since(start);
    }
    gl_keep_show(&v->kept, (unsigned)given);
    draw_marks(v, scale);
    glFinish();
    note_frame(v);
    if (uploaded && v->frame.points == v->frame.all)
        draw_again(v);
    return TRUE;
}

static void realize(GtkGLArea *area, photon_view *v)
{
    g_autoptr(GError) error = NULL;
    gtk_gl_area_make_current(area);
    if (gtk_gl_area_get_error(area))
        return;
    bool es = gdk_gl_context_get_use_es(gtk_gl_area_get_context(area));
    if (!gl_painter_init(&v->painter, es, &error))
        gtk_gl_area_set_error(area, error);
    v->wire_changed = v->photons_changed = v->arrows_changed = v->marks_changed = true;
}

static void unrealize(GtkGLArea *area, photon_view *v)
{
    gl_layer *const layers[] = {&v->wire_layer, &v->photon_layer, &v->arrow_layer,
                                &v->line_layer, &v->point_layer};
    g_clear_handle_id(&v->drawing, g_source_remove);
    gtk_gl_area_make_current(area);
    if (gtk_gl_area_get_error(area))
        return;
    for (size_t i = 0; i < G_N_ELEMENTS(layers); i++)
        gl_layer_clear(layers[i]);
    gl_keep_clear(&v->kept);
    gl_painter_clear(&v->painter);
}

/* ---- The view ---- */

photon_view *photon_view_new(const viewpoint *view,
                             void (*drawn)(const photon_frame *frame, void *data),
                             void *data)
{
    photon_view *v = g_new0(photon_view, 1);
    v->view = view;
    v->drawn = drawn;
    v->data = data;
    v->style = (photon_style){.maps = 7, .point_size = 5.0f, .wireframe = true};
    v->area =
        g_object_new(GTK_TYPE_GL_AREA, "accessible-role", GTK_ACCESSIBLE_ROLE_IMG, NULL);
    gtk_gl_area_set_auto_render(GTK_GL_AREA(v->area), FALSE);
    gtk_widget_set_hexpand(v->area, TRUE);
    gtk_widget_set_vexpand(v->area, TRUE);
    gtk_widget_add_css_class(v->area, "canvas");
    widget_name(v->area, "Photons over the wireframe");
    gtk_widget_set_has_tooltip(v->area, FALSE);
    g_signal_connect(v->area, "realize", G_CALLBACK(realize), v);
    g_signal_connect(v->area, "unrealize", G_CALLBACK(unrealize), v);
    g_signal_connect(v->area, "render", G_CALLBACK(render), v);
    return v;
}

void photon_view_free(photon_view *v)
{
    if (!v)
        return;
    stop_wiring(v);
    g_clear_handle_id(&v->telling, g_source_remove);
    held_scene_unref(v->scene);
    photon_cloud_free(v->cloud);
    g_free(v->wire);
    g_free(v->mark_lines);
    g_free(v->mark_points);
    g_free(v);
}

GtkWidget *photon_view_widget(photon_view *v)
{
    return v->area;
}

void photon_view_redraw(photon_view *v)
{
    gtk_gl_area_queue_render(GTK_GL_AREA(v->area));
}

void photon_view_set_scene(photon_view *v, held_scene *scene)
{
    held_scene *held = held_scene_ref(scene);
    held_scene_unref(v->scene);
    v->scene = held;
    stop_wiring(v);
    g_clear_pointer(&v->wire, g_free);
    v->n_wire = 0;
    v->wire_changed = true;
    photon_view_set_cloud(v, NULL);
}

void photon_view_set_cloud(photon_view *v, photon_cloud *cloud)
{
    g_clear_handle_id(&v->drawing, g_source_remove);
    photon_cloud_free(v->cloud);
    v->cloud = cloud;
    if (cloud && cloud->coloring != v->style.coloring)
        photon_cloud_color(cloud, v->style.coloring);
    v->photons_changed = true;
    photon_view_set_marks(v, NULL, 0, NULL, 0);
}

const photon_cloud *photon_view_cloud(const photon_view *v)
{
    return v->cloud;
}

void photon_view_set_style(photon_view *v, const photon_style *style)
{
    bool recolor = v->style.coloring != style->coloring;
    g_clear_handle_id(&v->drawing, g_source_remove);
    v->style = *style;
    if (recolor && v->cloud) {
        photon_cloud_color(v->cloud, style->coloring);
        v->photons_changed = true;
    }
    v->arrows_changed = true;
    photon_view_redraw(v);
}

const photon_style *photon_view_style(const photon_view *v)
{
    return &v->style;
}

void photon_view_set_marks(photon_view *v, const cloud_vertex *lines, size_t n_lines,
                           const cloud_vertex *points, size_t n_points)
{
    v->stale |= (n_lines > 0) != (v->n_mark_lines > 0); /* it fades, or does no more */
    g_free(v->mark_lines);
    g_free(v->mark_points);
    v->mark_lines = g_memdup2(lines, n_lines * sizeof *lines);
    v->mark_points = g_memdup2(points, n_points * sizeof *points);
    v->n_mark_lines = n_lines;
    v->n_mark_points = n_points;
    v->marks_changed = true;
    photon_view_redraw(v);
}

const photon_frame *photon_view_frame(const photon_view *v)
{
    return &v->frame;
}
