/*
 * Threads that wait for loops, in one pool of GLib's.
 *
 *   caller ─ asks helpers ─► chunks, with whoever comes ─► closes the loop ─ waits ─►
 *   helper ──────── enters, if it is open ─► chunks ─► leaves ─┘
 *
 * Nobody is waited for that has not come yet: where others have the processors, the
 * caller does the work by itself. Who waits sleeps. The locks are POSIX's: the thread
 * sanitizer does not see GLib's.
 */
#include "base/parallel.h"

#include <glib.h>
#include <pthread.h>

/* math: a bit of parallel_loop.inside */
#define CLOSED (1u << 31)

/* A loop under way; lives until the last helper that was asked has seen it. */
typedef struct parallel_loop {
    size_t n, chunk_size, n_chunks;
    const cancel_flag *cancel;
    parallel_body body;
    void *data;
    atomic_size_t next;     /* chunk */
    atomic_uint n_entered;  /* helpers so far */
    atomic_uint inside;     /* helpers now, and whether more may come */
    atomic_uint references; /* the caller's, and of each helper that was asked */
    pthread_mutex_t lock;
    pthread_cond_t left; /* the last one */
} parallel_loop;

/* Loops in loops have one thread: all others are at work. */
static _Thread_local bool is_within;

unsigned parallel_threads(unsigned n)
{
    return n ? n : g_get_num_processors();
}

static void loop_unref(parallel_loop *l)
{
    if (atomic_fetch_sub(&l->references, 1) > 1)
        return;
    pthread_mutex_destroy(&l->lock);
    pthread_cond_destroy(&l->left);
    g_free(l);
}

static void work_on(parallel_loop *l, unsigned thread)
{
    for (size_t i; (i = atomic_fetch_add(&l->next, 1)) < l->n_chunks;) {
        size_t begin = i * l->chunk_size;
        if (!cancelled(l->cancel))
            l->body(begin, MIN(begin + l->chunk_size, l->n), thread, l->data);
        if (thread == 0 && l->cancel && l->cancel->progress)
            l->cancel->progress(l->cancel->progress_data);
    }
}

/* ---- Helpers ---- */

static bool enter(parallel_loop *l)
{
    unsigned inside = atomic_load(&l->inside);
    do
        if (inside & CLOSED)
            return false;
    while (!atomic_compare_exchange_weak(&l->inside, &inside, inside + 1));
    return true;
}

static void leave(parallel_loop *l)
{
    if (atomic_fetch_sub(&l->inside, 1) != (CLOSED | 1))
        return;
    pthread_mutex_lock(&l->lock);
    pthread_cond_signal(&l->left);
    pthread_mutex_unlock(&l->lock);
}

static void help(void *data, void *unused)
{
    (void)unused;
    parallel_loop *l = data;
    is_within = true;
    if (enter(l)) {
        work_on(l, 1 + atomic_fetch_add(&l->n_entered, 1));
        leave(l);
    }
    loop_unref(l);
}

/* As many threads as all loops under way have asked for. */
static struct {
    pthread_mutex_t lock;
    GThreadPool *pool;
    unsigned n_asked, n_most;
} helpers = {.lock = PTHREAD_MUTEX_INITIALIZER};

static void ask_helpers(parallel_loop *l, unsigned n)
{
    pthread_mutex_lock(&helpers.lock);
    helpers.n_asked += n;
    if (!helpers.pool)
        helpers.pool = g_thread_pool_new(help, NULL, (int)n, TRUE, NULL);
    if (helpers.n_asked > helpers.n_most)
        g_thread_pool_set_max_threads(helpers.pool, (int)helpers.n_asked, NULL);
    helpers.n_most = MAX(helpers.n_most, helpers.n_asked);
    for (unsigned i = 0; i < n; i++)
        g_thread_pool_push(helpers.pool, l, NULL);
    pthread_mutex_unlock(&helpers.lock);
}

static void release_helpers(unsigned n)
{
    pthread_mutex_lock(&helpers.lock);
    helpers.n_asked -= n;
    pthread_mutex_unlock(&helpers.lock);
}

/* ---- The caller ---- */

static void wait_for_helpers(parallel_loop *l)
{
    if (atomic_fetch_or(&l->inside, CLOSED) == 0)
        return;
    pthread_mutex_lock(&l->lock);
    while (atomic_load(&l->inside) != CLOSED)
        pthread_cond_wait(&l->left, &l->lock);
    pthread_mutex_unlock(&l->lock);
}

static void share(const parallel_loop *loop, unsigned n_helpers)
{
    parallel_loop *l = g_new(parallel_loop, 1);
    *l = *loop;
    pthread_mutex_init(&l->lock, NULL);
    pthread_cond_init(&l->left, NULL);
    atomic_init(&l->references, n_helpers + 1);
    atomic_store(&l->inside, 0); /* what was written before, helpers see */
    ask_helpers(l, n_helpers);
    is_within = true;
    work_on(l, 0);
    is_within = false;
    wait_for_helpers(l);
    release_helpers(n_helpers);
    loop_unref(l);
}

bool parallel_for(size_t n, size_t chunk_size, unsigned threads,
                  const cancel_flag *cancel, parallel_body body, void *data)
{
    parallel_loop loop = {.n = n,
                          .chunk_size = chunk_size,
                          .n_chunks = (n + chunk_size - 1) / chunk_size,
                          .cancel = cancel,
                          .body = body,
                          .data = data};
    unsigned used = (unsigned)MIN((size_t)parallel_threads(threads), loop.n_chunks);
    if (used > 1 && !is_within)
        share(&loop, used - 1);
    else
        work_on(&loop, 0);
    return !cancelled(cancel);
}

bool parallel_work(size_t n, size_t chunk_size, workers by, parallel_body body,
                   void *data, GError **error)
{
    if (parallel_for(n, chunk_size, by.threads, by.cancel, body, data))
        return true;
    error_set(error, ERROR_CANCELLED, "cancelled");
    return false;
}
