/*
 * Where glTF keeps its numbers: buffers (a file beside it, a data: URI or the binary
 * chunk) are cut into views, and accessors say what numbers stand in a view.
 *
 *   accessor ─► bufferView ─► buffer      element i at view + byteOffset + i * stride
 *       └─ sparse: indices and values that replace some of them
 *
 * Every offset and size comes from the file; all are checked against the bytes that are
 * there before anything is read.
 */
#include "format/gltf/gltf.h"

#include "base/input.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

/* Elements that no bytes stand for: such an accessor is all zero but for what is sparse,
 * and its length is but a claim. */
enum { MOST_ZEROS = 1 << 24 };

enum { BYTE = 5120, UBYTE, SHORT, USHORT, UINT = 5125, FLOAT };

/* Elements in memory. */
typedef struct element_run {
    const uint8_t *bytes; /* of the first; NULL: all zero */
    size_t stride, count;
    unsigned n_components;
    int type;
    bool normalized;
} element_run;

static size_t component_size(int type)
{
    return type == BYTE || type == UBYTE ? 1 : type == SHORT || type == USHORT ? 2 : 4;
}

/* ---- Buffers and views ---- */

char *gltf_uri_path(gltf *g, const json_value *at, const char *uri)
{
    g_autofree char *scheme = g_uri_parse_scheme(uri);
    g_autofree char *name = scheme ? NULL : g_uri_unescape_string(uri, NULL);
    if (name)
        return g_canonicalize_filename(name, g->directory);
    json_fail(at, "expected a file's name or a data: URI, found \"%.60s\"", uri);
    return NULL;
}

static GBytes *data_uri_bytes(gltf *g, const json_value *at, const char *uri)
{
    const char *comma = strchr(uri, ',');
    if (!comma || comma - uri < 7 || strncmp(comma - 7, ";base64", 7) != 0) {
        json_fail(at, "expected a data: URI in base64");
        return NULL;
    }
    const char *code = comma + 1;
    size_t length = strlen(code);
    GError *error = NULL;
    guchar *bytes = big_alloc(length / 4 * 3 + 3, 1, "data: URI", &error);
    if (!bytes) {
        gltf_take_error(g, at, error);
        return NULL;
    }
    gint state = 0;
    guint save = 0;
    gsize size = g_base64_decode_step(code, length, bytes, &state, &save);
    return g_bytes_new_with_free_func(bytes, size, big_free, bytes);
}

GBytes *gltf_uri_bytes(gltf *g, const json_value *at, const char *uri)
{
    if (g_str_has_prefix(uri, "data:"))
        return data_uri_bytes(g, at, uri);
    g_autofree char *path = gltf_uri_path(g, at, uri);
    if (!path)
        return NULL;
    g_autoptr(GError) error = NULL;
    scene_sources_add(g->builder->build.sources, path);
    GBytes *bytes = input_bytes(path, &error);
    if (!bytes)
        gltf_take_error(g, at, g_steal_pointer(&error));
    return bytes;
}

static GBytes *read_buffer(gltf *g, const json_value *buffer, gint64 index)
{
    const char *uri = json_text(buffer, "uri");
    if (uri) {
        json_value at = json_member(buffer, "uri");
        return gltf_uri_bytes(g, &at, uri);
    }
    if (index == 0 && g->binary)
        return g_bytes_ref(g->binary);
    json_fail(buffer, "expected a 'uri', found none");
    return NULL;
}

/* The bytes of the buffer that a view names, as many as it says it has. */
static const uint8_t *buffer_bytes(gltf *g, const json_value *part, size_t *size)
{
    json_value array;
    gint64 index;
    json_value buffer = gltf_refer(g, part, "buffer", "buffers", &array, &index);
    if (!json_exists(&buffer))
        return NULL;
    gint64 length = json_whole(&buffer, "byteLength", G_MAXINT64 / 4);
    if (!g->buffers[index])
        g->buffers[index] = read_buffer(g, &buffer, index);
    if (!g->buffers[index] || gltf_failed(g))
        return NULL;
    const uint8_t *bytes = g_bytes_get_data(g->buffers[index], size);
    if (length < 0 || (guint64)length > *size) {
        json_fail(&buffer, "expected %" G_GINT64_FORMAT " bytes, found %zu", length,
                  *size);
        return NULL;
    }
    *size = (size_t)length;
    return bytes;
}

/* Meshopt's, if the buffer that has the same unpacked is a name alone. */
static bool is_packed(gltf *g, const json_value *part)
{
    json_value extensions, array;
    gint64 index;
    json_value packed = gltf_extension(part, "EXT_meshopt_compression", &extensions);
    if (!json_exists(&packed))
        return false;
    json_value buffer = gltf_refer(g, part, "buffer", "buffers", &array, &index);
    json_value uri = json_member(&buffer, "uri");
    if (json_exists(&uri) || gltf_failed(g))
        return false;
    json_fail(&packed, "meshes packed by meshopt are not supported");
    return true;
}

/* A view's bytes. *stride is 0 if it says nothing. */
static const uint8_t *view_bytes(gltf *g, const json_value *part, size_t *size,
                                 size_t *stride)
{
    size_t whole;
    const uint8_t *bytes = is_packed(g, part) ? NULL : buffer_bytes(g, part, &whole);
    gint64 offset = MAX(0, json_whole(part, "byteOffset", G_MAXINT64 / 4));
    gint64 length = json_whole(part, "byteLength", G_MAXINT64 / 4);
    gint64 step = json_whole(part, "byteStride", 252);
    if (gltf_failed(g) || !bytes)
        return NULL;
    if (length < 0 || (guint64)offset > whole ||
        (guint64)length > whole - (guint64)offset)
        json_fail(part, "expected a part of a buffer of %zu bytes", whole);
    else {
        *size = (size_t)length;
        *stride = step > 0 ? (size_t)step : 0;
        return bytes + offset;
    }
    return NULL;
}

GBytes *gltf_view_bytes(gltf *g, gint64 index)
{
    json_value views = json_member(&g->root, "bufferViews");
    json_value part = json_element(&views, (guint)index);
    size_t size, stride;
    const uint8_t *bytes = gltf_failed(g) ? NULL : view_bytes(g, &part, &size, &stride);
    return bytes ? g_bytes_new(bytes, size) : NULL;
}

/* ---- Accessors ---- */

static unsigned components_of(const json_value *accessor)
{
    static const char *const names[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    const char *type = json_text(accessor, "type");
    for (unsigned i = 0; type && i < G_N_ELEMENTS(names); i++)
        if (strcmp(type, names[i]) == 0)
            return i + 1;
    if (type && strcmp(type, "MAT4") == 0)
        return 16;
    json_fail(accessor, "expected \"type\" SCALAR, VEC2, VEC3, VEC4 or MAT4, found %s",
              type ? type : "none");
    return 1;
}

static int type_of(const json_value *of)
{
    gint64 type = json_whole(of, "componentType", GLTF_MOST);
    if ((type >= BYTE && type <= USHORT) || type == UINT || type == FLOAT)
        return (int)type;
    json_fail(of, "expected \"componentType\" 5120 to 5123, 5125 or 5126, found %d",
              (int)type);
    return FLOAT;
}

/* Puts a run into the view that of["bufferView"] names. */
static bool place_run(gltf *g, const json_value *of, element_run *run)
{
    json_value array;
    gint64 index;
    json_value part = gltf_refer(g, of, "bufferView", "bufferViews", &array, &index);
    if (!json_exists(&part))
        return !gltf_failed(g);
    gint64 offset = MAX(0, json_whole(of, "byteOffset", G_MAXINT64 / 4));
    size_t element = component_size(run->type) * run->n_components, size, stride;
    const uint8_t *bytes = view_bytes(g, &part, &size, &stride);
    if (!bytes || gltf_failed(g))
        return false;
    run->stride = stride ? stride : element;
    bool fits = (guint64)offset <= size && element <= size - (guint64)offset &&
                (run->count - 1) <= (size - (size_t)offset - element) / run->stride;
    if (run->stride < element || !fits) {
        json_fail(of, "%zu elements do not fit into a view of %zu bytes", run->count,
                  size);
        return false;
    }
    run->bytes = bytes + offset;
    return true;
}

static bool open_run(gltf *g, const json_value *accessor, element_run *run)
{
    gint64 count = json_whole(accessor, "count", GLTF_MOST);
    *run = (element_run){.n_components = components_of(accessor),
                         .type = type_of(accessor),
                         .normalized = json_flag(accessor, "normalized", false)};
    if (count < 1)
        json_fail(accessor, "expected a \"count\" of at least 1");
    run->count = (size_t)MAX(count, 1);
    run->stride = component_size(run->type) * run->n_components;
    if (gltf_failed(g) || !place_run(g, accessor, run))
        return false;
    if (run->bytes || count <= MOST_ZEROS)
        return true;
    json_fail(accessor, "expected a \"bufferView\" for more than %d elements",
              MOST_ZEROS);
    return false;
}

static uint32_t read_whole(const uint8_t *at, int type)
{
    uint16_t half;
    uint32_t whole;
    if (component_size(type) == 1)
        return *at;
    if (component_size(type) == 2) {
        memcpy(&half, at, sizeof half);
        return GUINT16_FROM_LE(half);
    }
    memcpy(&whole, at, sizeof whole);
    return GUINT32_FROM_LE(whole);
}

static float read_float(const uint8_t *at, const element_run *run)
{
    uint32_t bits = read_whole(at, run->type);
    float value;
    switch (run->type) {
    case FLOAT:
        memcpy(&value, &bits, sizeof value);
        return value;
    case BYTE:
        value = (float)(int8_t)bits;
        return run->normalized ? maxf(value / 127.0f, -1.0f) : value;
    case SHORT:
        value = (float)(int16_t)bits;
        return run->normalized ? maxf(value / 32767.0f, -1.0f) : value;
    case UBYTE:
        return run->normalized ? (float)bits / 255.0f : (float)bits;
    case USHORT:
        return run->normalized ? (float)bits / 65535.0f : (float)bits;
    default:
        return (float)bits;
    }
}

static void read_element(const element_run *run, size_t i, float *out)
{
    const uint8_t *at = run->bytes + i * run->stride;
    for (unsigned c = 0; c < run->n_components; c++)
        out[c] = read_float(at + c * component_size(run->type), run);
}

/* True if its bytes are the floats wanted. */
static bool is_plain(const element_run *run)
{
    return G_BYTE_ORDER == G_LITTLE_ENDIAN && run->type == FLOAT &&
           run->stride == run->n_components * sizeof(float);
}

static void read_all(const element_run *run, float *out)
{
    if (!run->bytes)
        return;
    if (is_plain(run)) {
        memcpy(out, run->bytes, run->count * run->stride);
        return;
    }
    for (size_t i = 0; i < run->count; i++)
        read_element(run, i, out + i * run->n_components);
}

static void replace_sparse(gltf *g, const json_value *accessor, const element_run *all,
                           float *out)
{
    json_value sparse = json_member(accessor, "sparse");
    if (!json_exists(&sparse))
        return;
    gint64 count = json_whole(&sparse, "count", (gint64)all->count);
    json_value indices = json_member(&sparse, "indices");
    json_value values = json_member(&sparse, "values");
    element_run where = {
        .n_components = 1, .type = type_of(&indices), .count = (size_t)MAX(count, 1)};
    element_run what = *all;
    what.count = where.count;
    what.bytes = NULL;
    if (count < 1)
        json_fail(&sparse, "expected a \"count\" of at least 1");
    if (gltf_failed(g) || !place_run(g, &indices, &where) ||
        !place_run(g, &values, &what))
        return;
    if (!where.bytes || !what.bytes || where.type == FLOAT) {
        json_fail(&sparse, "expected indices and values in buffer views");
        return;
    }
    for (size_t i = 0; i < where.count; i++) {
        uint32_t at = read_whole(where.bytes + i * where.stride, where.type);
        if (at >= all->count) {
            json_fail(&sparse, "expected indices below %zu, found %u", all->count, at);
            return;
        }
        read_element(&what, i, out + at * all->n_components);
    }
}

static bool find_run(gltf *g, const json_value *accessors, gint64 index,
                     json_value *accessor, element_run *run)
{
    *accessor = json_element(accessors, (guint)index);
    return !gltf_failed(g) && open_run(g, accessor, run);
}

float *gltf_read_floats(gltf *g, gint64 index, unsigned n_components, size_t padding,
                        size_t *count)
{
    json_value accessors = json_member(&g->root, "accessors"), accessor;
    element_run run;
    if (!find_run(g, &accessors, index, &accessor, &run))
        return NULL;
    if (run.n_components != n_components) {
        json_fail(&accessor, "expected %u components, found %u", n_components,
                  run.n_components);
        return NULL;
    }
    GError *error = NULL;
    size_t n = run.count * n_components + padding;
    float *out = big_alloc(n, sizeof *out, "mesh", &error);
    if (!out) {
        gltf_take_error(g, &accessor, error);
        return NULL;
    }
    read_all(&run, out);
    replace_sparse(g, &accessor, &run, out);
    *count = run.count;
    if (!gltf_failed(g))
        return out;
    big_free(out);
    return NULL;
}

unsigned gltf_components(gltf *g, gint64 index)
{
    json_value accessors = json_member(&g->root, "accessors");
    json_value accessor = json_element(&accessors, (guint)index);
    unsigned n = gltf_failed(g) ? 0 : components_of(&accessor);
    return gltf_failed(g) ? 0 : n;
}

uint32_t *gltf_read_indices(gltf *g, gint64 index, size_t *count)
{
    json_value accessors = json_member(&g->root, "accessors"), accessor;
    element_run run;
    if (!find_run(g, &accessors, index, &accessor, &run))
        return NULL;
    json_value sparse = json_member(&accessor, "sparse");
    if (run.n_components != 1 || run.type == FLOAT || !run.bytes ||
        json_exists(&sparse)) {
        json_fail(&accessor, "expected whole numbers in a buffer view as indices");
        return NULL;
    }
    GError *error = NULL;
    uint32_t *out = big_alloc(run.count, sizeof *out, "mesh", &error);
    if (!out) {
        gltf_take_error(g, &accessor, error);
        return NULL;
    }
    for (size_t i = 0; i < run.count; i++)
        out[i] = read_whole(run.bytes + i * run.stride, run.type);
    *count = run.count;
    return out;
}
