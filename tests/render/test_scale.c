/*
 * The unit of length: a room whose every length is multiplied by the same factor, a power
 * of two, gives the same picture, from rooms that are seen by no microscope to those that
 * hold the planets. Beyond that it is refused.
 *
 * A power of two changes no digit, so that path, vcm and auto give the same bits. What
 * looks around a photon's place draws its directions from the bits of that place,
 * exponent and all: there noise differs.
 */
#include "refused_scene.h"
#include "render_with.h"
#include "rooms.h"

#include <float.h>
#include <math.h>

/* Of the factor: of the world, of what takes it back before the camera, its square for
   lamps without a size, what media are multiplied by, and what is multiplied itself. */
#define BEFORE                                                                           \
    "LookAt 0.4 -3.4 1.2  0 0 0.9  0 0 1 Scale $b $b $b\n"                               \
    "Camera \"perspective\" \"float fov\" 55\n" SIZE(8) "WorldBegin\n"
#define OBJECT                                                                           \
    "ObjectBegin \"diamond\" Material \"diffuse\" \"rgb reflectance\" [0.2 0.6 0.3] "    \
    "Shape \"trianglemesh\" \"point3 P\" [0.5 0 0 0 0.5 0 -0.5 0 0 0 -0.5 0 0 0 0.5 0 "  \
    "0 -0.5] \"integer indices\" [0 1 4 1 2 4 2 3 4 3 0 4 1 0 5 2 1 5 3 2 5 0 3 5] "     \
    "Translate 0 0 0.6 Shape \"disk\" \"float radius\" 0.2 ObjectEnd\n"
#define PLACED                                                                           \
    "AttributeBegin Translate -0.3 1 1 Rotate 30 1 2 3 Scale 0.7 0.9 1 "                 \
    "ObjectInstance \"diamond\" AttributeEnd\n"                                          \
    "AttributeBegin ActiveTransform EndTime Translate 0.4 0 0.2 ActiveTransform All "    \
    "Translate -1.4 -1 1.2 Material \"diffuse\" Shape \"sphere\" \"float radius\" 0.2 "  \
    "AttributeEnd\n"
#define ROUND                                                                            \
    "AttributeBegin Translate 0.6 -0.5 0 " GLASS_BALL "AttributeEnd\n"                   \
    "AttributeBegin Translate -1 0.5 1 Rotate 40 1 1 0 Shape \"cylinder\" \"float "      \
    "radius\" 0.2 \"float zmin\" -0.3 \"float zmax\" 0.4 Shape \"bilinearmesh\" "        \
    "\"point3 P\" [-0.3 0 0.8 0.3 0 0.8 -0.3 0.4 1 0.3 0.4 0.7] AttributeEnd\n"          \
    "Shape \"curve\" \"string type\" \"cylinder\" \"point3 P\" [-1 -1 0.2 0 -1.3 0.8 "   \
    "0.3 -0.6 0.4 0.8 -1.2 1.2] \"float width\" 0.2\n"                                   \
    "Shape \"curve\" \"string type\" \"flat\" \"point3 P\" [-1.5 -1 0.2 -1.4 -1.3 0.8 "  \
    "-1.7 -0.6 0.4 -1.2 -1.2 1.6] \"float width\" 0.15\n"
#define BUMPS                                                                            \
    "Texture \"b\" \"float\" \"checkerboard\" \"float uscale\" 8 \"float vscale\" 8 "    \
    "\"float tex1\" 0 \"float tex2\" $l AttributeBegin Material \"diffuse\" \"texture "  \
    "displacement\" \"b\" Translate 0 1 0.4 Shape \"sphere\" \"float radius\" 0.3 "      \
    "AttributeEnd\n"
#define LAMPS                                                                            \
    "LightSource \"spot\" \"rgb I\" [3 1 1] \"point3 from\" [1.5 -1 1.5] \"point3 to\" " \
    "[0 0 0] \"float coneangle\" 40 \"float conedeltaangle\" 15 \"float scale\" $s\n"    \
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 9 9] Translate 1.5 1 1.6 "  \
    "Shape \"sphere\" \"float radius\" 0.1 AttributeEnd\n"
#define FOG                                                                              \
    "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" "           \
    "[0.1 0.2 0.3] \"rgb sigma_s\" [1 1 1] \"float scale\" $b\n"
#define SCALED_ROOM(before)                                                              \
    BEFORE OBJECT before "Scale $w $w $w\n" ROOM_LAMP("") ROOM_WALLS

static const char everything[] = SCALED_ROOM("") LAMPS BUMPS PLACED ROUND;
static const char foggy[] =
    SCALED_ROOM(FOG) "MediumInterface \"\" \"fog\" Material \"interface\" Shape "
                     "\"sphere\" \"float radius\" 1.5\n";

/* The scene with its lengths multiplied. */
static view *scaled(const char *text, double by)
{
    const struct {
        char letter;
        double value;
    } numbers[] = {{'w', by}, {'b', 1 / by}, {'s', by * by}, {'l', 0.05 * by}};
    g_autoptr(GString) all = g_string_new(NULL);
    for (; *text; text++) {
        char number[G_ASCII_DTOSTR_BUF_SIZE] = {*text};
        for (size_t i = 0; *text == '$' && i < G_N_ELEMENTS(numbers); i++)
            if (numbers[i].letter == text[1])
                g_ascii_dtostr(number, sizeof number, numbers[i].value);
        text += *text == '$';
        g_string_append(all, number);
    }
    return view_of(all->str);
}

/* The mean difference of pixels, over the mean of all. */
static double pixel_difference(const image *a, const image *b)
{
    double sum = 0;
    for (size_t i = 0; i < pixels_of(a); i++)
        sum += fabs(luminance_at(a, i) - luminance_at(b, i));
    return sum / (double)pixels_of(a) / mean_of(b, "");
}

typedef struct way {
    const char *name, *scene, *words;
    double off; /* what the mean difference of pixels may be */
} way;

/* To learn guiding takes a while: one way does. */
#define UNGUIDED "caustic_emission=uniform"

static const way ways[] = {
    {"path", everything, "integrator=path spp=4 passes=1", 1e-6},
    {"auto", everything, "integrator=auto spp=1 passes=1 photons=1500 edges=false", 1e-6},
    {"vcm", everything, "integrator=vcm spp=4 passes=1 photons=512 edges=false", 1e-6},
    {"photonmap", everything, "spp=1 passes=1 photons=1000 edges=false " UNGUIDED, 1e-6},
    {"sppm", everything, "integrator=sppm passes=1 photons=1000 edges=false " UNGUIDED,
     1e-6},
    {"fog-path", foggy, "integrator=path spp=4 passes=1", 1e-6},
    {"fog-photonmap", foggy, "spp=1 passes=1 photons=1000 edges=false " UNGUIDED, 1e-6},
    {"edges", everything, "integrator=sppm passes=1 photons=1000 " UNGUIDED, 0.04},
};

static void test_scales(gconstpointer data)
{
    static const double scales[] = {0x1p-36, 0x1p-30, 0x1p30, 0x1p36};
    const way *by = data;
    g_autoptr(view) plain = scaled(by->scene, 1);
    g_autoptr(image) want = render_with(plain, by->words);
    for (size_t i = 0; i < G_N_ELEMENTS(scales); i++) {
        g_autoptr(view) v = scaled(by->scene, scales[i]);
        g_autoptr(image) img = render_with(v, by->words);
        double off = pixel_difference(img, want);
        g_test_message("%g: %.6f %%", scales[i], 100 * off);
        g_assert_cmpfloat(off, <=, by->off);
    }
}

/* ---- What is refused ---- */

#define SEEN "Camera \"perspective\" WorldBegin\n"
#define LIMIT " m from the origin: expected coordinates up to 1e+12 m"

static void test_too_large(void)
{
    refuse(SEEN "Shape \"sphere\" \"float radius\" 2e12",
           "%s:2:1: the shape extends to 2e+12" LIMIT);
    refuse(SEEN "Scale 1e15 1e15 1e15 Shape \"disk\"",
           "%s:2:22: the shape extends to 1e+15" LIMIT);
    refuse(SEEN "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 -3e12 0] \"integer "
                "indices\" [0 1 2]",
           "%s:2:1: the shape extends to 3e+12" LIMIT);
    refuse(SEEN "ObjectBegin \"o\" Shape \"disk\" ObjectEnd\nScale 1e13 1e13 1e13 "
                "ObjectInstance \"o\"",
           "%s:3:37: the instance extends to 1e+13" LIMIT);
    refuse(SEEN "LightSource \"point\" \"point3 from\" [0 0 4e12] Shape \"disk\"",
           "%s:2:1: the light extends to 4e+12" LIMIT);
    refuse("Translate 0 0 1e30 " SEEN "Shape \"disk\"",
           "%s:1:20: the camera extends to 1e+30" LIMIT);
}

/* A ball of which floats know one point is left out, and one of a few steps is not. */
static void test_lost(void)
{
    g_autoptr(view) v = view_of(SEEN "Shape \"sphere\" AttributeBegin Translate 1e9 0 0 "
                                     "Shape \"sphere\" AttributeEnd Translate 1e6 0 0 "
                                     "Shape \"sphere\"");
    g_assert_cmpuint(v->scene->shapes->len, ==, 2);
}

static void test_too_small(void)
{
    refuse(SEEN "Shape \"disk\" \"float radius\" 2e-12",
           "%s: the scene's extent is 4e-12 m: expected 1e-11 to 1e+12 m");
}

/* ---- Rays that are none, and instances far from their object's size ---- */

static void test_strange_rays(void)
{
    static const float strange[] = {NAN, INFINITY, 1e30f, -1e19f, FLT_MAX};
    g_autoptr(view) v = scaled(everything, 1);
    ray good = {.direction = {0, 0, 1, 0}, .t_max = INFINITY};
    surface_hit hit;
    good.origin = vec3_make(0, 0, 1);
    g_assert_true(accel_intersect(v->scene->accel, &good, &hit));
    g_assert_true(accel_occluded(v->scene->accel, &good));
    for (size_t i = 0; i < G_N_ELEMENTS(strange); i++) {
        ray from = good, to = good;
        from.origin[1] = strange[i];
        to.direction[1] = strange[i];
        g_assert_false(accel_intersect(v->scene->accel, &from, &hit));
        g_assert_false(accel_occluded(v->scene->accel, &from));
        g_assert_false(accel_intersect(v->scene->accel, &to, &hit));
        g_assert_false(accel_occluded(v->scene->accel, &to));
    }
}

/* A metre of an object may be any length: what it is placed as is what is met. */
static void test_instances_of_any_size(void)
{
    static const double sizes[] = {1e-12, 1e-9, 1e-3, 1e9, 1e12};
    for (size_t i = 0; i < G_N_ELEMENTS(sizes); i++) {
        g_autofree char *text = g_strdup_printf(
            SEEN
            "Shape \"sphere\" \"float radius\" 0.1\nObjectBegin \"o\" Scale %g %g %g "
            "Shape \"trianglemesh\" \"point3 P\" [-0.5 -0.5 0 0.5 -0.5 0 0 0.5 0] "
            "\"integer indices\" [0 1 2] ObjectEnd Translate 0 0 2 Scale %g %g %g "
            "ObjectInstance \"o\"",
            sizes[i], sizes[i], sizes[i], 1 / sizes[i], 1 / sizes[i], 1 / sizes[i]);
        g_autoptr(scene) s = scene_of(text);
        ray up = {.direction = {0, 0, 1, 0}, .t_max = INFINITY};
        up.origin = vec3_make(0.1f, -0.1f, 1);
        surface_hit hit;
        g_assert_true(accel_intersect(s->accel, &up, &hit));
        g_assert_cmpfloat_with_epsilon(hit.t, 1, 1e-6);
        g_assert_cmpfloat_with_epsilon(hit.p[2], 2, 1e-6);
        g_assert_cmpfloat_with_epsilon(fabsf(hit.n_geom[2]), 1, 1e-6);
    }
}

/* Of a vector whose squares are no floats. */
static void test_normalize(void)
{
    for (int exponent = -37; exponent <= 37; exponent++) {
        float size = powf(10, (float)exponent);
        vec3 n = normalize3(vec3_make(3 * size, 0, -4 * size));
        g_assert_cmpfloat_with_epsilon(n[0], 0.6, 1e-6);
        g_assert_cmpfloat_with_epsilon(n[2], -0.8, 1e-6);
        float length = length3_of_area(vec3_make(3 * size, 0, -4 * size));
        g_assert_cmpfloat_with_epsilon(length / size, 5, 1e-5);
    }
    g_assert_cmpfloat(length3_of_area(vec3_make(0, 0, 0)), ==, 0);
    g_assert_cmpfloat(length3(normalize3(vec3_make(0, 0, 0))), ==, 0);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(ways); i++) {
        g_autofree char *name = g_strconcat("/scale/", ways[i].name, NULL);
        g_test_add_data_func(name, &ways[i], test_scales);
    }
    g_test_add_func("/scale/too-large", test_too_large);
    g_test_add_func("/scale/too-small", test_too_small);
    g_test_add_func("/scale/lost", test_lost);
    g_test_add_func("/scale/strange-rays", test_strange_rays);
    g_test_add_func("/scale/instances", test_instances_of_any_size);
    g_test_add_func("/scale/normalize", test_normalize);
    return g_test_run();
}
