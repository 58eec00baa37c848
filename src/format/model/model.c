#include "format/model/model.h"

#include <math.h>
#include <string.h>

/* A model has few remarks; and a person reads few. */
enum { MOST_NOTES = 100, LONGEST_TEXT = 1000 };

/** @brief What is left of the stream, or of a record. */
typedef struct cursor {
    const unsigned char *at;
    size_t left;
} cursor;

/* n elements of a size, or NULL if so many are not there. */
static const void *take(cursor *c, uint64_t n, size_t size)
{
    if (n > c->left / size)
        return NULL;
    const void *out = c->at;
    c->at += n * size;
    c->left -= n * size;
    return out;
}

static const char *take_string(cursor *c)
{
    const void *end = c->left > 0 ? memchr(c->at, '\0', c->left) : NULL;
    return end ? take(c, (uint64_t)((const unsigned char *)end - c->at) + 1, 1) : NULL;
}

static bool all_finite(const float *x, uint64_t n)
{
    for (uint64_t i = 0; i < n; i++)
        if (!isfinite(x[i]))
            return false;
    return true;
}

static bool is_place(const double to_world[16])
{
    for (int i = 0; i < 16; i++)
        if (!isfinite(to_world[i]))
            return false;
    return true;
}

/* For people to read: nothing that a terminal obeys, and not a book. */
static char *clean_text(const char *text)
{
    g_autofree char *some = g_strndup(text, LONGEST_TEXT);
    char *clean = g_utf8_make_valid(some, -1);
    for (char *at = clean; *at; at = g_utf8_next_char(at))
        if (g_unichar_iscntrl(g_utf8_get_char(at)))
            memset(at, ' ', (size_t)(g_utf8_next_char(at) - at));
    return g_strstrip(clean);
}

/* ---- Records: each is given its payload, and false says that it is none ---- */

static bool read_error(model *m, cursor *c, GError **error)
{
    (void)m;
    const stream_error *is = take(c, 1, sizeof *is);
    const char *text = is ? take_string(c) : NULL;
    if (!text || is->reason > STREAM_NO_MEMORY)
        return false;
    g_autofree char *clean = clean_text(text);
    error_at(error, (source_place){0}, "%s",
             is->reason == STREAM_NO_MEMORY ? "it needs more memory than it may have"
             : *clean                       ? clean
                                            : "it can not be read");
    return true;
}

static bool read_note(model *m, cursor *c, GError **error)
{
    (void)error;
    const stream_note *is = take(c, 1, sizeof *is);
    const char *text = is ? take_string(c) : NULL;
    if (!text || is->level > STREAM_WARNING)
        return false;
    if (m->notes->len == MOST_NOTES)
        return true;
    char *clean = clean_text(text);
    if (is->level == STREAM_DEBUG) {
        g_debug("nephroid-import: %s", clean);
        g_free(clean);
    } else {
        g_ptr_array_add(m->notes, clean);
    }
    return true;
}

static bool read_material(model *m, cursor *c, GError **error)
{
    (void)error;
    model_material out = {.numbers = take(c, 1, sizeof *out.numbers)};
    const size_t n_floats = offsetof(stream_material, illum) / sizeof(float);
    if (!out.numbers || !all_finite((const float *)(const void *)out.numbers, n_floats))
        return false;
    out.name = take_string(c);
    bool whole = out.name != NULL;
    for (int i = 0; i < N_STREAM_MAPS && whole; i++)
        whole = (out.maps[i] = take_string(c)) != NULL;
    if (whole)
        g_array_append_val(m->materials, out);
    return whole;
}

static bool read_image(model *m, cursor *c, GError **error)
{
    (void)error;
    const stream_image *is = take(c, 1, sizeof *is);
    model_image out = {0};
    if (!is || !(out.name = take_string(c)) || !(out.extension = take_string(c)))
        return false;
    out.size = is->n_bytes;
    out.bytes = take(c, is->n_bytes, 1);
    if (out.bytes)
        g_array_append_val(m->images, out);
    return out.bytes != NULL;
}

static bool read_mesh(model *m, cursor *c, GError **error)
{
    (void)error;
    const stream_mesh *is = take(c, 1, sizeof *is);
    if (!is || (is->has & ~(uint32_t)(STREAM_HAS_NORMALS | STREAM_HAS_UVS)))
        return false;
    const bool normals = is->has & STREAM_HAS_NORMALS, uvs = is->has & STREAM_HAS_UVS;
    model_mesh out = {
        is->n_vertices, is->n_triangles, is->material, NULL, NULL, NULL, NULL};
    if (!(out.positions = take(c, is->n_vertices, 3 * sizeof(float))) ||
        (normals && !(out.normals = take(c, is->n_vertices, 3 * sizeof(float)))) ||
        (uvs && !(out.uvs = take(c, is->n_vertices, 2 * sizeof(float)))) ||
        !(out.indices = take(c, is->n_triangles, 3 * sizeof(uint32_t))) ||
        !all_finite(out.positions, 3 * is->n_vertices))
        return false;
    for (uint64_t i = 0; i < 3 * is->n_triangles; i++)
        if (out.indices[i] >= is->n_vertices)
            return false;
    g_array_append_val(m->meshes, out);
    return true;
}

static bool read_instance(model *m, cursor *c, GError **error)
{
    (void)error;
    const stream_instance *is = take(c, 1, sizeof *is);
    if (!is || !is_place(is->to_world))
        return false;
    g_ptr_array_add(m->instances, (gpointer)is);
    return true;
}

static bool read_light(model *m, cursor *c, GError **error)
{
    (void)error;
    const stream_light *is = take(c, 1, sizeof *is);
    if (!is || !is_place(is->to_world) || !all_finite(is->position, 3) ||
        !all_finite(is->direction, 3) || !all_finite(is->color, 3) ||
        !isfinite(is->inner_angle) || !isfinite(is->outer_angle) ||
        is->kind >= N_STREAM_LIGHT_KINDS)
        return false;
    g_ptr_array_add(m->lights, (gpointer)is);
    return true;
}

static bool read_camera(model *m, cursor *c, GError **error)
{
    (void)error;
    const stream_camera *is = take(c, 1, sizeof *is);
    if (m->camera || !is || !is_place(is->to_world) || !all_finite(is->position, 3) ||
        !all_finite(is->look_at, 3) || !all_finite(is->up, 3) || !isfinite(is->aspect) ||
        !isfinite(is->fov))
        return false;
    m->camera = is;
    return true;
}

typedef struct record_kind {
    const char *name;
    bool (*read)(model *m, cursor *c, GError **error);
} record_kind;

static const record_kind kinds[N_STREAM_KINDS] = {
    [STREAM_ERROR] = {"error", read_error},
    [STREAM_NOTE] = {"note", read_note},
    [STREAM_MATERIAL] = {"material", read_material},
    [STREAM_IMAGE] = {"image", read_image},
    [STREAM_MESH] = {"mesh", read_mesh},
    [STREAM_INSTANCE] = {"instance", read_instance},
    [STREAM_LIGHT] = {"light", read_light},
    [STREAM_CAMERA] = {"camera", read_camera},
};

/* ---- All of it ---- */

static bool refuse(GError **error, const char *what)
{
    error_at(error, (source_place){0},
             "the importer talks nonsense (%s): the file is damaged", what);
    return false;
}

static bool read_record(model *m, const stream_head *head, cursor *payload,
                        GError **error)
{
    GError *inner = NULL;
    bool known = head->kind > STREAM_END && head->kind < N_STREAM_KINDS;
    if (!known)
        return refuse(error, "a record of no kind");
    if (!kinds[head->kind].read(m, payload, &inner) || payload->left > 0) {
        g_clear_error(&inner);
        return refuse(error, kinds[head->kind].name);
    }
    if (inner)
        g_propagate_error(error, inner);
    return !inner;
}

static bool read_records(model *m, cursor *c, GError **error)
{
    for (;;) {
        const stream_head *head = take(c, 1, sizeof *head);
        const void *payload = head ? take(c, head->size, 1) : NULL;
        if (!payload || !take(c, -head->size & 7, 1))
            return refuse(error, "it breaks off");
        if (head->kind == STREAM_END)
            return c->left == 0 || refuse(error, "it goes on behind its end");
        cursor inside = {payload, head->size};
        if (!read_record(m, head, &inside, error))
            return false;
    }
}

/* What names another is known only at the end. */
static bool check_names(const model *m, GError **error)
{
    for (guint i = 0; i < m->meshes->len; i++)
        if (g_array_index(m->meshes, model_mesh, i).material >= m->materials->len)
            return refuse(error, "a mesh's material");
    for (guint i = 0; i < m->instances->len; i++) {
        const stream_instance *at = m->instances->pdata[i];
        if (at->mesh >= m->meshes->len)
            return refuse(error, "an instance's mesh");
    }
    return true;
}

bool model_read(const void *bytes, size_t size, model *out, GError **error)
{
    cursor c = {bytes, size};
    *out = (model){.meshes = g_array_new(FALSE, FALSE, sizeof(model_mesh)),
                   .materials = g_array_new(FALSE, FALSE, sizeof(model_material)),
                   .images = g_array_new(FALSE, FALSE, sizeof(model_image)),
                   .instances = g_ptr_array_new(),
                   .lights = g_ptr_array_new(),
                   .notes = g_ptr_array_new_with_free_func(g_free)};
    const char *magic = take(&c, strlen(STREAM_MAGIC), 1);
    if (!magic || memcmp(magic, STREAM_MAGIC, strlen(STREAM_MAGIC)) != 0)
        return refuse(error, "it is of another version");
    return read_records(out, &c, error) && check_names(out, error);
}

void model_clear(model *m)
{
    if (!m->meshes)
        return;
    g_array_unref(m->meshes);
    g_array_unref(m->materials);
    g_array_unref(m->images);
    g_ptr_array_unref(m->instances);
    g_ptr_array_unref(m->lights);
    g_ptr_array_unref(m->notes);
    *m = (model){0};
}
