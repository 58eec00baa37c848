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
