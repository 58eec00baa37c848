/*
 * Building a scene: by calls, in any order, of one thread.
 *
 *   scene_builder_new ─► builder_add_* / builder_set_* ─► scene_builder_commit ─► scene
 *                                                      └─► scene_builder_view ─► view
 *
 * What only building needs is kept here and dies with the builder: names, files read
 * already, the log, the media and the object that what is added stands in. Everything is
 * kept in the order it was added, so that indices, and with them random choices, are the
 * same in every run. Calls return false or NO_INDEX with an ERROR_INPUT that names the
 * place; after the commit, with an ERROR_USAGE.
 */
#pragma once

#include "params/build_context.h"
#include "params/sources.h"
#include "scene/listener.h"
#include "scene/view.h"

typedef struct scene_builder {
    scene *scene;               /**< as far as it is built; NULL once it is committed */
    build_context build;        /**< what who makes a part is handed */
    GHashTable *material_names; /**< name -> index + 1 */
    GHashTable *medium_names;   /**< name -> index + 1 */
    GHashTable *object_names;   /**< the objects' own -> index + 1 */
    medium_interface around;    /**< what is added from here on */
    int open_object; /**< that shapes are added to now, or NO_INDEX: the world */
    camera camera;
    bool has_camera;
    film_settings film;
    pixel_filter filter;
    bool thin_glass; /**< closed meshes of glass without a volume are no solid glass: for
                        readers, set before anything is added */
    bool at_time;    /**< what is animated stands as it does at ... */
    double time;     /**< ... s: then the shutter opens, if it does at 0; 0 else. Both for
                        readers, set before anything is added */
    const scene_listener *listener; /**< borrowed; NULL: nobody */
} scene_builder;

/** @param log may be NULL; must outlive the builder */
scene_builder *scene_builder_new(const log_sink *log);
void scene_builder_free(scene_builder *b);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(scene_builder, scene_builder_free)

/** @brief Ends building. Checks what only the whole can tell: a camera, a light.
 *  @param threads for the acceleration structure; 0 = all
 *  @return the scene, owned by the caller; NULL with an error, and the builder is as it
 *  was before */
scene *scene_builder_commit(scene_builder *b, unsigned threads, GError **error);
/** @brief The view that was described of the scene that was built; once.
 * @param s is the view's from here on */
view *scene_builder_view(scene_builder *b, scene *s);

bool builder_add_texture(scene_builder *b, const char *name, const char *kind,
                         bool is_spectrum, const params *p, GError **error);
/** @brief name may be NULL. @return index, or NO_INDEX. */
int builder_add_material(scene_builder *b, const char *name, const char *kind,
                         const params *p, GError **error);
/** @brief Keeps a place for a material that shapes have before it is made; adding it by
 * its name fills the place, which must come before the commit. @return its index */
int builder_await_material(scene_builder *b, const char *name);
/** @brief True from builder_await_material until it is made. */
bool builder_material_is_awaited(const scene_builder *b, const char *name);
/** @brief Makes an awaited material none: the shapes that have it are interfaces. */
void builder_make_interface(scene_builder *b, const char *name, const params *p);
/** @brief Index of a named material, made or awaited, or NO_INDEX. */
int builder_find_material(const scene_builder *b, const char *name);
/** @brief A participating medium. @return index, or NO_INDEX. */
int builder_add_medium(scene_builder *b, const char *name, const char *kind,
                       const params *p, GError **error);
/** @brief Index of a named medium, or NO_INDEX. */
int builder_find_medium(const scene_builder *b, const char *name);
/** @brief From here on shapes part these media, by index or NO_INDEX for none (the same
 * twice: they part nothing), and lights and the camera stand in the outer one. */
void builder_set_medium_interface(scene_builder *b, int inside, int outside);
bool builder_add_light(scene_builder *b, const char *kind, const params *p,
                       const transform *to_world, GError **error);
/** @brief A shape from parameters; with at->area_light also its light. */
bool builder_add_shape(scene_builder *b, const char *kind, const params *p,
                       const shape_place *at, GError **error);
/** @brief A shape from a mesh in object space, whose arrays are taken. */
bool builder_add_mesh(scene_builder *b, mesh *m, const shape_place *at,
                      source_place place, GError **error);
/** @brief Shapes added from here to builder_object_end are part of a new object, in whose
 * space at->to_world puts them. @param name may be NULL @return its index, or NO_INDEX */
int builder_object_begin(scene_builder *b, const char *name, source_place place,
                         GError **error);
void builder_object_end(scene_builder *b);
/** @brief Index of a named object, or NO_INDEX. */
int builder_find_object(const scene_builder *b, const char *name);
/** @brief Reserves the memory of n instances, so that they are refused before the first
 * of them is made. Not needed, but for counts that a small file may state. */
bool builder_expect_instances(scene_builder *b, size_t n, source_place place,
                              GError **error);
/** @brief Puts an object into the world once more. Times of the motion in seconds. */
bool builder_add_instance(scene_builder *b, int object, const motion *to_world,
                          source_place place, GError **error);
bool builder_set_film(scene_builder *b, const char *kind, const params *p,
                      GError **error);
bool builder_set_filter(scene_builder *b, const char *kind, const params *p,
                        GError **error);
/** @brief The film must be set before (readers keep the directive until then). */
bool builder_set_camera(scene_builder *b, const char *kind, const params *p,
                        const transform *to_world, GError **error);
/** @brief Lets the camera that was set move; times in seconds. */
void builder_move_camera(scene_builder *b, const motion *to_world);

/** @brief True until the scene is committed; then ERROR_USAGE. */
bool builder_may_change(const scene_builder *b, GError **error);
