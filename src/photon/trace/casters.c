#include "photon/trace/casters.h"

#include "base/memory.h"
#include "math/warp.h"

/* ---- Surfaces ---- */

static bool is_caster(const caustic_casters *c, int index)
{
    const material *m = index == NO_INDEX ? NULL : c->scene->materials->pdata[index];
    return m && (material_casts_caustics(m) || (c->metals && material_is_conductor(m)));
}

/* The shapes of each object, or (first) of the world, that cast caustics. */
static GArray **shapes_by_object(const caustic_casters *c)
{
    const scene *s = c->scene;
    size_t n = (size_t)s->n_objects + 1;
    GArray **lists = g_new0(GArray *, n);
    for (size_t i = 0; i < n; i++)
        lists[i] = g_array_new(FALSE, FALSE, sizeof(int));
    for (guint i = 0; i < s->shapes->len; i++) {
        const shape *on = s->shapes->pdata[i];
        int index = (int)i;
        if (on->area > 0.0f && is_caster(c, on->material))
            g_array_append_val(lists[on->object + 1], index);
    }
    return lists;
}

static void free_lists(GArray **lists, guint n_objects)
{
    for (guint i = 0; i <= n_objects; i++)
        g_array_unref(lists[i]);
    g_free(lists);
}

/* Those of the world, if of_instance is NO_INDEX, or of an instance. */
static void list_shapes(caustic_casters *c, const GArray *list, int of_instance,
                        float *areas, box3 *box)
{
    const scene *s = c->scene;
    const instance *is = of_instance == NO_INDEX ? NULL : scene_instance(s, of_instance);
    double factor = is ? scene_instance_growth(s, is) : 1.0;
    for (guint k = 0; k < list->len; k++) {
        int i = g_array_index(list, int, k);
        const shape *on = s->shapes->pdata[i];
        box3 bounds = on->kind->bounds(on->self);
        areas[c->n] = (float)((double)on->area * factor);
        c->all[c->n++] = (caustic_caster){i, of_instance};
        *box = box3_union(*box, is ? scene_placed_bounds(s, is, bounds) : bounds);
    }
}

static size_t count_shapes(const scene *s, GArray **lists)
{
    size_t n = lists[0]->len;
    for (guint i = 0; i < s->instances->len; i++)
        n += lists[scene_instance(s, (int)i)->object + 1]->len;
    return n;
}

/* A shape is one as often as there are instances of it: many can be asked for by few
   words. @param areas owned by the caller (big_free); NULL: memory is short */
static float *list_all(caustic_casters *c, GArray **lists, box3 *box, GError **error)
{
    const scene *s = c->scene;
    size_t n = count_shapes(s, lists);
    if (n > INT_MAX) {
        error_set(error, ERROR_FAILED,
                  "expected at most %d casters of caustics, found %zu", INT_MAX, n);
        return NULL;
    }
    float *areas = big_alloc(n, sizeof *areas, "casters of caustics", error);
    if (areas)
        c->all = big_alloc(n, sizeof *c->all, "casters of caustics", error);
    if (!c->all) {
        big_free(areas);
        return NULL;
    }
    list_shapes(c, lists[0], NO_INDEX, areas, box);
    for (guint i = 0; i < s->instances->len; i++)
        list_shapes(c, lists[scene_instance(s, (int)i)->object + 1], (int)i, areas, box);
    return areas;
}

static bool find_surfaces(caustic_casters *c, GError **error)
{
    const scene *s = c->scene;
    box3 box = box3_empty();
    GArray **lists = shapes_by_object(c);
    float *areas = list_all(c, lists, &box, error);
    free_lists(lists, s->n_objects);
    c->center = box3_is_empty(box) ? s->center : box3_center(box);
    c->radius = box3_radius(box);
    bool done = areas && distribution_init(&c->area, areas, (size_t)c->n, error);
    big_free(areas);
    return done;
}

/* ---- Lights ---- */

static bool stands_apart(const caustic_casters *c, const light_bound *bound)
{
    vec3 nearest = max3(bound->box.low, min3(c->center, bound->box.high));
    return bound->is_local && length3(nearest - c->center) > c->radius;
}

/* The share of a light's power that may meet the sphere: parallel light is spread over
   the whole scene, that from a light apart from the sphere over a cone and up to twice as
   strong as on average. */
static float power_share(caustic_casters *c, int i, const wavelengths *w)
{
    const light *l = scene_light(c->scene, i);
    if (l->kind->is_parallel)
        return square(minf(1.0f, c->radius / c->scene->radius));
    light_bound bound = l->kind->bound(l->self, w);
    c->is_apart[i] = stands_apart(c, &bound);
    double distance = (double)length3(box3_center(bound.box) - c->center);
    double sine = (double)c->radius / distance;
    return c->is_apart[i] ? (float)one_minus_cos_of_sine2(sine * sine) : 1.0f;
}

static bool find_power(caustic_casters *c, GError **error)
{
    const wavelengths w = wavelengths_at(0.5f);
    const scene *s = c->scene;
    guint n = s->lights->len;
    float *power = big_alloc(n, sizeof(float), "lights", error);
    c->is_apart = power ? big_alloc(n, sizeof *c->is_apart, "lights", error) : NULL;
    for (guint i = 0; i < n && c->is_apart; i++) {
        c->is_apart[i] = false;
        power[i] = distribution_pdf(&s->light_power, i) * power_share(c, (int)i, &w);
    }
    bool done = c->is_apart && distribution_init(&c->power, power, n, error);
    big_free(power);
    return done;
}

static caustic_casters *casters_new(const scene *s, bool metals, GError **error)
{
    caustic_casters *c = g_aligned_alloc0(1, sizeof *c, _Alignof(caustic_casters));
    c->scene = s;
    c->metals = metals;
    if (find_surfaces(c, error) && find_power(c, error))
        return c;
    caustic_casters_free(c);
    return NULL;
}

caustic_casters *caustic_casters_new(const scene *s, GError **error)
{
    return casters_new(s, false, error);
}

caustic_casters *caustic_casters_new_with_metals(const scene *s, GError **error)
{
    return casters_new(s, true, error);
}

void caustic_casters_free(caustic_casters *c)
{
    if (!c)
        return;
    distribution_clear(&c->area);
    distribution_clear(&c->power);
    big_free(c->all);
    big_free(c->is_apart);
    g_aligned_free(c);
}

/* ---- Asking ---- */

bool caustic_casters_include(const caustic_casters *c, const surface_hit *hit)
{
    return is_caster(c, hit->material);
}

vec3 caustic_casters_sample(const caustic_casters *c, float u_shape, vec2 u, float time)
{
    const scene *s = c->scene;
    size_t i = distribution_sample(&c->area, &u_shape);
    const caustic_caster *caster = &c->all[i];
    vec3 p = shape_sample_area(s->shapes->pdata[caster->shape], u_shape, u).p;
    if (caster->instance == NO_INDEX)
        return p;
    transform to_world = accel_instance_at(s->accel, caster->instance, time);
    return transform_point(&to_world, p);
}

double caustic_casters_density(const caustic_casters *c, const surface_hit *hit)
{
    const scene *s = c->scene;
    double p = 1.0 / distribution_total(&c->area);
    if (hit->instance == NO_INDEX)
        return p;
    transform at = accel_instance_at(s->accel, hit->instance, hit->time);
    return p * scene_instance_growth(s, scene_instance(s, hit->instance)) /
           instance_area_factor(&at, hit->n_geom);
}
