/*
 * Runs: pieces of sorted arrays of points, as the search structures hand them out.
 */
#pragma once

#include "photon/map/map.h"
#include "photon/map/query.h"

/** @brief Positions of n points; borrowed. The arrays go on behind them for at least one
 * SIMD block, so that eight may be loaded from any. */
typedef struct point_arrays {
    size_t n;
    const float *x, *y, *z;
} point_arrays;

static inline point_arrays photon_points(const photon_store *store)
{
    return (point_arrays){store->n, store->x, store->y, store->z};
}

/** @brief Points begin .. end - 1 of the arrays. */
typedef struct photon_run {
    size_t begin, end;
} photon_run;

/** @brief Called with n runs. */
typedef void (*photon_run_visitor)(const photon_run *runs, size_t n, void *data);

/** @brief Runs on their way to a visitor, several at a time, so that their points are
 * on their way from memory before the first of them is looked at. */
typedef struct run_batch {
    point_arrays points;
    photon_run_visitor visit;
    void *data;
    size_t n;
    photon_run runs[16];
} run_batch;

static inline void run_batch_begin(run_batch *batch, const point_arrays *points,
                                   photon_run_visitor visit, void *data)
{
    batch->points = *points;
    batch->visit = visit;
    batch->data = data;
    batch->n = 0;
}

static inline void run_batch_flush(run_batch *batch)
{
    for (size_t i = 0; i < batch->n; i++) {
        size_t begin = batch->runs[i].begin;
        __builtin_prefetch(batch->points.x + begin);
        __builtin_prefetch(batch->points.y + begin);
        __builtin_prefetch(batch->points.z + begin);
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
    batch->runs[batch->n] = (photon_run){begin, end};
    batch->n += begin < end;
}

/** @brief Room for capacity hits in all. */
bool photon_hits_reserve(photon_hits *hits, size_t capacity);

/** @brief A search for all points within a radius, by runs. */
typedef struct within_search {
    const point_query *query;
    photon_hits *hits;
    float radius2;
    bool refused; /**< memory was */
} within_search;

/** @brief Adds those of the runs (photon_run_visitor; data: a within_search). */
void within_runs(const photon_run *runs, size_t n, void *data);
