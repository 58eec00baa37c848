/*
 * looked-around: which looks for edges the samples of a pixel share.
 */
#include "rooms.h"

#include "photon/looked_around.h"
#include "transport/photonmap/photonmap.h"
#include "transport/transport.h"

static const kernel CONE = {KERNEL_CONE, 1.1f};

/* A table of 2 x 2 m whose edge is x = 0, and the floor 2 cm below it. */
#define TABLE                                                                            \
    "Camera \"perspective\"\nWorldBegin\nShape \"trianglemesh\" \"point3 P\" [-2 -1 0 "  \
    "0 "                                                                                 \
    "-1 0 0 1 0 -2 1 0] \"integer indices\" [0 1 2 0 2 3]\nShape \"trianglemesh\" "      \
    "\"point3 P\" [-9 -9 -.02 9 -9 -.02 9 9 -.02 -9 9 -.02] \"integer indices\" [0 1 2 " \
    "0 2 3]\n"

static neighbourhood disc_at(const scene *s, vec3 p)
{
    return (neighbourhood){.scene = s, .p = p, .n = {0, 0, 1}, .radius = 0.1f};
}

static void test_covers(void)
{
    g_autoptr(view) v = view_of(TABLE);
    const neighbourhood middle = disc_at(v->scene, (vec3){-1, 0, 0}),
                        edge = disc_at(v->scene, (vec3){0, 0, 0});
    const looked_disc whole = disc_look(&middle, &CONE), half = disc_look(&edge, &CONE);
    g_assert_true(whole.whole);
    g_assert_cmpfloat(whole.coverage, ==, 1.0f);
    g_assert_false(half.whole);
    g_assert_cmpfloat_with_epsilon(half.coverage, 0.5f, 0.1f);
}

static void test_shared_on_its_surface_alone(void)
{
    g_autoptr(view) v = view_of(TABLE);
    static looked_around looked;
    const neighbourhood middle = disc_at(v->scene, (vec3){-1, 0, 0});
    const looked_disc seen = disc_look(&middle, &CONE);
    looked_around_put(&looked, &seen);
    neighbourhood other = middle;
    g_assert_true(looked_around_find(&looked, &other, &CONE) == &looked.discs[0]);
    other.p = middle.p + (vec3){0.02f, 0.01f, 0};
    g_assert_nonnull(looked_around_find(&looked, &other, &CONE));
    other.p = middle.p + (vec3){0.03f, 0, 0}; /* too far */
    g_assert_null(looked_around_find(&looked, &other, &CONE));
    other.p = middle.p + (vec3){0.001f, 0, -0.02f}; /* the floor beneath */
    g_assert_null(looked_around_find(&looked, &other, &CONE));
    other = middle;
    other.n = -middle.n; /* the other side */
    g_assert_null(looked_around_find(&looked, &other, &CONE));
    other = middle;
    other.radius *= 1.01f; /* another middle */
    g_assert_null(looked_around_find(&looked, &other, &CONE));
    const kernel gaussian = {.choice = KERNEL_GAUSSIAN};
    g_assert_null(looked_around_find(&looked, &middle, &gaussian));
    looked_around_forget(&looked);
    g_assert_null(looked_around_find(&looked, &middle, &CONE));
}

/* A thin wall stands between them, as a waterline does on the wall of a basin. */
static void test_shared_on_one_side_alone(void)
{
    g_autoptr(view) v = view_of(
        TABLE "Shape \"trianglemesh\" \"point3 P\" [-1 -1 0 -1 1 0 -1 1 1 -1 -1 1] "
              "\"integer indices\" [0 1 2 0 2 3]\n");
    static looked_around looked;
    const neighbourhood left = disc_at(v->scene, (vec3){-1.01f, 0, 0}),
                        beside = disc_at(v->scene, (vec3){-1.005f, 0.01f, 0}),
                        right = disc_at(v->scene, (vec3){-0.99f, 0, 0});
    const looked_disc seen = disc_look(&left, &CONE);
    looked_around_put(&looked, &seen);
    g_assert_nonnull(looked_around_find(&looked, &beside, &CONE));
    g_assert_null(looked_around_find(&looked, &right, &CONE));
}

static void test_oldest_goes_first(void)
{
    g_autoptr(view) v = view_of(TABLE);
    static looked_around looked;
    for (int i = 0; i <= LOOKED_DISCS; i++) {
        const neighbourhood middle = disc_at(v->scene, (vec3){-1, 0.05f * (float)i, 0});
        const looked_disc seen = disc_look(&middle, &CONE);
        looked_around_put(&looked, &seen);
    }
    const neighbourhood first = disc_at(v->scene, (vec3){-1, 0, 0}),
                        second = disc_at(v->scene, (vec3){-1, 0.05f, 0});
    g_assert_null(looked_around_find(&looked, &first, &CONE));
    g_assert_nonnull(looked_around_find(&looked, &second, &CONE));
}

/* Light, and how many looks were taken for it, of samples that share them or do not. */
static double look(const view *v, const transport_kind *kind, const void *pass,
                   bool shares, uint64_t *n_looks)
{
    transport_scratch scratch = {0};
    double sum = 0.0;
    for (uint64_t i = 0; i < 16 * 256; i++) {
        sampler random = sampler_make(3, i);
        vec2 u = sampler_2d(&random), lens = sampler_2d(&random);
        vec2 at = {(float)(i / 16 % 16) + u.x, (float)(i / 256) + u.y};
        ray r = camera_ray(&v->camera, at, lens, 0.5f);
        radiance_sample out = {.groups = NULL};
        if (!shares || i % 16 == 0)
            looked_around_forget(&scratch.estimate.looked);
        kind->radiance(pass, &r, &random, &scratch, &out);
        sum += (double)spectrum_mean(out.layers[LAYER_INDIRECT]);
    }
    *n_looks = scratch.estimate.n_looks;
    transport_scratch_clear(&scratch);
    return sum;
}

/* Samples of a pixel take fewer looks, and see the same light, edges and all. */
static void test_same_light(void)
{
    g_autoptr(view) v = view_of(ROOM);
    const transport_kind *kind = transport_find(INTEGRATOR_PHOTONMAP);
    transport_plan plan = {.scene = v->scene, .view = v};
    plan.how = settings_with(v->scene, "photons=50000 radius=0.4 threads=2");
    transport_counts counts = {0};
    uint64_t n_shared, n_alone;
    g_assert_true(kind->prepare(&plan, NULL, NULL));
    void *pass = kind->begin_pass(&plan, 0, NULL, &counts, NULL);
    double shared = look(v, kind, pass, true, &n_shared);
    double alone = look(v, kind, pass, false, &n_alone);
    g_test_message("%d looks, alone %d; %g, %g", (int)n_shared, (int)n_alone, shared,
                   alone);
    g_assert_cmpuint(3 * n_shared, <, 2 * n_alone);
    g_assert_cmpfloat_with_epsilon(shared / alone, 1.0, 0.003);
    kind->end_pass(pass);
    transport_plan_clear(&plan);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/looked-around/covers", test_covers);
    g_test_add_func("/looked-around/shared-on-its-surface-alone",
                    test_shared_on_its_surface_alone);
    g_test_add_func("/looked-around/shared-on-one-side-alone",
                    test_shared_on_one_side_alone);
    g_test_add_func("/looked-around/oldest-goes-first", test_oldest_goes_first);
    g_test_add_func("/looked-around/same-light", test_same_light);
    return g_test_run();
}
