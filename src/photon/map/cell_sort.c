/*
 * First stroke: elements go to N_BINS bins of consecutive cells, chunk by chunk; each
 * chunk of fixed length counts its own bins, and the running sums over (bin, chunk) tell
 * every chunk where its elements of a bin go. Second stroke: each bin, small enough for
 * the cache, is sorted by cell on its own.
 *
 *   elements   |chunk 0    |chunk 1    |chunk 2 ..      counts[chunk][bin]
 *   pairs      |bin 0 |bin 1    |bin 2 ..               (cell, element)
 *   order      |cell 0|cell 1|cell 2|..                 start[cell]
 *
 * Chunks and bins do not depend on the threads, and each is written by one: so the result
 * does not either.
 */
#include "photon/map/cell_sort.h"

#include "base/memory.h"
#include "base/parallel.h"

enum { N_BINS = 512 }; /* size: so many are sorted through the cache */

typedef struct pair {
    size_t cell, element;
} pair;

typedef struct sorter {
    size_t n, n_cells, cells_per_bin, n_chunks;
    cell_of_element cell_of;
    const void *data;
    size_t (*counts)[N_BINS]; /* per chunk: elements per bin, then where the next goes */
    size_t bin_begin[N_BINS + 1];
    pair *pairs;
    uint32_t *start;
    size_t *order;
} sorter;

static void count_chunk(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    sorter *s = data;
    size_t *count = s->counts[begin / ITEMS_AT_ONCE];
    for (size_t i = begin; i < end; i++)
        count[s->cell_of(i, s->data) / s->cells_per_bin]++;
}

/* Turns counts into places: bin by bin, within a bin chunk by chunk. */
static void sum_counts(sorter *s)
{
    size_t place = 0;
    for (size_t bin = 0; bin < N_BINS; bin++) {
        s->bin_begin[bin] = place;
        for (size_t chunk = 0; chunk < s->n_chunks; chunk++) {
            size_t count = s->counts[chunk][bin];
            s->counts[chunk][bin] = place;
            place += count;
        }
    }
    s->bin_begin[N_BINS] = place;
}

static void scatter_chunk(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    sorter *s = data;
    size_t *place = s->counts[begin / ITEMS_AT_ONCE];
    for (size_t i = begin; i < end; i++) {
        size_t cell = s->cell_of(i, s->data);
        s->pairs[place[cell / s->cells_per_bin]++] = (pair){cell, i};
    }
}

/* start[c + 1] holds, one after the other: the count of cell c, its begin, its end. The
 * end of a cell is the begin of the next, so start needs no more than one pass. */
static void sort_bin(size_t bin, size_t end, unsigned thread, void *data)
{
    (void)end, (void)thread;
    sorter *s = data;
    uint32_t *last = s->start + 1;
    size_t from = s->bin_begin[bin], to = s->bin_begin[bin + 1];
    for (size_t i = from; i < to; i++)
        last[s->pairs[i].cell]++;
    uint32_t place = (uint32_t)from;
    size_t cell_end = MIN((bin + 1) * s->cells_per_bin, s->n_cells);
    for (size_t cell = bin * s->cells_per_bin; cell < cell_end; cell++) {
        uint32_t count = last[cell];
        last[cell] = place;
        place += count;
    }
    for (size_t i = from; i < to; i++)
        s->order[last[s->pairs[i].cell]++] = s->pairs[i].element;
}

static bool sort_allocate(sorter *s, GError **error)
{
    const char *what = "sorting points";
    s->counts = big_alloc(s->n_chunks, sizeof *s->counts, what, error);
    s->pairs = s->counts ? big_alloc(s->n, sizeof *s->pairs, what, error) : NULL;
    s->order = s->pairs ? big_alloc(s->n, sizeof *s->order, what, error) : NULL;
    return s->order != NULL;
}

size_t *cell_sort(size_t n, size_t n_cells, cell_of_element cell_of, const void *data,
                  uint32_t *start, workers by, GError **error)
{
    sorter s = {
        .n = n,
        .n_cells = n_cells,
        .cells_per_bin = n_cells / N_BINS + 1,
        .n_chunks = (n + ITEMS_AT_ONCE - 1) / ITEMS_AT_ONCE,
        .cell_of = cell_of,
        .data = data,
        .start = start,
    };
    bool done = sort_allocate(&s, error) &&
                parallel_work(n, ITEMS_AT_ONCE, by, count_chunk, &s, error);
    if (done)
        sum_counts(&s);
    done = done && parallel_work(n, ITEMS_AT_ONCE, by, scatter_chunk, &s, error) &&
           parallel_work(N_BINS, 1, by, sort_bin, &s, error);
    if (!done)
        g_clear_pointer(&s.order, big_free);
    big_free(s.counts);
    big_free(s.pairs);
    return s.order;
}
