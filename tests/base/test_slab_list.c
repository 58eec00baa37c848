/*
 * slab_list: many lists that several threads fill at once come out whole and in order, in
 * memory that is counted while it is theirs, refused where there is none, and all given
 * back.
 */
#include "base/memory.h"
#include "base/slab_list.h"
#include "sanitizers.h"

#include <stdint.h>
#include <string.h>

enum { N_LISTS = 200, N_THREADS = 3, ODD = 24 };

/* Some are empty, some longer than a slab. */
static size_t length_of(size_t list)
{
    return list % 7 == 0 ? 0 : list == 50 ? 40000 : list * 13;
}

typedef struct odd {
    size_t list, number, twice;
} odd;

_Static_assert(sizeof(odd) == ODD, "no part of a cache line");

typedef struct line {
    _Alignas(64) size_t list;
    size_t number;
} line;

typedef struct filling {
    slab_list odds[N_LISTS], lines[N_LISTS];
    slab **slabs;
} filling;

static void fill(size_t i, size_t end, unsigned thread, void *data)
{
    (void)end;
    filling *f = data;
    for (size_t k = 0; k < length_of(i); k++) {
        odd *o = slab_list_add(&f->odds[i], sizeof *o, &f->slabs[thread], "odds", NULL);
        line *l =
            slab_list_add(&f->lines[i], sizeof *l, &f->slabs[thread], "lines", NULL);
        g_assert_true(o && l);
        g_assert_cmpuint((uintptr_t)l % 64, ==, 0);
        *o = (odd){i, k, 2 * k};
        *l = (line){i, k};
    }
}

static void fill_all(filling *f)
{
    const workers by = {.threads = N_THREADS};
    g_assert_true(slab_work(N_LISTS, 1, by, fill, f, &f->slabs, NULL));
}

typedef struct reading {
    size_t list, n;
} reading;

static void read_odds(const void *elements, size_t n, size_t at, void *data)
{
    reading *r = data;
    const odd *o = elements;
    g_assert_cmpuint(at, ==, r->n);
    for (size_t i = 0; i < n; i++, r->n++) {
        g_assert_cmpuint(o[i].list, ==, r->list);
        g_assert_cmpuint(o[i].number, ==, r->n);
        g_assert_cmpuint(o[i].twice, ==, 2 * r->n);
    }
}

static void read_lines(const void *elements, size_t n, size_t at, void *data)
{
    reading *r = data;
    const line *l = elements;
    g_assert_cmpuint(at, ==, r->n);
    for (size_t i = 0; i < n; i++, r->n++) {
        g_assert_cmpuint(l[i].list, ==, r->list);
        g_assert_cmpuint(l[i].number, ==, r->n);
    }
}

static void move(slab_list *list, size_t i, slab_visit visit)
{
    reading r = {i, 0};
    g_assert_cmpuint(list->n, ==, length_of(i));
    slab_list_move(list, visit, &r);
    g_assert_cmpuint(r.n, ==, length_of(i));
    g_assert_cmpuint(list->n, ==, 0);
    g_assert_null(list->first);
}

static void test_order(void)
{
    static filling f;
    size_t left = memory_left();
    fill_all(&f);
    g_assert_cmpuint(memory_left(), <, left);
    for (size_t i = 0; i < N_LISTS; i++) {
        move(&f.odds[i], i, read_odds);
        if (i % 2)
            slab_list_uncount(&f.lines[i]);
        move(&f.lines[i], i, read_lines);
    }
    g_assert_cmpuint(memory_left(), ==, left);
}

/* What is counted is what there is, to a piece a list, and is not counted twice. */
static void test_counted(void)
{
    enum { N = 100000, MOST_MORE = 8192 };
    slab_list list = {0};
    slab *from = NULL;
    size_t left = memory_left(), resident = memory_resident();
    for (size_t i = 0; i < N; i++)
        memset(slab_list_add(&list, 64, &from, "lines", NULL), 7, 64);
    size_t counted = left - memory_left();
    g_assert_cmpuint(counted, >=, N * 64);
    g_assert_cmpuint(counted, <=, N * 64 * 65 / 63 + MOST_MORE);
    g_assert_cmpuint(memory_resident() - resident, >=, N * 64 / 2);
    slab_list_uncount(&list);
    g_assert_cmpuint(memory_left(), ==, left);
    slab_list_clear(&list);
    slab_close(from);
    g_assert_cmpuint(memory_left(), ==, left);
    if (!MEMORY_IS_WATCHED) /* and given back */
        g_assert_cmpuint(memory_resident(), <, resident + N * 64 / 4);
}

/* Threads that store little take little, on huge pages or small ones. */
static void test_few(void)
{
    enum { N_SLABS = 8, MOST = 1 << 20 };
    slab_list lists[N_SLABS] = {0};
    slab *from[N_SLABS] = {0};
    size_t resident = memory_resident();
    for (size_t i = 0; i < N_SLABS; i++)
        memset(slab_list_add(&lists[i], 64, &from[i], "lines", NULL), 7, 64);
    if (!MEMORY_IS_WATCHED)
        g_assert_cmpuint(memory_resident() - resident, <, MOST);
    for (size_t i = 0; i < N_SLABS; i++) {
        slab_list_clear(&lists[i]);
        slab_close(from[i]);
    }
}

static void test_refused(void)
{
    GError *error = NULL;
    slab_list list = {0};
    slab *from = NULL;
    memory_set_limit(1 << 20);
    size_t left = memory_left();
    while (slab_list_add(&list, 64, &from, "too many", &error))
        g_assert_cmpuint(list.n, <, 1 << 14);
    g_assert_error(error, NEPH_ERROR, ERROR_FAILED);
    g_assert_nonnull(strstr(error->message, "too many"));
    g_clear_error(&error);
    g_assert_cmpuint(list.n * 64, >, 9 * left / 10);
    slab_list_clear(&list);
    g_assert_cmpuint(memory_left(), ==, left);
    memory_set_limit(0);
    slab_close(from);
    from = NULL;
    big_alloc_fail_at(1);
    g_assert_null(slab_list_add(&list, 64, &from, "none", &error));
    g_assert_error(error, NEPH_ERROR, ERROR_FAILED);
    g_clear_error(&error);
    g_assert_null(from);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/slab-list/order", test_order);
    g_test_add_func("/slab-list/counted", test_counted);
    g_test_add_func("/slab-list/few", test_few);
    g_test_add_func("/slab-list/refused", test_refused);
    return g_test_run();
}
