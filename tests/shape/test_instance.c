/*
 * instance: objects seen by way of instances are what copies of them are, standing and
 * moving; a motion is where its definition says at every time.
 */
#include "math/sampler.h"
#include "math/warp.h"
#include "scene_text.h"

#define HEAD                                                                             \
    "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n"                 \
    "LookAt 0 0 9 0 0 0 0 1 0\nCamera \"perspective\" "
#define START HEAD "\nWorldBegin\nLightSource \"point\" \"point3 from\" [0 0 8]\n"

/* One of each kind of surface, at places of their own. */
static const char things[] =
    "Material \"diffuse\"\nShape \"sphere\" \"float radius\" 0.4\n"
    "AttributeBegin\nMaterial \"dielectric\"\nTranslate 1 0.2 0\nRotate 30 1 1 0\n"
    "Shape \"cylinder\" \"float radius\" 0.3\nAttributeEnd\n"
    "AttributeBegin\nReverseOrientation\nTranslate -1 0 0\n"
    "Shape \"trianglemesh\" \"point3 P\" [0 0 0 0.8 0 0.3 0 0.9 0.2 0.5 1 -0.4]\n"
    "\"integer indices\" [0 1 2 1 3 2]\nAttributeEnd\n"
    "AttributeBegin\nTranslate 0 1 0.5\nScale 1 1 -1\n"
    "Shape \"trianglemesh\" \"point3 P\" [0 0 0 0.8 0 0.3 0 0.9 0.2]\n"
    "\"normal N\" [0 0 1 0.2 0 1 0 0.3 1] \"point2 uv\" [0 0 2 0 0 3]\nAttributeEnd\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0 1 -1 0.4 -1 -0.4 0.6 1 -0.5 -0.2]\n"
    "Shape \"curve\" \"string type\" \"cylinder\" \"float width\" 0.2\n"
    "\"point3 P\" [-1 1 0 0 2 1 0 0 -1 1 1 0]\n";

static const char *const places[] = {
    "Translate 2 -1 0.5\n",
    "Translate -2 1 0\nRotate 50 1 -2 0.5\n",
    "Scale -1 1 1\nTranslate 1 2 1\n",
    "Translate 0 -3 0\nScale 0.5 1.4 -0.8\n",
    "Translate 500 -300 100\nScale 0.01 0.01 0.01\nTranslate -50000 30000 -10000\n",
};

/* The things at every place, as copies or as instances of one object. */
static scene *crowd(bool instances)
{
    g_autoptr(GString) text = g_string_new(START);
    if (instances)
        g_string_append_printf(text, "ObjectBegin \"things\"\n%sObjectEnd\n", things);
    for (size_t i = 0; i < G_N_ELEMENTS(places); i++)
        g_string_append_printf(text, "AttributeBegin\n%s%sAttributeEnd\n", places[i],
                               instances ? "ObjectInstance \"things\"\n" : things);
    return scene_of(text->str);
}

static ray random_ray(uint64_t key, uint32_t i, float time)
{
    sampler s = sampler_make(key, i);
    vec3 o = 6.0f * warp_sphere(sampler_2d(&s));
    vec3 to = 3.0f * sampler_1d(&s) * warp_sphere(sampler_2d(&s));
    return (ray){
        .origin = o, .direction = normalize3(to - o), .t_max = INFINITY, .time = time};
}

/* Where a transform mirrors, pbrt turns the normals of a quadric or a curve, but not
 * those of an instance of one: up to the sign. */
static void compare_hits(const surface_hit *a, const surface_hit *b, bool up_to_sign,
                         float tolerance)
{
    float sign = up_to_sign && dot3(a->n_geom, b->n_geom) < 0 ? -1 : 1;
    g_assert_cmpfloat(length3(a->p - b->p), <, tolerance);
    g_assert_cmpfloat(length3(a->n_geom - sign * b->n_geom), <, 60 * tolerance);
    g_assert_cmpfloat(length3(a->n - sign * b->n), <, 60 * tolerance);
    g_assert_cmpfloat(length3(a->dpdu - b->dpdu), <, 100 * tolerance);
    g_assert_cmpfloat(length3(a->dpdv - b->dpdv), <, 100 * tolerance);
    g_assert_cmpfloat(fabsf(a->uv.x - b->uv.x), <, 60 * tolerance);
}

/* Differences are allowed where rays graze: few, and counted. */
static void compare_scenes(const scene *a, const scene *b, float time, float tolerance)
{
    unsigned n = 0, differ = 0;
    for (uint32_t i = 0; i < 4000; i++) {
        ray r = random_ray(3, i, time);
        surface_hit x, y;
        bool met = scene_intersect(a, &r, &x);
        if (scene_intersect(b, &r, &y) != met || (met && fabsf(x.t - y.t) > tolerance)) {
            differ++;
            continue;
        }
        g_assert_cmpint(scene_occluded(b, &r), ==, met);
        if (!met)
            continue;
        const shape *on = b->shapes->pdata[y.shape];
        bool is_faceted = on->kind->triangles || strstr(on->kind->name, "mesh");
        compare_hits(&x, &y, !is_faceted, tolerance);
        g_assert_cmpint(x.material != NO_INDEX, ==, y.material != NO_INDEX);
        /* What leaves the instance does not meet it where it left. */
        ray away = hit_ray(&y, y.n_geom);
        surface_hit next;
        if (scene_intersect(b, &away, &next))
            g_assert_cmpfloat(next.t, >, 1e-4f);
        n++;
    }
    g_assert_cmpuint(n, >, 600);
    g_assert_cmpuint(differ, <, 12);
}

static void test_instances_are_copies(void)
{
    g_autoptr(scene) copies = crowd(false);
    g_autoptr(scene) instances = crowd(true);
    compare_scenes(copies, instances, 0.0f, 2e-4f);
    g_assert_cmpuint(instances->shapes->len, ==, 6);
    g_assert_cmpuint(instances->instances->len, ==, G_N_ELEMENTS(places));
    g_assert_false(instances->moves);
    for (int i = 0; i < 3; i++) {
        g_assert_cmpfloat(instances->bounds.low[i], <=, copies->bounds.low[i] + 1e-3f);
        g_assert_cmpfloat(instances->bounds.high[i], >=, copies->bounds.high[i] - 1e-3f);
    }
}

/* A ball and a triangle that are as large as a world in their own space, and as small as
 * a grain, are what they are at their own size. What is beyond single precision may be
 * missed, but is asked. */
static void test_strange_sizes(void)
{
    static const char body[] =
        "ObjectBegin \"a\"\nAttributeBegin\nScale %g %g %g\nShape \"sphere\"\n"
        "Shape \"trianglemesh\" \"point3 P\" [-3 -3 0 3 -3 0 0 3 0]\nAttributeEnd\n"
        "ObjectEnd\nScale %g %g %g\nObjectInstance \"a\"\n";
    static const double sizes[] = {1.0, 1e4, 1e7, 1e15, 1e-4, 1e-7, 1e-12, 1e17};
    g_autoptr(scene) plain = NULL;
    for (size_t i = 0; i < G_N_ELEMENTS(sizes); i++) {
        double k = sizes[i], l = 1.0 / k;
        g_autofree char *world = g_strconcat(START, body, NULL);
        g_autofree char *text = g_strdup_printf(world, k, k, k, l, l, l);
        g_autoptr(scene) s = scene_of(text);
        unsigned differ = 0, met = 0;
        for (uint32_t n = 0; n < 500; n++) {
            ray r = random_ray(11, n, 0.0f);
            surface_hit x, y;
            bool meets = scene_intersect(s, &r, &x);
            g_assert_cmpint(scene_occluded(s, &r), ==, meets);
            met += meets;
            if (plain && (scene_intersect(plain, &r, &y) != meets ||
                          (meets && fabsf(x.t - y.t) > 1e-4f * y.t)))
                differ++;
        }
        g_assert_cmpuint(met, >, 100);
        g_assert_true(differ < 3 || k > 1e9);
        if (!plain)
            plain = g_steal_pointer(&s);
    }
}

/* From beyond all reach, and from nowhere, nothing is met. */
static void test_rays_from_nowhere(void)
{
    g_autoptr(scene) s = scene_of(START "Shape \"sphere\"\n");
    static const float from[] = {1e13f, 1e20f, INFINITY, NAN};
    for (size_t i = 0; i < G_N_ELEMENTS(from); i++)
        for (int k = 0; k < 3; k++) {
            ray r = {.direction = {0.0f, 0.0f, -1.0f}, .t_max = INFINITY};
            surface_hit hit;
            r.origin[k] = from[i];
            g_assert_false(scene_intersect(s, &r, &hit));
            g_assert_false(scene_occluded(s, &r));
            r = (ray){.origin = {0.0f, 0.0f, 5.0f}, .t_max = INFINITY};
            r.direction[k] = isnan(from[i]) ? NAN : INFINITY;
            g_assert_false(scene_intersect(s, &r, &hit));
            g_assert_false(scene_occluded(s, &r));
        }
}

/* ---- Motion ---- */

/* The things on their way, at a share x of the time; still if x < 0. */
static scene *moving_things(double x, const char *times, const char *shutter)
{
    const double turn = 80, way[3] = {1.5, -1, 0.5}, grow = 1.6;
    g_autoptr(GString) text = g_string_new(times);
    g_string_append_printf(text, HEAD "%s\nWorldBegin\nLightSource \"point\"\n", shutter);
    if (x >= 0) {
        g_string_append_printf(text,
                               "Translate %.9g %.9g %.9g\nRotate %.9g 1 2 -1\n"
                               "Scale %.9g 1 1\n%s",
                               x * way[0], x * way[1], x * way[2], x * turn,
                               1 + x * (grow - 1), things);
        return scene_of(text->str);
    }
    g_string_append_printf(
        text,
        "ObjectBegin \"things\"\n%sObjectEnd\nActiveTransform EndTime\n"
        "Translate 1.5 -1 0.5\nRotate 80 1 2 -1\nScale 1.6 1 1\n"
        "ActiveTransform All\nObjectInstance \"things\"\n",
        things);
    return scene_of(text->str);
}

static void test_motion_at_every_time(void)
{
    g_autoptr(scene) moving = moving_things(-1, "", "");
    g_assert_true(moving->moves);
    for (int i = 0; i <= 4; i++) {
        g_autoptr(scene) still = moving_things(i / 4.0, "", "");
        compare_scenes(still, moving, (float)i / 4, 3e-4f);
        for (int k = 0; k < 3; k++) {
            g_assert_cmpfloat(moving->bounds.low[k], <=, still->bounds.low[k] + 0.2f);
            g_assert_cmpfloat(moving->bounds.high[k], >=, still->bounds.high[k] - 0.2f);
        }
    }
}

/* The motion takes from 2 to 6 s, the shutter is open from 3 to 4 s. */
static void test_times_and_shutter(void)
{
    static const char shutter[] = "\"float shutteropen\" 3 \"float shutterclose\" 4";
    g_autoptr(scene) moving = moving_things(-1, "TransformTimes 2 6\n", shutter);
    g_autoptr(scene) open = moving_things(0.25, "", "");
    g_autoptr(scene) middle = moving_things(0.375, "", "");
    compare_scenes(open, moving, 0.0f, 3e-4f);
    compare_scenes(middle, moving, 0.5f, 3e-4f);
    g_autoptr(scene) before =
        moving_things(-1, "TransformTimes 5 6\n", shutter); /* not yet */
    g_assert_false(before->moves);
}

/* A shape by itself moves as an instance does. */
static void test_a_shape_that_moves(void)
{
    g_autoptr(scene) s =
        scene_of(START "AttributeBegin\nActiveTransform EndTime\nTranslate 2 0 0\n"
                       "ActiveTransform All\nScale 2 1 1\nMaterial \"conductor\"\n"
                       "Shape \"sphere\" \"float radius\" 0.5\nAttributeEnd\n"
                       "Shape \"disk\" \"float height\" -3\n");
    for (int i = 0; i <= 8; i++) {
        float time = (float)i / 8;
        ray r = {.origin = {2 * time, 0, 5},
                 .direction = {0, 0, -1},
                 .t_max = INFINITY,
                 .time = time};
        surface_hit hit;
        g_assert_true(scene_intersect(s, &r, &hit));
        g_assert_cmpfloat(fabsf(hit.t - 4.5f), <, 1e-5f);
        g_assert_cmpfloat(fabsf(hit.time - time), <, 1e-7f);
        transform by = scene_motion_to(s, &hit, 0.5f);
        g_assert_cmpfloat(length3(transform_point(&by, hit.p) - vec3_make(1, 0, 0.5f)), <,
                          1e-5f);
        r.time = time < 0.5f ? 1.0f : 0.0f;
        g_assert_true(fabsf(2 * time - 2 * r.time) < 1.01f ||
                      !scene_intersect(s, &r, &hit) || hit.t > 5.0f);
    }
}

/* Twice as large in the end: the area of what it carries four times. */
static void test_growth(void)
{
    g_autoptr(scene) s =
        scene_of(START "ActiveTransform EndTime Scale 2 2 2\nShape \"disk\"\n");
    ray r = {.origin = {0, 0, 5}, .direction = {0, 0, -1}, .t_max = INFINITY};
    surface_hit hit;
    g_assert_true(scene_intersect(s, &r, &hit));
    g_assert_cmpfloat(fabs(scene_area_change(s, &hit, 1.0f) - 4), <, 1e-5);
    g_assert_cmpfloat(fabs(scene_area_change(s, &hit, 0.5f) - 2.25), <, 1e-5);
}

/* ---- Motion alone ---- */

/* A rotation turns evenly; what is left changes linearly; bounds hold all. */
static void test_motion_by_its_definition(void)
{
    transform turn = transform_rotate(150, 1, -1, 2),
              shift = transform_translate(1, 2, 3);
    transform mirror = transform_scale(-1, 2, 1);
    transform end = transform_multiply(&shift, &turn);
    end = transform_multiply(&end, &mirror);
    transform start = transform_scale(-1, 1, 1);
    motion m = motion_make(&start, &end, 10, 20);
    box3 box = {vec3_make(-1, -0.5f, 0), vec3_make(0.3f, 2, 1)};
    box3 all = motion_bounds(&m, box, 10, 20);
    for (int i = 0; i <= 100; i++) {
        double x = i / 100.0;
        transform t = motion_at(&m, 10 + 10 * x);
        transform part = transform_rotate(150 * x, 1, -1, 2);
        transform rest = transform_scale(-1, 1 + x, 1);
        transform expected = transform_translate(x, 2 * x, 3 * x);
        expected = transform_multiply(&expected, &part);
        expected = transform_multiply(&expected, &rest);
        for (int k = 0; k < 16; k++)
            g_assert_cmpfloat(fabs(t.m[k / 4][k % 4] - expected.m[k / 4][k % 4]), <,
                              1e-9);
        box3 now = transform_box(&t, box);
        for (int k = 0; k < 3; k++) {
            g_assert_cmpfloat(now.low[k], >=, all.low[k] - 1e-5f);
            g_assert_cmpfloat(now.high[k], <=, all.high[k] + 1e-5f);
        }
    }
    transform early = motion_at(&m, 0), late = motion_at(&m, 99);
    g_assert_true(transform_equal(&early, &start) && transform_equal(&late, &end));
    g_assert_false(motion_make(&end, &end, 0, 1).moves);
    g_assert_false(motion_make(&start, &end, 1, 1).moves);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/instance/strange-sizes", test_strange_sizes);
    g_test_add_func("/instance/rays-from-nowhere", test_rays_from_nowhere);
    g_test_add_func("/instance/copies", test_instances_are_copies);
    g_test_add_func("/instance/motion/times", test_motion_at_every_time);
    g_test_add_func("/instance/motion/shutter", test_times_and_shutter);
    g_test_add_func("/instance/motion/shape", test_a_shape_that_moves);
    g_test_add_func("/instance/motion/growth", test_growth);
    g_test_add_func("/instance/motion/definition", test_motion_by_its_definition);
    return g_test_run();
}
