#include "panels/lobe_view.h"

#include "widgets/widgets.h"

#include <math.h>
#include <string.h>

enum { DIRECTIONS = 720 };

static const double colors[3][3] = {
    {0.86, 0.25, 0.25}, {0.2, 0.66, 0.3}, {0.22, 0.48, 0.9}};

struct lobe_view {
    GtkWidget *root, *material, *incidence, *area, *facts;
    held_scene *scene;
    NephBsdfPlot *plot;
    bool showing;
};

/* ---- Drawing ---- */

/* The middle of the diagram and the radius of its outer circle, pixels. */
typedef struct dial {
    double x, y, radius;
} dial;

static void place(const dial *d, double degrees, double r, double at[2])
{
    double a = degrees * G_PI / 180.0;
    at[0] = d->x + r * d->radius * sin(a);
    at[1] = d->y - r * d->radius * cos(a);
}

static double largest(const NephBsdfPlot *plot)
{
    double most = 0.0;
    for (size_t i = 0; i < 3 * plot->n; i++)
        most = fmax(most, (double)plot->rgb[i]);
    return most;
}

static void draw_line(cairo_t *cr, const dial *d, double degrees, double from, double to)
{
    double a[2], b[2];
    place(d, degrees, from, a);
    place(d, degrees, to, b);
    cairo_move_to(cr, a[0], a[1]);
    cairo_line_to(cr, b[0], b[1]);
    cairo_stroke(cr);
}

static void draw_frame(cairo_t *cr, const dial *d, GdkRGBA ink)
{
    ink.alpha = 0.18f;
    gdk_cairo_set_source_rgba(cr, &ink);
    cairo_set_line_width(cr, 1.0);
    for (int i = 1; i <= 4; i++) {
        cairo_arc(cr, d->x, d->y, d->radius * i / 4.0, 0.0, 2.0 * G_PI);
        cairo_stroke(cr);
    }
    draw_line(cr, d, 0.0, 0.0, 1.05);
    ink.alpha = 0.8f;
    gdk_cairo_set_source_rgba(cr, &ink);
    cairo_set_line_width(cr, 2.0);
    draw_line(cr, d, 90.0, -1.1, 1.1);
}

static void draw_curve(cairo_t *cr, const dial *d, const NephBsdfPlot *plot, int k,
                       double scale)
{
    double at[2];
    for (size_t i = 0; i < plot->n; i++) {
        place(d, 360.0 * (double)i / (double)plot->n,
              scale * (double)plot->rgb[3 * i + (size_t)k], at);
        cairo_line_to(cr, at[0], at[1]);
    }
    cairo_close_path(cr);
    cairo_set_source_rgba(cr, colors[k][0], colors[k][1], colors[k][2], 0.10);
    cairo_fill_preserve(cr);
    cairo_set_source_rgb(cr, colors[k][0], colors[k][1], colors[k][2]);
    cairo_set_line_width(cr, 2.0);
    cairo_stroke(cr);
}

static void draw_word(cairo_t *cr, double x, double y, double align, const char *word)
{
    cairo_text_extents_t size;
    cairo_text_extents(cr, word, &size);
    cairo_move_to(cr, x - align * size.width, y);
    cairo_show_text(cr, word);
}

/* Which curve is which, and where the light and the normal are. */
static void draw_words(cairo_t *cr, const dial *d, const NephBsdfPlot *plot, GdkRGBA ink)
{
    static const char *const names[3] = {"red", "green", "blue"};
    double light[2];
    cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr, 13.0);
    for (int k = 0; k < 3; k++) {
        double y = d->y + 0.8 * d->radius + 18.0 * k;
        cairo_set_source_rgb(cr, colors[k][0], colors[k][1], colors[k][2]);
        cairo_rectangle(cr, d->x - 1.1 * d->radius, y - 6.0, 18.0, 4.0);
        cairo_fill(cr);
        gdk_cairo_set_source_rgba(cr, &ink);
        draw_word(cr, d->x - 1.1 * d->radius + 26.0, y, 0.0, names[k]);
    }
    draw_word(cr, d->x, d->y - 1.08 * d->radius, 0.5, "normal");
    if (!plot)
        return;
    place(d, -plot->incidence, 1.14, light);
    draw_word(cr, light[0], light[1], plot->incidence > 10.0 ? 1.0 : 1.6, "light");
}

static void draw_ray(cairo_t *cr, const dial *d, const NephBsdfRay *one)
{
    cairo_set_line_width(cr, 3.0);
    for (int k = 0; k < 3; k++) {
        cairo_set_source_rgb(cr, colors[k][0], colors[k][1], colors[k][2]);
        draw_line(cr, d, one->angle + 0.8 * (k - 1), 0.0, (double)one->rgb[k]);
    }
}

static void draw(GtkDrawingArea *area, cairo_t *cr, int width, int height, void *data)
{
    const lobe_view *v = data;
    const dial d = {0.5 * width, 0.5 * height, 0.42 * MIN(width, height)};
    GdkRGBA ink;
    gtk_style_context_get_color(gtk_widget_get_style_context(GTK_WIDGET(area)), &ink);
    draw_frame(cr, &d, ink);
    draw_words(cr, &d, v->plot, ink);
    if (!v->plot)
        return;
    double most = largest(v->plot);
    cairo_set_source_rgb(cr, 0.9, 0.7, 0.1);
    cairo_set_line_width(cr, 4.0);
    draw_line(cr, &d, -v->plot->incidence, 0.0, 1.1);
    for (int k = 0; k < 3 && most > 0.0; k++)
        draw_curve(cr, &d, v->plot, k, 1.0 / most);
    for (size_t i = 0; i < v->plot->n_rays; i++)
        draw_ray(cr, &d, &v->plot->rays[i]);
}

/* ---- What is drawn ---- */

static void show_facts(lobe_view *v)
{
    GString *text = g_string_new(NULL);
    double most = v->plot ? largest(v->plot) : 0.0;
    if (most > 0.0)
        g_string_append_printf(text, "Outer circle: %.3g per steradian. ", most);
    for (size_t i = 0; v->plot && i < v->plot->n_rays; i++) {
        const NephBsdfRay *one = &v->plot->rays[i];
        bool below = one->angle > 90.0 && one->angle < 270.0;
        g_string_append_printf(text,
                               "%s: %.1f %% of red, %.1f %% of green, %.1f %% of "
                               "blue. ",
                               below ? "Refracted" : "Mirrored",
                               100.0 * (double)one->rgb[0], 100.0 * (double)one->rgb[1],
                               100.0 * (double)one->rgb[2]);
    }
    gtk_label_set_text(GTK_LABEL(v->facts), text->str);
    g_string_free(text, TRUE);
}

static void update(lobe_view *v)
{
    if (v->showing || !v->scene)
        return;
    guint i = gtk_drop_down_get_selected(GTK_DROP_DOWN(v->material));
    neph_bsdf_plot_free(v->plot);
    v->plot =
        neph_bsdf_plot(v->scene->scene, i, gtk_range_get_value(GTK_RANGE(v->incidence)),
                       DIRECTIONS, NULL);
    show_facts(v);
    gtk_widget_queue_draw(v->area);
}

static char *material_title(const NephScene *scene, size_t i)
{
    const char *name = neph_scene_material_name(scene, i);
    const char *kind = neph_scene_material_kind(scene, i);
    return strcmp(name, kind) == 0 ? g_strdup_printf("%s %zu", kind, i + 1)
                                   : g_strdup_printf("%s (%s)", name, kind);
}

void lobe_view_set_scene(lobe_view *v, held_scene *scene)
{
    held_scene *held = held_scene_ref(scene);
    held_scene_unref(v->scene);
    v->scene = held;
    g_autoptr(GtkStringList) words = gtk_string_list_new(NULL);
    for (size_t i = 0; i < neph_scene_n_materials(scene->scene); i++) {
        g_autofree char *title = material_title(scene->scene, i);
        gtk_string_list_append(words, title);
    }
    v->showing = true;
    gtk_drop_down_set_model(GTK_DROP_DOWN(v->material), G_LIST_MODEL(words));
    v->showing = false;
    update(v);
}

bool lobe_view_choose(lobe_view *v, const char *material)
{
    size_t n = v->scene ? neph_scene_n_materials(v->scene->scene) : 0;
    for (size_t i = 0; i < n; i++)
        if (strcmp(neph_scene_material_name(v->scene->scene, i), material) == 0) {
            gtk_drop_down_set_selected(GTK_DROP_DOWN(v->material), (guint)i);
            return true;
        }
    return false;
}

void lobe_view_choose_number(lobe_view *v, unsigned i)
{
    gtk_drop_down_set_selected(GTK_DROP_DOWN(v->material), i);
}

char *lobe_view_svg(const lobe_view *v)
{
    guint i = gtk_drop_down_get_selected(GTK_DROP_DOWN(v->material));
    const char *name = v->scene ? neph_scene_material_name(v->scene->scene, i) : NULL;
    return v->plot && name ? neph_bsdf_plot_svg(v->plot, name) : NULL;
}

/* ---- Building ---- */

static GtkWidget *tools_make(lobe_view *v)
{
    static const char *const none[] = {NULL};
    GtkWidget *tools = box_make(GTK_ORIENTATION_VERTICAL, 6, 12);
    GtkWidget *first = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 12);
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 12);
    v->material = choice_make(none);
    v->incidence = slider_make(0.0, 89.0, 1.0, 0);
    gtk_range_set_value(GTK_RANGE(v->incidence), 45.0);
    gtk_widget_set_hexpand(v->incidence, TRUE);
    widget_name(v->material, "Material");
    widget_name(v->incidence, "Angle of incidence, degrees from the normal");
    gtk_widget_set_hexpand(v->material, TRUE);
    gtk_box_append(GTK_BOX(first), gtk_label_new("Material"));
    gtk_box_append(GTK_BOX(first), v->material);
    gtk_box_append(GTK_BOX(first),
                   text_button_make("Save…", "The diagram as SVG", "win.save-diagram"));
    gtk_box_append(GTK_BOX(box), gtk_label_new("Angle of incidence (°)"));
    gtk_box_append(GTK_BOX(box), v->incidence);
    gtk_box_append(GTK_BOX(tools), first);
    gtk_box_append(GTK_BOX(tools), box);
    g_signal_connect_swapped(v->material, "notify::selected", G_CALLBACK(update), v);
    g_signal_connect_swapped(v->incidence, "value-changed", G_CALLBACK(update), v);
    return tools;
}

lobe_view *lobe_view_new(void)
{
    lobe_view *v = g_new0(lobe_view, 1);
    v->root = gtk_box_new(GTK_ORIENTATION_VERTICAL, 0);
    v->area =
        drawing_make("How the material scatters light, for red, green and blue", draw, v);
    gtk_widget_set_hexpand(v->area, TRUE);
    gtk_widget_set_vexpand(v->area, TRUE);
    v->facts = gtk_label_new("");
    gtk_label_set_wrap(GTK_LABEL(v->facts), TRUE);
    gtk_widget_add_css_class(v->facts, "dim-label");
    gtk_widget_set_margin_bottom(v->facts, 12);
    gtk_box_append(GTK_BOX(v->root), tools_make(v));
    gtk_box_append(GTK_BOX(v->root), v->area);
    gtk_box_append(GTK_BOX(v->root), v->facts);
    return v;
}

void lobe_view_free(lobe_view *v)
{
    if (!v)
        return;
    held_scene_unref(v->scene);
    neph_bsdf_plot_free(v->plot);
    g_free(v);
}

GtkWidget *lobe_view_widget(lobe_view *v)
{
    return v->root;
}
