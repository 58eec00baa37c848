#include "transport/places.h"

#include "base/memory.h"
#include "base/parallel.h"

enum { CHUNK = 256 }; /* size: of a thread's work */

/* A place for each patch as wide as a hundredth of what holds the scene. */
enum { MOST_PLACES = 8192 };

float places_distance(const photon_map *map, vec3 p, photon_hits *hits)
{
    if (!photon_map_nearest(map, p, PLACES_NEAREST, INFINITY, NULL, hits) ||
        hits->n < PLACES_NEAREST)
        return 0.0f;
    float furthest2 = 0.0f;
    for (size_t i = 0; i < hits->n; i++)
        furthest2 = maxf(furthest2, hits->distance2[i]);
    return sqrtf(furthest2);
}

typedef struct places_loop {
    const photon_map *map;
    size_t n;
    places_value value;
    const void *data;
    float *values;
} places_loop;

static photon chosen(const photon_map *map, size_t i, size_t n)
{
    const photon_store *from = photon_map_store(map);
    return photon_store_get(from, i * from->n / n);
}

static void find_values(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    const places_loop *loop = data;
    photon_hits hits = {0};
    for (size_t i = begin; i < end; i++) {
        vec3 p = chosen(loop->map, i, loop->n).p;
        float distance = places_distance(loop->map, p, &hits);
        loop->values[i] = loop->value(loop->data, p, distance, &hits);
    }
    photon_hits_clear(&hits);
}

photon_map *places_keep(const photon_map *map, unsigned threads, places_value value,
                        const void *data, GError **error)
{
    size_t n = MIN(photon_map_store(map)->n, MOST_PLACES);
    photon_store places = {0};
    float *values = big_alloc(n, sizeof *values, "places", error);
    if (!values || !photon_store_reserve(&places, n, error)) {
        big_free(values);
        return NULL;
    }
    places_loop loop = {map, n, value, data, values};
    parallel_for(n, CHUNK, threads, NULL, find_values, &loop);
    for (size_t i = 0; i < n; i++) {
        photon at = chosen(map, i, n);
        at.flux = spectrum_fill(values[i]);
        photon_store_put(&places, &at);
    }
    big_free(values);
    return photon_map_build(MAP_KDTREE, &places, 0.0f, 1, error);
}

float places_at(const photon_map *places, vec3 p, float none, photon_hits *hits)
{
    if (!photon_map_nearest(places, p, 1, INFINITY, NULL, hits) || hits->n == 0)
        return none;
    return photon_map_store(places)->flux[hits->index[0]][0];
}
