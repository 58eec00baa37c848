#include "photons/projection.h"

#include <glib.h>
#include <math.h>

/* What the widget shows at distance 1: the picture's screen, widened to its shape. */
static void shown_screen(const projection *p, double screen[4])
{
    const double *s = p->view->camera.screen;
    double width = s[1] - s[0], height = s[3] - s[2];
    double shape = fmax(p->width, 1.0) / fmax(p->height, 1.0);
    double wide = fmax(1.0, shape * height / width);
    double tall = fmax(1.0, width / (shape * height));
    double x = 0.5 * (s[0] + s[1]), y = 0.5 * (s[2] + s[3]);
    screen[0] = x - 0.5 * wide * width;
    screen[1] = x + 0.5 * wide * width;
    screen[2] = y - 0.5 * tall * height;
    screen[3] = y + 0.5 * tall * height;
}

void projection_place(const projection *p, double wx, double wy, double place[2])
{
    const double *s = p->view->camera.screen;
    double shown[4];
    shown_screen(p, shown);
    double x = shown[0] + wx / fmax(p->width, 1.0) * (shown[1] - shown[0]);
    double y = shown[3] + wy / fmax(p->height, 1.0) * (shown[2] - shown[3]);
    place[0] = (x - s[0]) / (s[1] - s[0]);
    place[1] = (y - s[3]) / (s[2] - s[3]);
}

void projection_widget(const projection *p, const double place[2], double *wx, double *wy)
{
    const double *s = p->view->camera.screen;
    double shown[4];
    shown_screen(p, shown);
    double x = s[0] + place[0] * (s[1] - s[0]), y = s[3] + place[1] * (s[2] - s[3]);
    *wx = (x - shown[0]) / (shown[1] - shown[0]) * p->width;
    *wy = (y - shown[3]) / (shown[2] - shown[3]) * p->height;
}

double projection_scale(const projection *p)
{
    const double *s = p->view->camera.screen;
    double shown[4];
    shown_screen(p, shown);
    return p->height * (s[3] - s[2]) / (shown[3] - shown[2]);
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
void projection_matrix(const projection *p, float out[16])
{
    const NephCamera *c = &p->view->camera;
    double rows[3][3], s[4], near = 1e-3 * p->view->extent, far = 30.0 * p->view->extent;
    camera_rows(c, rows);
    shown_screen(p, s);
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
