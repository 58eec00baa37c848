#include "scene/builder.h"

#include "base/memory.h"
#include "scene/scene_film.h"
#include "scene/scene_geometry.h"
#include "shape/mesh_repair.h"
#include "texture/picture.h"

#include <float.h>

static void unref_picture(void *data)
{
    picture_unref(data);
}

static GHashTable *names_new(void)
{
    return g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
}

scene_builder *scene_builder_new(const log_sink *log)
{
    scene_builder *b = g_new0(scene_builder, 1);
    b->scene = scene_new();
    b->material_names = names_new();
    b->medium_names = names_new();
    b->object_names = names_new();
    b->open_object = NO_INDEX;
    build_context_init(&b->build, log, unref_picture);
    b->film = film_default();
    return b;
}

void scene_builder_free(scene_builder *b)
{
    if (!b)
        return;
    scene_free(b->scene);
    g_hash_table_unref(b->object_names);
    g_hash_table_unref(b->medium_names);
    g_hash_table_unref(b->material_names);
    build_context_clear(&b->build);
    filter_clear(&b->filter);
    g_free(b->film.filename);
    g_free(b);
}

bool builder_may_change(const scene_builder *b, GError **error)
{
    if (!b->scene)
        error_set(error, ERROR_USAGE, "the scene is committed and can not be changed");
    return b->scene != NULL;
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

bool builder_add_texture(scene_builder *b, const char *name, const char *kind,
                         bool is_spectrum, const params *p, GError **error)
{
    GHashTable *table =
        is_spectrum ? b->build.spectrum_textures : b->build.float_textures;
    if (!builder_may_change(b, error) || !has_room("textures", p->place, error))
        return false;
    if (g_hash_table_contains(table, name)) {
        error_at(error, p->place, "texture \"%s\" is there already", name);
        return false;
    }
    LISTENER_TELL(b, texture, name, kind, is_spectrum, p);
    texture *t = texture_new(&b->build, kind, is_spectrum, p, error);
    if (!t)
        return false;
    g_ptr_array_add(b->scene->textures, t);
    g_hash_table_insert(table, g_strdup(name), t);
    return true;
}

/* Puts a new material into the place that its name has, or behind the last. */
static int take_material(scene_builder *b, material *m, const char *name)
{
    int index = name ? builder_find_material(b, name) : NO_INDEX;
    if (index == NO_INDEX) {
        index = (int)b->scene->materials->len;
        g_ptr_array_add(b->scene->materials, NULL);
    }
    b->scene->materials->pdata[index] = m;
    if (name) {
        g_free(m->name);
        m->name = g_strdup(name);
        g_hash_table_insert(b->material_names, g_strdup(name),
                            GINT_TO_POINTER(index + 1));
        g_hash_table_insert(b->build.materials, g_strdup(name), m);
    }
    return index;
}

int builder_add_material(scene_builder *b, const char *name, const char *kind,
                         const params *p, GError **error)
{
    if (!builder_may_change(b, error) || !has_room("materials", p->place, error))
        return NO_INDEX;
    int index = name ? builder_find_material(b, name) : NO_INDEX;
    if (index != NO_INDEX && b->scene->materials->pdata[index]) {
        error_at(error, p->place, "material \"%s\" is there already", name);
        return NO_INDEX;
    }
    LISTENER_TELL(b, material, index == NO_INDEX ? (int)b->scene->materials->len : index,
                  name, kind, p);
    material *m = material_new(&b->build, kind, p, error);
    return m ? take_material(b, m, name) : NO_INDEX;
}

int builder_await_material(scene_builder *b, const char *name)
{
    int index = (int)b->scene->materials->len;
    g_ptr_array_add(b->scene->materials, NULL);
    g_hash_table_insert(b->material_names, g_strdup(name), GINT_TO_POINTER(index + 1));
    LISTENER_TELL(b, material_awaited, index, name);
    return index;
}

bool builder_material_is_awaited(const scene_builder *b, const char *name)
{
    int index = builder_find_material(b, name);
    return index != NO_INDEX && !b->scene->materials->pdata[index];
}

/* What stands in its place is used by nothing. */
void builder_make_interface(scene_builder *b, const char *name, const params *p)
{
    int index = builder_find_material(b, name);
    LISTENER_TELL(b, material, index, name, "interface", p);
    g_autoptr(params) none = params_new(p->place, p->base_directory, p->space);
    take_material(b, material_new(&b->build, "diffuse", none, NULL), name);
    for (guint i = 0; i < b->scene->shapes->len; i++) {
        shape *on = b->scene->shapes->pdata[i];
        if (on->material == index)
            on->material = NO_INDEX;
    }
}

int builder_find_material(const scene_builder *b, const char *name)
{
    int found = GPOINTER_TO_INT(g_hash_table_lookup(b->material_names, name));
    return found ? found - 1 : NO_INDEX;
}

bool builder_add_light(scene_builder *b, const char *kind, const params *p,
                       const transform *to_world, GError **error)
{
    if (!builder_may_change(b, error) || !has_room("lights", p->place, error))
        return false;
    LISTENER_TELL(b, light, kind, p, to_world);
    light *l = light_new(&b->build, kind, p, to_world, NULL, error);
    if (!l)
        return false;
    if (!l->kind->is_environment && !l->kind->is_parallel) /* they are beyond all media */
        l->media = (medium_interface){b->around.outside, b->around.outside};
    g_ptr_array_add(b->scene->lights, l);
    return true;
}

/* What is in an object is as large as its instances. */
static bool is_in_order(const scene_builder *b, const shape *made, GError **error)
{
    if (made->material != NO_INDEX && (guint)made->material >= b->scene->materials->len) {
        error_at(error, made->place, "the shape's material %d does not exist",
                 made->material);
        return false;
    }
    return b->open_object != NO_INDEX ||
           scene_check_reach(made->kind->bounds(made->self), "the shape", made->place,
                             error);
}

/* The light of a shape that shines. */
static bool add_area_light(scene_builder *b, shape *made, const shape_place *at,
                           GError **error)
{
    if (b->open_object != NO_INDEX) {
        log_at(&b->build.log, LOG_WARNING, at->area_light->place,
               "a shape that moves or is part of an object does not shine");
        return true;
    }
    light *l =
        light_new(&b->build, "diffuse", at->area_light, &at->to_world, made, error);
    if (!l)
        return false;
    l->media = b->around;
    if (!made->parts_media)
        l->media.inside = l->media.outside;
    made->light = (int)b->scene->lights->len;
    g_ptr_array_add(b->scene->lights, l);
    return true;
}

/* True if a shape stands so far off that floats do not tell its points apart: its pieces
   would lie in one another, and every ray that comes near meet them all. As small as it
   looks from anywhere else it is not missed; a light may be. */
static bool is_lost(const scene_builder *b, const shape *made, const shape_place *at)
{
    const box3 box = made->kind->bounds(made->self);
    float size = max_component3(box.high - box.low);
    float far = max_component3(max3(abs3(box.low), abs3(box.high)));
    float step = FLT_EPSILON * far;
    bool kept = b->open_object != NO_INDEX || at->area_light || box3_is_empty(box);
    if (kept || !(size < 2.0f * step)) /* bounds are rounded outward */
        return false;
    log_at(&b->build.log, LOG_WARNING, made->place,
           "the shape is left out: it is %g m large, %g m from the origin, where floats "
           "are %g m apart",
           (double)size, (double)far, (double)step);
    return true;
}

/* Takes a new shape (NULL: it failed), with its light if it shines. */
static bool take_shape(scene_builder *b, shape *made, const shape_place *at,
                       GError **error)
{
    if (!made)
        return false;
    made->object = b->open_object;
    made->media = b->around;
    made->parts_media = b->around.inside != b->around.outside;
    if (!is_in_order(b, made, error) ||
        (at->area_light && !add_area_light(b, made, at, error))) {
        shape_free(made);
        return false;
    }
    if (is_lost(b, made, at))
        shape_free(made);
    else
        g_ptr_array_add(b->scene->shapes, made);
    return true;
}

bool builder_add_shape(scene_builder *b, const char *kind, const params *p,
                       const shape_place *at, GError **error)
{
    if (!builder_may_change(b, error) || !has_room("shapes", p->place, error))
        return false;
    LISTENER_TELL(b, shape, kind, p, at);
    return take_shape(b, shape_new(kind, p, at, error), at, error);
}

bool builder_add_mesh(scene_builder *b, mesh *m, const shape_place *at,
                      source_place place, GError **error)
{
    if (!builder_may_change(b, error) || !has_room("shapes", place, error)) {
        mesh_clear(m);
        return false;
    }
    mesh_drop_bad(m, place, &b->build.log);
    LISTENER_TELL(b, mesh, m, at);
    return take_shape(b, shape_new_mesh(m, at, place, error), at, error);
}

bool builder_set_film(scene_builder *b, const char *kind, const params *p, GError **error)
{
    film_settings film;
    if (!builder_may_change(b, error) || !film_init(&film, kind, p, &b->build.log, error))
        return false;
    g_free(b->film.filename);
    b->film = film;
    LISTENER_TELL(b, film, kind, p);
    return true;
}

bool builder_set_filter(scene_builder *b, const char *kind, const params *p,
                        GError **error)
{
    pixel_filter filter = {0};
    if (!builder_may_change(b, error) || !filter_init(&filter, kind, p, error))
        return false;
    filter_clear(&b->filter);
    b->filter = filter;
    LISTENER_TELL(b, filter, kind, p);
    return true;
}

bool builder_set_camera(scene_builder *b, const char *kind, const params *p,
                        const transform *to_world, GError **error)
{
    vec3 stands = transform_point(to_world, vec3_make(0.0f, 0.0f, 0.0f));
    b->has_camera =
        builder_may_change(b, error) &&
        scene_check_reach((box3){stands, stands}, "the camera", p->place, error) &&
        camera_init(&b->camera, kind, p, to_world, b->film.width, b->film.height, error);
    if (!b->has_camera)
        return false;
    b->camera.begin = b->time;
    b->scene->shutter[0] = (float)((double)b->camera.shutter_open + b->time);
    b->scene->shutter[1] = (float)((double)b->camera.shutter_close + b->time);
    b->camera.media = (medium_stack){.participating = b->around.outside};
    b->camera.medium_there = b->around.outside;
    b->camera.medium_at = stands;
    LISTENER_TELL(b, camera, kind, p, to_world);
    return true;
}

void builder_move_camera(scene_builder *b, const motion *to_world)
{
    LISTENER_TELL(b, camera_motion, to_world);
    b->scene->is_animated |= to_world->moves;
    b->camera.path = *to_world;
    b->camera.to_world = motion_at(to_world, (double)b->scene->shutter[0]);
}

/* ---- Media ---- */

int builder_add_medium(scene_builder *b, const char *name, const char *kind,
                       const params *p, GError **error)
{
    if (!builder_may_change(b, error))
        return NO_INDEX;
    LISTENER_TELL(b, medium, name, kind, p);
    medium *m = medium_new(name, kind, p, error);
    if (!m)
        return NO_INDEX;
    m->index = (int)b->scene->media->len;
    g_ptr_array_add(b->scene->media, m);
    g_hash_table_insert(b->medium_names, g_strdup(name), GINT_TO_POINTER(m->index + 1));
    return m->index;
}

int builder_find_medium(const scene_builder *b, const char *name)
{
    int found = GPOINTER_TO_INT(g_hash_table_lookup(b->medium_names, name));
    return found ? found - 1 : NO_INDEX;
}

static const char *medium_name(const scene *s, uint32_t number)
{
    const medium *m = scene_medium(s, number);
    return m ? m->name : NULL;
}

void builder_set_medium_interface(scene_builder *b, int inside, int outside)
{
    const medium_interface around = {(uint32_t)(inside + 1), (uint32_t)(outside + 1)};
    if (around.inside == b->around.inside && around.outside == b->around.outside)
        return;
    b->around = around;
    LISTENER_TELL(b, medium_interface, medium_name(b->scene, around.inside),
                  medium_name(b->scene, around.outside));
}
