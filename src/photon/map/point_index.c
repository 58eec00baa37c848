/*
 * The point index: the front door.
 */
#include "base/memory.h"
#include "photon/map/index_kind.h"

static const point_index_kind *const kinds[] = {
#define MAP(choice, word) [MAP_##choice] = &point_index_##word,
#include "settings/map.def"
#undef MAP
};

/* @return false when memory is refused */
static bool sort_points(point_index *index, point_arrays *points, float radius,
                        workers by, size_t **order, GError **error)
{
    if (!index->kind->sort)
        return true;
    *order = index->kind->sort(index, radius, by, error);
    bool ok = *order && point_arrays_permute(points, *order, by, error);
    if (!ok)
        g_clear_pointer(order, big_free);
    index->points = *points;
    return ok;
}

point_index *point_index_build(map_choice choice, point_arrays *points, float radius,
                               workers by, size_t **order, GError **error)
{
    g_autoptr(point_index) index = g_new0(point_index, 1);
    float usable = radius > 0.0f && isfinite(radius) ? radius : 0.0f;
    index->kind = kinds[choice];
    index->points = *points;
    *order = NULL;
    if (points->n > UINT32_MAX) {
        error_set(error, ERROR_FAILED, "an index holds at most 2^32 points, not %zu",
                  points->n);
        return NULL;
    }
    if (points->n == 0)
        return g_steal_pointer(&index);
    if (!sort_points(index, points, usable, by, order, error))
        return NULL;
    if (!index->kind->build || index->kind->build(index, by, error))
        return g_steal_pointer(&index);
    g_clear_pointer(order, big_free);
    return NULL;
}

void point_index_free(point_index *index)
{
    if (index && index->structure)
        index->kind->free(index);
    g_free(index);
}

size_t point_index_bytes(const point_index *index)
{
    return sizeof *index + (index->structure ? index->kind->bytes(index) : 0);
}

void point_index_runs(const point_index *index, vec3 p, float radius,
                      point_run_visitor visit, void *data)
{
    if (index->points.n > 0)
        index->kind->runs(index, p, radius, visit, data);
}

bool point_index_within(const point_index *index, const point_query *query, float radius,
                        point_hits *hits)
{
    hits->n = 0;
    if (index->points.n == 0)
        return true;
    if (index->kind->within)
        return index->kind->within(index, query, radius, hits);
    within_search search = {&index->points, query, hits, radius * radius, false};
    index->kind->runs(index, query->p, radius, within_runs, &search);
    return !search.refused;
}

bool point_index_nearest(const point_index *index, const point_query *query, size_t k,
                         float radius, point_hits *hits)
{
    hits->n = 0;
    size_t wanted = MIN(k, index->points.n);
    return wanted == 0 || index->kind->nearest(index, query, wanted, radius, hits);
}
