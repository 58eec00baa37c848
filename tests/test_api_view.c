/*
 * What a window on a scene asks of the installed header: the view as a value that goes
 * there and back, rays and places of the picture, and a view saved in its scene file.
 */
#include "nephroid/nephroid.h"

#include <glib/gstdio.h>
#include <math.h>
#include <string.h>

static char *folder;

static const char world[] =
    "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 16\n"
    "Integrator \"photonmap\" \"integer passes\" 1 \"integer photons\" 3000\n"
    "    \"string caustic_emission\" \"uniform\"\n"
    "WorldBegin\n"
    "LightSource \"point\" \"rgb I\" [10 10 10] \"point3 from\" [0 1.8 0]\n"
    "MakeNamedMaterial \"walls\" \"string type\" \"diffuse\"\n"
    "    \"rgb reflectance\" [0.7 0.5 0.3]\n"
    "MakeNamedMaterial \"glass\" \"string type\" \"dielectric\"\n"
    "NamedMaterial \"walls\"\n"
    "Shape \"sphere\" \"float radius\" 3\n"
    "NamedMaterial \"glass\"\n"
    "Shape \"sphere\" \"float radius\" 0.4\n";

static char *write_scene(const char *name, const char *head)
{
    char *path = g_build_filename(folder, name, NULL);
    g_autofree char *text = g_strconcat(head, world, NULL);
    g_assert_true(g_file_set_contents(path, text, -1, NULL));
    return path;
}

static NephScene *load(const char *path)
{
    g_autoptr(GError) error = NULL;
    NephScene *scene = neph_scene_load(path, 1, NULL, NULL, &error);
    g_assert_no_error(error);
    return scene;
}

static NephScene *make_scene(const char *head)
{
    g_autofree char *path = write_scene("scene.pbrt", head);
    return load(path);
}

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
    NephCamera before, after, bad[5];
    neph_scene_camera(scene, &before);
    for (size_t i = 0; i < G_N_ELEMENTS(bad); i++)
        bad[i] = elsewhere;
    bad[0].position[1] = (double)NAN;
    memset(bad[1].direction, 0, sizeof bad[1].direction);
    memcpy(bad[2].up, bad[2].direction, sizeof bad[2].up);
    bad[3].fov = 180.0;
    bad[4].focal_distance = 0.0;
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
} heard;

static bool hear(double fraction, const NephStatistics *statistics, void *data)
{
    (void)fraction;
    heard *h = data;
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
    heard h = {render, 0.0};
    g_assert_true(isinf(neph_render_noise(render)));
    g_assert_true(neph_render_run(render, hear, &h, NULL));
    NephStatistics statistics;
    neph_render_statistics(render, &statistics);
    g_assert_cmpfloat_with_epsilon(h.noise, statistics.noise, 1e-12);
}

static void test_bounds(void)
{
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    double low[3], high[3];
    g_assert_true(neph_scene_bounds(scene, low, high));
    assert_near(low, (const double[]){-3, -3, -3}, 3, 1e-5);
    assert_near(high, (const double[]){3, 3, 3}, 3, 1e-5);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder = g_dir_make_tmp("nephroid-api-view-XXXXXX", NULL);
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
    int result = g_test_run();
    static const char *const files[] = {"scene.pbrt", "saved.pbrt", "none.pbrt"};
    for (size_t i = 0; i < G_N_ELEMENTS(files); i++) {
        g_autofree char *path = g_build_filename(folder, files[i], NULL);
        g_remove(path);
    }
    g_rmdir(folder);
    g_free(folder);
    return result;
}
