/*
 * The solids of a scene. Only where something absorbs are they followed at all: then
 * clear glass is one too, since it displaces what it stands in.
 *
 * Whether the camera or a lamp is inside a solid is found by leaving: a ray to the
 * outside crosses its surface from behind once more often than from the front.
 */
#include "scene/scene_solids.h"

#include <string.h>

enum { N_WAYS = 3, MOST_CROSSINGS = 1000 };

/* ---- Which there are ---- */

static bool anything_absorbs(const scene *s)
{
    for (guint i = 0; i < s->materials->len; i++)
        if (material_interior(s->materials->pdata[i]))
            return true;
    return false;
}

/* The most that instances of an object grow it. */
static float *object_scales(const scene *s)
{
    float *scales = g_new0(float, MAX(s->objects->len, 1));
    for (guint i = 0; i < s->instances->len; i++) {
        const instance *is = &g_array_index(s->instances, instance, i);
        transform at = motion_at(&is->to_world, (double)s->camera.shutter_open);
        float scale = sqrtf((float)instance_mean_area_factor(&at));
        scales[is->object] = maxf(scales[is->object], scale);
    }
    return scales;
}

static void find_interiors(scene *s)
{
    g_autofree float *scales = object_scales(s);
    s->interiors = g_new0(interior, s->materials->len);
    for (guint i = 0; i < s->shapes->len; i++) {
        shape *on = s->shapes->pdata[i];
        const material *of =
            on->material == NO_INDEX ? NULL : s->materials->pdata[on->material];
        if (!of || !(material_interior(of) || material_encloses(of)))
            continue;
        interior *in = &s->interiors[on->material];
        float scale = on->object == NO_INDEX ? 1.0f : scales[on->object];
        box3 box = on->kind->bounds(on->self);
        in->medium = material_interior(of);
        in->size = maxf(in->size, scale * length3(box.high - box.low));
        on->interior = in;
    }
}

/* ---- What stands in them ---- */

/* Crossings on the way out: from the front counts up, from behind down. */
static solids left_on_the_way(const scene *s, vec3 p, vec3 direction)
{
    g_autofree int *entered = g_new0(int, s->materials->len);
    solids found = {0};
    ray r = {.origin = p, .direction = direction, .t_max = INFINITY, .time = 0.5f};
    surface_hit hit;
    for (int i = 0; i < MOST_CROSSINGS && scene_intersect_solid(s, &r, &hit); i++) {
        if (hit.interior && !hit.from_inside)
            entered[hit.material]++;
        else if (hit.interior && entered[hit.material]-- <= 0) {
            found = solids_enter(found, hit.interior);
            entered[hit.material] = 0;
        }
        r = hit_ray(&hit, direction);
    }
    return found;
}

static bool is_among(const solids *all, const interior *in, int n)
{
    for (int i = 0; i < SOLIDS_MOST && in; i++)
        n -= all->of[i] == in;
    return n <= 0;
}

solids scene_solids_at(const scene *s, vec3 p)
{
    /* Along no axis and no plane of symmetry, and not all to one side. */
    static const vec3 ways[N_WAYS] = {{0.2711f, 0.5023f, 0.8211f},
                                      {-0.7517f, 0.5531f, -0.3593f},
                                      {0.3469f, -0.8363f, -0.4246f}};
    solids found[N_WAYS], most = {0};
    if (!s->interiors)
        return most;
    for (int i = 0; i < N_WAYS; i++)
        found[i] = left_on_the_way(s, p, normalize3(ways[i]));
    for (int i = 0; i < N_WAYS - 1; i++)
        for (int k = 0; k < SOLIDS_MOST && found[i].of[k]; k++) {
            const interior *in = found[i].of[k];
            if (!is_among(&most, in, 1) && is_among(&found[0], in, 1) +
                                                   is_among(&found[1], in, 1) +
                                                   is_among(&found[2], in, 1) >=
                                               2)
                most = solids_enter(most, in);
        }
    return most;
}

/* Where a lamp's photons start; of lamps that are not beyond the scene. */
static solids solids_of_light(const scene *s, const light *l)
{
    const wavelengths w = wavelengths_at(0.5f);
    const vec2 middle = {0.5f, 0.5f};
    light_emission e = {0};
    if (l->kind->is_environment || l->kind->is_parallel)
        return (solids){0};
    l->kind->emit(l->self, &w, 0.5f, middle, (vec2){0.4f, 0.3f}, &e);
    return finite3(e.ray.origin) ? scene_solids_at(s, e.ray.origin) : (solids){0};
}

void scene_find_eye_solids(scene *s)
{
    transform at = motion_at(&s->camera.path, (double)s->camera.shutter_open);
    const transform *to_world = s->camera.path.moves ? &at : &s->camera.to_world;
    s->camera.solids =
        scene_solids_at(s, transform_point(to_world, vec3_make(0.0f, 0.0f, 0.0f)));
}

void scene_find_solids(scene *s)
{
    s->interiors = NULL;
    s->camera.solids = (solids){0};
    if (!anything_absorbs(s))
        return;
    find_interiors(s);
    scene_find_eye_solids(s);
    for (guint i = 0; i < s->lights->len; i++) {
        light *l = s->lights->pdata[i];
        l->solids = solids_of_light(s, l);
    }
}
