/*
 * Rays of a packet meet what each of them meets alone: shapes of every kind, cut out,
 * placed and moving, behind interfaces, in worlds of all sizes and from afar.
 */
#include "math/sampler.h"
#include "math/warp.h"
#include "scene/advance.h"
#include "scene_text.h"

enum { PACKETS = 3000 };

#define HOLES                                                                            \
    "Texture \"holes\" \"float\" \"checkerboard\" \"float tex1\" 0 \"float tex2\" .6\n"
#define QUAD                                                                             \
    "\"point3 P\" [-1 -1 0 1 -1 0.2 -1 1 0.3 1 1 0] \"point2 uv\" [0 0 5 0 0 5 5 5]"
#define TRIANGLES "Shape \"trianglemesh\" \"integer indices\" [0 1 2 1 3 2]" QUAD
#define CURVE                                                                            \
    "Shape \"curve\" \"point3 P\" [-1 0 0 -0.3 1 0 0.3 -1 0.5 1 0 0] \"float width\" "   \
    "0.4\n"
#define CUT "\"texture alpha\" \"holes\"\n"
#define AT(place, thing) "AttributeBegin Translate " place "\n" thing " AttributeEnd\n"

static const char object[] =
    HOLES "ObjectBegin \"thing\"\nShape \"sphere\" \"float radius\" 0.7" CUT
          "Translate 0.5 0 0.5 " TRIANGLES "\nObjectEnd\n";
static const char things[] =
    AT("3 0 0", TRIANGLES CUT) AT("-3 0 0", "Shape \"bilinearmesh\" " QUAD)
        AT("0 3 0", "Shape \"disk\" \"float phimax\" 300")
            AT("0 -3 0", "Rotate 40 1 0 0 Shape \"cylinder\"" CUT) AT("0 0 3", CURVE)
                AT("0 0 0", "Material \"interface\" Shape \"sphere\"")
                    AT("0 0 0", "Shape \"sphere\" \"float radius\" .8")
                        AT("-2 2 1", "Scale 1 -0.6 1.3 Rotate 70 1 2 3 ObjectInstance "
                                     "\"thing\"")
                            AT("2 -2 1",
                               "ActiveTransform EndTime Rotate 80 0 1 0 Translate 0.5 0 "
                               "0 ActiveTransform All ObjectInstance \"thing\"");

/* Begins near the others of its packet or anywhere, and may end before it meets much. */
static ray random_ray(sampler *random, vec3 near, float spread, float scale)
{
    vec3 from = near + spread * warp_sphere(sampler_2d(random));
    vec3 at = warp_sphere(sampler_2d(random)) * (3.0f * sampler_1d(random));
    return (ray){.origin = scale * from,
                 .direction = normalize3(at - from),
                 .t_max = sampler_1d(random) < 0.5f ? INFINITY
                                                    : scale * 9.0f * sampler_1d(random),
                 .time = sampler_1d(random)};
}

typedef struct tally {
    int n, apart, met, moving;
} tally;

static void compare(tally *t, const scene *s, const ray *r, const surface_hit *hit)
{
    surface_hit alone;
    bool met = scene_meet_surface(s, r, &alone);
    t->n++;
    if (!met || hit->shape == NO_INDEX || hit->shape != alone.shape ||
        hit->instance != alone.instance || hit->primitive != alone.primitive ||
        hit->material != alone.material) {
        t->apart += met || hit->shape != NO_INDEX;
        return;
    }
    t->met++;
    t->moving += scene_hit_moves(s, hit);
    g_assert_cmpfloat(fabsf(hit->t - alone.t), <=, 4e-6f * alone.t);
    g_assert_cmpfloat(length3(hit->p - alone.p), <=, 1e-5f * alone.t);
    g_assert_cmpfloat(dot3(hit->n_geom, alone.n_geom), >, 0.999f);
    g_assert_cmpfloat(hit->time, ==, alone.time);
}

static scene *world_of(const char *more, float scale)
{
    char number[G_ASCII_DTOSTR_BUF_SIZE];
    g_ascii_dtostr(number, sizeof number, (double)scale);
    g_autofree char *text =
        g_strdup_printf("Camera \"perspective\"\nWorldBegin\nLightSource "
                        "\"infinite\"\n%s%sScale %s %s %s\n%s",
                        more, object, number, number, number, things);
    return scene_of(text);
}

static void compare_packet(tally *t, const scene *s, const ray *rays, int n)
{
    surface_hit hits[RAY_PACKET];
    scene_meet_surfaces(s, rays, n, hits);
    for (int k = 0; k < n; k++)
        compare(t, s, &rays[k], &hits[k]);
}

/* Cut-outs are passed by a choice of the hit's bits, which a packet may round
   differently. */
static void check(const char *more, float scale, float far)
{
    g_autoptr(scene) s = world_of(more, scale);
    sampler random = sampler_make(7, 1);
    tally t = {0};
    for (int i = 0; i < PACKETS; i++) {
        ray rays[RAY_PACKET];
        vec3 near = far * warp_sphere(sampler_2d(&random));
        int n = 1 + i % RAY_PACKET;
        for (int k = 0; k < n; k++)
            rays[k] = random_ray(&random, near, i % 2 == 0 ? 0.01f : far, scale);
        if (i % 7 == 0)
            rays[n / 2].origin *= 1e20f;
        compare_packet(&t, s, rays, n);
    }
    g_test_message("%d rays, %d met, %d moving, %d apart", t.n, t.met, t.moving, t.apart);
    g_assert_cmpint(t.apart, <, t.n / 200);
    g_assert_cmpint(t.met, >, t.n / 10);
    g_assert_cmpint(t.moving, >, t.n / 200);
}

static void test_packets(void)
{
    check("", 1.0f, 5.0f);
}

static void test_sizes(void)
{
    check("", 1e-6f, 5.0f);
    check("", 1e7f, 5.0f);
}

/* A vertex gone astray: rays are asked in parts. */
static void test_afar(void)
{
    check("Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" "
          "[0 0 -4000000 1 0 -4000000 0 1 -5000000]\n",
          1.0f, 100000.0f);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/packet/alone", test_packets);
    g_test_add_func("/packet/sizes", test_sizes);
    g_test_add_func("/packet/afar", test_afar);
    return g_test_run();
}
