/*
 * Programs whose structs are smaller or larger than the library's: what both know is the
 * same, what only one knows is zero, and nothing is written beyond.
 */
#include "api_scene.h"

#include <glib/gstdio.h>

enum { MOST = 1024, GUARD = 0x5a, MORE = 48, MOST_GAPS = 3 };

/* What is asked for all structs that are filled. */
typedef struct filler {
    const NephScene *scene;
    NephRender *render;
    const NephPhotons *photons;
    const NephImage *image;
} filler;

static const double point[3] = {0.0, 0.0, 0.0}, along[3] = {0.0, 0.0, 1.0};

static void fill_camera(const filler *f, void *out, size_t size)
{
    neph_scene_camera_sized(f->scene, out, size);
}

static void fill_statistics(const filler *f, void *out, size_t size)
{
    neph_render_statistics_sized(f->render, out, size);
}

static void fill_photon_statistics(const filler *f, void *out, size_t size)
{
    neph_photons_statistics_sized(f->photons, out, size);
}

static void fill_plan(const filler *f, void *out, size_t size)
{
    g_assert_true(neph_render_plan_sized(f->render, out, size, NULL));
}

static void fill_surface(const filler *f, void *out, size_t size)
{
    g_assert_true(neph_scene_pick_sized(f->scene, point, along, out, size));
}

static void fill_difference(const filler *f, void *out, size_t size)
{
    g_assert_true(neph_image_compare_sized(f->image, f->image, out, size, NULL));
}

static void fill_photon(const filler *f, void *out, size_t size)
{
    g_assert_true(neph_photons_get_sized(f->photons, 1, out, size));
}

static void fill_estimate(const filler *f, void *out, size_t size)
{
    NephPhoton p;
    neph_photons_get(f->photons, 1, &p);
    const double at[3] = {p.position[0], p.position[1], p.position[2]};
    neph_photons_estimate_sized(f->photons, at, along, 1.0, out, size);
}

/* Between fields are bytes that mean nothing. */
typedef struct gap {
    size_t from, to;
} gap;

#define AFTER(type, field) (offsetof(type, field) + sizeof(((type *)NULL)->field))
#define STATISTICS_GAPS                                                                  \
    {                                                                                    \
        {AFTER(NephStatistics, can_look), offsetof(NephStatistics, part)},               \
        {                                                                                \
            AFTER(NephStatistics, short_of_memory), sizeof(NephStatistics)               \
        }                                                                                \
    }

#define SURFACE_GAPS                                                                     \
    {                                                                                    \
        {AFTER(NephSurfacePoint, shape), offsetof(NephSurfacePoint, shape_kind)},        \
            {AFTER(NephSurfacePoint, material),                                          \
             offsetof(NephSurfacePoint, material_name)},                                 \
            {AFTER(NephSurfacePoint, line), sizeof(NephSurfacePoint)},                   \
    }

#define NO_GAPS                                                                          \
    {                                                                                    \
        {0, 0},                                                                          \
    }

static const struct {
    const char *name;
    void (*fill)(const filler *f, void *out, size_t size);
    size_t size;
    gap gaps[MOST_GAPS];
} kinds[] = {
    {"camera", fill_camera, sizeof(NephCamera), NO_GAPS},
    {"statistics", fill_statistics, sizeof(NephStatistics), STATISTICS_GAPS},
    {"photon statistics", fill_photon_statistics, sizeof(NephStatistics),
     STATISTICS_GAPS},
    {"plan", fill_plan, sizeof(NephPlan), NO_GAPS},
    {"surface", fill_surface, sizeof(NephSurfacePoint), SURFACE_GAPS},
    {"difference", fill_difference, sizeof(NephImageDifference), NO_GAPS},
    {"photon", fill_photon, sizeof(NephPhoton), NO_GAPS},
    {"estimate", fill_estimate, sizeof(NephEstimate), NO_GAPS},
};

static bool is_same(const unsigned char *a, const unsigned char *b, size_t n,
                    const gap gaps[MOST_GAPS])
{
    for (size_t i = 0; i < n; i++) {
        bool means = true;
        for (int k = 0; k < MOST_GAPS; k++)
            means &= !(i >= gaps[k].from && i < gaps[k].to);
        if (means && a[i] != b[i])
            return false;
    }
    return true;
}

static void check_kind(const filler *f, size_t kind)
{
    unsigned char whole[MOST], other[MOST];
    size_t size = kinds[kind].size;
    g_assert_cmpuint(size + MORE, <=, MOST);
    kinds[kind].fill(f, whole, size);
    for (size_t n = 1; n <= size + MORE; n++) {
        memset(other, GUARD, sizeof other);
        kinds[kind].fill(f, other, n);
        if (!is_same(whole, other, MIN(n, size), kinds[kind].gaps))
            g_error("%s: %zu bytes are not those of %zu", kinds[kind].name, n, size);
        for (size_t i = size; i < n; i++)
            g_assert_cmpuint(other[i], ==, 0);
        g_assert_cmpuint(other[n], ==, GUARD);
    }
}

static void test_filled(void)
{
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    g_autoptr(NephSettings) settings = neph_scene_settings(scene);
    neph_settings_set(settings, "photons", "600", NULL);
    neph_settings_set(settings, "integrator", "photonmap", NULL);
    neph_settings_set(settings, "passes", "2", NULL);
    neph_scene_resize(scene, 8, 8, NULL);
    g_autoptr(NephPhotons) photons = neph_photons_trace(scene, settings, NULL);
    g_autoptr(NephRender) render = neph_render_new(scene, settings, NULL);
    g_assert_true(neph_render_run(render, NULL, NULL, NULL));
    g_autoptr(NephImage) image = neph_render_image(render, NULL);
    const filler f = {scene, render, photons, image};
    for (size_t i = 0; i < G_N_ELEMENTS(kinds); i++)
        check_kind(&f, i);
}

/* ---- Arrays: an element is as large as the program says ---- */

static void test_table(void)
{
    size_t n, m;
    const NephSettingInfo *rows = neph_settings_table(&n);
    const size_t sizes[] = {offsetof(NephSettingInfo, low), sizeof *rows + MORE};
    for (size_t k = 0; k < G_N_ELEMENTS(sizes); k++) {
        const char *other = (const char *)neph_settings_table_sized(&m, sizes[k]);
        g_assert_cmpuint(m, ==, n);
        for (size_t i = 0; i < n; i++)
            g_assert_cmpmem(other + i * sizes[k], MIN(sizes[k], sizeof *rows), &rows[i],
                            MIN(sizes[k], sizeof *rows));
        g_assert_true(other == (const char *)neph_settings_table_sized(&m, sizes[k]));
    }
}

static void test_events(void)
{
    enum { N = 8, SMALL = offsetof(NephPhotonEvent, rgb) };
    NephPhotonEvent whole[N];
    char other[N * SMALL + 1];
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    g_autoptr(NephSettings) settings = neph_scene_settings(scene);
    neph_settings_set(settings, "integrator", "photonmap", NULL);
    neph_settings_set(settings, "photons", "600", NULL);
    g_autoptr(NephPhotons) photons = neph_photons_trace(scene, settings, NULL);
    g_assert_true(neph_photons_follow(photons, NULL, NULL, NULL));
    for (size_t i = 0; i < 20; i++) {
        size_t n = neph_photons_path(photons, i, whole, N);
        memset(other, GUARD, sizeof other);
        g_assert_cmpuint(neph_photons_path_sized(
                             photons, i, (NephPhotonEvent *)(void *)other, SMALL, N),
                         ==, n);
        for (size_t k = 0; k < MIN(n, N); k++)
            g_assert_cmpmem(other + k * SMALL, SMALL, &whole[k], SMALL);
        g_assert_cmpint(other[MIN(n, N) * SMALL], ==, GUARD);
        g_assert_cmpuint(neph_photons_path(photons, i, NULL, N), ==, n);
    }
}

/* ---- What is taken ---- */

static void count_files(const char *path, void *data)
{
    (void)path;
    ++*(int *)data;
}

/* Fields that a program does not know are not read, whatever lies there. */
static void test_taken(void)
{
    int n_files = 0;
    g_autoptr(GError) error = NULL;
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    const char *path = neph_scene_files(scene)[0];
    NephLoadOptions options;
    memset(&options, GUARD, sizeof options);
    options = (NephLoadOptions){.file = count_files, .file_data = &n_files};
    memset((char *)&options + offsetof(NephLoadOptions, go_on), GUARD,
           sizeof options - offsetof(NephLoadOptions, go_on));
    g_autoptr(NephScene) again = neph_scene_load_with_sized(
        path, &options, offsetof(NephLoadOptions, go_on), &error);
    g_assert_no_error(error);
    g_assert_nonnull(again);
    g_assert_cmpint(n_files, ==, 1);
    options.file = NULL; /* nor is this read now */
    memset(&options.file, GUARD, sizeof options.file);
    g_autoptr(NephScene) older = neph_scene_load_with_sized(
        path, &options, offsetof(NephLoadOptions, file), &error);
    g_assert_no_error(error);
    g_assert_nonnull(older);
}

static void test_texts(void)
{
    NephStatistics s = {.passes = 7, .left_noisy = true, .short_of_memory = true};
    g_autofree char *all = neph_statistics_text(&s, true);
    g_autofree char *older =
        neph_statistics_text_sized(&s, offsetof(NephStatistics, short_of_memory), true);
    g_assert_nonnull(strstr(all, "\"short_of_memory\": true"));
    g_assert_nonnull(strstr(older, "\"short_of_memory\": false"));
    g_assert_nonnull(strstr(older, "\"left_noisy\": true"));
    g_assert_nonnull(strstr(older, "\"passes\": 7"));
    NephCamera c = {.direction = {0, 0, 1}, .up = {0, 1, 0}, .fov = 30};
    g_autofree char *text = neph_camera_text(&c);
    memset(&c.kind, GUARD, sizeof c.kind);
    g_autofree char *same = neph_camera_text_sized(&c, offsetof(NephCamera, kind));
    g_assert_cmpstr(text, ==, same);
}

/* The options' statistics have a size of their own. */
static void test_saved(void)
{
    unsigned char got[sizeof(NephStatistics)];
    g_autoptr(GError) error = NULL;
    g_autoptr(NephScene) scene = make_scene("Camera \"perspective\"\n");
    g_autoptr(NephSettings) settings = neph_scene_settings(scene);
    neph_settings_set(settings, "integrator", "photonmap", NULL);
    neph_settings_set(settings, "photons", "600", NULL);
    const size_t sizes[] = {sizeof(NephSaveOptions), offsetof(NephStatistics, radius)};
    const NephSaveOptions options = {.statistics = (NephStatistics *)(void *)got};
    g_autofree char *path = g_strconcat(neph_scene_files(scene)[0], ".photons", NULL);
    memset(got, GUARD, sizeof got);
    g_assert_true(
        neph_photons_save_sized(scene, settings, path, &options, sizes, &error));
    g_assert_no_error(error);
    uint64_t stored[NEPH_N_PHOTON_CLASSES];
    memcpy(stored, got + offsetof(NephStatistics, stored), sizeof stored);
    g_assert_cmpuint(stored[NEPH_PHOTON_INDIRECT], >, 0);
    g_assert_cmpuint(stored[NEPH_PHOTON_INDIRECT], <, 100000);
    g_assert_cmpuint(got[sizes[1]], ==, GUARD);
    g_unlink(path);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder = g_dir_make_tmp("nephroid-sizes-XXXXXX", NULL);
    g_test_add_func("/api-sizes/filled", test_filled);
    g_test_add_func("/api-sizes/table", test_table);
    g_test_add_func("/api-sizes/events", test_events);
    g_test_add_func("/api-sizes/taken", test_taken);
    g_test_add_func("/api-sizes/texts", test_texts);
    g_test_add_func("/api-sizes/saved", test_saved);
    int result = g_test_run();
    remove_folder();
    return result;
}
