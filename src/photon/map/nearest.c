/*
 * Cutting back to the k nearest: the k-th distance, one pass that keeps what is nearer,
 * and an exact order among those that tie.
 *
 * On a surface squared distances are about evenly spread, so that the k-th lies between
 * two guesses with few others: they are counted, LANES at a time, and only those between
 * them go through quickselect.
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
    /* Above the buffer lies room for what quickselect works on, and for ties. */
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

static float largest_value(const float *a, size_t n)
{
    lane_floats largest = fill_lanes(0.0f);
    size_t i = 0;
    for (; i + LANES <= n; i += LANES)
        largest = max_lanes(largest, load_lanes(a + i));
    float all = largest[0];
    for (int lane = 1; lane < LANES; lane++)
        all = maxf(all, largest[lane]);
    for (; i < n; i++)
        all = maxf(all, a[i]);
    return all;
}

static size_t count_below(const float *a, size_t n, float limit)
{
    size_t below = 0;
    for (size_t i = 0; i < n; i += LANES)
        below += (size_t)__builtin_popcount(
            bits_below(load_lanes(a + i), fill_lanes(limit)) & bits_first(n - i));
    return below;
}

/* Values from low on and below high, and how many there are below each. */
typedef struct value_range {
    float low, high;
    size_t below_low, below_high;
} value_range;

static size_t size_of(const value_range *r)
{
    return r->below_high - r->below_low;
}

/* Parts the range where the value of a rank would be, were they spread evenly, and keeps
 * the side of another. */
static void narrow(value_range *r, const float *a, size_t n, float rank, size_t wanted)
{
    float share = (rank - (float)r->below_low) / (float)size_of(r);
    float guess = r->low + (r->high - r->low) * clampf(share, 0.0f, 1.0f);
    size_t below = count_below(a, n, guess);
    if (below > wanted) {
        r->high = guess;
        r->below_high = below;
    } else {
        r->low = guess;
        r->below_low = below;
    }
}

/* Those around rank: a vector or two, or more if a pair of guesses does not leave less
 * than half, for they are spread unevenly. */
static value_range find_range(const float *a, size_t n, size_t rank)
{
    value_range r = {0.0f, nextafterf(largest_value(a, n), INFINITY), 0, n};
    for (size_t before = SIZE_MAX;
         size_of(&r) > 2 * LANES && size_of(&r) <= before / 2;) {
        before = size_of(&r);
        narrow(&r, a, n, (float)rank + LANES, rank);
        narrow(&r, a, n, (float)rank - LANES, rank);
    }
    return r;
}

/* The distance of rank. What lies behind the buffer's room is overwritten. */
static float find_distance2(point_hits *hits, size_t room, size_t rank)
{
    value_range r = find_range(hits->distance2, hits->n, rank);
    float *between = hits->distance2 + room;
    size_t n = 0;
    for (size_t i = 0; i < hits->n; i += LANES) {
        lane_floats values = load_lanes(hits->distance2 + i);
        unsigned bits = bits_below(values, fill_lanes(r.high)) &
                        ~bits_below(values, fill_lanes(r.low)) & bits_first(hits->n - i);
        n += pack_lanes(values, bits, 0, between + n, hits->index + room);
    }
    return select_value(between, n, rank - r.below_low);
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
    for (size_t i = 0; i < hits->n; i += LANES) {
        lane_floats values = load_lanes(hits->distance2 + i);
        unsigned all = bits_first(hits->n - i);
        unsigned below = bits_below(values, fill_lanes(limit)) & all;
        unsigned like = all & ~below & ~bits_below(fill_lanes(limit), values);
        for (; like; like &= like - 1u)
            ties[tied++] = hits->index[i + (size_t)__builtin_ctz(like)];
        nearer += pack_lane_pairs(values, hits->index + i, below,
                                  hits->distance2 + nearer, hits->index + nearer);
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
    float kth = find_distance2(hits, room, set->k - 1);
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
