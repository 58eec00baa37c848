/*
 * The hand-over between window and worker, without a window: orders from the main thread
 * at any moment, news on its main loop. Meant for the thread sanitizer too.
 */
#include "cpu_time.h"
#include "session/session.h"

#include <glib/gstdio.h>
#include <math.h>
#include <string.h>

static char *folder, *scene_file;

static const char scene_text[] =
    "LookAt 0 0 -2  0 0 0  0 1 0\n"
    "Camera \"perspective\" \"float fov\" 50\n"
    "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 16\n"
    "Integrator \"photonmap\" \"integer passes\" 3 \"integer photons\" 2000\n"
    "    \"integer spp\" 1 \"string caustic_emission\" \"uniform\"\n"
    "WorldBegin\n"
    "LightSource \"point\" \"rgb I\" [10 10 10] \"point3 from\" [0 1.8 0]\n"
    "Shape \"sphere\" \"float radius\" 3\n";

/* What has been heard so far. */
typedef struct heard {
    session_state state;
    int scenes, pictures, errors, kept, resumed;
    char *error; /* the last one */
    bool coarse; /* the last picture */
    held_picture *picture;
    NephStatistics statistics;
} heard;

static void listen(const session_news *news, void *data)
{
    heard *h = data;
    h->state = news->state;
    h->scenes += news->loaded != NULL;
    h->errors += news->error != NULL;
    h->statistics = news->statistics;
    h->kept += news->kept != NULL;
    h->resumed += news->resumed != NULL;
    if (news->error) {
        g_free(h->error);
        h->error = g_strdup(news->error->message);
    }
    if (!news->picture)
        return;
    h->pictures++;
    held_picture_unref(h->picture);
    h->picture = held_picture_ref(news->picture);
}

static void wait_until(bool (*done)(const heard *h), const heard *h)
{
    gint64 limit = g_get_monotonic_time() + 60 * G_USEC_PER_SEC;
    while (!done(h)) {
        g_assert_cmpint(g_get_monotonic_time(), <, limit);
        if (!g_main_context_iteration(NULL, FALSE))
            g_usleep(500);
    }
}

static bool is_done(const heard *h)
{
    return h->scenes > 0 && h->state == SESSION_DONE;
}

static bool has_picture(const heard *h)
{
    return h->pictures > 0;
}

static bool is_loading(const heard *h)
{
    return h->state == SESSION_LOADING;
}

static bool has_error(const heard *h)
{
    return h->errors > 0;
}

static bool has_moved(const heard *h)
{
    return h->pictures > 5;
}

static void end(session *s, heard *h)
{
    session_close(s);
    while (g_main_context_iteration(NULL, FALSE))
        ;
    held_picture_unref(h->picture);
    g_free(h->error);
}

/* The same picture as the library makes without a window. */
static void test_same_picture(void)
{
    heard h = {0};
    session *s = session_new(listen, &h);
    session_load(s, scene_file);
    wait_until(is_done, &h);
    g_assert_false(h.picture->coarse);
    g_assert_cmpint(h.statistics.passes, ==, 3);
    g_autoptr(NephScene) scene = neph_scene_load(scene_file, 0, NULL, NULL, NULL);
    g_autoptr(NephSettings) settings = neph_scene_settings(scene);
    g_autoptr(NephRender) render = neph_render_new(scene, settings, NULL);
    g_assert_true(neph_render_run(render, NULL, NULL, NULL));
    g_autoptr(NephImage) image = neph_render_image(render, NULL);
    int width, height, n;
    neph_image_size(image, &width, &height, &n);
    g_assert_cmpmem(neph_image_pixels(image),
                    (size_t)(width * height * n) * sizeof(float),
                    neph_image_pixels(h.picture->image),
                    (size_t)(width * height * n) * sizeof(float));
    end(s, &h);
}

static void test_missing(void)
{
    heard h = {0};
    session *s = session_new(listen, &h);
    session_load(s, "/nowhere/at/all.pbrt");
    wait_until(has_error, &h);
    g_assert_cmpint(h.state, ==, SESSION_EMPTY);
    end(s, &h);
}

/* A model whose importer never ends holds nobody up: another scene stops it, unheard, and
 * so does the end. */
static void test_endless_import(void)
{
    heard h = {0};
    g_autofree char *importer = g_build_filename(folder, "importer", NULL);
    g_autofree char *model = g_build_filename(folder, "a.obj", NULL);
    g_assert_true(
        g_file_set_contents(importer, "#!/bin/sh\nexec sleep 1000\n", -1, NULL));
    g_assert_true(g_file_set_contents(model, "v 0 0 0\n", -1, NULL));
    g_assert_cmpint(g_chmod(importer, 0700), ==, 0);
    g_setenv("NEPHROID_IMPORTER", importer, TRUE);
    session *s = session_new(listen, &h);
    session_load(s, model);
    wait_until(is_loading, &h);
    session_load(s, scene_file);
    wait_until(is_done, &h);
    g_assert_cmpint(h.errors, ==, 0);
    session_load(s, model);
    wait_until(is_loading, &h);
    end(s, &h);
    g_unsetenv("NEPHROID_IMPORTER");
    g_unlink(importer);
    g_unlink(model);
}

static void write_large(const char *path)
{
    GString *text = g_string_new("Camera \"perspective\"\nWorldBegin\nLightSource "
                                 "\"infinite\"\n");
    for (int i = 0; i < 200000; i++)
        g_string_append_printf(text,
                               "AttributeBegin Translate %d %d %d Material \"diffuse\" "
                               "\"rgb reflectance\" [0.5 0.4 0.3]\nShape \"sphere\" "
                               "\"float radius\" 0.4 AttributeEnd\n",
                               i % 100, i / 100 % 100, i / 10000);
    g_assert_true(g_file_set_contents(path, text->str, (gssize)text->len, NULL));
    g_string_free(text, TRUE);
}

/* Nor does a scene that takes long to read: the other one, and the end, take the time of
 * themselves. */
static void test_long_reading(void)
{
    heard h = {0};
    g_autofree char *large = g_build_filename(folder, "large.pbrt", NULL);
    write_large(large);
    double start = cpu_seconds();
    neph_scene_free(neph_scene_load(large, 1, NULL, NULL, NULL));
    double whole = cpu_seconds() - start;
    session *s = session_new(listen, &h);
    start = cpu_seconds();
    session_load(s, scene_file);
    wait_until(is_done, &h);
    double small = cpu_seconds() - start;
    h.scenes = 0;
    session_load(s, large);
    wait_until(is_loading, &h);
    start = cpu_seconds();
    session_load(s, scene_file);
    wait_until(is_done, &h);
    g_assert_cmpint(h.errors, ==, 0);
    g_assert_cmpint(h.scenes, ==, 1);
    session_load(s, large);
    wait_until(is_loading, &h);
    end(s, &h);
    g_test_message("%.2f s, alone %.2f; the large one %.2f s", cpu_seconds() - start,
                   small, whole);
    g_assert_cmpfloat(cpu_seconds() - start, <, small + 0.5 * whole);
    g_unlink(large);
}

/* While the view moves only quick looks come; when it stands still, the whole. */
static void test_moving(void)
{
    heard h = {0};
    session *s = session_new(listen, &h);
    session_load(s, scene_file);
    wait_until(is_done, &h);
    NephCamera camera = {.position = {0, 0, -2},
                         .direction = {0, 0, 1},
                         .up = {0, 1, 0},
                         .fov = 50.0,
                         .focal_distance = 1.0};
    h.pictures = 0;
    while (!has_moved(&h)) {
        camera.position[0] += 0.001;
        session_set_camera(s, &camera, true);
        g_main_context_iteration(NULL, FALSE);
        g_usleep(2000);
    }
    g_assert_true(h.picture->coarse);
    session_set_camera(s, &camera, false);
    wait_until(is_done, &h); /* nor is what was done before taken for it */
    g_assert_false(h.picture->coarse);
    end(s, &h);
}

/* ---- Checkpoints ---- */

static bool has_passes(const heard *h)
{
    return h->scenes > 0 && h->statistics.passes > 1;
}

static bool is_kept(const heard *h)
{
    return h->kept > 0;
}

static bool is_resumed(const heard *h)
{
    return h->resumed > 0;
}

static bool is_paused(const heard *h)
{
    return h->state == SESSION_PAUSED;
}

static NephSettings *long_settings(const NephScene *scene)
{
    NephSettings *settings = neph_scene_settings(scene);
    neph_settings_set(settings, "passes", "60", NULL);
    neph_settings_set(settings, "photons", "20000", NULL);
    return settings;
}

static NephRender *whole_render(NephScene *scene, const char *checkpoint)
{
    g_autoptr(NephSettings) settings = long_settings(scene);
    neph_scene_resize(scene, 20, 12, NULL);
    NephRender *render = neph_render_new(scene, settings, NULL);
    g_assert_true(neph_render_run(render, NULL, NULL, NULL));
    g_assert_true(!checkpoint || neph_render_save_checkpoint(render, checkpoint, NULL));
    return render;
}

static void assert_same_picture(const NephRender *whole, const heard *h)
{
    int width, height, n;
    g_autoptr(NephImage) image = neph_render_image(whole, NULL);
    neph_image_size(image, &width, &height, &n);
    g_assert_cmpint(h->picture->width, ==, width);
    g_assert_cmpmem(neph_image_pixels(image),
                    (size_t)(width * height * n) * sizeof(float),
                    neph_image_pixels(h->picture->image),
                    (size_t)(width * height * n) * sizeof(float));
}

static void resume_in_new_session(const char *path, const NephRender *whole)
{
    heard h = {0};
    session *s = session_new(listen, &h);
    session_load(s, scene_file);
    wait_until(is_done, &h); /* what is done goes on too */
    session_resume(s, path);
    wait_until(is_resumed, &h);
    wait_until(is_done, &h);
    g_assert_cmpint(h.errors, ==, 0);
    g_assert_cmpint(h.statistics.passes, ==, 60);
    assert_same_picture(whole, &h);
    end(s, &h);
}

/* Kept while it is rendered and while it pauses, and gone on from by another session: the
 * picture of a render without a break, in the size and with the settings of the file. So
 * does what the command line has kept. */
static void test_checkpoint(void)
{
    heard h = {0};
    g_autoptr(NephScene) scene = neph_scene_load(scene_file, 0, NULL, NULL, NULL);
    g_autoptr(NephSettings) settings = long_settings(scene);
    g_autofree char *running = g_build_filename(folder, "running", NULL);
    g_autofree char *paused = g_build_filename(folder, "paused", NULL);
    g_autofree char *others = g_build_filename(folder, "others", NULL);
    session *s = session_new(listen, &h);
    session_load(s, scene_file);
    wait_until(has_picture, &h);
    session_set_settings(s, settings);
    session_set_size(s, 20, 12);
    h.statistics.passes = 0;
    session_keep_in(s, running);
    wait_until(is_kept, &h);
    wait_until(has_passes, &h);
    session_pause(s);
    wait_until(is_paused, &h);
    h.kept = 0;
    session_keep_in(s, paused);
    wait_until(is_kept, &h);
    g_assert_cmpint(h.errors, ==, 0);
    end(s, &h);
    g_autoptr(NephRender) whole = whole_render(scene, others);
    resume_in_new_session(running, whole);
    resume_in_new_session(paused, whole);
    resume_in_new_session(others, whole);
    g_unlink(running);
    g_unlink(paused);
    g_unlink(others);
}

/* What can not be is told, and all goes on as it was. */
static void test_checkpoint_refused(void)
{
    heard h = {0};
    session *s = session_new(listen, &h);
    session_keep_in(s, "/nowhere/at/all");
    wait_until(has_error, &h);
    g_assert_nonnull(strstr(h.error, "nothing is rendered"));
    session_load(s, scene_file);
    wait_until(is_done, &h);
    h.errors = 0;
    session_keep_in(s, "/nowhere/at/all");
    wait_until(has_error, &h);
    g_assert_nonnull(strstr(h.error, "/nowhere/at/all"));
    h.errors = 0;
    session_resume(s, scene_file);
    wait_until(has_error, &h);
    g_assert_nonnull(strstr(h.error, "found another file"));
    g_assert_cmpint(h.state, ==, SESSION_DONE);
    h.errors = 0;
    g_autofree char *path = g_build_filename(folder, "kept", NULL);
    session_keep_in(s, path);
    wait_until(is_kept, &h);
    NephCamera camera = {
        .direction = {0, 0, 1}, .up = {0, 1, 0}, .fov = 50.0, .focal_distance = 1.0};
    session_set_camera(s, &camera, false);
    wait_until(is_done, &h);
    session_resume(s, path); /* seen from elsewhere */
    wait_until(has_error, &h);
    g_assert_nonnull(strstr(h.error, "of another scene"));
    g_assert_cmpint(h.resumed, ==, 0);
    end(s, &h);
    g_unlink(path);
}

/* Orders in every order and at every moment. */
static void test_any_order(void)
{
    heard h = {0};
    session *s = session_new(listen, &h);
    GRand *random = g_rand_new_with_seed(7);
    g_autofree char *path = g_build_filename(folder, "any", NULL);
    g_autoptr(NephSettings) settings = neph_settings_new();
    neph_settings_set(settings, "photons", "500", NULL);
    neph_settings_set(settings, "passes", "50", NULL);
    NephCamera camera = {
        .direction = {0, 0, 1}, .up = {0, 1, 0}, .fov = 50.0, .focal_distance = 1.0};
    session_load(s, scene_file);
    wait_until(has_picture, &h);
    for (int i = 0; i < 150; i++) {
        switch (g_rand_int_range(random, 0, 10)) {
        case 0:
            session_load(s, scene_file);
            break;
        case 1:
            session_set_settings(s, settings);
            break;
        case 2:
            session_set_size(s, g_rand_int_range(random, 1, 30), 12);
            break;
        case 3:
            session_play(s);
            break;
        case 4:
            session_pause(s);
            break;
        case 5:
            session_stop(s);
            break;
        case 6:
            session_set_camera(s, &camera, g_rand_boolean(random));
            break;
        case 7:
            session_keep_in(s, path);
            break;
        case 8:
            session_resume(s, path);
            break;
        default:
            session_restart(s);
        }
        g_main_context_iteration(NULL, FALSE);
        g_usleep((gulong)g_rand_int_range(random, 0, 3000));
    }
    session_set_camera(s, &camera, false);
    neph_settings_set(settings, "passes", "1", NULL);
    session_set_settings(s, settings);
    session_restart(s);
    h.state = SESSION_RENDERING;
    wait_until(is_done, &h);
    g_rand_free(random);
    end(s, &h);
    g_unlink(path);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder = g_dir_make_tmp("nephroid-session-XXXXXX", NULL);
    scene_file = g_build_filename(folder, "scene.pbrt", NULL);
    g_assert_true(g_file_set_contents(scene_file, scene_text, -1, NULL));
    g_test_add_func("/session/same-picture", test_same_picture);
    g_test_add_func("/session/missing", test_missing);
    g_test_add_func("/session/endless-import", test_endless_import);
    g_test_add_func("/session/long-reading", test_long_reading);
    g_test_add_func("/session/moving", test_moving);
    g_test_add_func("/session/checkpoint", test_checkpoint);
    g_test_add_func("/session/checkpoint-refused", test_checkpoint_refused);
    g_test_add_func("/session/any-order", test_any_order);
    int result = g_test_run();
    g_remove(scene_file);
    g_rmdir(folder);
    g_free(scene_file);
    g_free(folder);
    return result;
}
