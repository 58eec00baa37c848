#include "photon/trace/trace_chunk.h"

void trace_chunk_put(trace_chunk *chunk, photon_list *to, const photon *p)
{
    if (!spectrum_is_finite(p->flux)) {
        chunk->n_not_finite++;
        return;
    }
    if (chunk->error)
        return;
    packed_photon *put =
        slab_list_add(&to->all, sizeof *put, chunk->from, "photons", &chunk->error);
    if (put)
        *put = photon_store_packed(&to->empty, p);
}

typedef struct join_loop {
    trace_result *result;
    trace_chunk *chunks;
} join_loop;

typedef struct photon_place {
    photon_store *store;
    size_t first;
} photon_place;

static void put_side_by_side(const void *elements, size_t n, size_t at, void *data)
{
    const photon_place *to = data;
    const packed_photon *packed = elements;
    for (size_t i = 0; i < n; i++)
        photon_store_set_packed(to->store, to->first + at + i, &packed[i]);
}

static void move_photons(photon_store *store, photon_list *from)
{
    photon_place to = {store, from->first};
    slab_list_move(&from->all, put_side_by_side, &to);
}

static void join_chunk(size_t i, size_t end, unsigned thread, void *data)
{
    (void)end, (void)thread;
    join_loop *loop = data;
    move_photons(&loop->result->photons, &loop->chunks[i].photons);
    move_photons(&loop->result->in_media, &loop->chunks[i].in_media);
}

static void give_place(photon_list *photons, size_t *total)
{
    photons->first = *total;
    *total += photons->all.n;
    slab_list_uncount(&photons->all);
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
        slab_list_clear(&chunks[i].photons.all);
        slab_list_clear(&chunks[i].in_media.all);
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
