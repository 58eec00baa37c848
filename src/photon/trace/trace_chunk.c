#include "photon/trace/trace_chunk.h"

enum { BLOCK = 256 }; /* size: photons; half of it a chunk is not filled */

/* @return NULL: memory was refused */
static photon_store *open_block(photon_blocks *of, GError **error)
{
    photon_store block = of->empty;
    if (!photon_store_reserve(&block, BLOCK, error))
        return NULL;
    of->all = g_renew(photon_store, of->all, of->n_blocks + 1);
    of->all[of->n_blocks] = block;
    return &of->all[of->n_blocks++];
}

void trace_chunk_put(trace_chunk *chunk, photon_blocks *to, const photon *p)
{
    if (!spectrum_is_finite(p->flux)) {
        chunk->n_not_finite++;
        return;
    }
    photon_store *last = to->n_blocks > 0 ? &to->all[to->n_blocks - 1] : NULL;
    if (!chunk->error && (!last || last->n == last->capacity))
        last = open_block(to, &chunk->error);
    if (chunk->error)
        return;
    photon_store_put(last, p);
    to->n++;
}

static void clear_blocks(photon_blocks *of)
{
    for (size_t i = 0; i < of->n_blocks; i++)
        photon_store_clear(&of->all[i]);
    g_free(of->all);
    *of = (photon_blocks){0};
}

typedef struct join_loop {
    trace_result *result;
    trace_chunk *chunks;
} join_loop;

/* Copies blocks to their place and frees them. */
static void move_blocks(photon_store *to, photon_blocks *from)
{
    size_t at = from->offset;
    for (size_t i = 0; i < from->n_blocks; at += from->all[i++].n)
        photon_store_copy(to, at, &from->all[i]);
    clear_blocks(from);
}

static void join_chunk(size_t i, size_t end, unsigned thread, void *data)
{
    (void)end, (void)thread;
    join_loop *loop = data;
    move_blocks(&loop->result->photons, &loop->chunks[i].photons);
    move_blocks(&loop->result->in_media, &loop->chunks[i].in_media);
}

static void give_place(photon_blocks *blocks, size_t *total)
{
    blocks->offset = *total;
    *total += blocks->n;
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
        give_place(&chunk->photons, &total);
        give_place(&chunk->in_media, &in_media);
        result->n_rays += chunk->n_rays;
        result->n_not_finite += chunk->n_not_finite;
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
        clear_blocks(&chunks[i].photons);
        clear_blocks(&chunks[i].in_media);
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
