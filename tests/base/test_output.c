/*
 * base/json and base/output: what is written is JSON whatever is put in, numbers read
 * back to the same, and files are whole or not there.
 */
#include "base/json.h"
#include "base/memory.h"
#include "base/output.h"
#include "folder.h"
#include "json_check.h"

#include <glib/gstdio.h>
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char *folder;

static void test_checker_refuses(void)
{
    static const char *const bad[] = {"",    "{",       "[1,]",     "{\"a\" 1}",
                                      "nan", "01",      "\"a\nb\"", "[1] x",
                                      "1.",  "\"\\x\"", "'a'",      "{1:2}"};
    for (size_t i = 0; i < G_N_ELEMENTS(bad); i++)
        g_assert_false(json_is_valid(bad[i]));
    g_assert_true(json_is_valid(" {\"a\": [1, -2.5e-3, {}, []], \"b\\\"\": null}\n"));
}

static void test_json_is_json(void)
{
    json j = {0};
    json_object_begin(&j, NULL);
    json_string(&j, "quote \" back \\ line \n bell \a", "\xff\xfe caf\xc3\xa9 \x7f");
    json_string(&j, "none", NULL);
    json_number(&j, "nan", (double)NAN);
    json_number(&j, "infinity", -(double)INFINITY);
    json_integer(&j, "least", INT64_MIN);
    json_count(&j, "most", UINT64_MAX);
    json_bool(&j, "yes", true);
    json_array_begin(&j, "empty");
    json_array_end(&j);
    json_array_begin(&j, "list");
    json_object_begin(&j, NULL);
    json_object_end(&j);
    json_number(&j, NULL, 0.1);
    json_array_end(&j);
    json_floats(&j, "row", (const float[]){100.0f, 0.1f, NAN}, 3);
    json_object_end(&j);
    g_autofree char *text = json_finish(&j);
    g_test_message("%s", text);
    g_assert_true(json_is_valid(text));
    g_assert_nonnull(strstr(text, "\"nan\": null"));
    g_assert_nonnull(strstr(text, "\"most\": 18446744073709551615"));
    g_assert_nonnull(strstr(text, "\"row\": [100, 0.1, null]"));
}

static void test_numbers_come_back(void)
{
    const char *locale = setlocale(LC_NUMERIC, "de_DE.UTF-8");
    g_test_message("locale %s", locale ? locale : "C");
    GRand *random = g_rand_new_with_seed(7);
    for (int i = 0; i < 10000; i++) {
        union {
            uint64_t bits;
            double value;
        } in = {.bits = (uint64_t)g_rand_int(random) << 32 | g_rand_int(random)};
        if (!isfinite(in.value))
            continue;
        char buffer[G_ASCII_DTOSTR_BUF_SIZE];
        number_text(in.value, buffer);
        double back = g_ascii_strtod(buffer, NULL);
        g_assert_cmpmem(&back, sizeof back, &in.value, sizeof in.value);
        g_assert_null(strchr(buffer, ','));
    }
    char buffer[G_ASCII_DTOSTR_BUF_SIZE];
    static const struct {
        double value;
        const char *text;
    } cases[] = {{0.1, "0.1"},           {100.0, "100"},       {-300.0, "-300"},
                 {123456.7, "123456.7"}, {999999.0, "999999"}, {1e6, "1000000"},
                 {1e15, "1e+15"},        {0.0, "0"},           {1e-5, "1e-05"}};
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++)
        g_assert_cmpstr(number_text(cases[i].value, buffer), ==, cases[i].text);
    g_rand_free(random);
    setlocale(LC_NUMERIC, "C");
}

static void test_output_is_whole_or_absent(void)
{
    g_autofree char *path = g_build_filename(folder, "a.txt", NULL);
    output *out = output_open(path, NULL);
    fputs("half", output_stream(out));
    g_assert_false(g_file_test(path, G_FILE_TEST_EXISTS));
    output_discard(out);
    g_assert_cmpuint(n_files_in(folder), ==, 0);

    g_assert_true(output_write_text(path, "one", NULL));
    out = output_open(path, NULL);
    fputs("two", output_stream(out));
    g_autofree char *before = NULL;
    g_file_get_contents(path, &before, NULL, NULL);
    g_assert_cmpstr(before, ==, "one");
    g_assert_true(output_commit(out, NULL));
    g_autofree char *after = NULL;
    g_file_get_contents(path, &after, NULL, NULL);
    g_assert_cmpstr(after, ==, "two");
    g_assert_cmpuint(n_files_in(folder), ==, 1);
    g_remove(path);
}

static void test_output_keeps_links_and_umask(void)
{
    g_autofree char *path = g_build_filename(folder, "real.txt", NULL);
    g_autofree char *link = g_build_filename(folder, "link.txt", NULL);
    mode_t old = umask(027);
    g_assert_true(output_write_text(path, "one", NULL));
    umask(old);
    struct stat info;
    g_assert_cmpint(stat(path, &info), ==, 0);
    g_assert_cmpint(info.st_mode & 0777, ==, 0640);
    g_assert_cmpint(symlink("real.txt", link), ==, 0);
    g_assert_true(output_write_text(link, "two", NULL));
    g_assert_true(g_file_test(link, G_FILE_TEST_IS_SYMLINK));
    g_autofree char *text = NULL;
    g_file_get_contents(path, &text, NULL, NULL);
    g_assert_cmpstr(text, ==, "two");
    g_remove(link);
    g_remove(path);
}

static mode_t mode_of(const char *path)
{
    struct stat info;
    g_assert_cmpint(stat(path, &info), ==, 0);
    return info.st_mode & 07777;
}

/* Also while it is being written. */
static void test_output_keeps_permissions(void)
{
    static const mode_t modes[] = {0600, 0640, 0400, 0644, 0666, 0755};
    g_autofree char *path = g_build_filename(folder, "private.txt", NULL);
    mode_t old = umask(022);
    for (size_t i = 0; i < G_N_ELEMENTS(modes); i++) {
        g_assert_true(output_write_text(path, "one", NULL));
        g_assert_cmpint(mode_of(path), ==, i == 0 ? 0644 : modes[i - 1]);
        g_assert_cmpint(chmod(path, modes[i]), ==, 0);
        output *out = output_open(path, NULL);
        g_assert_nonnull(out);
        struct stat info;
        g_assert_cmpint(fstat(fileno(output_stream(out)), &info), ==, 0);
        g_assert_cmpint(info.st_mode & 07777, ==, modes[i]);
        fputs("two", output_stream(out));
        g_assert_true(output_commit(out, NULL));
        g_assert_cmpint(mode_of(path), ==, modes[i]);
    }
    umask(old);
    g_remove(path);
}

/* Only root may give files away; others keep their own. */
static void test_output_keeps_owner(void)
{
    if (geteuid() != 0) {
        g_test_skip("needs root");
        return;
    }
    g_autofree char *path = g_build_filename(folder, "owned.txt", NULL);
    g_assert_true(output_write_text(path, "one", NULL));
    g_assert_cmpint(chown(path, 65534, 65534), ==, 0);
    g_assert_true(output_write_text(path, "two", NULL));
    struct stat info;
    g_assert_cmpint(stat(path, &info), ==, 0);
    g_assert_cmpuint(info.st_uid, ==, 65534);
    g_assert_cmpuint(info.st_gid, ==, 65534);
    g_remove(path);
}

static void test_output_refuses(void)
{
    const char *const bad[] = {"/nowhere/at/all.txt", folder, ""};
    for (size_t i = 0; i < G_N_ELEMENTS(bad); i++) {
        g_autoptr(GError) error = NULL;
        g_assert_false(output_possible(bad[i], &error));
        g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
        g_assert_nonnull(strstr(error->message, "cannot write"));
    }
    g_autofree char *good = g_build_filename(folder, "good", NULL);
    g_assert_true(output_possible(good, NULL));
    g_assert_cmpuint(n_files_in(folder), ==, 0);
}

static void test_output_reports_a_full_disk(void)
{
    if (!g_file_test("/dev/full", G_FILE_TEST_EXISTS)) {
        g_test_skip("no /dev/full here");
        return;
    }
    g_autoptr(GError) error = NULL;
    g_assert_false(output_write_text("/dev/full", "x", &error));
    g_assert_error(error, NEPH_ERROR, ERROR_FAILED);
}

/* What was committed stays, what was not goes, closed or open. */
static void test_output_abandons(void)
{
    g_autofree char *whole = g_build_filename(folder, "whole", NULL);
    output *open[3];
    for (int i = 0; i < 3; i++) {
        g_autofree char *name = g_strdup_printf("%d", i);
        g_autofree char *path = g_build_filename(folder, name, NULL);
        open[i] = output_open(path, NULL);
        fputs("half", output_stream(open[i]));
    }
    g_assert_true(output_write_text(whole, "whole", NULL));
    g_assert_true(output_close(open[1], NULL));
    g_assert_cmpuint(n_files_in(folder), ==, 4);
    output_abandon_all();
    g_assert_cmpuint(n_files_in(folder), ==, 1);
    for (int i = 0; i < 3; i++)
        output_discard(open[i]);
    g_assert_true(output_write_text(whole, "again", NULL));
    g_assert_cmpuint(n_files_in(folder), ==, 1);
    g_remove(whole);
}

static void test_output_spares(void)
{
    g_autofree char *a = g_build_filename(folder, "a", NULL);
    g_autofree char *b = g_build_filename(folder, "b", NULL);
    g_autofree char *soft = g_build_filename(folder, "soft", NULL);
    g_autofree char *hard = g_build_filename(folder, "hard", NULL);
    g_autofree char *around = g_build_filename(folder, ".", "a", NULL);
    g_assert_true(output_write_text(a, "a", NULL));
    g_assert_cmpint(symlink("a", soft), ==, 0);
    g_assert_cmpint(link(a, hard), ==, 0);
    const char *const same[] = {a, soft, hard, around};
    const char *const inputs[] = {"/dev/null", "/nowhere/at/all", a, NULL};
    for (size_t i = 0; i < G_N_ELEMENTS(same); i++) {
        g_autoptr(GError) error = NULL;
        g_assert_false(output_spares(same[i], inputs, &error));
        g_assert_error(error, NEPH_ERROR, ERROR_USAGE);
        g_assert_nonnull(strstr(error->message, same[i]));
    }
    g_assert_true(output_spares(b, inputs, NULL));
    g_assert_true(output_spares("/dev/null", inputs, NULL));
    g_assert_true(output_spares(a, NULL, NULL));
    const char *const missing[] = {b, NULL};
    g_autofree char *around_b =
        g_build_filename(folder, "..", strrchr(folder, '/'), "b", NULL);
    g_assert_false(output_spares(around_b, missing, NULL));
    g_remove(a);
    g_remove(soft);
    g_remove(hard);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder = g_dir_make_tmp("nephroid-output-XXXXXX", NULL);
    g_test_add_func("/json/checker", test_checker_refuses);
    g_test_add_func("/json/valid", test_json_is_json);
    g_test_add_func("/json/numbers", test_numbers_come_back);
    g_test_add_func("/output/whole", test_output_is_whole_or_absent);
    g_test_add_func("/output/links", test_output_keeps_links_and_umask);
    g_test_add_func("/output/permissions", test_output_keeps_permissions);
    g_test_add_func("/output/owner", test_output_keeps_owner);
    g_test_add_func("/output/refuses", test_output_refuses);
    g_test_add_func("/output/abandons", test_output_abandons);
    g_test_add_func("/output/spares", test_output_spares);
    g_test_add_func("/output/full", test_output_reports_a_full_disk);
    int result = g_test_run();
    g_rmdir(folder);
    g_free(folder);
    return result;
}
