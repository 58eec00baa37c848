/*
 * The library in a process that does more than one thing: two renders at once are those
 * of two that come one after the other, and whatever a render is at, it ends soon when it
 * is asked to.
 */
#include "api_scene.h"
#include "asked_end.h"
#include "folder.h"
#include "sanitizers.h"

/* ---- Two at once ---- */

typedef struct task {
    const NephScene *scene;
    const char *integrator;
    NephImage *image;
} task;

static NephSettings *settings_of(const NephScene *scene, const char *integrator)
{
    NephSettings *settings = neph_scene_settings(scene);
    neph_settings_set(settings, "integrator", integrator, NULL);
    neph_settings_set(settings, "passes", "3", NULL);
    neph_settings_set(settings, "spp", "2", NULL);
    neph_settings_set(settings, "threads", "2", NULL);
    return settings;
}

static gpointer render_task(gpointer data)
{
    task *t = data;
    g_autoptr(NephSettings) settings = settings_of(t->scene, t->integrator);
    g_autoptr(NephRender) render = neph_render_new(t->scene, settings, NULL);
    g_assert_true(neph_render_run(render, NULL, NULL, NULL));
    t->image = neph_render_image(render, NULL);
    return NULL;
}

static void assert_same(const NephImage *a, const NephImage *b)
{
    int width, height, n, width_b, height_b, n_b;
    neph_image_size(a, &width, &height, &n);
    neph_image_size(b, &width_b, &height_b, &n_b);
    size_t size = (size_t)(width * height * n) * sizeof(float);
    size_t size_b = (size_t)(width_b * height_b * n_b) * sizeof(float);
    g_assert_cmpmem(neph_image_pixels(a), size, neph_image_pixels(b), size_b);
}

/* Of one scene, by all integrators, and of another one. */
static void test_at_once(void)
{
    static const char *const integrators[] = {"auto", "photonmap", "vcm", "path"};
    enum { N = G_N_ELEMENTS(integrators) + 1 };
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    g_autoptr(NephScene) other = make_scene("LookAt 1 0 0  0 0 0  0 1 0 Camera "
                                            "\"perspective\"\n");
    task at_once[N], alone[N];
    GThread *threads[N];
    for (int i = 0; i < N; i++)
        at_once[i] = alone[i] =
            (task){i < N - 1 ? scene : other, integrators[i % (N - 1)], NULL};
    for (int i = 0; i < N; i++)
        threads[i] = g_thread_new("render", render_task, &at_once[i]);
    for (int i = 0; i < N; i++)
        g_thread_join(threads[i]);
    for (int i = 0; i < N; i++) {
        render_task(&alone[i]);
        assert_same(at_once[i].image, alone[i].image);
        neph_image_free(at_once[i].image);
        neph_image_free(alone[i].image);
    }
}

/* Of a thread that is the first to ask, as all others are. */
typedef struct answers {
    const char *path; /* of a scene */
    size_t n;
    const NephSettingInfo *rows;
    const char *small; /* rows that end before their documents */
    const char *const *scenes, *const *images, *const *written;
    NephScene *scene;
} answers;

enum { SMALL_ROW = offsetof(NephSettingInfo, doc) };

static gpointer ask_first(gpointer data)
{
    answers *a = data;
    size_t n;
    a->scenes = neph_scene_extensions();
    a->images = neph_image_extensions();
    a->written = neph_image_written_extensions();
    a->rows = neph_settings_table(&a->n);
    a->small = (const char *)neph_settings_table_sized(&n, SMALL_ROW);
    a->scene = load(a->path);
    g_assert_cmpuint(n, ==, a->n);
    return NULL;
}

/* What is made when it is first asked for is whole for everybody, and made once. */
static void test_first(void)
{
    enum { N = 4 };
    answers all[N];
    GThread *threads[N];
    g_autofree char *path = write_scene("scene.pbrt", "Camera \"perspective\"\n");
    for (int i = 0; i < N; i++) {
        all[i] = (answers){.path = path};
        threads[i] = g_thread_new("first", ask_first, &all[i]);
    }
    for (int i = 0; i < N; i++)
        g_thread_join(threads[i]);
    for (int i = 0; i < N; i++) {
        const answers *a = &all[i];
        g_assert_true(a->rows == all[0].rows && a->small == all[0].small);
        for (size_t k = 0; k < a->n; k++)
            g_assert_cmpmem(a->small + k * SMALL_ROW, SMALL_ROW, &a->rows[k], SMALL_ROW);
        g_assert_true(g_strv_contains(a->scenes, ".pbrt"));
        g_assert_true(g_strv_contains(a->images, ".exr"));
        g_assert_true(g_strv_contains(a->written, ".exr"));
        neph_scene_free(a->scene);
    }
}

/* ---- Cancelling ---- */

/* Within this it ends: s; where each access to memory is watched, ten times that: sorting
   the photons of a map, which is not interrupted, takes 0.3 s there. */
static const double soon = THREADS_ARE_WATCHED ? 1.0 : 0.1;

/* The best of so many tries counts. */
enum { TRIES = 4, MOMENTS = 6 };

static void cancel(void *render)
{
    neph_render_cancel(render);
}

/* s from the asking to the end; 0: it was over before. */
static double cancel_after(const NephScene *scene, const NephSettings *settings,
                           double after)
{
    g_autoptr(NephRender) render = neph_render_new(scene, settings, NULL);
    g_autoptr(GError) error = NULL;
    asked_end end = {.after = (gint64)(after * 1e6), .ask = cancel, .of = render};
    asked_end_begin(&end);
    bool done = neph_render_run(render, NULL, NULL, &error);
    double took = asked_end_took(&end);
    if (done)
        return 0.0;
    g_assert_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_CANCELLED);
    return took;
}

/* s that one pass takes. */
static double seconds_of(const NephScene *scene, const NephSettings *settings)
{
    g_autoptr(NephRender) render = neph_render_new(scene, settings, NULL);
    gint64 start = g_get_monotonic_time();
    g_assert_true(neph_render_run(render, NULL, NULL, NULL));
    return 1e-6 * (double)(g_get_monotonic_time() - start);
}

/* At moments all through a pass: planning, sending photons, building maps, looking. */
static void test_cancel(const void *words)
{
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    g_autoptr(NephSettings) settings = neph_scene_settings(scene);
    g_auto(GStrv) pairs = g_strsplit(words, " ", -1);
    for (char **pair = pairs; *pair; pair++) {
        g_auto(GStrv) two = g_strsplit(*pair, "=", 2);
        g_assert_true(neph_settings_set(settings, two[0], two[1], NULL));
    }
    double whole = seconds_of(scene, settings), worst = 0.0;
    for (int i = 0; i < MOMENTS; i++) {
        double best = INFINITY;
        for (int k = 0; k < TRIES && best > soon; k++)
            best = fmin(best, cancel_after(scene, settings, whole * (i + 0.3) / MOMENTS));
        g_test_message("at %.2f of %.2f s: %.1f ms", whole * (i + 0.3) / MOMENTS, whole,
                       1e3 * best);
        worst = fmax(worst, best);
    }
    g_assert_cmpfloat(worst, <, soon);
}

/* Photons that are kept, and their file that is not there then. */
typedef struct patience {
    gint64 end, asked; /* monotonic µs; asked is 0 until it is */
    double cpu;        /* s of the process, when it was */
} patience;

static bool until(void *data)
{
    patience *p = data;
    if (g_get_monotonic_time() < p->end)
        return true;
    if (!p->asked) {
        p->asked = g_get_monotonic_time();
        p->cpu = cpu_seconds();
    }
    return false;
}

/* s from the end of patience to now. */
static double seconds_since(const patience *p)
{
    return fmin(1e-6 * (double)(g_get_monotonic_time() - p->asked),
                cpu_seconds() - p->cpu);
}

static void test_cancel_keeping(void)
{
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    g_autoptr(NephSettings) settings = neph_scene_settings(scene);
    g_autofree char *path = g_build_filename(folder, "kept", NULL);
    g_assert_true(neph_settings_set(settings, "photons", "4000000", NULL));
    double best = INFINITY;
    for (int k = 0; k < TRIES && best > soon; k++) {
        g_autoptr(GError) error = NULL;
        patience p = {.end = g_get_monotonic_time() + 150000};
        const NephSaveOptions options = {.go_on = until, .go_on_data = &p};
        g_assert_false(neph_photons_save(scene, settings, path, &options, &error));
        g_assert_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_CANCELLED);
        best = fmin(best, seconds_since(&p));
        g_assert_false(g_file_test(path, G_FILE_TEST_EXISTS));
    }
    g_test_message("%.1f ms", 1e3 * best);
    g_assert_cmpfloat(best, <, soon);
}

/* While noise is taken out: the next call has the whole picture. */
static void test_cancel_denoising(void)
{
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    g_autoptr(NephSettings) settings = neph_scene_settings(scene);
    neph_settings_set(settings, "integrator", "path", NULL);
    neph_settings_set(settings, "passes", "2", NULL);
    neph_scene_resize(scene, 400, 300, NULL);
    g_autoptr(NephRender) render = neph_render_new(scene, settings, NULL);
    g_assert_true(neph_render_run(render, NULL, NULL, NULL));
    gint64 start = g_get_monotonic_time();
    g_autoptr(NephImage) whole = neph_render_image(render, NULL);
    gint64 took = g_get_monotonic_time() - start;
    double worst = 0.0;
    for (int i = 0; i < MOMENTS; i++) {
        double best = INFINITY;
        for (int k = 0; k < TRIES && best > soon; k++) {
            g_autoptr(GError) error = NULL;
            patience p = {.end = g_get_monotonic_time() + took * i / MOMENTS};
            g_autoptr(NephImage) none =
                neph_render_image_while(render, until, &p, &error);
            if (!none)
                g_assert_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_CANCELLED);
            g_assert_true(i > 0 || !none);
            best = none ? 0.0 : seconds_since(&p);
        }
        g_test_message("at %d of %d of %.2f s: %.1f ms", i, MOMENTS, 1e-6 * (double)took,
                       1e3 * best);
        worst = fmax(worst, best);
    }
    g_assert_cmpfloat(worst, <, soon);
    g_autoptr(NephImage) again = neph_render_image(render, NULL);
    assert_same(whole, again);
}

/* Writing a picture: the old file stays, and nothing is beside it. */
static NephImage *noise(int width, int height)
{
    g_autofree float *rgb = g_new(float, 3 * (size_t)width * (size_t)height);
    g_autoptr(GRand) random = g_rand_new_with_seed(19);
    for (size_t i = 0; i < 3 * (size_t)width * (size_t)height; i++)
        rgb[i] = (float)g_rand_double(random);
    return neph_image_new(width, height, rgb, NULL);
}

static void assert_file_is(const char *path, const char *bytes, size_t size)
{
    g_autofree char *found = NULL;
    gsize n = 0;
    g_assert_true(g_file_get_contents(path, &found, &n, NULL));
    g_assert_cmpmem(found, n, bytes, size);
}

/* s from the asking to the end; 0: it was written before. */
static double cancel_writing(const NephImage *image, const char *path, gint64 after)
{
    g_autoptr(GError) error = NULL;
    patience p = {.end = g_get_monotonic_time() + after};
    if (neph_image_write_while(image, path, 0.0f, until, &p, &error))
        return 0.0;
    g_assert_error(error, NEPH_ERROR_DOMAIN, NEPH_ERROR_CANCELLED);
    return seconds_since(&p);
}

static void test_cancel_writing(const void *ending)
{
    enum { WIDTH = 1600, HEIGHT = 1200 };
    g_autofree char *name = g_strconcat("seen", (const char *)ending, NULL);
    g_autofree char *path = g_build_filename(folder, name, NULL);
    g_autoptr(NephImage) image = noise(WIDTH, HEIGHT);
    g_autofree char *whole = NULL;
    gsize size = 0;
    gint64 start = g_get_monotonic_time();
    g_assert_true(neph_image_write(image, path, 0.0f, NULL));
    gint64 took = g_get_monotonic_time() - start;
    g_assert_true(g_file_get_contents(path, &whole, &size, NULL));
    size_t before = n_files_in(folder);
    double worst = 0.0;
    for (int i = 0; i < MOMENTS; i++) {
        g_assert_true(g_file_set_contents(path, "old", 3, NULL));
        double best = INFINITY;
        for (int k = 0; k < TRIES && best > soon; k++)
            best = fmin(best, cancel_writing(image, path, took * i / MOMENTS));
        g_assert_true(i > 0 || best > 0.0);
        if (best > 0.0)
            assert_file_is(path, "old", 3);
        g_assert_cmpuint(n_files_in(folder), ==, before);
        g_test_message("at %d of %d of %.2f s: %.1f ms", i, MOMENTS, 1e-6 * (double)took,
                       1e3 * best);
        worst = fmax(worst, best);
    }
    g_assert_cmpfloat(worst, <, soon);
    patience enough = {.end = G_MAXINT64};
    g_assert_true(neph_image_write_while(image, path, 0.0f, until, &enough, NULL));
    assert_file_is(path, whole, size);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    open_folder();
    g_test_add_func("/api-threads/first", test_first); /* before anybody else asks */
    g_test_add_func("/api-threads/at-once", test_at_once);
    g_test_add_data_func("/api-threads/cancel/photonmap",
                         "integrator=photonmap passes=1 photons=400000 spp=16",
                         test_cancel);
    g_test_add_data_func(
        "/api-threads/cancel/gather",
        "integrator=photonmap passes=1 photons=20000 final_gather=on spp=8", test_cancel);
    g_test_add_data_func("/api-threads/cancel/auto", "integrator=auto passes=1 spp=128",
                         test_cancel);
    g_test_add_data_func("/api-threads/cancel/vcm", "integrator=vcm passes=1 spp=64",
                         test_cancel);
    g_test_add_data_func("/api-threads/cancel/path", "integrator=path passes=1 spp=256",
                         test_cancel);
    g_test_add_func("/api-threads/cancel/denoising", test_cancel_denoising);
    g_test_add_func("/api-threads/cancel/keeping", test_cancel_keeping);
    static const char *const endings[] = {".exr", ".png", ".jpg", ".hdr", ".pfm"};
    for (size_t i = 0; i < G_N_ELEMENTS(endings); i++) {
        g_autofree char *name =
            g_strconcat("/api-threads/cancel/writing/", endings[i] + 1, NULL);
        g_test_add_data_func(name, endings[i], test_cancel_writing);
    }
    int result = g_test_run();
    remove_folder();
    return result;
}
