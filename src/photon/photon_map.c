#include "photon/photon_map.h"

#include "base/memory.h"
#include "photon/photon_query.h"

struct photon_map {
    photon_store store;
    point_index *index;
};

static bool index_store(photon_map *map, map_choice choice, float radius, workers by,
                        GError **error)
{
    photon_store *store = &map->store;
    point_arrays points = photon_points(store);
    size_t *order = NULL;
    map->index = point_index_build(choice, &points, radius, by, &order, error);
    store->x = points.x;
    store->y = points.y;
    store->z = points.z;
    bool ok = map->index && photon_store_follow(store, order, by, error);
    big_free(order);
    return ok;
}

photon_map *photon_map_build(map_choice choice, photon_store *store, float radius,
                             workers by, GError **error)
{
    g_autoptr(photon_map) map = g_new0(photon_map, 1);
    map->store = *store;
    *store = (photon_store){0};
    return index_store(map, choice, radius, by, error) ? g_steal_pointer(&map) : NULL;
}

void photon_map_free(photon_map *map)
{
    if (!map)
        return;
    point_index_free(map->index);
    photon_store_clear(&map->store);
    g_free(map);
}

const photon_store *photon_map_store(const photon_map *map)
{
    return &map->store;
}

const point_index *photon_map_index(const photon_map *map)
{
    return map->index;
}

size_t photon_map_bytes(const photon_map *map)
{
    return sizeof *map + photon_store_bytes(&map->store) + point_index_bytes(map->index);
}

/* ---- Rules ---- */

static bool accepts(const void *data, size_t place)
{
    return photon_query_accepts(data, place);
}

static unsigned accepted(const void *data, size_t first, unsigned bits)
{
    return photon_query_accepted(data, first, bits);
}

static int compare_floats(float a, float b)
{
    return (a > b) - (a < b);
}

/* Of photons in one place. */
static int compare_photons(const void *data, size_t a, size_t b)
{
    const photon_store *s = ((const photon_query *)data)->store;
    int order = (s->wi[a] > s->wi[b]) - (s->wi[a] < s->wi[b]);
    if (s->numbered)
        return order ? order
                     : (s->number[a] > s->number[b]) - (s->number[a] < s->number[b]);
    spectrum x = photon_store_flux(s, a), y = photon_store_flux(s, b);
    for (int i = 0; i < N_WAVELENGTHS && !order; i++)
        order = compare_floats(x[i], y[i]);
    return order;
}

point_query photon_rules_of(const photon_query *query)
{
    static const point_rules all = {.compare = compare_photons};
    static const point_rules some = {accepts, accepted, compare_photons};
    point_query at = query->at;
    at.rules = photon_query_selects(query) ? &some : &all;
    at.data = query;
    return at;
}

/* ---- Queries ---- */

bool photon_map_query_within(const photon_map *map, const photon_query *query,
                             float radius, point_hits *hits)
{
    const point_query at = photon_rules_of(query);
    return point_index_within(map->index, &at, radius, hits);
}

bool photon_map_query_nearest(const photon_map *map, const photon_query *query, size_t k,
                              float radius, point_hits *hits)
{
    const point_query at = photon_rules_of(query);
    return point_index_nearest(map->index, &at, k, radius, hits);
}

bool photon_map_within(const photon_map *map, vec3 p, float radius,
                       const photon_filter *filter, point_hits *hits)
{
    if (!filter)
        return point_index_within(map->index, &(point_query){.p = p}, radius, hits);
    const photon_query query = photon_query_of(&map->store, p, filter);
    return photon_map_query_within(map, &query, radius, hits);
}

bool photon_map_nearest(const photon_map *map, vec3 p, size_t k, float radius,
                        const photon_filter *filter, point_hits *hits)
{
    const photon_query query = photon_query_of(&map->store, p, filter);
    return photon_map_query_nearest(map, &query, k, radius, hits);
}
