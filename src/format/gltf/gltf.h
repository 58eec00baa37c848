/*
 * The state shared by the parts of the glTF 2.0 reader.
 *
 *   gltf.c          .gltf and .glb, extensions, the scene graph
 *   gltf_buffer.c   buffers, views and accessors as arrays of numbers
 *   gltf_node.c     where nodes stand
 *   gltf_animation.c  where they do at a time
 *   gltf_mesh.c     primitives as meshes
 *   gltf_pose.c     morph targets and skins
 *   gltf_instance.c meshes where nodes put them, once or many times
 *   gltf_material.c materials, gltf_texture.c their textures
 *   gltf_light.c    lights and cameras
 *
 * Khronos, "glTF 2.0 Specification", 2021, and its KHR extensions. What is wrong is noted
 * in the JSON reader (json_read.h) with the way to the value; reading ends with the first
 * such error.
 */
#pragma once

#include "format/json_read.h"
#include "scene/builder.h"

/** @brief Largest index or count that a file may name. */
#define GLTF_MOST G_GINT64_CONSTANT(0x7fffffff)
/** @brief Nodes that may hang on each other. */
#define GLTF_DEEPEST 1000

/** @brief What a primitive needs to know of its material. */
typedef struct gltf_material_info {
    int index;          /**< in the scene; NO_INDEX: not made yet */
    int solid_index;    /**< the same read as solid glass; NO_INDEX: not made yet */
    params *area_light; /**< what it shines with, owned; NULL: it does not */
    params *both_sides; /**< the same from both sides, owned; NULL: it may not */
    params *alpha;      /**< "alpha" of its shapes, owned; NULL: opaque */
    bool transmits;     /**< without a volume: thin by the standard */
    bool colored;       /**< some primitive of it has colours of vertices */
    bool is_read;
} gltf_material_info;

/** @brief What is known of a mesh before it is read. */
typedef struct gltf_mesh_info {
    bool
        repeats; /**< several nodes, or one many times, show it: instances of an object */
    bool is_made; /**< the object, or it was found to be needless */
    int object;   /**< in the scene: of all its primitives but shining ones; NO_INDEX */
} gltf_mesh_info;

typedef struct gltf_moved gltf_moved;

typedef struct gltf {
    scene_builder *builder;
    const char *path; /**< of the file */
    char *directory;  /**< that names in it are relative to */
    json_reader json;
    json_value root;
    GBytes *binary;   /**< the binary chunk of a .glb; NULL */
    GBytes **buffers; /**< per buffer; NULL until read */
    guint n_buffers;
    gltf_material_info *materials; /**< one per material, and the default one */
    guint n_materials;
    bool *visited;     /**< per node */
    int *parents;      /**< per node; NO_INDEX: a root */
    gltf_moved *moved; /**< per node, by animations; NULL: as they stand */
    guint n_nodes;
    gltf_mesh_info *meshes;
    guint n_meshes;
    GHashTable *notes; /**< texts given already */
    bool has_camera;
    bool shines;   /**< a surface is brighter than white paper can be */
    double lumens; /**< per unit of a light's numbers; 0: not known yet */
    bool solid;    /**< closed meshes that transmit are read as solid glass */
    guint n_solid; /**< such meshes */
} gltf;

static inline bool gltf_failed(const gltf *g)
{
    return g->json.error != NULL;
}

/** @brief An empty list of parameters. */
params *gltf_params(const gltf *g);
/** @brief A note or warning, once however often it is met. */
void gltf_note(gltf *g, log_level level, const char *format, ...) G_GNUC_PRINTF(3, 4);
/** @brief Takes an error of the scene's, if there is one, as the reader's. */
void gltf_take_error(gltf *g, const json_value *at, GError *error);
/** @brief The element of a top-level array ("meshes") that of[key] names; absent if the
 * key is; an error if it is not there. `array` keeps what the way needs. */
json_value gltf_refer(gltf *g, const json_value *of, const char *key, const char *name,
                      json_value *array, gint64 *index);
/** @brief Member `name` of v's "extensions". `extensions` keeps what the way needs. */
json_value gltf_extension(const json_value *v, const char *name, json_value *extensions);

/* ---- gltf_buffer.c ---- */

/** @brief Bytes of a buffer view (an image's); NULL with an error noted. */
GBytes *gltf_view_bytes(gltf *g, gint64 index);
/** @brief The bytes that a "data:" URI, or a path relative to the file, stands for. */
GBytes *gltf_uri_bytes(gltf *g, const json_value *at, const char *uri);
/** @brief A path beside the file from a URI; NULL with an error noted. */
char *gltf_uri_path(gltf *g, const json_value *at, const char *uri);
/** @brief Elements of an accessor as floats, n_components each (normalised integers in
 * 0..1 or -1..1), with *padding* floats behind. big_alloc'ed; NULL with an error noted.
 * @param count gets the number of elements */
float *gltf_read_floats(gltf *g, gint64 accessor, unsigned n_components, size_t padding,
                        size_t *count);
/** @brief How many components the accessor's elements have; 0 with an error noted. */
unsigned gltf_components(gltf *g, gint64 accessor);
/** @brief gltf_read_floats of unsigned integers, one each. */
uint32_t *gltf_read_indices(gltf *g, gint64 accessor, size_t *count);

/* ---- gltf_node.c ---- */

/** @brief A move times a turn (a quaternion of any length) times a scale; false if it
 * flattens space. */
bool gltf_transform(const double t[3], const double q[4], const double s[3],
                    transform *out);
/** @brief The same of a node (an element of "nodes"), relative to its parent, by "matrix"
 * or "translation", "rotation" and "scale". */
bool gltf_node_transform(const gltf *g, const json_value *node, transform *out);
/** @brief Fills g->parents. */
void gltf_find_parents(gltf *g);
/** @brief Node to world, row by row. @return false with an error noted */
bool gltf_node_matrix(gltf *g, guint node, double out[4][4]);

/* ---- the others ---- */

typedef struct gltf_pose gltf_pose;
/** @brief Which primitives of a mesh are meant: those that shine can not be part of an
 * object. */
typedef enum gltf_part { GLTF_ALL, GLTF_SHINING, GLTF_DARK } gltf_part;
/** @brief Adds primitives of a mesh, bent by a pose, to the scene, or the object that is
 * open. @return how many there are of that part */
guint gltf_add_primitives(gltf *g, const json_value *mesh, const gltf_pose *pose,
                          gltf_part part, const transform *to_world);
/** @brief Counts how often each mesh is shown, and which materials have colours. */
void gltf_survey(gltf *g);
/** @brief Adds the mesh of a node to the scene. */
void gltf_add_mesh(gltf *g, const json_value *node, const transform *to_world);
/** @brief Index of a material in the scene, made if it is new; NO_INDEX with an error
 * noted. @param material -1: the default one */
int gltf_material_index(gltf *g, gint64 material, bool solid);
/** @brief What is known of it (made at the first call). */
const gltf_material_info *gltf_material(gltf *g, gint64 material);
/** @brief What of a texture is taken. */
typedef struct gltf_channel {
    const char *channel; /**< "R" to "A": a number; NULL: the colours */
    bool vertex_color;   /**< times the colours of the vertices */
    bool invert;         /**< a number: 1 - what the image and the factor say */
    bool is_cut;         /**< a number: 0 below `cut`, else 1 */
    double cut;
} gltf_channel;
/** @brief Adds parameter `name` made of texture reference `info` times a factor of one
 * number or three; the factor alone if there is no texture. */
void gltf_give_textured(gltf *g, params *p, const char *name, const json_value *info,
                        const gltf_channel *how, const double *factor);
/** @brief Adds "normalmap" and its scale, if there is one. */
void gltf_give_normals(gltf *g, params *p, const json_value *info);
/** @brief The path of a texture's image, made known to the scene if it is embedded;
 * interned, NULL with an error noted. */
const char *gltf_image_path(gltf *g, const json_value *info);
/** @brief A node's light (KHR_lights_punctual) and camera. */
void gltf_add_light(gltf *g, const json_value *node, const transform *to_world);
void gltf_add_camera(gltf *g, const json_value *node, const transform *to_world);
