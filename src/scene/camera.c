/*
 * pbrt's perspective camera: the field of view spans the shorter side of a screen at
 * z = 1, whose longer side follows the film's (or a given) aspect ratio.
 *
 *   raster (0, 0) ─────► x           camera space: x right, y up, z forward
 *          │   film                  (left-handed; to_world may mirror, and does in pbrt)
 *          ▼ y
 */
#include "scene/camera.h"

#include "math/warp.h"

#include <string.h>

/* ---- parameters ---- */

static bool check(bool good, const params *p, const char *name, const char *expected,
                  GError **error)
{
    if (good)
        return true;
    error_at(error, params_find(p, name)->place, "\"%s\" must be %s", name, expected);
    return false;
}

static bool read_optics(camera *c, const params *p, GError **error)
{
    float fov = 90.0f;
    if (!params_float(p, "fov", &fov, error) ||
        !check(fov > 0.0f && fov < 180.0f, p, "fov", "between 0 and 180 degrees",
               error) ||
        !params_float(p, "lensradius", &c->lens_radius, error) ||
        !check(c->lens_radius >= 0.0f, p, "lensradius", "0 or more", error) ||
        !params_float(p, "focaldistance", &c->focal_distance, error) ||
        !check(c->focal_distance > 0.0f, p, "focaldistance", "greater than 0", error))
        return false;
    c->half_screen = (float)tan(G_PI / 360.0 * (double)fov);
    return true;
}

static bool read_shutter(camera *c, const params *p, GError **error)
{
    return params_float(p, "shutteropen", &c->shutter_open, error) &&
           params_float(p, "shutterclose", &c->shutter_close, error) &&
           check(c->shutter_close >= c->shutter_open, p,
                 params_has(p, "shutterclose") ? "shutterclose" : "shutteropen",
                 "such that the shutter opens before it closes", error);
}

static bool read_window(camera *c, const params *p, GError **error)
{
    float aspect = 0.0f;
    if (!params_float(p, "frameaspectratio", &aspect, error) ||
        !check(aspect > 0.0f || !params_has(p, "frameaspectratio"), p, "frameaspectratio",
               "greater than 0", error))
        return false;
    c->aspect = aspect;
    const param *window = params_find(p, "screenwindow");
    if (!window)
        return true;
    const float *w = window->numbers;
    bool four = window->type == PARAM_FLOAT && window->n == 4;
    if (!check(four && w[0] < w[1] && w[2] < w[3] && isfinite(w[1] - w[0]) &&
                   isfinite(w[3] - w[2]),
               p, "screenwindow", "four floats: x_min < x_max, y_min < y_max", error))
        return false;
    memcpy(c->window, w, sizeof c->window);
    c->has_window = true;
    return true;
}

bool camera_init(camera *c, const char *kind, const params *p, const transform *to_world,
                 int width, int height, GError **error)
{
    if (strcmp(kind, "perspective") != 0) {
        error_at(error, p->place, "camera \"%s\" is not supported; known is perspective",
                 kind);
        return false;
    }
    camera made = {.to_world = *to_world, .focal_distance = 1e6f, .shutter_close = 1.0f};
    if (!read_optics(&made, p, error) || !read_shutter(&made, p, error) ||
        !read_window(&made, p, error) ||
        !params_all_used(p, "camera \"perspective\"", error))
        return false;
    camera_resize(&made, width, height);
    *c = made;
    return true;
}

void camera_resize(camera *c, int width, int height)
{
    c->width = width;
    c->height = height;
    float aspect = c->aspect > 0.0f ? c->aspect : (float)width / (float)height;
    float x = maxf(aspect, 1.0f), y = maxf(1.0f / aspect, 1.0f);
    const float fitted[4] = {-x, x, -y, y};
    for (int i = 0; i < 4; i++)
        c->screen[i] = c->half_screen * (c->has_window ? c->window[i] : fitted[i]);
}

/* ---- rays ---- */

ray camera_ray(const camera *c, vec2 raster, vec2 u_lens, float u_time)
{
    const float *s = c->screen;
    vec3 origin = {0};
    vec3 direction = vec3_make(lerpf(s[0], s[1], raster.x / (float)c->width),
                               lerpf(s[3], s[2], raster.y / (float)c->height), 1.0f);
    if (c->lens_radius > 0.0f) {
        vec2 lens = warp_disk(u_lens);
        origin = vec3_make(c->lens_radius * lens.x, c->lens_radius * lens.y, 0.0f);
        direction = c->focal_distance * direction - origin;
    }
    return (ray){
        .origin = transform_point(&c->to_world, origin),
        .direction = normalize3(transform_vector(&c->to_world, normalize3(direction))),
        .t_max = INFINITY,
        .time = lerpf(c->shutter_open, c->shutter_close, u_time),
    };
}

float camera_pixel_area(const camera *c, float z)
{
    const float *s = c->screen;
    float x = (s[1] - s[0]) / (float)c->width, y = (s[3] - s[2]) / (float)c->height;
    return x * y * z * z;
}

bool camera_project(const camera *c, vec3 p, vec2 *raster)
{
    transform to_camera = transform_inverse(&c->to_world);
    vec3 q = transform_point(&to_camera, p);
    if (!(q[2] > 0.0f))
        return false;
    const float *s = c->screen;
    raster->x = (q[0] / q[2] - s[0]) / (s[1] - s[0]) * (float)c->width;
    raster->y = (s[3] - q[1] / q[2]) / (s[3] - s[2]) * (float)c->height;
    return true;
}

/* ---- connections ---- */

/* A direction v = M d with d = (x, y, 1) in camera space turns by dω = |det M| dx
   dy/|v|³. The lens does not change that: its rays of equal d meet in a point of the
   plane in focus. */
float camera_pdf_direction(const camera *c, vec3 direction)
{
    const float *s = c->screen;
    transform to_camera = transform_inverse(&c->to_world);
    const double(*m)[4] = c->to_world.m;
    vec3 d = transform_vector(&to_camera, direction);
    if (!(d[2] > 0.0f))
        return 0.0f;
    double det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                 m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                 m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    float pixel = (s[1] - s[0]) * (s[3] - s[2]) / ((float)c->width * (float)c->height);
    float length = 1.0f / d[2];
    return length * length * length / ((float)fabs(det) * pixel);
}

bool camera_connect(const camera *c, vec3 p, vec2 u_lens, camera_connection *out)
{
    const float *s = c->screen;
    transform to_camera = transform_inverse(&c->to_world);
    vec3 q = transform_point(&to_camera, p), origin = {0};
    if (!(q[2] > 0.0f))
        return false;
    if (c->lens_radius > 0.0f) {
        vec2 lens = warp_disk(u_lens);
        origin = vec3_make(c->lens_radius * lens.x, c->lens_radius * lens.y, 0.0f);
    }
    /* Where the ray from the lens crosses z = 1, if the lens were a pinhole. */
    vec3 d = (q - origin) / q[2] + origin / c->focal_distance;
    vec3 to = transform_point(&c->to_world, origin) - p;
    out->distance = length3(to);
    out->direction = to / out->distance;
    out->raster.x = (d[0] - s[0]) / (s[1] - s[0]) * (float)c->width;
    out->raster.y = (s[3] - d[1]) / (s[3] - s[2]) * (float)c->height;
    out->pdf = camera_pdf_direction(c, -out->direction);
    return out->distance > 0.0f && out->pdf > 0.0f;
}
