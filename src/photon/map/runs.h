/*
 * Runs: pieces of sorted arrays of points, as the search structures hand them out.
 */
#pragma once

#include "photon/map/query.h"

/** @brief Points begin .. end - 1 of the arrays. */
typedef struct point_run {
    size_t begin, end;
} point_run;

/** @brief Called with n runs. */
typedef void (*point_run_visitor)(const point_run *runs, size_t n, void *data);

/** @brief Runs on their way to a visitor, several at a time, so that their points are
 * on their way from memory before the first of them is looked at. */
typedef struct run_batch {
    const point_arrays *points;
    point_run_visitor visit;
    void *data;
    size_t n;
    point_run runs[16];
} run_batch;

static inline void run_batch_begin(run_batch *batch, const point_arrays *points,
                                   point_run_visitor visit, void *data)
{
    batch->points = points;
    batch->visit = visit;
    batch->data = data;
    batch->n = 0;
}

static inline void run_batch_flush(run_batch *batch)
{
    for (size_t i = 0; i < batch->n; i++) {
        size_t begin = batch->runs[i].begin;
        __builtin_prefetch(batch->points->x + begin);
        __builtin_prefetch(batch->points->y + begin);
        __builtin_prefetch(batch->points->z + begin);
    }
    if (batch->n > 0)
        batch->visit(batch->runs, batch->n, batch->data);
    batch->n = 0;
}

/** @brief Adds a run; an empty one is left out, without a branch. */
static inline void run_batch_add(run_batch *batch, size_t begin, size_t end)
{
    if (batch->n == sizeof batch->runs / sizeof *batch->runs)
        run_batch_flush(batch);
    batch->runs[batch->n] = (point_run){begin, end};
    batch->n += begin < end;
}

/** @brief A search for all points within a radius, by runs. */
typedef struct within_search {
    const point_arrays *points;
    const point_query *query;
    point_hits *hits;
    float radius2;
    bool refused; /**< memory was */
} within_search;

/** @brief Adds those of the runs (point_run_visitor; data: a within_search). */
void within_runs(const point_run *runs, size_t n, void *data);
