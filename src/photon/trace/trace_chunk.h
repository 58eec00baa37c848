/*
 * What the chunks of a photon pass store, each by itself, until they are joined in order.
 */
#pragma once

#include "base/slab_list.h"
#include "photon/trace/trace.h"

/** @brief Photons of one sort as they come. */
typedef struct photon_list {
    slab_list all;      /**< packed_photon */
    photon_store empty; /**< where they will go */
    size_t first;       /**< place of the first there */
} photon_list;

/** @brief One chunk. */
typedef struct trace_chunk {
    photon_list photons, in_media;
    slab **from; /**< of the thread that traces it */
    uint64_t n_rays;
    uint64_t n_not_finite;
    GError *error; /**< memory was refused */
} trace_chunk;

/** @brief Puts a photon into `to`, one of the chunk's two, if its flux is finite. */
void trace_chunk_put(trace_chunk *chunk, photon_list *to, const photon *p);

/** @brief Puts n chunks behind one another into the result, whose stores are set up and
 * empty. @return false if memory was refused, to a chunk or now, or it was
 * cancelled */
bool trace_chunks_join(trace_chunk *chunks, size_t n, workers by, trace_result *result,
                       GError **error);

/** @brief Frees what chunks hold. */
void trace_chunks_clear(trace_chunk *chunks, size_t n);
