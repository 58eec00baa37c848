/*
 * Committing a scene: what only the whole of it can tell is found once and kept, so that
 * queries need only look.
 *
 *   bounds ─► acceleration structure ─► media ─► lights, prepared for how far they
 *   reach ─► groups, solids
 */
#include "base/wanted.h"
#include "scene/builder.h"

#include "base/memory.h"
#include "light/light_lines.h"
#include "scene/scene_film.h"
#include "scene/scene_geometry.h"
#include "scene/scene_media.h"
#include "scene/scene_solids.h"

/* ---- Lights ---- */

static bool check_strength(const scene *s, GError **error)
{
    double total = distribution_total(&s->light_power);
    if (!isfinite(total)) {
        error_set(error, ERROR_INPUT, "the scene's lights are infinitely strong");
        return false;
    }
    return true;
}

/* What the tree of lights takes for one, while it is built. */
#define LIGHT_SIZE ((size_t)512)

static bool find_lights(scene *s, GError **error)
{
    light_lines lines = {.n = 0};
    guint n = s->lights->len;
    if (!memory_ask(n * LIGHT_SIZE, "lights", error))
        return false;
    s->environments = g_new0(int, MAX(n, 1));
    float *power = big_alloc(n, sizeof(float), "lights", error);
    light_bound *bounds = power ? big_alloc(n, sizeof *bounds, "lights", error) : NULL;
    if (!bounds) {
        big_free(power);
        return false;
    }
    bool done = true;
    for (guint i = 0; i < n && (done = done && still_wanted(error)); i++) {
        const light *l = s->lights->pdata[i];
        if (l->kind->prepare)
            l->kind->prepare(l->self, s->center, scene_lit_radius(s));
        if (l->kind->is_environment)
            s->environments[s->n_environments++] = (int)i;
        light_strength strength = light_measure(l, &lines);
        power[i] = strength.power;
        bounds[i] = strength.bound;
        done =
            done && (!strength.bound.is_local ||
                     scene_check_reach(strength.bound.box, "the light", l->place, error));
    }
    s->lines = light_lines_density(&lines);
    s->light_tree = light_tree_new(bounds, done ? (int)n : 0);
    done = done && still_wanted(error) &&
           distribution_init(&s->light_power, power, n, error);
    big_free(power);
    big_free(bounds);
    return done && check_strength(s, error);
}

/* Index of a group by name, made if it is new. */
static int group_index(GPtrArray *names, const char *name)
{
    guint i;
    if (g_ptr_array_find_with_equal_func(names, name, g_str_equal, &i))
        return (int)i;
    g_ptr_array_add(names, g_strdup(name));
    return (int)names->len - 1;
}

static void find_light_groups(scene *s)
{
    bool any = false;
    for (guint i = 0; i < s->lights->len; i++)
        any |= scene_light(s, (int)i)->group != NULL;
    g_autoptr(GPtrArray) names = g_ptr_array_new();
    for (guint i = 0; i < s->lights->len && any; i++) {
        light *l = s->lights->pdata[i];
        l->group_index = group_index(names, l->group ? l->group : "default");
    }
    s->n_light_groups = (int)names->len;
    g_ptr_array_add(names, NULL);
    s->light_groups = (char **)g_ptr_array_steal(names, NULL);
}

/* ---- All of it ---- */

static bool find_all(scene *s, const camera *from, unsigned threads, GError **error)
{
    if (!scene_find_bounds(s, error) || !scene_build_accel(s, threads, error))
        return false;
    scene_find_outer_medium(s, from->medium_at, from->medium_there);
    if (!find_lights(s, error))
        return false;
    find_light_groups(s);
    scene_find_solids(s);
    return true;
}

scene *scene_builder_commit(scene_builder *b, unsigned threads, GError **error)
{
    scene *s = b->scene;
    if (!builder_may_change(b, error))
        return NULL;
    if (!b->has_camera) {
        error_set(error, ERROR_INPUT, "the scene has no camera");
        return NULL;
    }
    if (!b->filter.name && !filter_init_default(&b->filter, error))
        return NULL;
    if (!find_all(s, &b->camera, threads, error)) {
        scene_forget_commit(s);
        return NULL;
    }
    b->scene = NULL;
    return s;
}

view *scene_builder_view(scene_builder *b, scene *s)
{
    view *v = g_new(view, 1);
    *v = (view){.scene = s,
                .owned = s,
                .camera = b->camera,
                .film = b->film,
                .filter = b->filter};
    b->film = film_default();
    b->filter = (pixel_filter){0};
    const motion path = v->camera.path;
    view_place_camera(v, &path);
    return v;
}
