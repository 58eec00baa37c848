/*
 * checkpoint: a render that is cut off and goes on elsewhere gives the same bits, and a
 * file that is not what it was, or of something else, is refused with the reason.
 */
#include "base/memory.h"
#include "render/film/film_planes.h"
#include "render/kept/checkpoint.h"
#include "rooms.h"

#include <glib/gstdio.h>
#include <string.h>

static char *folder, *path;
static const render_identity me = {(char *)"test 1", (char *)"room"};

/* With light groups and every layer a film can have. */
static view *subject(void)
{
    return view_of(ROOM_CAMERA "Film \"gbuffer\" \"integer xresolution\" 20 "
                               "\"integer yresolution\" 17\n"
                               "WorldBegin\n" ROOM_LAMP("") ROOM_WALLS GLASS_BALL);
}

static bool stop_after(double fraction, const render_statistics *st, void *data)
{
    (void)fraction;
    return st->passes < *(const int *)data;
}

/* A render by words, stopped after n passes, and then its checkpoint. */
static void leave(const view *v, const char *words, int n)
{
    g_autoptr(render) r = render_of(v, words);
    g_autoptr(GError) error = NULL;
    g_assert_false(render_run(r, stop_after, &n, NULL));
    g_assert_cmpint(render_get_statistics(r).passes, ==, n);
    g_assert_true(render_save_checkpoint(r, &me, path, &error));
    g_assert_no_error(error);
}

static render *go_on(const view *v, const char *words)
{
    g_autoptr(GError) error = NULL;
    render *r = render_of(v, words);
    g_assert_true(render_resume(r, &me, path, &error));
    g_assert_no_error(error);
    return r;
}

/* ---- The same bits ---- */

static void test_same_bits(const void *data)
{
    g_autoptr(view) v = subject();
    g_autofree char *words =
        g_strdup_printf("%s passes=5 spp=2 photons=3000", (char *)data);
    g_autofree char *one = g_strconcat(words, " threads=1", NULL);
    g_autofree char *three = g_strconcat(words, " threads=3", NULL);
    g_autoptr(image) whole = render_with(v, words);
    for (int n = 1; n < 5; n += 2) {
        leave(v, one, n);
        g_autoptr(render) r = go_on(v, three);
        g_assert_true(render_run(r, NULL, NULL, NULL));
        g_autoptr(image) picture = image_of(r);
        g_assert_cmpint(render_get_statistics(r).passes, ==, 5);
        assert_same_bits(whole, picture);
    }
}

/* More passes than were asked for at first are planned as those were; rays are counted
   on, and so is time. */
static void test_goes_further(void)
{
    g_autoptr(view) v = subject();
    leave(v, "passes=4 spp=1 photons=3000", 3);
    g_autoptr(render) first = go_on(v, "passes=4 spp=1 photons=3000");
    render_statistics before = render_get_statistics(first);
    g_autoptr(render) r = go_on(v, "passes=6 spp=1 photons=3000");
    g_assert_true(render_run(r, NULL, NULL, NULL));
    render_statistics after = render_get_statistics(r);
    g_autoptr(image) more = image_of(r);
    g_autoptr(image) whole =
        render_with(v, "passes=6 planned_passes=4 spp=1 photons=3000");
    assert_same_bits(whole, more);
    g_assert_cmpuint(before.camera_rays, >=, 3 * 20 * 17);
    g_assert_cmpuint(after.camera_rays, >=, before.camera_rays + 3 * 20 * 17);
    g_assert_cmpfloat(before.time_total, >, 0.0);
    g_assert_cmpfloat(after.time_total, >, before.time_total);
}

/* Passes dealt out to two renders, some of which have joined before, are those of one. */
static void test_dealt(const void *data)
{
    g_autoptr(view) v = subject();
    g_autofree char *words =
        g_strdup_printf("%s passes=6 spp=2 first_spp=1 photons=3000", (char *)data);
    g_autoptr(render) a = render_of(v, words), b = render_of(v, words);
    g_autoptr(image) whole = render_with(v, words);
    size_t n = render_count_sums(a);
    g_autofree double *sums = g_new(double, n);
    for (uint32_t i = 0; i < 6; i++) {
        g_assert_true(render_dealt_pass(i % 3 == 0 ? a : b, i, NULL, NULL, NULL));
        if (i != 2 && i != 5)
            continue;
        const render_statistics st = render_get_statistics(b);
        render_get_sums(b, 0, n, sums);
        render_add_sums(a, 0, n, sums);
        render_add_statistics(a, &st);
        render_forget(b);
        g_assert_cmpint(render_get_statistics(a).passes, ==, i + 1);
        g_assert_cmpint(render_get_statistics(b).passes, ==, 0);
    }
    g_autoptr(image) joined = image_of(a);
    g_assert_cmpint(joined->n_channels, ==, whole->n_channels);
    for (size_t i = 0; i < pixels_of(whole) * (size_t)whole->n_channels; i++) {
        double expected = (double)whole->pixels[i];
        double off = fabs((double)joined->pixels[i] - expected);
        g_assert_cmpfloat(off, <=, 1e-5 * fabs(expected) + 1e-6);
    }
}

/* ---- Plans of another process ---- */

/* Passes by a plan that was taken over are those of who made it, and it is not made
 * again. */
static void test_plan_taken(const void *data)
{
    g_autoptr(view) v = subject();
    g_autofree char *words =
        g_strdup_printf("%s passes=3 spp=2 first_spp=1 photons=3000", (char *)data);
    g_autoptr(render) a = render_of(v, words), b = render_of(v, words);
    g_autoptr(GBytes) plan = render_plan_bytes(a, &me, NULL);
    g_assert_nonnull(plan);
    g_assert_true(render_take_plan(b, &me, plan, NULL));
    g_assert_cmpfloat(render_get_statistics(a).time_prepare, >, 0.0);
    g_autoptr(GBytes) again = render_plan_bytes(b, &me, NULL);
    g_assert_true(g_bytes_equal(plan, again));
    for (uint32_t i = 0; i < 3; i++)
        g_assert_true(render_dealt_pass(b, i, NULL, NULL, NULL));
    g_assert_cmpfloat(render_get_statistics(b).time_prepare, <=, 0.0);
    g_autoptr(image) whole = render_with(v, words), picture = image_of(b);
    assert_same_bits(whole, picture);
}

static void refuse_plan(render *r, const render_identity *who, GBytes *plan,
                        const char *part)
{
    g_autoptr(GError) error = NULL;
    g_assert_false(render_take_plan(r, who, plan, &error));
    g_assert_true(error->domain == NEPH_ERROR);
    if (!strstr(error->message, part))
        g_error("'%s' lacks '%s'", error->message, part);
}

static GBytes *with_bit_turned(GBytes *bytes, gsize bit)
{
    gsize size;
    const guint8 *data = g_bytes_get_data(bytes, &size);
    guint8 *copy = g_memdup2(data, size);
    copy[bit / 8 % size] ^= (guint8)(1 << bit % 8);
    return g_bytes_new_take(copy, size);
}

static void test_plan_refused(void)
{
    const char *words = "integrator=auto passes=3 spp=1 photons=1000";
    g_autoptr(view) v = subject();
    g_autoptr(render) a = render_of(v, words), b = render_of(v, words),
                      c = render_of(v, "integrator=vcm passes=3 spp=1");
    g_autoptr(GBytes) plan = render_plan_bytes(a, &me, NULL);
    const render_identity other = {(char *)"test 2", me.scene},
                          elsewhere = {me.program, (char *)"hall"};
    refuse_plan(b, &other, plan, "another version");
    refuse_plan(b, &elsewhere, plan, "another scene");
    refuse_plan(c, &me, plan, "no plan of this render");
    refuse_plan(a, &me, plan, "there is one");
    g_autoptr(GRand) random = g_rand_new_with_seed(5);
    for (int i = 0; i < 200; i++) {
        gsize at = g_rand_int(random);
        g_autoptr(GBytes) turned = with_bit_turned(plan, at);
        g_autoptr(GBytes) cut =
            g_bytes_new_from_bytes(plan, 0, at % g_bytes_get_size(plan));
        refuse_plan(b, &me, turned, "damaged");
        refuse_plan(b, &me, cut, "damaged");
    }
    g_assert_true(render_take_plan(b, &me, plan, NULL)); /* still as new */
    g_assert_true(render_run(b, NULL, NULL, NULL));
    g_autoptr(image) whole = render_with(v, words), picture = image_of(b);
    assert_same_bits(whole, picture);
}

/* Of a film all is kept: each plane, as it was. */
static void test_planes(void)
{
    g_autoptr(view) v = subject();
    film a, b;
    g_assert_true(film_open(&a, v, true, NULL) && film_open(&b, v, true, NULL));
    film_plane of_a[FILM_MOST_PLANES], of_b[FILM_MOST_PLANES];
    size_t n = film_planes(&a, of_a), total = film_count_sums(&a);
    g_assert_cmpuint(film_planes(&b, of_b), ==, n);
    g_assert_cmpuint(n, >=, 2);
    g_autoptr(GRand) random = g_rand_new_with_seed(3);
    g_autofree double *numbers = g_new(double, total), *back = g_new(double, total);
    for (size_t i = 0; i < total; i++)
        numbers[i] = (double)g_rand_int_range(random, -1000, 1000);
    film_add_sums(&a, 0, total, numbers);
    film_add_sums(&b, 0, 100, numbers);
    film_add_sums(&b, 100, total - 100, numbers + 100);
    for (size_t i = 0; i < n; i++)
        g_assert_cmpmem(of_a[i].data, film_plane_bytes(&of_a[i]), of_b[i].data,
                        film_plane_bytes(&of_b[i]));
    film_add_sums(&a, 0, total, numbers);
    film_get_sums(&a, 0, 50, back);
    film_get_sums(&a, 50, total - 50, back + 50);
    for (size_t i = 0; i < total; i++)
        g_assert_cmpfloat(back[i], ==, 2.0 * numbers[i]);
    film_reset(&a);
    film_get_sums(&a, 0, total, back);
    for (size_t i = 0; i < total; i++)
        g_assert_cmpfloat(back[i], ==, 0.0);
    film_clear(&a);
    film_clear(&b);
}

/* All memory of a film is of its planes, of the pass under way or of the image to come:
   whoever gives it more lists that, or a checkpoint loses it. */
static void test_all_is_listed(void)
{
    enum { SMALL = 4096 };
    g_autoptr(view) v = subject();
    size_t left = memory_left();
    film f;
    g_assert_true(film_open(&f, v, true, NULL));
    size_t known = film_bytes(&f) + f.image_size + f.denoise_size;
    size_t taken = left - memory_left();
    g_test_message("%zu bytes, %zu known", taken, known);
    g_assert_cmpuint(taken, >=, known);
    g_assert_cmpuint(taken, <=, known + SMALL);
    film_clear(&f);
}

/* ---- What is refused ---- */

static const char asked[] = "passes=3 spp=1 photons=1000";

static void refuse(const view *v, const char *words, const render_identity *who,
                   const char *part)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(render) r = render_of(v, words);
    g_assert_false(render_resume(r, who, path, &error));
    g_test_message("%s", error->message);
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_nonnull(strstr(error->message, part));
    g_assert_cmpint(render_get_statistics(r).passes, ==, 0);
}

static void test_foreign(void)
{
    g_autoptr(view) v = subject();
    leave(v, asked, 2);
    const render_identity other = {(char *)"test 2", me.scene},
                          elsewhere = {me.program, (char *)"hall"};
    refuse(v, asked, &other, "written by test 1");
    refuse(v, asked, &elsewhere, "of another scene");
    refuse(v, "passes=3 spp=2 photons=1000", &me, "with spp = 1, not 2");
    refuse(v, "passes=3 spp=1 photons=1000 seed=4", &me, "with seed = 0, not 4");
    view_resize(v, 21, 17);
    refuse(v, asked, &me, "20x17 pixels, not 21x17");
    g_assert_true(g_file_set_contents(path, "nephroid checkpoint 2 7 0\n", -1, NULL));
    refuse(v, asked, &me, "found form '2'");
    g_assert_true(g_file_set_contents(path, "\x89PNG", -1, NULL));
    refuse(v, asked, &me, "found another file");
    g_assert_true(g_file_set_contents(path, "", -1, NULL));
    refuse(v, asked, &me, "found another file");
}

/* Cut anywhere, or with a bit turned anywhere, it is never taken for whole. */
static void test_damaged(void)
{
    g_autoptr(view) v = subject();
    leave(v, asked, 2);
    g_autofree char *bytes = NULL;
    gsize size;
    g_assert_true(g_file_get_contents(path, &bytes, &size, NULL));
    g_autoptr(render) r = render_of(v, asked);
    g_autoptr(GRand) random = g_rand_new_with_seed(8);
    for (int i = 0; i < 600; i++) {
        bool cut = i % 2 == 0, in_header = i % 4 < 2;
        gsize at = (gsize)g_rand_int_range(random, 0, in_header ? 3000 : (gint32)size);
        g_autofree char *broken = g_memdup2(bytes, size);
        broken[at] = (char)(broken[at] ^ (1 << g_rand_int_range(random, 0, 8)));
        g_assert_true(g_file_set_contents(path, broken, (gssize)(cut ? at : size), NULL));
        g_autoptr(GError) error = NULL;
        g_assert_false(render_resume(r, &me, path, &error));
        g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    }
    g_autofree char *longer = g_malloc0(size + 1);
    memcpy(longer, bytes, size);
    g_assert_true(g_file_set_contents(path, longer, (gssize)size + 1, NULL));
    refuse(v, asked, &me, "something follows");
    g_assert_true(g_file_set_contents(path, bytes, (gssize)size, NULL));
    g_assert_true(render_resume(r, &me, path, NULL)); /* after all that still as new */
    g_assert_true(render_run(r, NULL, NULL, NULL));
    g_autoptr(image) whole = render_with(v, asked), picture = image_of(r);
    assert_same_bits(whole, picture);
}

static void test_not_now(void)
{
    g_autoptr(view) v = subject();
    g_autoptr(GError) none = NULL, begun = NULL, nowhere = NULL;
    g_autoptr(render) r = render_of(v, asked);
    g_assert_false(render_save_checkpoint(r, &me, path, &none));
    g_assert_error(none, NEPH_ERROR, ERROR_USAGE);
    leave(v, asked, 1);
    g_assert_true(render_run(r, NULL, NULL, NULL));
    g_assert_false(render_resume(r, &me, path, &begun));
    g_assert_error(begun, NEPH_ERROR, ERROR_USAGE);
    g_assert_false(render_save_checkpoint(r, &me, "/nowhere/at/all", &nowhere));
    g_assert_error(nowhere, NEPH_ERROR, ERROR_INPUT);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder = g_dir_make_tmp("checkpoint-XXXXXX", NULL);
    path = g_build_filename(folder, "room.checkpoint", NULL);
    g_test_add_data_func("/checkpoint/bits/auto", "integrator=auto", test_same_bits);
    g_test_add_data_func("/checkpoint/bits/path", "integrator=path", test_same_bits);
    g_test_add_data_func("/checkpoint/bits/vcm", "integrator=vcm", test_same_bits);
    g_test_add_data_func("/checkpoint/bits/sppm", "integrator=sppm", test_same_bits);
    g_test_add_data_func("/checkpoint/bits/photonmap", "integrator=photonmap first_spp=1",
                         test_same_bits);
    g_test_add_data_func("/checkpoint/bits/final-gather",
                         "integrator=photonmap final_gather=on gather_rays=4",
                         test_same_bits);
    g_test_add_data_func("/checkpoint/dealt/auto", "integrator=auto", test_dealt);
    g_test_add_data_func("/checkpoint/dealt/vcm", "integrator=vcm", test_dealt);
    g_test_add_data_func("/checkpoint/dealt/sppm", "integrator=sppm", test_dealt);
    g_test_add_data_func("/checkpoint/plan/auto", "integrator=auto", test_plan_taken);
    g_test_add_data_func("/checkpoint/plan/path", "integrator=path", test_plan_taken);
    g_test_add_data_func("/checkpoint/plan/vcm", "integrator=vcm", test_plan_taken);
    g_test_add_data_func("/checkpoint/plan/sppm", "integrator=sppm", test_plan_taken);
    g_test_add_data_func("/checkpoint/plan/final-gather",
                         "integrator=photonmap final_gather=on gather_rays=4",
                         test_plan_taken);
    g_test_add_func("/checkpoint/plan/refused", test_plan_refused);
    g_test_add_func("/checkpoint/goes-further", test_goes_further);
    g_test_add_func("/checkpoint/planes", test_planes);
    g_test_add_func("/checkpoint/all-is-listed", test_all_is_listed);
    g_test_add_func("/checkpoint/foreign", test_foreign);
    g_test_add_func("/checkpoint/damaged", test_damaged);
    g_test_add_func("/checkpoint/not-now", test_not_now);
    int result = g_test_run();
    g_remove(path);
    g_rmdir(folder);
    return result;
}
