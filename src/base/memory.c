#include "base/memory.h"

#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

enum { HUGE_ARRAY = 4 << 20 }; /* bytes, from which on huge pages are worth asking for */

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

/* Fewer page faults while an array fills, fewer misses of the TLB when it is read in no
   order. Only a hint. */
static void use_huge_pages(char *base, size_t bytes)
{
    uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE);
    uintptr_t begin = ((uintptr_t)base + page - 1) & ~(page - 1);
    madvise((void *)begin, ((uintptr_t)base + bytes - begin) & ~(page - 1),
            MADV_HUGEPAGE);
}

/* From calloc, which knows which memory is zero already: a big array is then not touched
 * before it is used, nor by one thread only. Where it begins stands before the array. */
void *big_alloc(size_t n, size_t size, const char *what, GError **error)
{
    const size_t alignment = 64;
    size_t bytes = 0;
    bool fits = !__builtin_mul_overflow(n, size, &bytes) && bytes <= SIZE_MAX / 2;
    size_t rounded = fits ? (bytes + alignment) & ~(alignment - 1) : 0;
    char *base = fits && !must_fail() ? calloc(1, rounded + alignment) : NULL;
    if (!base) {
        error_set(error, ERROR_FAILED, "out of memory: %zu x %zu bytes for %s", n, size,
                  what);
        return NULL;
    }
    if (rounded >= HUGE_ARRAY)
        use_huge_pages(base, rounded);
    void **array = (void **)(((uintptr_t)base + alignment) & ~(uintptr_t)(alignment - 1));
    array[-1] = base;
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

void big_free(void *array)
{
    if (array)
        free(((void **)array)[-1]);
}

size_t memory_peak(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (size_t)usage.ru_maxrss * 1024;
}
