/*
 * base: errors carry their place, big allocations fail on demand, parallel loops cover
 * each element once whatever the number of threads.
 */
#include "base/error.h"
#include "base/intern.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/printable.h"

#include <stdint.h>

static void test_error_names_its_place(void)
{
    g_autoptr(GError) error = NULL;
    error_at(&error, (source_place){"box.pbrt", 7, 3}, "expected %s", "a number");
    g_assert_error(error, NEPH_ERROR, ERROR_INPUT);
    g_assert_cmpstr(error->message, ==, "box.pbrt:7:3: expected a number");
}

static void test_printable(void)
{
    static const char *const cases[][2] = {
        {"", ""},
        {"plain \"text\" \\ 1", "plain \"text\" \\ 1"},
        {"gl\303\244sern \346\227\245\346\234\254 \360\237\230\200",
         "gl\303\244sern \346\227\245\346\234\254 \360\237\230\200"},
        {"\033[31m", "\\x1b[31m"},
        {"a\nb\tc\rd", "a\\nb\\tc\\x0dd"},
        {"\177", "\\x7f"},
        {"\302\233", "\\u009b"},
        {"\342\200\250\342\200\256", "\\u2028\\u202e"},
        {"\377\303", "\\xff\\xc3"},
        {"\340\200\200", "\\xe0\\x80\\x80"}, /* zero, written too long */
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autofree char *once = printable(cases[i][0]), *twice = printable(once);
        g_assert_cmpstr(once, ==, cases[i][1]);
        g_assert_cmpstr(twice, ==, once);
    }
}

static void test_allocation_is_aligned_and_zeroed(void)
{
    for (size_t n = 0; n < 300; n += 37) {
        unsigned char *a = big_alloc(n, 1, "bytes", NULL);
        g_assert_nonnull(a);
        g_assert_cmpuint((uintptr_t)a % 64, ==, 0);
        for (size_t i = 0; i < n; i++)
            g_assert_cmpuint(a[i], ==, 0);
        big_free(a);
    }
}

static void test_allocation_refuses(void)
{
    g_autoptr(GError) overflow = NULL;
    g_assert_null(big_alloc(SIZE_MAX / 2, 4, "photons", &overflow));
    g_assert_error(overflow, NEPH_ERROR, ERROR_FAILED);
    big_alloc_fail_at(2);
    void *first = big_alloc(1, 1, "x", NULL);
    void *second = big_alloc(1, 1, "x", NULL);
    void *third = big_alloc(1, 1, "x", NULL);
    g_assert_true(first && !second && third);
    big_free(first);
    big_free(third);
}

static void count_visits(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    unsigned char *visits = data;
    for (size_t i = begin; i < end; i++)
        visits[i]++;
}

/* More than the first tables of any pool hold; a leak checker sees what growing leaves.
 */
static void test_interned_are_kept_once(void)
{
    const char *first[10000];
    for (int round = 0; round < 2; round++) {
        for (size_t i = 0; i < G_N_ELEMENTS(first); i++) {
            g_autofree char *text = g_strdup_printf("kept-%zu", i);
            const char *kept = intern(text);
            g_assert_cmpstr(kept, ==, text);
            g_assert_true(kept != text);
            if (round == 0)
                first[i] = kept;
            g_assert_true(first[i] == kept);
        }
    }
    g_assert_null(intern(NULL));
}

static void test_parallel_visits_each_once(void)
{
    for (unsigned threads = 1; threads <= 4; threads++) {
        unsigned char visits[1001] = {0};
        g_assert_true(parallel_for(1001, 10, threads, NULL, count_visits, visits));
        for (size_t i = 0; i < 1001; i++)
            g_assert_cmpuint(visits[i], ==, 1);
    }
}

/* Loops in a loop are whole, on the thread that asks for them. */
static void loop_within(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)end, (void)thread;
    unsigned char(*visits)[64] = data;
    g_assert_true(parallel_for(64, 4, 4, NULL, count_visits, visits[begin]));
}

static void test_parallel_within_another(void)
{
    unsigned char visits[32][64] = {0};
    g_assert_true(parallel_for(32, 1, 4, NULL, loop_within, visits));
    for (size_t i = 0; i < sizeof visits; i++)
        g_assert_cmpuint(visits[i / 64][i % 64], ==, 1);
}

enum { AT_ONCE = 4 };

/* Chunks of a loop that go on until all of them have begun: each on a thread of its own.
 */
typedef struct meeting {
    atomic_uint n_there, seen;
} meeting;

static void meet(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)begin, (void)end;
    meeting *m = data;
    gint64 limit = g_get_monotonic_time() + 20 * G_USEC_PER_SEC;
    atomic_fetch_or(&m->seen, 1u << thread);
    atomic_fetch_add(&m->n_there, 1);
    while (atomic_load(&m->n_there) < AT_ONCE && g_get_monotonic_time() < limit)
        g_usleep(100);
}

static gpointer hold_meeting(gpointer data)
{
    parallel_for(AT_ONCE, 1, AT_ONCE, NULL, meet, data);
    return NULL;
}

/* Two loops at the same time have all their threads both, numbered from 0. */
static void test_parallel_two_at_once(void)
{
    meeting m[2] = {0};
    for (int round = 0; round < 20; round++) {
        memset(m, 0, sizeof m);
        GThread *other = g_thread_new("meeting", hold_meeting, &m[0]);
        hold_meeting(&m[1]);
        g_thread_join(other);
        for (int i = 0; i < 2; i++) {
            g_assert_cmpuint(m[i].n_there, ==, AT_ONCE);
            g_assert_cmpuint(m[i].seen, ==, (1u << AT_ONCE) - 1);
        }
    }
}

static void test_parallel_stops_when_cancelled(void)
{
    cancel_flag cancel = {.set = true};
    unsigned char visits[10] = {0};
    g_assert_false(parallel_for(10, 1, 2, &cancel, count_visits, visits));
    for (size_t i = 0; i < 10; i++)
        g_assert_cmpuint(visits[i], ==, 0);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/base/error/place", test_error_names_its_place);
    g_test_add_func("/base/printable", test_printable);
    g_test_add_func("/base/memory/aligned", test_allocation_is_aligned_and_zeroed);
    g_test_add_func("/base/memory/refuses", test_allocation_refuses);
    g_test_add_func("/base/intern", test_interned_are_kept_once);
    g_test_add_func("/base/parallel/once", test_parallel_visits_each_once);
    g_test_add_func("/base/parallel/within", test_parallel_within_another);
    g_test_add_func("/base/parallel/two-at-once", test_parallel_two_at_once);
    g_test_add_func("/base/parallel/cancel", test_parallel_stops_when_cancelled);
    return g_test_run();
}
