#include "scene/view.h"

#include "scene/scene_media.h"

view *view_share(const view *v)
{
    view *other = g_memdup2(v, sizeof *v); /* size and camera are plain values in it */
    other->owned = NULL;
    return other;
}

void view_free(view *v)
{
    if (!v)
        return;
    if (v->owned) {
        filter_clear(&v->filter);
        g_free(v->film.filename);
        scene_free(v->owned);
    }
    g_free(v);
}

/* ---- What follows from camera and film ---- */

/* By two rays half a pixel apart: with several samples a pixel each has to see no more.
 */
static void find_pixel_width(view *v)
{
    vec2 middle = {0.5f * (float)v->film.width, 0.5f * (float)v->film.height};
    ray a = camera_ray(&v->camera, middle, (vec2){0.5f, 0.5f}, 0.5f);
    middle.x += 0.5f;
    ray b = camera_ray(&v->camera, middle, (vec2){0.5f, 0.5f}, 0.5f);
    v->pixel_width = length3(b.origin - a.origin);
    v->pixel_spread = length3(b.direction - a.direction);
}

/* The participating medium is the one where the file put the camera, as changed by the
   interfaces on the straight line. */
static uint32_t medium_at_eye(const view *v)
{
    const camera *c = &v->camera;
    vec3 from = c->medium_at, to = transform_point(&c->to_world, (vec3){0}) - from;
    ray segment = {
        .origin = from, .t_max = length3(to), .media.participating = c->medium_there};
    if (!scene_has_media(v->scene) || !(segment.t_max > 0.0f) || !isfinite(segment.t_max))
        return c->medium_there;
    segment.direction = to / segment.t_max;
    return scene_medium_behind(v->scene, segment);
}

void view_resize(view *v, int width, int height)
{
    v->film.width = width;
    v->film.height = height;
    camera_resize(&v->camera, width, height);
    find_pixel_width(v);
}

void view_place_camera(view *v, const motion *to_world)
{
    camera *c = &v->camera;
    c->path = *to_world;
    c->to_world = motion_at(to_world, c->begin + (double)c->shutter_open);
    find_pixel_width(v);
    c->media = scene_solids_at(v->scene, transform_point(&c->to_world, (vec3){0}));
    c->media.participating = medium_at_eye(v);
}
