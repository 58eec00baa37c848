/*
 * The polar diagram of a material as SVG: a curve each for red, green and blue, the light
 * that comes in, arrows for what is mirrored or refracted.
 */
#include "api/objects.h"

#include <math.h>

enum { SIDE = 640, MIDDLE = SIDE / 2, RADIUS = 250, TOP = 40, LONGEST_TITLE = 60 };

static const char *const colors[] = {"#d43a3a", "#2f9e44", "#2f6fd4"};
static const char *const names[] = {"red", "green", "blue"};

static void put_number(GString *out, double value)
{
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    g_string_append(out, g_ascii_formatd(text, sizeof text, "%.6g", value));
}

/* A place at an angle from the normal, in pixels. */
static void put_place(GString *out, double degrees, double radius)
{
    double a = degrees * G_PI / 180.0;
    put_number(out, MIDDLE + radius * sin(a));
    g_string_append_c(out, ' ');
    put_number(out, TOP + MIDDLE - radius * cos(a));
}

static double largest(const NephBsdfPlot *plot)
{
    double most = 0.0;
    for (size_t i = 0; i < 3 * plot->n; i++)
        most = fmax(most, (double)plot->rgb[i]);
    return most;
}

static void put_frame(GString *out, const char *title)
{
    bool is_long = g_utf8_strlen(title, -1) > LONGEST_TITLE;
    g_autofree char *begin = g_utf8_substring(title, 0, is_long ? LONGEST_TITLE : -1);
    g_autofree char *shown = g_strconcat(begin, is_long ? "…" : "", NULL);
    g_autofree char *escaped = g_markup_escape_text(shown, -1);
    g_string_append_printf(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" "
        "font-family=\"sans-serif\" font-size=\"15\">\n"
        "<rect width=\"100%%\" height=\"100%%\" fill=\"#ffffff\"/>\n"
        "<text x=\"%d\" y=\"28\" text-anchor=\"middle\" font-size=\"19\">%s</text>\n",
        SIDE, SIDE + 2 * TOP, MIDDLE, escaped);
    for (int i = 1; i <= 4; i++)
        g_string_append_printf(out,
                               "<circle cx=\"%d\" cy=\"%d\" r=\"%d\" fill=\"none\" "
                               "stroke=\"#dddddd\"/>\n",
                               MIDDLE, TOP + MIDDLE, RADIUS * i / 4);
    g_string_append_printf(out,
                           "<path d=\"M %d %d H %d\" stroke=\"#555555\" "
                           "stroke-width=\"2\"/>\n"
                           "<path d=\"M %d %d V %d\" stroke=\"#999999\" "
                           "stroke-dasharray=\"4 4\"/>\n",
                           MIDDLE - RADIUS - 20, TOP + MIDDLE, MIDDLE + RADIUS + 20,
                           MIDDLE, TOP + MIDDLE, TOP + MIDDLE - RADIUS - 10);
}

static void put_curve(GString *out, const NephBsdfPlot *plot, int k, double scale)
{
    g_string_append_printf(out,
                           "<path class=\"%s\" fill=\"%s\" fill-opacity=\"0.08\" "
                           "stroke=\"%s\" stroke-width=\"2\" d=\"",
                           names[k], colors[k], colors[k]);
    for (size_t i = 0; i < plot->n; i++) {
        g_string_append(out, i ? " L " : "M ");
        put_place(out, 360.0 * (double)i / (double)plot->n,
                  scale * (double)plot->rgb[3 * i + (size_t)k]);
    }
    g_string_append(out, " Z\"/>\n");
}

static void put_line(GString *out, double angle, double from, double to,
                     const char *color, int width)
{
    g_string_append(out, "<path d=\"M ");
    put_place(out, angle, from);
    g_string_append(out, " L ");
    put_place(out, angle, to);
    g_string_append_printf(out, "\" fill=\"none\" stroke=\"%s\" stroke-width=\"%d\"/>\n",
                           color, width);
}

/* Three lines side by side in angle, as long as their share. */
static void put_ray(GString *out, const NephBsdfRay *one)
{
    for (int k = 0; k < 3; k++)
        put_line(out, one->angle + 0.8 * (k - 1), 0.0, RADIUS * (double)one->rgb[k],
                 colors[k], 3);
}

static void put_legend(GString *out, const NephBsdfPlot *plot, double most)
{
    g_string_append_printf(out, "<text x=\"20\" y=\"%d\">", SIDE + TOP + 20);
    g_string_append(out, "light from ");
    put_number(out, plot->incidence);
    g_string_append(out, "° (yellow)");
    if (most > 0.0) {
        g_string_append(out, "; outer circle: ");
        put_number(out, most);
        g_string_append(out, " sr⁻¹");
    }
    if (plot->n_rays > 0)
        g_string_append(out, "; lines: mirrored or refracted, outer circle: all");
    g_string_append(out, "</text>\n</svg>\n");
}

char *neph_bsdf_plot_svg(const NephBsdfPlot *plot, const char *title)
{
    GString *out = g_string_new(NULL);
    double most = largest(plot);
    put_frame(out, title);
    put_line(out, -plot->incidence, 0.0, RADIUS + 30, "#e0b000", 4);
    for (int k = 0; k < 3 && most > 0.0; k++)
        put_curve(out, plot, k, RADIUS / most);
    for (size_t i = 0; i < plot->n_rays; i++)
        put_ray(out, &plot->rays[i]);
    put_legend(out, plot, most);
    return g_string_free(out, FALSE);
}
