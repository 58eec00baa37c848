#include "base/memory.h"

#include "base/machine.h"

#include <malloc.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

enum { ALIGNMENT = 64 }; /* bytes: a cache line */

#define HUGE_PAGE ((size_t)2 << 20) /* bytes: of most systems */

#define DEFAULT_SHARE 0.8

/* ---- For tests ---- */

static atomic_uint fail_countdown;

static bool must_fail(void)
{
    unsigned left = atomic_load(&fail_countdown);
    while (left > 0) {
        if (atomic_compare_exchange_weak(&fail_countdown, &left, left - 1))
            return left == 1;
    }
    return false;
}

void big_alloc_fail_at(unsigned n)
{
    atomic_store(&fail_countdown, n);
}

unsigned big_alloc_fail_left(void)
{
    return atomic_load(&fail_countdown);
}

/* ---- The limit ---- */

static atomic_size_t used, limit /* 0: not asked for yet */;
static atomic_size_t in_arrays, asked, most_used;

void memory_set_limit(size_t bytes)
{
    atomic_store(&limit, bytes);
}

size_t memory_limit(void)
{
    size_t bytes = atomic_load(&limit);
    if (bytes > 0)
        return bytes;
    bytes = (size_t)(DEFAULT_SHARE * (double)machine_memory());
    atomic_store(&limit, bytes);
    return bytes;
}

size_t memory_left(void)
{
    size_t all = memory_limit();
    return all - MIN(atomic_load(&used), all);
}

void memory_write_size(size_t bytes, char out[MEMORY_SIZE_TEXT])
{
    static const char *const units[] = {"bytes", "KiB", "MiB", "GiB", "TiB"};
    double x = (double)bytes;
    size_t unit = 0;
    for (; x >= 1024.0 && unit + 1 < G_N_ELEMENTS(units); unit++)
        x /= 1024.0;
    g_snprintf(out, MEMORY_SIZE_TEXT, unit ? "%.1f %s" : "%.0f %s", x, units[unit]);
}

static void refuse_beside(size_t in_use, size_t bytes, const char *what, GError **error)
{
    char wanted[MEMORY_SIZE_TEXT], left[MEMORY_SIZE_TEXT], most[MEMORY_SIZE_TEXT];
    size_t all = memory_limit();
    memory_write_size(bytes, wanted);
    memory_write_size(all - MIN(in_use, all), left);
    memory_write_size(all, most);
    error_set(error, ERROR_FAILED,
              "out of memory: %s for %s, where %s are left of the limit of %s", wanted,
              what, left, most);
}

static void refuse(size_t bytes, const char *what, GError **error)
{
    refuse_beside(atomic_load(&used), bytes, what, error);
}

static void note_most(size_t now)
{
    size_t before = atomic_load(&most_used);
    while (now > before && !atomic_compare_exchange_weak(&most_used, &before, now))
        ;
}

size_t memory_most(void)
{
    return atomic_load(&most_used);
}

size_t memory_forget_most(void)
{
    size_t now = atomic_load(&used);
    atomic_store(&most_used, now);
    return now;
}

static bool reserve(size_t bytes)
{
    size_t all = memory_limit(), before = atomic_load(&used);
    do
        if (before > all || bytes > all - before)
            return false;
    while (!atomic_compare_exchange_weak(&used, &before, before + bytes));
    note_most(before + bytes);
    return true;
}

bool memory_reserve(size_t bytes, const char *what, GError **error)
{
    if (reserve(bytes))
        return true;
    refuse(bytes, what, error);
    return false;
}

void memory_count(size_t bytes)
{
    note_most(atomic_fetch_add(&used, bytes) + bytes);
}

void memory_release(size_t bytes)
{
    atomic_fetch_sub(&used, bytes);
}

/* A sanitizer has a malloc of its own. */
#ifdef __has_feature
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define SANITIZED
#endif
#elif defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__
#define SANITIZED
#endif

#ifdef SANITIZED
size_t __sanitizer_get_current_allocated_bytes(void);

static size_t allocated(void)
{
    return __sanitizer_get_current_allocated_bytes();
}
#else
static size_t allocated(void)
{
    struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
}
#endif

/* What malloc has given for other things than arrays. */
static size_t in_small_things(void)
{
    size_t all = allocated(), arrays = atomic_load(&in_arrays);
    return all - MIN(all, arrays);
}

bool memory_ask(size_t bytes, const char *what, GError **error)
{
    const size_t step = 1 << 20;
    size_t before = atomic_fetch_add(&asked, bytes);
    bool fails = must_fail();
    if (!fails && bytes < step && before / step == (before + bytes) / step)
        return true;
    size_t in_use = atomic_load(&used) + in_small_things(), all = memory_limit();
    if (!fails && in_use <= all && bytes <= all - in_use)
        return true;
    refuse_beside(in_use, bytes, what, error);
    return false;
}

/* ---- Arrays ---- */

/* From calloc, which knows which memory is zero already: a big array is then not touched
 * before it is used, nor by one thread only. Before the array stand how large it is and
 * where it begins; places are even by far, so bits are left to say whose it is. */
typedef struct array_head {
    size_t bytes;
    uintptr_t base;
} array_head;

enum {
    IS_MAPPED = 1,    /* from the system */
    IS_UNCOUNTED = 2, /* its owner counts what is used of it */
    FLAGS = IS_MAPPED | IS_UNCOUNTED,
};

/* From the system where an array is large: of what malloc is given back it keeps pieces,
   which do not fit what comes next. A sanitizer watches what comes from malloc only. */
static bool is_large(size_t bytes)
{
#ifdef SANITIZED
    return false && bytes;
#else
    enum { LARGE_ARRAY = 1 << 17 }; /* as malloc has it, until it has met larger ones */
    return bytes >= LARGE_ARRAY;
#endif
}

static bool is_mapped(const array_head *head)
{
    return head->base & IS_MAPPED;
}

static char *map(size_t bytes)
{
    return mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
}

/* From where a huge page begins: fewer faults while an array fills, which are dear where
   a system runs in another, and fewer misses of the TLB when it is read in no order. What
   is less than a huge page at its end is of small ones, so that nothing is taken that is
   not used. That pages are huge is only a hint. */
static char *map_huge(size_t bytes)
{
    size_t page = (size_t)sysconf(_SC_PAGESIZE), size = (bytes + page - 1) & ~(page - 1);
    char *base = map(size + HUGE_PAGE);
    if (base == MAP_FAILED)
        return base;
    size_t before = -(uintptr_t)base & (HUGE_PAGE - 1);
    if (before > 0)
        munmap(base, before);
    munmap(base + before + size, HUGE_PAGE - before);
    madvise(base + before, size & ~(HUGE_PAGE - 1), MADV_HUGEPAGE);
    return base + before;
}

/* There may be so many pieces of the system's and no more. @return 0: no memory */
static uintptr_t take(size_t bytes)
{
    char *base = MAP_FAILED;
    if (is_large(bytes))
        base = bytes < HUGE_PAGE ? map(bytes) : map_huge(bytes);
    if (base != MAP_FAILED)
        return (uintptr_t)base | IS_MAPPED;
    return (uintptr_t)calloc(1, bytes);
}

static void *base_of(const array_head *head)
{
    return (void *)(head->base & ~(uintptr_t)FLAGS);
}

static void give_back(const array_head *head)
{
    if (is_mapped(head))
        munmap(base_of(head), head->bytes);
    else
        free(base_of(head));
}

/* Behind room for the head. */
static void *array_of(const array_head *head)
{
    uintptr_t base = (uintptr_t)base_of(head);
    array_head *array = (array_head *)((base + ALIGNMENT) & ~(uintptr_t)(ALIGNMENT - 1));
    array[-1] = *head;
    return array;
}

/* With the head. */
static size_t bytes_for(size_t bytes)
{
    return ((bytes + ALIGNMENT) & ~(size_t)(ALIGNMENT - 1)) + ALIGNMENT;
}

/* @param total with the head, which is counted already */
static void *make_counted(size_t total, uintptr_t flags)
{
    const array_head head = {total, take(total) | flags};
    if (head.base == flags)
        return NULL;
    atomic_fetch_add(&in_arrays, is_mapped(&head) ? 0 : total);
    return array_of(&head);
}

/* @param fails as if there were no memory */
static void *make_array(size_t n, size_t size, const char *what, bool fails,
                        GError **error)
{
    size_t bytes = 0;
    bool fits = !__builtin_mul_overflow(n, size, &bytes) && bytes <= SIZE_MAX / 2;
    size_t total = bytes_for(fits ? bytes : SIZE_MAX / 2);
    if (!memory_reserve(total, what, error))
        return NULL;
    void *array = fails ? NULL : make_counted(total, 0);
    if (!array) {
        memory_release(total);
        refuse(total, what, error);
    }
    return array;
}

void *big_alloc(size_t n, size_t size, const char *what, GError **error)
{
    return make_array(n, size, what, must_fail(), error);
}

void *big_alloc_uncounted(size_t bytes, const char *what, GError **error)
{
    size_t total = bytes_for(bytes);
    void *array = must_fail() ? NULL : make_counted(total, IS_UNCOUNTED);
    if (!array)
        refuse(total, what, error);
    return array;
}

void *big_grow(void *old, size_t n_old, size_t n_new, size_t size, const char *what,
               GError **error)
{
    void *grown = big_alloc(n_new, size, what, error);
    if (grown && old)
        memcpy(grown, old, MIN(n_old, n_new) * size);
    if (grown)
        big_free(old);
    return grown;
}

void big_zero(void *array, size_t bytes)
{
    const array_head *head = (const array_head *)array - 1;
    const uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE);
    char *end = (char *)array + bytes;
    char *first = (char *)(((uintptr_t)array + page - 1) & ~(page - 1));
    char *last = (char *)((uintptr_t)end & ~(page - 1));
    if (!is_mapped(head) || first >= last ||
        madvise(first, (size_t)(last - first), MADV_DONTNEED) != 0) {
        memset(array, 0, bytes);
        return;
    }
    memset(array, 0, (size_t)(first - (char *)array));
    memset(last, 0, (size_t)(end - last));
}

void big_free(void *array)
{
    if (!array)
        return;
    const array_head head = ((array_head *)array)[-1];
    memory_release(head.base & IS_UNCOUNTED ? 0 : head.bytes);
    atomic_fetch_sub(&in_arrays, is_mapped(&head) ? 0 : head.bytes);
    give_back(&head);
}

size_t memory_peak(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (size_t)usage.ru_maxrss * 1024;
}

size_t memory_resident(void)
{
    g_autofree char *text = NULL;
    size_t all = 0, resident = 0;
    if (!g_file_get_contents("/proc/self/statm", &text, NULL, NULL) ||
        sscanf(text, "%zu %zu", &all, &resident) != 2)
        return 0;
    return resident * (size_t)sysconf(_SC_PAGESIZE);
}
