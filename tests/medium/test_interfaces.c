/*
 * interfaces: ways through participating media that surfaces part. What is left of light
 * is exp(-Σ σt × length), however the surfaces that part them came to where they are; and
 * the eye is found in the right medium after it was moved.
 */
#include "api/objects.h"
#include "scene/advance.h"
#include "scene/scene_media.h"
#include "scene_text.h"

/* Extinctions 0.5, 2 and 1 / m, the second scattering, too; and a coloured one. */
#define MEDIA                                                                            \
    "MakeNamedMedium \"a\" \"string type\" \"homogeneous\" \"spectrum sigma_a\" [300 "   \
    ".5 900 .5] \"spectrum sigma_s\" [300 0 900 0]\n"                                    \
    "MakeNamedMedium \"b\" \"string type\" \"homogeneous\" \"spectrum sigma_a\" [300 1 " \
    "900 1] \"spectrum sigma_s\" [300 3 900 3] \"float scale\" .5 \"float g\" .6\n"      \
    "MakeNamedMedium \"c\" \"string type\" \"homogeneous\" \"spectrum sigma_a\" [300 1 " \
    "900 7] \"spectrum sigma_s\" [300 0 900 0]\n"

#define BEGIN "WorldBegin LightSource \"distant\" Material \"interface\"\n"
#define WORLD MEDIA "Camera \"perspective\" " BEGIN

#define BETWEEN(inside, outside) "MediumInterface \"" inside "\" \"" outside "\"\n"

/* A box with its normals outward, from -half to half in x and y. */
#define BOX(half, near, far)                                                             \
    "Shape \"trianglemesh\" \"point3 P\" [-" half " -" half " " near " " half " -" half  \
    " " near " " half " " half " " near " -" half " " half " " near " -" half " -" half  \
    " " far " " half " -" half " " far " " half " " half " " far " -" half " " half      \
    " " far "] \"integer indices\" [0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 1 2 6 1 6 5 2 "  \
    "3 7 2 7 6 3 0 4 3 4 7]\n"

#define BALL(radius) "Shape \"sphere\" \"float radius\" " radius "\n"

#define OBJECT(text) "ObjectBegin \"o\" " text " ObjectEnd\n"

#define TURNED "Translate .2 -.3 0 Rotate 180 1 0 0 "

typedef struct crossing {
    const char *what, *text, *in; /* the medium that the ray starts in; NULL: none */
    double from[3], to[3];        /* the ray's ends */
    double depth;                 /* Σ σt × length of grey media ... */
    double coloured;              /* ... and metres in the coloured one */
} crossing;

/* Straight through, from z = -3 to 4, a little off the axis. */
#define THROUGH                                                                          \
    {.1, .05, -3},                                                                       \
    {                                                                                    \
        .1, .05, 4                                                                       \
    }

static const crossing crossings[] = {
    {"empty space", WORLD, NULL, THROUGH, 0, 0},
    {"a box", WORLD BETWEEN("a", "") BOX("2", "0", "1"), NULL, THROUGH, .5, 0},
    {"into a box",
     WORLD BETWEEN("a", "") BOX("2", "0", "1"),
     NULL,
     {0, 0, -3},
     {0, 0, .25},
     .125,
     0},
    {"out of a box",
     WORLD BETWEEN("a", "") BOX("2", "0", "1"),
     "a",
     {0, 0, .25},
     {0, 0, 4},
     .375,
     0},
    {"within a box",
     WORLD BETWEEN("a", "") BOX("2", "0", "1"),
     "a",
     {-1.5, 0, .25},
     {1.5, 0, .25},
     1.5,
     0},
    {"slanting",
     WORLD BETWEEN("a", "") BOX("9", "0", "1"),
     NULL,
     {0, -1, -1},
     {0, 2, 2},
     .5 * G_SQRT2,
     0},
    {"a coloured box", WORLD BETWEEN("c", "") BOX("2", "0", ".3"), NULL, THROUGH, 0, .3},
    {"one within another",
     WORLD BETWEEN("a", "") BOX("2", "0", "1") BETWEEN("b", "a") BOX("1", ".3", ".5"),
     NULL, THROUGH, .4 + .4, 0},
    {"the inner one first",
     WORLD BETWEEN("b", "a") BOX("1", ".3", ".5") BETWEEN("a", "") BOX("2", "0", "1"),
     NULL, THROUGH, .4 + .4, 0},
    {"three deep",
     WORLD BETWEEN("a", "") BOX("3", "0", "1") BETWEEN("b", "a") BOX("2", ".2", ".8")
         BETWEEN("c", "b") BOX("1", ".4", ".5"),
     NULL, THROUGH, .2 + 1, .1},
    {"one behind another",
     WORLD BETWEEN("a", "") BOX("2", "0", "1") BETWEEN("b", "") BOX("2", "1.5", "2"),
     NULL, THROUGH, .5 + 1, 0},
    {"a bubble",
     WORLD BETWEEN("a", "") BOX("2", "-1", "1") BETWEEN("", "a") BALL(".5"),
     NULL,
     {.3, 0, -3},
     {.3, 0, 3},
     .5 * (2 - .8),
     0},
    {"a bubble in endless fog",
     WORLD BETWEEN("", "b") BALL(".5"),
     "b",
     {0, .4, -1},
     {0, .4, 1},
     2 * (2 - .6),
     0},
    {"a ball", WORLD BETWEEN("b", "") BALL(".5"), NULL, {0, .4, -1}, {0, .4, 1}, 1.2, 0},
    {"a reversed ball",
     WORLD BETWEEN("", "b") "ReverseOrientation " BALL(".5"),
     NULL,
     {0, .4, -1},
     {0, .4, 1},
     1.2,
     0},
    /* A transform that mirrors turns a quadric's normals, as in pbrt, not a mesh's. */
    {"a mirrored ball",
     WORLD BETWEEN("", "b") "Scale -1 1 1 " BALL(".5"),
     NULL,
     {0, .4, -1},
     {0, .4, 1},
     1.2,
     0},
    {"a mirrored and reversed ball",
     WORLD BETWEEN("b", "") "Scale 1 1 -1 ReverseOrientation " BALL(".5"),
     NULL,
     {0, .4, -1},
     {0, .4, 1},
     1.2,
     0},
    {"a mirrored box", WORLD BETWEEN("a", "") "Scale -1 1 1 " BOX("2", "0", "1"), NULL,
     THROUGH, .5, 0},
    {"a box mirrored lengthwise",
     WORLD BETWEEN("a", "") "Scale 1 1 -2 " BOX("2", "0", "1"), NULL, THROUGH, 1, 0},
    {"a reversed box", WORLD BETWEEN("", "a") "ReverseOrientation " BOX("2", "0", "1"),
     NULL, THROUGH, .5, 0},
    {"a mirrored and reversed box",
     WORLD BETWEEN("", "a") "Scale 1 1 -1 ReverseOrientation " BOX("2", "0", "1"), NULL,
     THROUGH, .5, 0},
    {"an instance",
     WORLD OBJECT(BETWEEN("a", "") BOX("2", "0", "1")) TURNED "ObjectInstance \"o\"\n",
     NULL, THROUGH, .5, 0},
    {"a stretched instance",
     WORLD OBJECT(BETWEEN("a", "") BOX("2", "0", "1")) "Scale 2 1 3 ObjectInstance "
                                                       "\"o\"\n",
     NULL, THROUGH, 1.5, 0},
    {"a mirrored instance",
     WORLD OBJECT(BETWEEN("a", "") BOX("2", "0", "1")) "Scale 1 1 -1 ObjectInstance "
                                                       "\"o\"\n",
     NULL, THROUGH, .5, 0},
    {"a mirrored instance of a mirrored box",
     WORLD OBJECT(BETWEEN("a", "") "Scale 1 -1 1 " BOX(
         "2", "0", "1")) "Scale -1 1 1 ObjectInstance \"o\"\n",
     NULL, THROUGH, .5, 0},
    {"a mirrored instance of a reversed ball",
     WORLD OBJECT(BETWEEN("", "b") "ReverseOrientation " BALL(
         ".5")) "Scale 1 -1 1 ObjectInstance \"o\"\n",
     NULL,
     {0, .4, -1},
     {0, .4, 1},
     1.2,
     0},
    {"instances in a box",
     WORLD BETWEEN("a", "") BOX("2", "0", "1")
         OBJECT(BETWEEN("b", "a") BOX(".9", ".1", ".2")) "ObjectInstance \"o\" Translate "
                                                         "0 0 .5 ObjectInstance \"o\"\n",
     NULL, THROUGH, .4 + .4, 0},
    {"a surface that parts nothing",
     WORLD BETWEEN("a", "") BOX("2", "0", "1") BETWEEN("a", "a") BOX("1", ".3", ".5"),
     NULL, THROUGH, .5, 0},
    {"no interface within fog",
     WORLD BETWEEN("a", "") BOX("2", "0", "1") BETWEEN("", "") BALL(".2"), NULL, THROUGH,
     .5, 0},
    {"slabs of two discs",
     WORLD BETWEEN("b", "") "Shape \"disk\" \"float radius\" 2 ReverseOrientation "
                            "Translate 0 0 -.5 Shape \"disk\" \"float radius\" 2\n",
     NULL, THROUGH, 1, 0},
    {"far from the origin",
     WORLD "Translate 100 -50 300 " BETWEEN("a", "") BOX("2", "0", "1") BETWEEN("b", "a")
         BOX("1", ".3", ".5"),
     NULL,
     {100.1, -49.9, 290},
     {100.1, -49.9, 310},
     .8,
     0},
    {"small",
     WORLD "Scale .001 .001 .001 " BETWEEN("a", "") BOX("2", "0", "1") BETWEEN("b", "a")
         BOX("1", ".3", ".5"),
     NULL,
     {1e-4, 0, -1e-2},
     {1e-4, 0, 1e-2},
     .8e-3,
     0},
};

/* As in a medium_stack. */
static uint32_t medium_named(const scene *s, const char *name)
{
    if (!name)
        return 0;
    for (uint32_t number = 1; number <= s->media->len; number++)
        if (strcmp(scene_medium(s, number)->name, name) == 0)
            return number;
    g_error("no medium \"%s\"", name);
}

static ray ray_of(const scene *s, const crossing *c)
{
    vec3 from = vec3_make((float)c->from[0], (float)c->from[1], (float)c->from[2]);
    vec3 way = vec3_make((float)(c->to[0] - c->from[0]), (float)(c->to[1] - c->from[1]),
                         (float)(c->to[2] - c->from[2]));
    return (ray){.origin = from,
                 .direction = normalize3(way),
                 .t_max = length3(way),
                 .media.participating = medium_named(s, c->in)};
}

/* The coloured one: sigma_a runs from 1 at 300 nm to 7 at 900. */
static double left_at(const crossing *c, float nm)
{
    return exp(-c->depth - c->coloured * (1 + ((double)nm - 300) / 100));
}

/* n: surfaces on the way, at most. */
static void check_crossing(const crossing *c, int n)
{
    const wavelengths w = wavelengths_at(0.3f);
    g_autoptr(scene) s = scene_of(c->text);
    const ray r = ray_of(s, c);
    g_assert_false(scene_occluded(s, &r));
    spectrum left = scene_transmittance(s, &r, &w);
    /* Behind a surface rays start again a few millionths of their coordinates away. */
    double most = 0;
    for (int i = 0; i < 3; i++)
        most = fmax(most, fmax(fabs(c->from[i]), fabs(c->to[i])));
    double allowed = 2e-5 + n * 5e-6 * most * 2;
    for (int i = 0; i < N_WAVELENGTHS; i++) {
        double expected = left_at(c, w.lambda[i]);
        if (!(fabs((double)left[i] / expected - 1) < allowed))
            g_error("%s: %.6f is left, expected %.6f", c->what, (double)left[i],
                    expected);
    }
}

static void test_crossings(void)
{
    for (size_t i = 0; i < G_N_ELEMENTS(crossings); i++)
        check_crossing(&crossings[i], 6);
}

/* The other way round it is the same; only rays that start in nothing can be turned. */
static void test_both_ways(void)
{
    for (size_t i = 0; i < G_N_ELEMENTS(crossings); i++) {
        const crossing *c = &crossings[i];
        bool ends_in_nothing = c->to[2] > 1 || strstr(c->what, "small");
        if (c->in || !ends_in_nothing)
            continue;
        crossing back = *c;
        memcpy(back.from, c->to, sizeof back.from);
        memcpy(back.to, c->from, sizeof back.to);
        check_crossing(&back, 6);
    }
}

static void test_endless(void)
{
    const wavelengths w = wavelengths_at(0.5f);
    g_autoptr(scene) s = scene_of(WORLD BETWEEN("a", "") BOX("2", "0", "1"));
    ray r = {.direction = {0, 0, 1}, .origin = {0, 0, -2}, .t_max = INFINITY};
    g_assert_cmpfloat(fabsf(scene_transmittance(s, &r, &w)[0] - expf(-.5f)), <, 1e-5f);
    r.origin = vec3_make(0, 0, 2); /* away from it */
    g_assert_cmpfloat(scene_transmittance(s, &r, &w)[0], ==, 1.0f);
    /* What nothing bounds ends at a sphere that holds the box, of half-diagonal √8.25. */
    r.media.participating = medium_named(s, "a");
    float end = s->center[2] + s->media_radius - 2;
    g_assert_cmpfloat(s->media_radius, >, sqrtf(8.25f));
    g_assert_cmpfloat(fabsf(scene_transmittance(s, &r, &w)[0] - expf(-.5f * end)), <,
                      1e-5f);
}

/* A hundred shells around each other: media by turns. */
static void test_many(void)
{
    g_autoptr(GString) text = g_string_new(WORLD);
    double depth = 0;
    for (int i = 100; i > 0; i--) {
        bool even = i % 2 == 0;
        g_string_append_printf(text,
                               "MediumInterface \"%s\" \"%s\" Shape \"sphere\" \"float "
                               "radius\" %g\n",
                               even ? "a" : "b",
                               i == 100 ? ""
                               : even   ? "b"
                                        : "a",
                               i * .01);
        depth += 2 * .01 * (even ? .5 : 2);
    }
    check_crossing(
        &(crossing){"a hundred shells", text->str, NULL, {0, 0, -2}, {0, 0, 2}, depth, 0},
        200);
}

/* ---- The eye ---- */

#define EYE_WORLD                                                                        \
    BETWEEN("a", "")                                                                     \
    BOX("2", "0", "1")                                                                   \
    BETWEEN("b", "a")                                                                    \
    BOX("1", ".3", ".5")                                                                 \
    BETWEEN("c", "") OBJECT(BOX("1", "3", "4")) "ObjectInstance \"o\"\n"

typedef struct stand {
    double at[3];
    const char *in;
} stand;

static const stand stands[] = {
    {{0, 0, -3}, NULL},  {{0, 0, .2}, "a"},  {{0, 0, .4}, "b"},    {{0, 0, .7}, "a"},
    {{0, 0, 2}, NULL},   {{0, 0, 3.5}, "c"}, {{0, 0, 9}, NULL},    {{.5, .2, .4}, "b"},
    {{1.5, 0, .4}, "a"}, {{5, 5, .4}, NULL}, {{.2, .1, 3.2}, "c"}, {{0, 0, -3}, NULL},
};

/* From wherever it was given, by the installed header. */
static void check_stands(const char *text)
{
    scene_folder f = folder_new(text);
    g_autoptr(GError) error = NULL;
    NephScene *s = neph_scene_load(f.main, 1, NULL, NULL, &error);
    g_assert_no_error(error);
    for (size_t i = 0; i < G_N_ELEMENTS(stands); i++) {
        NephCamera c;
        neph_scene_camera(s, &c);
        memcpy(c.position, stands[i].at, sizeof c.position);
        g_assert_true(neph_scene_set_camera(s, &c, &error));
        uint32_t seen = s->view->camera.media.participating;
        const medium *in = scene_medium(s->scene, seen);
        if (g_strcmp0(in ? in->name : NULL, stands[i].in) != 0)
            g_error("stand %zu: in \"%s\", expected \"%s\"", i, in ? in->name : "",
                    stands[i].in ? stands[i].in : "");
        const ray r = camera_ray(&s->view->camera, (vec2){1, 1}, (vec2){.5f, .5f}, 0);
        g_assert_true(r.media.participating == seen);
    }
    neph_scene_free(s);
    folder_remove(&f);
}

#define EYE(look, in)                                                                    \
    MEDIA BETWEEN("", in) "LookAt " look " 0 1 0 Camera \"perspective\" " BEGIN EYE_WORLD

static void test_eye(void)
{
    check_stands(EYE("0 0 -3  0 0 0", ""));
    check_stands(EYE("0 0 .2  0 0 9", "a"));
    check_stands(EYE("0 0 .4  0 1 9", "b"));
    check_stands(EYE("0 0 3.5  0 0 9", "c"));
}

/* In fog without end it stays wherever it goes, but for a bubble. */
static void test_eye_in_endless_fog(void)
{
    g_autoptr(view) v =
        view_of(MEDIA BETWEEN("", "b") "Camera \"perspective\" " BEGIN BETWEEN(
            "", "b") "Translate 0 0 5 " BALL("1"));
    uint32_t b = medium_named(v->scene, "b");
    static const double z[] = {0, 5, 5.9, 20, 4.1, 3.9, -100};
    g_assert_true(v->camera.media.participating == b);
    for (size_t i = 0; i < G_N_ELEMENTS(z); i++) {
        const transform to_world = transform_translate(0, 0, z[i]);
        const motion still = motion_still(&to_world);
        view_place_camera(v, &still);
        g_assert_true(v->camera.media.participating == (fabs(z[i] - 5) < 1 ? 0 : b));
    }
}

/* ---- Lamps ---- */

/* What light leaves a lamp into: the current outside for those without a surface, the
   interface's sides for a shape, nothing for what is beyond all media. */
static void test_lamps(void)
{
    g_autoptr(scene) s = scene_of(
        WORLD BETWEEN("a", "b") "LightSource \"point\" LightSource \"distant\" "
                                "LightSource \"infinite\" \"rgb L\" [1 1 1] LightSource "
                                "\"spot\" AttributeBegin AreaLightSource \"diffuse\" "
                                "Material \"diffuse\" Shape \"disk\" AttributeEnd\n");
    const char *const outside[] = {NULL, "b", NULL, NULL, "b", "b"};
    const vec3 n = {0, 0, 1};
    g_assert_cmpint((int)s->lights->len, ==, 6);
    for (int i = 0; i < 6; i++)
        g_assert_true(scene_light_medium(s, i, n, n) == medium_named(s, outside[i]));
    g_assert_true(scene_light_medium(s, 5, n, -n) == medium_named(s, "a"));
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/interfaces/crossings", test_crossings);
    g_test_add_func("/interfaces/both-ways", test_both_ways);
    g_test_add_func("/interfaces/endless", test_endless);
    g_test_add_func("/interfaces/many", test_many);
    g_test_add_func("/interfaces/eye", test_eye);
    g_test_add_func("/interfaces/eye-in-endless-fog", test_eye_in_endless_fog);
    g_test_add_func("/interfaces/lamps", test_lamps);
    return g_test_run();
}
