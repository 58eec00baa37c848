/*
 * A soft environment and a view that frames the scene, for files without lights or
 * camera.
 *
 * The view comes from the front, a little from the side and above, as a photographer
 * stands before a still life, as near as all of it is seen.
 */
#include "format/defaults.h"

#include "base/intern.h"
#include "format/given.h"
#include "light/light.h"
#include "math/frame.h"
#include "scene/scene_geometry.h"

#include <math.h>
#include <string.h>

#define DEFAULT_FOV 35.0 /* degrees, of the shorter side */

enum { DEFAULT_WIDTH = 960, DEFAULT_HEIGHT = 720, ENVIRONMENT_ROWS = 64 };

static params *list(const char *path)
{
    g_autofree char *absolute = g_canonicalize_filename(path, NULL);
    g_autofree char *directory = g_path_get_dirname(absolute);
    return params_new((source_place){intern(path), 0, 0}, directory, color_space_srgb());
}

/* Local z is up. */
static transform upright(vec3 up)
{
    frame f = frame_from_normal(up);
    double m[4][4] = {{0}};
    for (int i = 0; i < 3; i++) {
        m[i][0] = (double)f.s[i];
        m[i][1] = (double)f.t[i];
        m[i][2] = (double)f.n[i];
    }
    m[3][3] = 1.0;
    transform out;
    return transform_from_matrix((const double(*)[4])m, &out) ? out
                                                              : transform_identity();
}

/* Radiance from a direction: a bright haze over a dark ground, bluer further up, and a
 * soft sun (a cloud before it) behind the camera's left shoulder. */
static void environment_color(vec3 d, vec3 up, vec3 sun, float rgb[3])
{
    static const float ground[3] = {0.22f, 0.21f, 0.2f}, haze[3] = {0.95f, 0.97f, 1.0f},
                       zenith[3] = {0.3f, 0.42f, 0.62f}, glow[3] = {14.0f, 12.8f, 11.0f};
    float height = dot3(d, up), off = acosf(clampf(dot3(d, sun), -1.0f, 1.0f));
    float above = clampf(0.5f + 12.0f * height, 0.0f, 1.0f);
    float rise = sqrtf(clampf(height, 0.0f, 1.0f)), near = expf(-square(off / 0.25f));
    for (int i = 0; i < 3; i++)
        rgb[i] =
            lerpf(ground[i], lerpf(haze[i], zenith[i], rise), above) + near * glow[i];
}

/* A PFM file, whose rows go up from the lower one. Row 0 of the map is +z, columns go
 * round from +x. */
static GBytes *environment_picture(const transform *to_world, vec3 up, vec3 sun)
{
    g_autofree char *header =
        g_strdup_printf("PF\n%d %d\n%s\n", 2 * ENVIRONMENT_ROWS, ENVIRONMENT_ROWS,
                        G_BYTE_ORDER == G_LITTLE_ENDIAN ? "-1.0" : "1.0");
    GByteArray *bytes = g_byte_array_new();
    g_byte_array_append(bytes, (const guint8 *)header, (guint)strlen(header));
    for (int y = ENVIRONMENT_ROWS - 1; y >= 0; y--)
        for (int x = 0; x < 2 * ENVIRONMENT_ROWS; x++) {
            float theta = PI_F * ((float)y + 0.5f) / ENVIRONMENT_ROWS, rgb[3];
            float phi = PI_F * ((float)x + 0.5f) / ENVIRONMENT_ROWS;
            vec3 d =
                vec3_make(sinf(theta) * cosf(phi), sinf(theta) * sinf(phi), cosf(theta));
            environment_color(transform_vector(to_world, d), up, sun, rgb);
            g_byte_array_append(bytes, (const guint8 *)rgb, sizeof rgb);
        }
    return g_byte_array_free_to_bytes(bytes);
}

/* From where the camera looks: from the front, a little from the right and above. */
static vec3 standpoint(vec3 up, float right, float above)
{
    vec3 side = vec3_make(1.0f, 0.0f, 0.0f);
    if (fabsf(up[0]) > 0.5f)
        side = vec3_make(0.0f, 0.0f, 1.0f);
    return normalize3(cross3(side, up) + right * side + above * up);
}

static bool add_environment(scene_builder *to, const char *path, vec3 up, GError **error)
{
    transform to_world = upright(up);
    g_autofree char *name = g_strdup_printf("%s.environment.pfm", path);
    g_autofree char *absolute = g_canonicalize_filename(name, NULL);
    g_autoptr(GBytes) picture =
        environment_picture(&to_world, up, standpoint(up, -0.8f, 1.1f));
    g_autoptr(params) p = list(path);
    build_context_add_file(&to->build, absolute, picture);
    give_text(p, PARAM_STRING, "filename", absolute);
    log_message(
        &to->build.log, LOG_NOTE, "%s: no %s in it; a soft environment is added", path,
        to->scene->lights->len > 0 ? "light, only what glows a little," : "light");
    return builder_add_light(to, "infinite", p, &to_world, error);
}

static bool set_film(scene_builder *to, const char *path, GError **error)
{
    g_autoptr(params) p = list(path);
    give_integer(p, "xresolution", DEFAULT_WIDTH);
    give_integer(p, "yresolution", DEFAULT_HEIGHT);
    return builder_set_film(to, "rgb", p, error);
}

/* How far back from the centre a view has to stand so that a box is in it. */
static double distance_to_frame(box3 box, const transform *to_camera)
{
    double half = tan(0.5 * DEFAULT_FOV * G_PI / 180.0), far = 0.0;
    double aspect = (double)DEFAULT_WIDTH / DEFAULT_HEIGHT;
    for (int k = 0; k < 8; k++) {
        vec3 corner =
            vec3_make(k & 1 ? box.high[0] : box.low[0], k & 2 ? box.high[1] : box.low[1],
                      k & 4 ? box.high[2] : box.low[2]);
        vec3 c = transform_vector(to_camera, corner - box3_center(box));
        double across = MAX(fabs((double)c[0]) / aspect, fabs((double)c[1]));
        far = MAX(far, 1.06 * across / half - (double)c[2]);
    }
    return far;
}

/* Our right is the camera's right, where pbrt's camera, in a world of its own hand, looks
 * into a mirror. */
static bool look_from(vec3 from, vec3 at, vec3 up, transform *out)
{
    const transform mirror = transform_scale(-1.0, 1.0, 1.0);
    double eye[3], target[3], upward[3];
    for (int i = 0; i < 3; i++) {
        eye[i] = (double)from[i];
        target[i] = (double)at[i];
        upward[i] = (double)up[i];
    }
    if (!transform_look_at(eye, target, upward, out))
        return false;
    *out = transform_multiply(&mirror, out);
    return true;
}

static bool add_view(scene_builder *to, const char *path, vec3 up, GError **error)
{
    box3 box = scene_world_bounds(to->scene);
    vec3 toward = standpoint(up, 0.4f, 0.3f), center = box3_center(box);
    transform look;
    bool done = look_from(toward, vec3_make(0.0f, 0.0f, 0.0f), up, &look);
    float distance = (float)distance_to_frame(box, &look);
    if (!(distance > 0.0f)) /* all is in one place */
        distance = 1.0f;
    if (!done || !look_from(center + distance * toward, center, up, &look)) {
        error_at(error, (source_place){intern(path), 0, 0},
                 "the scene is too large to be looked at");
        return false;
    }
    look = transform_inverse(&look);
    g_autoptr(params) p = list(path);
    give_float(p, "fov", DEFAULT_FOV);
    log_message(&to->build.log, LOG_NOTE,
                "%s: no camera in it; one that frames it is added", path);
    return set_film(to, path, error) &&
           builder_set_camera(to, "perspective", p, &look, error);
}

/* ---- Whether there is light ---- */

/* Of a white environment's light, as much as surfaces that shine must send out to be
 * lights. */
#define LEAST_GLOW 0.01

/* Luminance times area times steradian: of white surfaces of radiance 1, pi times their
 * area. */
static double luminous_power(const light *l)
{
    enum { N = 4 };
    double sum = 0.0;
    for (int i = 0; i < N; i++) {
        const wavelengths w = wavelengths_at(((float)i + 0.5f) / N);
        float xyz[3];
        spectrum_to_xyz(&w, l->kind->power(l->self, &w), xyz);
        sum += (double)xyz[1] / N;
    }
    return sum;
}

static bool is_lit(const scene_builder *to, bool glow_is_look)
{
    const box3 box = scene_world_bounds(to->scene);
    double glow = 0.0, radius = 0.5 * (double)length3(box.high - box.low);
    for (guint i = 0; i < to->scene->lights->len; i++) {
        const light *l = to->scene->lights->pdata[i];
        if (l->kind->is_delta || l->kind->is_environment)
            return true;
        glow += luminous_power(l);
    }
    /* A environment of radiance 1 sends pi through each square metre of a sphere. */
    double environment = G_PI * 4.0 * G_PI * radius * radius;
    return !glow_is_look && glow > 0.0 && glow >= LEAST_GLOW * environment;
}

bool scene_complete(scene_builder *to, const char *path, vec3 up, bool glow_is_look,
                    GError **error)
{
    if (to->scene->shapes->len == 0) {
        error_at(error, (source_place){intern(path), 0, 0},
                 "expected something with a surface, found nothing");
        return false;
    }
    bool done = (is_lit(to, glow_is_look) || add_environment(to, path, up, error)) &&
                (to->has_camera || add_view(to, path, up, error));
    to->film.is_unexposed = true;
    return done;
}
