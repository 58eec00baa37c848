/*
 * What a kind of map supplies, for those who write one and for the estimate, which walks
 * the runs itself so as to weigh photons where it finds them.
 */
#pragma once

#include "photon/map/map.h"
#include "photon/probe.h"

/** @brief Photons begin .. end - 1 of the store. */
typedef struct photon_run {
    size_t begin, end;
} photon_run;

/** @brief Called with n runs of photons. */
typedef void (*photon_run_visitor)(const photon_run *runs, size_t n, void *data);

/** @brief Runs on their way to a visitor, several at a time, so that their photons are
 * on their way from memory before the first of them is looked at. */
typedef struct run_batch {
    const photon_store *store;
    photon_run_visitor visit;
    void *data;
    size_t n;
    photon_run runs[16];
} run_batch;

static inline void run_batch_begin(run_batch *batch, const photon_store *store,
                                   photon_run_visitor visit, void *data)
{
    batch->store = store;
    batch->visit = visit;
    batch->data = data;
    batch->n = 0;
}

static inline void run_batch_flush(run_batch *batch)
{
    for (size_t i = 0; i < batch->n; i++) {
        size_t begin = batch->runs[i].begin;
        __builtin_prefetch(batch->store->x + begin);
        __builtin_prefetch(batch->store->y + begin);
        __builtin_prefetch(batch->store->z + begin);
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

typedef struct photon_map_kind {
    const char *name; /**< "list", "kdtree", "grid" */
    /** Puts map->store in order and builds map->index. The store is not empty. */
    bool (*build)(photon_map *map, float radius, unsigned threads, GError **error);
    void (*free)(photon_map *map);
    size_t (*bytes)(const photon_map *map); /**< without the store */
    /** Visits runs that hold every photon within radius of p, none of them twice. NULL:
     *  the map has no order, and `within` is the way. */
    void (*runs)(const photon_map *map, vec3 p, float radius, photon_run_visitor visit,
                 void *data);
    /* Both add to empty hits, in no order; false when memory is refused. */
    bool (*within)(const photon_map *map, const photon_probe *probe, float radius,
                   photon_hits *hits);
    bool (*nearest)(const photon_map *map, const photon_probe *probe, size_t k,
                    float radius, photon_hits *hits);
} photon_map_kind;

struct photon_map {
    const photon_map_kind *kind;
    photon_store store;
    void *index; /**< the kind's own, big_alloc'ed */
};

#define MAP(choice, word) extern const photon_map_kind photon_map_##word;
#include "settings/map.def"
#undef MAP

/** @brief Room for capacity hits in all. */
bool photon_hits_reserve(photon_hits *hits, size_t capacity);

/** @brief photon_map_kind.within by way of runs, eight at a time. */
bool photon_map_within_runs(const photon_map *map, const photon_probe *probe,
                            float radius, photon_hits *hits);
