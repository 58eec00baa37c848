/*
 * Rays that come from where floats know a mesh as a few points, in a world that something
 * makes a million times larger: they meet what those meet that begin nearby, and take not
 * much longer.
 */
#include "cpu_time.h"
#include "shape_subjects.h"

/* Of the sheet; m that the world reaches down below it, where floats are half a metre
   apart; and of the rays, m that the one nearby begins before its target, and that both
   end behind it. */
enum { SIDE = 300, REACH = 1 << 22, NEARBY = 8, BEHIND = 2, N_RAYS = 2000 };

/* ---- The world ---- */

static void add_vertex(mesh *m, double x, double y, double z)
{
    const float p[3] = {(float)x, (float)y, (float)z};
    memcpy(&m->positions[3 * m->n_vertices++], p, sizeof p);
}

static void add_triangle(mesh *m, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t corners[3] = {a, b, c};
    memcpy(&m->indices[3 * m->n_triangles++], corners, sizeof corners);
}

/* A wavy sheet, 2 m wide. */
static void add_sheet(mesh *m)
{
    for (int i = 0; i < SIDE * SIDE; i++) {
        double x = 2.0 * (i % SIDE) / (SIDE - 1) - 1.0;
        double y = 2.0 * (i / SIDE) / (SIDE - 1) - 1.0;
        add_vertex(m, x, y, 0.03 * sin(9.0 * x) * cos(7.0 * y));
    }
    for (uint32_t i = 0; i < SIDE * (SIDE - 1); i++) {
        if (i % SIDE == SIDE - 1)
            continue;
        add_triangle(m, i, i + 1, i + SIDE);
        add_triangle(m, i + 1, i + SIDE + 1, i + SIDE);
    }
}

/* Beside the sheet, and down. */
static void add_stray(mesh *m)
{
    uint32_t first = (uint32_t)m->n_vertices;
    add_vertex(m, 5.0, -3.0, -1.0);
    add_vertex(m, 5.0, 3.0, -1.0);
    add_vertex(m, 5.0, 0.0, -REACH);
    add_triangle(m, first, first + 1, first + 2);
}

/* All that is down there. */
static void add_speck(mesh *m)
{
    uint32_t first = (uint32_t)m->n_vertices;
    add_vertex(m, 0.0, 0.0, -REACH);
    add_vertex(m, 2.0, 0.0, -REACH);
    add_vertex(m, 0.0, 2.0, -REACH);
    add_triangle(m, first, first + 1, first + 2);
}

static void add_cloud(mesh *m)
{
    const double half = 1e6, height = 1000.0;
    uint32_t first = (uint32_t)m->n_vertices;
    add_vertex(m, -half, -half, height);
    add_vertex(m, half, -half, height);
    add_vertex(m, 0.0, 2.0 * half, height);
    add_triangle(m, first, first + 1, first + 2);
}

typedef void (*mesh_part)(mesh *m);

/* Of up to two parts. */
static shape *shape_of(mesh_part first, mesh_part second, int object)
{
    const shape_place at = {.to_world = transform_identity()};
    const size_t n_vertices = SIDE * SIDE + 3, n_triangles = 2 * SIDE * SIDE;
    GError *error = NULL;
    mesh m = {.positions = big_alloc(3 * n_vertices + 1, sizeof(float), "test", NULL),
              .indices = big_alloc(3 * n_triangles, sizeof(uint32_t), "test", NULL)};
    first(&m);
    if (second)
        second(&m);
    shape *made = shape_new_mesh(&m, &at, here, &error);
    g_assert_no_error(error);
    made->object = object;
    return made;
}

typedef struct world {
    shape *shapes[2];
    size_t n_shapes;
    instance placed;
    bool is_placed;
    accel *accel;
} world;

static void world_build(world *w)
{
    GError *error = NULL;
    const transform stays = transform_identity();
    w->placed = (instance){.object = 0, .to_world = motion_still(&stays)};
    const accel_input in = {.shapes = w->shapes,
                            .n_shapes = w->n_shapes,
                            .instances = &w->placed,
                            .n_instances = w->is_placed,
                            .n_objects = w->is_placed,
                            .shutter = {0.0, 1.0}};
    w->accel = accel_build(&in, 1, &error);
    g_assert_no_error(error);
}

static void world_clear(world *w)
{
    accel_free(w->accel);
    for (size_t i = 0; i < w->n_shapes; i++)
        shape_free(w->shapes[i]);
}

static world world_of(mesh_part first, mesh_part second)
{
    world w = {.shapes = {shape_of(first, NULL, NO_INDEX)}, .n_shapes = 1};
    if (second)
        w.shapes[w.n_shapes++] = shape_of(second, NULL, NO_INDEX);
    return w;
}

/* ---- Rays ---- */

static vec3 along(vec3 p, vec3 d, double t)
{
    vec3 out = {0};
    for (int i = 0; i < 3; i++)
        out[i] = (float)((double)p[i] + t * (double)d[i]);
    return out;
}

/* From above and afar. */
static ray ray_number(uint32_t n)
{
    sampler random = sampler_make(71, n);
    vec2 u = sampler_2d(&random);
    vec3 target = vec3_make(2.0f * u.x - 1.0f, 2.0f * u.y - 1.0f, 0.0f);
    vec3 d = -warp_sphere(sampler_2d(&random));
    d[2] = -0.2f - fabsf(d[2]);
    d = normalize3(d);
    return (ray){along(target, d, -REACH), d, REACH + BEHIND, 0, {{0}, 0}};
}

static ray moved_nearby(const ray *r)
{
    ray near = *r;
    near.origin = along(r->origin, r->direction, REACH - NEARBY);
    near.t_max = NEARBY + BEHIND;
    return near;
}

/* The triangle that each meets, -1: none. @return s */
static double ask(const accel *a, bool nearby, int64_t met[N_RAYS])
{
    double start = cpu_seconds();
    for (uint32_t n = 0; n < N_RAYS; n++) {
        surface_hit hit;
        ray from_afar = ray_number(n), near = moved_nearby(&from_afar);
        const ray *r = nearby ? &near : &from_afar;
        bool is_met = accel_intersect(a, r, &hit);
        g_assert_cmpint(accel_occluded(a, r), ==, is_met);
        met[n] = is_met ? (int64_t)hit.primitive : -1;
        if (is_met && !nearby)
            g_assert_cmpfloat(fabs((double)hit.t - REACH), <, BEHIND);
    }
    return cpu_seconds() - start;
}

/* Of some rays rounding decides which of two neighbours they meet. */
static void compare(world *w)
{
    world alone = world_of(add_sheet, NULL);
    g_autofree int64_t *want = g_new(int64_t, N_RAYS), *found = g_new(int64_t, N_RAYS);
    unsigned n_met = 0, n_others = 0;
    world_build(&alone);
    world_build(w);
    double near = ask(alone.accel, true, want), far = ask(w->accel, false, found);
    for (uint32_t n = 0; n < N_RAYS; n++) {
        n_met += want[n] >= 0;
        n_others += want[n] != found[n];
    }
    g_test_message("%u of %u met, %u others from afar; %.2f and %.2f ms", n_met, N_RAYS,
                   n_others, 1e3 * near, 1e3 * far);
    g_assert_cmpuint(n_met, >, N_RAYS / 2);
    g_assert_cmpuint(n_others, <=, N_RAYS / 100);
    g_assert_cmpfloat(far, <, 50.0 * near);
    world_clear(&alone);
    world_clear(w);
}

/* ---- Tests ---- */

static void test_another_shape(void)
{
    world w = world_of(add_sheet, add_stray);
    compare(&w);
}

static void test_a_vertex(void)
{
    world w = {.shapes = {shape_of(add_sheet, add_stray, NO_INDEX)}, .n_shapes = 1};
    compare(&w);
}

static void test_a_speck(void)
{
    world w = world_of(add_speck, add_sheet);
    compare(&w);
}

static void test_an_object(void)
{
    world w = {.shapes = {shape_of(add_sheet, add_stray, 0)}, .n_shapes = 1};
    w.is_placed = true;
    compare(&w);
}

/* What is met on the way is the nearest still. */
static void test_before(void)
{
    world w = world_of(add_sheet, add_cloud);
    world_build(&w);
    for (uint32_t n = 0; n < N_RAYS; n++) {
        ray r = ray_number(n);
        double t = (1000.0 - (double)r.origin[2]) / (double)r.direction[2];
        surface_hit hit;
        if (fabs((double)r.origin[0] + t * (double)r.direction[0]) > 1e4)
            continue;
        g_assert_true(accel_intersect(w.accel, &r, &hit));
        g_assert_cmpint(hit.shape, ==, 1);
        g_assert_cmpfloat(fabs((double)hit.t - t), <, 4.0);
        r.t_max = (float)(t - 4.0);
        g_assert_false(accel_intersect(w.accel, &r, &hit));
        g_assert_false(accel_occluded(w.accel, &r));
    }
    world_clear(&w);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/afar/another-shape", test_another_shape);
    g_test_add_func("/afar/a-vertex", test_a_vertex);
    g_test_add_func("/afar/a-speck", test_a_speck);
    g_test_add_func("/afar/an-object", test_an_object);
    g_test_add_func("/afar/before", test_before);
    return g_test_run();
}
