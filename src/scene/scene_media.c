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

void scene_find_outer_medium(scene *s, vec3 from, uint32_t there)
{
    vec3 away = from - s->center;
    float distance = length3(away);
    const ray segment = {.origin = from,
                         .direction =
                             distance > 0.0f ? away / distance : (vec3){0.0f, 0.0f, 1.0f},
                         .t_max = INFINITY,
                         .media.participating = there};
    s->outer_medium = scene_medium_behind(s, segment);
    s->media_radius = MEDIA_REACH * maxf(s->radius, distance);
}

float scene_lit_radius(const scene *s)
{
    const medium *outer = scene_medium(s, s->outer_medium);
    return outer && medium_scatters(outer) ? s->media_radius : s->radius;
}
