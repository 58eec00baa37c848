/*
 * settings: every row reads back what it writes, keeps its range, and answers to the
 * names that the literature gave it; files of settings name the place of an error.
 */
#include "settings/settings.h"

#include <glib/gstdio.h>
#include <math.h>
#include <string.h>

static void set(settings *s, const char *name, const char *value)
{
    g_autoptr(GError) error = NULL;
    bool done = settings_set(s, name, value, &error);
    g_assert_no_error(error);
    g_assert_true(done);
}

static void refuse(const char *name, const char *value, const char *message)
{
    settings s = settings_default(), before = s;
    g_autoptr(GError) error = NULL;
    g_assert_false(settings_set(&s, name, value, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_USAGE);
    g_assert_cmpstr(error->message, ==, message);
    g_assert_cmpmem(&s, sizeof s, &before, sizeof before);
}

static void test_rows_are_whole(void)
{
    size_t n;
    const setting_row *rows = settings_table(&n);
    for (size_t i = 0; i < n; i++) {
        if (rows[i].low > rows[i].initial && !rows[i].words) /* it stands apart: none */
            g_assert_cmpfloat(fabs(rows[i].initial), <=, 0.0);
        g_assert_cmpfloat(rows[i].initial, <=, rows[i].high);
        g_assert_true(g_str_has_suffix(rows[i].doc, "."));
        g_assert_cmpint((int)strlen(rows[i].users), >, 0);
        bool chosen = rows[i].type == SETTING_CHOICE;
        bool named = rows[i].type == SETTING_COUNT && rows[i].initial < rows[i].low;
        g_assert_true(rows[i].words ? chosen || named : !chosen);
        if (chosen)
            g_assert_cmpuint(g_strv_length((char **)rows[i].words), >=,
                             (guint)rows[i].high + 1);
    }
}

static void test_names_are_unique(void)
{
    size_t n;
    const setting_row *rows = settings_table(&n);
    g_autoptr(GHashTable) seen =
        g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    for (size_t i = 0; i < n; i++) {
        g_autofree char *names = g_strconcat(rows[i].name, " ", rows[i].aliases, NULL);
        g_auto(GStrv) words = g_strsplit(g_strstrip(names), " ", -1);
        for (size_t k = 0; words[k]; k++) {
            char *key = g_ascii_strdown(words[k], -1);
            const setting_row *other = g_hash_table_lookup(seen, key);
            g_assert_true(!other || other == &rows[i]);
            g_hash_table_insert(seen, key, (gpointer)&rows[i]);
            g_assert_true(settings_find(words[k]) == &rows[i]);
        }
    }
    g_assert_null(settings_find(""));
    g_assert_null(settings_find("Passes"));
    g_assert_true(settings_find("PHOTONRADIUS") == settings_find("radius"));
}

static void test_text_round_trip(void)
{
    size_t n;
    const setting_row *rows = settings_table(&n);
    for (size_t i = 0; i < n; i++) {
        double values[] = {rows[i].low, rows[i].high, rows[i].initial};
        for (size_t k = 0; k < 3; k++) {
            char number[G_ASCII_DTOSTR_BUF_SIZE];
            const char *given = rows[i].type == SETTING_CHOICE
                                    ? rows[i].words[(int)values[k]]
                                    : g_ascii_dtostr(number, sizeof number, values[k]);
            settings a = settings_default(), b = settings_default();
            set(&a, rows[i].name, given);
            g_autofree char *text = settings_get(&a, &rows[i]);
            set(&b, rows[i].name, text);
            g_assert_cmpmem(&a, sizeof a, &b, sizeof b);
        }
    }
}

static void test_default_is_the_table(void)
{
    settings s = settings_default();
    g_assert_cmpint(s.integrator, ==, INTEGRATOR_AUTO);
    g_assert_cmpint(settings_most_passes(&s), ==, 16);
    g_assert_cmpint(s.spp, ==, 4);
    g_assert_cmpint(s.max_forward_bounces, ==, -1);
    g_assert_true(s.direct_illumination && s.shadow_rays && !s.final_gather);
    g_assert_cmpint(s.photon_map, ==, MAP_AUTO);
    g_assert_cmpint(s.class_kernel[2], ==, KERNEL_EPANECHNIKOV);
    g_assert_cmpint(s.class_emission[2], ==, EMISSION_GUIDED);
    g_assert_true(fabs(s.alpha - 2.0 / 3.0) < 1e-15);
}

static void test_sppm_is_a_preset(void)
{
    settings s = settings_default(), expected = settings_default();
    set(&s, "indirect_nearest", "100");
    set(&s, "final_gather", "on");
    set(&s, "integrator", "path");
    set(&s, "radius", "0.5");
    set(&s, "integrator", "sppm");
    expected.integrator = INTEGRATOR_PHOTONMAP;
    expected.spp = 1;
    expected.radius = 0.5;
    expected.given = s.given; /* what was said differs, not what holds */
    g_assert_cmpmem(&s, sizeof s, &expected, sizeof expected);
}

static void test_values(void)
{
    settings s = settings_default();
    set(&s, "photons", "1e6");
    g_assert_cmpint(s.photons, ==, 1000000);
    set(&s, "radius", " 0.25 ");
    g_assert_cmpfloat(s.radius, ==, 0.25);
    set(&s, "final_gather", "on");
    set(&s, "shadow_rays", "No");
    g_assert_true(s.final_gather && !s.shadow_rays);
    set(&s, "indirect_kernel", "gaussian");
    g_assert_cmpint(s.class_kernel[1], ==, KERNEL_GAUSSIAN);
    set(&s, "caustic_nearest", "50");
    g_assert_cmpint(s.class_nearest[2], ==, 50);
}

static void test_names_of_the_seeds(void)
{
    settings s = settings_default();
    set(&s, "maxForwardBounces", "3");
    set(&s, "maxBackwardBounces", "4");
    set(&s, "numEmitted", "1234");
    set(&s, "photonRadius", "0.5");
    set(&s, "CAUSTIC_PHOTONS_PER_LIGHT", "77");
    set(&s, "INDIRECT_NEARBY_PHOTONS", "88");
    set(&s, "MULTIPLE_SAMPLES", "false");
    g_assert_cmpint(s.max_forward_bounces, ==, 2);  /* it counts hits */
    g_assert_cmpint(s.max_backward_bounces, ==, 5); /* it leaves out the last */
    g_assert_cmpint(s.photons, ==, 1234);
    g_assert_cmpfloat(s.passes, ==, 1.0); /* so many in all */
    g_assert_cmpfloat(s.radius, ==, 0.5);
    g_assert_cmpint(s.class_photons[2], ==, 77);
    g_assert_true(s.photons_per_light);
    g_assert_cmpint(s.class_nearest[1], ==, 88);
    g_assert_false(s.multiple_samples);
    set(&s, "MAX_PHOTON_BOUNCES", "9");
    g_assert_cmpint(s.max_forward_bounces, ==, 9);
}

/* Their numbers bound ours. */
static void test_ends_of_the_seeds_names(void)
{
    settings s = settings_default();
    set(&s, "maxForwardBounces", "1");
    g_assert_cmpint(s.max_forward_bounces, ==, 0);
    set(&s, "maxForwardBounces", "unlimited");
    g_assert_cmpint(s.max_forward_bounces, ==, -1);
    set(&s, "maxForwardBounces", "1000001");
    g_assert_cmpint(s.max_forward_bounces, ==, 1000000);
    set(&s, "MAXBACKWARDBOUNCES", "0");
    g_assert_cmpint(s.max_backward_bounces, ==, 1);
    set(&s, "maxBackwardBounces", "-1");
    g_assert_cmpint(s.max_backward_bounces, ==, -1);
    set(&s, "DIRECT_PHOTONS_PER_LIGHT", "1e6");
    g_assert_cmpint(s.class_photons[0], ==, 1000000);
    refuse("maxForwardBounces", "0",
           "setting 'maxForwardBounces': expected unlimited or a whole number from 1 to "
           "1000001; with 0 no photon would be stored, found '0'");
    refuse("maxBackwardBounces", "1000000",
           "setting 'maxBackwardBounces': expected unlimited or a whole number from 0 to "
           "999999, found '1000000'");
    refuse("numEmitted", "0",
           "setting 'numEmitted': expected a whole number from 1 to 1000000000000 "
           "photons/pass; with 0 no photon would be stored, found '0'");
    refuse("numEmitted", "2.5",
           "setting 'numEmitted': expected a whole number from 1 to 1000000000000 "
           "photons/pass; with 0 no photon would be stored, found '2.5'");
}

static void test_render_mode(void)
{
    settings s = settings_default();
    set(&s, "RENDERMODE", "PHOTONMAP");
    g_assert_cmpint(s.integrator, ==, INTEGRATOR_PHOTONMAP);
    set(&s, "RenderMode", "MonteCarlo");
    g_assert_cmpint(s.integrator, ==, INTEGRATOR_PATH);
    refuse("RENDERMODE", "WHITTED",
           "setting 'RENDERMODE': expected PHOTONMAP or MONTECARLO, found 'WHITTED'");
}

/* What is not read is as if it had not been said. */
static void test_forgets_what_is_not_read(void)
{
    settings s = settings_default(), expected = s;
    set(&s, "one_map", "true");
    set(&s, "photon_lobes", "diffuse");
    set(&s, "final_gather", "true");
    set(&s, "spp", "9");
    settings_forget_unread(&s);
    expected.given = s.given;
    expected.spp = 9;
    g_assert_cmpmem(&s, sizeof s, &expected, sizeof expected);
    set(&s, "integrator", "photonmap");
    set(&s, "one_map", "true");
    settings_forget_unread(&s);
    g_assert_true(s.one_map);
    g_assert_true(settings_one_map(&s));
    set(&s, "final_gather", "true");
    g_assert_false(settings_one_map(&s));
}

/* What stands apart from the numbers may have a name, which is what is written. */
static void test_words_of_counts(void)
{
    static const char *const names[] = {"max_backward_bounces", "max_forward_bounces"};
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        settings s = settings_default(), expected = s;
        g_autofree char *initial = settings_get(&s, settings_find(names[i]));
        g_assert_cmpstr(initial, ==, "unlimited");
        set(&s, names[i], "0");
        g_autofree char *none = settings_get(&s, settings_find(names[i]));
        g_assert_cmpstr(none, ==, "0");
        set(&s, names[i], " unlimited ");
        expected.given = s.given; /* what was said differs, not what holds */
        g_assert_cmpmem(&s, sizeof s, &expected, sizeof expected);
        set(&s, names[i], "7");
        set(&s, names[i], "-1");
        g_assert_cmpmem(&s, sizeof s, &expected, sizeof expected);
    }
    g_assert_cmpint(settings_default().max_backward_bounces, ==, -1);
    refuse("max_forward_bounces", "-2",
           "setting 'max_forward_bounces': expected unlimited or a whole number from 0 "
           "to 1000000, found '-2'");
    refuse("maxdepth", "unlimited",
           "setting 'maxdepth': expected a whole number from 0 to 1000000, found "
           "'unlimited'");
    refuse("passes", "unlimited",
           "setting 'passes': expected a number from 0 to 1000000000, found "
           "'unlimited'");
}

static void test_cone_alias_chooses_the_kernel(void)
{
    settings s = settings_default();
    set(&s, "CAUSTICS_CONE_FILTER_PARAM", "1.5");
    g_assert_cmpint(s.class_kernel[2], ==, KERNEL_CONE);
    g_assert_cmpfloat(s.class_cone_k[2], ==, 1.5);
    set(&s, "CAUSTICS_CONE_FILTER_PARAM", "0");
    g_assert_cmpint(s.class_kernel[2], ==, KERNEL_CONSTANT);
    g_assert_cmpint(s.class_kernel[0], ==, KERNEL_EPANECHNIKOV);
    set(&s, "direct_cone_k", "2");
    g_assert_cmpint(s.class_kernel[0], ==, KERNEL_EPANECHNIKOV);
}

static void test_maxdepth_bounds_both_ways(void)
{
    settings s = settings_default();
    set(&s, "maxdepth", "5");
    g_assert_cmpint(s.max_backward_bounces, ==, 5);
    g_assert_cmpint(s.max_forward_bounces, ==, 4);
    set(&s, "maxdepth", "0");
    g_assert_cmpint(s.max_forward_bounces, ==, 0);
    refuse("maxdepth", "-1",
           "setting 'maxdepth': expected a whole number from 0 to 1000000, found '-1'");
}

static void test_refusals(void)
{
    refuse("pases", "3",
           "expected a setting's name, found 'pases'; did you mean 'passes'?");
    refuse("xyzzy", "3", "expected a setting's name, found 'xyzzy'");
    refuse("passes", "-1",
           "setting 'passes': expected a number from 0 to 1000000000, found '-1'");
    refuse("spp", "2.5",
           "setting 'spp': expected a whole number from 1 to 65536 samples/pixel, found "
           "'2.5'");
    refuse("caustic_nearest", "1",
           "setting 'caustic_nearest': expected 0 or a whole number from 2 to 10000000 "
           "photons, found '1'");
    refuse("radius", "nan",
           "setting 'radius': expected a number from 0 to 1000000000000 m, found 'nan'");
    refuse("radius", "inf",
           "setting 'radius': expected a number from 0 to 1000000000000 m, found 'inf'");
    refuse("radius", "0x10",
           "setting 'radius': expected a number from 0 to 1000000000000 m, found '0x10'");
    refuse("radius", "1,5",
           "setting 'radius': expected a number from 0 to 1000000000000 m, found '1,5'");
    refuse("radius", "",
           "setting 'radius': expected a number from 0 to 1000000000000 m, found ''");
    refuse("final_gather", "perhaps",
           "setting 'final_gather': expected true or false, found 'perhaps'");
    refuse(
        "photon_map", "octree",
        "setting 'photon_map': expected one of list, kdtree, grid, auto, found 'octree'");
    refuse("direct_cone_k", "0.5",
           "setting 'direct_cone_k': expected a number from 1 to 1000000, found '0.5'");
}

/** Writes text to a file of its own and loads it; *path is where it lay. */
static bool load(const char *text, settings *s, char **path, GError **error)
{
    int fd = g_file_open_tmp("nephroid-settings-XXXXXX", path, NULL);
    g_assert_cmpint(fd, >=, 0);
    g_close(fd, NULL);
    g_assert_true(g_file_set_contents(*path, text, -1, NULL));
    bool loaded = settings_load(s, *path, error);
    g_unlink(*path);
    return loaded;
}

static void test_load(void)
{
    settings s = settings_default();
    g_autofree char *path = NULL;
    g_autoptr(GError) error = NULL;
    bool loaded = load("# a note\n\n passes = 3 # three\r\nphoton_map=kdtree\n"
                       "CAUSTIC_NEARBY_PHOTONS = 60",
                       &s, &path, &error);
    g_assert_no_error(error);
    g_assert_true(loaded);
    g_assert_cmpint(s.passes, ==, 3);
    g_assert_cmpint(s.photon_map, ==, MAP_KDTREE);
    g_assert_cmpint(s.class_nearest[2], ==, 60);
}

static void load_refuses(const char *text, const char *message)
{
    settings s = settings_default(), before = s;
    g_autofree char *path = NULL;
    g_autoptr(GError) error = NULL;
    g_assert_false(load(text, &s, &path, &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_autofree char *whole = g_strconcat(path, message, NULL);
    g_assert_cmpstr(error->message, ==, whole);
    g_assert_cmpmem(&s, sizeof s, &before, sizeof before);
}

static void test_load_names_the_place(void)
{
    load_refuses(
        "passes = 3\n  photns = 4\n",
        ":2:3: expected a setting's name, found 'photns'; did you mean 'photons'?");
    load_refuses("passes 3\n", ":1:1: expected name = value, found no '='");
    load_refuses("passes = 3\nspp =  x\n",
                 ":2:8: setting 'spp': expected a whole number from 1 to 65536 "
                 "samples/pixel, found 'x'");
    settings s = settings_default();
    g_autoptr(GError) error = NULL;
    g_assert_false(settings_load(&s, "/nowhere/at/all", &error));
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_true(g_str_has_prefix(error->message, "/nowhere/at/all: cannot read"));
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/settings/rows-are-whole", test_rows_are_whole);
    g_test_add_func("/settings/names-are-unique", test_names_are_unique);
    g_test_add_func("/settings/text-round-trip", test_text_round_trip);
    g_test_add_func("/settings/default-is-the-table", test_default_is_the_table);
    g_test_add_func("/settings/values", test_values);
    g_test_add_func("/settings/names-of-the-seeds", test_names_of_the_seeds);
    g_test_add_func("/settings/ends-of-the-seeds-names", test_ends_of_the_seeds_names);
    g_test_add_func("/settings/render-mode", test_render_mode);
    g_test_add_func("/settings/forgets-what-is-not-read", test_forgets_what_is_not_read);
    g_test_add_func("/settings/words-of-counts", test_words_of_counts);
    g_test_add_func("/settings/cone-alias", test_cone_alias_chooses_the_kernel);
    g_test_add_func("/settings/maxdepth", test_maxdepth_bounds_both_ways);
    g_test_add_func("/settings/refusals", test_refusals);
    g_test_add_func("/settings/load", test_load);
    g_test_add_func("/settings/load-names-the-place", test_load_names_the_place);
    g_test_add_func("/settings/sppm", test_sppm_is_a_preset);
    return g_test_run();
}
