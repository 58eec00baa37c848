/*
 * What a kind of map supplies, for those who write one and for the estimate, which walks
 * the runs itself so as to weigh photons where it finds them.
 */
#pragma once

#include "photon/map/runs.h"

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
    bool (*within)(const photon_map *map, const point_query *query, float radius,
                   photon_hits *hits);
    bool (*nearest)(const photon_map *map, const point_query *query, size_t k,
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

/** @brief photon_map_kind.within by way of runs, eight at a time. */
bool photon_map_within_runs(const photon_map *map, const point_query *query, float radius,
                            photon_hits *hits);
