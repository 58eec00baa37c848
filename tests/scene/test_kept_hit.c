/*
 * kept_hit: a hit restored from what a path keeps of it is the hit, to the bit, on every
 * shape, instanced, moving and within other media.
 */
#include "math/sampler.h"
#include "math/warp.h"
#include "scene/kept_hit.h"
#include "scene_text.h"

enum { RAYS = 20000 };

#define GROUPED(thing) "AttributeBegin " thing " AttributeEnd\n"
#define CURVE(type)                                                                      \
    "Shape \"curve\" \"string type\" \"" type "\" \"point3 P\" [-1 0 0 -0.3 1 0 0.3 -1 " \
    "0.5 1 0 0] \"float width\" 0.4 \"normal N\" [0 0 1 0 1 0]"
#define QUAD                                                                             \
    "\"point3 P\" [-1 -1 0 1 -1 0.2 -1 1 0.3 1 1 0] \"point2 uv\" [0 0 1 0 0 1 1 1]"

static const char text[] =
    "Camera \"perspective\"\nWorldBegin\n"
    "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n"
    "LightSource \"infinite\"\n" GROUPED(
        "Translate 3 0 0 Shape \"trianglemesh\" \"integer indices\" [0 1 2 1 3 2]" QUAD)
        GROUPED("Translate -3 0 0 AreaLightSource \"diffuse\" Rotate 20 1 1 0 "
                "Shape \"bilinearmesh\" " QUAD) GROUPED("Translate 0 3 0 Shape \"disk\" "
                                                        "\"float phimax\" 300")
            GROUPED("Translate 0 -3 0 Rotate 40 1 0 0 Shape \"cylinder\"") GROUPED(
                "Translate 0 0 3 " CURVE(
                    "flat")) GROUPED("Translate 0 0 -3 " CURVE("cylinder"))
                GROUPED("Translate 2 2 0 " CURVE("ribbon")) GROUPED(
                    "Material \"dielectric\" \"spectrum absorption\" [300 1 900 3] "
                    "Scale 1 2 1 Shape \"sphere\" \"float radius\" 1.4")
                    GROUPED(
                        "MediumInterface \"fog\" \"\" Material \"interface\" Translate 0 "
                        "0.3 0 "
                        "Shape \"sphere\"") "ObjectBegin \"thing\"\nShape \"sphere\" "
                                            "\"float radius\" 0.7\n"
                                            "Translate 0.5 0 0.5 Shape \"trianglemesh\" "
                                            "\"integer indices\" [0 1 2]" QUAD
                                            "\nObjectEnd\n" GROUPED(
                                                "Translate -2 2 1 Scale 1 -0.6 1.3 "
                                                "Rotate 70 1 2 3 ObjectInstance "
                                                "\"thing\"")
                                                GROUPED("Translate 2 -2 1 "
                                                        "ActiveTransform EndTime Rotate "
                                                        "80 0 1 0 Translate 0.5 0 0 "
                                                        "ActiveTransform All "
                                                        "ObjectInstance \"thing\"");

static ray random_ray(sampler *random)
{
    vec3 from = warp_sphere(sampler_2d(random)) * 6.0f;
    vec3 at = warp_sphere(sampler_2d(random)) * (4.0f * sampler_1d(random));
    return (ray){.origin = from,
                 .direction = normalize3(at - from),
                 .t_max = INFINITY,
                 .time = sampler_1d(random)};
}

static void same_vec3(vec3 a, vec3 b)
{
    for (int i = 0; i < 3; i++)
        g_assert_cmpmem(&(float){a[i]}, sizeof(float), &(float){b[i]}, sizeof(float));
}

static void same_number(float a, float b)
{
    g_assert_cmpmem(&a, sizeof a, &b, sizeof b);
}

static void same_place(const surface_hit *a, const surface_hit *b)
{
    same_vec3(a->p, b->p);
    same_vec3(a->n_geom, b->n_geom);
    same_vec3(a->n, b->n);
    same_vec3(a->dpdu, b->dpdu);
    same_vec3(a->dpdv, b->dpdv);
    g_assert_cmpmem(&a->uv, sizeof a->uv, &b->uv, sizeof b->uv);
    g_assert_cmpmem(&a->corners, sizeof a->corners, &b->corners, sizeof b->corners);
    same_number(a->t, b->t);
    same_number(a->error, b->error);
    same_number(a->time, b->time);
    same_number(a->footprint, b->footprint);
}

static void same_surface(const surface_hit *a, const surface_hit *b)
{
    g_assert_cmpint(a->camera_facing, ==, b->camera_facing);
    g_assert_cmpint(a->shape, ==, b->shape);
    g_assert_cmpint(a->instance, ==, b->instance);
    g_assert_cmpuint(a->primitive, ==, b->primitive);
    g_assert_cmpint(a->material, ==, b->material);
    g_assert_cmpint(a->light, ==, b->light);
    g_assert_true(a->mesh == b->mesh);
    g_assert_true(a->boundary == b->boundary);
    g_assert_cmpuint(a->solid, ==, b->solid);
    g_assert_cmpint(a->from_inside, ==, b->from_inside);
    g_assert_cmpmem(&a->media, sizeof a->media, &b->media, sizeof b->media);
}

/* Rays go on through what they meet, so that they come to surfaces from within. */
static void test_restored(void)
{
    g_autoptr(scene) s = scene_of(text);
    sampler random = sampler_make(7, 1);
    g_autofree int *met = g_new0(int, s->shapes->len);
    int placed = 0, moving = 0, within = 0;
    for (int i = 0; i < RAYS; i++) {
        ray r = random_ray(&random);
        surface_hit hit;
        for (int k = 0; k < 4 && scene_intersect(s, &r, &hit); k++) {
            const kept_hit kept = hit_keep(&r, &hit);
            const surface_hit again = scene_restore_hit(s, &kept);
            same_place(&again, &hit);
            same_surface(&again, &hit);
            same_vec3(kept_hit_wo(&kept), -r.direction);
            met[hit.shape]++;
            placed += hit.instance != NO_INDEX;
            moving += scene_hit_moves(s, &hit);
            within += hit.media.solid[0] > 0 && hit.media.participating > 0;
            r = hit_ray(&hit, r.direction);
        }
    }
    for (guint i = 0; i < s->shapes->len; i++)
        g_assert_cmpint(met[i], >, 20);
    g_assert_cmpint(placed, >, moving);
    g_assert_cmpint(moving, >, 100);
    g_assert_cmpint(within, >, 100);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/kept_hit/restored", test_restored);
    return g_test_run();
}
