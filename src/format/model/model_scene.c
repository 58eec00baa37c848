/*
 * OBJ, STL, 3MF, Collada and FBX: what nephroid-import told of a file, as our meshes,
 * materials, lights and camera.
 *
 *   file ─► importer (a child) ─► bytes ─► model (checked) ─► builder_add_*
 *
 * Wavefront's files say nothing of units or of which way is up; metres and +y are taken,
 * and +z for formats of machines that cut and print.
 */
#include "format/model/model_scene.h"

#include "base/intern.h"
#include "base/memory.h"
#include "format/defaults.h"
#include "format/model/importer.h"
#include "format/model/obj_materials.h"
#include "format/reader.h"
#include "shape/mesh_closed.h"

#include <math.h>
#include <string.h>

/* ---- Meshes ---- */

static float *copy_floats(const float *from, size_t n, size_t padding, GError **error)
{
    float *out = big_alloc(n + padding, sizeof *out, "mesh", error);
    if (out)
        memcpy(out, from, n * sizeof *out);
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

static bool copy_uvs(const model_mesh *from, mesh *m, GError **error)
{
    m->uvs = big_alloc(from->n_vertices, sizeof *m->uvs, "mesh", error);
    for (size_t i = 0; m->uvs && i < from->n_vertices; i++) {
        const float *uv = from->uvs + 2 * i;
        m->uvs[i] =
            (vec2){isfinite(uv[0]) ? uv[0] : 0.0f, isfinite(uv[1]) ? uv[1] : 0.0f};
    }
    return m->uvs != NULL;
}

static bool copy_mesh(const model_mesh *from, mesh *m, GError **error)
{
    size_t n = m->n_vertices = from->n_vertices;
    m->n_triangles = from->n_triangles;
    m->positions = copy_floats(from->positions, 3 * n, 1, error);
    m->indices = m->positions
                     ? big_alloc(3 * from->n_triangles, sizeof *m->indices, "mesh", error)
                     : NULL;
    if (!m->indices)
        return false;
    memcpy(m->indices, from->indices, 3 * from->n_triangles * sizeof *m->indices);
    if (from->normals && !(m->normals = copy_floats(from->normals, 3 * n, 0, error)))
        return false;
    if (from->normals && !make_unit(m->normals, n))
        g_clear_pointer(&m->normals, big_free);
    return !from->uvs || copy_uvs(from, m, error);
}

static bool add_shape(model_builder *b, mesh *m, const model_look *look, int index,
                      const transform *to_world, GError **error)
{
    float_input alpha;
    shape_place at = {
        .to_world = *to_world, .material = index, .area_light = look->area_light};
    const source_place place = {intern(b->path), 0, 0};
    if (look->alpha) {
        if (!float_input_init(&alpha, &b->builder->build, look->alpha, "alpha", 1.0f,
                              error))
            return false;
        if (!alpha.texture && !(alpha.constant > 0.0f))
            return true;
        at.alpha = &alpha;
    }
    return builder_add_mesh(b->builder, m, &at, place, error);
}

static bool is_closed(const mesh *m, bool thin, bool *closed, GError **error)
{
    mesh_body body = {0};
    *closed = false;
    if (!thin && !mesh_body_of(m, &body, error))
        return false;
    *closed = body.closed;
    return true;
}

static bool add_mesh(model_builder *b, const model_mesh *from, const transform *to_world,
                     GError **error)
{
    mesh m = {0};
    bool closed = true;
    const model_look *look = model_look_of(b, from->material, error);
    bool done =
        look && copy_mesh(from, &m, error) &&
        (!look->is_glass || is_closed(&m, b->builder->thin_glass, &closed, error));
    if (done && m.n_triangles > 0) {
        int index = model_material_index(b, from->material, closed, error);
        done = index != NO_INDEX && add_shape(b, &m, look, index, to_world, error);
    }
    mesh_clear(&m);
    return done;
}

static bool add_instances(model_builder *b, GError **error)
{
    const model *m = b->source;
    for (guint i = 0; i < m->instances->len; i++) {
        const stream_instance *at = m->instances->pdata[i];
        transform to_world;
        if (!model_transform(at->to_world, &to_world))
            model_tell(b, "a node that is flattened is left out");
        else if (!add_mesh(b, &g_array_index(m->meshes, model_mesh, at->mesh), &to_world,
                           error))
            return false;
    }
    return true;
}

/* ---- The formats ---- */

/* Few, and each is tested: of a format that is read, all faults of its importer are. What
 * its name ends in, what people call it, and which way is up in it. */
#define EACH_FORMAT(ROW)                                                                 \
    ROW(".obj", "OBJ", 0, 1, 0)                                                          \
    ROW(".stl", "STL", 0, 0, 1)                                                          \
    ROW(".3mf", "3MF", 0, 0, 1)                                                          \
    ROW(".dae", "Collada", 0, 1, 0)                                                      \
    ROW(".fbx", "FBX", 0, 1, 0)

typedef struct model_format {
    const char *extension, *name;
    vec3 up;
} model_format;

#define FORMAT(extension, name, x, y, z) {extension, name, {x, y, z}},
static const model_format formats[] = {EACH_FORMAT(FORMAT)};

#define EXTENSION(extension, name, x, y, z) extension,
static const char *const extensions[] = {EACH_FORMAT(EXTENSION) NULL};

static const model_format *format_of(const char *path)
{
    g_autofree char *name = g_ascii_strdown(path, -1);
    for (size_t i = 0; i < G_N_ELEMENTS(formats); i++)
        if (g_str_has_suffix(name, formats[i].extension))
            return &formats[i];
    return NULL;
}

/* ---- The file ---- */

#define MOST_GEOMETRY (UINT64_C(8) << 30) /* bytes; what one machine renders */

/* One mesh stands in the file once and may stand in the world a million times. */
static bool is_bearable(const model_builder *b, GError **error)
{
    uint64_t bytes = 0, n_triangles = 0;
    const model *m = b->source;
    for (guint i = 0; i < m->instances->len; i++) {
        const stream_instance *at = m->instances->pdata[i];
        const model_mesh *is = &g_array_index(m->meshes, model_mesh, at->mesh);
        bytes += 32 * is->n_vertices + 12 * is->n_triangles;
        n_triangles += is->n_triangles;
    }
    if (n_triangles == 0)
        error_at(error, (source_place){intern(b->path), 0, 0},
                 "expected a mesh, found none");
    else if (bytes > MOST_GEOMETRY)
        error_at(error, (source_place){intern(b->path), 0, 0},
                 "its nodes show meshes so often that they would take %.1f GB of memory, "
                 "and may take %.1f",
                 (double)bytes * 0x1p-30, (double)MOST_GEOMETRY * 0x1p-30);
    return n_triangles > 0 && bytes <= MOST_GEOMETRY;
}

static bool build(model_builder *b, GError **error)
{
    return is_bearable(b, error) && add_instances(b, error) &&
           model_add_lights(b, error) && model_add_camera(b, error) &&
           scene_complete(b->builder, b->path, b->up, false, error);
}

static bool ask_importer(scene_builder *to, const char *path, const model_format *format,
                         void **bytes, size_t *size, GError **error)
{
    g_autoptr(GArray) files = strcmp(format->extension, ".obj") == 0
                                  ? obj_material_files(to, path)
                                  : g_array_new(FALSE, FALSE, sizeof(import_file));
    const import_job job = {.path = path,
                            .extension = format->extension + 1,
                            .format = format->name,
                            .files = (const import_file *)(void *)files->data,
                            .n_files = files->len,
                            .cancel = to->build.cancel};
    *bytes = importer_run(&job, size, error);
    return *bytes != NULL;
}

static bool read_bytes(const void *bytes, size_t size, const char *path, model *out,
                       GError **error)
{
    g_autoptr(GError) inner = NULL;
    bool done = model_read(bytes, size, out, &inner);
    if (!done && g_error_matches(inner, NEPH_ERROR, ERROR_INPUT))
        g_prefix_error(&inner, "%s: ", path);
    if (!done)
        g_propagate_error(error, g_steal_pointer(&inner));
    return done;
}

static void free_looks(model_builder *b)
{
    for (guint i = 0; b->looks && i < b->source->materials->len; i++) {
        params_free(b->looks[i].area_light);
        params_free(b->looks[i].alpha);
    }
    g_free(b->looks);
}

static bool read_model(scene_builder *to, const char *path, GError **error)
{
    const model_format *format = format_of(path);
    void *bytes;
    size_t size;
    model m = {0};
    if (!ask_importer(to, path, format, &bytes, &size, error))
        return false;
    g_autofree char *absolute = g_canonicalize_filename(path, NULL);
    g_autofree char *directory = g_path_get_dirname(absolute);
    g_autoptr(GHashTable) notes =
        g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    model_builder b = {.builder = to,
                       .path = path,
                       .directory = directory,
                       .source = &m,
                       .notes = notes,
                       .up = format->up};
    bool done = read_bytes(bytes, size, path, &m, error);
    for (guint i = 0; m.notes && i < m.notes->len; i++)
        model_tell(&b, "%s", (const char *)m.notes->pdata[i]);
    done = done && build(&b, error);
    free_looks(&b);
    model_clear(&m);
    big_free(bytes);
    return done;
}

const format_reader model_reader = {
    .name = "models", .extensions = extensions, .read = read_model};
