/*
 * pbrt's cameras. The perspective one's field of view spans the shorter side of a screen
 * at z = 1, whose longer side follows the film's (or a given) aspect ratio; the
 * orthographic one looks along z from all of its screen; the spherical one sees all
 * directions.
 *
 *   raster (0, 0) ─────► x           camera space: x right, y up, z forward
 *          │   film                  (left-handed; to_world may mirror, and does in pbrt)
 *          ▼ y
 *
 * Depth of field of an orthographic camera is that of a telecentric lens: every place on
 * the screen has a lens of its own. pbrt's rays all leave one lens at the origin there,
 * which makes a perspective picture of it.
 *
 * Equirectangular: θ = π y / height from +y down, φ = 2π x / width around from +x to +z.
 * Equal-area: Clarberg's square (sphere_map.h), with y and z exchanged, as pbrt does.
 */
#include "camera/camera.h"

#include "math/warp.h"
#include "texture/sphere_map.h"

#include <string.h>

/* How a kind of camera works, in camera space. */
struct camera_kind {
    const char *name;
    const char *parameters; /* blank-separated, for the manual */
    bool (*read)(camera *c, const params *p, GError **error);
    /* Origin and direction, not unit, through a place on the film and one on the lens. */
    void (*start)(const camera *c, vec2 raster, vec3 lens, vec3 *origin, vec3 *direction);
    /* Where the film sees q from a place on the lens; false if it does not. */
    bool (*see)(const camera *c, vec3 q, vec3 lens, vec2 *raster);
    /* Pixels per solid angle around a direction of unit length in the world, which is d
       in camera space; without the determinant of to_world. NULL: light can not be
       connected. */
    float (*density)(const camera *c, vec3 d);
    float (*pixel_area)(const camera *c, float z);
    /* camera_repeats, on a film of 1 x 1. NULL: there are none. */
    int (*repeats)(const camera *c, vec2 at, vec2 out[MOST_REPEATS]);
};

/* ---- parameters ---- */

static bool check(bool good, const params *p, const char *name, const char *expected,
                  GError **error)
{
    if (good)
        return true;
    error_at(error, params_find(p, name)->place, "\"%s\" must be %s", name, expected);
    return false;
}

static bool read_lens(camera *c, const params *p, GError **error)
{
    return params_float(p, "lensradius", &c->lens_radius, error) &&
           check(c->lens_radius >= 0.0f, p, "lensradius", "0 or more", error) &&
           params_float(p, "focaldistance", &c->focal_distance, error) &&
           check(c->focal_distance > 0.0f, p, "focaldistance", "greater than 0", error);
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

/* ---- perspective ---- */

static bool read_perspective(camera *c, const params *p, GError **error)
{
    float fov = 90.0f, half = 45.0f;
    bool is_half = params_has(p, "halffov");
    if (!params_float(p, "fov", &fov, error) ||
        !check(fov > 0.0f && fov < 180.0f, p, "fov", "between 0 and 180 degrees",
               error) ||
        !params_float(p, "halffov", &half, error) ||
        !check(half > 0.0f && half < 90.0f, p, "halffov", "between 0 and 90 degrees",
               error) ||
        !read_lens(c, p, error) || !read_window(c, p, error))
        return false;
    c->half_screen =
        (float)tan(is_half ? G_PI / 180.0 * (double)half : G_PI / 360.0 * (double)fov);
    return true;
}

/* The place on the screen. */
static vec3 on_screen(const camera *c, vec2 raster, float z)
{
    const float *s = c->screen;
    return vec3_make(lerpf(s[0], s[1], raster.x / (float)c->width),
                     lerpf(s[3], s[2], raster.y / (float)c->height), z);
}

static vec2 on_film(const camera *c, vec3 screen)
{
    const float *s = c->screen;
    return (vec2){(screen[0] - s[0]) / (s[1] - s[0]) * (float)c->width,
                  (s[3] - screen[1]) / (s[3] - s[2]) * (float)c->height};
}

static float screen_pixel(const camera *c)
{
    const float *s = c->screen;
    return (s[1] - s[0]) * (s[3] - s[2]) / ((float)c->width * (float)c->height);
}

static void start_perspective(const camera *c, vec2 raster, vec3 lens, vec3 *origin,
                              vec3 *direction)
{
    *origin = lens;
    *direction = on_screen(c, raster, 1.0f);
    if (c->lens_radius > 0.0f)
        *direction = c->focal_distance * *direction - lens;
}

static bool see_perspective(const camera *c, vec3 q, vec3 lens, vec2 *raster)
{
    if (!(q[2] > 0.0f))
        return false;
    /* Where the ray from the lens crosses z = 1, if the lens were a pinhole. */
    *raster = on_film(c, (q - lens) / q[2] + lens / c->focal_distance);
    return true;
}

/* The lens changes nothing: its rays of equal d meet in a point of the plane in focus. */
static float density_perspective(const camera *c, vec3 d)
{
    float length = 1.0f / d[2];
    return d[2] > 0.0f ? length * length * length / screen_pixel(c) : 0.0f;
}

static float pixel_area_perspective(const camera *c, float z)
{
    return screen_pixel(c) * z * z;
}

/* ---- orthographic ---- */

static bool read_orthographic(camera *c, const params *p, GError **error)
{
    c->half_screen = 1.0f;
    return read_lens(c, p, error) && read_window(c, p, error);
}

static void start_orthographic(const camera *c, vec2 raster, vec3 lens, vec3 *origin,
                               vec3 *direction)
{
    *origin = on_screen(c, raster, 0.0f) + lens;
    *direction = vec3_make(0.0f, 0.0f, c->focal_distance) - lens;
}

static bool see_orthographic(const camera *c, vec3 q, vec3 lens, vec2 *raster)
{
    (void)lens;
    *raster = on_film(c, q);
    return q[2] > 0.0f;
}

static float pixel_area_orthographic(const camera *c, float z)
{
    (void)z;
    return screen_pixel(c);
}

/* ---- spherical ---- */

static bool read_spherical(camera *c, const params *p, GError **error)
{
    static const char *const mappings[] = {"equalarea", "equirectangular", NULL};
    int mapping = 0;
    if (!params_choice(p, "mapping", mappings, &mapping, error))
        return false;
    c->equal_area = mapping == 0;
    c->half_screen = 1.0f;
    return true;
}

/* The square continues beyond its border turned by half a turn. */
static vec2 wrap_square(vec2 at)
{
    if (at.x < 0.0f || at.x > 1.0f)
        at = (vec2){at.x < 0.0f ? -at.x : 2.0f - at.x, 1.0f - at.y};
    if (at.y < 0.0f || at.y > 1.0f)
        at = (vec2){1.0f - at.x, at.y < 0.0f ? -at.y : 2.0f - at.y};
    return at;
}

static void start_spherical(const camera *c, vec2 raster, vec3 lens, vec3 *origin,
                            vec3 *direction)
{
    *origin = lens;
    vec2 at = {raster.x / (float)c->width, raster.y / (float)c->height};
    if (c->equal_area) {
        vec3 d = equal_area_to_sphere(wrap_square(at));
        *direction = vec3_make(d[0], d[2], d[1]);
        return;
    }
    float theta = PI_F * at.y, phi = 2.0f * PI_F * at.x;
    *direction = vec3_make(sinf(theta) * cosf(phi), cosf(theta), sinf(theta) * sinf(phi));
}

static bool see_spherical(const camera *c, vec3 q, vec3 lens, vec2 *raster)
{
    vec3 d = normalize3(q - lens);
    vec2 at;
    if (c->equal_area) {
        at = equal_area_to_square(vec3_make(d[0], d[2], d[1]));
    } else {
        float phi = atan2f(d[2], d[0]) / (2.0f * PI_F);
        float height = clampf(d[1], -1.0f, 1.0f);
        at = (vec2){phi < 0.0f ? phi + 1.0f : phi, acosf(height) * INV_PI_F};
    }
    *raster = (vec2){at.x * (float)c->width, at.y * (float)c->height};
    return length3_2(q - lens) > 0.0f;
}

static float density_spherical(const camera *c, vec3 d)
{
    float length2 = length3_2(d), sine = sqrtf(d[0] * d[0] + d[2] * d[2]);
    float n = (float)c->width * (float)c->height;
    float length3 = length2 * sqrtf(length2);
    if (c->equal_area)
        return n / (4.0f * PI_F * length3);
    return n * sqrtf(length2) / (2.0f * PI_F * PI_F * sine * length3);
}

static float pixel_area_spherical(const camera *c, float z)
{
    return 4.0f * PI_F * z * z / ((float)c->width * (float)c->height);
}

/* As wrap_square has it: beyond a corner the square goes on as it is. */
static int repeats_of_square(vec2 at, vec2 out[MOST_REPEATS])
{
    int n = 0;
    for (float x = -1.0f; x <= 1.0f; x += 2.0f) {
        out[n++] = (vec2){1.0f + x - at.x, 1.0f - at.y};
        out[n++] = (vec2){1.0f - at.x, 1.0f + x - at.y};
        out[n++] = (vec2){at.x + x, at.y - 1.0f};
        out[n++] = (vec2){at.x + x, at.y + 1.0f};
    }
    return n;
}

/* Around, and over the poles to where it is half a turn further. */
static int repeats_spherical(const camera *c, vec2 at, vec2 out[MOST_REPEATS])
{
    if (c->equal_area)
        return repeats_of_square(at, out);
    int n = 0;
    for (float x = -1.0f; x <= 1.0f; x += 2.0f) {
        out[n++] = (vec2){at.x + x, at.y};
        out[n++] = (vec2){at.x + 0.5f * x, -at.y};
        out[n++] = (vec2){at.x + 0.5f * x, 2.0f - at.y};
    }
    return n;
}

/* ---- all of them ---- */

static const camera_kind kinds[] = {
    {"perspective",
     "fov halffov screenwindow frameaspectratio lensradius focaldistance shutteropen "
     "shutterclose",
     read_perspective, start_perspective, see_perspective, density_perspective,
     pixel_area_perspective, NULL},
    {"orthographic",
     "screenwindow frameaspectratio lensradius focaldistance shutteropen shutterclose",
     read_orthographic, start_orthographic, see_orthographic, NULL,
     pixel_area_orthographic, NULL},
    {"spherical", "mapping shutteropen shutterclose", read_spherical, start_spherical,
     see_spherical, density_spherical, pixel_area_spherical, repeats_spherical},
};

const char *camera_kind_at(size_t i)
{
    return i < G_N_ELEMENTS(kinds) ? kinds[i].name : NULL;
}

const char *camera_kind_parameters(size_t i)
{
    return i < G_N_ELEMENTS(kinds) ? kinds[i].parameters : NULL;
}

static const camera_kind *find_kind(const char *name, const params *p, GError **error)
{
    for (size_t i = 0; i < G_N_ELEMENTS(kinds); i++) {
        if (strcmp(kinds[i].name, name) == 0)
            return &kinds[i];
    }
    error_at(error, p->place,
             "camera \"%s\" is not supported; known are perspective, orthographic and "
             "spherical",
             name);
    return NULL;
}

bool camera_init(camera *c, const char *kind, const params *p, const transform *to_world,
                 int width, int height, GError **error)
{
    camera made = {.kind = find_kind(kind, p, error),
                   .to_world = *to_world,
                   .path = motion_still(to_world),
                   .focal_distance = 1e6f,
                   .shutter_close = 1.0f};
    g_autofree char *what = g_strdup_printf("camera \"%s\"", kind);
    if (!made.kind || !made.kind->read(&made, p, error) ||
        !read_shutter(&made, p, error) || !params_all_used(p, what, error))
        return false;
    camera_resize(&made, width, height);
    *c = made;
    return true;
}

const char *camera_kind_name(const camera *c)
{
    return c->kind->name;
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

transform camera_at(const camera *c, float time)
{
    if (!c->path.moves)
        return c->to_world;
    double from_begin = (double)lerpf(c->shutter_open, c->shutter_close, time);
    return motion_at(&c->path, c->begin + from_begin);
}

static vec3 on_lens(const camera *c, vec2 u_lens)
{
    if (!(c->lens_radius > 0.0f))
        return (vec3){0};
    vec2 lens = warp_disk(u_lens);
    return vec3_make(c->lens_radius * lens.x, c->lens_radius * lens.y, 0.0f);
}

ray camera_ray(const camera *c, vec2 raster, vec2 u_lens, float u_time)
{
    transform to_world = camera_at(c, u_time);
    vec3 origin, direction;
    c->kind->start(c, raster, on_lens(c, u_lens), &origin, &direction);
    return (ray){
        .origin = transform_point(&to_world, origin),
        .direction = normalize3(transform_vector(&to_world, normalize3(direction))),
        .t_max = INFINITY,
        .time = u_time,
        .media = c->media,
    };
}

float camera_pixel_area(const camera *c, float z)
{
    return c->kind->pixel_area(c, z);
}

bool camera_project(const camera *c, vec3 p, vec2 *raster)
{
    transform to_world = camera_at(c, 0.0f), to_camera = transform_inverse(&to_world);
    return c->kind->see(c, transform_point(&to_camera, p), (vec3){0}, raster);
}

int camera_repeats(const camera *c, vec2 raster, vec2 out[MOST_REPEATS])
{
    const vec2 size = {(float)c->width, (float)c->height};
    if (!c->kind->repeats)
        return 0;
    int n = c->kind->repeats(c, (vec2){raster.x / size.x, raster.y / size.y}, out);
    for (int i = 0; i < n; i++)
        out[i] = (vec2){out[i].x * size.x, out[i].y * size.y};
    return n;
}

/* ---- connections ---- */

bool camera_connects(const camera *c)
{
    return c->kind->density != NULL;
}

/* A direction v = M d, v unit, turns by dω = |det M| times what d turns by, over |v|³. */
float camera_pdf_direction(const camera *c, vec3 direction, float time)
{
    const transform to_world = camera_at(c, time);
    transform to_camera = transform_inverse(&to_world);
    const double(*m)[4] = to_world.m;
    double det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                 m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                 m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    vec3 d = transform_vector(&to_camera, direction);
    return c->kind->density(c, d) / (float)fabs(det);
}

bool camera_connect(const camera *c, vec3 p, vec2 u_lens, float time,
                    camera_connection *out)
{
    transform to_world = camera_at(c, time), to_camera = transform_inverse(&to_world);
    vec3 lens = on_lens(c, u_lens), q = transform_point(&to_camera, p);
    if (!c->kind->see(c, q, lens, &out->raster))
        return false;
    vec3 to = transform_point(&to_world, lens) - p;
    out->distance = length3(to);
    out->direction = to / out->distance;
    out->pdf = camera_pdf_direction(c, -out->direction, time);
    return out->distance > 0.0f && out->pdf > 0.0f;
}
