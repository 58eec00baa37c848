/*
 * What the chunks of a photon pass store, each by itself, until they are joined in order.
 *
 * Nobody knows beforehand how many photons a chunk will have. They lie in blocks of one
 * size, which are not moved when more come: what a pass takes is what it stores, to a
 * block a chunk, and what one pass gives back is just what the next asks for.
 */
#pragma once

#include "photon/trace/trace.h"

/** @brief Photons of one sort as they come. */
typedef struct photon_blocks {
    photon_store empty; /**< what each block starts from */
    photon_store *all;
    size_t n_blocks;
    size_t n;      /**< photons in all */
    size_t offset; /**< of the first in the whole */
} photon_blocks;

/** @brief One chunk. Its blocks are set up, none yet, before photons are put in. */
typedef struct trace_chunk {
    photon_blocks photons, in_media;
    uint64_t n_rays;
    uint64_t n_not_finite;
    GError *error; /**< memory was refused */
} trace_chunk;

/** @brief Puts a photon into `to`, one of the chunk's two, if its flux is finite. */
void trace_chunk_put(trace_chunk *chunk, photon_blocks *to, const photon *p);

/** @brief Puts n chunks behind one another into the result, whose stores are set up and
 * empty. @return false if memory was refused, to a chunk or now, or it was
 * cancelled */
bool trace_chunks_join(trace_chunk *chunks, size_t n, workers by, trace_result *result,
                       GError **error);

/** @brief Frees what chunks hold. */
void trace_chunks_clear(trace_chunk *chunks, size_t n);
