#include "base/memory.h"

#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

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

void *big_alloc(size_t n, size_t size, const char *what, GError **error)
{
    const size_t alignment = 64;
    size_t bytes = 0;
    bool fits = !__builtin_mul_overflow(n, size, &bytes) && bytes <= SIZE_MAX / 2;
    size_t rounded = fits ? (bytes + alignment) & ~(alignment - 1) : 0;
    void *array = fits && !must_fail() ? aligned_alloc(alignment, rounded) : NULL;
    if (!array) {
        error_set(error, ERROR_FAILED, "out of memory: %zu x %zu bytes for %s", n, size,
                  what);
        return NULL;
    }
    return memset(array, 0, rounded);
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
    free(array);
}

size_t memory_peak(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (size_t)usage.ru_maxrss * 1024;
}
