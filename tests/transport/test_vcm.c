/*
 * Vertex connection and merging: weights against their definition, strategies against one
 * another and against path tracing and photon mapping.
 *
 * Statistical tests are deterministic by their seeds; tolerances are at least five
 * standard deviations of what they compare.
 */
#include "rooms.h"
#include "transport/vcm/vcm.h"

/* ---- Weights against their definition ---- */

enum { MAX_SURFACES = 6 };

/* A path from a light to the eye, made of random numbers: the identities hold for any. */
typedef struct random_path {
    int n; /* surfaces 1..n; 0 is on the light, n + 1 the eye */
    double distance2[MAX_SURFACES + 2];                           /* from i - 1 to i */
    double cos_lamp[MAX_SURFACES + 2], cos_eye[MAX_SURFACES + 2]; /* at i, to i -+ 1 */
    double pdf[MAX_SURFACES + 2], reverse[MAX_SURFACES + 2]; /* from lamp, from eye */
    bool mirror[MAX_SURFACES + 2];
    double alone[MAX_SURFACES + 2];
    double eye; /* camera samples per solid angle over light subpaths */
    light_start start;
    strategy_ratios ratios;
} random_path;

static double between(GRand *random, double low, double high)
{
    return low * pow(high / low, g_rand_double(random));
}

static random_path path_of(GRand *random, const scene *s, int index, bool mirrors)
{
    random_path p = {.n = g_rand_int_range(random, 1, MAX_SURFACES + 1)};
    for (int i = 1; i <= p.n + 1; i++) {
        p.distance2[i] = between(random, 0.1, 10);
        p.cos_lamp[i] = between(random, 0.1, 1);
        p.cos_eye[i] = between(random, 0.1, 1);
        p.pdf[i] = between(random, 0.01, 10);
        p.reverse[i] = between(random, 0.01, 10);
        p.mirror[i] = mirrors && g_rand_double(random) < 0.4;
        if (p.mirror[i])
            p.reverse[i] = p.pdf[i];
        p.alone[i] = i < p.n ? between(random, 1e-4, 1) : 1;
    }
    p.eye = between(random, 0.01, 100);
    double merge = between(random, 0.01, 100);
    p.ratios = (strategy_ratios){(float)merge, (float)(1 / merge)};
    vec3 n = vec3_make(0, 0, -1), d = normalize3(vec3_make(0.3f, 0.4f, -1));
    p.start = (light_start){.light = scene_light(s, index),
                            .p_traced = (float)between(random, 0.1, 1),
                            .p = vec3_make(0, 0, 1),
                            .n = n,
                            .direction = d,
                            .distance2 = (float)p.distance2[1],
                            .pdf = (float)between(random, 0.1, 10),
                            .cosine = (float)p.cos_lamp[1]};
    return p;
}

/* Densities of all strategies by their definition. connect[s]: s vertices from the light;
   merge[m]: both subpaths end at surface m. */
typedef struct path_densities {
    double connect[MAX_SURFACES + 2], merge[MAX_SURFACES + 2], sum;
} path_densities;

static path_densities define(const random_path *p)
{
    float position, direction;
    const light_start *start = &p->start;
    const light_kind *kind = start->light->kind;
    kind->emit_pdf(start->light->self, start->p, start->n, start->direction, &position,
                   &direction);
    double cos0 = (double)fabsf(dot3(start->n, start->direction));
    double to_area = kind->is_parallel ? 1 : 1 / p->distance2[1];
    /* By solid angle at surface 1, or what stands for it, to the measure of vertex 0. */
    double to_light = kind->is_parallel || kind->is_delta ? 1 : cos0 / p->distance2[1];
    double lamp[MAX_SURFACES + 2], eye[MAX_SURFACES + 3];
    lamp[1] = (double)(start->p_traced * position * direction) * p->cos_lamp[1] * to_area;
    for (int i = 2; i <= p->n; i++)
        lamp[i] = lamp[i - 1] * p->pdf[i - 1] * p->cos_lamp[i] / p->distance2[i];
    eye[p->n + 1] = 1;
    eye[p->n] = p->eye * p->cos_eye[p->n] / p->distance2[p->n + 1];
    for (int i = p->n - 1; i >= 1; i--)
        eye[i] = eye[i + 1] * p->reverse[i + 1] * p->cos_eye[i] / p->distance2[i + 1];
    path_densities d = {0};
    d.connect[0] = kind->is_delta ? 0 : eye[1] * p->reverse[1] * to_light;
    if (!p->mirror[1])
        d.connect[1] = eye[1] * (double)start->pdf * to_light;
    for (int s = 2; s <= p->n + 1; s++) {
        if (!p->mirror[s - 1] && (s == p->n + 1 || !p->mirror[s]))
            d.connect[s] = lamp[s - 1] * eye[s];
    }
    for (int m = 1; m <= p->n; m++) {
        if (!p->mirror[m])
            d.merge[m] = lamp[m] * eye[m] * (double)p->ratios.merge * p->alone[m];
    }
    for (int i = 0; i <= p->n + 1; i++)
        d.sum += d.connect[i] + d.merge[i];
    return d;
}

static void bounce_at(partial_weights *w, const random_path *p, int i, bool from_lamp)
{
    double cosine = from_lamp ? p->cos_eye[i] : p->cos_lamp[i];
    if (p->mirror[i])
        weights_bounce_specular(w, (float)cosine);
    else
        weights_bounce(w, (float)cosine, (float)(from_lamp ? p->pdf[i] : p->reverse[i]),
                       (float)(from_lamp ? p->reverse[i] : p->pdf[i]), &p->ratios,
                       (float)p->alone[i]);
}

/* The partial weights of a light subpath at each surface. */
static void weights_of_lamp(const random_path *p, partial_weights out[])
{
    partial_weights w = weights_from_light(&p->start, &p->ratios);
    for (int i = 1; i <= p->n; i++) {
        if (i > 1)
            weights_arrive(&w, (float)p->distance2[i], (float)p->cos_lamp[i]);
        out[i] = w;
        bounce_at(&w, p, i, true);
    }
}

/* ... and of a camera subpath; out[0] is on its way to the light. */
static void weights_of_eye(const random_path *p, partial_weights out[])
{
    partial_weights w = {.vcm = (float)(1 / p->eye)};
    for (int i = p->n; i >= 1; i--) {
        weights_arrive(&w, (float)p->distance2[i + 1], (float)p->cos_eye[i]);
        out[i] = w;
        bounce_at(&w, p, i, false);
    }
    out[0] = w;
}

static double met(const random_path *p, partial_weights w)
{
    float position, direction, connected = p->start.pdf;
    const light_start *start = &p->start;
    const light *l = start->light;
    l->kind->emit_pdf(l->self, start->p, start->n, start->direction, &position,
                      &direction);
    if (!l->kind->is_parallel) {
        float cos0 = fabsf(dot3(start->n, start->direction));
        weights_arrive(&w, start->distance2, cos0);
        connected *= cos0 / start->distance2;
    }
    return (double)weights_met(&w, connected, start->p_traced * position * direction);
}

/* The weight of s light vertices connected to the rest. */
static double connected(const random_path *p, const partial_weights lamp[],
                        const partial_weights eye[], int s)
{
    if (s == 0)
        return met(p, eye[0]);
    if (s == 1) {
        bool delta = p->start.light->kind->is_delta;
        double others = delta ? 0 : p->reverse[1] / (double)p->start.pdf;
        float traced = light_start_traced_over_connected(&p->start);
        return 1 / (1 + others +
                    (double)weights_connected(&eye[1], traced, (float)p->pdf[1],
                                              &p->ratios, (float)p->alone[1]));
    }
    bool to_eye = s == p->n + 1;
    double d2 = p->distance2[s];
    double area = (to_eye ? p->eye : p->reverse[s]) * p->cos_eye[s - 1] / d2;
    double sum =
        1 + (double)weights_connected(&lamp[s - 1], (float)area, (float)p->reverse[s - 1],
                                      &p->ratios, (float)p->alone[s - 1]);
    if (!to_eye)
        sum += (double)weights_connected(
            &eye[s], (float)(p->pdf[s - 1] * p->cos_lamp[s] / d2), (float)p->pdf[s],
            &p->ratios, (float)p->alone[s]);
    return 1 / sum;
}

static double merged(const random_path *p, const partial_weights lamp[],
                     const partial_weights eye[], int m)
{
    float alone = (float)p->alone[m];
    float a = weights_merged(&lamp[m], (float)p->reverse[m], &p->ratios, alone);
    float b = weights_merged(&eye[m], (float)p->pdf[m], &p->ratios, alone);
    return (double)(1 / (a + 1 + b));
}

static void check_weights(const random_path *p)
{
    partial_weights lamp[MAX_SURFACES + 2], eye[MAX_SURFACES + 2];
    path_densities d = define(p);
    weights_of_lamp(p, lamp);
    weights_of_eye(p, eye);
    double sum = 0;
    for (int s = 0; s <= p->n + 1; s++) {
        if (!(d.connect[s] > 0))
            continue;
        double w = connected(p, lamp, eye, s);
        sum += w;
        g_assert_cmpfloat(fabs(w - d.connect[s] / d.sum), <, 1e-5);
    }
    for (int m = 1; m <= p->n; m++) {
        if (!(d.merge[m] > 0))
            continue;
        double w = merged(p, lamp, eye, m);
        sum += w;
        g_assert_cmpfloat(fabs(w - d.merge[m] / d.sum), <, 1e-5);
    }
    if (d.sum > 0)
        g_assert_cmpfloat(fabs(sum - 1), <, 1e-4);
}

#define EVERY_LIGHT                                                                      \
    "Camera \"perspective\"\n" SIZE(                                                     \
        4) "WorldBegin LightSource \"point\" LightSource "                               \
           "\"spot\" \"float coneangle\" 90 \"point3 to\" [0 0 -1] LightSource "         \
           "\"distant\" LightSource \"infinite\" AreaLightSource \"diffuse\" \"bool "    \
           "twosided\" true Shape \"sphere\"\n"

static void test_weights_follow_their_definition(void)
{
    g_autoptr(scene) s = scene_of(EVERY_LIGHT);
    GRand *random = g_rand_new_with_seed(1);
    for (int i = 0; i < 20000; i++) {
        random_path p = path_of(random, s, i % (int)s->lights->len, i % 2 == 1);
        check_weights(&p);
    }
    g_rand_free(random);
}

/* ---- The camera's other direction ---- */

static void test_camera_is_connected_as_its_rays_go(void)
{
    g_autoptr(view) v = view_of(
        "Scale -2 2 2 LookAt 1 2 3  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 50 "
        "\"float lensradius\" 0.2 \"float focaldistance\" 3\n"
        "Film \"rgb\" \"integer xresolution\" 20 \"integer yresolution\" 10\n"
        "WorldBegin LightSource \"point\"");
    GRand *random = g_rand_new_with_seed(2);
    for (int i = 0; i < 1000; i++) {
        vec2 u = {(float)g_rand_double(random), (float)g_rand_double(random)};
        vec2 raster = {20.0f * (float)g_rand_double(random),
                       10.0f * (float)g_rand_double(random)};
        ray r = camera_ray(&v->camera, raster, u, 0.0f);
        camera_connection found;
        g_assert_true(
            camera_connect(&v->camera, r.origin + 5.0f * r.direction, u, 0.0f, &found));
        g_assert_cmpfloat(fabsf(found.raster.x - raster.x), <, 1e-3f);
        g_assert_cmpfloat(fabsf(found.raster.y - raster.y), <, 1e-3f);
        g_assert_cmpfloat(fabsf(found.distance - 5.0f), <, 1e-4f);
        const float h = 0.05f;
        vec3 dx = camera_ray(&v->camera, (vec2){raster.x + h, raster.y}, u, 0).direction -
                  camera_ray(&v->camera, (vec2){raster.x - h, raster.y}, u, 0).direction;
        vec3 dy = camera_ray(&v->camera, (vec2){raster.x, raster.y + h}, u, 0).direction -
                  camera_ray(&v->camera, (vec2){raster.x, raster.y - h}, u, 0).direction;
        float solid_angle = length3(cross3(dx, dy)) / (4.0f * h * h);
        g_assert_cmpfloat(fabsf(found.pdf * solid_angle - 1.0f), <, 2e-3f);
    }
    g_rand_free(random);
}

/* ---- Against path tracing ---- */

static void check_agreement(const view *v, const char *words, double expected,
                            double tolerance)
{
    g_autofree char *all =
        g_strconcat("integrator=vcm max_backward_bounces=-1 ", words, NULL);
    g_autoptr(image) img = render_with(v, all);
    double found = mean_of(img, "");
    g_test_message("%s: %g, expected %g (%+.2f %%)", words, found, expected,
                   100 * (found / expected - 1));
    g_assert_cmpfloat(fabs(found / expected - 1.0), <, tolerance);
}

static double path_mean(const view *v, const char *words)
{
    g_autofree char *all =
        g_strconcat("integrator=path max_backward_bounces=-1 ", words, NULL);
    g_autoptr(image) img = render_with(v, all);
    return mean_of(img, "");
}

static void test_furnace(gconstpointer words)
{
    g_autoptr(view) v = view_of(FURNACE);
    check_agreement(v, words, 2.0, 1e-3);
}

/* Plastic has a specular coat, which the light strategy does not see, over a base. */
static void test_strategies_agree(void)
{
    g_autofree char *text = g_strconcat(ROOM, furnishings[7].text, NULL);
    g_autoptr(view) v = view_of(text);
    double expected = path_mean(v, "passes=16 spp=32 seed=1");
    check_agreement(v, "vcm_strategies=bpt passes=16 spp=4 photons=4096", expected,
                    0.006);
    check_agreement(v, "vcm_strategies=bpm passes=8 spp=4 photons=8192", expected, 0.006);
    check_agreement(v, "vcm_strategies=ppm passes=8 spp=4 photons=8192", expected, 0.006);
    g_autoptr(view) empty = view_of(ROOM);
    expected = path_mean(empty, "passes=16 spp=32 seed=1");
    check_agreement(empty, "vcm_strategies=light passes=8 spp=8 photons=20000", expected,
                    0.006);
}

/* ---- Lights, lenses and filters ---- */

/* A floor, a wall, two balls, one of them in an interface, which light must not see. */
#define STAGE                                                                            \
    "WorldBegin Material \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.5]\n"                \
    "Shape \"trianglemesh\" \"point3 P\" [-4 -2 0 4 -2 0 4 4 0 -4 4 0] \"integer "       \
    "indices\" [0 1 2 0 2 3]\n"                                                          \
    "Shape \"trianglemesh\" \"point3 P\" [-4 2 0 4 2 0 4 2 3 -4 2 3] \"integer "         \
    "indices\" [0 1 2 0 2 3] Shape \"sphere\" \"float radius\" 0.5\n"                    \
    "AttributeBegin Translate 1 0 0.7 Material \"conductor\" \"float roughness\" 0.3 "   \
    "Shape \"sphere\" \"float radius\" 0.4 AttributeEnd\n"                               \
    "AttributeBegin Translate 0 -0.5 0.5 Material \"interface\" Shape \"sphere\" "       \
    "\"float radius\" 0.9 AttributeEnd\n"
#define EYE                                                                              \
    "LookAt 0 -3.4 1.2  0 0 0.9  0 0 1 Camera \"perspective\" \"float fov\" 55 "         \
    "\"float lensradius\" 0.1 \"float focaldistance\" 3\n" SIZE(12)

typedef struct lighting {
    const char *name, *text;
} lighting;

static const lighting lightings[] = {
    {"point", "LightSource \"point\" \"rgb I\" [2 2 2] \"point3 from\" [-1 -2 2]"},
    {"spot", "LightSource \"spot\" \"rgb I\" [9 9 9] \"point3 from\" [1 -1 3] \"point3 "
             "to\" [0 1 0] \"float coneangle\" 40 \"float conedeltaangle\" 15"},
    {"distant", "LightSource \"distant\" \"point3 from\" [1 -1 2]"},
    {"infinite", "LightSource \"infinite\""},
    {"sphere", "AreaLightSource \"diffuse\" \"rgb L\" [9 9 9] Translate -1 -1 2 Shape "
               "\"sphere\" \"float radius\" 0.3"},
    {"unseen", "AreaLightSource \"diffuse\" \"rgb L\" [9 9 9] Translate -1 -1 2 Shape "
               "\"sphere\" \"float radius\" 0.3 \"float alpha\" 0"},
    {"hidden-shape",
     "LightSource \"point\" \"rgb I\" [2 2 2] \"point3 from\" [-1 -2 2] Translate 0.3 "
     "-1.5 0.9 "
     "Shape \"sphere\" \"float radius\" 0.4 \"bool camera_visible\" false"},
    {"many", "LightSource \"infinite\" \"rgb L\" [0.2 0.2 0.4] LightSource \"distant\" "
             "\"point3 from\" [1 -1 2] LightSource \"point\" \"point3 from\" [-1 -2 2] "
             "AreaLightSource \"diffuse\" \"rgb L\" [9 9 9] \"bool twosided\" true "
             "Translate -1 -1 2 Shape \"disk\" \"float radius\" 0.3"},
};

static void test_lights(gconstpointer data)
{
    const lighting *l = data;
    g_autofree char *text = g_strconcat(EYE, STAGE, l->text, NULL);
    g_autoptr(view) v = view_of(text);
    double expected = path_mean(v, "passes=16 spp=64 seed=1");
    check_agreement(v, "passes=16 spp=16 photons=8192 radius=0.05", expected, 0.008);
    check_agreement(v, "vcm_strategies=bpt passes=16 spp=16 photons=8192", expected,
                    0.008);
}

/* Two skies: whichever of them a path meets, it is weighed against its own. */
static void test_two_skies_are_one(void)
{
    g_autoptr(view) two =
        view_of(EYE STAGE "LightSource \"infinite\" \"rgb L\" [1 0.5 0.5] "
                          "LightSource \"infinite\" \"rgb L\" [0.5 1 1]");
    g_autoptr(view) one =
        view_of(EYE STAGE "LightSource \"infinite\" \"rgb L\" [1.5 1.5 1.5]");
    double expected = path_mean(one, "passes=16 spp=64 seed=1");
    check_agreement(two, "passes=16 spp=16 photons=8192 radius=0.05", expected, 0.008);
    double path = path_mean(two, "passes=16 spp=64 seed=1");
    g_test_message("path: %g, expected %g", path, expected);
    g_assert_cmpfloat(fabs(path / expected - 1), <, 0.008);
}

static void test_splats_follow_the_filter(void)
{
    static const char *const filters[] = {
        "\"gaussian\"", "\"mitchell\"",
        "\"triangle\" \"float xradius\" 1.5 \"float yradius\" 0.8"};
    for (size_t i = 0; i < G_N_ELEMENTS(filters); i++) {
        g_autofree char *text = g_strconcat(
            "LookAt 0 0 2  0 0 0  0 1 0 PixelFilter ", filters[i],
            " Film \"rgb\" \"integer xresolution\" 9 \"integer yresolution\" 7 \"float "
            "cropwindow\" [0.2 0.9 0 0.8] Camera \"perspective\" WorldBegin LightSource "
            "\"point\" \"point3 from\" [0.5 0 0.4] Shape \"disk\" \"float radius\" 9",
            NULL);
        g_autoptr(view) v = view_of(text);
        g_autoptr(image) rays = render_with(v, "integrator=path passes=16 spp=64 seed=1");
        g_autoptr(image) splats = render_with(
            v, "integrator=vcm vcm_strategies=light passes=16 spp=1 photons=20000");
        image_difference d;
        g_assert_true(image_compare(splats, rays, &d, NULL));
        g_test_message("%s: %g and %g, relMSE %g", filters[i], d.mean_a, d.mean_b,
                       d.relmse);
        g_assert_cmpfloat(fabs(d.mean_a / d.mean_b - 1), <, 0.005);
        g_assert_cmpfloat(d.relmse, <, 1e-3);
    }
}

/* A coarse ball that pretends to be round: light subpaths carry the adjoint of what
   camera subpaths see. */
static void test_shading_normals(void)
{
    g_autoptr(view) v = view_of(
        ROOM
        "Translate 0 0 0.8 Shape \"trianglemesh\" \"point3 P\" [1 0 0 0 1 0 -1 0 0 "
        "0 -1 0 0 0 0.8 0 0 -0.8] \"normal N\" [1 0 0 0 1 0 -1 0 0 0 -1 0 0 0 1 0 0 "
        "-1] \"integer indices\" [0 1 4 1 2 4 2 3 4 3 0 4 1 0 5 2 1 5 3 2 5 0 3 5]\n");
    double expected = path_mean(v, "passes=16 spp=32 seed=1");
    check_agreement(v, "vcm_strategies=bpt passes=16 spp=8 photons=8192", expected,
                    0.006);
    /* merging mixes the facets along the edges: a small radius keeps that below the noise
     */
    check_agreement(v, "vcm_strategies=bpm passes=16 spp=4 photons=20000 radius=0.03",
                    expected, 0.015);
    check_agreement(v, "vcm_strategies=light passes=8 spp=8 photons=20000", expected,
                    0.006);
}

/* ---- What paths do not find ---- */

static void test_point_light_through_glass(void)
{
    g_autoptr(view) v = view_of(
        "LookAt 0 -4 2  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 40\n" SIZE(
            12) "WorldBegin LightSource \"point\" \"rgb I\" [5 5 5] \"point3 from\" [0 0 "
                "3] Shape \"disk\" \"float radius\" 4 Material \"dielectric\" Translate "
                "0 "
                "0 0.8 Shape \"sphere\" \"float radius\" 0.5");
    g_autoptr(image) photons =
        render_with(v, "passes=32 spp=32 photons=50000 max_backward_bounces=-1");
    g_autoptr(image) vcm = render_with(v, "integrator=vcm passes=64 spp=4 photons=16384");
    double a = mean_of(vcm, ""), b = mean_of(photons, "");
    double found = mean_of(vcm, "caustic"), caustic = mean_of(photons, "caustic");
    g_test_message("vcm %g, photons %g; caustic %g and %g", a, b, found, caustic);
    g_assert_cmpfloat(fabs(a / b - 1), <, 0.008);
    g_assert_cmpfloat(fabs(found / caustic - 1), <, 0.03);
}

/* ---- Layers, bits, pixels ---- */

static void test_layers_agree_with_path_tracing(void)
{
    g_autofree char *text = g_strconcat(ROOM, furnishings[4].text, NULL);
    g_autoptr(view) v = view_of(text);
    g_autoptr(image) path =
        render_with(v, "integrator=path passes=16 spp=32 max_backward_bounces=-1");
    g_autoptr(image) vcm = render_with(v, "integrator=vcm passes=16 spp=8 photons=8192");
    const char *const names[] = {"direct",   "indirect", "caustic",
                                 "specular", "emission", "albedo"};
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        double a = mean_of(vcm, names[i]), b = mean_of(path, names[i]);
        g_test_message("%s: vcm %g, path %g", names[i], a, b);
        g_assert_cmpfloat(fabs(a - b), <, 0.006 * mean_of(path, ""));
    }
}

static void test_same_bits_on_any_number_of_threads(void)
{
    g_autofree char *text = g_strconcat(ROOM, furnishings[3].text, NULL);
    g_autoptr(view) v = view_of(text);
    g_autoptr(image) one =
        render_with(v, "integrator=vcm passes=2 spp=2 photons=5000 threads=1");
    g_autoptr(image) two =
        render_with(v, "integrator=vcm passes=2 spp=2 photons=5000 threads=2");
    assert_same_bits(one, two);
}

/* Light subpaths of a pass. */
static uint64_t light_paths_with(const view *v, const char *words)
{
    g_autoptr(render) r = render_of(v, words);
    g_assert_true(render_run(r, NULL, NULL, NULL));
    return render_get_statistics(r).emitted[PHOTON_INDIRECT];
}

static void test_as_many_paths_from_lamps_as_from_the_eye(void)
{
    g_autofree char *text = g_strconcat(ROOM, furnishings[3].text, NULL);
    g_autoptr(view) v = view_of(text);
    uint64_t pixels = (uint64_t)v->film.width * (uint64_t)v->film.height;
    g_assert_cmpuint(light_paths_with(v, "integrator=vcm passes=1 spp=2"), ==,
                     2 * pixels);
    g_assert_cmpuint(light_paths_with(v, "integrator=vcm passes=1 photons=777"), ==, 777);
    g_assert_cmpuint(
        light_paths_with(v, "integrator=vcm passes=1 spp=1 vcm_strategies=light"), ==,
        400000);
}

enum { N_RENDERS = 24 };

/* Adds N_RENDERS independent renders' green to sum and squares, pixel by pixel. */
static size_t sum_pixels(const view *s, const char *words, int seed, double *sum,
                         double *squares)
{
    size_t n = 0;
    for (int i = 0; i < N_RENDERS; i++) {
        g_autofree char *all = g_strdup_printf("%s seed=%d", words, seed + i);
        g_autoptr(image) img = render_with(s, all);
        int green = image_channel(img, "G");
        n = (size_t)img->width * (size_t)img->height;
        for (size_t k = 0; k < n; k++) {
            double v = (double)img->pixels[k * (size_t)img->n_channels + (size_t)green];
            sum[k] += v;
            squares[k] += v * v;
        }
    }
    return n;
}

/* Without merging vcm has no bias, so every pixel agrees. |z| > 8 at some 45 degrees of
   freedom has p < 1e-9, for 256 pixels below 1e-6. */
static void test_every_pixel_agrees(void)
{
    enum { N = 256 };
    double a[N] = {0}, a2[N] = {0}, b[N] = {0}, b2[N] = {0}, worst = 0, square_sum = 0;
    g_autofree char *text = g_strconcat(ROOM, furnishings[5].text, NULL);
    g_autoptr(view) v = view_of(text);
    size_t n =
        sum_pixels(v, "integrator=path passes=2 spp=8 max_backward_bounces=3", 0, a, a2);
    sum_pixels(v,
               "integrator=vcm vcm_strategies=bpt passes=2 spp=4 photons=1024 "
               "max_backward_bounces=3",
               N_RENDERS, b, b2);
    g_assert_cmpuint(n, ==, N);
    for (size_t i = 0; i < n; i++) {
        double ma = a[i] / N_RENDERS, mb = b[i] / N_RENDERS;
        double variance = a2[i] / N_RENDERS - ma * ma + b2[i] / N_RENDERS - mb * mb;
        double z = (ma - mb) / sqrt(variance / (N_RENDERS - 1));
        worst = fmax(worst, fabs(z));
        square_sum += z * z;
    }
    g_test_message("largest |z| %g, mean z² %g", worst, square_sum / N);
    g_assert_cmpfloat(worst, <, 8.0);
    g_assert_cmpfloat(square_sum / N, <, 1.6);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/vcm/weights", test_weights_follow_their_definition);
    g_test_add_func("/vcm/camera", test_camera_is_connected_as_its_rays_go);
    g_test_add_data_func("/vcm/furnace/all", "passes=32 spp=32 photons=16384",
                         test_furnace);
    g_test_add_data_func("/vcm/furnace/bpt",
                         "vcm_strategies=bpt passes=32 spp=32 photons=16384",
                         test_furnace);
    for (size_t i = 0; i < G_N_ELEMENTS(lightings); i++) {
        g_autofree char *name = g_strdup_printf("/vcm/lights/%s", lightings[i].name);
        g_test_add_data_func(name, &lightings[i], test_lights);
    }
    g_test_add_func("/vcm/lights/two-skies", test_two_skies_are_one);
    g_test_add_func("/vcm/strategies", test_strategies_agree);
    g_test_add_func("/vcm/shading-normals", test_shading_normals);
    g_test_add_func("/vcm/filters", test_splats_follow_the_filter);
    g_test_add_func("/vcm/caustic", test_point_light_through_glass);
    g_test_add_func("/vcm/layers", test_layers_agree_with_path_tracing);
    g_test_add_func("/vcm/light-paths", test_as_many_paths_from_lamps_as_from_the_eye);
    g_test_add_func("/vcm/threads", test_same_bits_on_any_number_of_threads);
    g_test_add_func("/vcm/pixels", test_every_pixel_agrees);
    return g_test_run();
}
