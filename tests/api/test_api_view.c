/*
 * What a window on a scene asks of the installed header: the view as a value that goes
 * there and back, rays and places of the picture, and a view saved in its scene file.
 */
#include "api_scene.h"

static void assert_near(const double *a, const double *b, int n, double epsilon)
{
    for (int i = 0; i < n; i++)
        g_assert_cmpfloat_with_epsilon(a[i], b[i], epsilon);
}

static void assert_same_view(const NephCamera *a, const NephCamera *b)
{
    assert_near(a->position, b->position, 3, 1e-5);
    assert_near(a->direction, b->direction, 3, 1e-5);
    assert_near(a->up, b->up, 3, 1e-5);
    assert_near(&a->fov, &b->fov, 1, 1e-4);
    assert_near(a->screen, b->screen, 4, 1e-5);
    g_assert_true(a->mirrored == b->mirrored);
    g_assert_cmpfloat_with_epsilon(a->lens_radius, b->lens_radius, 1e-6);
    if (a->lens_radius > 0.0)
        g_assert_cmpfloat_with_epsilon(a->focal_distance, b->focal_distance, 1e-5);
}

/* ---- The view ---- */

static void test_camera_read(void)
{
    g_autoptr(NephScene) scene = make_scene(
        "LookAt 1 2 -4  1 2 5  0 1 0\nCamera \"perspective\" \"float fov\" 60\n");
    NephCamera c;
    neph_scene_camera(scene, &c);
    assert_near(c.position, (const double[]){1, 2, -4}, 3, 1e-6);
    assert_near(c.direction, (const double[]){0, 0, 1}, 3, 1e-6);
    assert_near(c.up, (const double[]){0, 1, 0}, 3, 1e-6);
    g_assert_cmpfloat_with_epsilon(c.fov, 60.0, 1e-4);
    double side = tan(G_PI / 6.0);
    assert_near(c.screen, (const double[]){-2 * side, 2 * side, -side, side}, 4, 1e-6);
    g_assert_false(c.mirrored);
}

/* A Scale before LookAt mirrors, or makes camera lengths shorter. */
static void test_camera_scaled(void)
{
    g_autoptr(NephScene) mirrored =
        make_scene("Scale -1 1 1\nLookAt 0 0 -2  0 0 0  0 1 0\nCamera \"perspective\"\n");
    NephCamera c;
    neph_scene_camera(mirrored, &c);
    g_assert_true(c.mirrored);
    assert_near(c.up, (const double[]){0, 1, 0}, 3, 1e-6);
    g_autoptr(NephScene) scaled = make_scene(
        "Scale 2 2 2\nLookAt 0 0 -2  0 0 0  0 1 0\n"
        "Camera \"perspective\" \"float lensradius\" 0.2 \"float focaldistance\" 3\n");
    neph_scene_camera(scaled, &c);
    g_assert_cmpfloat_with_epsilon(c.focal_distance, 1.5, 1e-6);
    g_assert_cmpfloat_with_epsilon(c.lens_radius, 0.1, 1e-6);
}

static const NephCamera elsewhere = {
    .position = {0.5, 0.25, -1.5},
    .direction = {0.2, -0.1, 0.9},
    .up = {0.1, 1.0, 0.0},
    .fov = 35.0,
    .lens_radius = 0.01,
    .focal_distance = 1.25,
};

static void test_camera_set(void)
{
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    g_autoptr(GError) error = NULL;
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        NephCamera wanted = elsewhere, once, twice;
        wanted.mirrored = mirrored;
        g_assert_true(neph_scene_set_camera(scene, &wanted, &error));
        neph_scene_camera(scene, &once);
        g_assert_true(neph_scene_set_camera(scene, &once, &error));
        neph_scene_camera(scene, &twice);
        assert_same_view(&once, &twice);
        assert_near(once.position, elsewhere.position, 3, 1e-6);
        double length = sqrt(0.04 + 0.01 + 0.81);
        g_assert_cmpfloat_with_epsilon(once.direction[2], 0.9 / length, 1e-6);
    }
}

static void test_camera_refused(void)
{
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    NephCamera before, after, bad[8];
    neph_scene_camera(scene, &before);
    for (size_t i = 0; i < G_N_ELEMENTS(bad); i++)
        bad[i] = elsewhere;
    bad[0].position[1] = (double)NAN;
    memset(bad[1].direction, 0, sizeof bad[1].direction);
    memcpy(bad[2].up, bad[2].direction, sizeof bad[2].up);
    bad[3].fov = 180.0;
    bad[4].focal_distance = 0.0;
    bad[5].lens_radius = -0.01;
    bad[6].lens_radius = (double)INFINITY;
    bad[7].lens_radius = (double)NAN;
    for (size_t i = 0; i < G_N_ELEMENTS(bad); i++) {
        g_autoptr(GError) error = NULL;
        g_assert_false(neph_scene_set_camera(scene, &bad[i], &error));
        g_assert_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_USAGE);
        neph_scene_camera(scene, &after);
        assert_same_view(&before, &after);
    }
}

/* A ray through a place of the picture meets only points that project to that place. */
static void test_camera_rays(void)
{
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    for (int k = 0; k < 20; k++) {
        NephCamera c = elsewhere;
        c.mirrored = k % 2;
        g_assert_true(neph_scene_set_camera(scene, &c, NULL));
        neph_scene_camera(scene, &c);
        double x = 0.05 * k, y = 1.0 - 0.03 * k, back[2], origin[3], direction[3], p[3];
        neph_camera_ray(&c, x, y, origin, direction);
        for (int i = 0; i < 3; i++)
            p[i] = origin[i] + 3.0 * direction[i];
        g_assert_true(neph_camera_project(&c, p, &back[0], &back[1]));
        assert_near(back, (const double[]){x, y}, 2, 1e-9);
        for (int i = 0; i < 3; i++)
            p[i] = origin[i] - 3.0 * direction[i];
        g_assert_false(neph_camera_project(&c, p, &back[0], &back[1]));
    }
}

static void test_camera_fov(void)
{
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    NephCamera changed, again;
    neph_scene_camera(scene, &changed);
    neph_camera_set_fov(&changed, 20.0);
    g_assert_true(neph_scene_set_camera(scene, &changed, NULL));
    neph_scene_camera(scene, &again);
    assert_same_view(&changed, &again);
}

/* ---- Into a file ---- */

static void test_camera_text(void)
{
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
        NephCamera wanted = elsewhere, found;
        wanted.mirrored = mirrored;
        g_assert_true(neph_scene_set_camera(scene, &wanted, NULL));
        neph_scene_camera(scene, &wanted);
        g_autofree char *text = neph_camera_text(&wanted);
        g_autoptr(NephScene) again = make_scene(text);
        neph_scene_camera(again, &found);
        assert_same_view(&wanted, &found);
    }
}

static void test_camera_saved(void)
{
    g_autofree char *path =
        write_scene("saved.pbrt",
                    "# a Camera in a comment\nScale 3 3 3\nLookAt 0 0 -2  0 0 0  0 1 0\n"
                    "Camera \"perspective\" \"float fov\" [ 40 ] # Camera\n");
    NephCamera wanted = elsewhere, found;
    for (int k = 0; k < 2; k++) {
        g_autoptr(NephScene) scene = load(path);
        wanted.position[0] = k;
        g_assert_true(neph_scene_set_camera(scene, &wanted, NULL));
        neph_scene_camera(scene, &wanted);
        g_autoptr(GError) error = NULL;
        g_assert_true(neph_camera_save(&wanted, path, &error));
        g_autoptr(NephScene) again = load(path);
        neph_scene_camera(again, &found);
        assert_same_view(&wanted, &found);
    }
    g_autofree char *text = NULL;
    g_assert_true(g_file_get_contents(path, &text, NULL, NULL));
    g_assert_nonnull(strstr(text, "# a Camera in a comment\nScale 3 3 3\n"));
    g_assert_nonnull(strstr(text, " # Camera\n"));
    char *mark = strstr(text, "# saved view");
    g_assert_nonnull(mark);
    g_assert_null(strstr(mark + 1, "# saved view"));
}

static void test_camera_save_refused(void)
{
    g_autofree char *path = g_build_filename(folder, "none.pbrt", NULL);
    g_autoptr(GError) missing = NULL, pointless = NULL;
    g_assert_false(neph_camera_save(&elsewhere, path, &missing));
    g_assert_error(missing, NEPH_ERROR_DOMAIN, NEPH_ERROR_INPUT);
    g_assert_true(g_file_set_contents(path, "WorldBegin\n", -1, NULL));
    g_assert_false(neph_camera_save(&elsewhere, path, &pointless));
    g_assert_error(pointless, NEPH_ERROR_DOMAIN, NEPH_ERROR_INPUT);
}

/* ---- Noise while rendering ---- */

typedef struct heard {
    NephRender *render;
    double noise;
    int n_early; /* looks before the first pass was done */
} heard;

/* Before a pass is done there may be a coarse picture: light everywhere. */
static void look_early(heard *h)
{
    g_autoptr(NephImage) image = neph_render_image(h->render, NULL);
    g_assert_nonnull(image);
    int width, height, n;
    neph_image_size(image, &width, &height, &n);
    const float *pixel = neph_image_pixels(image);
    int lit = 0;
    for (int i = 0; i < width * height; i++, pixel += n)
        lit += pixel[0] + pixel[1] + pixel[2] > 0.0f;
    g_assert_cmpint(lit, >, 9 * width * height / 10);
    h->n_early++;
}

static bool hear(double fraction, const NephStatistics *statistics, void *data)
{
    (void)fraction;
    heard *h = data;
    g_assert_true(statistics->passes == 0 || statistics->can_look);
    if (statistics->passes == 0 && statistics->can_look)
        look_early(h);
    if (statistics->passes > 1)
        h->noise = neph_render_noise(h->render);
    return true;
}

static void test_noise(void)
{
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    g_autoptr(NephSettings) settings = neph_scene_settings(scene);
    neph_settings_set(settings, "passes", "3", NULL);
    g_autoptr(NephRender) render = neph_render_new(scene, settings, NULL);
    heard h = {render, 0.0, 0};
    g_assert_true(isinf(neph_render_noise(render)));
    g_assert_true(neph_render_run(render, hear, &h, NULL));
    NephStatistics statistics;
    neph_render_statistics(render, &statistics);
    g_assert_cmpfloat_with_epsilon(h.noise, statistics.noise, 1e-12);
    g_assert_cmpint(h.n_early, ==, 3);
}

static void test_bounds(void)
{
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    double low[3], high[3];
    g_assert_true(neph_scene_bounds(scene, low, high));
    assert_near(low, (const double[]){-3, -3, -3}, 3, 1e-5);
    assert_near(high, (const double[]){3, 3, 3}, 3, 1e-5);
}

/* ---- Surfaces ---- */

static void test_pick(void)
{
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    const double origin[3] = {0, 0, -2}, ahead[3] = {0, 0, 1}, up[3] = {0, 1, 0};
    NephSurfacePoint at;
    g_assert_true(neph_scene_pick(scene, origin, ahead, &at));
    g_assert_cmpfloat_with_epsilon(at.distance, 1.6, 1e-5);
    assert_near(at.position, (const double[]){0, 0, -0.4}, 3, 1e-5);
    assert_near(at.normal, (const double[]){0, 0, -1}, 3, 1e-5);
    g_assert_cmpstr(at.material_name, ==, "glass");
    g_assert_cmpstr(at.shape_kind, ==, "sphere");
    g_assert_nonnull(strstr(at.file, "scene.pbrt"));
    g_assert_cmpint(at.line, ==, 13);
    g_assert_true(neph_scene_pick(scene, origin, up, &at));
    g_assert_cmpstr(at.material_name, ==, "walls");
    const double far_away[3] = {0, 9, 0};
    g_assert_false(neph_scene_pick(scene, far_away, up, &at));
}

static const char cube[] =
    "Camera \"perspective\"\n"
    "WorldBegin\nLightSource \"point\"\nShape \"trianglemesh\"\n"
    "\"point3 P\" [0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1]\n"
    "\"integer indices\" [0 1 2 0 2 3 4 6 5 4 7 6 0 4 5 0 5 1\n"
    " 1 5 6 1 6 2 2 6 7 2 7 3 3 7 4 3 4 0]\n";

/* A cube has twelve edges; the diagonals of its sides are none. */
static void test_wireframe(void)
{
    g_autofree char *path = g_build_filename(folder, "scene.pbrt", NULL);
    g_assert_true(g_file_set_contents(path, cube, -1, NULL));
    g_autoptr(NephScene) box = load(path);
    size_t n;
    g_autofree float *edges = neph_scene_wireframe(box, 1000, &n);
    g_assert_cmpuint(n, ==, 12);
    for (size_t i = 0; i < n; i++) {
        const float *e = edges + 6 * i;
        float length = fabsf(e[0] - e[3]) + fabsf(e[1] - e[4]) + fabsf(e[2] - e[5]);
        g_assert_cmpfloat_with_epsilon(length, 1.0f, 1e-6f);
    }
    g_autofree float *few = neph_scene_wireframe(box, 4, &n);
    g_assert_nonnull(few);
    g_assert_cmpuint(n, >, 0);
    g_assert_cmpuint(n, <=, 4);
    g_assert_nonnull(few);
    g_autoptr(NephScene) balls = make_scene("Camera \"perspective\"\n");
    g_autofree float *lines = neph_scene_wireframe(balls, 100000, &n);
    g_assert_cmpuint(n, >, 100);
    for (size_t i = 0; i < n; i++) {
        const float *e = lines + 6 * i;
        float r = sqrtf(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
        g_assert_true(fabsf(r - 3.0f) < 1e-3f || fabsf(r - 0.4f) < 1e-3f);
    }
}

/* Of a mesh of many triangles, with little memory: nothing, or nothing of the mesh. */
static void test_wireframe_out_of_memory(void)
{
    enum { SIDE = 200, MOST = 1000000 };
    g_autoptr(GString) text = g_string_new(
        "Camera \"perspective\"\nWorldBegin\nShape \"trianglemesh\" \"point3 P\" [");
    for (int i = 0; i < SIDE * SIDE; i++)
        g_string_append_printf(text, "%d %d %d ", i % SIDE, i / SIDE, i * 7919 % 100);
    g_string_append(text, "] \"integer indices\" [");
    for (int i = 0; i + SIDE + 1 < SIDE * SIDE; i++)
        g_string_append_printf(text, "%d %d %d ", i, i + 1, i + SIDE);
    g_string_append(text, "]\n");
    g_autofree char *path = g_build_filename(folder, "scene.pbrt", NULL);
    g_assert_true(g_file_set_contents(path, text->str, -1, NULL));
    g_autoptr(NephScene) mesh = load(path);
    size_t n;
    g_free(neph_scene_wireframe(mesh, MOST, &n));
    g_assert_cmpuint(n, ==, 3 * (SIDE * SIDE - SIDE - 1));
    g_assert_true(neph_memory_set_limit("1M", NULL));
    g_assert_null(neph_scene_wireframe(mesh, MOST, &n));
    g_assert_cmpuint(n, ==, 0);
    g_autofree float *few = neph_scene_wireframe(mesh, 10, &n);
    g_assert_nonnull(few);
    g_assert_cmpuint(n, ==, 0);
    g_assert_true(neph_memory_set_limit(NULL, NULL));
}

/* Two instances of a cube have twice its edges, where they stand. */
static void test_wireframe_instances(void)
{
    g_autofree char *path = g_build_filename(folder, "scene.pbrt", NULL);
    g_auto(GStrv) parts = g_strsplit(cube, "Shape", 2);
    g_autofree char *text = g_strconcat(
        parts[0], "ObjectBegin \"one\"\nShape", parts[1],
        "ObjectEnd\nObjectInstance \"one\"\nTranslate 5 0 0\nObjectInstance \"one\"\n",
        NULL);
    g_assert_true(g_file_set_contents(path, text, -1, NULL));
    g_autoptr(NephScene) boxes = load(path);
    size_t n, moved = 0;
    g_autofree float *edges = neph_scene_wireframe(boxes, 1000, &n);
    g_assert_cmpuint(n, ==, 24);
    for (size_t i = 0; i < n; i++)
        moved += edges[6 * i] > 4.0f;
    g_assert_cmpuint(moved, ==, 12);
}

/* Parallel rays, and what they meet is seen where they start. */
static void test_camera_orthographic(void)
{
    g_autoptr(NephScene) scene =
        make_scene("LookAt 0 0 -2  0 0 0  0 1 0\n"
                   "Camera \"orthographic\" \"float screenwindow\" [-2 2 -1 1]\n");
    NephCamera c;
    double origin[3], direction[3], x, y, p[3];
    neph_scene_camera(scene, &c);
    g_assert_cmpstr(c.kind, ==, "orthographic");
    neph_camera_ray(&c, 0.75, 0.25, origin, direction);
    assert_near(origin, (const double[]){1, 0.5, -2}, 3, 1e-6);
    assert_near(direction, (const double[]){0, 0, 1}, 3, 1e-9);
    for (int i = 0; i < 3; i++)
        p[i] = origin[i] + 7.0 * direction[i];
    g_assert_true(neph_camera_project(&c, p, &x, &y));
    g_assert_cmpfloat_with_epsilon(x, 0.75, 1e-6);
    g_assert_cmpfloat_with_epsilon(y, 0.25, 1e-6);
    c.position[0] = 1.0;
    g_assert_true(neph_scene_set_camera(scene, &c, NULL));
    g_autofree char *text = neph_camera_text(&c);
    g_assert_null(strstr(text, "Camera"));
}

/* ---- Diagrams ---- */

static size_t find_material(const NephScene *scene, const char *name)
{
    size_t i = 0;
    while (g_strcmp0(neph_scene_material_name(scene, i), name) != 0)
        g_assert_cmpuint(i++, <, neph_scene_n_materials(scene));
    return i;
}

/* A Lambertian surface is rho / pi in every direction above it, and nothing below. */
static void test_bsdf_diffuse(void)
{
    static const double rho[3] = {0.7, 0.5, 0.3};
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    size_t i = find_material(scene, "walls");
    g_assert_cmpstr(neph_scene_material_kind(scene, i), ==, "diffuse");
    g_autoptr(NephBsdfPlot) plot = neph_bsdf_plot(scene, i, 30.0, 360, NULL);
    for (size_t k = 0; k < 360; k++)
        for (int c = 0; c < 3; c++) {
            double expected = k < 90 || k > 270 ? rho[c] / G_PI : 0.0;
            if (k != 90 && k != 270)
                g_assert_cmpfloat_with_epsilon((double)plot->rgb[3 * k + (size_t)c],
                                               expected, 0.02);
        }
    g_assert_cmpuint(plot->n_rays, ==, 0);
}

/* Glass mirrors at the same angle, refracts by Snell, and keeps all light. */
static void test_bsdf_glass(void)
{
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    g_autoptr(NephBsdfPlot) plot =
        neph_bsdf_plot(scene, find_material(scene, "glass"), 45.0, 90, NULL);
    g_assert_cmpuint(plot->n_rays, ==, 2);
    g_assert_cmpfloat_with_epsilon(plot->rays[0].angle, 45.0, 0.01);
    double refracted = 180.0 - asin(sqrt(0.5) / 1.5) * 180.0 / G_PI;
    g_assert_cmpfloat_with_epsilon(plot->rays[1].angle, refracted, 0.01);
    for (int c = 0; c < 3; c++)
        g_assert_cmpfloat_with_epsilon(plot->rays[0].rgb[c] + plot->rays[1].rgb[c], 1.0f,
                                       0.03f);
}

static void test_bsdf_refused(void)
{
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    g_assert_null(neph_bsdf_plot(scene, 99, 30.0, 90, NULL));
    g_assert_null(neph_bsdf_plot(scene, 0, 91.0, 90, NULL));
    g_assert_null(neph_bsdf_plot(scene, 0, 30.0, 2, NULL));
    g_assert_null(neph_scene_material_name(scene, 99));
}

static void test_bsdf_svg(void)
{
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    for (size_t i = 0; i < neph_scene_n_materials(scene); i++) {
        g_autoptr(NephBsdfPlot) plot = neph_bsdf_plot(scene, i, 30.0, 90, NULL);
        g_autofree char *svg = neph_bsdf_plot_svg(plot, "a <b> & c");
        const GMarkupParser nothing = {0};
        g_autoptr(GMarkupParseContext) parser =
            g_markup_parse_context_new(&nothing, 0, NULL, NULL);
        g_assert_true(g_markup_parse_context_parse(parser, svg, -1, NULL));
        g_assert_true(g_markup_parse_context_end_parse(parser, NULL));
        g_assert_nonnull(strstr(svg, "a &lt;b&gt; &amp; c"));
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    open_folder();
    g_test_add_func("/api-view/camera/read", test_camera_read);
    g_test_add_func("/api-view/camera/scaled", test_camera_scaled);
    g_test_add_func("/api-view/camera/set", test_camera_set);
    g_test_add_func("/api-view/camera/refused", test_camera_refused);
    g_test_add_func("/api-view/camera/rays", test_camera_rays);
    g_test_add_func("/api-view/camera/fov", test_camera_fov);
    g_test_add_func("/api-view/camera/text", test_camera_text);
    g_test_add_func("/api-view/camera/saved", test_camera_saved);
    g_test_add_func("/api-view/camera/save-refused", test_camera_save_refused);
    g_test_add_func("/api-view/noise", test_noise);
    g_test_add_func("/api-view/bounds", test_bounds);
    g_test_add_func("/api-view/pick", test_pick);
    g_test_add_func("/api-view/wireframe", test_wireframe);
    g_test_add_func("/api-view/wireframe-out-of-memory", test_wireframe_out_of_memory);
    g_test_add_func("/api-view/wireframe-instances", test_wireframe_instances);
    g_test_add_func("/api-view/camera/orthographic", test_camera_orthographic);
    g_test_add_func("/api-view/bsdf/diffuse", test_bsdf_diffuse);
    g_test_add_func("/api-view/bsdf/glass", test_bsdf_glass);
    g_test_add_func("/api-view/bsdf/refused", test_bsdf_refused);
    g_test_add_func("/api-view/bsdf/svg", test_bsdf_svg);
    int result = g_test_run();
    remove_folder();
    return result;
}
