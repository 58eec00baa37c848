/*
 * A scene's participating media: adding them, and ways through them.
 */
#include "scene/scene_media.h"

#include "scene/advance.h"
#include "scene/scene_commit.h"

/* Media without bounds end at so many radii of a sphere around scene and camera. */
#define MEDIA_REACH 2.0f

int scene_add_medium(scene *s, const char *name, const char *kind, const params *p,
                     GError **error)
{
    if (!scene_may_change(s, error))
        return NO_INDEX;
    LISTENER_TELL(s, medium, name, kind, p);
    medium *m = medium_new(name, kind, p, error);
    if (!m)
        return NO_INDEX;
    m->index = (int)s->media->len;
    g_ptr_array_add(s->media, m);
    g_hash_table_insert(s->medium_names, g_strdup(name), GINT_TO_POINTER(m->index + 1));
    return m->index;
}

int scene_find_medium(const scene *s, const char *name)
{
    int found = GPOINTER_TO_INT(g_hash_table_lookup(s->medium_names, name));
    return found ? found - 1 : NO_INDEX;
}

static const char *name_of(const scene *s, uint32_t number)
{
    const medium *m = scene_medium(s, number);
    return m ? m->name : NULL;
}

void scene_set_medium_interface(scene *s, int inside, int outside)
{
    const medium_interface around = {(uint32_t)(inside + 1), (uint32_t)(outside + 1)};
    if (around.inside == s->around.inside && around.outside == s->around.outside)
        return;
    s->around = around;
    LISTENER_TELL(s, medium_interface, name_of(s, around.inside),
                  name_of(s, around.outside));
}

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
