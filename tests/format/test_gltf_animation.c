/*
 * gltf_animation: where nodes stand and how meshes are bent at a time, against closed
 * forms: linear moves, turns along the shorter arc, steps, splines, morph targets; before
 * the first key and after the last nothing moves; and files that do not add up.
 */
#include "scene_text.h"

#include <math.h>

/* Accessors, all floats in one buffer: 0 positions, 1 a morph target, 2 times 1 2 4,
   3 translations, 4 turns about z by 0, 90 and 270 degrees as quaternions, 5 scales,
   6 weights, 7 translations with tangents for two keys, 8 times 1 2, 9 a not-a-number. */
#define HALF 0.70710678f
static const float numbers[] = {
    0,   0,   0,   1,   0,   0,   0,    1,    0,                   /* 0 */
    0,   0,   1,   0,   0,   1,   0,    0,    1,                   /* 1 */
    1,   2,   4,                                                   /* 2 */
    0,   0,   0,   2,   0,   0,   2,    8,    0,                   /* 3 */
    0,   0,   0,   1,   0,   0,   HALF, HALF, 0,   0, HALF, -HALF, /* 4 */
    1,   1,   1,   2,   2,   2,   3,    3,    3,                   /* 5 */
    0,   1,   5,                                                   /* 6 */
    9,   9,   9,   0,   0,   0,   4,    0,    0,   0, 0,    0,
    1,   2,   3,   9,   9,   9,                    /* 7 */
    1,   2,                                        /* 8 */
    NAN, NAN, NAN, NAN, NAN, NAN, NAN,  NAN,  NAN, /* 9 */
};

static const struct {
    int first, count;
    const char *type;
} accessors[] = {{0, 3, "VEC3"},    {9, 3, "VEC3"},  {18, 3, "SCALAR"}, {21, 3, "VEC3"},
                 {30, 3, "VEC4"},   {42, 3, "VEC3"}, {51, 3, "SCALAR"}, {54, 6, "VEC3"},
                 {72, 2, "SCALAR"}, {74, 3, "VEC3"}};

#define MESH                                                                             \
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":[{\"POSITION\":1}]}]" \
    "}"

/* A triangle, and another that hangs on it, which the animations of the text move. */
static char *document(const char *animations)
{
    g_autofree char *code = g_base64_encode((const guchar *)numbers, sizeof numbers);
    g_autoptr(GString) list = g_string_new(NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(accessors); i++)
        g_string_append_printf(list,
                               "%s{\"bufferView\":0,\"byteOffset\":%zu,\"componentType\":"
                               "5126,\"count\":%d,\"type\":\"%s\"}",
                               i ? "," : "", (size_t)accessors[i].first * sizeof(float),
                               accessors[i].count, accessors[i].type);
    return g_strdup_printf(
        "{\"asset\":{\"version\":\"2.0\"},\"meshes\":[" MESH "," MESH
        "],\"nodes\":[{\"mesh\":0,"
        "\"translation\":[7,0,0],\"children\":[1]},{\"mesh\":1}],\"scenes\":[{\"nodes\":["
        "0]}],\"animations\":[%s],\"buffers\":[{\"byteLength\":%zu,\"uri\":\"data:"
        "application/octet-stream;base64,%s\"}],\"bufferViews\":[{\"buffer\":0,"
        "\"byteLength\":%zu}],\"accessors\":[%s]}",
        animations, sizeof numbers, code, sizeof numbers, list->str);
}

/* One channel of a node. */
static char *channel(int node, const char *path, int input, int output, const char *how)
{
    return g_strdup_printf(
        "{\"channels\":[{\"sampler\":0,\"target\":{\"node\":%d,\"path\":\"%s\"}}],"
        "\"samplers\":[{\"input\":%d,\"output\":%d%s}]}",
        node, path, input, output, how);
}

static scene *try_load(const char *animations, const double *time, GError **error)
{
    scene_folder f = folder_new("");
    g_autofree char *text = document(animations);
    g_autofree char *path = g_build_filename(f.path, "a.gltf", NULL);
    folder_write(&f, "a.gltf", text, -1);
    const load_options how = {
        .threads = 1, .at_time = time != NULL, .time = time ? *time : 0.0};
    scene *s = format_load_with(path, &how, error);
    folder_remove(&f);
    return s;
}

/* The corners of the mesh of a node. */
static void assert_corners(const char *animation, const double *time, guint node,
                           const float expected[9])
{
    g_autoptr(GError) error = NULL;
    g_autoptr(scene) s = try_load(animation, time, &error);
    g_assert_no_error(error);
    g_assert_true(s->is_animated);
    const shape *on = s->shapes->pdata[node];
    const mesh *m = on->kind->triangles(on->self);
    for (int i = 0; i < 9; i++)
        if (!(fabsf(m->positions[i] - expected[i]) < 1e-5f))
            g_error("%s: number %d is %g, not %g", animation, i, (double)m->positions[i],
                    (double)expected[i]);
}

static void assert_moved(const char *animation, double time, float x, float y, float z)
{
    const float expected[9] = {x, y, z, x + 1, y, z, x, y + 1, z};
    assert_corners(animation, &time, 0, expected);
}

static void test_moves(void)
{
    g_autofree char *linear = channel(0, "translation", 2, 3, "");
    g_autofree char *step =
        channel(0, "translation", 2, 3, ",\"interpolation\":\"STEP\"");
    g_autofree char *cubic =
        channel(0, "translation", 8, 7, ",\"interpolation\":\"CUBICSPLINE\"");
    assert_moved(linear, 0.0, 0, 0, 0);
    assert_moved(linear, 1.5, 1, 0, 0);
    assert_moved(linear, 2.0, 2, 0, 0);
    assert_moved(linear, 3.5, 2, 6, 0);
    assert_moved(linear, 9.0, 2, 8, 0);
    assert_moved(step, 1.9, 0, 0, 0);
    assert_moved(step, 2.0, 2, 0, 0);
    assert_moved(cubic, 0.5, 0, 0, 0);
    /* half of both, an eighth of the tangents */
    assert_moved(cubic, 1.5, 1, 1, 1.5f);
    assert_moved(cubic, 2.5, 1, 2, 3);
}

/* From 90 to 270 degrees, whose quaternions are opposite ways round, either way is as
   long. */
static void test_turns(void)
{
    g_autofree char *turn = channel(0, "rotation", 2, 4, "");
    static const struct {
        double time;
        float corners[9];
    } cases[] = {
        {1.5, {7, 0, 0, 7 + HALF, HALF, 0, 7 - HALF, HALF, 0}},
        {2.0, {7, 0, 0, 7, 1, 0, 6, 0, 0}},
        {4.0, {7, 0, 0, 7, -1, 0, 8, 0, 0}},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++)
        assert_corners(turn, &cases[i].time, 0, cases[i].corners);
}

/* A child goes along; it can be moved itself; targets and scales follow their keys. */
static void test_other_paths(void)
{
    g_autofree char *of_parent = channel(0, "translation", 2, 3, "");
    g_autofree char *scale = channel(1, "scale", 2, 5, "");
    g_autofree char *weights = channel(1, "weights", 2, 6, "");
    const double time = 3.0;
    const float along[9] = {2, 4, 0, 3, 4, 0, 2, 5, 0};
    const float scaled[9] = {7, 0, 0, 9.5f, 0, 0, 7, 2.5f, 0};
    const float bent[9] = {7, 0, 3, 8, 0, 3, 7, 1, 3};
    assert_corners(of_parent, &time, 1, along);
    assert_corners(scale, &time, 1, scaled);
    assert_corners(weights, &time, 1, bent);
}

/* Without a time it stands as the nodes say. */
static void test_at_rest(void)
{
    g_autofree char *linear = channel(0, "translation", 2, 3, "");
    const float rest[9] = {7, 0, 0, 8, 0, 0, 7, 1, 0};
    assert_corners(linear, NULL, 0, rest);
}

static void test_refused(void)
{
    static const struct {
        const char *path;
        int input, output;
        const char *how, *part;
    } cases[] = {
        {"translation", 2, 7, "", "values for each of 3 keys"},
        {"rotation", 2, 3, "", "expected VEC4"},
        {"translation", 2, 3, ",\"interpolation\":\"CUBICSPLINE\"", "expected 3 values"},
        {"translation", 2, 3, ",\"interpolation\":\"BEZIER\"", "found BEZIER"},
        {"translation", 2, 9, "", "finite"},
        {"translation", 99, 3, "", "accessors"},
        {"translation", 3, 3, "", "SCALAR"},
    };
    const double time = 1.0;
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autoptr(GError) error = NULL;
        g_autofree char *text =
            channel(0, cases[i].path, cases[i].input, cases[i].output, cases[i].how);
        g_assert_null(try_load(text, &time, &error));
        g_test_message("%s", error->message);
        g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    }
    g_autoptr(GError) none = NULL;
    g_assert_null(try_load("{\"channels\":[{\"target\":{\"node\":0,\"path\":\"scale\"}}],"
                           "\"samplers\":[]}",
                           &time, &none));
    g_assert_nonnull(strstr(none->message, "expected a \"sampler\""));
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/gltf-animation/moves", test_moves);
    g_test_add_func("/gltf-animation/turns", test_turns);
    g_test_add_func("/gltf-animation/other-paths", test_other_paths);
    g_test_add_func("/gltf-animation/at-rest", test_at_rest);
    g_test_add_func("/gltf-animation/refused", test_refused);
    return g_test_run();
}
