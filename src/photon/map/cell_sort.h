/*
 * Sorting by cell: a counting sort in two strokes, stable, linear, and the same on any
 * number of threads.
 */
#pragma once

#include "base/parallel.h"

#include <stddef.h>
#include <stdint.h>

/** @brief The cell of element i, below n_cells. */
typedef size_t (*cell_of_element)(size_t i, const void *data);

/**
 * @brief The order of n elements by cell; elements of one cell keep their order.
 * @param n below 2^32
 * @param start n_cells + 1 zeroed entries: on return cell c holds order[start[c]] ..
 *        order[start[c + 1] - 1]
 * @return order[n], owned by the caller (big_free); NULL when memory is refused. 24 bytes
 *         an element are held while sorting.
 */
size_t *cell_sort(size_t n, size_t n_cells, cell_of_element cell_of, const void *data,
                  uint32_t *start, workers by, GError **error);
