/*
 * Whether a sanitizer watches: gcc has a macro for each, clang a feature.
 */
#pragma once

#if defined(__SANITIZE_THREAD__)
#define THREADS_ARE_WATCHED true
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define THREADS_ARE_WATCHED true
#endif
#endif
#ifndef THREADS_ARE_WATCHED
#define THREADS_ARE_WATCHED false
#endif

/* Or by one of them, so that malloc is not the system's. */
#if defined(__SANITIZE_ADDRESS__)
#define MEMORY_IS_WATCHED true
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define MEMORY_IS_WATCHED true
#endif
#endif
#ifndef MEMORY_IS_WATCHED
#define MEMORY_IS_WATCHED THREADS_ARE_WATCHED
#endif
