/*
 * photon_file: a render by photons that were kept is, bit for bit, one that sends them
 * itself; the camera may be another; and a file that is not what it was, or of something
 * else, is refused with the reason.
 */
#include "render/kept/photon_file.h"
#include "rooms.h"

#include <glib/gstdio.h>
#include <string.h>

static char *folder, *path;
static const render_identity me = {(char *)"test 1", (char *)"room"};

static view *subject(const char *film, const char *lamp, const char *things)
{
    g_autofree char *text =
        g_strconcat(film, "WorldBegin\n", lamp, ROOM_WALLS, things, NULL);
    return view_of(text);
}

static view *room(void)
{
    return subject(ROOM_CAMERA SIZE(16), ROOM_LAMP(""), GLASS_BALL);
}

static bool keep(const view *v, const char *words, int64_t n, GError **error)
{
    const settings how = settings_with(v->scene, words);
    const photon_file_order order = {.view = v, .how = &how, .who = &me, .n_passes = n};
    return photon_file_write(&order, path, NULL, error);
}

static void keep_well(const view *v, const char *words, int64_t n)
{
    g_autoptr(GError) error = NULL;
    keep(v, words, n, &error);
    g_assert_no_error(error);
}

static render *with_kept(const view *v, const char *words)
{
    g_autoptr(GError) error = NULL;
    render *r = render_of(v, words);
    render_use_photons(r, &me, path, &error);
    g_assert_no_error(error);
    return r;
}

static image *render_kept(const view *v, const char *words)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(render) r = with_kept(v, words);
    render_run(r, NULL, NULL, &error);
    g_assert_no_error(error);
    return image_of(r);
}

/* ---- The same bits ---- */

static void assert_kept_alike(const view *v, const char *words)
{
    g_autofree char *three = g_strconcat(words, " threads=3", NULL);
    g_autoptr(image) whole = render_with(v, words);
    keep_well(v, three, 3);
    g_autoptr(image) kept = render_kept(v, words);
    assert_same_bits(whole, kept);
    g_assert_cmpfloat(mean_of(kept, ""), >, 0.01);
}

/* Where auto sends photons: a lens, and a light that no path finds. */
static const char lit_lens[] = "LightSource \"point\" \"rgb I\" [9 9 9] \"point3 from\" "
                               "[0 0 1.9]\n";

static void test_same_bits(const void *data)
{
    g_autoptr(view) v = subject(ROOM_CAMERA SIZE(32), lit_lens, GLASS_BALL);
    g_autofree char *words =
        g_strdup_printf("%s passes=3 spp=2 photons=3000", (char *)data);
    assert_kept_alike(v, words);
}

/* Photons with tags, on curves, in fog, and in slices of time. */
static void test_all_sorts(void)
{
    static const char *const fog =
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.1 .1 "
        ".1] \"rgb sigma_s\" [.2 .2 .2]\n"
        "AttributeBegin Material \"interface\" MediumInterface \"fog\" \"\" Translate 0 "
        "0 1 "
        "Shape \"sphere\" \"float radius\" 0.4 AttributeEnd\n";
    static const char *const thread =
        "AttributeBegin Material \"diffuse\" Shape \"curve\" \"point3 P\" [-1 0 0.2 -0.3 "
        "0 "
        "0.5 0.3 0 0.5 1 0 0.2] \"float width\" 0.1 AttributeEnd\n";
    static const char *const moving =
        "AttributeBegin ActiveTransform EndTime Translate 0.3 0 0 ActiveTransform All "
        "Material \"diffuse\" Translate 0.5 0 0.3 Shape \"sphere\" \"float radius\" 0.2 "
        "AttributeEnd\n";
    static const char *const grouped = "LightSource \"point\" \"rgb I\" [9 9 9] \"point3 "
                                       "from\" [0 0 1.9] \"string group\" \"top\"\n";
    static const char *const words[] = {"photons=2000 passes=3 spp=1",
                                        "integrator=auto photons=2000 passes=3 spp=1"};
    const char *const things[] = {fog, thread, moving, GLASS_BALL};
    for (size_t i = 0; i < G_N_ELEMENTS(things); i++) {
        const char *lamp = i == 3 ? grouped : lit_lens;
        g_autofree char *all = g_strconcat(things[i], i < 3 ? GLASS_BALL : "", NULL);
        g_autoptr(view) v = subject(ROOM_CAMERA SIZE(32), lamp, all);
        assert_kept_alike(v, words[0]);
        assert_kept_alike(v, words[1]);
    }
}

/* From elsewhere it is the same light: as much as with its own photons, and where a file
   has no more passes they come again. */
static void test_other_camera(void)
{
    static const char *const words = "passes=6 spp=4 photons=20000";
    g_autoptr(view) v = room();
    g_autoptr(view) other = subject("LookAt 1 -2.5 1.5  0 0 0.5  0 0 1 Camera "
                                    "\"perspective\" \"float fov\" 70\n" SIZE(24),
                                    ROOM_LAMP(""), GLASS_BALL);
    g_autoptr(image) own = render_with(other, words);
    keep_well(v, words, 4);
    g_autoptr(image) kept = render_kept(other, words);
    double expected = mean_of(own, ""), found = mean_of(kept, "");
    g_test_message("%g, %g", expected, found);
    g_assert_cmpfloat(fabs(found - expected), <, 0.03 * expected);
    keep_well(v, words, 1);
    g_autoptr(image) one = render_kept(other, words);
    g_assert_cmpfloat(fabs(mean_of(one, "") - expected), <, 0.1 * expected);
}

/* A render that goes on from a checkpoint goes on with the same photons. */
static void test_checkpoint(void)
{
    static const char *const words = "passes=4 spp=1 photons=2000";
    g_autofree char *left = g_build_filename(folder, "checkpoint", NULL);
    g_autoptr(view) v = room();
    g_autoptr(GError) error = NULL;
    keep_well(v, words, 2);
    g_autoptr(image) whole = render_kept(v, words);
    g_autoptr(render) half = with_kept(v, "passes=2 spp=1 photons=2000");
    g_assert_true(render_run(half, NULL, NULL, NULL));
    g_assert_true(render_save_checkpoint(half, &me, left, NULL));
    g_autoptr(render) r = with_kept(v, words);
    g_assert_true(render_resume(r, &me, left, NULL));
    g_assert_true(render_run(r, NULL, NULL, NULL));
    g_autoptr(image) picture = image_of(r);
    assert_same_bits(whole, picture);
    g_autoptr(render) alone = render_of(v, words);
    g_assert_true(render_resume(alone, &me, left, NULL));
    g_assert_false(render_run(alone, NULL, NULL, &error));
    g_assert_nonnull(strstr(error->message, "its photons were others"));
    g_remove(left);
}

/* ---- What is refused ---- */

static const char asked[] = "passes=2 spp=1 photons=1000";

/* As soon as it is opened, or when a pass needs what is damaged. */
static void refuse(const view *v, const char *words, const render_identity *who,
                   const char *part)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(render) r = render_of(v, words);
    bool refused =
        !render_use_photons(r, who, path, &error) || !render_run(r, NULL, NULL, &error);
    g_assert_true(refused);
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_true(g_str_has_prefix(error->message, path));
    g_assert_nonnull(strstr(error->message, part));
}

static void test_foreign(void)
{
    g_autoptr(view) v = room();
    keep_well(v, asked, 2);
    const render_identity other = {(char *)"test 2", me.scene},
                          elsewhere = {me.program, (char *)"hall"};
    refuse(v, asked, &other, "written by test 1, this is test 2");
    refuse(v, asked, &elsewhere, "of another scene");
    refuse(v, "passes=2 spp=1 photons=1001", &me, "with photons = 1000, not 1001");
    refuse(v, "passes=2 spp=1 photons=1000 seed=4", &me, "with seed = 0, not 4");
    refuse(v, "integrator=vcm passes=2 spp=1 photons=1000", &me, "with integrator =");
    g_assert_true(g_file_set_contents(path, "nephroid photons 9 7 0\n", -1, NULL));
    refuse(v, asked, &me, "found form '9'");
    g_assert_true(g_file_set_contents(path, "nephroid checkpoint 1 7 0\n", -1, NULL));
    refuse(v, asked, &me, "expected a photon map, found another file");
}

/* Cut anywhere, or with a bit turned anywhere, it is never taken for whole. */
static void test_damaged(void)
{
    g_autoptr(view) v = room();
    keep_well(v, "passes=2 spp=1 photons=300", 2);
    g_autofree char *bytes = NULL;
    gsize size;
    g_assert_true(g_file_get_contents(path, &bytes, &size, NULL));
    g_autoptr(GRand) random = g_rand_new_with_seed(8);
    for (int i = 0; i < 300; i++) {
        bool cut = i % 2 == 0, in_header = i % 4 < 2;
        gsize at = (gsize)g_rand_int_range(random, 0, in_header ? 3000 : (gint32)size);
        g_autofree char *broken = g_memdup2(bytes, size);
        broken[at] = (char)(broken[at] ^ (1 << g_rand_int_range(random, 0, 8)));
        g_assert_true(g_file_set_contents(path, broken, (gssize)(cut ? at : size), NULL));
        refuse(v, "passes=2 spp=1 photons=300", &me, "");
    }
    g_autofree char *longer = g_malloc0(size + 1);
    memcpy(longer, bytes, size);
    g_assert_true(g_file_set_contents(path, longer, (gssize)size + 1, NULL));
    refuse(v, "passes=2 spp=1 photons=300", &me, "something follows its end");
}

/* What sends no photons, or such as are of no use to others, leaves no file. */
static void test_nothing_to_keep(void)
{
    static const char *const words[][2] = {
        {"integrator=path", "expected one of photonmap, auto, sppm,"},
        {"integrator=vcm", "expected one of photonmap, auto, sppm,"},
        {"integrator=auto gather_indirect=off", "there is nothing to keep"},
    };
    g_autoptr(view) v = subject(ROOM_CAMERA SIZE(8), ROOM_LAMP(""), "");
    g_remove(path);
    for (size_t i = 0; i < G_N_ELEMENTS(words); i++) {
        g_autoptr(GError) error = NULL;
        g_assert_false(keep(v, words[i][0], 1, &error));
        g_assert_error(error, NEPH_ERROR, ERROR_USAGE);
        g_assert_nonnull(strstr(error->message, words[i][1]));
        g_assert_false(g_file_test(path, G_FILE_TEST_EXISTS));
    }
    g_autoptr(GError) stopped = NULL;
    cancel_flag cancel = {0};
    atomic_store(&cancel.set, true);
    const settings how = settings_with(v->scene, asked);
    const photon_file_order order = {
        .view = v, .how = &how, .who = &me, .n_passes = 1, .cancel = &cancel};
    g_assert_false(photon_file_write(&order, path, NULL, &stopped));
    g_assert_error(stopped, NEPH_ERROR, ERROR_CANCELLED);
    g_assert_false(g_file_test(path, G_FILE_TEST_EXISTS));
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder = g_dir_make_tmp("photon-file-XXXXXX", NULL);
    path = g_build_filename(folder, "room.photons", NULL);
    g_test_add_data_func("/photon-file/bits/auto", "integrator=auto", test_same_bits);
    g_test_add_data_func("/photon-file/bits/sppm", "integrator=sppm", test_same_bits);
    g_test_add_data_func("/photon-file/bits/photonmap", "integrator=photonmap",
                         test_same_bits);
    g_test_add_data_func("/photon-file/bits/one-map",
                         "one_map=on direct_illumination=off", test_same_bits);
    g_test_add_data_func("/photon-file/bits/final-gather",
                         "final_gather=on gather_rays=4", test_same_bits);
    g_test_add_func("/photon-file/all-sorts", test_all_sorts);
    g_test_add_func("/photon-file/other-camera", test_other_camera);
    g_test_add_func("/photon-file/checkpoint", test_checkpoint);
    g_test_add_func("/photon-file/foreign", test_foreign);
    g_test_add_func("/photon-file/damaged", test_damaged);
    g_test_add_func("/photon-file/nothing-to-keep", test_nothing_to_keep);
    int result = g_test_run();
    g_remove(path);
    g_rmdir(folder);
    return result;
}
