/*
 * A scene's participating media: adding them, and ways through them.
 */
#include "scene/scene_media.h"

#include "scene/scene_commit.h"

/* Media without bounds end at so many radii of a sphere around scene and camera. */
#define MEDIA_REACH 2.0f

/* A way crosses no more surfaces than this: a guard against endless loops only. */
enum { MOST_CROSSINGS = 10000 };

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

static const medium *medium_at(const scene *s, int index)
{
    return index == NO_INDEX ? NULL : s->media->pdata[index];
}

static const char *name_of(const medium *m)
{
    return m ? m->name : NULL;
}

void scene_set_medium_interface(scene *s, int inside, int outside)
{
    const medium_interface around = {medium_at(s, inside), medium_at(s, outside)};
    if (around.inside == s->around.inside && around.outside == s->around.outside)
        return;
    s->around = around;
    LISTENER_TELL(s, medium_interface, name_of(around.inside), name_of(around.outside));
}

/* Takes a ray to the next surface on its way, and behind it.
   @return how far that was; INFINITY: it meets none */
static float cross(const scene *s, ray *r)
{
    surface_hit hit;
    if (!scene_intersect_solid(s, r, &hit))
        return INFINITY;
    float left = r->t_max - hit.t;
    *r = hit_ray(&hit, r->direction);
    r->t_max = left;
    return hit.t;
}

/* Where a line leaves the sphere at which media end; < 0: it does not meet it, or before
   the ray starts. *enters gets where it comes in. */
static float sphere_end(const scene *s, const ray *r, float *enters)
{
    vec3 to = s->center - r->origin;
    float middle = dot3(to, r->direction);
    float d2 = length3_2(to - middle * r->direction);
    float half2 = s->media_radius * s->media_radius - d2;
    float half = sqrtf(maxf(half2, 0.0f));
    *enters = middle - half;
    return half2 > 0.0f ? middle + half : -1.0f;
}

float scene_medium_end(const scene *s, const ray *r, float length)
{
    float enters;
    return isfinite(length) ? length : maxf(sphere_end(s, r, &enters), 0.0f);
}

void scene_come_from_outside(const scene *s, ray *r)
{
    float enters;
    r->medium = s->outer_medium;
    if (r->medium && sphere_end(s, r, &enters) > 0.0f && enters > 0.0f)
        r->origin += enters * r->direction;
}

spectrum scene_transmittance(const scene *s, const ray *r, const wavelengths *w)
{
    spectrum out = spectrum_fill(1.0f);
    ray left = *r;
    for (int i = 0; i < MOST_CROSSINGS && scene_has_media(s); i++) {
        const medium *through = left.medium;
        const ray way = left;
        float t = cross(s, &left);
        if (through)
            out *= medium_transmittance(through,
                                        scene_medium_end(s, &way, minf(t, way.t_max)), w);
        if (isinf(t) || spectrum_is_black(out))
            break;
    }
    return out;
}

const medium *scene_medium_behind(const scene *s, ray r)
{
    for (int i = 0; i < MOST_CROSSINGS && isfinite(cross(s, &r)); i++)
        continue;
    return r.medium;
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
                     .medium = c->medium_there};
    s->outer_medium = scene_medium_behind(s, way);
    s->media_radius = MEDIA_REACH * maxf(s->radius, distance);
}

void scene_find_eye_medium(scene *s)
{
    camera *c = &s->camera;
    vec3 from = c->medium_at, to = transform_point(&c->to_world, (vec3){0}) - from;
    ray way = {.origin = from, .t_max = length3(to), .medium = c->medium_there};
    c->medium = c->medium_there;
    if (!scene_has_media(s) || !(way.t_max > 0.0f) || !isfinite(way.t_max))
        return;
    way.direction = to / way.t_max;
    c->medium = scene_medium_behind(s, way);
}
