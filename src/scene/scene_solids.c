/*
 * The solids of a scene. Only where something absorbs are they followed at all: then
 * clear glass is one too, since it displaces what it stands in.
 *
 * Whether a camera or a light is inside a solid is found by leaving: a ray to the
 * outside crosses its surface from behind once more often than from the front.
 */
#include "scene/scene_solids.h"

#include "base/wanted.h"
#include "scene/advance.h"

enum { N_WAYS = 3 };

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
    float *scales = g_new0(float, MAX(s->n_objects, 1));
    for (guint i = 0; i < s->instances->len; i++) {
        const instance *is = scene_instance(s, (int)i);
        float scale = sqrtf((float)scene_instance_growth(s, is));
        scales[is->object] = maxf(scales[is->object], scale);
    }
    return scales;
}

/* What a material fills: as large as the largest shape that has it. */
typedef struct filling {
    const medium *medium; /* NULL: clear */
    float size;           /* m; 0: the material bounds no solid */
    int material;
} filling;

static const material *bounding_material(const scene *s, const shape *on)
{
    const material *of =
        on->material == NO_INDEX ? NULL : s->materials->pdata[on->material];
    return of && (material_interior(of) || material_encloses(of)) ? of : NULL;
}

static filling *find_fillings(const scene *s)
{
    g_autofree float *scales = object_scales(s);
    filling *all = g_new0(filling, MAX(s->materials->len, 1));
    for (guint i = 0; i < s->materials->len; i++)
        all[i].material = (int)i;
    for (guint i = 0; i < s->shapes->len; i++) {
        const shape *on = s->shapes->pdata[i];
        const material *of = bounding_material(s, on);
        if (!of)
            continue;
        filling *in = &all[on->material];
        float scale = on->object == NO_INDEX ? 1.0f : scales[on->object];
        box3 box = on->kind->bounds(on->self);
        in->medium = material_interior(of);
        in->size = maxf(in->size, scale * length3(box.high - box.low));
    }
    return all;
}

static int by_size(const void *a, const void *b)
{
    const filling *x = a, *y = b;
    int order = (x->size > y->size) - (x->size < y->size);
    return order ? order : x->material - y->material;
}

/* Gives each solid its rank by size. */
static void rank_solids(scene *s)
{
    g_autofree filling *all = find_fillings(s);
    g_autofree uint32_t *ranks = g_new0(uint32_t, MAX(s->materials->len, 1));
    qsort(all, s->materials->len, sizeof *all, by_size);
    s->solids = g_new0(const medium *, s->materials->len + 1);
    for (guint i = 0; i < s->materials->len; i++) {
        s->solids[i + 1] = all[i].medium;
        ranks[all[i].material] = i + 1;
    }
    for (guint i = 0; i < s->shapes->len; i++) {
        shape *on = s->shapes->pdata[i];
        on->solid = bounding_material(s, on) ? ranks[on->material] : 0;
    }
}

/* ---- What stands in them ---- */

/* Crossings on the way out: from the front counts up, from behind down. */
static medium_stack left_on_the_way(const scene *s, vec3 p, vec3 direction)
{
    g_autofree int *entered = g_new0(int, s->materials->len);
    medium_stack found = {0};
    ray r = {.origin = p, .direction = direction, .t_max = INFINITY, .time = 0.5f};
    surface_hit hit;
    for (int i = 0; i < MOST_CROSSINGS && scene_cross(s, &r, &hit); i++) {
        if (hit.solid && !hit.from_inside)
            entered[hit.material]++;
        else if (hit.solid && entered[hit.material]-- <= 0) {
            found = medium_stack_enter(found, hit.solid);
            entered[hit.material] = 0;
        }
    }
    return found;
}

static bool is_among(const medium_stack *all, uint32_t solid)
{
    for (int i = 0; i < SOLIDS_MOST; i++)
        if (all->solid[i] == solid)
            return true;
    return false;
}

medium_stack scene_solids_at(const scene *s, vec3 p)
{
    /* Along no axis and no plane of symmetry, and not all to one side. */
    static const vec3 ways[N_WAYS] = {{0.2711f, 0.5023f, 0.8211f},
                                      {-0.7517f, 0.5531f, -0.3593f},
                                      {0.3469f, -0.8363f, -0.4246f}};
    medium_stack found[N_WAYS], most = {0};
    if (!s->solids)
        return most;
    for (int i = 0; i < N_WAYS; i++)
        found[i] = left_on_the_way(s, p, normalize3(ways[i]));
    for (int i = 0; i < N_WAYS - 1; i++)
        for (int k = 0; k < SOLIDS_MOST && found[i].solid[k]; k++) {
            uint32_t in = found[i].solid[k];
            int n = is_among(&found[0], in) + is_among(&found[1], in) +
                    is_among(&found[2], in);
            if (n >= 2 && !is_among(&most, in))
                most = medium_stack_enter(most, in);
        }
    return most;
}

/* Where a light's photons start; of lights that are not beyond the scene. */
static medium_stack solids_of_light(const scene *s, const light *l)
{
    const wavelengths w = wavelengths_at(0.5f);
    const vec2 middle = {0.5f, 0.5f};
    light_emission e = {0};
    if (l->kind->is_environment || l->kind->is_parallel)
        return (medium_stack){0};
    l->kind->emit(l->self, &w, 0.5f, middle, (vec2){0.4f, 0.3f}, &e);
    return finite3(e.ray.origin) ? scene_solids_at(s, e.ray.origin) : (medium_stack){0};
}

void scene_find_solids(scene *s)
{
    s->solids = NULL;
    if (!anything_absorbs(s))
        return;
    rank_solids(s);
    for (guint i = 0; i < s->lights->len && still_wanted(NULL); i++) {
        light *l = s->lights->pdata[i];
        l->inside = solids_of_light(s, l);
    }
}
