/*
 * casters: which surfaces caustic photons are sent to, by what density, and which lights
 * stand apart from them.
 */
#include "photon/trace/casters.h"
#include "scene_text.h"

#include "math/sampler.h"

#define START                                                                            \
    "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n"                 \
    "LookAt 0 0 9 0 0 0 0 1 0\nCamera \"perspective\" \nWorldBegin\n"                    \
    "LightSource \"point\" \"point3 from\" [0 0 8]\n"

#define GLASS "Material \"dielectric\" "

/* White surfaces, lamps and interfaces are none; the area is that of what bends light. */
static void test_what_casts(void)
{
    g_autoptr(scene) s =
        scene_of(START "Shape \"sphere\" \"float radius\" 2\n" GLASS "Shape \"sphere\"\n"
                       "Material \"interface\" Shape \"sphere\" \"float radius\" 3\n");
    g_autoptr(caustic_casters) c = caustic_casters_new(s, NULL);
    g_assert_cmpint(c->n, ==, 1);
    g_assert_cmpint(c->all[0].shape, ==, 1);
    g_assert_cmpint(c->all[0].instance, ==, NO_INDEX);
    g_assert_cmpfloat(fabs(distribution_total(&c->area) - 4 * G_PI), <, 1e-4);
    g_assert_true(caustic_casters_are_lit(c));
}

/* Without any there is nothing to send to. */
static void test_none(void)
{
    g_autoptr(scene) s = scene_of(START "Shape \"sphere\"\n");
    g_autoptr(caustic_casters) c = caustic_casters_new(s, NULL);
    g_assert_cmpint(c->n, ==, 0);
    g_assert_false(caustic_casters_are_lit(c));
}

/* A ball of glass of radius 1 at the origin, and four lamps: the power that may meet its
 * sphere is that in the cone of half angle asin(R / 8), of a lamp in the ball all, of
 * parallel light and of the sky that of its disc in the scene's. */
static void test_lights_apart(void)
{
    g_autoptr(scene) s =
        scene_of(START "LightSource \"point\" \"point3 from\" [0 0.5 0]\n"
                       "LightSource \"distant\"\nLightSource \"infinite\"\n"
                       "Shape \"disk\" \"float radius\" 20 \"float height\" -1\n" GLASS
                       "Shape \"sphere\"\n");
    g_autoptr(caustic_casters) c = caustic_casters_new(s, NULL);
    static const bool apart[] = {true, false, false, false};
    double R = (double)c->radius, ratio = R / (double)s->radius;
    const double share[] = {1 - sqrt(1 - R * R / 64), 1, ratio * ratio, ratio * ratio};
    double total = 0;
    g_assert_cmpfloat(length3(c->center), <, 1e-5f);
    for (size_t i = 0; i < 4; i++)
        total += share[i] * (double)distribution_pdf(&s->light_power, i);
    for (size_t i = 0; i < 4; i++) {
        double of = share[i] * (double)distribution_pdf(&s->light_power, i) / total;
        g_assert_true(c->is_apart[i] == apart[i]);
        g_assert_cmpfloat(fabs((double)distribution_pdf(&c->power, i) / of - 1), <, 1e-4);
    }
}

/* The sphere is around all of the way of what moves. */
static void test_motion(void)
{
    g_autoptr(scene) s =
        scene_of(START "ActiveTransform EndTime\nTranslate 2 0 0\nActiveTransform All\n"
                       "Scale 2 1 1\nMaterial \"conductor\"\n"
                       "Shape \"sphere\" \"float radius\" 0.5\n");
    g_autoptr(caustic_casters) c = caustic_casters_new(s, NULL);
    g_assert_cmpint(c->n, ==, 1);
    g_assert_cmpfloat(c->radius, >, 1.9f);
}

/* Places for aimed photons, where instances are not stretched: the same number, area and
 * sphere as copies have, and a density whose integral is one. */
static void test_instances(void)
{
    static const char *const ball =
        "Material \"dielectric\"\nShape \"sphere\" \"float radius\" 0.5\n";
    g_autofree char *text = g_strdup_printf(
        START "ObjectBegin \"ball\"\n%sObjectEnd\n"
              "AttributeBegin Translate 2 0 0 ObjectInstance \"ball\" AttributeEnd\n"
              "AttributeBegin Scale 1 -2 1 Scale 2 1 2 ObjectInstance \"ball\" "
              "AttributeEnd\n%s",
        ball, ball);
    g_autoptr(scene) s = scene_of(text);
    g_autoptr(caustic_casters) c = caustic_casters_new(s, NULL);
    g_assert_cmpint(c->n, ==, 3);
    g_assert_cmpfloat(fabs(distribution_total(&c->area) - 6 * G_PI), <, 1e-3);
    g_assert_cmpfloat(c->radius, >, 1.7f);
    unsigned n[3] = {0}, total = 6000;
    for (uint32_t i = 0; i < total; i++) {
        sampler random = sampler_make(9, i);
        float u = sampler_1d(&random);
        vec3 p = caustic_casters_sample(c, u, sampler_2d(&random), 0.0f);
        float to[3] = {length3(p - vec3_make(2, 0, 0)) - 0.5f, length3(p) - 1.0f,
                       length3(p) - 0.5f};
        int on = 0;
        for (int k = 0; k < 3; k++)
            if (fabsf(to[k]) < fabsf(to[on]))
                on = k;
        g_assert_cmpfloat(fabsf(to[on]), <, 1e-5f);
        n[on]++;
    }
    g_assert_cmpfloat(fabs(n[1] - total * 4 / 6.0), <, 5 * sqrt(total * 2 / 9.0));
    g_assert_cmpfloat(fabs(n[0] - total / 6.0), <, 5 * sqrt(total * 5 / 36.0));
    ray r = {.origin = {2, 0, 5}, .direction = {0, 0, -1}, .t_max = INFINITY};
    surface_hit hit;
    g_assert_true(scene_intersect(s, &r, &hit));
    g_assert_cmpfloat(fabs(caustic_casters_density(c, &hit) * 6 * G_PI - 1), <, 1e-4);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/casters/what", test_what_casts);
    g_test_add_func("/casters/none", test_none);
    g_test_add_func("/casters/lights", test_lights_apart);
    g_test_add_func("/casters/motion", test_motion);
    g_test_add_func("/casters/instances", test_instances);
    return g_test_run();
}
