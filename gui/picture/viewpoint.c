#include "picture/viewpoint.h"

#include <math.h>
#include <string.h>

/* The view never looks closer to straight up or down than this, rad. */
#define POLE_MARGIN 0.02

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = a[j] * b[k] - a[k] * b[j];
    }
}

static void add(double a[3], double t, const double b[3])
{
    for (int i = 0; i < 3; i++)
        a[i] += t * b[i];
}

static double distance(const double a[3], const double b[3])
{
    double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return sqrt(dot(d, d));
}

static void make_unit(double v[3])
{
    double length = sqrt(dot(v, v));
    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

/* v turned about a unit axis (Rodrigues). */
static void rotate(double v[3], const double axis[3], double angle)
{
    double across[3], along = dot(axis, v) * (1.0 - cos(angle));
    cross(axis, v, across);
    for (int i = 0; i < 3; i++)
        v[i] = v[i] * cos(angle) + across[i] * sin(angle) + axis[i] * along;
}

static void right_of(const NephCamera *c, double right[3])
{
    cross(c->up, c->direction, right);
    for (int i = 0; i < 3; i++)
        right[i] *= c->mirrored ? -1.0 : 1.0;
}

/* Up again perpendicular to the direction, and level. */
static void level(viewpoint *v)
{
    NephCamera *c = &v->camera;
    memcpy(c->up, v->up, sizeof c->up);
    add(c->up, -dot(v->up, c->direction), c->direction);
    make_unit(c->up);
}

static void snap_up(viewpoint *v)
{
    int axis = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(v->camera.up[i]) > fabs(v->camera.up[axis]))
            axis = i;
    memset(v->up, 0, sizeof v->up);
    v->up[axis] = v->camera.up[axis] < 0.0 ? -1.0 : 1.0;
}

void viewpoint_init(viewpoint *v, const NephCamera *camera, const double low[3],
                    const double high[3])
{
    double ahead = 1.0;
    *v = (viewpoint){.camera = *camera, .extent = 1.0};
    snap_up(v);
    if (low) {
        double middle[3];
        for (int i = 0; i < 3; i++)
            middle[i] = 0.5 * (low[i] + high[i]) - camera->position[i];
        v->extent = fmax(distance(low, high), 1e-6);
        ahead = fmax(dot(middle, camera->direction), 0.05 * v->extent);
    }
    memcpy(v->pivot, camera->position, sizeof v->pivot);
    add(v->pivot, ahead, camera->direction);
}

/* How far the view may still be turned up by `up` without passing the pole. */
static double allowed_up(const viewpoint *v, double up)
{
    double height = asin(fmin(fmax(dot(v->camera.direction, v->up), -1.0), 1.0));
    double most = G_PI_2 - POLE_MARGIN;
    return fmin(fmax(height + up, -most), most) - height;
}

/* Signs such that positive angles turn to the right and up in the picture. */
static void turn(viewpoint *v, double right, double up)
{
    NephCamera *c = &v->camera;
    double axis[3], hand = c->mirrored ? -1.0 : 1.0;
    right_of(c, axis);
    rotate(c->direction, axis, -hand * allowed_up(v, up));
    rotate(c->direction, v->up, hand * right);
    make_unit(c->direction);
    level(v);
}

void viewpoint_look(viewpoint *v, double right, double up)
{
    double ahead = distance(v->pivot, v->camera.position);
    turn(v, right, up);
    memcpy(v->pivot, v->camera.position, sizeof v->pivot);
    add(v->pivot, ahead, v->camera.direction);
}

/* The pivot keeps its place in the picture: the camera goes where it is seen as before.
 */
void viewpoint_orbit(viewpoint *v, double right, double up)
{
    NephCamera *c = &v->camera;
    double axes[3][3], to_pivot[3], along[3];
    for (int i = 0; i < 3; i++)
        to_pivot[i] = v->pivot[i] - c->position[i];
    right_of(c, axes[0]);
    memcpy(axes[1], c->up, sizeof axes[1]);
    memcpy(axes[2], c->direction, sizeof axes[2]);
    for (int k = 0; k < 3; k++)
        along[k] = dot(to_pivot, axes[k]);
    turn(v, right, up);
    right_of(c, axes[0]);
    memcpy(c->position, v->pivot, sizeof c->position);
    add(c->position, -along[0], axes[0]);
    add(c->position, -along[1], c->up);
    add(c->position, -along[2], c->direction);
}

void viewpoint_pan(viewpoint *v, double right, double up)
{
    const NephCamera *c = &v->camera;
    double height = (c->screen[3] - c->screen[2]) * distance(v->pivot, c->position);
    viewpoint_fly(v, right * height, up * height, 0.0);
}

void viewpoint_dolly(viewpoint *v, double factor)
{
    NephCamera *c = &v->camera;
    double away[3];
    for (int i = 0; i < 3; i++)
        away[i] = c->position[i] - v->pivot[i];
    if (sqrt(dot(away, away)) * factor < 1e-4 * v->extent)
        return;
    memcpy(c->position, v->pivot, sizeof c->position);
    add(c->position, factor, away);
}

void viewpoint_fly(viewpoint *v, double right, double up, double forward)
{
    NephCamera *c = &v->camera;
    double axis[3], step[3] = {0};
    right_of(c, axis);
    add(step, right, axis);
    add(step, up, c->up);
    add(step, forward, c->direction);
    add(c->position, 1.0, step);
    add(v->pivot, 1.0, step);
}

void viewpoint_set_pivot(viewpoint *v, const double pivot[3])
{
    memcpy(v->pivot, pivot, sizeof v->pivot);
}

void viewpoint_frame(viewpoint *v, const double low[3], const double high[3])
{
    NephCamera *c = &v->camera;
    double shorter = fmin(c->screen[1] - c->screen[0], c->screen[3] - c->screen[2]);
    double away = 0.5 * distance(low, high) * (1.0 + 2.0 / shorter);
    for (int i = 0; i < 3; i++)
        v->pivot[i] = 0.5 * (low[i] + high[i]);
    memcpy(c->position, v->pivot, sizeof c->position);
    add(c->position, -away, c->direction);
}
