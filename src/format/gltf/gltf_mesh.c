/*
 * glTF primitives as meshes. Each becomes a shape of its own, since each has its own
 * material.
 *
 * glTF's texture coordinates go down from the upper left corner, ours up from the lower
 * left one: v becomes 1 - v.
 */
#include "format/gltf/gltf_pose.h"

#include "base/intern.h"
#include "base/memory.h"
#include "shape/mesh_closed.h"

#include <string.h>

enum { MODE_TRIANGLES = 4, MODE_STRIP, MODE_FAN };

/* ---- Reading ---- */

static bool check_count(const json_value *attributes, const char *name, size_t count,
                        const mesh *m)
{
    if (count == m->n_vertices)
        return true;
    json_value at = json_member(attributes, name);
    json_fail(&at, "expected %zu elements as in POSITION, found %zu", m->n_vertices,
              count);
    return false;
}

static bool read_positions(gltf *g, const json_value *attributes, mesh *m)
{
    gint64 index = json_whole(attributes, "POSITION", GLTF_MOST);
    if (index < 0)
        json_fail(attributes, "expected a POSITION, found none");
    else
        m->positions = gltf_read_floats(g, index, 3, 1, &m->n_vertices);
    return m->positions != NULL;
}

static void make_unit(float *n)
{
    vec3 v = vec3_make(n[0], n[1], n[2]);
    float length = length3(v);
    v = length > 0.0f ? v / length : vec3_make(0.0f, 0.0f, 1.0f);
    for (int c = 0; c < 3; c++)
        n[c] = v[c];
}

static bool read_normals(gltf *g, const json_value *attributes, mesh *m)
{
    size_t count;
    gint64 index = json_whole(attributes, "NORMAL", GLTF_MOST);
    if (index < 0)
        return !gltf_failed(g);
    m->normals = gltf_read_floats(g, index, 3, 0, &count);
    if (!m->normals || !check_count(attributes, "NORMAL", count, m))
        return false;
    for (size_t i = 0; i < count; i++)
        make_unit(m->normals + 3 * i);
    return true;
}

/* The fourth number, which way the bitangent goes, is what our coordinates make of it. */
static bool read_tangents(gltf *g, const json_value *attributes, mesh *m)
{
    size_t count;
    gint64 index = json_whole(attributes, "TANGENT", GLTF_MOST);
    if (index < 0)
        return !gltf_failed(g);
    m->tangents = gltf_read_floats(g, index, 4, 0, &count);
    if (!m->tangents || !check_count(attributes, "TANGENT", count, m))
        return false;
    for (size_t i = 0; i < count; i++)
        memmove(m->tangents + 3 * i, m->tangents + 4 * i, 3 * sizeof(float));
    return true;
}

static bool read_uvs(gltf *g, const json_value *attributes, const char *name,
                     const mesh *m, vec2 **out)
{
    size_t count;
    gint64 index = json_whole(attributes, name, GLTF_MOST);
    if (index < 0)
        return !gltf_failed(g);
    vec2 *uvs = *out = (vec2 *)(void *)gltf_read_floats(g, index, 2, 0, &count);
    if (!uvs || !check_count(attributes, name, count, m))
        return false;
    for (size_t i = 0; i < count; i++)
        uvs[i].y = 1.0f - uvs[i].y;
    return true;
}

/* Three components are opaque. */
static bool read_colors(gltf *g, const json_value *attributes, mesh *m)
{
    size_t count;
    gint64 index = json_whole(attributes, "COLOR_0", GLTF_MOST);
    unsigned n = index < 0 ? 0 : gltf_components(g, index);
    if (index < 0 || gltf_failed(g))
        return !gltf_failed(g);
    if (n != 3 && n != 4) {
        json_fail(attributes, "expected a COLOR_0 of 3 or 4 components, found %u", n);
        return false;
    }
    m->colors = gltf_read_floats(g, index, n, n == 3 ? m->n_vertices : 0, &count);
    if (!m->colors || !check_count(attributes, "COLOR_0", count, m))
        return false;
    for (size_t i = count; n == 3 && i-- > 0;) {
        memmove(m->colors + 4 * i, m->colors + 3 * i, 3 * sizeof(float));
        m->colors[4 * i + 3] = 1.0f;
    }
    return true;
}

static uint32_t *count_up(gltf *g, const json_value *at, size_t n)
{
    GError *error = NULL;
    uint32_t *out = big_alloc(n, sizeof *out, "mesh", &error);
    for (size_t i = 0; out && i < n; i++)
        out[i] = (uint32_t)i;
    if (!out)
        gltf_take_error(g, at, error);
    return out;
}

/* A strip's or fan's corners, three a triangle. */
static uint32_t *unroll(gltf *g, const json_value *at, const uint32_t *corners,
                        size_t n_triangles, gint64 mode)
{
    GError *error = NULL;
    uint32_t *out = big_alloc(3 * n_triangles, sizeof *out, "mesh", &error);
    for (size_t i = 0; out && i < n_triangles; i++) {
        bool odd = mode == MODE_STRIP && i % 2;
        out[3 * i] = mode == MODE_FAN ? corners[0] : corners[i];
        out[3 * i + 1] = corners[odd ? i + 2 : i + 1];
        out[3 * i + 2] = corners[odd ? i + 1 : i + 2];
    }
    if (!out)
        gltf_take_error(g, at, error);
    return out;
}

static bool check_indices(const json_value *primitive, const mesh *m)
{
    for (size_t i = 0; i < 3 * m->n_triangles; i++)
        if (m->indices[i] >= m->n_vertices) {
            json_fail(primitive, "expected indices below %zu, found %u", m->n_vertices,
                      m->indices[i]);
            return false;
        }
    return true;
}

static bool read_triangles(gltf *g, const json_value *primitive, gint64 mode, mesh *m)
{
    size_t n = m->n_vertices;
    gint64 index = json_whole(primitive, "indices", GLTF_MOST);
    m->indices = index >= 0 ? gltf_read_indices(g, index, &n) : count_up(g, primitive, n);
    if (!m->indices)
        return false;
    if (n < 3 || (mode == MODE_TRIANGLES && n % 3 != 0)) {
        json_fail(primitive, "expected three indices a triangle, found %zu", n);
        return false;
    }
    m->n_triangles = mode == MODE_TRIANGLES ? n / 3 : n - 2;
    if (mode != MODE_TRIANGLES) {
        uint32_t *corners = m->indices;
        m->indices = unroll(g, primitive, corners, m->n_triangles, mode);
        big_free(corners);
    }
    return m->indices && check_indices(primitive, m);
}

static bool read_primitive(gltf *g, const json_value *primitive, mesh *m)
{
    json_value attributes = json_member(primitive, "attributes");
    gint64 mode = json_whole(primitive, "mode", 6);
    return !gltf_failed(g) && read_positions(g, &attributes, m) &&
           read_normals(g, &attributes, m) && read_tangents(g, &attributes, m) &&
           read_uvs(g, &attributes, "TEXCOORD_0", m, &m->uvs) &&
           read_uvs(g, &attributes, "TEXCOORD_1", m, &m->uvs2) &&
           read_colors(g, &attributes, m) &&
           read_triangles(g, primitive, mode < 0 ? MODE_TRIANGLES : mode, m);
}

/* ---- Adding ---- */

/* Thin by the standard, but who models a closed body means solid glass. */
static bool is_solid(gltf *g, const json_value *primitive, const mesh *m,
                     const gltf_material_info *info)
{
    GError *error = NULL;
    mesh_body body = {0};
    if (!g->solid || !info->transmits)
        return false;
    if (!mesh_body_of(m, &body, &error)) {
        gltf_take_error(g, primitive, error);
        return false;
    }
    g->n_solid += body.closed;
    return body.closed;
}

/* What a mesh shines with: a closed one that is not inside out shows its front alone. */
static const params *shine_of(gltf *g, const json_value *primitive, const mesh *m,
                              const gltf_material_info *info)
{
    GError *error = NULL;
    mesh_body body = {0};
    if (!info->both_sides)
        return info->area_light;
    if (!mesh_body_of(m, &body, &error))
        gltf_take_error(g, primitive, error);
    return body.closed && body.volume > 0.0 ? info->area_light : info->both_sides;
}

static bool alpha_hides_all(const shape_place *at)
{
    return at->alpha && !at->alpha->texture && !(at->alpha->constant > 0.0f);
}

static void add_shape(gltf *g, const json_value *primitive, mesh *m,
                      const gltf_material_info *info, const shape_place *stands)
{
    shape_place at = *stands;
    GError *error = NULL;
    float_input alpha;
    const source_place place = {intern(g->path), 0, 0};
    if (info->alpha) {
        if (!float_input_init(&alpha, &g->builder->build, info->alpha, "alpha", 1.0f,
                              &error)) {
            gltf_take_error(g, primitive, error);
            return;
        }
        at.alpha = &alpha;
    }
    if (!alpha_hides_all(&at) && !builder_add_mesh(g->builder, m, &at, place, &error))
        gltf_take_error(g, primitive, error);
}

static void add_primitive(gltf *g, const json_value *primitive, gint64 number,
                          const gltf_pose *pose, const transform *to_world)
{
    mesh m = {0};
    const gltf_material_info *info = gltf_material(g, number);
    if (read_primitive(g, primitive, &m)) {
        bool in_world = gltf_pose_apply(g, primitive, pose, &m);
        bool solid = !gltf_failed(g) && is_solid(g, primitive, &m, info);
        shape_place at = {.to_world = in_world ? transform_identity() : *to_world,
                          .material = gltf_material_index(g, number, solid),
                          .area_light = NULL};
        if (!gltf_failed(g))
            at.area_light = shine_of(g, primitive, &m, info);
        if (!gltf_failed(g))
            add_shape(g, primitive, &m, info, &at);
    }
    mesh_clear(&m);
}

/* A file that does not require Draco says the same without it; the accessors have data
 * of their own then. */
static bool has_plain_data(gltf *g, const json_value *primitive)
{
    json_value attributes = json_member(primitive, "attributes"), array;
    gint64 index;
    json_value points =
        gltf_refer(g, &attributes, "POSITION", "accessors", &array, &index);
    json_value data = json_member(&points, "bufferView");
    return json_exists(&data);
}

/* Points and lines have no surface. */
static bool has_surface(gltf *g, const json_value *primitive)
{
    json_value extensions,
        packed = gltf_extension(primitive, "KHR_draco_mesh_compression", &extensions);
    gint64 mode = json_whole(primitive, "mode", 6);
    if (json_exists(&packed) && !has_plain_data(g, primitive))
        json_fail(&packed, "meshes packed by Draco are not supported");
    if (mode < 0 || mode >= MODE_TRIANGLES)
        return true;
    gltf_note(g, LOG_WARNING, "points and lines are left out");
    return false;
}

guint gltf_add_primitives(gltf *g, const json_value *of, const gltf_pose *pose,
                          gltf_part part, const transform *to_world)
{
    json_value primitives = json_member(of, "primitives");
    guint n = json_length(&primitives), n_added = 0;
    for (guint i = 0; i < n && !gltf_failed(g); i++) {
        json_value primitive = json_element(&primitives, i);
        gint64 number = json_whole(&primitive, "material", GLTF_MOST);
        const gltf_material_info *info = gltf_material(g, number);
        if (!info || !has_surface(g, &primitive) || gltf_failed(g))
            continue;
        if (part == GLTF_ALL || (part == GLTF_SHINING) == (info->area_light != NULL)) {
            add_primitive(g, &primitive, number, pose, to_world);
            n_added++;
        }
    }
    return n_added;
}
