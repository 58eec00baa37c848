/*
 * A scene's participating media, and ways through them.
 */
#include "scene/scene_media.h"

#include "scene/advance.h"

/* Media without bounds end at so many radii of a sphere around scene and camera. */
#define MEDIA_REACH 2.0f

uint32_t scene_medium_behind(const scene *s, ray r)
{
    surface_hit hit;
    for (int i = 0; i < MOST_CROSSINGS && scene_cross(s, &r, &hit); i++)
        continue;
    return r.media.participating;
}

void scene_find_outer_medium(scene *s)
{
    camera *c = &s->camera;
    vec3 away = c->medium_at - s->center;
    float distance = length3(away);
    const ray way = {.origin = c->medium_at,
                     .direction =
                         distance > 0.0f ? away / distance : (vec3){0.0f, 0.0f, 1.0f},
                     .t_max = INFINITY,
                     .media.participating = c->medium_there};
    s->outer_medium = scene_medium_behind(s, way);
    s->media_radius = MEDIA_REACH * maxf(s->radius, distance);
}

void scene_find_eye_medium(scene *s)
{
    camera *c = &s->camera;
    vec3 from = c->medium_at, to = transform_point(&c->to_world, (vec3){0}) - from;
    ray way = {
        .origin = from, .t_max = length3(to), .media.participating = c->medium_there};
    c->media.participating = c->medium_there;
    if (!scene_has_media(s) || !(way.t_max > 0.0f) || !isfinite(way.t_max))
        return;
    way.direction = to / way.t_max;
    c->media.participating = scene_medium_behind(s, way);
}
