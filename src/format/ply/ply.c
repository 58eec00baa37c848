/*
 * Triangle meshes from PLY files.
 *
 * Workload: scans of 10^6..10^8 triangles, binary, one float per coordinate and one list
 * of three ints per face. Those two cases have loops of their own that run at the speed
 * of memory; all others go value by value.
 */
#include "format/ply/ply.h"

#include "base/input.h"
#include "base/intern.h"
#include "base/memory.h"
#include "base/wanted.h"
#include "format/ply/ply_values.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

enum { N_COLUMNS = 17, BLOCK = 1024 };

/** A vertex property that is kept. */
typedef struct column {
    int property; /**< index, -1: the file has none */
    float *to;    /**< of the first vertex */
    size_t stride;
    const char *name;
} column;

static bool skip_element(ply_reader *r, const ply_element *e, GError **error)
{
    if (e->properties->len == 0)
        return true;
    for (size_t row = 0; row < e->count; row++)
        for (guint i = 0; i < e->properties->len; i++)
            if (!still_wanted_at(row, error) ||
                !ply_skip_property(r, ply_property_at(e, i), error))
                return false;
    return true;
}

/** Refuses what cannot be in the file before memory is asked for it. */
static bool check_count(const ply_reader *r, const ply_element *e, GError **error)
{
    size_t least = ply_least_row(&r->header, e);
    size_t most = least ? (ply_remaining(r) + 1) / least : e->count;
    if (e->count <= most)
        return true;
    error_set(error, ERROR_INPUT,
              "%s: expected %zu elements '%s', found the end of the file after at most "
              "%zu",
              r->file, e->count, e->name, most);
    return false;
}

/* ---- Vertices ---- */

static bool alloc_rows(float **out, size_t n, size_t per_row, const char *what,
                       GError **error)
{
    *out = big_alloc(n * per_row + 1, sizeof **out, what, error);
    return *out != NULL;
}

/* What vertices may have: the names of its properties, one way or another, and where in
 * a mesh it goes. The last three are what ply_write adds for pictures that need them. */
typedef struct attribute {
    const char *names[4]; /**< blank-separated */
    int n;
    size_t offset;
    const char *what;
} attribute;

static const attribute attributes[] = {
    {{"x y z"}, 3, offsetof(mesh, positions), "vertices"},
    {{"nx ny nz"}, 3, offsetof(mesh, normals), "normals"},
    {{"u v", "s t", "texture_u texture_v", "texture_s texture_t"},
     2,
     offsetof(mesh, uvs),
     "texture coordinates"},
    {{"u2 v2"}, 2, offsetof(mesh, uvs2), "texture coordinates"},
    {{"tx ty tz"}, 3, offsetof(mesh, tangents), "tangents"},
    {{"color_r color_g color_b color_a"}, 4, offsetof(mesh, colors), "colours"},
};

/* Columns of the properties of these names; false if one is missing. */
static bool find_columns(column *columns, const ply_element *e, const char *names, int n)
{
    g_auto(GStrv) words = g_strsplit(names, " ", -1);
    for (int i = 0; i < n; i++) {
        int p = ply_find_property(e, words[i]);
        if (p < 0 || ply_property_at(e, (guint)p)->is_list)
            return false;
        columns[i] = (column){p, NULL, (size_t)n, intern(words[i])};
    }
    return true;
}

static bool plan_attribute(ply_reader *r, const ply_element *e, const attribute *a,
                           column *columns, GError **error)
{
    bool found = false;
    for (size_t i = 0; i < G_N_ELEMENTS(a->names) && a->names[i] && !found; i++)
        found = find_columns(columns, e, a->names[i], a->n);
    for (int i = 0; i < a->n && !found; i++)
        columns[i].property = -1;
    if (!found)
        return true;
    float *to;
    if (!alloc_rows(&to, e->count, (size_t)a->n, a->what, error))
        return false;
    *(float **)(void *)((char *)&r->m + a->offset) = to;
    for (int i = 0; i < a->n; i++)
        columns[i].to = to + i;
    return true;
}

/** Which properties go where; allocates their arrays. */
static bool plan_columns(ply_reader *r, const ply_element *e, column *columns,
                         GError **error)
{
    int at = 0;
    for (size_t i = 0; i < G_N_ELEMENTS(attributes); i++) {
        if (!plan_attribute(r, e, &attributes[i], columns + at, error))
            return false;
        at += attributes[i].n;
    }
    return r->m.positions ||
           ply_fail(r, error, "expected vertices with x, y and z, found none");
}

/** Rows of one size: block by block, so that a block's columns meet it in the cache. */
static bool read_fixed_rows(ply_reader *r, const ply_element *e, const column *columns)
{
    size_t offsets[N_COLUMNS], row = ply_least_row(&r->header, e);
    ply_type type[N_COLUMNS];
    for (int c = 0; c < N_COLUMNS; c++) {
        offsets[c] = 0;
        for (int i = 0; i < columns[c].property; i++)
            offsets[c] += ply_type_size(ply_property_at(e, (guint)i)->type);
        if (columns[c].property >= 0)
            type[c] = ply_property_at(e, (guint)columns[c].property)->type;
    }
    for (size_t first = 0; first < e->count && still_wanted(NULL); first += BLOCK) {
        size_t end = MIN(first + BLOCK, e->count);
        for (int c = 0; c < N_COLUMNS; c++) {
            if (columns[c].property < 0)
                continue;
            const char *from = r->at + first * row + offsets[c];
            float *to = columns[c].to + first * columns[c].stride;
            bool plain = type[c] == PLY_FLOAT32 && !r->swap;
            for (size_t i = first; i < end; i++, from += row, to += columns[c].stride) {
                if (plain)
                    memcpy(to, from, sizeof *to);
                else
                    *to = (float)ply_load(from, type[c], r->swap);
            }
        }
    }
    r->at += e->count * row;
    return true;
}

static bool read_row(ply_reader *r, const ply_element *e, const column *columns,
                     size_t row, GError **error)
{
    for (guint i = 0; i < e->properties->len; i++) {
        const ply_property *p = ply_property_at(e, i);
        double value;
        int c = 0;
        while (c < N_COLUMNS && columns[c].property != (int)i)
            c++;
        if (c == N_COLUMNS) {
            if (!ply_skip_property(r, p, error))
                return false;
            continue;
        }
        if (!ply_read_number(r, p->type, &value, error))
            return false;
        columns[c].to[row * columns[c].stride] = (float)value;
    }
    return true;
}

/* Places must be numbers; what else is none is the mesh's to do without. */
static bool check_finite(const ply_reader *r, const column *columns, size_t n,
                         GError **error)
{
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < n && still_wanted_at(i, NULL); i++)
            if (!isfinite(columns[c].to[i * columns[c].stride])) {
                error_set(error, ERROR_INPUT,
                          "%s: expected finite numbers, found %s = %g of vertex %zu",
                          r->file, columns[c].name,
                          (double)columns[c].to[i * columns[c].stride], i);
                return false;
            }
    return true;
}

static bool read_vertices(ply_reader *r, const ply_element *e, GError **error)
{
    column columns[N_COLUMNS];
    if (r->m.positions)
        return ply_fail(r, error, "expected one element 'vertex', found another");
    if (!plan_columns(r, e, columns, error))
        return false;
    bool is_fixed = r->header.encoding != PLY_TEXT;
    for (guint i = 0; i < e->properties->len; i++)
        is_fixed &= !ply_property_at(e, i)->is_list;
    if (is_fixed)
        read_fixed_rows(r, e, columns);
    for (size_t row = 0; !is_fixed && row < e->count; row++)
        if (!still_wanted_at(row, error) || !read_row(r, e, columns, row, error))
            return false;
    if (!still_wanted(error))
        return false;
    r->m.n_vertices = e->count;
    return check_finite(r, columns, e->count, error);
}

/* ---- Faces ---- */

static bool make_room(ply_reader *r, GError **error)
{
    size_t used = 3 * r->m.n_triangles;
    if (used + 6 <= r->capacity)
        return true;
    size_t capacity = 2 * r->capacity;
    uint32_t *grown =
        big_grow(r->m.indices, r->capacity, capacity, sizeof *grown, "triangles", error);
    if (!grown)
        return false;
    r->m.indices = grown;
    r->capacity = capacity;
    return true;
}

static bool read_corner(ply_reader *r, const ply_property *p, uint32_t *out,
                        GError **error)
{
    double index;
    if (!ply_read_number(r, p->type, &index, error))
        return false;
    if (!(index >= 0.0 && index < (double)r->n_vertices) || index > floor(index))
        return ply_fail(r, error, "expected a vertex from 0 to %zu, found %.10g",
                        r->n_vertices - 1, index);
    *out = (uint32_t)index;
    return true;
}

/** One list of corners: a triangle or two. */
static bool read_face(ply_reader *r, const ply_property *p, GError **error)
{
    size_t n = 0;
    uint32_t v[4];
    if (!ply_read_length(r, p, &n, error))
        return false;
    if (n != 3 && n != 4)
        return ply_fail(r, error, "expected a face of 3 or 4 vertices, found one of %zu",
                        n);
    for (size_t i = 0; i < n; i++)
        if (!read_corner(r, p, &v[i], error))
            return false;
    if (!make_room(r, error))
        return false;
    uint32_t *to = r->m.indices + 3 * r->m.n_triangles;
    memcpy(to, v, 3 * sizeof *to);
    r->m.n_triangles++;
    if (n == 4) {
        memcpy(to + 3, (uint32_t[]){v[0], v[2], v[3]}, 3 * sizeof *to);
        r->m.n_triangles++;
    }
    return true;
}

/** Faces that are nothing but a byte 3 and three indices of ours; stops at the first that
 * is not. @return how many were read */
static size_t read_plain_triangles(ply_reader *r, const ply_element *e)
{
    enum { FACE = 1 + 3 * 4 };
    const ply_property *p = ply_property_at(e, 0);
    bool is_plain = r->header.encoding != PLY_TEXT && !r->swap &&
                    e->properties->len == 1 && ply_type_size(p->count_type) == 1 &&
                    (p->type == PLY_INT32 || p->type == PLY_UINT32);
    size_t n = is_plain ? MIN(e->count, ply_remaining(r) / FACE) : 0;
    uint32_t *to = r->m.indices;
    for (size_t i = 0; i < n; i++, r->at += FACE, to += 3) {
        memcpy(to, r->at + 1, 3 * sizeof *to);
        if (*r->at != 3 || to[0] >= r->n_vertices || to[1] >= r->n_vertices ||
            to[2] >= r->n_vertices || !still_wanted_at(i, NULL)) {
            n = i;
            break;
        }
    }
    r->m.n_triangles = n;
    return n;
}

static bool read_faces(ply_reader *r, const ply_element *e, GError **error)
{
    int list = ply_find_property(e, "vertex_indices");
    if (list < 0)
        list = ply_find_property(e, "vertex_index");
    if (list < 0 || !ply_property_at(e, (guint)list)->is_list)
        return ply_fail(r, error,
                        "expected faces with a list vertex_indices, found none");
    if (r->m.indices)
        return ply_fail(r, error, "expected one element 'face', found another");
    r->capacity = 3 * e->count + 6;
    r->m.indices = big_alloc(r->capacity, sizeof *r->m.indices, "triangles", error);
    if (!r->m.indices)
        return false;
    size_t plain = read_plain_triangles(r, e);
    if (!still_wanted(error))
        return false;
    for (size_t row = plain; row < e->count; row++)
        for (guint i = 0; i < e->properties->len; i++) {
            const ply_property *p = ply_property_at(e, i);
            if (!still_wanted_at(row, error) ||
                !(i == (guint)list ? read_face(r, p, error)
                                   : ply_skip_property(r, p, error)))
                return false;
        }
    return true;
}

/* ---- The file ---- */

static bool find_vertices(ply_reader *r, GError **error)
{
    for (guint i = 0; i < r->header.elements->len; i++) {
        const ply_element *e = ply_element_at(&r->header, i);
        if (strcmp(e->name, "vertex") == 0)
            r->n_vertices = e->count;
    }
    if (r->n_vertices > 0 && r->n_vertices <= UINT32_MAX)
        return true;
    error_set(error, ERROR_INPUT, "%s: expected 1 to %u vertices, found %zu", r->file,
              UINT32_MAX, r->n_vertices);
    return false;
}

static bool read_elements(ply_reader *r, GError **error)
{
    for (guint i = 0; i < r->header.elements->len; i++) {
        const ply_element *e = ply_element_at(&r->header, i);
        bool fine;
        if (!check_count(r, e, error))
            return false;
        if (strcmp(e->name, "vertex") == 0)
            fine = read_vertices(r, e, error);
        else if (strcmp(e->name, "face") == 0)
            fine = read_faces(r, e, error);
        else
            fine = skip_element(r, e, error);
        if (!fine)
            return false;
    }
    if (r->m.n_triangles > 0)
        return true;
    error_set(error, ERROR_INPUT, "%s: expected faces, found none", r->file);
    return false;
}

static bool read_data(ply_reader *r, const input *in, GError **error)
{
    if (!ply_header_read(&r->header, r->file, in->data, in->size, error))
        return false;
    ply_encoding ours =
        G_BYTE_ORDER == G_LITTLE_ENDIAN ? PLY_LITTLE_ENDIAN : PLY_BIG_ENDIAN;
    r->begin = in->data;
    r->at = r->line_start = in->data + r->header.size;
    r->end = in->data + in->size;
    r->line = r->header.n_lines + 1;
    r->swap = r->header.encoding != ours;
    bool fine = find_vertices(r, error) && read_elements(r, error);
    ply_header_clear(&r->header);
    return fine;
}

bool ply_read(const char *path, mesh *out, GError **error)
{
    input in;
    if (!input_open(&in, path, error))
        return false;
    ply_reader r = {.file = path};
    bool fine = read_data(&r, &in, error);
    input_close(&in);
    if (fine)
        *out = r.m;
    else
        mesh_clear(&r.m);
    return fine;
}
