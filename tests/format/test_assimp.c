/*
 * Models through the importer: Wavefront's OBJ and MTL as materials, STL and PLY as they
 * are, and Debian's collection of models, some of them damaged: each is read or refused
 * with a message.
 */
#include "scene_text.h"

#include "bsdf/bsdf_models.h"
#include "format/gltf/height_map.h"
#include "image/image.h"

#include <math.h>

#define TRIANGLE "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
#define FACE(name) "usemtl " name "\nf 1/1 2/2 3/3\n"
/* A tetrahedron, closed and turned outwards. */
#define BODY(name)                                                                       \
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl " name "\nf 1 3 2\nf 1 2 4\nf 1 4 3\n"   \
    "f 2 3 4\n"

static scene *load(const char *obj, const char *mtl, GError **error)
{
    scene_folder f = folder_new("");
    g_autofree char *text = g_strdup_printf("mtllib m.mtl\n%s", obj);
    folder_write(&f, "a.obj", text, -1);
    folder_write(&f, "m.mtl", mtl, -1);
    static const char *const names[] = {"R", "G", "B"};
    g_autoptr(image) img = image_new(2, 1, 3, names, NULL);
    img->pixels[3] = img->pixels[4] = img->pixels[5] = 1.0f;
    g_autofree char *picture = g_build_filename(f.path, "picture.png", NULL);
    g_assert_true(image_write(img, picture, NULL, NULL));
    g_ptr_array_add(f.files, g_steal_pointer(&picture));
    g_autofree char *path = g_build_filename(f.path, "a.obj", NULL);
    scene *s = format_load(path, 1, NULL, error);
    folder_remove(&f);
    return s;
}

static scene *load_right(const char *obj, const char *mtl)
{
    g_autoptr(GError) error = NULL;
    scene *s = load(obj, mtl, &error);
    g_assert_no_error(error);
    return s;
}

static const material *first_material(const scene *s)
{
    const shape *on = s->shapes->pdata[0];
    return s->materials->pdata[on->material];
}

static void test_materials(void)
{
    static const struct {
        const char *obj, *mtl, *kind;
    } cases[] = {
        {TRIANGLE FACE("a"), "newmtl a\nKd 0.5 0.5 0.5\nillum 1\n", "diffuse"},
        {TRIANGLE FACE("a"), "newmtl a\nKd 0.5 0.5 0.5\nKs 0.2 0.2 0.2\nNs 50\nillum 2\n",
         "phong"},
        {TRIANGLE FACE("a"), "newmtl a\nKd 0 0 0\nKs 0.9 0.9 0.9\nNs 999\nillum 3\n",
         "conductor"},
        {BODY("a"), "newmtl a\nKd 0 0 0\nNi 1.33\nd 0.1\nillum 7\n", "dielectric"},
        {TRIANGLE FACE("a"), "newmtl a\nKd 0 0 0\nNi 1.33\nillum 4\n", "thindielectric"},
        {BODY("a"), "newmtl a\nKd 0 0 0\nNi 1.5\nTr 0.9\n", "dielectric"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autoptr(scene) s = load_right(cases[i].obj, cases[i].mtl);
        g_test_message("%s", cases[i].mtl);
        g_assert_cmpstr(first_material(s)->kind->name, ==, cases[i].kind);
        g_assert_cmpstr(first_material(s)->name, ==, "a");
    }
}

static bsdf bsdf_at(const material *m, float u)
{
    static const bsdf_options plain = {0};
    wavelengths w = wavelengths_at(0.5f);
    surface_hit hit = {.n = {0, 0, 1},
                       .n_geom = {0, 0, 1},
                       .dpdu = {1, 0, 0},
                       .dpdv = {0, 1, 0},
                       .uv = {u, 0.5f}};
    bsdf b;
    material_bsdf(m, &hit, &w, ALL_WAVELENGTHS, &plain, &b);
    return b;
}

static void test_maps(void)
{
    g_autoptr(scene) s = load_right(TRIANGLE FACE("a"),
                                    "newmtl a\nKd 1 1 1\nillum 1\nmap_Kd picture.png\n");
    g_assert_cmpfloat(bsdf_at(first_material(s), 0.75f).rho[3], >, 0.98f);
    g_assert_cmpfloat(bsdf_at(first_material(s), 0.25f).rho[3], <, 0.01f);

    g_autoptr(scene) cut = load_right(TRIANGLE FACE("a"),
                                      "newmtl a\nKd 1 1 1\nillum 1\nmap_d picture.png\n");
    surface_hit hit = {.uv = {0.75f, 0.5f}};
    g_assert_cmpfloat(shape_opacity(cut->shapes->pdata[0], &hit), >, 0.99f);
    hit.uv.x = 0.25f;
    g_assert_cmpfloat(shape_opacity(cut->shapes->pdata[0], &hit), <, 0.01f);

    /* An image that is missing is left out. */
    g_autoptr(scene) bare = load_right(
        TRIANGLE FACE("a"), "newmtl a\nKd 0.25 0.25 0.25\nillum 1\nmap_Kd none.png\n");
    g_assert_cmpfloat(fabsf(bsdf_at(first_material(bare), 0.5f).rho[3] - 0.25f), <,
                      0.01f);
}

/* A ramp is a slope, in the direction in which it falls, times -bm. */
static void test_heights(void)
{
    static const char *const names[] = {"R", "G", "B"};
    g_autoptr(image) img = image_new(8, 8, 3, names, NULL);
    for (int i = 0; i < 64; i++)
        for (int c = 0; c < 3; c++)
            img->pixels[3 * i + c] = 0.25f * (float)(i % 8 % 4) / 4.0f;
    g_assert_false(height_map_is_normals(img));
    g_autoptr(GBytes) bytes = height_map_as_normals(img, 8.0);
    g_autoptr(GError) error = NULL;
    g_autoptr(image) normals = image_read_bytes("n.pfm", bytes, NULL, &error);
    g_assert_no_error(error);
    /* 1/16 a texel, eight times as steep. */
    const float *n = normals->pixels + 3 * (8 * 3 + 2);
    float slope = 0.5f, length = sqrtf(1.0f + slope * slope);
    g_assert_cmpfloat(fabsf(2.0f * n[0] - 1.0f + slope / length), <, 1e-5f);
    g_assert_cmpfloat(fabsf(2.0f * n[1] - 1.0f), <, 1e-5f);
    g_assert_cmpfloat(fabsf(2.0f * n[2] - 1.0f - 1.0f / length), <, 1e-5f);

    g_autoptr(scene) s = load_right(
        TRIANGLE FACE("a"), "newmtl a\nKd 1 1 1\nillum 1\nmap_bump -bm 2 picture.png\n");
    bsdf b = bsdf_at(first_material(s), 0.5f);
    g_assert_true(first_material(s)->bump != NULL);
    g_assert_cmpfloat(length3(b.shading.n), >, 0.999f);
}

static void test_emission(void)
{
    g_autoptr(scene) s = load_right(TRIANGLE FACE("a"), "newmtl a\nKd 0 0 0\nKe 2 2 2\n");
    g_assert_cmpuint(s->lights->len, ==, 1);
    const light *l = scene_light(s, 0);
    g_assert_cmpstr(l->kind->name, ==, "diffuse");
}

static void test_stl_and_ply(void)
{
    static const char stl[] =
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"
        "vertex 2 0 0\nvertex 0 3 0\nendloop\nendfacet\nendsolid a\n";
    static const char ply[] =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
        "property float y\nproperty float z\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n"
        "0 0 0\n2 0 0\n0 3 0\n3 0 1 2\n";
    static const struct {
        const char *name, *text;
    } files[] = {{"a.stl", stl}, {"a.ply", ply}, {"a.data", ply}};
    for (size_t i = 0; i < G_N_ELEMENTS(files); i++) {
        g_autoptr(GError) error = NULL;
        scene_folder f = folder_new("");
        folder_write(&f, files[i].name, files[i].text, -1);
        g_autofree char *path = g_build_filename(f.path, files[i].name, NULL);
        g_autoptr(scene) s = format_load(path, 1, NULL, &error);
        g_assert_no_error(error);
        g_assert_cmpfloat(fabsf(s->bounds.high[1] - 3.0f), <, 1e-6f);
        folder_remove(&f);
    }
}

static void test_refused(void)
{
    g_autoptr(GError) error = NULL;
    g_assert_null(load("v 0 0 0\n", "", &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_clear_error(&error);
    g_assert_null(format_load("/nowhere/a.stl", 1, NULL, &error));
    g_assert_cmpstr(error->message, ==, "/nowhere/a.stl: expected a file, found none");
    g_clear_error(&error);
}

static void collect(const char *folder, GPtrArray *out)
{
    g_autoptr(GDir) dir = g_dir_open(folder, 0, NULL);
    for (const char *name; dir && (name = g_dir_read_name(dir));) {
        char *path = g_build_filename(folder, name, NULL);
        if (g_file_test(path, G_FILE_TEST_IS_DIR)) {
            collect(path, out);
            g_free(path);
        } else {
            g_ptr_array_add(out, path);
        }
    }
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* Every eighth model, or all of them if NEPHROID_ALL_MODELS is set. */
static void test_models(void)
{
    g_autoptr(GPtrArray) paths = g_ptr_array_new_with_free_func(g_free);
    collect("/usr/share/assimp/models", paths);
    collect("/usr/share/assimp/models-nonbsd", paths);
    if (paths->len == 0) {
        g_test_skip("the package assimp-testmodels is not installed");
        return;
    }
    g_ptr_array_sort(paths, by_name);
    unsigned n_read = 0, step = g_getenv("NEPHROID_ALL_MODELS") ? 1 : 8;
    for (guint i = 0; i < paths->len; i += step) {
        g_autoptr(GError) error = NULL;
        g_autoptr(scene) s = format_load(paths->pdata[i], 1, NULL, &error);
        if (s)
            n_read++;
        else
            g_assert_true(g_str_has_prefix(error->message, paths->pdata[i]));
    }
    g_assert_cmpuint(n_read, >, paths->len / step / 4);
}

/* What is missing is said, by name; what is there is not. */
static void keep_text(log_level level, const char *text, void *data)
{
    if (level == LOG_WARNING)
        g_string_append_printf(data, "%s\n", text);
}

static void test_missing_materials(void)
{
    static const struct {
        const char *head, *mtl_name, *said, *not_said; /* NULL: nothing is said */
    } cases[] = {
        {"mtllib m.mtl\nusemtl a\n", "m.mtl", NULL, NULL},
        {"mtllib my own.mtl \r\nusemtl a\r\n", "my own.mtl", NULL, NULL},
        {"mtllib gone.mtl\nusemtl a\n", "m.mtl", "'gone.mtl' (mtllib)", "usemtl"},
        {"mtllib gone.mtl\nusemtl a\n", "a.mtl", "a.mtl instead", "usemtl"},
        {"mtllib m.mtl\nusemtl b\nusemtl a\n", "m.mtl", "'b' (usemtl)", "'a'"},
        {"mtllib m.mtl\nmtllib m.mtl\nusemtl bb\nusemtl a\nusemtl bb\n", "m.mtl",
         "a.obj: material 'bb' (usemtl)", "'a'"},
        {"usemtl b\n", "m.mtl", "no file of them (mtllib)", "'b'"},
        {"", "m.mtl", NULL, NULL},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autoptr(GString) said = g_string_new(NULL);
        g_autoptr(GError) error = NULL;
        const log_sink sink = {keep_text, said};
        scene_folder f = folder_new("");
        g_autofree char *obj =
            g_strconcat(cases[i].head, TRIANGLE "f 1/1 2/2 3/3\n", NULL);
        folder_write(&f, "a.obj", obj, -1);
        folder_write(&f, cases[i].mtl_name, "# one\n  newmtl a\r\nKd 1 0 0\n", -1);
        g_autofree char *path = g_build_filename(f.path, "a.obj", NULL);
        scene *s = format_load(path, 1, &sink, &error);
        g_assert_no_error(error);
        scene_free(s);
        folder_remove(&f);
        g_test_message("%s: %s", cases[i].head, said->str);
        g_assert_true((strstr(said->str, "mtl") != NULL) == (cases[i].said != NULL));
        if (cases[i].said)
            g_assert_nonnull(strstr(said->str, cases[i].said));
        if (cases[i].not_said)
            g_assert_null(strstr(said->str, cases[i].not_said));
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/assimp/materials", test_materials);
    g_test_add_func("/assimp/maps", test_maps);
    g_test_add_func("/assimp/heights", test_heights);
    g_test_add_func("/assimp/emission", test_emission);
    g_test_add_func("/assimp/stl-and-ply", test_stl_and_ply);
    g_test_add_func("/assimp/refused", test_refused);
    g_test_add_func("/assimp/models", test_models);
    g_test_add_func("/assimp/missing-materials", test_missing_materials);
    return g_test_run();
}
