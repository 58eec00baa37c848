/*
 * What a scene is made of, for those who point at it: surfaces and materials.
 */
#include "api/objects.h"

static const char *name_of(const material *m)
{
    return m->name ? m->name : m->kind->name;
}

bool neph_scene_pick(const NephScene *s, const double origin[3],
                     const double direction[3], NephSurfacePoint *out)
{
    ray r = {.t_max = INFINITY};
    surface_hit hit;
    for (int i = 0; i < 3; i++) {
        r.origin[i] = (float)origin[i];
        r.direction[i] = (float)direction[i];
    }
    r.direction = normalize3(r.direction);
    if (!view_see(s->view, &r, &hit))
        return false;
    const shape *on = s->scene->shapes->pdata[hit.shape];
    const vec3 n = face_forward(hit.n_geom, -r.direction);
    *out = (NephSurfacePoint){.distance = (double)hit.t,
                              .shape = hit.shape,
                              .shape_kind = on->kind->name,
                              .material = hit.material,
                              .material_name = "",
                              .file = on->place.file,
                              .line = on->place.line};
    if (hit.material != NO_INDEX)
        out->material_name = name_of(s->scene->materials->pdata[hit.material]);
    for (int i = 0; i < 3; i++) {
        out->position[i] = (double)hit.p[i];
        out->normal[i] = (double)n[i];
    }
    return true;
}

size_t neph_scene_n_materials(const NephScene *s)
{
    return s->scene->materials->len;
}

const char *neph_scene_material_name(const NephScene *s, size_t i)
{
    return i < s->scene->materials->len ? name_of(s->scene->materials->pdata[i]) : NULL;
}

const char *neph_scene_material_kind(const NephScene *s, size_t i)
{
    const material *m =
        i < s->scene->materials->len ? s->scene->materials->pdata[i] : NULL;
    return m ? m->kind->name : NULL;
}
