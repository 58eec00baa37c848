/*
 * What the chunks of a photon pass store, each by itself, until they are joined in order.
 */
#pragma once

#include "photon/trace/trace.h"

/** @brief One chunk. Its stores are set up, empty, before photons are put into them. */
typedef struct trace_chunk {
    trace_result of;
    size_t offset, offset_in_media; /**< of its photons in the whole */
    GError *error;                  /**< memory was refused */
} trace_chunk;

/** @brief Puts a photon into one of the chunk's stores, if its flux is finite. */
void trace_chunk_put(trace_chunk *chunk, photon_store *store, const photon *p);

/** @brief Puts n chunks behind one another into the result, whose stores are set up and
 * empty. @return false if memory was refused, to a chunk or now, or it was
 * cancelled */
bool trace_chunks_join(trace_chunk *chunks, size_t n, workers by, trace_result *result,
                       GError **error);

/** @brief Frees what chunks hold. */
void trace_chunks_clear(trace_chunk *chunks, size_t n);
