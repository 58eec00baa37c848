#include "photon/map/points.h"

#include "base/memory.h"
#include "base/parallel.h"

size_t points_padded(size_t n)
{
    return (n + LANES - 1) / LANES * LANES + LANES;
}

bool point_arrays_make(point_arrays *points, size_t n, const char *what, GError **error)
{
    *points = (point_arrays){.n = n};
    float **arrays[] = {&points->x, &points->y, &points->z};
    for (int axis = 0; axis < 3; axis++) {
        *arrays[axis] = big_alloc(points_padded(n), sizeof(float), what, error);
        if (!*arrays[axis]) {
            point_arrays_clear(points);
            return false;
        }
    }
    return true;
}

void point_arrays_clear(point_arrays *points)
{
    big_free(points->x);
    big_free(points->y);
    big_free(points->z);
    *points = (point_arrays){0};
}

bool point_arrays_permute(point_arrays *points, const size_t *order, workers by,
                          GError **error)
{
    size_t n = points->n, size = sizeof(float);
    return points_permute(&points->x, n, size, order, by, error) &&
           points_permute(&points->y, n, size, order, by, error) &&
           points_permute(&points->z, n, size, order, by, error);
}

/* An array being put in order. */
typedef struct permutation {
    const size_t *order;
    const char *from;
    char *to;
    size_t size;
} permutation;

/* Of a size that the compiler knows. */
static inline __attribute__((always_inline)) void
permute_by(const permutation *job, size_t begin, size_t end, size_t size)
{
    const size_t *order = job->order;
    for (size_t i = begin; i < end; i++)
        memcpy(job->to + i * size, job->from + order[i] * size, size);
}

static void permute_piece(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const permutation *job = data;
    switch (job->size) {
    case 4:
        permute_by(job, begin, end, 4);
        break;
    case 8:
        permute_by(job, begin, end, 8);
        break;
    case 32:
        permute_by(job, begin, end, 32);
        break;
    default:
        permute_by(job, begin, end, job->size);
    }
}

bool points_permute(void *array, size_t n, size_t size, const size_t *order, workers by,
                    GError **error)
{
    void **old = array;
    void *to = big_alloc(points_padded(n), size, "points in order", error);
    if (!to)
        return false;
    permutation job = {order, *old, to, size};
    if (!parallel_work(n, ITEMS_AT_ONCE, by, permute_piece, &job, error)) {
        big_free(to);
        return false;
    }
    big_free(*old);
    *old = to;
    return true;
}

void point_hits_clear(point_hits *hits)
{
    big_free(hits->index);
    big_free(hits->distance2);
    *hits = (point_hits){0};
}

bool point_hits_refuse(GError **error)
{
    error_set(error, ERROR_FAILED, "out of memory: points that were found");
    return false;
}

bool point_hits_reserve(point_hits *hits, size_t capacity)
{
    if (capacity <= hits->capacity)
        return true;
    size_t room = MAX(capacity + LANES, 2 * hits->capacity);
    uint32_t *index =
        big_grow(hits->index, hits->n, room, sizeof *index, "points found", NULL);
    hits->refused |= !index;
    if (!index)
        return false;
    hits->index = index;
    float *distance2 =
        big_grow(hits->distance2, hits->n, room, sizeof *distance2, "points found", NULL);
    hits->refused |= !distance2;
    if (!distance2)
        return false;
    hits->distance2 = distance2;
    hits->capacity = room;
    return true;
}
