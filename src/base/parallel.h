/*
 * Parallel loops whose result does not depend on the number of threads: the range is cut
 * into chunks of fixed size, each chunk is one call, and a chunk writes only what is its
 * own.
 */
#pragma once

#include "base/error.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

/** @brief A flag that asks long work to stop soon, set from any thread and read by all;
 * and who is told of its progress. Zero to begin. */
typedef struct cancel_flag {
    atomic_bool set;
    void (*progress)(void *data); /**< called again and again on the thread that called
                                 parallel_for; NULL: nobody listens */
    void *progress_data;
} cancel_flag;

/** @brief True if flag is not NULL and has been set. */
static inline bool cancelled(const cancel_flag *flag)
{
    return flag &&
           atomic_load_explicit(&((cancel_flag *)flag)->set, memory_order_relaxed);
}

/** @brief Tells of progress, for long work that is no parallel loop: on the thread that
 * was called, some twenty times a second. @return cancelled(flag) */
static inline bool cancel_tell_progress(const cancel_flag *flag)
{
    if (flag && flag->progress)
        flag->progress(flag->progress_data);
    return cancelled(flag);
}

/**
 * @brief Work on elements [begin, end); chunk is begin / chunk_size; thread is in
 * 0..threads-1.
 */
typedef void (*parallel_body)(size_t begin, size_t end, unsigned thread, void *data);

/**
 * @brief Calls body for every chunk of [0, n), in any order, on the given number of
 * threads.
 * @param threads 0 = one per processor
 * @param cancel may be NULL; when set, chunks not yet begun are skipped; its progress is
 * called after each chunk on the calling thread
 * @return false if cancelled before all chunks ran
 */
bool parallel_for(size_t n, size_t chunk_size, unsigned threads,
                  const cancel_flag *cancel, parallel_body body, void *data);

/** @brief Who does work, and until when. */
typedef struct workers {
    unsigned threads;          /**< 0 = one per processor */
    const cancel_flag *cancel; /**< NULL: until it is done */
} workers;

/** @brief parallel_for by these. @return false with ERROR_CANCELLED if it was cancelled
 */
bool parallel_work(size_t n, size_t chunk_size, workers by, parallel_body body,
                   void *data, GError **error);

/** @brief Chunks that are worth a thread's while, where the result is the same with any
 * other: of elements that trace or ask something, some microseconds each, and of those
 * that are only moved. */
enum { RAYS_AT_ONCE = 1 << 10, ITEMS_AT_ONCE = 1 << 14 };

/** @brief The number of threads that a setting of n (0 = automatic) means on this
 * machine. */
unsigned parallel_threads(unsigned n);
