#include "photon_view.h"

#include "gl_layer.h"
#include "widgets.h"

#include <epoxy/gl.h>
#include <math.h>
#include <string.h>

/* Line segments of a wireframe, at most. */
enum { MOST_EDGES = 200000 };

/* Length of an arrow, as share of the scene's extent. */
#define ARROW_SHARE 0.05f

struct photon_view {
    GtkWidget *area;
    const viewpoint *view;
    photon_style style;
    photon_cloud *cloud;
    cloud_vertex *wire, *mark_lines, *mark_points;
    size_t n_wire, n_mark_lines, n_mark_points;
    gl_painter painter;
    gl_layer wire_layer, photon_layer, arrow_layer, line_layer, point_layer;
    bool wire_changed, photons_changed, arrows_changed, marks_changed;
    double frame_time;
};

/* ---- Matrices ---- */

/* What the widget shows at distance 1: the picture's screen, widened to its shape. */
static void shown_screen(const photon_view *v, double screen[4])
{
    const double *s = v->view->camera.screen;
    double width = s[1] - s[0], height = s[3] - s[2];
    double shape = fmax(gtk_widget_get_width(v->area), 1.0) /
                   fmax(gtk_widget_get_height(v->area), 1.0);
    double wide = fmax(1.0, shape * height / width);
    double tall = fmax(1.0, width / (shape * height));
    double x = 0.5 * (s[0] + s[1]), y = 0.5 * (s[2] + s[3]);
    screen[0] = x - 0.5 * wide * width;
    screen[1] = x + 0.5 * wide * width;
    screen[2] = y - 0.5 * tall * height;
    screen[3] = y + 0.5 * tall * height;
}

void photon_view_place(const photon_view *v, double wx, double wy, double place[2])
{
    const double *s = v->view->camera.screen;
    double shown[4];
    shown_screen(v, shown);
    double x =
        shown[0] + wx / fmax(gtk_widget_get_width(v->area), 1.0) * (shown[1] - shown[0]);
    double y =
        shown[3] + wy / fmax(gtk_widget_get_height(v->area), 1.0) * (shown[2] - shown[3]);
    place[0] = (x - s[0]) / (s[1] - s[0]);
    place[1] = (y - s[3]) / (s[2] - s[3]);
}

double photon_view_scale(const photon_view *v)
{
    const double *s = v->view->camera.screen;
    double shown[4];
    shown_screen(v, shown);
    return gtk_widget_get_height(v->area) * (s[3] - s[2]) / (shown[3] - shown[2]);
}

/* Rows of the camera: right, up, direction. */
static void camera_rows(const NephCamera *c, double rows[3][3])
{
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        double right = c->up[j] * c->direction[k] - c->up[k] * c->direction[j];
        rows[0][i] = c->mirrored ? -right : right;
        rows[1][i] = c->up[i];
        rows[2][i] = c->direction[i];
    }
}

/* From rays through a point to parallel ones. */
static void flatten(double m[4][4], double near, double far, const double shift[2])
{
    for (int i = 0; i < 4; i++) {
        double z = m[3][i], one = i == 3 ? 1.0 : 0.0;
        m[0][i] += shift[0] * (one - z);
        m[1][i] += shift[1] * (one - z);
        m[2][i] = 2.0 / (far - near) * z - one * (far + near) / (far - near);
        m[3][i] = one;
    }
}

/* World to clip space, column by column. */
static void clip_matrix(const photon_view *v, float out[16])
{
    const NephCamera *c = &v->view->camera;
    double rows[3][3], s[4], near = 1e-3 * v->view->extent, far = 30.0 * v->view->extent;
    camera_rows(c, rows);
    shown_screen(v, s);
    const double scale[2] = {2.0 / (s[1] - s[0]), 2.0 / (s[3] - s[2])};
    const double shift[2] = {-(s[1] + s[0]) / (s[1] - s[0]),
                             -(s[3] + s[2]) / (s[3] - s[2])};
    double m[4][4], at[3] = {0};
    for (int r = 0; r < 3; r++)
        for (int i = 0; i < 3; i++)
            at[r] -= rows[r][i] * c->position[i];
    for (int i = 0; i < 4; i++) {
        double x = i < 3 ? rows[0][i] : at[0], y = i < 3 ? rows[1][i] : at[1],
               z = i < 3 ? rows[2][i] : at[2];
        m[0][i] = scale[0] * x + shift[0] * z;
        m[1][i] = scale[1] * y + shift[1] * z;
        m[2][i] = (far + near) / (far - near) * z -
                  (i == 3 ? 2.0 * far * near / (far - near) : 0.0);
        m[3][i] = z;
    }
    if (g_strcmp0(c->kind, "orthographic") == 0)
        flatten(m, near, far, shift);
    for (int r = 0; r < 4; r++)
        for (int i = 0; i < 4; i++)
            out[4 * i + r] = (float)m[r][i];
}

/* ---- Drawing ---- */

static bool shows_arrows(const photon_view *v)
{
    return v->cloud && photon_cloud_count(v->cloud, v->style.maps) < MOST_ARROWS;
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

static void upload(photon_view *v)
{
    if (v->wire_changed)
        gl_layer_set(&v->wire_layer, v->wire, v->n_wire);
    if (v->photons_changed)
        gl_layer_set(&v->photon_layer, v->cloud ? v->cloud->vertices : NULL,
                     v->cloud ? v->cloud->n : 0);
    if (v->arrows_changed || v->photons_changed)
        upload_arrows(v);
    if (v->marks_changed) {
        gl_layer_set(&v->line_layer, v->mark_lines, v->n_mark_lines);
        gl_layer_set(&v->point_layer, v->mark_points, v->n_mark_points);
    }
    v->wire_changed = v->photons_changed = v->arrows_changed = v->marks_changed = false;
}

static void draw_photons(photon_view *v)
{
    bool arrows = shows_arrows(v);
    float size = v->style.point_size * (float)gtk_widget_get_scale_factor(v->area);
    if (!v->cloud)
        return;
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++)
        if (v->style.maps & (1u << c))
            gl_layer_points(&v->painter, &v->photon_layer, v->cloud->first[c],
                            v->cloud->first[c + 1] - v->cloud->first[c],
                            arrows ? fmaxf(size, 4.0f) : size);
    if (arrows)
        gl_layer_lines(&v->painter, &v->arrow_layer, 1.0f);
}

static gboolean render(GtkGLArea *area, GdkGLContext *context, photon_view *v)
{
    (void)context;
    static const float background[3] = {0.10f, 0.10f, 0.11f};
    float matrix[16];
    if (gtk_gl_area_get_error(area) || !v->painter.program)
        return FALSE;
    gint64 start = g_get_monotonic_time();
    upload(v);
    clip_matrix(v, matrix);
    gl_painter_begin(&v->painter, matrix, background);
    if (v->style.wireframe)
        gl_layer_lines(&v->painter, &v->wire_layer, 0.55f);
    draw_photons(v);
    glDisable(GL_DEPTH_TEST);
    gl_layer_lines(&v->painter, &v->line_layer, 1.0f);
    gl_layer_points(&v->painter, &v->point_layer, 0, v->point_layer.n, 5.0f);
    glFinish();
    v->frame_time = 1e-6 * (double)(g_get_monotonic_time() - start);
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
    gtk_gl_area_make_current(area);
    if (gtk_gl_area_get_error(area))
        return;
    for (size_t i = 0; i < G_N_ELEMENTS(layers); i++)
        gl_layer_clear(layers[i]);
    gl_painter_clear(&v->painter);
}

/* ---- The view ---- */

photon_view *photon_view_new(const viewpoint *view)
{
    photon_view *v = g_new0(photon_view, 1);
    v->view = view;
    v->style = (photon_style){.maps = 7, .point_size = 2.0f, .wireframe = true};
    v->area = gtk_gl_area_new();
    gtk_gl_area_set_has_depth_buffer(GTK_GL_AREA(v->area), TRUE);
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
    size_t n;
    g_autofree float *ends = neph_scene_wireframe(scene->scene, MOST_EDGES, &n);
    g_free(v->wire);
    v->n_wire = 2 * n;
    v->wire = g_new(cloud_vertex, v->n_wire);
    for (size_t i = 0; i < v->n_wire; i++) {
        memcpy(v->wire[i].position, ends + 3 * i, sizeof v->wire[i].position);
        memset(v->wire[i].color, 200, sizeof v->wire[i].color);
    }
    v->wire_changed = true;
    photon_view_set_cloud(v, NULL);
}

void photon_view_set_cloud(photon_view *v, photon_cloud *cloud)
{
    photon_cloud_free(v->cloud);
    v->cloud = cloud;
    if (cloud)
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
    g_free(v->mark_lines);
    g_free(v->mark_points);
    v->mark_lines = g_memdup2(lines, n_lines * sizeof *lines);
    v->mark_points = g_memdup2(points, n_points * sizeof *points);
    v->n_mark_lines = n_lines;
    v->n_mark_points = n_points;
    v->marks_changed = true;
    photon_view_redraw(v);
}

double photon_view_frame_time(const photon_view *v)
{
    return v->frame_time;
}
