/*
 * For tests of the glTF reader: small files around a tetrahedron, loaded from a folder
 * that goes away with the test.
 */
#pragma once

#include "bsdf/bsdf_models.h"
#include "scene_text.h"

/* ---- Files ---- */

/* A tetrahedron with its corners at the origin and 1 along each axis: positions, a copy
   of them as normalised bytes, indices; then two sparse values. */
typedef struct body {
    float positions[12];
    uint8_t bytes[16]; /* 3 a vertex, 4 apart */
    uint16_t indices[12];
    uint16_t sparse_index, padding;
    float sparse_value[3];
} body;

static const body tetrahedron = {
    .positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1},
    .bytes = {0, 0, 0, 9, 255, 0, 0, 9, 0, 255, 0, 9, 0, 0, 255, 9},
    .indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3},
    .sparse_index = 3,
    .sparse_value = {0, 0, 5},
};

#define VIEWS                                                                            \
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},"                                 \
    "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":16,\"byteStride\":4},"               \
    "{\"buffer\":0,\"byteOffset\":64,\"byteLength\":24},"                                \
    "{\"buffer\":0,\"byteOffset\":88,\"byteLength\":2},"                                 \
    "{\"buffer\":0,\"byteOffset\":92,\"byteLength\":12}],"                               \
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":"      \
    "\"VEC3\"},{\"bufferView\":1,\"componentType\":5121,\"normalized\":true,\"count\":4" \
    ",\"type\":\"VEC3\"},{\"bufferView\":2,\"componentType\":5123,\"count\":12,\"type\"" \
    ":\"SCALAR\"},{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":"        \
    "\"VEC3\",\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":3,\"componentType\":"  \
    "5123},\"values\":{\"bufferView\":4}}}]"

#define HEAD "{\"asset\":{\"version\":\"2.0\"},"
#define MESH(position)                                                                   \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":" position               \
    "},\"indices\":2,\"material\":0}]}],"
#define NODES "\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}],"

static inline char *buffer_uri(void)
{
    g_autofree char *code =
        g_base64_encode((const guchar *)&tetrahedron, sizeof tetrahedron);
    return g_strdup_printf("\"buffers\":[{\"byteLength\":%zu,\"uri\":\"data:application/"
                           "octet-stream;base64,%s\"}],",
                           sizeof tetrahedron, code);
}

/* The middle of a file, completed by buffers and views. */
static inline char *document(const char *middle)
{
    g_autofree char *buffers = buffer_uri();
    return g_strdup_printf(HEAD "%s%s" VIEWS "}", middle, buffers);
}

typedef struct notes {
    GString *text;
} notes;

static inline void keep_note(log_level level, const char *text, void *data)
{
    (void)level;
    g_string_append_printf(((notes *)data)->text, "%s\n", text);
}

static bool thin_glass; /* for the next load */

/* Loads a file of these bytes; NULL with its error. */
static inline scene *load_bytes(const char *name, const char *bytes, gssize size,
                                notes *kept, GError **error)
{
    scene_folder f = folder_new("");
    folder_write(&f, name, bytes, size);
    folder_write(&f, "body.bin", (const char *)&tetrahedron, sizeof tetrahedron);
    g_autofree char *path = g_build_filename(f.path, name, NULL);
    const log_sink sink = {keep_note, kept};
    const load_options how = {
        .threads = 1, .thin_glass = thin_glass, .log = kept ? &sink : NULL};
    scene *s = format_load_with(path, &how, error);
    folder_remove(&f);
    return s;
}

static inline scene *load(const char *middle, notes *kept)
{
    g_autofree char *text = document(middle);
    g_autoptr(GError) error = NULL;
    scene *s = load_bytes("a.gltf", text, -1, kept, &error);
    g_assert_no_error(error);
    return s;
}

/** The same with the view that it describes. */
static inline view *load_shown(const char *middle, notes *kept)
{
    scene_folder f = folder_new("");
    g_autofree char *text = document(middle);
    folder_write(&f, "a.gltf", text, -1);
    folder_write(&f, "body.bin", (const char *)&tetrahedron, sizeof tetrahedron);
    g_autofree char *path = g_build_filename(f.path, "a.gltf", NULL);
    const log_sink sink = {keep_note, kept};
    g_autoptr(GError) error = NULL;
    view *v = load_view(path, kept ? &sink : NULL, &error);
    g_assert_no_error(error);
    folder_remove(&f);
    return v;
}

static inline void assert_at(vec3 p, float x, float y, float z)
{
    vec3 off = abs3(p - vec3_make(x, y, z));
    if (!(max_component3(off) < 2e-5f))
        g_error("(%g, %g, %g) is not (%g, %g, %g)", (double)p[0], (double)p[1],
                (double)p[2], (double)x, (double)y, (double)z);
}

#define UNLIT ",\"extensions\":{\"KHR_materials_unlit\":{}}"

static inline const material *material_of(const char *json, notes *kept, scene **owner)
{
    g_autofree char *text = g_strdup_printf("\"materials\":[%s]," MESH("0") NODES, json);
    *owner = load(text, kept);
    const shape *on = (*owner)->shapes->pdata[0];
    return (*owner)->materials->pdata[on->material];
}

static inline bsdf bsdf_of(const material *m)
{
    static const bsdf_options plain = {0};
    wavelengths w = wavelengths_at(0.5f);
    surface_hit hit = {
        .n = {0, 0, 1}, .n_geom = {0, 0, 1}, .dpdu = {1, 0, 0}, .dpdv = {0, 1, 0}};
    bsdf b;
    material_bsdf(m, &hit, &w, ALL_WAVELENGTHS, &plain, &b);
    return b;
}

#define GLASS(more)                                                                      \
    "{\"pbrMetallicRoughness\":{\"roughnessFactor\":0,\"metallicFactor\":0},"            \
    "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1}" more     \
    "}}"
