/*
 * Photon maps: the front door.
 */
#include "photon/map/map.h"

#include "base/memory.h"
#include "photon/map/map_kind.h"

static const photon_map_kind *const kinds[] = {
#define MAP(choice, word) [MAP_##choice] = &photon_map_##word,
#include "settings/map.def"
#undef MAP
};

photon_map *photon_map_build(map_choice choice, photon_store *store, float radius,
                             unsigned threads, GError **error)
{
    photon_map *map = g_new0(photon_map, 1);
    map->kind = kinds[choice];
    map->store = *store;
    *store = (photon_store){0};
    if (map->store.n > UINT32_MAX) {
        error_set(error, ERROR_FAILED, "a map holds at most 2^32 photons, not %zu",
                  map->store.n);
        photon_map_free(map);
        return NULL;
    }
    float usable = radius > 0.0f && isfinite(radius) ? radius : 0.0f;
    if (map->store.n > 0 && !map->kind->build(map, usable, threads, error)) {
        photon_map_free(map);
        return NULL;
    }
    return map;
}

void photon_map_free(photon_map *map)
{
    if (!map)
        return;
    if (map->index)
        map->kind->free(map);
    photon_store_clear(&map->store);
    g_free(map);
}

const photon_store *photon_map_store(const photon_map *map)
{
    return &map->store;
}

size_t photon_map_bytes(const photon_map *map)
{
    size_t index = map->index ? map->kind->bytes(map) : 0;
    return sizeof *map + photon_store_bytes(&map->store) + index;
}

bool photon_map_within(const photon_map *map, vec3 p, float radius,
                       const photon_filter *filter, photon_hits *hits)
{
    hits->n = 0;
    point_query query = point_query_of(&map->store, p, filter);
    return map->store.n == 0 || map->kind->within(map, &query, radius, hits);
}

bool photon_map_nearest(const photon_map *map, vec3 p, size_t k, float radius,
                        const photon_filter *filter, photon_hits *hits)
{
    hits->n = 0;
    point_query query = point_query_of(&map->store, p, filter);
    size_t wanted = MIN(k, map->store.n);
    return wanted == 0 || map->kind->nearest(map, &query, wanted, radius, hits);
}

bool photon_map_within_runs(const photon_map *map, const point_query *query, float radius,
                            photon_hits *hits)
{
    within_search search = {query, hits, radius * radius, false};
    map->kind->runs(map, query->p, radius, within_runs, &search);
    return !search.refused;
}
