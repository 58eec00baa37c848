/*
 * The glTF 2.0 reader: the two kinds of files, what they require, and the scene graph.
 *
 *   .glb: "glTF" version length, then chunks: length type bytes (JSON, then BIN)
 */
#include "format/gltf/gltf_animation.h"

#include "base/input.h"
#include "base/intern.h"
#include "base/memory.h"
#include "format/defaults.h"
#include "format/gltf/gltf_extensions.h"
#include "format/reader.h"

#include <string.h>

enum {
    GLB_HEADER = 12,
    CHUNK_HEADER = 8,
    CHUNK_JSON = 0x4E4F534A,
    CHUNK_BIN = 0x004E4942
};

/* ---- The scene graph ---- */

static void add_node(gltf *g, const json_value *nodes, guint index,
                     const transform *parent, unsigned depth);

static void add_children(gltf *g, const json_value *nodes, const json_value *list,
                         const transform *to_world, unsigned depth)
{
    guint n = json_length(list), n_nodes = json_length(nodes);
    for (guint i = 0; i < n && !gltf_failed(g); i++) {
        gint64 index = json_whole_at(list, i, (gint64)n_nodes - 1);
        if (index >= 0)
            add_node(g, nodes, (guint)index, to_world, depth);
    }
}

/* With all that hangs on it (KHR_node_visibility). */
static bool is_hidden(const json_value *node)
{
    json_value extensions;
    json_value e = gltf_extension(node, "KHR_node_visibility", &extensions);
    return !json_flag(&e, "visible", true);
}

static void add_node(gltf *g, const json_value *nodes, guint index,
                     const transform *parent, unsigned depth)
{
    json_value node = json_element(nodes, index);
    transform own, to_world;
    if (g->visited[index]) {
        json_fail(&node, "the node is met twice: nodes must form a tree");
        return;
    }
    if (depth > GLTF_DEEPEST) {
        json_fail(&node, "expected nodes in a tree of at most %d levels", GLTF_DEEPEST);
        return;
    }
    g->visited[index] = true;
    if (is_hidden(&node))
        return;
    if (!gltf_node_transform(g, &node, &own)) {
        if (!gltf_failed(g))
            gltf_note(g, LOG_WARNING, "a node scaled to nothing is left out");
        return;
    }
    to_world = transform_multiply(parent, &own);
    gltf_add_mesh(g, &node, &to_world);
    gltf_add_light(g, &node, &to_world);
    gltf_add_camera(g, &node, &to_world);
    json_value children = json_member(&node, "children");
    if (!gltf_failed(g))
        add_children(g, nodes, &children, &to_world, depth + 1);
}

/* Nodes that are nobody's child: what to show where the file names no scene. */
static void add_roots(gltf *g, const json_value *nodes)
{
    transform identity = transform_identity();
    for (guint i = 0; i < g->n_nodes && !gltf_failed(g); i++)
        if (g->parents[i] == NO_INDEX)
            add_node(g, nodes, i, &identity, 0);
}

static void add_scene(gltf *g)
{
    json_value nodes = json_member(&g->root, "nodes");
    json_value scenes = json_member(&g->root, "scenes");
    g->visited = g_new0(bool, json_length(&nodes) + 1);
    if (!json_exists(&scenes)) {
        add_roots(g, &nodes);
        return;
    }
    gint64 shown = MAX(0, json_whole(&g->root, "scene", GLTF_MOST));
    json_value of = json_element(&scenes, (guint)shown);
    json_value list = json_member(&of, "nodes");
    transform identity = transform_identity();
    if (!gltf_failed(g))
        add_children(g, &nodes, &list, &identity, 0);
}

/* ---- What the file is ---- */

static void check_version(gltf *g)
{
    json_value asset = json_member(&g->root, "asset");
    const char *version = json_text(&asset, "version");
    if (!version || !g_str_has_prefix(version, "2."))
        json_fail(&asset, "expected glTF of \"version\" 2, found %s",
                  version ? version : "none");
}

/* Element i of a list of names; NULL if it is not a string. */
static const char *name_at(const json_value *list, guint i, json_value *name)
{
    *name = json_element(list, i);
    bool is_text = JSON_NODE_HOLDS_VALUE(name->node) &&
                   json_node_get_value_type(name->node) == G_TYPE_STRING;
    return is_text ? json_node_get_string(name->node) : NULL;
}

/* Without what a file requires it may look otherwise; what can not be read without it is
 * refused, and what is not known may be that. */
static void check_required(gltf *g)
{
    json_value required = json_member(&g->root, "extensionsRequired"), at;
    guint n = json_length(&required);
    for (guint i = 0; i < n; i++) {
        const char *name = name_at(&required, i, &at);
        const gltf_extension_row *row = name ? gltf_find_extension(name) : NULL;
        if (!name)
            json_fail(&at, "expected a string");
        else if (!row || row->support == GLTF_REFUSED)
            json_fail(&at, "the file requires the extension %s, which is not supported",
                      name);
    }
}

/* Of the extensions that a file uses, those that are left out, and those not known. */
static void note_extensions(gltf *g, const char *list)
{
    json_value used = json_member(&g->root, list), at;
    guint n = json_length(&used);
    for (guint i = 0; i < n; i++) {
        const char *name = name_at(&used, i, &at);
        const gltf_extension_row *row = name ? gltf_find_extension(name) : NULL;
        if (name && (!row || row->support == GLTF_LEFT_OUT))
            gltf_note(g, LOG_WARNING, "%s is left out", name);
    }
}

static void make_room(gltf *g)
{
    json_value materials = json_member(&g->root, "materials");
    json_value buffers = json_member(&g->root, "buffers");
    g->n_materials = json_length(&materials);
    json_value meshes = json_member(&g->root, "meshes");
    g->n_buffers = json_length(&buffers);
    g->n_meshes = json_length(&meshes);
    g->buffers = g_new0(GBytes *, g->n_buffers + 1);
    g->materials = g_new0(gltf_material_info, g->n_materials + 1);
    for (guint i = 0; i <= g->n_materials; i++)
        g->materials[i] =
            (gltf_material_info){.index = NO_INDEX, .solid_index = NO_INDEX};
    g->meshes = g_new0(gltf_mesh_info, g->n_meshes + 1);
}

static void read_document(gltf *g)
{
    check_version(g);
    check_required(g);
    if (gltf_failed(g))
        return;
    make_room(g);
    gltf_find_parents(g);
    gltf_read_animations(g);
    gltf_survey(g);
    note_extensions(g, "extensionsUsed");
    note_extensions(g, "extensionsRequired");
    if (!gltf_failed(g))
        add_scene(g);
    if (g->n_solid > 0)
        gltf_note(g, LOG_NOTE,
                  "%u closed mesh%s let%s light pass, thin by the standard: read as "
                  "solid glass",
                  g->n_solid, g->n_solid == 1 ? "" : "es", g->n_solid == 1 ? "s" : "");
}

/* ---- Files ---- */

static uint32_t word_at(const char *bytes)
{
    uint32_t word;
    memcpy(&word, bytes, sizeof word);
    return GUINT32_FROM_LE(word);
}

/* A chunk of a .glb at *at, which moves behind it. */
static const char *next_chunk(const input *in, size_t *at, uint32_t type, size_t *size)
{
    if (in->size - *at < CHUNK_HEADER || word_at(in->data + *at + 4) != type)
        return NULL;
    *size = word_at(in->data + *at);
    if (*size > in->size - *at - CHUNK_HEADER)
        return NULL;
    const char *bytes = in->data + *at + CHUNK_HEADER;
    *at += CHUNK_HEADER + *size;
    return bytes;
}

static bool is_glb(const char *data, size_t size)
{
    return size >= GLB_HEADER && memcmp(data, "glTF", 4) == 0;
}

/* The text of the document, and the binary chunk beside it. */
static bool find_document(gltf *g, const input *in, const char **text, size_t *size,
                          GError **error)
{
    source_place place = {intern(g->path), 0, 0};
    size_t at = GLB_HEADER, binary_size;
    *text = in->data;
    *size = in->size;
    if (!is_glb(in->data, in->size))
        return true;
    *text = next_chunk(in, &at, CHUNK_JSON, size);
    if (word_at(in->data + 4) != 2 || !*text) {
        error_at(error, place, "damaged .glb file: expected version 2 and a JSON chunk");
        return false;
    }
    const char *binary = next_chunk(in, &at, CHUNK_BIN, &binary_size);
    if (binary)
        g->binary = g_bytes_new_static(binary, binary_size);
    return true;
}

static void clear(gltf *g)
{
    for (guint i = 0; i < g->n_buffers; i++)
        g_clear_pointer(&g->buffers[i], g_bytes_unref);
    for (guint i = 0; g->materials && i <= g->n_materials; i++) {
        params_free(g->materials[i].area_light);
        params_free(g->materials[i].both_sides);
        params_free(g->materials[i].alpha);
    }
    g_free(g->buffers);
    g_free(g->materials);
    g_free(g->meshes);
    g_free(g->visited);
    gltf_forget_animations(g);
    g_free(g->parents);
    g_clear_pointer(&g->binary, g_bytes_unref);
    g_hash_table_unref(g->notes);
    g_free(g->directory);
}

static bool read_input(gltf *g, const input *in, GError **error)
{
    const char *text;
    size_t size;
    if (!find_document(g, in, &text, &size, error) ||
        !json_open(&g->json, g->path, text, size, error))
        return false;
    g->root = json_root(&g->json);
    read_document(g);
    if (gltf_failed(g))
        g_propagate_error(error, g_steal_pointer(&g->json.error));
    json_close(&g->json);
    /* A model that just glows here and there is looked at by a viewer's light; who makes
     * it brighter than paper, or sets up a camera, lights something by it. */
    bool is_look = !g->shines && !g->builder->has_camera;
    return !*error && scene_complete(g->builder, g->path, vec3_make(0.0f, 1.0f, 0.0f),
                                     is_look, error);
}

static bool read_gltf(scene_builder *to, const char *path, GError **error)
{
    input in;
    g_autoptr(GError) inner = NULL;
    if (!input_open(&in, path, &inner)) {
        error_move_at(error, (source_place){intern(path), 0, 0}, g_steal_pointer(&inner));
        return false;
    }
    g_autofree char *absolute = g_canonicalize_filename(path, NULL);
    gltf g = {.builder = to,
              .path = path,
              .directory = g_path_get_dirname(absolute),
              .notes = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL),
              .solid = !to->thin_glass};
    bool done = read_input(&g, &in, &inner);
    clear(&g);
    input_close(&in);
    if (!done)
        g_propagate_error(error, g_steal_pointer(&inner));
    return done;
}

static const char *const extensions[] = {".gltf", ".glb", NULL};

const format_reader gltf_reader = {.name = "glTF 2.0",
                                   .extensions = extensions,
                                   .recognises = is_glb,
                                   .read = read_gltf};
