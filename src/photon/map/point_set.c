#include "photon/map/point_set.h"

#include "base/memory.h"

struct point_set {
    point_arrays points; /* sorted */
    size_t *number;      /* the owner's, in that order */
    point_index *index;
};

static int compare_numbers(const void *data, size_t a, size_t b)
{
    const size_t *number = data;
    return (number[a] > number[b]) - (number[a] < number[b]);
}

static const point_rules by_number = {.compare = compare_numbers};

point_set *point_set_build(const vec3 *points, size_t n, unsigned threads, GError **error)
{
    g_autoptr(point_set) set = g_new0(point_set, 1);
    if (!point_arrays_make(&set->points, n, "points in space", error))
        return NULL;
    for (size_t i = 0; i < n; i++) {
        set->points.x[i] = points[i][0];
        set->points.y[i] = points[i][1];
        set->points.z[i] = points[i][2];
    }
    set->index = point_index_build(MAP_KDTREE, &set->points, 0.0f,
                                   (workers){threads, NULL}, &set->number, error);
    return set->index ? g_steal_pointer(&set) : NULL;
}

void point_set_free(point_set *set)
{
    if (!set)
        return;
    point_index_free(set->index);
    point_arrays_clear(&set->points);
    big_free(set->number);
    g_free(set);
}

size_t point_set_number(const point_set *set, size_t place)
{
    return set->number[place];
}

vec3 point_set_position(const point_set *set, size_t place)
{
    const point_arrays *points = &set->points;
    return vec3_make(points->x[place], points->y[place], points->z[place]);
}

/* From places in the sorted arrays to the owner's numbers. */
static void name_hits(const point_set *set, point_hits *hits)
{
    for (size_t i = 0; i < hits->n; i++)
        hits->index[i] = (uint32_t)set->number[hits->index[i]];
}

bool point_set_within(const point_set *set, vec3 p, float radius, point_hits *hits)
{
    const point_query query = {.p = p};
    bool done = point_index_within(set->index, &query, radius, hits);
    name_hits(set, hits);
    return done;
}

bool point_set_nearest(const point_set *set, vec3 p, size_t k, float radius,
                       point_hits *hits)
{
    const point_query query = {.p = p, .rules = &by_number, .data = set->number};
    bool done = point_index_nearest(set->index, &query, k, radius, hits);
    name_hits(set, hits);
    return done;
}
