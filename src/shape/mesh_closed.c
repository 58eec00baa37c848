/*
 * Closed meshes. Vertices that lie at exactly one place are made one (exporters split
 * them where normals or texture coordinates jump), by hashing; then all edges are sorted,
 * and each must come up an even number of times. Volume by the divergence theorem.
 */
#include "shape/mesh_closed.h"

#include "base/memory.h"
#include "base/wanted.h"
#include "math/sampler.h"

#include <stdlib.h>
#include <string.h>

#define NO_VERTEX UINT32_MAX

/* + 0 makes both zeros one. */
static uint64_t hash_place(const float *p)
{
    uint32_t bits[3];
    float place[3] = {p[0] + 0.0f, p[1] + 0.0f, p[2] + 0.0f};
    memcpy(bits, place, sizeof bits);
    return hash_mix(hash_mix(bits[0], bits[1]), bits[2]);
}

static bool same_place(const float *a, const float *b)
{
    return !(fabsf(a[0] - b[0]) > 0.0f || fabsf(a[1] - b[1]) > 0.0f ||
             fabsf(a[2] - b[2]) > 0.0f);
}

/* first[i]: the first vertex at the place of vertex i. */
static uint32_t *weld(const mesh *m, GError **error)
{
    size_t size = 16;
    while (size < 2 * m->n_vertices)
        size *= 2;
    uint32_t *first = big_alloc(m->n_vertices, sizeof *first, "mesh edges", error);
    uint32_t *table = first ? big_alloc(size, sizeof *table, "mesh edges", error) : NULL;
    if (!table) {
        big_free(first);
        return NULL;
    }
    memset(table, 0xff, size * sizeof *table);
    for (size_t i = 0; i < m->n_vertices && still_wanted_at(i, NULL); i++) {
        const float *p = m->positions + 3 * i;
        size_t at = hash_place(p) & (size - 1);
        while (table[at] != NO_VERTEX &&
               !same_place(m->positions + 3 * (size_t)table[at], p))
            at = (at + 1) & (size - 1);
        if (table[at] == NO_VERTEX)
            table[at] = (uint32_t)i;
        first[i] = table[at];
    }
    big_free(table);
    return first;
}

static int compare_edges(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

/* Sorted runs [first, middle) and [middle, end) become one. */
static void merge_runs(const uint64_t *from, size_t first, size_t middle, size_t end,
                       uint64_t *to)
{
    size_t a = first, b = middle;
    for (size_t i = first; i < end && still_wanted_at(i, NULL); i++)
        to[i] = b == end || (a < middle && from[a] <= from[b]) ? from[a++] : from[b++];
}

/* In runs, since qsort can not be stopped. @return which of the two has them sorted */
static uint64_t *sort_edges(uint64_t *edges, size_t n, uint64_t *beside)
{
    const size_t run = 1 << 16;
    uint64_t *from = edges, *to = beside;
    for (size_t i = 0; i < n && still_wanted(NULL); i += run)
        qsort(edges + i, MIN(run, n - i), sizeof *edges, compare_edges);
    for (size_t length = run; length < n; length *= 2) {
        for (size_t i = 0; i < n; i += 2 * length)
            merge_runs(from, i, MIN(i + length, n), MIN(i + 2 * length, n), to);
        uint64_t *sorted = to;
        to = from;
        from = sorted;
    }
    return from;
}

/* Edges as pairs of vertices, the lower one first; those of no length are left out. */
static size_t list_edges(const mesh *m, const uint32_t *first, uint64_t *edges)
{
    size_t n = 0;
    for (size_t i = 0; i < m->n_triangles && still_wanted_at(i, NULL); i++)
        for (int k = 0; k < 3; k++) {
            uint32_t a = first[m->indices[3 * i + (size_t)k]];
            uint32_t b = first[m->indices[3 * i + (size_t)((k + 1) % 3)]];
            if (a != b)
                edges[n++] = (uint64_t)MIN(a, b) << 32 | MAX(a, b);
        }
    return n;
}

static bool all_even(const uint64_t *edges, size_t n)
{
    for (size_t i = 0; i < n;) {
        size_t end = i + 1;
        while (end < n && edges[end] == edges[i])
            end++;
        if ((end - i) % 2)
            return false;
        i = end;
    }
    return n > 0;
}

static double volume_of(const mesh *m)
{
    double sum = 0.0;
    const float *o = m->positions;
    for (size_t i = 0; i < m->n_triangles; i++) {
        double p[3][3];
        for (int k = 0; k < 3; k++)
            for (int c = 0; c < 3; c++)
                p[k][c] = (double)m->positions[3 * (size_t)m->indices[3 * i + (size_t)k] +
                                               (size_t)c] -
                          (double)o[c];
        sum += p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) +
               p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
               p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
    }
    return sum / 6.0;
}

bool mesh_body_of(const mesh *m, mesh_body *out, GError **error)
{
    *out = (mesh_body){0};
    uint32_t *first = weld(m, error);
    size_t most = 3 * m->n_triangles;
    uint64_t *edges = first ? big_alloc(most, sizeof *edges, "mesh edges", error) : NULL;
    uint64_t *beside =
        edges ? big_alloc(most, sizeof *beside, "mesh edges", error) : NULL;
    if (beside) {
        size_t n = list_edges(m, first, edges);
        out->closed = all_even(sort_edges(edges, n, beside), n);
        out->volume = out->closed ? volume_of(m) : 0.0;
    }
    bool done = beside && still_wanted(error);
    big_free(beside);
    big_free(edges);
    big_free(first);
    return done;
}
