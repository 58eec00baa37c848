/*
 * The view of a scene as a plain value, for those who move it: the inverse of what pbrt's
 * LookAt and Camera directives say.
 *
 *   camera.to_world = [right | up | direction | position],  right = ± up × direction
 *
 * The columns of a scene's matrix need not be unit (a Scale before LookAt): lengths along
 * the axis are taken along, so that the focal distance is in metres of the world.
 */
#include "api/objects.h"

#include <math.h>
#include <string.h>

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = a[j] * b[k] - a[k] * b[j];
    }
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* @return the length before. */
static double make_unit(double v[3])
{
    double length = sqrt(dot(v, v));
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return length;
}

static bool is_kind(const NephCamera *c, const char *kind)
{
    return g_strcmp0(c->kind, kind) == 0;
}

/* What a spherical camera sees ahead. */
static void screen_ahead(const camera *c, NephCamera *out)
{
    double aspect = (double)c->width / (double)c->height;
    double x = fmax(aspect, 1.0), y = fmax(1.0 / aspect, 1.0);
    const double screen[4] = {-x, x, -y, y};
    memcpy(out->screen, screen, sizeof screen);
    out->fov = 90.0;
}

static void right_of(const NephCamera *c, double right[3])
{
    cross(c->up, c->direction, right);
    for (int i = 0; i < 3; i++)
        right[i] *= c->mirrored ? -1.0 : 1.0;
}

void neph_scene_camera(const NephScene *s, NephCamera *out)
{
    const camera *c = &s->view->camera;
    const transform at = camera_at(c, 0.0f);
    double right[3], along;
    out->kind = camera_kind_name(c);
    for (int i = 0; i < 3; i++) {
        out->position[i] = at.m[i][3];
        out->direction[i] = at.m[i][2];
        right[i] = at.m[i][0];
    }
    out->mirrored = transform_swaps_handedness(&at);
    along = make_unit(out->direction);
    cross(out->direction, right, out->up);
    make_unit(out->up);
    for (int i = 0; i < 3; i++)
        out->up[i] *= out->mirrored ? -1.0 : 1.0;
    for (int i = 0; i < 4; i++)
        out->screen[i] = (double)c->screen[i];
    out->fov = 360.0 / G_PI * atan((double)c->half_screen);
    if (is_kind(out, "spherical"))
        screen_ahead(c, out);
    out->lens_radius = (double)c->lens_radius * along;
    out->focal_distance = (double)c->focal_distance * along;
}

static bool refuse(const char *why, GError **error)
{
    error_set(error, ERROR_USAGE, "camera: expected %s", why);
    return false;
}

static bool is_finite(const double *values, int n)
{
    bool good = true;
    for (int i = 0; i < n; i++)
        good &= isfinite(values[i]);
    return good;
}

static bool check(const NephCamera *c, GError **error)
{
    if (!is_finite(c->position, 3) || !is_finite(c->direction, 3) || !is_finite(c->up, 3))
        return refuse("finite coordinates", error);
    if (!(c->fov > 0.0 && c->fov < 180.0))
        return refuse("a field of view between 0 and 180 degrees", error);
    if (!(c->lens_radius >= 0.0 && isfinite(c->lens_radius)))
        return refuse("a lens radius of 0 or more", error);
    if (!(c->focal_distance > 0.0 && isfinite(c->focal_distance)))
        return refuse("a focal distance greater than 0", error);
    return true;
}

/* The matrix [right | up | direction | position]; false if the directions span no space.
 */
static bool place(const NephCamera *c, transform *out)
{
    NephCamera unit = *c;
    double right[3], m[4][4] = {{0}};
    make_unit(unit.direction);
    cross(unit.up, unit.direction, right);
    if (!(make_unit(right) > 1e-9 * sqrt(dot(c->up, c->up))))
        return false;
    cross(unit.direction, right, unit.up);
    right_of(&unit, right);
    for (int i = 0; i < 3; i++) {
        m[i][0] = right[i];
        m[i][1] = unit.up[i];
        m[i][2] = unit.direction[i];
        m[i][3] = unit.position[i];
    }
    m[3][3] = 1.0;
    return transform_from_matrix((const double(*)[4])m, out);
}

bool neph_scene_set_camera(NephScene *s, const NephCamera *c, GError **error)
{
    camera *to = &s->view->camera;
    transform to_world;
    if (!check(c, error))
        return false;
    if (!place(c, &to_world))
        return refuse("a direction and another one for up", error);
    if (strcmp(camera_kind_name(to), "spherical") != 0)
        to->half_screen = (float)tan(G_PI / 360.0 * c->fov);
    to->lens_radius = (float)c->lens_radius;
    to->focal_distance = (float)c->focal_distance;
    camera_resize(to, to->width, to->height);
    const motion still = motion_still(&to_world);
    view_place_camera(s->view, &still);
    return true;
}

void neph_camera_set_fov(NephCamera *c, double degrees)
{
    double ratio = tan(G_PI / 360.0 * degrees) / tan(G_PI / 360.0 * c->fov);
    for (int i = 0; i < 4; i++)
        c->screen[i] *= ratio;
    c->fov = degrees;
}

/* Camera space to world: along right, up and direction. */
static void turn_to_world(const NephCamera *c, const double at[3], double out[3])
{
    double right[3];
    right_of(c, right);
    for (int i = 0; i < 3; i++)
        out[i] = at[0] * right[i] + at[1] * c->up[i] + at[2] * c->direction[i];
}

void neph_camera_ray(const NephCamera *c, double x, double y, double origin[3],
                     double direction[3])
{
    const double *s = c->screen;
    double on_screen[2] = {s[0] + x * (s[1] - s[0]), s[3] + y * (s[2] - s[3])};
    double from[3] = {0}, toward[3] = {on_screen[0], on_screen[1], 1.0};
    if (is_kind(c, "orthographic")) {
        memcpy(from, on_screen, sizeof on_screen);
        toward[0] = toward[1] = 0.0;
    } else if (is_kind(c, "spherical")) {
        toward[0] = sin(G_PI * y) * cos(2.0 * G_PI * x);
        toward[1] = cos(G_PI * y);
        toward[2] = sin(G_PI * y) * sin(2.0 * G_PI * x);
    }
    turn_to_world(c, from, origin);
    turn_to_world(c, toward, direction);
    for (int i = 0; i < 3; i++)
        origin[i] += c->position[i];
    make_unit(direction);
}

bool neph_camera_project(const NephCamera *c, const double point[3], double *x, double *y)
{
    const double *s = c->screen;
    double right[3], to[3];
    right_of(c, right);
    for (int i = 0; i < 3; i++)
        to[i] = point[i] - c->position[i];
    double depth = dot(to, c->direction);
    double scale = is_kind(c, "orthographic") ? 1.0 : depth;
    *x = (dot(to, right) / scale - s[0]) / (s[1] - s[0]);
    *y = (dot(to, c->up) / scale - s[3]) / (s[2] - s[3]);
    return depth > 0.0;
}

bool neph_scene_bounds(const NephScene *s, double low[3], double high[3])
{
    const box3 *bounds = &s->scene->bounds;
    if (box3_is_empty(*bounds))
        return false;
    for (int i = 0; i < 3; i++) {
        low[i] = (double)bounds->low[i];
        high[i] = (double)bounds->high[i];
    }
    return true;
}
