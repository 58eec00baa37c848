/*
 * The installed header from the caller's side: settings round trip, errors are values
 * with codes, and a render lives through run, stop, statistics and images.
 */
#include "base/memory.h"
#include "json_check.h"
#include "nephroid/nephroid.h"

#include <glib/gstdio.h>
#include <locale.h>
#include <math.h>
#include <string.h>

static char *folder, *scene_file;

static const char scene_text[] =
    "LookAt 0 0 -2  0 0 0  0 1 0\n"
    "Camera \"perspective\" \"float fov\" 50\n"
    "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 12\n"
    "    \"string filename\" \"wanted.exr\"\n"
    "Integrator \"photonmap\" \"integer passes\" 3 \"integer photons\" 2000\n"
    "    \"integer spp\" 1 \"string caustic_emission\" \"uniform\"\n"
    "WorldBegin\n"
    "LightSource \"point\" \"rgb I\" [10 10 10] \"point3 from\" [0 1.8 0]\n"
    "Material \"diffuse\" \"rgb reflectance\" [0.7 0.5 0.3]\n"
    "Shape \"sphere\" \"float radius\" 3\n"
    "Material \"dielectric\"\n"
    "Shape \"sphere\" \"float radius\" 0.4\n";

static NephScene *load(void)
{
    g_autoptr(GError) error = NULL;
    NephScene *scene = neph_scene_load(scene_file, 1, NULL, NULL, &error);
    g_assert_no_error(error);
    return scene;
}

/* ---- Settings ---- */

static void test_settings_round_trip(void)
{
    size_t n;
    const NephSettingInfo *rows = neph_settings_table(&n);
    g_assert_true(rows == neph_settings_table(&n));
    NephSettings *from = neph_settings_new(), *to = neph_settings_new();
    for (size_t i = 0; i < n; i++) {
        g_autofree char *initial = neph_settings_get(from, rows[i].name);
        const bool has_words = rows[i].type == NEPH_SETTING_CHOICE;
        g_autofree char *high = g_strdup_printf("%.17g", rows[i].high);
        g_assert_true(neph_settings_set(to, rows[i].name,
                                        has_words ? rows[i].words[0] : high, NULL));
        g_assert_true(neph_settings_set(to, rows[i].name, initial, NULL));
        g_autofree char *back = neph_settings_get(to, rows[i].name);
        g_assert_cmpstr(initial, ==, back);
    }
    neph_settings_set(from, "passes", "7", NULL);
    NephSettings *copy = neph_settings_copy(from);
    g_autofree char *passes = neph_settings_get(copy, "passes");
    g_assert_cmpstr(passes, ==, "7");
    neph_settings_free(copy);
    neph_settings_free(from);
    neph_settings_free(to);
    neph_settings_free(NULL);
}

static void test_settings_refuse(void)
{
    NephSettings *s = neph_settings_new();
    g_autoptr(GError) unknown = NULL;
    g_assert_false(neph_settings_set(s, "pases", "3", &unknown));
    g_assert_error(unknown, NEPH_ERROR_DOMAIN, NEPH_ERROR_USAGE);
    g_assert_nonnull(strstr(unknown->message, "passes"));
    g_assert_null(neph_settings_get(s, "pases"));
    g_autoptr(GError) missing = NULL;
    g_assert_false(neph_settings_load(s, "/nowhere.ini", &missing));
    g_assert_error(missing, NEPH_ERROR_DOMAIN, NEPH_ERROR_INPUT);
    neph_settings_free(s);
}

static void test_settings_described(void)
{
    g_autofree char *json = neph_settings_describe(true);
    g_autofree char *text = neph_settings_describe(false);
    g_assert_true(json_is_valid(json));
    size_t n;
    const NephSettingInfo *rows = neph_settings_table(&n);
    for (size_t i = 0; i < n; i++) {
        g_assert_nonnull(strstr(json, rows[i].name));
        g_assert_nonnull(strstr(text, rows[i].doc));
    }
}

/* ---- Statistics ---- */

static void test_statistics_text(void)
{
    const NephStatistics s = {.passes = 3,
                              .time_total = 1.5,
                              .time_trace = (double)NAN,
                              .stored = {1, 2, 3},
                              .emitted = {10, 20, UINT64_MAX},
                              .radius = {0.0, 0.25, 1e-9},
                              .memory_peak = 1 << 20,
                              .n_not_finite = 4};
    setlocale(LC_NUMERIC, "de_DE.UTF-8");
    g_autofree char *json = neph_statistics_text(&s, true);
    setlocale(LC_NUMERIC, "C");
    g_autofree char *table = neph_statistics_text(&s, false);
    g_assert_true(json_is_valid(json));
    g_assert_cmpfloat(json_find_number(json, "passes"), ==, 3.0);
    g_assert_cmpfloat(json_find_number(json, "total"), ==, 1.5);
    g_assert_cmpfloat(json_find_number(json, "not_finite"), ==, 4.0);
    g_assert_nonnull(strstr(json, "\"trace\": null"));
    g_assert_nonnull(strstr(json, "18446744073709551615"));
    g_assert_nonnull(strstr(table, "4 samples that were not finite"));
}

/* ---- Scenes ---- */

static void count_line(NephLogLevel level, const char *text, void *data)
{
    (void)level;
    g_test_message("%s", text);
    ++*(int *)data;
}

static void test_scene(void)
{
    NephScene *scene = load();
    int width, height;
    neph_scene_size(scene, &width, &height);
    g_assert_cmpint(width, ==, 16);
    g_assert_cmpint(height, ==, 12);
    g_assert_true(g_str_has_suffix(neph_scene_output(scene), "wanted.exr"));
    g_autoptr(GError) error = NULL;
    g_assert_false(neph_scene_resize(scene, 0, 5, &error));
    g_assert_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_USAGE);
    g_assert_true(neph_scene_resize(scene, 8, 4, NULL));
    neph_scene_size(scene, &width, &height);
    g_assert_cmpint(width * height, ==, 32);
    NephSettings *settings = neph_scene_settings(scene);
    g_autofree char *passes = neph_settings_get(settings, "passes");
    g_assert_cmpstr(passes, ==, "3");
    neph_settings_free(settings);
    g_autofree char *json = neph_scene_describe(scene, true);
    g_test_message("%s", json);
    g_assert_true(json_is_valid(json));
    g_assert_cmpfloat(json_find_number(json, "casting_caustics"), ==, 0.0);
    g_autofree char *text = neph_scene_describe(scene, false);
    g_assert_nonnull(strstr(text, "passes         3"));
    neph_scene_free(scene);
    neph_scene_free(NULL);
}

static void test_scene_errors(void)
{
    int n_lines = 0;
    g_autoptr(GError) missing = NULL;
    g_assert_null(neph_scene_load("/nowhere.pbrt", 1, count_line, &n_lines, &missing));
    g_assert_error(missing, NEPH_ERROR_DOMAIN, NEPH_ERROR_INPUT);
    g_autofree char *path = g_build_filename(folder, "bad.pbrt", NULL);
    g_file_set_contents(path, "WorldBegin\nShape \"blob\"\nShape \"blub\"\n", -1, NULL);
    g_autoptr(GError) bad = NULL;
    g_assert_null(neph_scene_load(path, 1, count_line, &n_lines, &bad));
    g_assert_error(bad, NEPH_ERROR_DOMAIN, NEPH_ERROR_INPUT);
    g_assert_nonnull(strstr(bad->message, "bad.pbrt:2:"));
    g_assert_nonnull(strstr(bad->message, "bad.pbrt:3:"));
    g_remove(path);
}

/* A point light of 10 W/sr, of which rgb(10, 10, 10) has the luminance: its power must
 * not depend on how it is asked for. */
static void test_described_power_scales(void)
{
    double power[2];
    for (int i = 0; i < 2; i++) {
        g_autofree char *path = g_build_filename(folder, "light.pbrt", NULL);
        g_autofree char *text = g_strdup_printf(
            "Camera \"perspective\"\nWorldBegin\n"
            "LightSource \"point\" \"rgb I\" [%d %d %d]\nShape \"sphere\"\n",
            1 + i, 1 + i, 1 + i);
        g_file_set_contents(path, text, -1, NULL);
        NephScene *scene = neph_scene_load(path, 1, NULL, NULL, NULL);
        g_autofree char *json = neph_scene_describe(scene, true);
        power[i] = json_find_number(json, "power");
        neph_scene_free(scene);
        g_remove(path);
    }
    g_assert_cmpfloat(power[0], >, 0.0);
    g_assert_cmpfloat_with_epsilon(power[1] / power[0], 2.0, 1e-5);
}

/* ---- Rendering ---- */

static NephRender *begin(const NephScene *scene, GError **error)
{
    NephSettings *settings = neph_scene_settings(scene);
    neph_settings_set(settings, "threads", "2", NULL);
    NephRender *render = neph_render_new(scene, settings, error);
    neph_settings_free(settings);
    return render;
}

typedef struct watch {
    double last;
    unsigned n_calls;
    int64_t stop_after; /* passes; 0: never */
    NephRender *render;
    NephImage *picture;
} watch;

static bool look(double fraction, const NephStatistics *statistics, void *data)
{
    watch *w = data;
    g_assert_cmpfloat(fraction, >=, w->last);
    g_assert_cmpfloat(fraction, <=, 1.0);
    w->last = fraction;
    w->n_calls++;
    return !w->stop_after || statistics->passes < w->stop_after;
}

static void test_render_lives(void)
{
    NephScene *scene = load();
    g_autoptr(GError) error = NULL;
    NephRender *render = begin(scene, &error);
    g_assert_no_error(error);
    watch w = {0};
    g_assert_true(neph_render_run(render, look, &w, &error));
    g_assert_cmpuint(w.n_calls, >=, 3);
    NephStatistics s;
    neph_render_statistics(render, &s);
    g_assert_cmpint(s.passes, ==, 3);
    g_assert_cmpfloat(s.time_total, >, 0.0);
    g_assert_cmpuint(s.camera_rays, >, 0);
    g_assert_cmpuint(s.emitted[NEPH_PHOTON_CAUSTIC], >, 0);
    g_assert_cmpuint(s.n_not_finite, ==, 0);
    NephImage *image = neph_render_image(render, &error);
    int width, height, n_channels;
    neph_image_size(image, &width, &height, &n_channels);
    g_assert_cmpint(width, ==, 16);
    g_assert_cmpstr(neph_image_channel_name(image, 0), ==, "R");
    g_assert_null(neph_image_channel_name(image, n_channels));
    double sum = 0.0;
    for (int i = 0; i < width * height; i++)
        sum += (double)neph_image_pixels(image)[i * n_channels];
    g_assert_cmpfloat(sum, >, 0.0);
    neph_image_free(image);
    neph_render_free(render);
    neph_scene_free(scene);
}

static void test_render_stops(void)
{
    NephScene *scene = load();
    NephRender *render = begin(scene, NULL);
    watch w = {.stop_after = 1};
    g_autoptr(GError) error = NULL;
    g_assert_false(neph_render_run(render, look, &w, &error));
    g_assert_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_CANCELLED);
    NephStatistics s;
    neph_render_statistics(render, &s);
    g_assert_cmpint(s.passes, >=, 1);
    g_assert_cmpint(s.passes, <, 3);
    NephImage *image = neph_render_image(render, NULL);
    g_assert_nonnull(image);
    neph_image_free(image);
    neph_render_free(render);
    neph_scene_free(scene);
}

/* Keeps the picture after two passes. */
static bool keep_picture(double fraction, const NephStatistics *statistics, void *data)
{
    (void)fraction;
    watch *w = data;
    if (statistics->passes == 2 && !w->picture)
        w->picture = neph_render_image(w->render, NULL);
    return true;
}

/* After so many of three passes, noise being taken out in such windows; how it looked
   after two in under_way. */
static NephImage *picture_after(const char *passes, const char *windows,
                                NephImage **under_way)
{
    g_autoptr(NephScene) scene = load();
    g_autoptr(NephSettings) settings = neph_scene_settings(scene);
    g_assert_true(neph_settings_set(settings, "planned_passes", "3", NULL));
    g_assert_true(neph_settings_set(settings, "passes", passes, NULL));
    g_assert_true(neph_settings_set(settings, "denoise_windows", windows, NULL));
    g_autoptr(NephRender) render = neph_render_new(scene, settings, NULL);
    watch w = {.render = render};
    g_assert_true(neph_render_run(render, keep_picture, &w, NULL));
    g_assert_nonnull(w.picture);
    if (under_way)
        *under_way = w.picture;
    else
        neph_image_free(w.picture);
    return neph_render_image(render, NULL);
}

static bool are_same(const NephImage *a, const NephImage *b)
{
    int width, height, n;
    neph_image_size(a, &width, &height, &n);
    size_t size = (size_t)(width * height * n) * sizeof(float);
    return memcmp(neph_image_pixels(a), neph_image_pixels(b), size) == 0;
}

/* Noise is taken out in fewer windows of a render under way, unless it is asked how. */
static void test_render_under_way(void)
{
    g_autoptr(NephImage) early = NULL, early_fine = NULL;
    g_autoptr(NephImage) whole = picture_after("3", "auto", &early);
    g_autoptr(NephImage) whole_fine = picture_after("3", "fine", &early_fine);
    g_autoptr(NephImage) coarse = picture_after("2", "coarse", NULL);
    g_autoptr(NephImage) fine = picture_after("2", "fine", NULL);
    g_assert_false(are_same(coarse, fine));
    g_assert_true(are_same(early, coarse));
    g_assert_true(are_same(early_fine, fine));
    g_assert_true(are_same(whole, whole_fine));
}

/* Whether a render with the n-th big allocation refused ends well. */
static bool render_refused_at(unsigned n, const NephScene *scene,
                              const NephSettings *settings, GError **error)
{
    big_alloc_fail_at(n);
    NephRender *render = neph_render_new(scene, settings, error);
    bool done = render && neph_render_run(render, NULL, NULL, error);
    big_alloc_fail_at(0);
    neph_render_free(render);
    return done;
}

/* For n = 1, 2, 3 …, until there is nothing left to refuse: an error of the right kind,
 * and never a crash. */
static void test_render_survives_refusals(void)
{
    NephScene *scene = load();
    NephSettings *settings = neph_scene_settings(scene);
    neph_settings_set(settings, "passes", "1", NULL);
    neph_settings_set(settings, "threads", "1", NULL);
    unsigned n = 0;
    for (bool done = false; !done && n < 500; n++) {
        g_autoptr(GError) error = NULL;
        done = render_refused_at(n + 1, scene, settings, &error);
        g_assert_true(done == !error);
        if (error)
            g_assert_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_FAILED);
    }
    g_test_message("%u refusals", n - 1);
    g_assert_cmpuint(n, >, 5);
    g_assert_cmpuint(n, <, 500);
    neph_settings_free(settings);
    neph_scene_free(scene);
}

/* ---- Images and files ---- */

static void test_images(void)
{
    g_autoptr(GError) missing = NULL;
    g_assert_null(neph_image_read("/nowhere.exr", &missing));
    g_assert_error(missing, NEPH_ERROR_DOMAIN, NEPH_ERROR_INPUT);
    g_assert_false(neph_image_can_write("/nowhere/x.exr", NULL));
    NephImageDifference d = {.rmse = 0.5, .psnr = (double)INFINITY};
    g_autofree char *json = neph_image_difference_text(&d, true);
    g_autofree char *text = neph_image_difference_text(&d, false);
    g_assert_true(json_is_valid(json));
    g_assert_nonnull(strstr(json, "\"psnr\": null"));
    g_assert_nonnull(strstr(text, "rmse            0.5"));
    neph_image_free(NULL);
}

/* ---- Photons ---- */

static void keep_line(const char *line, void *data)
{
    g_ptr_array_add(data, g_strdup(line));
}

static void test_photons(void)
{
    NephScene *scene = load();
    NephSettings *settings = neph_scene_settings(scene);
    g_autoptr(GError) error = NULL;
    NephPhotons *photons = neph_photons_trace(scene, settings, &error);
    g_assert_no_error(error);
    NephStatistics s;
    neph_photons_statistics(photons, &s);
    size_t n = neph_photons_count(photons);
    g_assert_cmpuint(n, ==, s.stored[0] + s.stored[1] + s.stored[2]);
    size_t seen[NEPH_N_PHOTON_CLASSES] = {0};
    for (size_t i = 0; i < n; i++) {
        NephPhoton p;
        neph_photons_get(photons, i, &p);
        float *d = p.direction;
        g_assert_cmpfloat_with_epsilon(d[0] * d[0] + d[1] * d[1] + d[2] * d[2], 1.0f,
                                       1e-3f);
        seen[p.photon_class]++;
    }
    for (int c = 0; c < NEPH_N_PHOTON_CLASSES; c++)
        g_assert_cmpuint(seen[c], ==, s.stored[c]);
    g_assert_false(neph_photons_write_ply(photons, "/nowhere/x.ply", NULL));
    neph_photons_free(photons);
    g_autoptr(GPtrArray) lines = g_ptr_array_new_with_free_func(g_free);
    g_assert_true(neph_photons_event_log(scene, settings, 2, keep_line, lines, &error));
    g_assert_cmpuint(lines->len, >=, 4);
    neph_settings_free(settings);
    neph_scene_free(scene);
}

/* Two sizes and places of one scene at once, and the first as it was. */
static void test_shared(void)
{
    NephScene *scene = load();
    NephScene *other = neph_scene_share(scene);
    NephCamera before, moved;
    int width, height;
    neph_scene_camera(scene, &before);
    moved = before;
    moved.position[0] += 0.5;
    g_assert_true(neph_scene_resize(other, 8, 8, NULL));
    g_assert_true(neph_scene_set_camera(other, &moved, NULL));
    neph_scene_size(scene, &width, &height);
    g_assert_cmpint(width, ==, 16);
    g_assert_cmpint(height, ==, 12);
    neph_scene_camera(scene, &moved);
    g_assert_cmpmem(before.position, sizeof before.position, moved.position,
                    sizeof moved.position);
    g_autoptr(NephSettings) settings = neph_scene_settings(other);
    g_autoptr(NephRender) render = neph_render_new(other, settings, NULL);
    g_assert_true(neph_render_run(render, NULL, NULL, NULL));
    g_autoptr(NephImage) image = neph_render_image(render, NULL);
    int n;
    neph_image_size(image, &width, &height, &n);
    g_assert_cmpint(width, ==, 8);
    g_clear_pointer(&render, neph_render_free);
    neph_scene_free(other);
    neph_scene_free(scene);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder = g_dir_make_tmp("nephroid-api-XXXXXX", NULL);
    scene_file = g_build_filename(folder, "box.pbrt", NULL);
    g_file_set_contents(scene_file, scene_text, -1, NULL);
    g_test_add_func("/api/settings/round-trip", test_settings_round_trip);
    g_test_add_func("/api/settings/refuse", test_settings_refuse);
    g_test_add_func("/api/settings/described", test_settings_described);
    g_test_add_func("/api/statistics", test_statistics_text);
    g_test_add_func("/api/scene", test_scene);
    g_test_add_func("/api/scene/shared", test_shared);
    g_test_add_func("/api/scene/errors", test_scene_errors);
    g_test_add_func("/api/scene/power", test_described_power_scales);
    g_test_add_func("/api/render/lives", test_render_lives);
    g_test_add_func("/api/render/stops", test_render_stops);
    g_test_add_func("/api/render/under-way", test_render_under_way);
    g_test_add_func("/api/render/refusals", test_render_survives_refusals);
    g_test_add_func("/api/images", test_images);
    g_test_add_func("/api/photons", test_photons);
    int result = g_test_run();
    g_remove(scene_file);
    g_rmdir(folder);
    g_free(scene_file);
    g_free(folder);
    return result;
}
