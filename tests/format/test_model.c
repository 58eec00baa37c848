/*
 * What the importer's child tells, as its parent reads it: the child may be anybody's.
 * A stream that is right is read as it was written; one that is cut off, lies, or has
 * random bytes in it is refused, or is a model in which nothing is out of range.
 */
#include "base/memory.h"
#include "format/model/model.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* ---- Writing streams ---- */

static GByteArray *stream_new(void)
{
    GByteArray *s = g_byte_array_new();
    return g_byte_array_append(s, (const guint8 *)STREAM_MAGIC, 8);
}

static void put(GByteArray *s, stream_kind kind, const void *payload, size_t size)
{
    static const guint8 padding[8] = {0};
    const stream_head head = {.kind = kind, .size = size};
    g_byte_array_append(s, (const guint8 *)&head, sizeof head);
    if (size > 0)
        g_byte_array_append(s, payload, (guint)size);
    g_byte_array_append(s, padding, (guint)(-size & 7));
}

static void put_with(GByteArray *s, stream_kind kind, const void *value, size_t size,
                     const void *tail, size_t n_tail)
{
    g_autoptr(GByteArray) payload = g_byte_array_new();
    g_byte_array_append(payload, value, (guint)size);
    g_byte_array_append(payload, tail, (guint)n_tail);
    put(s, kind, payload->data, payload->len);
}

static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/* A triangle as numbers behind a stream_mesh. */
typedef struct triangle {
    stream_mesh head;
    float positions[9], normals[9], uvs[6];
    uint32_t indices[3];
} triangle;

enum { TRIANGLE_SIZE = offsetof(triangle, indices) + 3 * sizeof(uint32_t) };

static const triangle plain_triangle = {
    .head = {3, 1, 0, STREAM_HAS_NORMALS | STREAM_HAS_UVS},
    .positions = {0, 0, 0, 1, 0, 0, 0, 1, 0},
    .normals = {0, 0, 1, 0, 0, 1, 0, 0, 1},
    .uvs = {0, 0, 1, 0, 0, 1},
    .indices = {0, 1, 2}};

static void put_material(GByteArray *s, float grey)
{
    const stream_material numbers = {.diffuse = {grey, grey, grey}, .illum = -1};
    static const char names[] = "clay\0colour.png\0\0\0\0";
    put_with(s, STREAM_MATERIAL, &numbers, sizeof numbers, names, sizeof names);
}

static void put_instance(GByteArray *s, uint32_t mesh)
{
    stream_instance instance = {.mesh = mesh};
    memcpy(instance.to_world, identity, sizeof identity);
    put(s, STREAM_INSTANCE, &instance, sizeof instance);
}

/* All kinds of records that a whole stream may have, with this mesh. */
static GByteArray *stream_with(const triangle *t)
{
    GByteArray *s = stream_new();
    const stream_note note = {.level = STREAM_WARNING};
    const stream_image image = {.n_bytes = 5};
    stream_light light = {.color = {1, 1, 1}, .direction = {0, 0, 1}};
    stream_camera camera = {.look_at = {0, 0, 1}, .up = {0, 1, 0}, .fov = 1.0f};
    memcpy(light.to_world, identity, sizeof identity);
    memcpy(camera.to_world, identity, sizeof identity);
    put_with(s, STREAM_NOTE, &note, sizeof note, "a note", 7);
    put_with(s, STREAM_IMAGE, &image, sizeof image, "i\0png\0bytes", 11);
    put_material(s, 0.5f);
    put(s, STREAM_MESH, t, TRIANGLE_SIZE);
    put_instance(s, 0);
    put(s, STREAM_LIGHT, &light, sizeof light);
    put(s, STREAM_CAMERA, &camera, sizeof camera);
    return s;
}

static GByteArray *whole_stream(void)
{
    GByteArray *s = stream_with(&plain_triangle);
    put(s, STREAM_END, NULL, 0);
    return s;
}

/* ---- Reading them ---- */

/* Reads a copy of its own, at whose end memory ends. */
static bool read_copy(const guint8 *bytes, size_t size, model *out, void **copy,
                      GError **error)
{
    *copy = g_aligned_alloc(MAX(size, 1), 1, 8);
    memcpy(*copy, bytes, size);
    return model_read(*copy, size, out, error);
}

/* Touches all that there is; what is wrong in it fails here or in a sanitizer. */
static double use(const model *m)
{
    double sum = 0.0;
    for (guint i = 0; i < m->meshes->len; i++) {
        const model_mesh *is = &g_array_index(m->meshes, model_mesh, i);
        g_assert_cmpuint(is->material, <, m->materials->len);
        for (size_t k = 0; k < 3 * is->n_triangles; k++) {
            g_assert_cmpuint(is->indices[k], <, is->n_vertices);
            sum += (double)is->positions[3 * is->indices[k]];
        }
        g_assert_true(isfinite(sum));
        for (size_t k = 0; is->normals && k < 3 * is->n_vertices; k++)
            sum += is->normals[k] > 0.0f;
        for (size_t k = 0; is->uvs && k < 2 * is->n_vertices; k++)
            sum += is->uvs[k] > 0.0f;
    }
    for (guint i = 0; i < m->instances->len; i++) {
        const stream_instance *at = m->instances->pdata[i];
        g_assert_cmpuint(at->mesh, <, m->meshes->len);
        g_assert_true(isfinite(at->to_world[i % 16]));
    }
    for (guint i = 0; i < m->materials->len; i++) {
        const model_material *is = &g_array_index(m->materials, model_material, i);
        sum += (double)strlen(is->name) + (double)is->numbers->opacity;
        for (int k = 0; k < N_STREAM_MAPS; k++)
            sum += (double)strlen(is->maps[k]);
    }
    for (guint i = 0; i < m->images->len; i++) {
        const model_image *is = &g_array_index(m->images, model_image, i);
        sum += (double)strlen(is->name) + (double)strlen(is->extension);
        for (size_t k = 0; k < is->size; k++)
            sum += ((const guint8 *)is->bytes)[k];
    }
    for (guint i = 0; i < m->notes->len; i++)
        g_assert_true(g_utf8_validate(m->notes->pdata[i], -1, NULL));
    return sum;
}

/* The message of a refusal, owned; NULL: it was read. */
static char *refusal_of(const GByteArray *s)
{
    g_autoptr(GError) error = NULL;
    model m;
    void *copy;
    bool done = read_copy(s->data, s->len, &m, &copy, &error);
    g_assert_true(done == (error == NULL));
    if (done)
        use(&m);
    else
        g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    model_clear(&m);
    g_aligned_free(copy);
    return done ? NULL : g_strdup(error->message);
}

static void test_whole(void)
{
    g_autoptr(GByteArray) s = whole_stream();
    g_autoptr(GError) error = NULL;
    model m;
    void *copy;
    g_assert_true(read_copy(s->data, s->len, &m, &copy, &error));
    g_assert_no_error(error);
    const model_mesh *is = &g_array_index(m.meshes, model_mesh, 0);
    const model_material *clay = &g_array_index(m.materials, model_material, 0);
    const model_image *image = &g_array_index(m.images, model_image, 0);
    g_assert_cmpuint(is->n_vertices, ==, 3);
    g_assert_cmpmem(is->positions, 36, plain_triangle.positions, 36);
    g_assert_cmpmem(is->normals, 36, plain_triangle.normals, 36);
    g_assert_cmpmem(is->uvs, 24, plain_triangle.uvs, 24);
    g_assert_cmpmem(is->indices, 12, plain_triangle.indices, 12);
    g_assert_cmpstr(clay->name, ==, "clay");
    g_assert_cmpstr(clay->maps[STREAM_MAP_COLOR], ==, "colour.png");
    g_assert_cmpstr(clay->maps[STREAM_MAP_HEIGHTS], ==, "");
    g_assert_cmpmem(image->bytes, image->size, "bytes", 5);
    g_assert_cmpstr(m.notes->pdata[0], ==, "a note");
    g_assert_cmpuint(m.instances->len, ==, 1);
    g_assert_cmpuint(m.lights->len, ==, 1);
    g_assert_nonnull(m.camera);
    model_clear(&m);
    g_aligned_free(copy);
}

static void test_cut_off(void)
{
    g_autoptr(GByteArray) s = whole_stream();
    for (guint n = s->len; n-- > 0;) {
        g_byte_array_set_size(s, n);
        g_autofree char *said = refusal_of(s);
        g_assert_nonnull(said);
    }
}

/* One mesh that lies. */
static void refuse_triangle(triangle t)
{
    g_autoptr(GByteArray) s = stream_with(&t);
    put(s, STREAM_END, NULL, 0);
    g_autofree char *said = refusal_of(s);
    g_assert_nonnull(said);
    g_assert_nonnull(strstr(said, "the file is damaged"));
}

static void test_lying_meshes(void)
{
    static const uint64_t counts[] = {
        0, 2, 4, 1u << 31, UINT64_MAX, 1ull << 62, 1ull << 63, 0x5555555555555556};
    for (size_t i = 0; i < G_N_ELEMENTS(counts); i++) {
        triangle t = plain_triangle;
        t.head.n_vertices = counts[i];
        refuse_triangle(t);
        t = plain_triangle;
        t.head.n_triangles = counts[i];
        refuse_triangle(t);
    }
    triangle t = plain_triangle;
    t.indices[2] = 3;
    refuse_triangle(t);
    t = plain_triangle;
    t.positions[4] = NAN;
    refuse_triangle(t);
    t = plain_triangle;
    t.head.material = 1;
    refuse_triangle(t);
    t = plain_triangle;
    t.head.has = 4;
    refuse_triangle(t);
}

/* A record put behind those that are right. */
static void refuse_record(stream_kind kind, const void *payload, size_t size)
{
    g_autoptr(GByteArray) s = stream_with(&plain_triangle);
    put(s, kind, payload, size);
    put(s, STREAM_END, NULL, 0);
    g_autofree char *said = refusal_of(s);
    g_assert_nonnull(said);
}

static void test_lying_records(void)
{
    stream_instance nowhere = {.mesh = 0, .to_world = {NAN}}, of_none = {.mesh = 1};
    stream_light odd = {.kind = N_STREAM_LIGHT_KINDS}, dark = {.color = {INFINITY}};
    stream_camera second = {.fov = 1.0f};
    const stream_image long_image = {.n_bytes = 1000};
    const stream_note no_end = {.level = STREAM_WARNING}, no_level = {.level = 7};
    refuse_record(STREAM_INSTANCE, &nowhere, sizeof nowhere);
    refuse_record(STREAM_INSTANCE, &of_none, sizeof of_none);
    refuse_record(STREAM_INSTANCE, &of_none, sizeof of_none - 8);
    refuse_record(STREAM_LIGHT, &odd, sizeof odd);
    refuse_record(STREAM_LIGHT, &dark, sizeof dark);
    refuse_record(STREAM_CAMERA, &second, sizeof second);
    refuse_record(STREAM_IMAGE, &long_image, sizeof long_image);
    refuse_record(STREAM_NOTE, &no_end, sizeof no_end);
    refuse_record(STREAM_NOTE, &no_level, sizeof no_level);
    refuse_record(STREAM_MATERIAL, "short", 5);
    refuse_record(N_STREAM_KINDS, NULL, 0);
    refuse_record(STREAM_END, NULL, 0);
    refuse_record(STREAM_END, "more", 4);
    g_autoptr(GByteArray) other = g_byte_array_new();
    g_byte_array_append(other, (const guint8 *)"nephmdl0", 8);
    put(other, STREAM_END, NULL, 0);
    g_autofree char *said = refusal_of(other);
    g_assert_nonnull(strstr(said, "version"));
}

/* Texts are for people: no escape sequences, no books. */
static void test_texts(void)
{
    g_autoptr(GByteArray) s = stream_new();
    const stream_error is = {.reason = STREAM_DAMAGED};
    static const char text[] = "red \x1b[31m\n\xff\xc2\x9b line";
    put_with(s, STREAM_ERROR, &is, sizeof is, text, sizeof text);
    put(s, STREAM_END, NULL, 0);
    g_autofree char *said = refusal_of(s);
    g_assert_cmpstr(said, ==, "red  [31m \xef\xbf\xbd   line");

    g_autoptr(GByteArray) endless = stream_new();
    g_autofree char *book = g_strnfill(1 << 20, 'a');
    put_with(endless, STREAM_ERROR, &is, sizeof is, book, (1 << 20) + 1);
    put(endless, STREAM_END, NULL, 0);
    g_autofree char *start = refusal_of(endless);
    g_assert_cmpuint(strlen(start), <=, 1000);

    g_autoptr(GByteArray) poor = stream_new();
    const stream_error memory = {.reason = STREAM_NO_MEMORY};
    put_with(poor, STREAM_ERROR, &memory, sizeof memory, "", 1);
    put(poor, STREAM_END, NULL, 0);
    g_autofree char *why = refusal_of(poor);
    g_assert_nonnull(strstr(why, "memory"));
}

/* Bytes, words and long words, since counts are those. */
static void mutate(GByteArray *s, GRand *random)
{
    static const uint64_t favourites[] = {0,          1,          0x7fffffff, 0xffffffff,
                                          UINT64_MAX, 1ull << 63, 0x7f800000, 8};
    for (int i = g_rand_int_range(random, 1, 5); i > 0; i--) {
        static const int widths[] = {1, 4, 8};
        const int width = widths[g_rand_int_range(random, 0, 3)];
        const guint at = (guint)g_rand_int_range(random, 0, (int)s->len - 8);
        const bool favourite = g_rand_boolean(random);
        const uint64_t any =
            (uint64_t)g_rand_int(random) << 32 | (uint64_t)g_rand_int(random);
        const uint64_t value =
            favourite ? favourites[g_rand_int_range(random, 0, G_N_ELEMENTS(favourites))]
                      : any;
        memcpy(s->data + (width > 1 ? at & ~3u : at), &value, (size_t)width);
    }
    if (g_rand_int_range(random, 0, 10) == 0)
        g_byte_array_set_size(s, (guint)g_rand_int_range(random, 0, (int)s->len));
}

static void test_mutations(void)
{
    enum { N = 10000 };
    g_autoptr(GRand) random = g_rand_new_with_seed(1);
    g_autoptr(GByteArray) whole = whole_stream();
    unsigned n_refused = 0;
    for (int i = 0; i < N; i++) {
        g_autoptr(GByteArray) s = g_byte_array_new();
        g_byte_array_append(s, whole->data, whole->len);
        mutate(s, random);
        g_autofree char *said = refusal_of(s);
        n_refused += said != NULL;
    }
    /* Most bytes are numbers, of which most may be changed. */
    g_assert_cmpuint(n_refused, >, N / 4);
    g_assert_cmpuint(n_refused, <, N);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/model/whole", test_whole);
    g_test_add_func("/model/cut-off", test_cut_off);
    g_test_add_func("/model/lying-meshes", test_lying_meshes);
    g_test_add_func("/model/lying-records", test_lying_records);
    g_test_add_func("/model/texts", test_texts);
    g_test_add_func("/model/mutations", test_mutations);
    return g_test_run();
}
