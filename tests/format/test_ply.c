/*
 * ply: one mesh written in every encoding and type reads back the same; what is broken is
 * refused with its line or byte.
 */
#include "format/ply/ply.h"

#include "base/memory.h"

#include <glib/gstdio.h>
#include <math.h>
#include <string.h>
#include <zlib.h>

typedef enum encoding { TEXT, LITTLE, BIG } encoding;

/** How the mesh below is to be written. */
typedef struct recipe {
    encoding encoding;
    const char *real, *count, *index; /**< types */
    bool extras; /**< other properties, lists and elements between those that are read */
    bool zip;
} recipe;

enum { N_VERTICES = 5, N_ROW = 8 };

/* x y z nx ny nz u v; numbers that every type holds exactly. */
static const float rows[N_VERTICES][N_ROW] = {{0, 0, 0, 0, 0, 1, 0, 0},
                                              {1, 0, 0, 0, 0, 1, 1, 0},
                                              {1, 1, 0, 0, 0, 1, 1, 1},
                                              {0, 1, 0, 0, 0, 1, 0, 1},
                                              {2, 3, 4, 1, 0, 0, 5, 6}};
static const uint32_t quad[4] = {0, 1, 2, 3}, triangle[3] = {2, 3, 4};
static const uint32_t expected_indices[9] = {0, 1, 2, 0, 2, 3, 2, 3, 4};

static bool is_type(const char *type, const char *a, const char *b)
{
    return strcmp(type, a) == 0 || strcmp(type, b) == 0;
}

static void put(GString *out, const recipe *r, const char *type, double value)
{
    char bytes[8];
    size_t n = 4;
    int32_t whole = (int32_t)(int64_t)value;
    if (r->encoding == TEXT) {
        g_string_append_printf(out, "%g ", value);
        return;
    }
    if (is_type(type, "double", "float64")) {
        memcpy(bytes, &value, n = 8);
    } else if (is_type(type, "float", "float32")) {
        memcpy(bytes, &(float){(float)value}, 4);
    } else {
        bool is_byte = strstr(type, "char") || g_str_has_suffix(type, "t8");
        bool is_short = strstr(type, "short") || g_str_has_suffix(type, "t16");
        memcpy(bytes, &whole, n = is_byte ? 1 : is_short ? 2 : 4);
    }
    for (size_t i = 0; i < n; i++)
        g_string_append_c(out, bytes[r->encoding == BIG ? n - 1 - i : i]);
}

static void put_list(GString *out, const recipe *r, const uint32_t *v, size_t n)
{
    put(out, r, r->count, (double)n);
    for (size_t i = 0; i < n; i++)
        put(out, r, r->index, v[i]);
}

static void put_header(GString *out, const recipe *r)
{
    static const char *const names[] = {"ascii", "binary_little_endian",
                                        "binary_big_endian"};
    static const char *const columns[N_ROW] = {"x", "y", "z", "nx", "ny", "nz", "u", "v"};
    g_string_append_printf(out, "ply\nformat %s 1.0\ncomment a test\n",
                           names[r->encoding]);
    if (r->extras)
        g_string_append(out, "element material 2\nproperty uchar red\n"
                             "property list uchar short weights\n");
    g_string_append_printf(out, "element vertex %d\n", N_VERTICES);
    for (int c = 0; c < N_ROW; c++) {
        if (r->extras && c == 3)
            g_string_append(out, "property uchar quality\n");
        g_string_append_printf(out, "property %s %s\n", r->real, columns[c]);
    }
    g_string_append(out, "element face 2\n");
    if (r->extras)
        g_string_append(out, "property int flags\n");
    g_string_append_printf(out, "property list %s %s vertex_indices\n", r->count,
                           r->index);
    if (r->extras)
        g_string_append(out, "property list uchar float texcoord\n");
    g_string_append(out, "end_header\n");
}

static void put_body(GString *out, const recipe *r)
{
    for (int i = 0; r->extras && i < 2; i++) {
        put(out, r, "uchar", 7);
        put(out, r, "uchar", i);
        for (int k = 0; k < i; k++)
            put(out, r, "short", 300);
    }
    for (int i = 0; i < N_VERTICES; i++)
        for (int c = 0; c < N_ROW; c++) {
            if (r->extras && c == 3)
                put(out, r, "uchar", 9);
            put(out, r, r->real, (double)rows[i][c]);
        }
    for (size_t face = 0; face < 2; face++) {
        if (r->extras)
            put(out, r, "int", -1);
        put_list(out, r, face ? triangle : quad, face ? 3 : 4);
        if (r->extras) {
            put(out, r, "uchar", 1);
            put(out, r, "float", 0.5);
        }
    }
}

/** Writes bytes to a new file; the name is owned by the caller. */
static char *write_file(const GString *bytes, bool zip)
{
    g_autofree char *folder = g_dir_make_tmp("nephroid-ply-XXXXXX", NULL);
    char *path = g_build_filename(folder, zip ? "mesh.ply.gz" : "mesh.ply", NULL);
    if (!zip) {
        g_assert_true(g_file_set_contents(path, bytes->str, (gssize)bytes->len, NULL));
        return path;
    }
    gzFile file = gzopen(path, "wb");
    g_assert_cmpint(gzwrite(file, bytes->str, (unsigned)bytes->len), ==, bytes->len);
    gzclose(file);
    return path;
}

static void remove_file(char *path)
{
    g_autofree char *folder = g_path_get_dirname(path);
    g_unlink(path);
    g_rmdir(folder);
    g_free(path);
}

static void check_mesh(const mesh *m)
{
    g_assert_cmpuint(m->n_vertices, ==, N_VERTICES);
    g_assert_cmpuint(m->n_triangles, ==, 3);
    g_assert_cmpmem(m->indices, sizeof expected_indices, expected_indices,
                    sizeof expected_indices);
    for (int i = 0; i < N_VERTICES; i++) {
        g_assert_cmpmem(m->positions + 3 * i, 12, rows[i], 12);
        g_assert_cmpmem(m->normals + 3 * i, 12, rows[i] + 3, 12);
        g_assert_cmpmem(m->uvs + i, 8, rows[i] + 6, 8);
    }
}

static void round_trip(const recipe *r)
{
    g_autoptr(GString) bytes = g_string_new(NULL);
    g_autoptr(GError) error = NULL;
    put_header(bytes, r);
    put_body(bytes, r);
    char *path = write_file(bytes, r->zip);
    mesh m = {0};
    bool read = ply_read(path, &m, &error);
    g_assert_no_error(error);
    g_assert_true(read);
    check_mesh(&m);
    mesh_clear(&m);
    remove_file(path);
}

static void test_every_encoding_and_type(void)
{
    static const char *const reals[] = {"float",   "float32", "double",
                                        "float64", "char",    "int16"};
    static const char *const counts[] = {"uchar", "uint8", "int", "ushort"};
    static const char *const indices[] = {"int", "uint32", "ushort", "int8", "short"};
    for (int e = TEXT; e <= BIG; e++)
        for (size_t i = 0; i < 6; i++)
            for (size_t k = 0; k < 5; k++) {
                recipe r = {(encoding)e, reals[i],    counts[k % 4],
                            indices[k],  (i + k) % 2, (i + k) % 3 == 0};
                round_trip(&r);
            }
}

/** n vertices and n faces that are triangles only, but face `odd`, which ends in `last`
 * and has a corner more if it is a quad. */
static GString *plain_triangles(uint32_t n, uint32_t odd, uint32_t last, bool is_quad)
{
    recipe r = {LITTLE, "float", "uchar", "int", false, false};
    GString *bytes = g_string_new("ply\nformat binary_little_endian 1.0\n");
    g_string_append_printf(bytes,
                           "element vertex %u\nproperty float x\nproperty float y\n"
                           "property float z\nelement face %u\n"
                           "property list uchar int vertex_index\nend_header\n",
                           n, n);
    for (uint32_t i = 0; i < 3 * n; i++)
        put(bytes, &r, "float", i);
    for (uint32_t i = 0; i < n; i++) {
        uint32_t v[4] = {i, n - 1 - i, i == odd ? last : 0, 1};
        put_list(bytes, &r, v, is_quad && i == odd ? 4 : 3);
    }
    return bytes;
}

/* Triangles alone take the quick way. */
static void test_many_plain_triangles(void)
{
    enum { N = 3000 };
    g_autoptr(GString) bytes = plain_triangles(N, N, 0, false);
    char *path = write_file(bytes, false);
    mesh m = {0};
    g_assert_true(ply_read(path, &m, NULL));
    g_assert_cmpuint(m.n_triangles, ==, N);
    g_assert_null(m.normals);
    g_assert_null(m.uvs);
    for (uint32_t i = 0; i < N; i++) {
        g_assert_cmpfloat(m.positions[3 * i + 2], ==, (float)(3 * i + 2));
        g_assert_cmpuint(m.indices[3 * i], ==, i);
        g_assert_cmpuint(m.indices[3 * i + 1], ==, N - 1 - i);
    }
    mesh_clear(&m);
    remove_file(path);
}

static void test_a_quad_among_triangles(void)
{
    g_autoptr(GString) bytes = plain_triangles(10, 4, 2, true);
    char *path = write_file(bytes, false);
    mesh m = {0};
    g_assert_true(ply_read(path, &m, NULL));
    g_assert_cmpuint(m.n_triangles, ==, 11);
    static const uint32_t corners[12] = {4, 5, 2, 4, 2, 1, 5, 4, 0, 6, 3, 0};
    g_assert_cmpmem(m.indices + 12, sizeof corners, corners, sizeof corners);
    mesh_clear(&m);
    remove_file(path);
}

static void refuse(const GString *bytes, const char *message)
{
    char *path = write_file(bytes, false);
    g_autoptr(GError) error = NULL;
    mesh m = {0};
    g_assert_false(ply_read(path, &m, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_autofree char *whole = g_strconcat(path, message, NULL);
    g_assert_cmpstr(error->message, ==, whole);
    g_assert_null(m.positions);
    remove_file(path);
}

static void refuse_text(const char *text, const char *message)
{
    g_autoptr(GString) bytes = g_string_new(text);
    refuse(bytes, message);
}

#define HEAD                                                                             \
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"                        \
    "property float y\nproperty float z\nelement face 1\n"                               \
    "property list uchar int vertex_indices\nend_header\n"

static void test_broken_text(void)
{
    refuse_text("", ":1:1: expected 'ply' on the first line, found something else");
    refuse_text("ply\n", ":2:1: expected end_header, found the end of the file");
    refuse_text("ply\nformat binary 1.0\n",
                ":2:1: expected ascii, binary_little_endian or binary_big_endian, found "
                "'binary'");
    refuse_text("ply\nformat ascii 1.0\nelement vertex -1\n",
                ":3:1: expected a number of elements, found '-1'");
    refuse_text("ply\nformat ascii 1.0\nproperty float x\n",
                ":3:1: expected an element before its properties, found 'property'");
    refuse_text("ply\nformat ascii 1.0\nelement vertex 3\nproperty half x\n",
                ":4:1: expected a type, found 'half'");
    refuse_text("ply\nend_header\n", ":2:1: expected a format before end_header, found "
                                     "'end_header'");
    refuse_text("ply\nformat ascii 1.0\nend_header\n",
                ": expected 1 to 4294967295 vertices, found 0");
    refuse_text(HEAD "0 0 0\n1 0 x\n0 1 0\n3 0 1 2\n",
                ":11:5: expected a number, found 'x'");
    refuse_text(HEAD "0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n",
                ": expected finite numbers, found z = nan of vertex 1");
    refuse_text(HEAD "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
                ":13:8: expected a vertex from 0 to 2, found 3");
    refuse_text(HEAD "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n",
                ":13:9: expected a vertex from 0 to 2, found -1");
    refuse_text(HEAD "0 0 0\n1 0 0\n0 1 0\n2 0 1\n",
                ":13:2: expected a face of 3 or 4 vertices, found one of 2");
    refuse_text(HEAD "0 0 0\n1 0 0\n0 1 0\n3 0 1\n",
                ":14:1: expected a number, found the end of the file");
}

static GString *binary_mesh(void)
{
    recipe r = {LITTLE, "float", "uchar", "int", false, false};
    GString *bytes = g_string_new(NULL);
    put_header(bytes, &r);
    put_body(bytes, &r);
    return bytes;
}

static void test_broken_binary(void)
{
    g_autoptr(GString) whole = binary_mesh();
    size_t body = whole->len - (N_VERTICES * N_ROW * 4 + 17 + 13);
    g_autoptr(GString) cut = g_string_new_len(whole->str, (gssize)whole->len - 4);
    g_autofree char *at = g_strdup_printf(
        ": byte %zu: expected a number, found the end of the file", whole->len - 4);
    refuse(cut, at);
    g_string_truncate(cut, body + 50);
    refuse(cut, ": expected 5 elements 'vertex', found the end of the file after at most "
                "1");
    g_autoptr(GString) nan = g_string_new_len(whole->str, (gssize)whole->len);
    memcpy(nan->str + body + 32 + 4, &(float){NAN}, 4);
    refuse(nan, ": expected finite numbers, found y = nan of vertex 1");
    g_autoptr(GString) beyond = g_string_new_len(whole->str, (gssize)whole->len);
    memcpy(beyond->str + whole->len - 4, &(uint32_t){5}, 4);
    g_autofree char *index =
        g_strdup_printf(": byte %zu: expected a vertex from 0 to 4, found 5", whole->len);
    refuse(beyond, index);
}

static void test_plain_triangle_out_of_range(void)
{
    g_autoptr(GString) beyond = plain_triangles(10, 4, 10, false);
    g_autoptr(GString) negative = plain_triangles(10, 9, UINT32_MAX, false);
    g_autofree char *first =
        g_strdup_printf(": byte %zu: expected a vertex from 0 to 9, found 10",
                        (size_t)beyond->len - 5 * 13);
    g_autofree char *second = g_strdup_printf(
        ": byte %zu: expected a vertex from 0 to 9, found -1", (size_t)negative->len);
    refuse(beyond, first);
    refuse(negative, second);
}

static void test_absurd_sizes(void)
{
    refuse_text("ply\nformat ascii 1.0\nelement vertex 9000000000000000000\n"
                "property float x\nproperty float y\nproperty float z\nend_header\n",
                ": expected 1 to 4294967295 vertices, found 9000000000000000000");
    refuse_text(
        "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\n"
        "property float x\nproperty float y\nproperty float z\nend_header\n",
        ": expected 4000000000 elements 'vertex', found the end of the file after "
        "at most 0");
}

static void test_missing_and_damaged_files(void)
{
    mesh m = {0};
    g_autoptr(GError) missing = NULL, damaged = NULL;
    g_assert_false(ply_read("/nowhere/mesh.ply", &m, &missing));
    g_assert_cmpstr(missing->message, ==,
                    "cannot open '/nowhere/mesh.ply': No such file or directory");
    g_autoptr(GString) bytes = binary_mesh();
    char *path = write_file(bytes, true);
    g_autofree char *zipped = NULL;
    size_t size;
    g_assert_true(g_file_get_contents(path, &zipped, &size, NULL));
    g_assert_true(g_file_set_contents(path, zipped, (gssize)size / 2, NULL));
    g_assert_false(ply_read(path, &m, &damaged));
    g_assert_error(damaged, NEPH_ERROR, ERROR_INPUT);
    g_assert_nonnull(strstr(damaged->message, "expected whole gzip data"));
    remove_file(path);
}

/* Any byte may be wrong: refused or read, never a crash or an index out of range. */
static void test_garbage(void)
{
    g_autoptr(GString) good = binary_mesh();
    g_autoptr(GRand) random = g_rand_new_with_seed(42);
    g_autoptr(GString) empty = g_string_new("");
    char *path = write_file(empty, false);
    for (int i = 0; i < 400; i++) {
        g_autofree char *bytes = g_memdup2(good->str, good->len);
        int n_changes = g_rand_int_range(random, 1, 6);
        for (int k = 0; k < n_changes; k++)
            bytes[g_rand_int_range(random, 0, (gint32)good->len)] =
                (char)g_rand_int_range(random, 0, 256);
        g_assert_true(g_file_set_contents_full(path, bytes, (gssize)good->len,
                                               G_FILE_SET_CONTENTS_NONE, 0600, NULL));
        mesh m = {0};
        g_autoptr(GError) error = NULL;
        bool read = ply_read(path, &m, &error);
        g_assert_true(read == (error == NULL));
        for (size_t t = 0; t < 3 * m.n_triangles; t++)
            g_assert_cmpuint(m.indices[t], <, m.n_vertices);
        mesh_clear(&m);
    }
    remove_file(path);
}

static void test_memory_that_is_refused(void)
{
    g_autoptr(GString) bytes = binary_mesh();
    char *path = write_file(bytes, true);
    unsigned n = 1;
    for (bool read = false; !read; n++) {
        g_autoptr(GError) error = NULL;
        mesh m = {0};
        big_alloc_fail_at(n);
        read = ply_read(path, &m, &error);
        if (!read)
            g_assert_error(error, NEPH_ERROR, ERROR_FAILED);
        mesh_clear(&m);
    }
    big_alloc_fail_at(0);
    g_assert_cmpuint(n, >=, 6);
    remove_file(path);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/ply/every-encoding-and-type", test_every_encoding_and_type);
    g_test_add_func("/ply/many-plain-triangles", test_many_plain_triangles);
    g_test_add_func("/ply/a-quad-among-triangles", test_a_quad_among_triangles);
    g_test_add_func("/ply/plain-triangle-out-of-range", test_plain_triangle_out_of_range);
    g_test_add_func("/ply/broken-text", test_broken_text);
    g_test_add_func("/ply/broken-binary", test_broken_binary);
    g_test_add_func("/ply/absurd-sizes", test_absurd_sizes);
    g_test_add_func("/ply/missing-and-damaged-files", test_missing_and_damaged_files);
    g_test_add_func("/ply/garbage", test_garbage);
    g_test_add_func("/ply/memory-that-is-refused", test_memory_that_is_refused);
    return g_test_run();
}
