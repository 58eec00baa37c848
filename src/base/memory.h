/*
 * Big arrays: aligned to a cache line, checked for overflow, and reported when refused.
 *
 * Small things (strings, lists) use GLib, which aborts when a few bytes are not to be
 * had; who makes very many of them for a file asks memory_ask first. Arrays whose size
 * depends on the input (photons, meshes, images) come from here and may fail.
 *
 * All of them together stay below a limit, so that a file of a few bytes that asks for
 * all the memory there is gets a message and not the machine. What libraries allocate
 * for us (decoders, Embree) is reserved here before.
 */
#pragma once

#include "base/error.h"

#include <stddef.h>

/**
 * @brief Allocates n * size zeroed bytes aligned to 64.
 * @param what named in the error, e.g. "photons"
 * @return the array, owned by the caller (big_free); NULL with ERROR_FAILED. n = 0 is
 * allowed and gives a pointer that may be freed.
 */
void *big_alloc(size_t n, size_t size, const char *what, GError **error);

/** @brief The same, not counted as in use: its owner reserves what is used of it.
 * @param bytes below half of all that there are */
void *big_alloc_uncounted(size_t bytes, const char *what, GError **error);

/** @brief Grows an array from n_old to n_new elements, keeping the contents; the old one
 * stays valid and owned by the caller when this fails. The new part is zeroed. */
void *big_grow(void *old, size_t n_old, size_t n_new, size_t size, const char *what,
               GError **error);

/** @brief Makes the first bytes of an array zero; large ones get fresh pages, which takes
 * no time until they are written to. */
void big_zero(void *array, size_t bytes);
/** @brief Frees what big_alloc or big_grow gave; NULL is allowed. */
void big_free(void *array);

/** @brief Counts bytes that come from elsewhere, or will be wanted later, as used.
 * @return false with ERROR_FAILED saying how much `what` wanted and how much of the limit
 * is left; nothing is counted then */
bool memory_reserve(size_t bytes, const char *what, GError **error);
/** @brief The same where nothing can be refused any more. */
void memory_count(size_t bytes);
/** @brief Gives back what memory_reserve or memory_count took. */
void memory_release(size_t bytes);

/** @brief Asks for about so many bytes in small pieces that GLib will allocate, which
 * ends the program where they are not to be had. They are not counted one by one: at
 * every mebibyte that was asked for it is looked at how much the process has in all.
 * @return false with ERROR_FAILED if that is too much */
bool memory_ask(size_t bytes, const char *what, GError **error);

/** @brief Limits the process. What is in use stays. @param bytes 0: as at first, 80 % of
 * what the machine, the process's cgroup and ulimit -v have, whichever is least */
void memory_set_limit(size_t bytes);
size_t memory_limit(void);
enum { MEMORY_SIZE_TEXT = 32 };
/** @brief As "3.5 GiB". */
void memory_write_size(size_t bytes, char out[MEMORY_SIZE_TEXT]);
/** @brief What of the limit is neither reserved nor in arrays. */
size_t memory_left(void);

/** @brief The most that was in use at once since memory_forget_most. */
size_t memory_most(void);
/** @brief @return what is in use */
size_t memory_forget_most(void);

/** @brief For tests: the n-th call of big_alloc, big_grow or memory_ask from now (1 =
 * next) fails once; 0 = never. */
void big_alloc_fail_at(unsigned n);

/** @brief So many calls until the one that big_alloc_fail_at asked for; 0: it came. */
unsigned big_alloc_fail_left(void);

/** @brief Largest resident size of this process so far, in bytes. */
size_t memory_peak(void);
/** @brief What it has now, in bytes; 0: not known. */
size_t memory_resident(void);
