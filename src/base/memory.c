#include "base/memory.h"

#include "base/machine.h"

#include <malloc.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

enum {
    ALIGNMENT = 64,    /* bytes: a cache line */
    LEAST_PAGE = 4096, /* bytes: of any system */
};

#define HUGE_PAGE ((size_t)2 << 20) /* bytes: of most systems */
#define REGION ((size_t)16 << 20)   /* bytes of address space: see open_region */

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

/* Small ones come from calloc, and before each stand how large it is and where it begins.
 * Large ones come from the system: of what malloc is given back it keeps pieces, which do
 * not fit what comes next. A large array is not touched before it is used, nor by one
 * thread only. */
typedef struct array_head {
    size_t bytes : 63;
    bool is_counted : 1; /* as in use; if not, its owner counts what is used of it */
    void *base;
} array_head;

_Static_assert(sizeof(array_head) <= 16,
               "there is so much room before what malloc gives");

/* A sanitizer watches what comes from malloc only. */
static bool is_large(size_t bytes)
{
#ifdef SANITIZED
    return false && bytes;
#else
    /* More than a thread's first slab (slab_list.c), and half of what malloc takes for
       large at first: what is smaller it gives back at the end of its heap, and takes it
       again page by page, which may be 10 us each (75 planes of 68 kB, on a virtual
       machine: half the time that denoising them takes). */
    enum { LARGE_ARRAY = 65 << 10 };
    return bytes >= LARGE_ARRAY;
#endif
}

/* Large arrays lie beside one another in regions of the system's, so that those of less
 * than a huge page share one:
 *
 *   region  │ array │ array │   array   │ given back │ array │ not taken yet        │
 *           └──── huge page ────┴──── huge page ────┴──── huge page ────┴── .. ─────┘
 *
 * The memory of each goes back alone, in whole pages; the region's addresses go with its
 * last array. What stands in a head elsewhere is kept apart from them: a head would be
 * touched before it is known which thread fills the array. */
typedef struct region {
    char *next, *end; /* what is not taken yet */
    char *begin;
    size_t n_arrays;
} region;

typedef struct mapped_array {
    array_head head;
    region *in;
} mapped_array;

static struct {
    pthread_mutex_t lock;
    GHashTable *arrays; /* under the lock, as all of it: mapped_array by place, owned */
    region *last;       /* where the next array will be; NULL: there is none */
} mapped = {.lock = PTHREAD_MUTEX_INITIALIZER};

static size_t whole_pages(size_t bytes, size_t page)
{
    return (bytes + page - 1) & ~(page - 1);
}

static size_t page_size(void)
{
    return (size_t)sysconf(_SC_PAGESIZE);
}

static void close_region(region *r)
{
    if (!r || r->n_arrays > 0)
        return;
    munmap(r->begin, (size_t)(r->end - r->begin));
    g_free(r);
}

/* One that begins with a huge page, and holds so many bytes at least. Fewer faults while
   arrays fill, fewer misses of the TLB when they are read in no order: but that pages
   are huge is only a hint. @return NULL: no memory */
static region *open_region(size_t bytes)
{
    size_t size = whole_pages(MAX(bytes, REGION), HUGE_PAGE), room = size + HUGE_PAGE;
    char *base =
        mmap(NULL, room, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (base == MAP_FAILED)
        return NULL;
    size_t before = whole_pages((uintptr_t)base, HUGE_PAGE) - (uintptr_t)base;
    if (before > 0)
        munmap(base, before);
    if (before < HUGE_PAGE)
        munmap(base + before + size, HUGE_PAGE - before);
    region *r = g_new0(region, 1);
    r->begin = r->next = base + before;
    r->end = r->begin + size;
    madvise(r->begin, size, MADV_HUGEPAGE);
    return r;
}

/* The region with room for so many bytes. NULL: no memory */
static region *region_for(size_t bytes)
{
    region *last = mapped.last;
    if (last && bytes <= (size_t)(last->end - last->next))
        return last;
    region *next = open_region(bytes);
    if (next) {
        close_region(last);
        mapped.last = next;
    }
    return next;
}

/* @return NULL: no memory */
static void *map_array(const array_head *head)
{
    void *array = NULL;
    const size_t size = whole_pages(head->bytes, page_size());
    pthread_mutex_lock(&mapped.lock);
    if (!mapped.arrays)
        mapped.arrays = g_hash_table_new_full(NULL, NULL, NULL, g_free);
    region *in = region_for(size);
    if (in) {
        mapped_array *noted = g_new(mapped_array, 1);
        *noted = (mapped_array){*head, in};
        array = in->next;
        in->next += size;
        in->n_arrays++;
        g_hash_table_insert(mapped.arrays, array, noted);
    }
    pthread_mutex_unlock(&mapped.lock);
    return array;
}

static array_head unmap_array(void *array)
{
    pthread_mutex_lock(&mapped.lock);
    mapped_array *noted = g_hash_table_lookup(mapped.arrays, array);
    const array_head head = noted->head;
    region *in = noted->in;
    madvise(array, whole_pages(head.bytes, page_size()), MADV_DONTNEED);
    in->n_arrays--;
    if (in != mapped.last)
        close_region(in);
    g_hash_table_remove(mapped.arrays, array);
    pthread_mutex_unlock(&mapped.lock);
    return head;
}

/* Only they begin with a page. */
static bool is_mapped(const void *array)
{
    return (uintptr_t)array % LEAST_PAGE == 0;
}

/* Behind room for the head, and at no page's begin. */
static void *array_behind(const array_head *head)
{
    uintptr_t place = ((uintptr_t)head->base + ALIGNMENT) & ~(uintptr_t)(ALIGNMENT - 1);
    place += place % LEAST_PAGE == 0 ? ALIGNMENT : 0;
    array_head *array = (array_head *)place;
    array[-1] = *head;
    return array;
}

/* There may be so many pieces of the system's and no more. @return NULL: no memory */
static void *take(array_head head)
{
    void *array = is_large(head.bytes) ? map_array(&head) : NULL;
    if (array)
        return array;
    head.base = calloc(1, head.bytes + ALIGNMENT);
    if (!head.base)
        return NULL;
    atomic_fetch_add(&in_arrays, head.bytes);
    return array_behind(&head);
}

/* With the head. */
static size_t bytes_for(size_t bytes)
{
    return ((bytes + ALIGNMENT) & ~(size_t)(ALIGNMENT - 1)) + ALIGNMENT;
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
    void *array = fails ? NULL : take((array_head){total, true, NULL});
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
    void *array = must_fail() ? NULL : take((array_head){total, false, NULL});
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
    const size_t whole = bytes & ~(page_size() - 1);
    size_t done = 0;
    if (is_mapped(array) && whole > 0 && madvise(array, whole, MADV_DONTNEED) == 0)
        done = whole;
    memset((char *)array + done, 0, bytes - done);
}

static array_head give_back(void *array)
{
    if (is_mapped(array))
        return unmap_array(array);
    const array_head head = ((array_head *)array)[-1];
    atomic_fetch_sub(&in_arrays, head.bytes);
    free(head.base);
    return head;
}

void big_free(void *array)
{
    if (!array)
        return;
    const array_head head = give_back(array);
    memory_release(head.is_counted ? head.bytes : 0);
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
