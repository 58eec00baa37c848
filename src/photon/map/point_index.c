#include "photon/map/point_index.h"

#include "base/memory.h"
#include "photon/map/kdtree.h"

/* size: room after the last point, so that eight can be loaded from any. */
enum { PADDING = LANES };

struct point_index {
    size_t n;
    float *x, *y, *z; /* sorted */
    uint32_t *normal; /* packed, in that order; NULL: there are none */
    size_t *number;   /* the owner's, in that order */
    kdtree *tree;     /* NULL: there are no points */
};

static point_arrays arrays_of(const point_index *index)
{
    return (point_arrays){index->n, index->x, index->y, index->z};
}

static bool make_room(point_index *index, bool with_normals, GError **error)
{
    if (with_normals)
        index->normal = big_alloc(index->n + PADDING, sizeof *index->normal,
                                  "points in space", error);
    if (with_normals && !index->normal)
        return false;
    float **arrays[] = {&index->x, &index->y, &index->z};
    for (int axis = 0; axis < 3; axis++) {
        *arrays[axis] =
            big_alloc(index->n + PADDING, sizeof(float), "points in space", error);
        if (!*arrays[axis])
            return false;
    }
    return true;
}

static void place_points(const point_index *index, const vec3 *points)
{
    for (size_t i = 0; i < index->n; i++) {
        vec3 p = points[index->number ? index->number[i] : i];
        index->x[i] = p[0];
        index->y[i] = p[1];
        index->z[i] = p[2];
    }
}

static bool sort_points(point_index *index, const vec3 *points, unsigned threads,
                        GError **error)
{
    const point_arrays arrays = arrays_of(index);
    place_points(index, points);
    index->number = kdtree_sort(&arrays, threads, error);
    if (!index->number)
        return false;
    place_points(index, points);
    index->tree = kdtree_build(&arrays, threads, error);
    return index->tree != NULL;
}

point_index *point_index_build(const vec3 *points, const uint32_t *normals, size_t n,
                               unsigned threads, GError **error)
{
    g_autoptr(point_index) index = g_new0(point_index, 1);
    index->n = n;
    if (n > 0 && (!make_room(index, normals != NULL, error) ||
                  !sort_points(index, points, threads, error)))
        return NULL;
    for (size_t i = 0; i < n && normals; i++)
        index->normal[i] = normals[index->number[i]];
    return g_steal_pointer(&index);
}

void point_index_free(point_index *index)
{
    if (!index)
        return;
    kdtree_free(index->tree);
    big_free(index->x);
    big_free(index->y);
    big_free(index->z);
    big_free(index->normal);
    big_free(index->number);
    g_free(index);
}

size_t point_index_number(const point_index *index, size_t place)
{
    return index->number[place];
}

vec3 point_index_position(const point_index *index, size_t place)
{
    return vec3_make(index->x[place], index->y[place], index->z[place]);
}

static point_query query_at(const point_index *index, vec3 p)
{
    return (point_query){
        .number = index->number, .x = index->x, .y = index->y, .z = index->z, .p = p};
}

/* From places in the sorted arrays to the owner's numbers. */
static void name_hits(const point_index *index, photon_hits *hits)
{
    for (size_t i = 0; i < hits->n; i++)
        hits->index[i] = (uint32_t)index->number[hits->index[i]];
}

bool point_index_within(const point_index *index, vec3 p, float radius, photon_hits *hits)
{
    hits->n = 0;
    if (!index->tree)
        return true;
    const point_arrays points = arrays_of(index);
    const point_query query = query_at(index, p);
    within_search search = {&query, hits, radius * radius, false};
    kdtree_runs(index->tree, &points, p, radius, within_runs, &search);
    name_hits(index, hits);
    return !search.refused;
}

static bool find_nearest(const point_index *index, const point_query *query, size_t k,
                         float radius, photon_hits *hits)
{
    hits->n = 0;
    size_t wanted = MIN(k, index->n);
    nearest_set set;
    if (wanted == 0)
        return true;
    if (!nearest_begin(&set, query, wanted, radius, hits))
        return false;
    if (wanted == 1 && !query_selects(query))
        kdtree_nearest_one(index->tree, &set);
    else
        kdtree_nearest(index->tree, &set);
    name_hits(index, hits);
    return true;
}

bool point_index_nearest(const point_index *index, vec3 p, size_t k, float radius,
                         photon_hits *hits)
{
    const point_query query = query_at(index, p);
    return find_nearest(index, &query, k, radius, hits);
}

bool point_index_nearest_facing(const point_index *index, vec3 p, vec3 n, size_t k,
                                float radius, photon_hits *hits)
{
    point_query query = query_at(index, p);
    query.wi = index->normal;
    query.n = n;
    query.one_sided = true;
    return find_nearest(index, &query, k, radius, hits);
}
