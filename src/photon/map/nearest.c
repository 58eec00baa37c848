/*
 * Cutting back to the k nearest: the k-th distance by quickselect over a copy of the
 * distances, one pass that keeps what is nearer, and an exact order among those that tie.
 */
#include "photon/map/nearest.h"

/* -1, 0, 1 as a is before, like or after b. */
static int compare(float a, float b)
{
    return (a > b) - (a < b);
}

/* Of those at one distance. */
static int compare_ties(const nearest_set *set, size_t a, size_t b)
{
    const point_arrays *points = set->points;
    const point_query *query = set->query;
    int order = compare(points->x[a], points->x[b]);
    order = order ? order : compare(points->y[a], points->y[b]);
    order = order ? order : compare(points->z[a], points->z[b]);
    if (!order && query->rules && query->rules->compare)
        return query->rules->compare(query->data, a, b);
    return order ? order : (a > b) - (a < b);
}

bool nearest_before(const nearest_set *set, size_t a, float da, size_t b, float db)
{
    int order = compare(da, db);
    return (order ? order : compare_ties(set, a, b)) < 0;
}

bool nearest_begin(nearest_set *set, const point_arrays *points, const point_query *query,
                   size_t k, float radius, point_hits *hits)
{
    size_t full = 2 * k + LANES;
    *set = (nearest_set){points, query, hits, .k = k, .full = full};
    /* Above the buffer lies room for the copy that quickselect works on. */
    bool ok = point_hits_reserve(hits, 2 * (full + LANES));
    nearest_restart(set, radius);
    return ok;
}

void nearest_restart(nearest_set *set, float radius)
{
    set->hits->n = 0;
    set->limit = radius * radius;
}

/* Moves values below pivot to the front, without branches; returns their number. */
static size_t partition(float *a, size_t n, float pivot, bool or_like)
{
    size_t below = 0;
    for (size_t i = 0; i < n; i++) {
        float x = a[i];
        a[i] = a[below];
        a[below] = x;
        below += or_like ? !(pivot < x) : x < pivot;
    }
    return below;
}

/* The middle one of first, middle and last. */
static float median3(const float *a, size_t n)
{
    float x = a[0], y = a[n / 2], z = a[n - 1];
    return maxf(minf(x, y), minf(maxf(x, y), z));
}

/* The value that would stand at rank if a were sorted. */
static float select_value(float *a, size_t n, size_t rank)
{
    for (;;) {
        float pivot = median3(a, n);
        size_t below = partition(a, n, pivot, false);
        if (rank < below) {
            n = below;
            continue;
        }
        if (below == 0) {
            below = partition(a, n, pivot, true);
            if (rank < below)
                return pivot;
        }
        a += below;
        rank -= below;
        n -= below;
    }
}

/* Hoare's partition of index[low, high); returns where the upper part begins. */
static size_t partition_ties(const nearest_set *set, uint32_t *index, size_t low,
                             size_t high)
{
    size_t pivot = index[low + (high - low - 1) / 2], i = low, j = high - 1;
    for (;; i++, j--) {
        while (compare_ties(set, index[i], pivot) < 0)
            i++;
        while (compare_ties(set, index[j], pivot) > 0)
            j--;
        if (i >= j)
            return j + 1;
        uint32_t swapped = index[i];
        index[i] = index[j];
        index[j] = swapped;
    }
}

/* Moves the k first of index[0, n) to its front. */
static void select_ties(const nearest_set *set, uint32_t *index, size_t n, size_t k)
{
    size_t low = 0, high = n;
    while (high - low > 1 && k > low && k < high) {
        size_t split = partition_ties(set, index, low, high);
        if (k < split)
            high = split;
        else
            low = split;
    }
}

/* Keeps hits nearer than limit, in their order; those that tie with it follow them.
 * Returns how many are nearer. */
static size_t keep_nearer(point_hits *hits, float limit, uint32_t *ties)
{
    size_t nearer = 0, tied = 0;
    for (size_t i = 0; i < hits->n; i++) {
        uint32_t index = hits->index[i];
        float distance2 = hits->distance2[i];
        ties[tied] = index;
        tied += !(distance2 < limit) && !(distance2 > limit);
        hits->index[nearer] = index;
        hits->distance2[nearer] = distance2;
        nearer += distance2 < limit;
    }
    hits->n = nearer + tied;
    return nearer;
}

void nearest_cut(nearest_set *set)
{
    point_hits *hits = set->hits;
    if (hits->n < set->k)
        return;
    size_t room = set->full + LANES;
    float *copy = hits->distance2 + room;
    memcpy(copy, hits->distance2, hits->n * sizeof *copy);
    float kth = select_value(copy, hits->n, set->k - 1);
    uint32_t *ties = hits->index + room;
    size_t nearer = keep_nearer(hits, kth, ties);
    size_t wanted = set->k - nearer;
    if (hits->n > set->k)
        select_ties(set, ties, hits->n - nearer, wanted);
    for (size_t i = 0; i < wanted; i++) {
        hits->index[nearer + i] = ties[i];
        hits->distance2[nearer + i] = kth;
    }
    hits->n = set->k;
    set->limit = minf(set->limit, nextafterf(kth, INFINITY));
}

void nearest_add_run(nearest_set *set, size_t begin, size_t end)
{
    point_hits *hits = set->hits;
    for (size_t i = begin; i < end; i += LANES) {
        lane_floats distance2;
        unsigned bits =
            query_block(set->query, set->points, i, end, set->limit, &distance2);
        if (!bits)
            continue;
        hits->n += pack_lanes(distance2, bits, (uint32_t)i, hits->distance2 + hits->n,
                              hits->index + hits->n);
        if (hits->n > set->full)
            nearest_cut(set);
    }
}
