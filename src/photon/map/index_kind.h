/*
 * What a kind of point index supplies, for those who write one.
 */
#pragma once

#include "photon/map/point_index.h"

typedef struct point_index_kind {
    const char *name; /**< as the setting `photon_map` says it */
    /** The order that it wants points in, big_alloc'ed; of index->points, not empty. NULL
     * when memory is refused. No function: they stay as they are. */
    size_t *(*sort)(point_index *index, float radius, workers by, GError **error);
    /** What is made of points in this order. No function: nothing. */
    bool (*build)(point_index *index, workers by, GError **error);
    void (*free)(point_index *index);          /**< structure is not NULL */
    size_t (*bytes)(const point_index *index); /**< of the structure */
    /* Of an index with points. */
    void (*runs)(const point_index *index, vec3 p, float radius, point_run_visitor visit,
                 void *data);
    /* Both add to empty hits, in no order; false when memory is refused. */
    bool (*within)(const point_index *index, const point_query *query, float radius,
                   point_hits *hits); /**< no function: by runs */
    bool (*nearest)(const point_index *index, const point_query *query, size_t k,
                    float radius, point_hits *hits);
} point_index_kind;

struct point_index {
    const point_index_kind *kind;
    point_arrays points; /**< the owner's */
    void *structure;     /**< the kind's own, NULL: there is none */
};

#define MAP(choice, word) extern const point_index_kind point_index_##word;
#include "settings/map.def"
#undef MAP
