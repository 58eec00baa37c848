#include "photon/trace/trace_chunk.h"

void trace_chunk_put(trace_chunk *chunk, photon_store *store, const photon *p)
{
    if (!spectrum_is_finite(p->flux)) {
        chunk->of.n_not_finite++;
        return;
    }
    size_t more = MAX(2 * store->capacity, RAYS_AT_ONCE);
    if (chunk->error || (store->n == store->capacity &&
                         !photon_store_reserve(store, more, &chunk->error)))
        return;
    photon_store_put(store, p);
}

typedef struct join_loop {
    trace_result *result;
    trace_chunk *chunks;
} join_loop;

/* Copies a chunk to its place and frees it. */
static void join_chunk(size_t i, size_t end, unsigned thread, void *data)
{
    (void)end, (void)thread;
    join_loop *loop = data;
    trace_chunk *chunk = &loop->chunks[i];
    photon_store_copy(&loop->result->photons, chunk->offset, &chunk->of.photons);
    photon_store_copy(&loop->result->in_media, chunk->offset_in_media,
                      &chunk->of.in_media);
    trace_result_clear(&chunk->of);
}

/* Gives each chunk its place in the whole. @return false if one failed. */
static bool add_up(trace_chunk *chunks, size_t n, trace_result *result, GError **error)
{
    size_t total = 0, in_media = 0;
    for (size_t i = 0; i < n; i++) {
        trace_chunk *chunk = &chunks[i];
        if (chunk->error) {
            g_propagate_error(error, g_steal_pointer(&chunk->error));
            return false;
        }
        chunk->offset = total;
        chunk->offset_in_media = in_media;
        total += chunk->of.photons.n;
        in_media += chunk->of.in_media.n;
        result->n_rays += chunk->of.n_rays;
        result->n_not_finite += chunk->of.n_not_finite;
    }
    if (!photon_store_reserve(&result->photons, total, error) ||
        !photon_store_reserve(&result->in_media, in_media, error))
        return false;
    result->photons.n = total;
    result->in_media.n = in_media;
    return true;
}

bool trace_chunks_join(trace_chunk *chunks, size_t n, workers by, trace_result *result,
                       GError **error)
{
    if (!add_up(chunks, n, result, error))
        return false;
    join_loop loop = {result, chunks};
    return parallel_work(n, 1, by, join_chunk, &loop, error);
}

void trace_chunks_clear(trace_chunk *chunks, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        trace_result_clear(&chunks[i].of);
        g_clear_error(&chunks[i].error);
    }
}

static bool append(photon_store *to, photon_store *from, GError **error)
{
    size_t n = to->n;
    if (from->n == 0)
        return true;
    if (!photon_store_reserve(to, n + from->n, error))
        return false;
    photon_store_copy(to, n, from);
    to->n = n + from->n;
    photon_store_clear(from);
    return true;
}

bool trace_result_append(trace_result *to, trace_result *from, GError **error)
{
    to->n_rays += from->n_rays;
    to->n_not_finite += from->n_not_finite;
    return append(&to->photons, &from->photons, error) &&
           append(&to->in_media, &from->in_media, error);
}

void trace_result_clear(trace_result *result)
{
    photon_store_clear(&result->photons);
    photon_store_clear(&result->in_media);
    *result = (trace_result){0};
}
