#include "base/slab_list.h"

#include "base/memory.h"

#include <stdatomic.h>

enum {
    PIECE_BYTES = 4 << 10,  /* size: so much a list leaves half of */
    FIRST_BYTES = 64 << 10, /* size: of a thread's first slab */
    LINE = 64,              /* bytes: of the cache */
};

struct slab {
    _Alignas(LINE)
        atomic_size_t n_used; /* pieces that were cut, and one until it is closed */
    size_t size, cut;         /* bytes, this among them */
};

struct slab_piece {
    _Alignas(LINE) slab *of;
    slab_piece *next;
    size_t n;
};

/* Pieces count as memory in use, and not slabs, so that the memory of few elements tells
   that of many. */
static void release(slab *s)
{
    if (atomic_fetch_sub(&s->n_used, 1) == 1)
        big_free(s);
}

void slab_close(slab *s)
{
    if (s)
        release(s);
}

static slab *slab_with_room(slab **from, const char *what, GError **error)
{
    slab *s = *from;
    if (s && s->cut + PIECE_BYTES <= s->size)
        return s;
    size_t size = s ? MIN(2 * s->size, SLAB_BYTES) : FIRST_BYTES;
    slab *next = big_alloc_uncounted(size, what, error);
    if (!next)
        return NULL;
    atomic_init(&next->n_used, 1);
    next->size = size;
    next->cut = sizeof *next;
    slab_close(s);
    return *from = next;
}

static slab_piece *cut_piece(slab **from, const char *what, GError **error)
{
    slab *s = slab_with_room(from, what, error);
    if (!s || !memory_reserve(PIECE_BYTES, what, error))
        return NULL;
    slab_piece *piece = (slab_piece *)((char *)s + s->cut);
    s->cut += PIECE_BYTES;
    atomic_fetch_add(&s->n_used, 1);
    *piece = (slab_piece){.of = s};
    return piece;
}

static size_t elements_in_piece(size_t size)
{
    return (PIECE_BYTES - sizeof(slab_piece)) / size;
}

static bool add_piece(slab_list *list, slab **from, const char *what, GError **error)
{
    slab_piece *piece = cut_piece(from, what, error);
    if (!piece)
        return false;
    if (list->last)
        list->last->next = piece;
    else
        list->first = piece;
    list->last = piece;
    return true;
}

void *slab_list_add(slab_list *list, size_t size, slab **from, const char *what,
                    GError **error)
{
    const slab_piece *last = list->last;
    bool is_full = !last || last->n == elements_in_piece(size);
    if (is_full && !add_piece(list, from, what, error))
        return NULL;
    list->n++;
    return (char *)(list->last + 1) + list->last->n++ * size;
}

void slab_list_uncount(slab_list *list)
{
    for (const slab_piece *piece = list->first; piece; piece = piece->next)
        memory_release(PIECE_BYTES);
    list->uncounted = true;
}

void slab_list_move(slab_list *list, slab_visit visit, void *data)
{
    size_t at = 0;
    for (slab_piece *piece = list->first, *next; piece; piece = next) {
        visit(piece + 1, piece->n, at, data);
        at += piece->n;
        next = piece->next;
        memory_release(list->uncounted ? 0 : PIECE_BYTES);
        release(piece->of);
    }
    *list = (slab_list){0};
}

static void pass_by(const void *elements, size_t n, size_t at, void *data)
{
    (void)elements, (void)n, (void)at, (void)data;
}

void slab_list_clear(slab_list *list)
{
    slab_list_move(list, pass_by, NULL);
}

bool slab_work(size_t n, size_t chunk_size, workers by, parallel_body body, void *data,
               slab ***slabs, GError **error)
{
    unsigned n_threads = parallel_threads(by.threads);
    g_autofree slab **all = *slabs = g_new0(slab *, n_threads);
    bool done = parallel_work(n, chunk_size, by, body, data, error);
    for (unsigned i = 0; i < n_threads; i++)
        slab_close(all[i]);
    *slabs = NULL;
    return done;
}
