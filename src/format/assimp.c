/*
 * OBJ, STL and whatever else assimp reads: its meshes, nodes, materials, lights and
 * cameras as ours.
 *
 * Wavefront's files say nothing of units or of which way is up; metres and +y are taken,
 * and +z for formats of machines that cut and print.
 */
#include "format/assimp.h"

#include "base/intern.h"
#include "base/memory.h"
#include "format/defaults.h"
#include "format/obj_materials.h"
#include "format/reader.h"
#include "shape/mesh_closed.h"

#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_NODE_DEPTH = 1000 };

static const unsigned STEPS = aiProcess_Triangulate | aiProcess_SortByPType |
                              aiProcess_JoinIdenticalVertices |
                              aiProcess_ValidateDataStructure;

params *assimp_params(const assimp_reader *r)
{
    return params_new((source_place){intern(r->path), 0, 0}, r->directory,
                      color_space_srgb());
}

void assimp_note(assimp_reader *r, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    char *text = g_strdup_vprintf(format, args);
    va_end(args);
    if (!g_hash_table_contains(r->notes, text))
        log_message(&r->scene->build.log, LOG_WARNING, "%s: %s", r->path, text);
    g_hash_table_add(r->notes, text);
}

/* ---- Meshes ---- */

static float *copy_vectors(const struct aiVector3D *from, size_t n, size_t padding,
                           GError **error)
{
    float *out = big_alloc(3 * n + padding, sizeof *out, "mesh", error);
    for (size_t i = 0; out && i < n; i++) {
        out[3 * i] = from[i].x;
        out[3 * i + 1] = from[i].y;
        out[3 * i + 2] = from[i].z;
    }
    return out;
}

/* Normals that are none (zero or not finite) make the mesh flat. */
static bool make_unit(float *normals, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        vec3 v = vec3_make(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]);
        float length = length3(v);
        if (!(length > 0.0f) || !isfinite(length))
            return false;
        for (int c = 0; c < 3; c++)
            normals[3 * i + (size_t)c] = v[c] / length;
    }
    return true;
}

static bool copy_faces(const struct aiMesh *from, mesh *m, GError **error)
{
    m->indices =
        big_alloc(3 * (size_t)from->mNumFaces, sizeof *m->indices, "mesh", error);
    for (size_t i = 0; m->indices && i < from->mNumFaces; i++)
        if (from->mFaces[i].mNumIndices == 3)
            memcpy(m->indices + 3 * m->n_triangles++, from->mFaces[i].mIndices,
                   3 * sizeof *m->indices);
    return m->indices != NULL;
}

static bool copy_mesh(const struct aiMesh *from, mesh *m, GError **error)
{
    size_t n = m->n_vertices = from->mNumVertices;
    m->positions = copy_vectors(from->mVertices, n, 1, error);
    if (!m->positions || !copy_faces(from, m, error))
        return false;
    if (from->mNormals) {
        m->normals = copy_vectors(from->mNormals, n, 0, error);
        if (!m->normals)
            return false;
        if (!make_unit(m->normals, n))
            g_clear_pointer(&m->normals, big_free);
    }
    if (!from->mTextureCoords[0])
        return true;
    m->uvs = big_alloc(n, sizeof *m->uvs, "mesh", error);
    for (size_t i = 0; m->uvs && i < n; i++) {
        const struct aiVector3D *uv = &from->mTextureCoords[0][i];
        m->uvs[i] =
            (vec2){isfinite(uv->x) ? uv->x : 0.0f, isfinite(uv->y) ? uv->y : 0.0f};
    }
    return m->uvs != NULL;
}

static bool add_shape(assimp_reader *r, mesh *m, const assimp_material *material_is,
                      int index, const transform *to_world, GError **error)
{
    float_input alpha;
    shape_place at = {
        .to_world = *to_world, .material = index, .area_light = material_is->area_light};
    const source_place place = {intern(r->path), 0, 0};
    if (material_is->alpha) {
        if (!float_input_init(&alpha, &r->scene->build, material_is->alpha, "alpha", 1.0f,
                              error))
            return false;
        if (!alpha.texture && !(alpha.constant > 0.0f))
            return true;
        at.alpha = &alpha;
    }
    return scene_add_mesh(r->scene, m, &at, place, error);
}

static bool has_indices_in_range(const mesh *m)
{
    for (size_t i = 0; i < 3 * m->n_triangles; i++)
        if (m->indices[i] >= m->n_vertices)
            return false;
    return true;
}

/* Corrupt meshes are left to the scene to refuse. */
static bool is_closed(const mesh *m, bool thin, bool *closed, GError **error)
{
    mesh_body body = {0};
    *closed = false;
    if (!thin && has_indices_in_range(m) && !mesh_body_of(m, &body, error))
        return false;
    *closed = body.closed;
    return true;
}

static bool add_mesh(assimp_reader *r, const struct aiMesh *from,
                     const transform *to_world, GError **error)
{
    mesh m = {0};
    bool closed = true;
    if (!(from->mPrimitiveTypes & aiPrimitiveType_TRIANGLE)) {
        assimp_note(r, "points and lines are left out");
        return true;
    }
    const assimp_material *of = assimp_material_of(r, from->mMaterialIndex, error);
    bool done = of && copy_mesh(from, &m, error) &&
                (!of->is_glass || is_closed(&m, r->scene->thin_glass, &closed, error));
    if (done && m.n_triangles > 0) {
        int index = assimp_material_index(r, from->mMaterialIndex, closed, error);
        done = index != NO_INDEX && add_shape(r, &m, of, index, to_world, error);
    }
    mesh_clear(&m);
    return done;
}

/* ---- Nodes ---- */

bool assimp_transform(const struct aiMatrix4x4 *m, transform *out)
{
    const float *f = &m->a1;
    double rows[4][4];
    for (int i = 0; i < 16; i++)
        rows[i / 4][i % 4] = (double)f[i];
    return transform_from_matrix((const double(*)[4])rows, out);
}

transform assimp_node_to_world(const assimp_reader *r, const char *name)
{
    transform to_world = transform_identity(), own;
    const struct aiNode *node = NULL;
    GPtrArray *open = g_ptr_array_new();
    g_ptr_array_add(open, r->source->mRootNode);
    for (guint i = 0; i < open->len && !node; i++) {
        struct aiNode *at = open->pdata[i];
        if (strcmp(at->mName.data, name) == 0)
            node = at;
        for (unsigned k = 0; k < at->mNumChildren; k++)
            g_ptr_array_add(open, at->mChildren[k]);
    }
    g_ptr_array_unref(open);
    for (; node; node = node->mParent)
        if (assimp_transform(&node->mTransformation, &own))
            to_world = transform_multiply(&own, &to_world);
    return to_world;
}

static bool add_node(assimp_reader *r, const struct aiNode *node, const transform *parent,
                     int depth, GError **error)
{
    transform own;
    if (depth > MAX_NODE_DEPTH || !assimp_transform(&node->mTransformation, &own)) {
        assimp_note(r, "a node that is flattened, or too deep, is left out");
        return true;
    }
    transform to_world = transform_multiply(parent, &own);
    for (unsigned i = 0; i < node->mNumMeshes; i++)
        if (!add_mesh(r, r->source->mMeshes[node->mMeshes[i]], &to_world, error))
            return false;
    for (unsigned i = 0; i < node->mNumChildren; i++)
        if (!add_node(r, node->mChildren[i], &to_world, depth + 1, error))
            return false;
    return true;
}

/* ---- The file ---- */

static void note_left_out(assimp_reader *r)
{
    bool bones = false;
    for (unsigned i = 0; i < r->source->mNumMeshes; i++)
        bones |= r->source->mMeshes[i]->mNumBones > 0;
    if (bones || r->source->mNumAnimations > 0)
        assimp_note(r, "animations and bones are left out: it stands as it was modelled");
}

static bool build(assimp_reader *r, GError **error)
{
    const transform identity = transform_identity();
    note_left_out(r);
    obj_check_materials(r->scene, r->path);
    return add_node(r, r->source->mRootNode, &identity, 0, error) &&
           assimp_add_lights(r, error) && assimp_add_camera(r, error) &&
           scene_complete(r->scene, r->path, r->up, false, error);
}

static vec3 up_of(const char *path)
{
    static const char *const z_up[] = {".stl", ".3mf", ".amf", ".off", ".dxf", ".ifc"};
    g_autofree char *name = g_ascii_strdown(path, -1);
    for (size_t i = 0; i < G_N_ELEMENTS(z_up); i++)
        if (g_str_has_suffix(name, z_up[i]))
            return vec3_make(0.0f, 0.0f, 1.0f);
    return vec3_make(0.0f, 1.0f, 0.0f);
}

/* assimp makes room for as many vertices and faces as an OFF file says it has; none is
 * written with fewer than two characters. */
static bool off_is_possible(const char *path)
{
    g_autofree char *text = NULL, *name = g_ascii_strdown(path, -1);
    gsize size;
    unsigned long vertices, faces;
    if (!g_str_has_suffix(name, ".off") || !g_file_get_contents(path, &text, &size, NULL))
        return true;
    const char *numbers = text + strcspn(text, " \r\n\t");
    return sscanf(numbers, "%lu %lu", &vertices, &faces) != 2 ||
           (vertices < size && faces < size);
}

static bool read_file(assimp_reader *r, GError **error)
{
    const source_place place = {intern(r->path), 0, 0};
    if (!g_file_test(r->path, G_FILE_TEST_IS_REGULAR)) {
        error_at(error, place, "expected a file, found none");
        return false;
    }
    if (!off_is_possible(r->path)) {
        error_at(error, place, "a file this short cannot hold what it claims to");
        return false;
    }
    r->source = assimp_import(r->scene->build.sources, r->path, STEPS);
    if (!r->source) {
        error_at(error, place, "%s", aiGetErrorString());
        return false;
    }
    if (r->source->mRootNode && r->source->mNumMeshes > 0)
        return build(r, error);
    error_at(error, place, "expected a mesh, found none");
    return false;
}

static bool read_assimp(scene *s, const char *path, GError **error)
{
    g_autofree char *absolute = g_canonicalize_filename(path, NULL);
    assimp_reader r = {.scene = s,
                       .path = path,
                       .directory = g_path_get_dirname(absolute),
                       .notes =
                           g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL),
                       .up = up_of(path)};
    r.materials = NULL;
    bool done = read_file(&r, error);
    for (unsigned i = 0; r.materials && i < r.source->mNumMaterials; i++) {
        params_free(r.materials[i].area_light);
        params_free(r.materials[i].alpha);
    }
    aiReleaseImport(r.source);
    g_free(r.materials);
    g_hash_table_unref(r.notes);
    g_free(r.directory);
    return done;
}

static const char *const extensions[] = {
    ".obj",     ".stl",    ".dae", ".fbx", ".3ds", ".3mf", ".blend", ".x",       ".lwo",
    ".lws",     ".off",    ".ac",  ".ase", ".dxf", ".md2", ".md3",   ".md5mesh", ".ms3d",
    ".smd",     ".b3d",    ".x3d", ".ifc", ".xgl", ".zgl", ".nff",   ".raw",     ".ter",
    ".q3o",     ".q3s",    ".cob", ".scn", ".irr", ".mdl", ".ndo",   ".ogex",    ".amf",
    ".irrmesh", ".assbin", ".m3d", ".wrl", NULL};

const format_reader assimp_reader_kind = {
    .name = "by assimp", .extensions = extensions, .read = read_assimp};
