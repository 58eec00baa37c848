#include "transport/radius_cache.h"

#include "base/parallel.h"
#include "transport/near_places.h"

#include <string.h>

struct radius_cache {
    size_t n;
    near_places *near; /* of places */
    vec3 *places;
    float *radii; /* at each place */
};

float radius_of_nearest(const point_hits *nearest)
{
    float furthest2 = 0.0f;
    for (size_t i = 0; i < nearest->n; i++)
        furthest2 = maxf(furthest2, nearest->distance2[i]);
    return sqrtf(furthest2 * RADIUS_NEAREST / (float)MAX(nearest->n, 1));
}

typedef struct radius_loop {
    const vec3 *places;
    const radius_source *source;
    float *radii;
    atomic_bool refused; /* memory was */
} radius_loop;

static void find_radii(size_t begin, size_t end, unsigned thread, void *data)
{
    (void)thread;
    radius_loop *loop = data;
    const radius_source *source = loop->source;
    point_hits hits = {0};
    for (size_t i = begin; i < end; i++) {
        vec3 p = loop->places[i];
        bool found = source->nearest(source->data, p, &hits);
        float distance = found ? radius_of_nearest(&hits) : 0.0f;
        loop->radii[i] = source->radius(source->data, p, distance, &hits);
    }
    if (hits.refused)
        atomic_store(&loop->refused, true);
    point_hits_clear(&hits);
}

/* Without its radii. */
static radius_cache *cache_at(const vec3 *places, size_t n, GError **error)
{
    g_autoptr(radius_cache) cache = g_new0(radius_cache, 1);
    cache->n = n;
    cache->radii = g_new0(float, MAX(n, 1));
    cache->places = g_aligned_alloc0(MAX(n, 1), sizeof *cache->places, 16);
    memcpy(cache->places, places, n * sizeof *places);
    cache->near = near_places_build(cache->places, n, error);
    return cache->near ? g_steal_pointer(&cache) : NULL;
}

radius_cache *radius_cache_of(const vec3 *places, const float *radii, size_t n,
                              GError **error)
{
    radius_cache *cache = cache_at(places, n, error);
    if (cache)
        memcpy(cache->radii, radii, n * sizeof *radii);
    return cache;
}

radius_cache *radius_cache_build(const vec3 *places, size_t n,
                                 const radius_source *source, unsigned threads,
                                 GError **error)
{
    g_autoptr(radius_cache) cache = cache_at(places, n, error);
    if (!cache)
        return NULL;
    radius_loop loop = {places, source, cache->radii, false};
    const workers by = {threads, source->cancel};
    if (!parallel_work(n, RAYS_AT_ONCE, by, find_radii, &loop, error))
        return NULL;
    if (loop.refused && !point_hits_refuse(error))
        return NULL;
    return g_steal_pointer(&cache);
}

void radius_cache_free(radius_cache *cache)
{
    if (!cache)
        return;
    near_places_free(cache->near);
    g_free(cache->radii);
    g_aligned_free(cache->places);
    g_free(cache);
}

size_t radius_cache_count(const radius_cache *cache)
{
    return cache->n;
}

vec3 radius_cache_place(const radius_cache *cache, size_t i)
{
    return cache->places[i];
}

float radius_cache_nth(const radius_cache *cache, size_t i)
{
    return cache->radii[i];
}

float radius_cache_at(const radius_cache *cache, vec3 p, float none, float *distance,
                      point_hits *hits)
{
    near_place found;
    if (!near_places_find(cache->near, p, &found, hits))
        return none;
    if (distance)
        *distance = sqrtf(found.distance2);
    return cache->radii[found.which];
}
