/*
 * Embree builds on threads of its own, which call us. Who asked waits until they are
 * done, but the thread sanitizer does not see how, since Embree is not instrumented: it
 * is told.
 *
 *   who asks ── hands over ──► rtcCommitScene ──────────────────► takes over ──► goes on
 *   Embree's thread     └─► takes over ─► our function ─► hands over ─┘
 *
 * Without the sanitizer nothing is done.
 */
#pragma once

#if defined __has_feature
#if __has_feature(thread_sanitizer)
#define THREADS_ARE_SEEN
#endif
#elif defined __SANITIZE_THREAD__
#define THREADS_ARE_SEEN
#endif

#ifdef THREADS_ARE_SEEN
#include <sanitizer/tsan_interface.h>
#endif

/** @brief Only its address counts: what was done before it is handed over is seen by all
 * who take it over later. */
extern char embree_threads;

static inline void embree_hand_over(void)
{
#ifdef THREADS_ARE_SEEN
    __tsan_release(&embree_threads);
#endif
}

static inline void embree_take_over(void)
{
#ifdef THREADS_ARE_SEEN
    __tsan_acquire(&embree_threads);
#endif
}
