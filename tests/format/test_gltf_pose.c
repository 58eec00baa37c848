/*
 * gltf_pose: morph targets and skins at rest, against positions in closed form: joints
 * that turn, move and scale about points of their own, alone and mixed, the sum of morph
 * targets, and what the standard says does not count. The files are made here; two of
 * Debian's assimp-testmodels stand for those made by others.
 */
#include "scene_text.h"

#include <math.h>

/* ---- Files ---- */

/* The document in the making: what its accessors say, and their numbers. */
typedef struct numbers {
    GByteArray *bytes;
    GString *views, *accessors;
    int n;
} numbers;

static void numbers_clear(numbers *to)
{
    g_byte_array_unref(to->bytes);
    g_string_free(to->views, TRUE);
    g_string_free(to->accessors, TRUE);
}

static numbers numbers_new(void)
{
    return (numbers){g_byte_array_new(), g_string_new(NULL), g_string_new(NULL), 0};
}

static void add(numbers *to, const void *data, size_t size, int type, int count,
                const char *kind)
{
    const char *comma = to->n > 0 ? "," : "";
    g_string_append_printf(to->views,
                           "%s{\"buffer\":0,\"byteOffset\":%u,\"byteLength\":%zu}", comma,
                           to->bytes->len, size);
    g_string_append_printf(
        to->accessors,
        "%s{\"bufferView\":%d,\"componentType\":%d,\"count\":%d,"
        "\"type\":\"%s\"%s}",
        comma, to->n, type, count, kind,
        type == 5121 && strcmp(kind, "VEC4") != 0 ? ",\"normalized\":true" : "");
    g_byte_array_append(to->bytes, data, (guint)size);
    to->n++;
}

/* A tetrahedron, accessors by number: 0 positions, 1 joints (bytes) and 2 weights (that
   add up to 2: they are scaled), 3 inverse bind matrices of two joints (the second stood
   at (0, 0, 1)), 4 and 5 changes of the positions, 6 normals, 7 changes of the normals, 8
   joints that are not there; behind them document adds 9 the corners of triangles, 10
   joints and 11 weights of two vertices only. */
static numbers subject(void)
{
    static const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    static const uint8_t joints[] = {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0};
    static const uint8_t missing[] = {0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0};
    static const float weights[] = {2, 0, 0, 0, 2, 0, 0, 0, 1, 1, 0, 0, 2, 0, 0, 0};
    static const float binds[32] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0,  1,
                                    1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -1, 1};
    static const float up[] = {0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4};
    static const float along[] = {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    static const float normals[] = {0, 0, 1, 0, 0, 1, 0, 0.6f, 0.8f, 0.6f, 0, 0.8f};
    static const float turned[] = {0, 1, -1, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    numbers to = numbers_new();
    add(&to, positions, sizeof positions, 5126, 4, "VEC3");
    add(&to, joints, sizeof joints, 5121, 4, "VEC4");
    add(&to, weights, sizeof weights, 5126, 4, "VEC4");
    add(&to, binds, sizeof binds, 5126, 2, "MAT4");
    add(&to, up, sizeof up, 5126, 4, "VEC3");
    add(&to, along, sizeof along, 5126, 4, "VEC3");
    add(&to, normals, sizeof normals, 5126, 4, "VEC3");
    add(&to, turned, sizeof turned, 5126, 4, "VEC3");
    add(&to, missing, sizeof missing, 5121, 4, "VEC4");
    return to;
}

static char *document(const char *middle)
{
    static const uint16_t corners[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    numbers all = subject();
    static const uint8_t few_joints[8] = {0};
    static const float few_weights[8] = {1, 0, 0, 0, 1, 0, 0, 0};
    add(&all, corners, sizeof corners, 5123, 12, "SCALAR");
    add(&all, few_joints, sizeof few_joints, 5121, 2, "VEC4");
    add(&all, few_weights, sizeof few_weights, 5126, 2, "VEC4");
    g_autofree char *code = g_base64_encode(all.bytes->data, all.bytes->len);
    char *text = g_strdup_printf(
        "{\"asset\":{\"version\":\"2.0\"},%s,\"buffers\":[{\"byteLength\":%u,\"uri\":"
        "\"data:application/octet-stream;base64,%s\"}],\"bufferViews\":[%s],"
        "\"accessors\":[%s]}",
        middle, all.bytes->len, code, all.views->str, all.accessors->str);
    numbers_clear(&all);
    return text;
}

static scene *try_load(const char *middle, GError **error)
{
    scene_folder f = folder_new("");
    g_autofree char *text = document(middle);
    g_autofree char *path = g_build_filename(f.path, "a.gltf", NULL);
    folder_write(&f, "a.gltf", text, -1);
    scene *s = format_load(path, 1, NULL, error);
    folder_remove(&f);
    return s;
}

static scene *load(const char *middle)
{
    g_autoptr(GError) error = NULL;
    scene *s = try_load(middle, &error);
    g_assert_no_error(error);
    return s;
}

static const mesh *mesh_at(const scene *s, guint i)
{
    const shape *on = s->shapes->pdata[i];
    return on->kind->triangles(on->self);
}

static void assert_floats(const float *found, const float *expected, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (!(fabsf(found[i] - expected[i]) < 1e-5f))
            g_error("number %zu is %g, not %g", i, (double)found[i], (double)expected[i]);
}

#define PRIMITIVE(more) "{\"attributes\":{\"POSITION\":0" more "},\"indices\":9"
#define SKINNED ",\"JOINTS_0\":1,\"WEIGHTS_0\":2"
#define MESH(primitive) "\"meshes\":[{\"primitives\":[" primitive "}]}],"
#define SKIN                                                                             \
    "\"skins\":[{\"joints\":[1,2],\"inverseBindMatrices\":3}],\"scenes\":[{\"nodes\":"   \
    "[0,1]}],"
/* Joint 1 at (0, 0, 2); joint 2, its child, 1 above it, turned by 90 degrees about y. */
#define JOINTS                                                                           \
    "{\"translation\":[0,0,2],\"children\":[2]},{\"translation\":[0,0,1],\"rotation\":"  \
    "[0,0.70710678,0,0.70710678]}"

/* ---- Skins ---- */

/* By hand: joint 1 moves by (0, 0, 2). Joint 2 takes (x, y, z) to (z - 1, y, 3 - x). */
static void test_skin(void)
{
    static const float expected[] = {0,     0, 2,    /* (0, 0, 0) by joint 1 */
                                     -1,    0, 2,    /* (1, 0, 0) by joint 2 */
                                     -0.5f, 1, 2.5f, /* (0, 1, 0) by half of each */
                                     0,     0, 3};   /* (0, 0, 1) by joint 2 */
    /* Where the node itself is does not count, nor what it hangs on. */
    static const char *const nodes[] = {
        "{\"mesh\":0,\"skin\":0}," JOINTS,
        "{\"mesh\":0,\"skin\":0,\"translation\":[5,6,7],\"scale\":[3,3,3]}," JOINTS,
    };
    for (size_t i = 0; i < G_N_ELEMENTS(nodes); i++) {
        g_autofree char *text =
            g_strdup_printf(MESH(PRIMITIVE(SKINNED)) SKIN "\"nodes\":[%s]", nodes[i]);
        g_autoptr(scene) s = load(text);
        assert_floats(mesh_at(s, 0)->positions, expected, 12);
    }
}

/* Joints under a parent that is no joint; without matrices, joints stood at the origin.
 */
static void test_parents(void)
{
    static const float expected[] = {1, 0, 0, 1, 0, -2, 1, 2, 0, 3, 0, 0};
    g_autoptr(scene) s = load(MESH(PRIMITIVE(
        SKINNED)) "\"skins\":[{\"joints\":[1,1]}],\"scenes\":[{\"nodes\":[0,2]}],"
                  "\"nodes\":[{\"mesh\":0,\"skin\":0},{\"rotation\":[0,0.70710678,0,"
                  "0.70710678],\"scale\":[2,2,2]},{\"translation\":[1,0,0],\"children\":"
                  "[1]}]");
    assert_floats(mesh_at(s, 0)->positions, expected, 12);
}

/* A joint twice as long along z: normals lean away from it; one that is flattened may
   bend vertices, though nothing can be put into its space. */
static void test_normals(void)
{
    static const char middle[] = MESH(PRIMITIVE(
        SKINNED ",\"NORMAL\":6")) "\"skins\":[{\"joints\":[1,1]}],\"nodes\":[{\"mesh\":0,"
                                  "\"skin\":0},{\"scale\":[%s]}]";
    const float long_z = 1.0f / sqrtf(0.6f * 0.6f + 0.4f * 0.4f);
    const float leaning[] = {0,
                             0,
                             1,
                             0,
                             0,
                             1,
                             0,
                             0.6f * long_z,
                             0.4f * long_z,
                             0.6f * long_z,
                             0,
                             0.4f * long_z};
    const float flat[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0};
    g_autofree char *stretched = g_strdup_printf(middle, "1,1,2");
    g_autofree char *mirrored = g_strdup_printf(middle, "1,1,-2");
    g_autofree char *flattened = g_strdup_printf(middle, "1,1,0");
    g_autoptr(scene) a = load(stretched), b = load(mirrored), c = load(flattened);
    assert_floats(mesh_at(a, 0)->normals, leaning, 12);
    for (int i = 0; i < 4; i++) {
        const float *n = mesh_at(b, 0)->normals + 3 * i;
        const float turned[] = {leaning[3 * i], leaning[3 * i + 1], -leaning[3 * i + 2]};
        assert_floats(n, turned, 3);
    }
    assert_floats(mesh_at(c, 0)->positions, flat, 12);
}

/* ---- Morph targets ---- */

#define TARGETS ",\"targets\":[{\"POSITION\":4},{\"POSITION\":5,\"NORMAL\":7}]"

/* A node's weights stand before the mesh's; without any, nothing is changed. */
static void test_morph(void)
{
    static const struct {
        const char *of_mesh, *of_node;
        float up, along;
    } cases[] = {
        {"", "", 0, 0},
        {",\"weights\":[0.5,0]", "", 0.5f, 0},
        {",\"weights\":[0.5,0]", ",\"weights\":[0.25,-2]", 0.25f, -2},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        float up = cases[i].up, x = cases[i].along;
        const float expected[] = {x, 0, up, 1, 0, 2 * up, 0, 1, 3 * up, 0, 0, 1 + 4 * up};
        g_autofree char *text =
            g_strdup_printf("\"meshes\":[{\"primitives\":[" PRIMITIVE(",\"NORMAL\":6")
                                TARGETS "}]%s}],"
                                        "\"nodes\":[{\"mesh\":0%s}]",
                            cases[i].of_mesh, cases[i].of_node);
        g_autoptr(scene) s = load(text);
        const float *n = mesh_at(s, 0)->normals;
        const float turned[] = {0, x, 1 - x};
        float length = sqrtf(turned[1] * turned[1] + turned[2] * turned[2]);
        assert_floats(mesh_at(s, 0)->positions, expected, 12);
        g_assert_cmpfloat(fabsf(n[1] - turned[1] / length), <, 1e-5f);
        g_assert_cmpfloat(fabsf(n[2] - turned[2] / length), <, 1e-5f);
    }
}

/* Targets come first: vertex 0 goes up by 1, then where joint 1 puts it. */
static void test_morph_then_skin(void)
{
    static const float expected[] = {0, 0, 3, 1, 0, 2, 1, 1, 4, 4, 0, 3};
    g_autoptr(scene) s = load("\"meshes\":[{\"primitives\":[" PRIMITIVE(SKINNED) TARGETS
                              "}],\"weights\":[1,0]}"
                              "]," SKIN "\"nodes\":[{\"mesh\":0,\"skin\":0}," JOINTS "]");
    assert_floats(mesh_at(s, 0)->positions, expected, 12);
}

/* Nodes with one mesh and poses of their own are no instances of each other; nodes
   without are, and as the mesh's weights say. */
static void test_poses_of_one_mesh(void)
{
    g_autoptr(scene) s = load(
        "\"meshes\":[{\"primitives\":[" PRIMITIVE("") TARGETS
        "}],\"weights\":[1,0]}],"
        "\"nodes\":[{\"mesh\":0,\"weights\":[2,0],\"translation\":[10,0,0]},{\"mesh\":0,"
        "\"weights\":[3,0]},{\"mesh\":0},{\"mesh\":0,\"translation\":[0,0,20]}]");
    g_assert_cmpuint(s->shapes->len, ==, 3);
    g_assert_cmpfloat(fabsf(mesh_at(s, 0)->positions[11] - 9.0f), <, 1e-5f);
    g_assert_cmpfloat(fabsf(mesh_at(s, 0)->positions[0] - 10.0f), <, 1e-5f);
    g_assert_cmpfloat(fabsf(mesh_at(s, 1)->positions[11] - 13.0f), <, 1e-5f);
    g_assert_cmpfloat(fabsf(s->bounds.high[2] - 25.0f), <, 1e-4f);
}

/* A node without thickness is a plane; one without any size is not there. */
static void test_flat_node(void)
{
    g_autoptr(scene) s =
        load(MESH(PRIMITIVE("")) "\"nodes\":[{\"mesh\":0,\"scale\":[2,3,0]}]");
    g_assert_cmpfloat(fabsf(s->bounds.high[0] - 2.0f), <, 1e-5f);
    g_assert_cmpfloat(fabsf(s->bounds.high[1] - 3.0f), <, 1e-5f);
    g_assert_cmpfloat(s->bounds.high[2], <, 1e-5f);
    g_autoptr(GError) error = NULL;
    g_assert_null(try_load(
        MESH(PRIMITIVE("")) "\"nodes\":[{\"mesh\":0,\"scale\":[0,0,0]}]", &error));
}

/* ---- What is refused ---- */

static void test_refused(void)
{
    static const struct {
        const char *middle, *message;
    } cases[] = {
        {MESH(PRIMITIVE(",\"JOINTS_0\":8,\"WEIGHTS_0\":2")) SKIN
         "\"nodes\":[{\"mesh\":0,\"skin\":0}," JOINTS "]",
         "meshes[0].primitives[0].attributes: vertex 1 hangs on a joint that its skin "
         "has "
         "not"},
        {MESH(PRIMITIVE(",\"JOINTS_0\":10,\"WEIGHTS_0\":2")) SKIN
         "\"nodes\":[{\"mesh\":0,\"skin\":0}," JOINTS "]",
         "expected a JOINTS_0 and a WEIGHTS_0 of 4 elements, found 2 and 4"},
        {MESH(PRIMITIVE(",\"JOINTS_0\":1,\"WEIGHTS_0\":11")) SKIN
         "\"nodes\":[{\"mesh\":0,\"skin\":0}," JOINTS "]",
         "expected a JOINTS_0 and a WEIGHTS_0 of 4 elements, found 4 and 2"},
        {MESH(PRIMITIVE(SKINNED)) "\"skins\":[{\"joints\":[0,0,0],"
                                  "\"inverseBindMatrices\":3}],\"nodes\":[{\"mesh\":0,"
                                  "\"skin\":0}]",
         "skins[0]: expected 3 inverse bind matrices, found 2"},
        {MESH(PRIMITIVE(SKINNED)) "\"skins\":[{}],\"nodes\":[{\"mesh\":0,\"skin\":0}]",
         "skins[0]: expected at least one joint, found none"},
        {MESH(PRIMITIVE(SKINNED)) "\"nodes\":[{\"mesh\":0,\"skin\":1}]",
         "\"skin\" 1: there are only 0 skins"},
        {MESH(PRIMITIVE(SKINNED)) "\"skins\":[{\"joints\":[1]}],\"scenes\":[{\"nodes\":"
                                  "[0]}],\"nodes\":[{\"mesh\":0,\"skin\":0},{\"children\""
                                  ":[2]},{\"children\":[1]}]",
         "nodes[1]: expected nodes in a tree of at most 1000 levels"},
        {MESH(PRIMITIVE("") TARGETS) "\"nodes\":[{\"mesh\":0,\"weights\":[1]}]",
         "targets: expected as many targets as weights (1), found 2"},
        {MESH(PRIMITIVE("") ",\"targets\":[{\"POSITION\":9}]") "\"nodes\":[{\"mesh\":0,"
                                                               "\"weights\":[1]}]",
         "expected a POSITION of 4 elements, found 12"},
        {MESH(PRIMITIVE("") ",\"targets\":[{\"POSITION\":1}]") "\"nodes\":[{\"mesh\":0,"
                                                               "\"weights\":[1]}]",
         "expected a POSITION of 3 components, found 4"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autoptr(GError) error = NULL;
        g_autoptr(scene) s = try_load(cases[i].middle, &error);
        g_assert_null(s);
        if (!strstr(error->message, cases[i].message))
            g_error("%s\n  does not say: %s", error->message, cases[i].message);
    }
}

/* A chain of nodes that would overflow the stack. */
static void test_deep(void)
{
    g_autoptr(GString) nodes = g_string_new("\"scenes\":[{\"nodes\":[0]}],\"nodes\":[");
    for (int i = 1; i < 200000; i++)
        g_string_append_printf(nodes, "{\"children\":[%d]},", i);
    g_string_append(nodes, "{}]");
    g_autoptr(GError) error = NULL;
    g_assert_null(try_load(nodes->str, &error));
    g_assert_nonnull(strstr(error->message, "in a tree of at most 1000 levels"));
}

/* ---- Files of others ---- */

#define MODELS "/usr/share/assimp/models/glTF2/"

static void test_models(void)
{
    static const struct {
        const char *path;
        float low[3], high[3];
    } models[] = {
        /* Both joints put what stood around (0.5, 1, 0) around (0, 1, 0). */
        {MODELS "simple_skin/simple_skin.gltf", {-0.5f, 0, 0}, {0.5f, 2, 0}},
        /* Its weights are 0 at rest; its node makes metres of it. */
        {MODELS "glTF-Sample-Models/AnimatedMorphCube-glTF/AnimatedMorphCube.gltf",
         {-1, -1, -1},
         {1, 1, 1}},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(models); i++) {
        g_autoptr(GError) error = NULL;
        if (!g_file_test(models[i].path, G_FILE_TEST_EXISTS)) {
            g_test_skip("no assimp-testmodels");
            return;
        }
        g_autoptr(scene) s = format_load(models[i].path, 1, NULL, &error);
        g_assert_no_error(error);
        for (int c = 0; c < 3; c++) {
            g_assert_cmpfloat(fabsf(s->bounds.low[c] - models[i].low[c]), <, 1e-4f);
            g_assert_cmpfloat(fabsf(s->bounds.high[c] - models[i].high[c]), <, 1e-4f);
        }
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/gltf-pose/skin", test_skin);
    g_test_add_func("/gltf-pose/parents", test_parents);
    g_test_add_func("/gltf-pose/normals", test_normals);
    g_test_add_func("/gltf-pose/morph", test_morph);
    g_test_add_func("/gltf-pose/morph-then-skin", test_morph_then_skin);
    g_test_add_func("/gltf-pose/poses-of-one-mesh", test_poses_of_one_mesh);
    g_test_add_func("/gltf-pose/flat-node", test_flat_node);
    g_test_add_func("/gltf-pose/refused", test_refused);
    g_test_add_func("/gltf-pose/deep", test_deep);
    g_test_add_func("/gltf-pose/models", test_models);
    return g_test_run();
}
