/*
 * Lists that many threads fill, each its own, until all are joined.
 *
 * Nobody knows beforehand how long they become. Elements lie in pieces of one size, which
 * stay where they are when more come; a thread cuts the pieces of whatever lists it fills
 * from a slab of its own, one behind the other, and a slab goes back with the last of its
 * pieces:
 *
 *   slab  │ list a │ list b │ list a │ list a │ ..     at most a huge page
 *
 * A thread's first slab is small, since one page of a huge one takes all of it, and the
 * next is twice as large. So what a loop takes is what it stores, to half a piece a list
 * and as much again or a slab a thread, whichever is less, and every loop takes and gives
 * the same slabs: nothing is left in pieces that fit nothing.
 */
#pragma once

#include "base/parallel.h"

#include <stdbool.h>
#include <stddef.h>

enum { SLAB_BYTES = (2 << 20) - 128 }; /* the largest, with what stands before arrays */

typedef struct slab slab;
typedef struct slab_piece slab_piece;

/** @brief Elements of one size, at most a piece's. All zero: empty. */
typedef struct slab_list {
    slab_piece *first, *last;
    size_t n;       /**< elements in all */
    bool uncounted; /**< see slab_list_uncount */
} slab_list;

/** @brief Adds an element.
 * @param from the thread's slab; one that is NULL is made when it is needed, and given
 * back by slab_close
 * @return the element, not set to anything and aligned to a cache line if its size is a
 * multiple of one; NULL with ERROR_FAILED */
void *slab_list_add(slab_list *list, size_t size, slab **from, const char *what,
                    GError **error);

/** @brief Hears of elements that lie side by side: n of them, the first of which is
 * number `at` of its list. */
typedef void (*slab_visit)(const void *elements, size_t n, size_t at, void *data);

/** @brief Counts it as memory in use no more: what it is moved to counts in its place,
 * and grows as fast as the list shrinks. No element comes after that. */
void slab_list_uncount(slab_list *list);

/** @brief Visits all elements in the order they came in, and frees them. */
void slab_list_move(slab_list *list, slab_visit visit, void *data);

/** @brief Frees the elements. */
void slab_list_clear(slab_list *list);

/** @brief No piece will be cut from it any more. NULL is allowed. */
void slab_close(slab *s);

/** @brief parallel_work whose body cuts pieces from slabs[thread], which are there while
 * it runs. @param slabs where the body finds them */
bool slab_work(size_t n, size_t chunk_size, workers by, parallel_body body, void *data,
               slab ***slabs, GError **error);
