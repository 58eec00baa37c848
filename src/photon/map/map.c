/*
 * Photon maps: the front door, and the search that maps with runs share.
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

void photon_hits_clear(photon_hits *hits)
{
    big_free(hits->index);
    big_free(hits->distance2);
    *hits = (photon_hits){0};
}

bool photon_hits_reserve(photon_hits *hits, size_t capacity)
{
    if (capacity <= hits->capacity)
        return true;
    size_t room = MAX(capacity + LANES, 2 * hits->capacity);
    size_t *index =
        big_grow(hits->index, hits->n, room, sizeof *index, "photons found", NULL);
    if (!index)
        return false;
    hits->index = index;
    float *distance2 = big_grow(hits->distance2, hits->n, room, sizeof *distance2,
                                "photons found", NULL);
    if (!distance2)
        return false;
    hits->distance2 = distance2;
    hits->capacity = room;
    return true;
}

bool photon_map_within(const photon_map *map, vec3 p, float radius,
                       const photon_filter *filter, photon_hits *hits)
{
    hits->n = 0;
    photon_probe probe = photon_probe_make(&map->store, p, filter);
    return map->store.n == 0 || map->kind->within(map, &probe, radius, hits);
}

bool photon_map_nearest(const photon_map *map, vec3 p, size_t k, float radius,
                        const photon_filter *filter, photon_hits *hits)
{
    hits->n = 0;
    photon_probe probe = photon_probe_make(&map->store, p, filter);
    size_t wanted = MIN(k, map->store.n);
    return wanted == 0 || map->kind->nearest(map, &probe, wanted, radius, hits);
}

typedef struct within_search {
    const photon_probe *probe;
    photon_hits *hits;
    float radius2;
    bool refused;
} within_search;

static void within_run(size_t begin, size_t end, within_search *search)
{
    photon_hits *hits = search->hits;
    const photon_probe probe = *search->probe;
    for (size_t i = begin; i < end; i += LANES) {
        floats8 distance2;
        unsigned bits = probe_block(&probe, i, end, search->radius2, &distance2);
        if (!bits)
            continue;
        if (search->refused || !photon_hits_reserve(hits, hits->n + LANES)) {
            search->refused = true;
            return;
        }
        hits->n +=
            pack8(distance2, bits, i, hits->distance2 + hits->n, hits->index + hits->n);
    }
}

static void within_runs(const photon_run *runs, size_t n, void *data)
{
    for (size_t i = 0; i < n; i++)
        within_run(runs[i].begin, runs[i].end, data);
}

bool photon_map_within_runs(const photon_map *map, const photon_probe *probe,
                            float radius, photon_hits *hits)
{
    within_search search = {probe, hits, radius * radius, false};
    map->kind->runs(map, probe->p, radius, within_runs, &search);
    return !search.refused;
}
