/*
 * scene: building, what commit finds and refuses, the film directive, and the lights
 * asked as one.
 */
#include "light/light_kinds.h"
#include "scene/builder.h"
#include "scene_text.h"
#include "shape_subjects.h"

static params *no_params(void)
{
    return params_new(here, "/", color_space_srgb());
}

static params *one_number(const char *name, float value)
{
    params *p = no_params();
    params_add_numbers(p, here, PARAM_FLOAT, name, &value, 1, NULL);
    return p;
}

static void set_camera(scene_builder *b)
{
    g_autoptr(params) p = no_params();
    transform identity = transform_identity();
    GError *error = NULL;
    g_assert_true(builder_set_camera(b, "perspective", p, &identity, &error));
    g_assert_no_error(error);
}

static void add_light(scene_builder *b, const char *kind, float scale)
{
    g_autoptr(params) p = one_number("scale", scale);
    transform identity = transform_identity();
    GError *error = NULL;
    g_assert_true(builder_add_light(b, kind, p, &identity, &error));
    g_assert_no_error(error);
}

static int add_material(scene_builder *b, const char *name, const char *kind)
{
    g_autoptr(params) p = no_params();
    GError *error = NULL;
    int index = builder_add_material(b, name, kind, p, &error);
    g_assert_no_error(error);
    return index;
}

/* A ball at (x, y, z), shining if scale > 0. */
static void add_ball(scene_builder *b, const float p[3], float radius, int made_of,
                     float scale)
{
    g_autoptr(params) ball = one_number("radius", radius);
    g_autoptr(params) shine = one_number("scale", scale);
    shape_place at = {.to_world =
                          transform_translate((double)p[0], (double)p[1], (double)p[2]),
                      .material = made_of,
                      .area_light = scale > 0 ? shine : NULL};
    GError *error = NULL;
    g_assert_true(builder_add_shape(b, "sphere", ball, &at, &error));
    g_assert_no_error(error);
}

static scene *commit(scene_builder *b)
{
    GError *error = NULL;
    scene *s = scene_builder_commit(b, 1, &error);
    g_assert_no_error(error);
    return s;
}

/* White floor ball, glass ball, two lamps of power 1 : 8, a point light and a sky. */
static scene *make_scene(float unit)
{
    g_autoptr(scene_builder) b = scene_builder_new(NULL);
    set_camera(b);
    int white = add_material(b, "white", "diffuse");
    int glass = add_material(b, "glass", "dielectric");
    const float at[4][3] = {
        {0, 0, -3 * unit}, {0, 0, 0}, {-2 * unit, 0, 2 * unit}, {2 * unit, 0, 2 * unit}};
    add_ball(b, at[0], unit, white, 0);
    add_ball(b, at[1], unit, glass, 0);
    add_ball(b, at[2], 0.25f * unit, white, 1);
    add_ball(b, at[3], 0.5f * unit, NO_INDEX, 2);
    add_light(b, "point", square(unit));
    add_light(b, "infinite", 0.1f);
    return commit(b);
}

static void test_commit_finds_the_world(void)
{
    g_autoptr(scene) s = make_scene(1);
    g_assert_cmpint((int)s->lights->len, ==, 4);
    g_assert_cmpint(s->n_environments, ==, 1);
    g_assert_cmpint(s->environments[0], ==, 3);
    g_assert_cmpfloat(fabsf(s->bounds.low[2] + 4), <, 1e-5);
    g_assert_cmpfloat(fabsf(s->bounds.high[0] - 2.5f), <, 1e-5);
    for (unsigned corner = 0; corner < 8; corner++) {
        vec3 p = {0};
        for (int i = 0; i < 3; i++)
            p[i] = (corner >> i) & 1 ? s->bounds.high[i] : s->bounds.low[i];
        g_assert_cmpfloat(length3(p - s->center), <, s->radius);
    }
    /* power: lamps π A L = 1 : 8, point 4π; the sky is 4π² R² L */
    double lamp = G_PI * G_PI / 4;
    double sky = 4 * G_PI * G_PI * (double)(square(s->radius) * 0.1f);
    double expected[4] = {lamp, 8 * lamp, 4 * G_PI, sky};
    double total = 9 * lamp + 4 * G_PI + sky;
    for (int i = 0; i < 4; i++)
        g_assert_cmpfloat(fabs((double)distribution_pdf(&s->light_power, (size_t)i) -
                               expected[i] / total),
                          <, 1e-4);
}

static void test_hits_know_material_and_light(void)
{
    g_autoptr(scene) s = make_scene(1);
    const wavelengths w = wavelengths_at(0.5f);
    const bsdf_options options = {0};
    const int materials[4] = {0, 1, 0, NO_INDEX}, lights[4] = {NO_INDEX, NO_INDEX, 0, 1};
    const float x[4] = {0, 0, -2, 2}, z[4] = {-3, 0, 2, 2};
    for (int i = 0; i < 4; i++) {
        ray r = {{x[i], -10, z[i]}, {0, 1, 0}, INFINITY, 0, {{0}, 0}};
        surface_hit hit;
        bsdf b;
        g_assert_true(scene_intersect(s, &r, &hit));
        /* what has no material hides nothing */
        g_assert_cmpint(scene_occluded(s, &r), ==, materials[i] != NO_INDEX);
        g_assert_cmpint(hit.shape, ==, i);
        g_assert_cmpint(hit.material, ==, materials[i]);
        g_assert_cmpint(hit.light, ==, lights[i]);
        g_assert_cmpint(scene_bsdf(s, &hit, &w, ALL_WAVELENGTHS, &options, &b), ==,
                        materials[i] != NO_INDEX);
        spectrum out = scene_emitted(s, &hit, -r.direction, &w);
        g_assert_cmpint(!spectrum_is_black(out), ==, lights[i] != NO_INDEX);
        g_assert_true(spectrum_is_black(scene_emitted(s, &hit, r.direction, &w)));
    }
    ray away = {{0, -10, 0}, {0, -1, 0}, INFINITY, 0, {{0}, 0}};
    surface_hit hit;
    g_assert_false(scene_intersect(s, &away, &hit));
    g_assert_false(spectrum_is_black(sky_at(s, away.direction, &w)));
}

/* Samples carry the density that is told for a ray in their direction. */
static void test_sampling_agrees_with_density(void)
{
    g_autoptr(scene) s = make_scene(1);
    const wavelengths w = wavelengths_at(0.5f);
    const vec3 ref = vec3_make(0.3f, -4, 0.2f);
    unsigned seen[4] = {0};
    for (uint32_t i = 0; i < 4000; i++) {
        sampler random = sampler_make(3, i);
        vec2 u = sampler_2d(&random);
        float u_light = sampler_1d(&random);
        light_sample to;
        int index;
        if (!scene_sample_light(s, &w, ref, u_light, 0.5f, u, &index, &to))
            continue;
        seen[index]++;
        const light *l = scene_light(s, index);
        float choice = light_tree_probability(s->light_tree, ref, index);
        if (l->kind->is_delta) {
            g_assert_cmpfloat(fabsf(to.pdf / choice - 1), <, 1e-5);
            continue;
        }
        if (l->kind->is_environment) {
            g_assert_cmpfloat(
                fabsf(scene_light_pdf(s, index, ref, to.wi, NULL) / to.pdf - 1), <, 1e-5);
            continue;
        }
        ray r = {ref, to.wi, INFINITY, 0, {{0}, 0}};
        surface_hit hit;
        if (!scene_intersect(s, &r, &hit) || hit.light != index)
            continue; /* grazing */
        g_assert_cmpfloat(fabsf(scene_light_pdf(s, index, ref, to.wi, &hit) / to.pdf - 1),
                          <, 1e-4);
    }
    for (int i = 0; i < 4; i++)
        g_assert_cmpuint(seen[i], >, 50);
}

/* Many lights of all kinds: picks come as often as is told, and probabilities sum to one.
 */
static void test_light_tree(void)
{
    enum { LIGHTS = 40, DRAWS = 1 << 16 };
    light_bound bounds[LIGHTS];
    for (int i = 0; i < LIGHTS; i++) {
        sampler random = sampler_make(8, (uint64_t)i);
        vec3 p = vec3_make(sampler_1d(&random), sampler_1d(&random), sampler_1d(&random));
        bounds[i] = i % 7 == 3
                        ? (light_bound){.irradiance = 0.1f * sampler_1d(&random)}
                        : (light_bound){.is_local = true,
                                        .box = {p, p + 0.05f * sampler_1d(&random)},
                                        .power = sampler_1d(&random)};
    }
    light_tree *tree = light_tree_new(bounds, LIGHTS);
    const vec3 ref = vec3_make(0.2f, 0.7f, 0.4f);
    double sum = 0;
    unsigned seen[LIGHTS] = {0};
    for (uint32_t i = 0; i < DRAWS; i++) {
        float p;
        int k = light_tree_sample(tree, ref, ((float)i + 0.5f) / DRAWS, &p);
        g_assert_cmpfloat(fabsf(p / light_tree_probability(tree, ref, k) - 1), <, 1e-4f);
        seen[k]++;
    }
    for (int i = 0; i < LIGHTS; i++) {
        double p = (double)light_tree_probability(tree, ref, i);
        g_assert_cmpfloat(fabs(seen[i] / (double)DRAWS - p), <, 2e-4);
        sum += p;
    }
    g_assert_cmpfloat(fabs(sum - 1), <, 1e-5);
    light_tree_free(tree);
}

/* One unbiased sum over all lights is the sum of each light alone. */
static void test_one_light_for_all(void)
{
    g_autoptr(scene) s = make_scene(1);
    const wavelengths w = wavelengths_at(0.5f);
    const vec3 ref = vec3_make(0.3f, -4, 0.2f), n = vec3_make(0, 0, 1);
    enum { N = 1 << 16 };
    double chosen = 0, each = 0;
    for (uint32_t i = 0; i < N; i++) {
        sampler random = sampler_make(5, i);
        vec2 u = sampler_2d(&random);
        float u_light = sampler_1d(&random);
        light_sample to;
        int index;
        if (scene_sample_light(s, &w, ref, u_light, 0.5f, u, &index, &to))
            chosen +=
                (double)(spectrum_mean(to.radiance) * fmaxf(0, dot3(to.wi, n)) / to.pdf);
        for (int k = 0; k < 4; k++) {
            const light *l = scene_light(s, k);
            if (l->kind->sample(l->self, &w, ref, 0.5f, u, &to))
                each += (double)(spectrum_mean(to.radiance) * fmaxf(0, dot3(to.wi, n)) /
                                 to.pdf);
        }
    }
    g_assert_cmpfloat(fabs(chosen / each - 1), <, 0.02);
}

/* In millimetres instead of metres: same choice of lights, same irradiance. */
static void test_scale_by_thousand(void)
{
    g_autoptr(scene) small = make_scene(1);
    g_autoptr(scene) large = make_scene(1000);
    const wavelengths w = wavelengths_at(0.5f);
    const vec3 ref = vec3_make(0.3f, -4, 0.2f);
    for (size_t i = 0; i < 4; i++)
        g_assert_cmpfloat(fabsf(distribution_pdf(&small->light_power, i) /
                                    distribution_pdf(&large->light_power, i) -
                                1),
                          <, 1e-4);
    for (uint32_t i = 0; i < 1000; i++) {
        sampler random = sampler_make(7, i);
        vec2 u = sampler_2d(&random);
        float u_light = sampler_1d(&random);
        light_sample a, b;
        int k, l;
        bool found = scene_sample_light(small, &w, ref, u_light, 0.5f, u, &k, &a);
        g_assert_cmpint(
            found, ==,
            scene_sample_light(large, &w, 1000 * ref, u_light, 0.5f, u, &l, &b));
        if (!found || k != l) /* on the border of two */
            continue;
        float ratio =
            spectrum_mean(a.radiance) / a.pdf / spectrum_mean(b.radiance) * b.pdf;
        g_assert_cmpfloat(fabsf(ratio - 1), <, 1e-3);
        g_assert_cmpfloat(length3(a.wi - b.wi), <, 1e-3);
    }
}

static void expect_commit_error(scene_builder *b, const char *text)
{
    GError *error = NULL;
    g_assert_null(scene_builder_commit(b, 1, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_nonnull(strstr(error->message, text));
    g_error_free(error);
}

static void test_what_only_the_whole_can_tell(void)
{
    g_autoptr(scene_builder) b = scene_builder_new(NULL);
    expect_commit_error(b, "no camera");
    set_camera(b);
    add_light(b, "infinite", 1);
    g_autoptr(scene) s = commit(b); /* nothing but sky */
    g_assert_cmpfloat(s->radius, >, 0);
    g_autoptr(params) p = no_params();
    GError *error = NULL;
    transform identity = transform_identity();
    g_assert_false(builder_add_light(b, "point", p, &identity, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_USAGE);
    g_clear_error(&error);
    g_assert_null(scene_builder_commit(b, 1, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_USAGE);
    g_error_free(error);
}

static void test_names(void)
{
    g_autoptr(scene_builder) b = scene_builder_new(NULL);
    g_assert_cmpint(add_material(b, NULL, "diffuse"), ==, 0);
    g_assert_cmpint(add_material(b, "a", "diffuse"), ==, 1);
    g_assert_cmpint(builder_find_material(b, "a"), ==, 1);
    g_assert_cmpint(builder_find_material(b, "b"), ==, NO_INDEX);
    g_autoptr(params) p = no_params();
    GError *error = NULL;
    g_assert_cmpint(builder_add_material(b, "a", "diffuse", p, &error), ==, NO_INDEX);
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_clear_error(&error);
    shape_place at = {.to_world = transform_identity(), .material = 7};
    g_assert_false(builder_add_shape(b, "sphere", p, &at, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_clear_error(&error);
    g_autoptr(params) bad = one_number("scale", -1);
    at = (shape_place){.to_world = at.to_world, .material = 0, .area_light = bad};
    g_assert_false(builder_add_shape(b, "sphere", p, &at, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_cmpuint(b->scene->shapes->len + b->scene->lights->len, ==, 0);
    g_error_free(error);
}

/* ---- Film ---- */

static void add_integers(params *p, param_type type, const char *name, const int *values,
                         size_t n)
{
    params_add_integers(p, here, type, name, values, n, NULL);
}

static void test_film(void)
{
    g_autoptr(scene_builder) b = scene_builder_new(NULL);
    g_assert_cmpint(b->film.width, ==, 1280);
    g_assert_cmpint(b->film.height, ==, 720);
    g_autoptr(params) p = one_number("iso", 200);
    const int size[2] = {400, 300}, bounds[4] = {10, 399, 0, 17};
    const char *const name[1] = {"a.exr"};
    add_integers(p, PARAM_INTEGER, "xresolution", &size[0], 1);
    add_integers(p, PARAM_INTEGER, "yresolution", &size[1], 1);
    add_integers(p, PARAM_INTEGER, "pixelbounds", bounds, 4);
    params_add_strings(p, here, PARAM_STRING, "filename", name, 1, NULL);
    GError *error = NULL;
    g_assert_true(builder_set_film(b, "rgb", p, &error));
    g_assert_no_error(error);
    set_camera(b);
    g_assert_cmpint(b->camera.width, ==, 400);
    g_assert_cmpstr(b->film.filename, ==, "a.exr");
    for (int i = 0; i < 4; i++)
        g_assert_cmpint((int)ceilf(b->film.crop[i] * (float)size[i / 2]), ==, bounds[i]);
    g_autoptr(view) v = scene_builder_view(b, commit(b));
    g_assert_cmpfloat(fabsf(view_imaging_ratio(v) - 2), <, 1e-6);
    g_autoptr(view) other = view_share(v);
    view_resize(other, 40, 30);
    g_assert_cmpint(other->film.height, ==, 30);
    g_assert_cmpint(other->camera.height, ==, 30);
    g_assert_cmpint(v->film.height, ==, 300);
    g_assert_cmpstr(other->film.filename, ==, "a.exr");
}

static void expect_film_error(params *p, const char *kind, const char *text)
{
    g_autoptr(scene_builder) b = scene_builder_new(NULL);
    GError *error = NULL;
    g_assert_false(builder_set_film(b, kind, p, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_true(g_str_has_prefix(error->message, "shapes.pbrt:7:3: "));
    g_assert_nonnull(strstr(error->message, text));
    g_error_free(error);
    params_free(p);
}

static params *integers_of(const char *name, const int *values, size_t n)
{
    params *p = no_params();
    add_integers(p, PARAM_INTEGER, name, values, n);
    return p;
}

static void test_bad_film_is_named(void)
{
    const int sizes[3] = {0, 70000, -5}, bounds[4] = {5, 5, 0, 10};
    const float crop[4] = {0, 0.5f, 1.2f, 1.5f};
    const char *const sensor[1] = {"box_camera"};
    expect_film_error(integers_of("xresolution", &sizes[0], 1), "rgb", "xresolution");
    expect_film_error(integers_of("yresolution", &sizes[1], 1), "rgb", "yresolution");
    expect_film_error(integers_of("yresolution", &sizes[2], 1), "rgb", "yresolution");
    expect_film_error(integers_of("pixelbounds", bounds, 4), "rgb", "pixelbounds");
    expect_film_error(integers_of("pixelbounds", bounds, 3), "rgb", "pixelbounds");
    params *p = no_params();
    params_add_numbers(p, here, PARAM_FLOAT, "cropwindow", crop, 4, NULL);
    expect_film_error(p, "rgb", "cropwindow");
    p = no_params();
    params_add_strings(p, here, PARAM_STRING, "sensor", sensor, 1, NULL);
    expect_film_error(p, "rgb", "box_camera");
    expect_film_error(one_number("iso", 0), "rgb", "iso");
    expect_film_error(one_number("whitebalance", 500), "rgb", "whitebalance");
    expect_film_error(one_number("maxcomponentvalue", 0), "rgb", "maxcomponentvalue");
    expect_film_error(one_number("exposuretime", 1), "rgb", "exposuretime");
    expect_film_error(no_params(), "glass", "glass");
}

static void test_memory_refused(void)
{
    for (unsigned n = 1;; n++) {
        g_autoptr(scene_builder) b = scene_builder_new(NULL);
        set_camera(b);
        add_ball(b, (const float[3]){0, 0, 0}, 1, NO_INDEX, 1);
        GError *error = NULL;
        big_alloc_fail_at(n);
        g_autoptr(scene) s = scene_builder_commit(b, 1, &error);
        big_alloc_fail_at(0);
        if (s) {
            g_assert_cmpuint(n, >, 4);
            return;
        }
        g_assert_error(error, NEPH_ERROR, ERROR_FAILED);
        g_error_free(error);
        s = commit(b); /* a second attempt goes through */
    }
}

/* Half a pixel's width at the hit; none for rays that do not come from the eye. */
static void test_footprint(void)
{
    g_autoptr(view) v = view_of(
        "Camera \"perspective\" \"float fov\" 90 Film \"rgb\" \"integer xresolution\" 64 "
        "\"integer yresolution\" 64 WorldBegin LightSource \"point\" Translate 0 0 4 "
        "Shape \"disk\" \"float radius\" 9");
    surface_hit hit;
    for (int size = 64; size <= 128; size *= 2) {
        view_resize(v, size, size);
        ray r = camera_ray(&v->camera, (vec2){32, 32}, (vec2){0.5f, 0.5f}, 0.5f);
        g_assert_true(view_see(v, &r, &hit));
        g_assert_cmpfloat(fabsf(hit.footprint / (hit.t / (float)size) - 1), <, 0.01f);
        g_assert_true(scene_intersect(v->scene, &r, &hit));
        g_assert_cmpfloat(hit.footprint, <=, 0);
    }
    /* By a lens of half the angle half as wide. */
    const motion path = v->camera.path;
    v->camera.half_screen *= 0.5f;
    camera_resize(&v->camera, 128, 128);
    view_place_camera(v, &path);
    ray r = camera_ray(&v->camera, (vec2){64, 64}, (vec2){0.5f, 0.5f}, 0.5f);
    g_assert_true(view_see(v, &r, &hit));
    g_assert_cmpfloat(fabsf(hit.footprint / (hit.t / 256) - 1), <, 0.01f);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/scene/commit", test_commit_finds_the_world);
    g_test_add_func("/scene/hits", test_hits_know_material_and_light);
    g_test_add_func("/scene/lights/density", test_sampling_agrees_with_density);
    g_test_add_func("/scene/lights/tree", test_light_tree);
    g_test_add_func("/scene/lights/sum", test_one_light_for_all);
    g_test_add_func("/scene/footprint", test_footprint);
    g_test_add_func("/scene/scale", test_scale_by_thousand);
    g_test_add_func("/scene/refused", test_what_only_the_whole_can_tell);
    g_test_add_func("/scene/names", test_names);
    g_test_add_func("/scene/film", test_film);
    g_test_add_func("/scene/film/bad", test_bad_film_is_named);
    g_test_add_func("/scene/memory", test_memory_refused);
    return g_test_run();
}
