/*
 * Building a scene, and asking it.
 *
 * Everything is kept in the order it was added, so that indices, and with them random
 * choices, are the same in every run.
 */
#include "scene/scene.h"

#include "base/memory.h"
#include "scene/scene_commit.h"
#include "scene/scene_film.h"
#include "scene/scene_geometry.h"
#include "shape/mesh_repair.h"
#include "texture/picture.h"

#include <string.h>

static void free_texture(void *data)
{
    texture_free(data);
}

static void free_material(void *data)
{
    material_free(data);
}

static void free_medium(void *data)
{
    medium_free(data);
}

static void free_shape(void *data)
{
    shape_free(data);
}

static void free_light(void *data)
{
    light_free(data);
}

static void unref_picture(void *data)
{
    picture_unref(data);
}

scene *scene_new(const log_sink *log)
{
    scene *s = g_new0(scene, 1);
    s->shapes = g_ptr_array_new_with_free_func(free_shape);
    s->materials = g_ptr_array_new_with_free_func(free_material);
    s->lights = g_ptr_array_new_with_free_func(free_light);
    scene_open_objects(s);
    s->textures = g_ptr_array_new_with_free_func(free_texture);
    s->material_names = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    s->media = g_ptr_array_new_with_free_func(free_medium);
    s->medium_names = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    build_context_init(&s->build, log, unref_picture);
    s->film = film_default();
    s->settings = settings_default();
    return s;
}

scene *scene_share(const scene *s)
{
    return g_memdup2(s, sizeof *s); /* size and camera are plain values in it */
}

void scene_free(scene *s)
{
    if (!s)
        return;
    scene_forget_commit(s);
    g_ptr_array_unref(s->lights);
    g_ptr_array_unref(s->shapes);
    g_ptr_array_unref(s->materials);
    scene_close_objects(s);
    g_ptr_array_unref(s->media);
    g_hash_table_unref(s->medium_names);
    g_hash_table_unref(s->material_names);
    g_ptr_array_unref(s->textures);
    scene_sources_free(s->build.sources);
    build_context_clear(&s->build);
    filter_clear(&s->filter);
    g_free(s->film.filename);
    g_free(s);
}

/* ---- Adding ---- */

/* About what a thing takes, beside arrays. */
enum { THING_SIZE = 1024 };

static bool has_room(const char *what, source_place place, GError **error)
{
    GError *refused = NULL;
    if (memory_ask(THING_SIZE, what, &refused))
        return true;
    error_move_at(error, place, refused);
    return false;
}

bool scene_add_texture(scene *s, const char *name, const char *kind, bool is_spectrum,
                       const params *p, GError **error)
{
    GHashTable *table =
        is_spectrum ? s->build.spectrum_textures : s->build.float_textures;
    if (!scene_may_change(s, error) || !has_room("textures", p->place, error))
        return false;
    if (g_hash_table_contains(table, name)) {
        error_at(error, p->place, "texture \"%s\" is there already", name);
        return false;
    }
    LISTENER_TELL(s, texture, name, kind, is_spectrum, p);
    texture *t = texture_new(&s->build, kind, is_spectrum, p, error);
    if (!t)
        return false;
    g_ptr_array_add(s->textures, t);
    g_hash_table_insert(table, g_strdup(name), t);
    return true;
}

/* Puts a new material into the place that its name has, or behind the last. */
static int take_material(scene *s, material *m, const char *name)
{
    int index = name ? scene_find_material(s, name) : NO_INDEX;
    if (index == NO_INDEX) {
        index = (int)s->materials->len;
        g_ptr_array_add(s->materials, NULL);
    }
    s->materials->pdata[index] = m;
    if (name) {
        g_free(m->name);
        m->name = g_strdup(name);
        g_hash_table_insert(s->material_names, g_strdup(name),
                            GINT_TO_POINTER(index + 1));
        g_hash_table_insert(s->build.materials, g_strdup(name), m);
    }
    return index;
}

int scene_add_material(scene *s, const char *name, const char *kind, const params *p,
                       GError **error)
{
    if (!scene_may_change(s, error) || !has_room("materials", p->place, error))
        return NO_INDEX;
    int index = name ? scene_find_material(s, name) : NO_INDEX;
    if (index != NO_INDEX && s->materials->pdata[index]) {
        error_at(error, p->place, "material \"%s\" is there already", name);
        return NO_INDEX;
    }
    LISTENER_TELL(s, material, index == NO_INDEX ? (int)s->materials->len : index, name,
                  kind, p);
    material *m = material_new(&s->build, kind, p, error);
    return m ? take_material(s, m, name) : NO_INDEX;
}

int scene_await_material(scene *s, const char *name)
{
    int index = (int)s->materials->len;
    g_ptr_array_add(s->materials, NULL);
    g_hash_table_insert(s->material_names, g_strdup(name), GINT_TO_POINTER(index + 1));
    LISTENER_TELL(s, material_awaited, index, name);
    return index;
}

bool scene_material_is_awaited(const scene *s, const char *name)
{
    int index = scene_find_material(s, name);
    return index != NO_INDEX && !s->materials->pdata[index];
}

/* What stands in its place is used by nothing. */
void scene_make_interface(scene *s, const char *name, const params *p)
{
    int index = scene_find_material(s, name);
    LISTENER_TELL(s, material, index, name, "interface", p);
    g_autoptr(params) none = params_new(p->place, p->base_directory, p->space);
    take_material(s, material_new(&s->build, "diffuse", none, NULL), name);
    for (guint i = 0; i < s->shapes->len; i++) {
        shape *on = s->shapes->pdata[i];
        if (on->material == index)
            on->material = NO_INDEX;
    }
}

int scene_find_material(const scene *s, const char *name)
{
    int found = GPOINTER_TO_INT(g_hash_table_lookup(s->material_names, name));
    return found ? found - 1 : NO_INDEX;
}

bool scene_add_light(scene *s, const char *kind, const params *p,
                     const transform *to_world, GError **error)
{
    if (!scene_may_change(s, error) || !has_room("lights", p->place, error))
        return false;
    LISTENER_TELL(s, light, kind, p, to_world);
    light *l = light_new(&s->build, kind, p, to_world, NULL, error);
    if (!l)
        return false;
    if (!l->kind->is_environment && !l->kind->is_parallel) /* they are beyond all media */
        l->media = (medium_interface){s->around.outside, s->around.outside};
    g_ptr_array_add(s->lights, l);
    return true;
}

/* Takes a new shape (NULL: it failed), with its light if it shines. */
static bool take_shape(scene *s, shape *made, const shape_place *at, GError **error)
{
    if (!made)
        return false;
    if (made->material != NO_INDEX && (guint)made->material >= s->materials->len) {
        error_at(error, made->place, "the shape's material %d does not exist",
                 made->material);
        shape_free(made);
        return false;
    }
    if (s->open_object ==
            NO_INDEX && /* what is in an object is as large as its instances */
        !scene_check_reach(made->kind->bounds(made->self), "the shape", made->place,
                           error)) {
        shape_free(made);
        return false;
    }
    made->object = s->open_object;
    made->media = s->around;
    made->parts_media = s->around.inside != s->around.outside;
    bool shines = at->area_light;
    if (shines && s->open_object != NO_INDEX) {
        log_at(&s->build.log, LOG_WARNING, at->area_light->place,
               "a shape that moves or is part of an object does not shine");
        shines = false;
    }
    if (shines) {
        light *l =
            light_new(&s->build, "diffuse", at->area_light, &at->to_world, made, error);
        if (!l) {
            shape_free(made);
            return false;
        }
        l->media = s->around;
        if (!made->parts_media)
            l->media.inside = l->media.outside;
        made->light = (int)s->lights->len;
        g_ptr_array_add(s->lights, l);
    }
    g_ptr_array_add(s->shapes, made);
    return true;
}

bool scene_add_shape(scene *s, const char *kind, const params *p, const shape_place *at,
                     GError **error)
{
    if (!scene_may_change(s, error) || !has_room("shapes", p->place, error))
        return false;
    LISTENER_TELL(s, shape, kind, p, at);
    return take_shape(s, shape_new(kind, p, at, error), at, error);
}

bool scene_add_mesh(scene *s, mesh *m, const shape_place *at, source_place place,
                    GError **error)
{
    if (!scene_may_change(s, error) || !has_room("shapes", place, error)) {
        mesh_clear(m);
        return false;
    }
    mesh_drop_bad(m, place, &s->build.log);
    LISTENER_TELL(s, mesh, m, at);
    return take_shape(s, shape_new_mesh(m, at, place, error), at, error);
}

bool scene_set_film(scene *s, const char *kind, const params *p, GError **error)
{
    film_settings film;
    if (!scene_may_change(s, error) || !film_init(&film, kind, p, &s->build.log, error))
        return false;
    g_free(s->film.filename);
    s->film = film;
    LISTENER_TELL(s, film, kind, p);
    return true;
}

bool scene_set_filter(scene *s, const char *kind, const params *p, GError **error)
{
    pixel_filter filter = {0};
    if (!scene_may_change(s, error) || !filter_init(&filter, kind, p, error))
        return false;
    filter_clear(&s->filter);
    s->filter = filter;
    LISTENER_TELL(s, filter, kind, p);
    return true;
}

bool scene_set_camera(scene *s, const char *kind, const params *p,
                      const transform *to_world, GError **error)
{
    vec3 stands = transform_point(to_world, vec3_make(0.0f, 0.0f, 0.0f));
    s->has_camera =
        scene_may_change(s, error) &&
        scene_check_reach((box3){stands, stands}, "the camera", p->place, error) &&
        camera_init(&s->camera, kind, p, to_world, s->film.width, s->film.height, error);
    if (!s->has_camera)
        return false;
    s->camera.media = (medium_stack){.participating = s->around.outside};
    s->camera.medium_there = s->around.outside;
    s->camera.medium_at = stands;
    LISTENER_TELL(s, camera, kind, p, to_world);
    return true;
}

void scene_move_camera(scene *s, const motion *to_world)
{
    LISTENER_TELL(s, camera_motion, to_world);
    s->camera.path = *to_world;
    s->camera.to_world = motion_at(to_world, (double)s->camera.shutter_open);
}

/* ---- Asking ---- */

wavelengths scene_wavelengths(const scene *s, const settings *how, uint32_t pass)
{
    bool fixed = s->switches.fixed_wavelengths;
    return wavelengths_drawn(s->lines,
                             fixed ? 0.5f : wavelength_offset((uint64_t)how->seed, pass));
}

wavelengths scene_trial_wavelengths(const scene *s, uint32_t trial)
{
    return wavelengths_drawn(s->lines, s->lines ? wavelength_offset(0, trial) : 0.5f);
}

bool scene_see(const scene *s, const ray *r, surface_hit *hit)
{
    ray left = *r;
    while (scene_intersect(s, &left, hit)) {
        const shape *on = s->shapes->pdata[hit->shape];
        if (!on->camera_hidden) {
            hit->t = length3(hit->p - r->origin);
            hit->footprint = s->switches.sharp_textures
                                 ? 0.0f
                                 : s->pixel_width + hit->t * s->pixel_spread;
            return true;
        }
        left = hit_ray(hit, r->direction);
        left.media = r->media; /* what is not seen absorbs nothing */
        left.t_max = r->t_max - length3(left.origin - r->origin);
    }
    return false;
}

float scene_imaging_ratio(const scene *s)
{
    return s->film.iso / 100.0f * (s->camera.shutter_close - s->camera.shutter_open);
}

unsigned scene_lobes_around(const scene *s, const surface_hit *hit, const bsdf *b)
{
    return b->lobes | material_possible_lobes(s->materials->pdata[hit->material]);
}

bool scene_bsdf(const scene *s, const surface_hit *hit, const wavelengths *w, int lane,
                const bsdf_options *options, bsdf *out)
{
    if (hit->material == NO_INDEX)
        return false;
    material_bsdf(s->materials->pdata[hit->material], hit, w, lane, options, out);
    return true;
}
